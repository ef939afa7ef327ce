"""Walls that exchange heat, and the ledger of energy."""

import math

import numpy as np
from jobs.gas import contacts_pass
from jobs.registry import Findings, job, rounded

from atmosbox import theory
from atmosbox.engine import HeatBath, ParcelSet, Piston, Specular, maxwell_velocities, random_positions
from atmosbox.engine.core.measure import layer_sample
from atmosbox.scene.statistics import block_average, kolmogorov_smirnov_critical
from atmosbox.simulation.runner import LEDGER_LIMIT


@job("energy")
def energy(found: Findings) -> None:
    """Let a thousand molecules collide ten million times in gravity between reflecting walls."""
    n = 1000
    rng = np.random.default_rng(1)
    length = (20.0, 20.0, 25.0)
    gas = ParcelSet(
        random_positions(length, np.ones(n), rng), maxwell_velocities(1.0, np.ones(n), rng), length=length, gravity=0.1
    )
    start = sum(gas.energy())
    worst = 0.0
    for _ in range(100):
        contacts_pass(gas, 1e5)
        worst = max(worst, abs(sum(gas.energy()) / start - 1.0))
    found.bound(f"largest relative change of the energy in {rounded(gas.contacts, 3)} collisions", worst, 1e-12)
    found.number("change", rounded(worst))


class Breath:
    """A ceiling that goes up and down by a third, over and over."""

    interval = 0.1

    def __init__(self, height: float, period: float) -> None:
        self._height, self._turn = height, 2.0 * math.pi / period

    def velocity(self, parcel: ParcelSet) -> float:
        """Return the velocity of the ceiling for the next interval."""
        return self._height / 3.0 * self._turn * math.cos(self._turn * parcel.time)


@job("ledger")
def ledger(found: Findings) -> None:
    """Keep the books of molecules that rotate, in gravity, between unlike heat baths, below a piston that moves."""
    n = 1000
    rng = np.random.default_rng(2)
    length = (20.0, 20.0, 25.0)
    walls = (HeatBath(0.5), HeatBath(2.0), Specular(), HeatBath(1.0, accommodation=0.5), HeatBath(1.5), Piston())
    gas = ParcelSet(
        random_positions(length, np.ones(n), rng),
        maxwell_velocities(1.0, np.ones(n), rng),
        length=length,
        walls=walls,
        rotation=2.0,
        rotational_energy=np.ones(n),
        gravity=0.05,
        driver=Breath(25.0, 200.0),
    )
    worst = 0.0
    for _ in range(50):
        contacts_pass(gas, 4e4)
        worst = max(worst, gas.ledger())
    exchanged = (float(np.sum(np.abs(gas.wall_heat))) + abs(gas.work)) / sum(gas.energy())
    found.bound(f"what is missing from the ledger in {rounded(gas.contacts, 3)} collisions", worst, LEDGER_LIMIT)
    found.number("exchanged", rounded(exchanged))
    found.number("missing", rounded(worst))


def distance(values: np.ndarray, cumulative: np.ndarray) -> float:
    """Return how far the share of values below each of them is from a cumulative distribution there."""
    return float(np.max(np.abs(cumulative - (np.arange(values.size) + 0.5) / values.size)))


@job("emission")
def emission(found: Findings) -> None:
    """Let points fall side by side onto a warm floor; each has hit it once when they are looked at."""
    n = 200_000
    rng = np.random.default_rng(4)
    position = rng.random((n, 3)) * [1.0, 1.0, 0.1]
    velocity = np.zeros((n, 3))
    velocity[:, 2] = -1.0
    length = (1.0, 1.0, 20.0)
    floor = (Specular(),) * 4 + (HeatBath(1.0), Specular())
    gas = ParcelSet(position, velocity, length=length, walls=floor, diameter=0.0, rotation=2.0, seed=4)
    gas.advance(0.11)
    if gas.wall_hits[4] != n or gas.wall_hits[5]:
        raise RuntimeError("not every molecule has hit the floor once")
    snapshot = gas.snapshot()
    normal, along = np.sort(snapshot.velocity[:, 2]), np.sort(snapshot.velocity[:, 0])
    limit = float(kolmogorov_smirnov_critical(n, 0.001))
    found.bound(
        "distance from Rayleigh's distribution, speed away from the wall",
        distance(normal, -np.expm1(-0.5 * normal**2)),
        limit,
    )
    cumulative = np.array([0.5 * math.erfc(-u / math.sqrt(2.0)) for u in along])
    found.bound("distance from Gauss's distribution, velocity along the wall", distance(along, cumulative), limit)
    taken = 0.5 * np.sum(snapshot.velocity**2, axis=1) + snapshot.rotational_energy
    found.agree(
        "mean speed away from the wall",
        float(normal.mean()),
        float(normal.std() / math.sqrt(n)),
        float(theory.emission_normal_speed(1.0, 1.0)),
        unit="√(kT/m)",
    )
    found.agree(
        "mean energy of a molecule that leaves",
        float(taken.mean()),
        float(taken.std() / math.sqrt(n)),
        float(theory.emission_energy(1.0, 3, 2)),
        unit="kT",
    )


@job("slab")
def slab(found: Findings) -> None:
    """Let points that never meet fly between a wall of 4 kT and one of 1 kT."""
    n, layers = 4000, 8
    rng = np.random.default_rng(6)
    walls = (Specular(),) * 4 + (HeatBath(4.0), HeatBath(1.0))
    gas = ParcelSet(
        rng.random((n, 3)),
        maxwell_velocities(2.0, np.ones(n), rng),
        length=(1.0, 1.0, 1.0),
        walls=walls,
        diameter=0.0,
        seed=6,
    )
    answer = theory.free_molecular_slab(4.0, 1.0, float(n), 1.0)
    gas.advance(30.0)
    heat, warmth = [], []
    for _ in range(200):
        before, start = gas.wall_heat, gas.time
        seen = []
        for _ in range(5):
            gas.advance(gas.time + 1.0)
            sample = layer_sample(gas, gas.snapshot(), layers)
            seen.append(2.0 * sample.energy / sample.freedom)
        gave = gas.wall_heat - before
        heat.append(0.5 * (gave[4] - gave[5]) / (gas.time - start))
        warmth.append(np.mean(seen, axis=0))
    flux, layer = block_average(heat), block_average(warmth)
    found.agree(
        "heat flux",
        float(flux.mean) / n,
        float(flux.standard_error) / n,
        float(answer.heat_flux) / n,
        unit="n kT √(kT/m)",
    )
    for name, i in (("by the warm wall", 0), ("by the cold wall", layers - 1)):
        found.agree(
            f"temperature {name}", float(layer.mean[i]), float(layer.standard_error[i]), float(answer.kT), unit="kT"
        )

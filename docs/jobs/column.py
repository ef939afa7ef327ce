"""Columns of molecules in gravity."""

import numpy as np
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.engine import HeatBath, ParcelSet, Periodic, Specular, maxwell_velocities, random_positions
from atmosbox.engine.core.measure import layer_sample
from atmosbox.scene.statistics import block_average

LAYERS = 20


def watched(
    gas: ParcelSet, settle: float, step: float, frames: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return, frame by frame, molecules and temperature of each layer, force on floor less ceiling, and mean height."""
    gas.advance(settle)
    number, warmth, force, height = [], [], [], []
    for _ in range(frames):
        before, start = gas.wall_impulse, gas.time
        count, energy, freedom, middle = np.zeros(LAYERS), np.zeros(LAYERS), np.zeros(LAYERS), []
        for _ in range(4):
            gas.advance(gas.time + 0.25 * step)
            snapshot = gas.snapshot()
            sample = layer_sample(gas, snapshot, LAYERS)
            count, energy, freedom = count + 0.25 * sample.number, energy + sample.energy, freedom + sample.freedom
            middle.append(float(snapshot.position[:, 2].mean()))
        given = (gas.wall_impulse - before) / (gas.time - start)
        number.append(count)
        warmth.append(2.0 * energy / np.maximum(freedom, 1.0))
        force.append(given[4] - given[5])
        height.append(float(np.mean(middle)))
    return np.array(number), np.array(warmth), np.array(force), np.array(height)


@job("barometric")
def barometric(found: Findings) -> None:
    """Let points fly above a warm floor: they never meet, and thin by the barometric law all the same."""
    n, top = 5000, 5.0
    rng = np.random.default_rng(3)
    length = (1.0, 1.0, top)
    position = random_positions(length, np.zeros(n), rng, scale_height=1.0)
    walls = (Specular(),) * 4 + (HeatBath(1.0), Specular())
    gas = ParcelSet(
        position,
        maxwell_velocities(1.0, np.ones(n), rng),
        length=length,
        walls=walls,
        diameter=0.0,
        gravity=1.0,
        seed=3,
    )
    number, _, force, height = watched(gas, 50.0, 10.0, 200)
    edges = np.linspace(0.0, top, LAYERS + 1)
    expected = theory.hydrostatic_layers(edges, float(n), 0.0, top, 1.0, 1.0, 1.0) * np.diff(edges)
    counted, pushed, middle = block_average(number), block_average(force), block_average(height)
    for i in (0, 8, 16):
        found.agree(
            f"share of the molecules between {edges[i]:.2f} and {edges[i + 1]:.2f} scale heights",
            float(counted.mean[i]) / n,
            float(counted.standard_error[i]) / n,
            float(expected[i]) / n,
        )
    worst = float(np.max(np.abs(counted.mean - expected) / counted.standard_error))
    found.bound(f"largest difference of a layer, of {LAYERS}, in standard errors", worst, 4.0)
    found.agree(
        "mean height",
        float(middle.mean),
        float(middle.standard_error),
        float(theory.column_mean_height(top, 1.0, 1.0, 1.0)),
        unit="scale heights",
    )
    found.agree("floor less ceiling over the weight", float(pushed.mean) / n, float(pushed.standard_error) / n, 1.0)


@job("hydrostatic")
def hydrostatic(found: Findings) -> None:
    """Watch a crowded column without heat bath: it is hydrostatic with the room that molecules take, and isothermal.

    Against the floor molecules stand in layers, which no theory of a smooth fluid has; so the column of theory is the
    part above six diameters, with the molecules that are there.
    """
    n, side, top, base = 900, 8.0, 40.0, 3
    rng = np.random.default_rng(8)
    length = (side, side, top)
    position = random_positions(length, np.ones(n), rng, periodic=(True, True, False), scale_height=14.0)
    walls = (Periodic(),) * 4 + (Specular(), Specular())
    gas = ParcelSet(position, maxwell_velocities(1.0, np.ones(n), rng), length=length, walls=walls, gravity=0.1, seed=8)
    number, warmth, force, _ = watched(gas, 800.0, 25.0, 200)
    kT = float(np.sum(number * warmth) / np.sum(number))
    edges = np.linspace(0.0, top, LAYERS + 1)
    counted, warm, pushed = block_average(number), block_average(warmth), block_average(force)
    above = float(counted.mean[base:].sum()) / side**2
    theirs = edges[base:]
    expected = (
        theory.hydrostatic_layers(theirs, above, theirs[0], top - 0.5, kT, 1.0, 0.1, 1.0) * side**2 * np.diff(theirs)
    )
    found.number("packing", f"{float(counted.mean[1]) / (side**2 * edges[1]) * np.pi / 6.0:.2f}")
    for i in (base, 8, 14):
        share = expected[i - base]
        found.agree(
            f"molecules between {edges[i]:g} and {edges[i + 1]:g} diameters over those expected",
            float(counted.mean[i] / share),
            float(counted.standard_error[i] / share),
            1.0,
        )
    for i in (1, 8, 14):
        found.agree(
            f"temperature between {edges[i]:g} and {edges[i + 1]:g} diameters over that of the column",
            float(warm.mean[i]) / kT,
            float(warm.standard_error[i]) / kT,
            1.0,
        )
    found.agree(
        "floor less ceiling over the weight",
        float(pushed.mean) / (0.1 * n),
        float(pushed.standard_error) / (0.1 * n),
        1.0,
    )

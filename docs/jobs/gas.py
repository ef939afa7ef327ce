"""The gas in a box without walls: its pressure, and how often its molecules collide."""

import math

import numpy as np
from jobs.drawing import axes_of, explain, save
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.engine import ParcelSet, Periodic, maxwell_velocities, random_positions
from atmosbox.scene.statistics import block_average

BLOCKS = 40


def cube(n: int, packing: float, seed: int) -> ParcelSet:
    """Return a periodic cube of spheres with Maxwell's velocities at kT = 1."""
    rng = np.random.default_rng(seed)
    side = (math.pi / 6.0 * n / packing) ** (1.0 / 3.0)
    length = (side, side, side)
    position = random_positions(length, np.ones(n), rng, periodic=(True,) * 3)
    velocity = maxwell_velocities(1.0, np.ones(n), rng, exact=True)
    return ParcelSet(position, velocity, length=length, walls=(Periodic(),) * 6, seed=seed)


def contacts_pass(parcel: ParcelSet, number: float) -> None:
    """Let time pass until so many more contacts have happened, within a hundredth or so."""
    goal = parcel.contacts + number
    begun, start = parcel.time, parcel.contacts
    parcel.advance(parcel.time + 0.1 / max(parcel.number, 1) ** (1.0 / 3.0))
    while parcel.contacts < goal:
        rate = max(parcel.contacts - start, 1) / (parcel.time - begun)
        step = (goal - parcel.contacts) / rate
        parcel.advance(parcel.time + min(max(step, 1e-3 * number / rate), 2.0 * (parcel.time - begun)))


def pressure_and_rate(packing: float, contacts: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Z and the collisions of a molecule per time, in blocks, of 2000 spheres in equilibrium.

    Total momentum is zero, so n molecules have the thermal energy of n - 1.
    """
    n = 2000
    gas = cube(n, packing, seed)
    contacts_pass(gas, 200.0 * n)
    energy = sum(gas.energy())
    kT = 2.0 * energy / (3.0 * (n - 1))
    before, began = gas.contacts, gas.time
    contacts_pass(gas, 0.02 * contacts)
    step = (contacts / BLOCKS) * (gas.time - began) / (gas.contacts - before)
    z, rate = [], []
    for _ in range(BLOCKS):
        met, virial, start = gas.contacts, float(gas.virial.sum()), gas.time
        gas.advance(start + step)
        z.append(1.0 + (float(gas.virial.sum()) - virial) / step / (3.0 * (n - 1) * kT))
        rate.append(2.0 * (gas.contacts - met) / step / n / math.sqrt(kT))
    return np.array(z), np.array(rate)


@job("equation-of-state")
def equation_of_state(found: Findings) -> None:
    """Measure pressure and collision rate of hard spheres from a thin gas to the brink of freezing."""
    cases = {0.01: 4e6, 0.1: 4e6, 0.3: 6e6, 0.494: 1.2e7}
    points = []
    for packing, contacts in cases.items():
        z, rate = (block_average(values, BLOCKS) for values in pressure_and_rate(packing, contacts, seed=11))
        density = packing * 6.0 / math.pi
        expected = float(theory.compressibility_factor(packing))
        often = float(theory.collision_rate(density, 1.0, 1.0, 1.0))
        found.agree(
            f"Z at φ = {packing:g}",
            float(z.mean),
            float(z.standard_error),
            expected,
            limit=0.003 * expected,
            tolerance=2.0 * (expected - 1.0) / 2000,
        )
        found.agree(
            f"collisions of a molecule at φ = {packing:g}",
            float(rate.mean),
            float(rate.standard_error),
            often,
            unit="√(kT/m)/σ",
            limit=0.003 * often,
            tolerance=2.0 * often / 2000,
        )
        points.append((packing, float(z.mean), float(z.standard_error)))
        found.number(f"misfit-{packing:g}", f"{100.0 * (float(z.mean) / expected - 1.0):+.2f} %".replace("-", "−"))
    draw_equation_of_state(found, np.array(points))


def draw_equation_of_state(found: Findings, points: np.ndarray) -> None:
    """Draw Z against packing fraction, and how far it is from theory."""
    packing = np.linspace(0.0, 0.494, 200)
    with axes_of(2, (9.0, 4.6)) as (drawing, (left, right)):
        left.plot(
            packing,
            theory.compressibility_factor(packing),
            "--",
            color="#1a1a1a",
            label="Kolafa, Labík, Malijevský 2004",
        )
        left.plot(packing, 1.0 + 4.0 * packing, ":", color="#595959", label="1 + 4φ, a thin gas")
        left.plot(points[:, 0], points[:, 1], "o", label="molecules")
        left.set(
            title="Excluded volume raises the pressure",
            xlabel="packing fraction φ",
            ylabel="Z = p / n k T",
            xlim=(0.0, 0.51),
            ylim=(0.0, 13.5),
        )
        left.legend(loc="upper left")
        expected = theory.compressibility_factor(points[:, 0])
        right.axhline(0.0, ls="--", color="#1a1a1a", label="theory")
        share = 100.0 * (
            theory.compressibility_factor(packing, "carnahan-starling") / theory.compressibility_factor(packing) - 1.0
        )
        right.plot(packing, share, "-.", color="#009e73", label="Carnahan and Starling 1969")
        right.errorbar(
            points[:, 0],
            100.0 * (points[:, 1] / expected - 1.0),
            100.0 * points[:, 2] / expected,
            fmt="o",
            capsize=3,
            label="molecules",
        )
        right.set(
            title="The difference from theory",
            xlabel="packing fraction φ",
            ylabel="measured minus theory, % of Z",
            xlim=(0.0, 0.51),
            ylim=(-0.4, 0.4),
        )
        right.legend(loc="upper left")
        explain(drawing)
        save(found, drawing, "equation-of-state")

"""The gas in a box without walls: its pressure, how often molecules meet, how fast they are, and who has the energy."""

import math

import numpy as np
from jobs.drawing import axes_of, explain, save
from jobs.registry import Findings, job

from atmosbox import theory
from atmosbox.engine import ParcelSet, Periodic, equal_speeds, maxwell_velocities, random_positions
from atmosbox.engine.core.measure import temperature
from atmosbox.scene.statistics import block_average, kolmogorov_smirnov_critical

OPEN = (Periodic(),) * 6
BLOCKS = 40


def cube(n: int, packing: float, seed: int, *, diameter=1.0, mass=1.0, speeds=None, **more) -> ParcelSet:
    """Return a periodic cube of spheres with Maxwell's velocities at kT = 1, unless others are given."""
    rng = np.random.default_rng(seed)
    sigma = np.broadcast_to(np.asarray(diameter, float), n)
    masses = np.broadcast_to(np.asarray(mass, float), n)
    side = (float(np.sum(math.pi / 6.0 * sigma**3)) / packing) ** (1.0 / 3.0)
    length = (side, side, side)
    position = random_positions(length, sigma, rng, periodic=(True,) * 3)
    velocity = maxwell_velocities(1.0, masses, rng, exact=True) if speeds is None else equal_speeds(speeds, n, rng)
    if speeds is not None:
        velocity -= (masses[:, None] * velocity).sum(axis=0) / masses.sum()
    return ParcelSet(position, velocity, length=length, walls=OPEN, diameter=sigma, mass=masses, seed=seed, **more)


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


@job("maxwell")
def maxwell(found: Findings) -> None:
    """Start two thousand molecules at one speed: a few collisions later their speeds are Maxwell's."""
    n, snapshots = 2000, 100
    gas = cube(n, 0.05, 3, speeds=math.sqrt(3.0))
    contacts_pass(gas, 20.0 * n)
    speeds = []
    for _ in range(snapshots):
        contacts_pass(gas, 2.5 * n)
        speeds.append(np.sqrt(np.sum(gas.snapshot().velocity ** 2, axis=1)))
    kT = temperature(gas, gas.snapshot()) * n / (n - 1)
    speed = np.sort(np.concatenate(speeds))
    share = theory.maxwell_speed_cumulative(speed, kT, 1.0)
    steps = np.arange(speed.size + 1) / speed.size
    distance = float(max(np.max(steps[1:] - share), np.max(share - steps[:-1])))
    limit = float(kolmogorov_smirnov_critical(speed.size, 0.001))
    found.bound(f"greatest distance of the cumulative distributions, {speed.size:,} speeds", distance, limit)
    found.number("speeds", f"{speed.size:,}")


@job("equipartition")
def equipartition(found: Findings) -> None:
    """Start five hundred molecules of mass 1 and as many of mass 100 at one speed."""
    n = 1000
    mass = np.where(np.arange(n) < n // 2, 1.0, 100.0)
    gas = cube(n, 0.05, 5, mass=mass, speeds=1.0)
    contacts_pass(gas, 150.0 * n)
    values = []
    for _ in range(400):
        contacts_pass(gas, 2.0 * n)
        energy = 0.5 * mass * np.sum(gas.snapshot().velocity ** 2, axis=1)
        values.append([energy[: n // 2].mean(), energy[n // 2 :].mean()])
    share = np.array(values)
    share /= share.mean(axis=1)[:, None]
    mean, error = block_average(share)
    found.agree("energy of a molecule of mass 1 over the mean", float(mean[0]), float(error[0]), 1.0)
    found.agree("energy of a molecule of mass 100 over the mean", float(mean[1]), float(error[1]), 1.0)


@job("larsen-borgnakke")
def larsen_borgnakke(found: Findings) -> None:
    """Start molecules of air without rotation: in the end it has two fifths of the energy."""
    n = 2000
    gas = cube(n, 0.02, 7, rotation=2.0)
    contacts_pass(gas, 20.0 * n)
    ratio, spins = [], []
    for _ in range(200):
        contacts_pass(gas, 2.0 * n)
        kinetic, rotational, _ = gas.energy()
        ratio.append(kinetic / rotational)
        spins.append(gas.snapshot().rotational_energy)
    mean, error = block_average(ratio)
    found.agree("energy of translation over that of rotation", float(mean), float(error), 1.5, tolerance=2.0 / n)
    spin = np.sort(np.concatenate(spins))
    share = -np.expm1(-spin / spin.mean())
    distance = float(np.max(np.abs(share - (np.arange(spin.size) + 0.5) / spin.size)))
    limit = float(kolmogorov_smirnov_critical(spin.size, 0.001))
    found.bound(f"greatest distance from an exponential distribution, {spin.size:,} rotations", distance, limit)


def counted_and_expected(gas: ParcelSet, members: list[np.ndarray], contacts: float) -> list[float]:
    """Return contacts counted over contacts expected of a mixture of two, in 20 blocks.

    Molecules of mass 1 and 10^6 hardly exchange energy, so that each kind keeps the temperature of its start; the
    lighter kind's sets the pace.
    """
    light = gas.mass == gas.mass.min()
    number = np.array([each.sum() for each in members])
    density = number / gas.volume
    sizes, masses = ([float(values[each][0]) for each in members] for values in (gas.diameter, gas.mass))
    # a molecule does not meet itself: among its like it has one partner less
    rate = theory.collision_rate_between(density, sizes, masses, 1.0) * (1.0 - np.diag(1.0 / number))
    per_time = float(0.5 * np.sum(density[:, None] * rate)) * gas.volume
    shares = []
    for _ in range(20):
        before, looks, weights = gas.contacts, 5, []
        for _ in range(looks):
            gas.advance(gas.time + contacts / (20 * looks) / per_time)
            speed = gas.snapshot().velocity[light]
            weights.append(math.sqrt(float(gas.mass[light][0] * np.mean(np.sum(speed**2, axis=1))) / 3.0))
        shares.append((gas.contacts - before) * 20 / contacts / float(np.mean(weights)))
    return shares


@job("unlike-molecules")
def unlike_molecules(found: Findings) -> None:
    """Count how often molecules meet whose masses differ by a million, or whose sizes differ by a hundred."""
    half, few = np.arange(1000) < 500, np.arange(4010) < 10
    cases = {
        "masses 1 : 10⁶": (half, np.ones(1000), np.where(half, 1.0, 1e6), 0.05),
        "sizes 1 : 100": (few, np.where(few, 100.0, 1.0), np.ones(4010), 0.10),
    }
    for what, (first, sigma, mass, packing) in cases.items():
        gas = cube(sigma.size, packing, 9, diameter=sigma, mass=mass)
        contacts_pass(gas, 1e5)
        mean, error = block_average(counted_and_expected(gas, [first, ~first], 1e6))
        found.agree(f"contacts over those expected, {what}", float(mean), float(error), 1.0, limit=0.01)

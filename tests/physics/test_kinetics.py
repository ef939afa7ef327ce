"""The motion of molecules after many collisions: Maxwell's speeds, equipartition of energy, collision rates.

Means allow 4 standard errors from 20 blocks (a false alarm once in 1 500 for a fresh seed, never for these); tests of
a distribution are Kolmogorov's at a level of 1e-4, from snapshots at least three contacts of each molecule apart.
"""

import math

import numpy as np
import pytest
from scipy import stats

from atmosbox import theory
from atmosbox.engine import Periodic, equal_speeds
from atmosbox.engine.core.measure import speed_counts
from atmosbox.scene.statistics import block_average
from tests.oracle.kinetic_gas import kolmogorov_smirnov_critical

P = Periodic()
LEVEL = 1e-4


def snapshots(box, number, contacts_apart=3.0, warm_up=20.0):
    """Return a number of snapshots, with a number of contacts of every molecule between them."""
    half = 0.5 * box.number
    while box.contacts < warm_up * half:
        box.advance(box.time + 0.05 * box.length[2])
    pace = box.time / box.contacts * contacts_apart * half * 1.2
    taken = []
    for _ in range(number):
        before = box.contacts
        box.advance(box.time + pace)
        assert box.contacts - before >= 0.9 * contacts_apart * half
        taken.append(box.snapshot())
    return taken


def maxwellian(gas, number, samples):
    rng = np.random.default_rng(21)
    side = (number * math.pi / 6.0 / 0.1) ** (1.0 / 3.0)
    box = gas(number, (side,) * 3, seed=21, velocity=equal_speeds(math.sqrt(3.0), number, rng))

    def distance(speed):
        return stats.kstest(speed, lambda v: theory.maxwell_speed_cumulative(v, 1.0, 1.0)).statistic

    def speeds(snapshot):
        return np.sqrt(np.sum(snapshot.velocity**2, axis=1))

    # all start with the same speed, far from Maxwell's distribution
    assert distance(speeds(box.snapshot())) > 0.5
    taken = snapshots(box, samples)
    found = np.concatenate([speeds(snapshot) for snapshot in taken])
    assert distance(found) < kolmogorov_smirnov_critical(found.size, LEVEL)
    for axis in range(3):
        component = np.concatenate([snapshot.velocity[:, axis] for snapshot in taken])
        assert stats.kstest(component, "norm").statistic < kolmogorov_smirnov_critical(found.size, LEVEL)
    # and the histogram that a scene shows is that of these speeds
    edges = np.linspace(0.0, 6.0, 25)
    counts = sum(speed_counts(snapshot, edges) for snapshot in taken)
    expected = found.size * np.diff(theory.maxwell_speed_cumulative(edges, 1.0, 1.0))
    enough = expected > 10.0
    chi_squared = np.sum((counts - expected)[enough] ** 2 / expected[enough])
    assert stats.chi2.sf(chi_squared, enough.sum()) > LEVEL
    return found.size


@pytest.mark.parametrize(("number", "samples"), [(1000, 20), pytest.param(5000, 200, marks=pytest.mark.nightly)])
def test_molecules_of_one_speed_become_maxwells(gas, number, samples):
    assert maxwellian(gas, number, samples) == number * samples


@pytest.mark.parametrize(("ratio", "planar"), [(4.0, False), (100.0, False), (20.0, True)])
def test_heavy_and_light_molecules_have_the_same_energy(gas, ratio, planar):
    number, heavy, sides = 300, 60, (35.0, 1.0, 35.0) if planar else (11.0,) * 3
    mass = np.where(np.arange(number) < heavy, ratio, 1.0)
    # all energy starts in the light ones
    velocity = equal_speeds(1.0, number, np.random.default_rng(23))
    velocity[:, 1] *= not planar
    velocity[:heavy] = 0.0
    freedom = 2.0 if planar else 3.0
    velocity *= math.sqrt(freedom * number / np.sum(mass[:, None] * velocity**2))
    box = gas(number, sides, seed=23, mass=mass, velocity=velocity, planar=planar)
    energies = []
    # a heavy molecule takes about its mass over four light ones' contacts to warm
    for snapshot in snapshots(box, 2000, warm_up=20.0 + 5.0 * ratio):
        energy = 0.5 * mass * np.sum(snapshot.velocity**2, axis=1)
        energies.append([energy[:heavy].mean(), energy[heavy:].mean()])
    mean, error = block_average(energies)
    assert (error < 0.02).all()
    # with walls only energy is conserved, not momentum, so each has exactly its share
    assert (np.abs(mean - 0.5 * freedom) <= 4.0 * error).all()


MIXTURES = {
    "two masses": {"share": 0.3, "diameter": (1.0, 1.0), "mass": (1.0, 50.0)},
    "two sizes": {"share": 0.2, "diameter": (1.0, 2.0), "mass": (1.0, 1.0)},
    "few heavy giants": {"share": 0.02, "diameter": (1.0, 4.0), "mass": (1.0, 64.0)},
}


@pytest.mark.parametrize(
    "name", ["two masses", "two sizes", pytest.param("few heavy giants", marks=pytest.mark.nightly)]
)
def test_a_mixture_meets_as_often_as_theory_says(gas, name):
    mixture, number = MIXTURES[name], 500
    second = np.arange(number) < mixture["share"] * number
    diameter = np.where(second, mixture["diameter"][1], mixture["diameter"][0])
    mass = np.where(second, mixture["mass"][1], mixture["mass"][0])
    side = float(np.sum(math.pi / 6.0 * diameter**3) / 0.1) ** (1.0 / 3.0)
    box = gas(number, (side,) * 3, walls=(P,) * 6, seed=24, diameter=diameter, mass=mass)
    members = np.array([np.sum(~second), np.sum(second)])
    rate = theory.collision_rate_between(members / side**3, mixture["diameter"], mixture["mass"], 1.0)
    # a molecule does not collide with itself
    rate *= 1.0 - np.eye(2) / members
    expected = 0.5 * float(np.sum(members[:, None] * rate)) * math.sqrt(number / (number - 1.0))
    box.advance(30.0 * number / expected * 10.0)
    rates = []
    for _ in range(20):
        before = box.contacts
        box.advance(box.time + 20_000.0 / expected)
        rates.append((box.contacts - before) / (20_000.0 / expected))
    measured, error = block_average(rates)
    assert box.contacts > 400_000
    assert error / expected < 0.003
    # the contact values of mixtures are themselves good to 1 part in 500 here
    assert abs(measured / expected - 1.0) <= 4.0 * error / expected + 0.002
    only_light = 0.5 * members[0] * rate[0, 0]
    assert expected > 1.1 * only_light

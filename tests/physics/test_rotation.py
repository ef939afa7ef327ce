"""Molecules that rotate, so that air has 5 degrees of freedom: exchange of energy by Larsen and Borgnakke's method.

Means allow 4 standard errors from 20 blocks (a false alarm once in 1 500 for a fresh seed, never for these); tests of
a distribution are Kolmogorov's at a level of 1e-4.
"""

import math

import numpy as np
import pytest
from scipy import stats

from atmosbox.engine import Periodic, Piston, Specular
from atmosbox.scene.statistics import block_average
from tests.oracle.kinetic_gas import kolmogorov_smirnov_critical
from tests.physics.conftest import EVERYTHING


def shares(box, warm_up, step, samples):
    """Return the block average of kinetic and rotational energy per molecule."""
    box.advance(warm_up)
    rows = []
    for _ in range(samples):
        box.advance(box.time + step)
        rows.append(np.array(box.energy()[:2]) / box.number)
    return block_average(np.array(rows))


@pytest.mark.parametrize(
    ("rotation", "collision_number", "planar"),
    [
        (2, 5.0, False),
        (3, 1.0, False),
        (2, 1.0, True),
        *(pytest.param(*case, False, marks=pytest.mark.nightly) for case in ((2, 1.0), (3, 5.0))),
    ],
)
def test_motion_and_rotation_share_the_energy_by_their_degrees_of_freedom(gas, rotation, collision_number, planar):
    flies = 2.0 if planar else 3.0
    # all energy starts as translation
    box = gas(
        400, (40.0, 1.0, 40.0) if planar else (12.0,) * 3, kT=(flies + rotation) / flies, spin_kT=0.0, planar=planar,
        rotation=rotation, collision_number=collision_number, seed=61,
        **EVERYTHING | ({"walls": (Periodic(),) * 2 + (Specular(),) * 3 + (Piston(),)} if planar else {}),
    )  # fmt: skip
    assert box.degrees_of_freedom == flies + rotation
    assert box.energy()[1] == 0.0
    before = sum(box.energy())
    mean, error = shares(box, *((200.0, 5.0, 2000) if planar else (100.0, 3.0, 1000)))
    assert sum(box.energy()) == pytest.approx(before, rel=1e-12)
    assert box.contacts > 200_000
    assert (error < 0.01).all()
    # 3 : 2 for air, of 5/2 kT
    assert (np.abs(mean - [0.5 * flies, 0.5 * rotation]) <= 4.0 * error).all()


@pytest.mark.parametrize(("rotation", "shape"), [(2, 1.0), (3, 1.5)])
def test_rotational_energies_are_those_of_a_heat_bath_and_speeds_maxwells(gas, rotation, shape):
    number = 1000
    box = gas(number, (16.0,) * 3, kT=(3.0 + rotation) / 3.0, spin_kT=0.0, rotation=rotation, seed=62, **EVERYTHING)
    box.advance(30.0)
    spin, speed = [], []
    for _ in range(20):
        before = box.contacts
        box.advance(box.time + 3.0)
        assert box.contacts - before > 2 * number
        here = box.snapshot()
        spin.append(here.rotational_energy)
        speed.append(here.velocity[:, 0])
    spin, speed = np.concatenate(spin), np.concatenate(speed)
    # two degrees of freedom: exponential
    critical = kolmogorov_smirnov_critical(spin.size, 1e-4)
    assert stats.kstest(spin, "gamma", args=(shape,)).statistic < critical
    assert stats.kstest(speed, "norm").statistic < critical
    assert abs(np.corrcoef(spin, speed**2)[0, 1]) < 4.0 / math.sqrt(spin.size)


@pytest.mark.parametrize("collision_number", [1.0, 4.0, 20.0])
def test_rotation_warms_at_the_rate_that_the_collision_number_sets(gas, collision_number):
    # relative motion counts as 4 degrees of freedom and the rotations as 2 + 2: they get half of a pair's energy
    number, runs, length = 2000, 20, (25.0,) * 3
    gained = []
    for seed in range(runs):
        box = gas(number, length, spin_kT=0.0, rotation=2, collision_number=collision_number, seed=seed, **EVERYTHING)
        while box.contacts < 60:
            box.advance(box.time + 0.01)
        # so few that hardly any molecule has collided twice
        gained.append(box.energy()[1] / box.contacts)
    mean, error = np.mean(gained), np.std(gained, ddof=1) / math.sqrt(runs)
    # contacts are proportional to relative speed, which makes their mean relative energy 2 kT
    exact = 1.0 / collision_number
    assert abs(mean - exact) <= 4.0 * error + 0.05 * exact
    assert error < 0.3 * exact


def test_rotating_and_plain_molecules_come_to_one_temperature(gas):
    number = 400
    rotation = np.where(np.arange(number) < number // 2, 0.0, 2.0)
    mass = np.where(np.arange(number) < number // 2, 1.0, 7.0)
    box = gas(number, (13.0,) * 3, kT=4.0 / 3.0, spin_kT=0.0, rotation=rotation, mass=mass, seed=64, **EVERYTHING)
    assert box.degrees_of_freedom == 4.0
    box.advance(200.0)
    rows = []
    for _ in range(1000):
        box.advance(box.time + 4.0)
        here = box.snapshot()
        kinetic = 0.5 * mass * np.sum(here.velocity**2, axis=1)
        rows.append(
            [kinetic[rotation == 0.0].mean(), kinetic[rotation == 2.0].mean(), here.rotational_energy.sum() / 200.0]
        )
        assert here.rotational_energy[rotation == 0.0].max() == 0.0
    mean, error = block_average(rows)
    assert (error < 0.02).all()
    assert (np.abs(mean - [1.5, 1.5, 1.0]) <= 4.0 * error).all()

"""Molecules scattered at random: inside their walls, without overlap, and with the density of an atmosphere."""

import math

import numpy as np
import pytest

from atmosbox import theory
from atmosbox.engine import ParcelSet, Periodic, RandomNumbers, maxwell_velocities, random_positions
from tests.engine.boxes import apart


@pytest.mark.parametrize("periodic", [(False,) * 3, (True, True, False), (True,) * 3])
def test_scattered_molecules_are_apart_and_inside_their_walls(periodic):
    sides = np.array([8.0, 9.0, 10.0])
    x = random_positions(tuple(sides), np.ones(400), np.random.default_rng(1), periodic=periodic)
    assert apart(x, x, sides, periodic)[np.triu_indices(400, 1)].min() >= 1.0
    wall = np.where(periodic, 0.0, 0.5)
    assert (x >= wall).all()
    assert (x <= sides - wall).all()


def test_points_thin_out_with_height_as_an_isothermal_atmosphere():
    number, height, scale = 40_000, 3.0, 1.0
    x = random_positions((1.0, 1.0, height), np.zeros(number), np.random.default_rng(6), scale_height=scale)
    blocks = x[:, 2].reshape(20, -1).mean(axis=1)
    error = blocks.std(ddof=1) / math.sqrt(20)
    # the mean of an exponential that is cut off; 4 standard errors of 20 blocks are a false alarm in 1 of 1300 seeds
    expected = scale - height / math.expm1(height / scale)
    assert abs(blocks.mean() - expected) <= 4.0 * error
    assert error < 0.01


@pytest.mark.parametrize("packing", [0.02, 0.1])
def test_molecules_collide_from_the_first_moment_as_often_as_in_equilibrium(packing):
    number, runs = 1000, 40
    side = (number * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    rate = float(theory.collision_rate(number / side**3, 1.0, 1.0, 1.0))
    contacts = np.zeros(runs)
    for seed in range(runs):
        rng = RandomNumbers(seed)
        x = random_positions((side,) * 3, np.ones(number), rng, periodic=(True,) * 3)
        v = maxwell_velocities(1.0, np.ones(number), rng, exact=True)
        gas = ParcelSet(x, v, length=(side,) * 3, walls=(Periodic(),) * 6)
        gas.advance(0.25 / rate)
        contacts[seed] = gas.contacts
    error = contacts.std(ddof=1) / math.sqrt(runs)
    assert abs(contacts.mean() - 0.125 * number) <= 4.0 * error
    assert error < 0.02 * 0.125 * number

"""Conservation at contacts, walls and pistons: energy, momentum, and the energy budget.

These are identities of every single run, to rounding: nothing here is statistical.
"""

import numpy as np
import pytest

from atmosbox.engine import HeatBath, Periodic, Piston

P = Periodic()


@pytest.mark.parametrize("contacts", [3e5, pytest.param(1e7, marks=pytest.mark.nightly)])
def test_energy_is_kept_to_rounding_with_gravity_and_walls(gas, contacts):
    box = gas(400, (11.0, 11.0, 14.0), gravity=0.1, seed=1)
    before = sum(box.energy())
    for share in np.linspace(0.05, 1.0, 20):
        while box.contacts < share * contacts:
            box.advance(box.time + 0.002 * contacts / 400.0)
        assert abs(sum(box.energy()) / before - 1.0) <= 1e-12
    assert box.wall_hits.min() > 100


def test_the_energy_budget_closes_with_heat_baths_a_piston_and_rotation(gas):
    mass = [1.0, 1.5] * 150
    walls = (HeatBath(1.5), HeatBath(0.7), P, P, HeatBath(1.0, 0.5), Piston())
    box = gas(300, (9.0, 9.0, 9.0), walls=walls, rotation=2, gravity=0.05, diameter=0.8, mass=mass, seed=2)
    exchanged = 0.0
    for stroke in range(20):
        box.set_piston_velocity(-0.1 if stroke % 2 else 0.1)
        heat, work = box.wall_heat, box.work
        box.advance(box.time + 10.0)
        exchanged += float(np.abs(box.wall_heat - heat).sum()) + abs(box.work - work)
        assert box.ledger() <= 1e-10
    # much more energy than the gas has went in and out
    assert exchanged > 5.0 * sum(box.energy())
    assert box.wall_hits[5] > 1000
    assert box.contacts > 50_000


def scattered_pairs():
    """Return impact parameters in diameters, and many pairs far apart, each about to have its one contact."""
    rng = np.random.default_rng(7)
    b = np.sqrt(rng.random(4096))
    azimuth = 2.0 * np.pi * rng.random(b.size)
    corner = np.stack(np.meshgrid(*[12.0 * np.arange(16)] * 3, indexing="ij"), axis=-1).reshape(-1, 3) + 4.0
    target = corner + np.stack([3.0 + 0.0 * b, b * np.cos(azimuth), b * np.sin(azimuth)], axis=1)
    x = np.concatenate([corner, target])
    v = np.zeros_like(x)
    v[: b.size, 0] = 1.0
    return b, x, v


@pytest.mark.parametrize("masses", [(1.0, 1.0), (1.0, 3.0), (100.0, 1.0)])
def test_a_pair_scatters_as_mechanics_says_and_keeps_all_that_it_must(gas, masses):
    b, x, v = scattered_pairs()
    mass = np.repeat(masses, b.size)
    box = gas(mass.size, (192.0,) * 3, mass=mass, seed=7, position=x, velocity=v)
    box.advance(3.5)
    assert box.contacts == b.size
    after = box.snapshot()
    m1, m2 = masses
    (x1, x2), (v1, v2) = after.position.reshape(2, -1, 3), after.velocity.reshape(2, -1, 3)
    p = m1 * v1 + m2 * v2
    assert np.abs(p - [m1, 0.0, 0.0]).max() <= 1e-14 * m1
    assert np.abs(m1 * np.sum(v1**2, axis=1) + m2 * np.sum(v2**2, axis=1) - m1).max() <= 1e-13 * m1
    start = x.reshape(2, -1, 3)
    origin = start[0]
    spin = m1 * np.cross(x1 - origin, v1) + m2 * np.cross(x2 - origin, v2)
    assert np.abs(spin).max() <= 1e-11 * m1
    relative = v1 - v2
    deflection = np.arccos(np.clip(relative[:, 0], -1.0, 1.0))
    assert deflection == pytest.approx(np.pi - 2.0 * np.arcsin(b), abs=1e-6)
    assert relative[:, 0] == pytest.approx(2.0 * b**2 - 1.0, abs=1e-11)

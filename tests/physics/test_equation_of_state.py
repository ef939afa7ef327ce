"""Pressure and collision rate of hard spheres: against published molecular dynamics, at every density of a fluid.

The pressure is measured twice: from the contacts (the virial theorem) and from the walls. Every statistical
comparison allows 4 standard errors, from 20 blocks: a false alarm once in 1 500 for a fresh seed, and never for
these. The difference of N molecules from infinitely many, (Z - 1) / N times 1.5 as measured by others, is added.
"""

import math

import numpy as np
import pytest

from atmosbox.engine import Periodic
from atmosbox.engine.core.measure import mean_free_path
from atmosbox.scene.statistics import block_average
from tests.oracle import kinetic_gas

P = Periodic()
FINITE = 1.5

# packing fraction, Z (Kolafa, Labik, Malijevsky 2004), collision rate per molecule, mean free path
TABLE = [
    (0.01, 1.041019, 0.138854, 11.4924),
    (0.10, 1.521647, 1.765845, 0.903686),
    (0.30, 3.983983, 10.101194, 0.157978),
    (0.494, 12.500092, 38.929393, 0.040991),
]


def series(box, contacts, blocks=20):
    """Return, block by block, the virial and contacts per time and the mean speed, after 50 mean free times."""
    while box.contacts < 25 * box.number:
        box.advance(box.time + 25.0 * box.number / (box.contacts + box.number))
    pace = 0.5 * contacts / blocks * box.time / box.contacts
    virial, rate, speed = [], [], []
    for _ in range(blocks):
        start = box.time, box.virial.sum(), box.contacts
        speeds = []
        for _ in range(10):
            box.advance(box.time + 0.2 * pace)
            speeds.append(np.sqrt(np.sum(box.snapshot().velocity ** 2, axis=1)).mean())
        time = box.time - start[0]
        virial.append((box.virial.sum() - start[1]) / time)
        rate.append((box.contacts - start[2]) / time)
        speed.append(np.mean(speeds))
    return np.array(virial), np.array(rate), np.array(speed)


def compare(gas, row, number, contacts):
    packing, z, rate, path = row
    side = (number * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    box = gas(number, (side,) * 3, walls=(P,) * 6, seed=11)
    virial, meetings, speed = series(box, contacts)
    assert box.contacts > 0.9 * contacts
    kinetic = box.energy()[0]
    assert kinetic == pytest.approx(1.5 * number, rel=1e-12)

    # Z = 1 + W / (3 (N - 1) kT), where 3 (N - 1) kT is twice the energy, because the momentum is zero
    measured, error = block_average(1.0 + virial / (2.0 * kinetic))
    # the scatter of counts and impulses, if they were independent
    assert error < 2.0 * kinetic_gas.compressibility_noise(z, contacts)
    assert abs(measured - z) <= 4.0 * error + FINITE * (z - 1.0) / number

    # in a box of fixed energy and momentum a pair is a little faster than the mean temperature says, and a
    # molecule has N - 1 partners
    finite = kinetic_gas.constant_energy_speed_factor(3 * number - 3) * math.sqrt((number - 1) / number)
    measured, error = block_average(2.0 * meetings / number)
    assert abs(measured / (rate * finite) - 1.0) <= 4.0 * error / rate + FINITE / number

    paths = [mean_free_path(m, number * v) for m, v in zip(meetings, speed, strict=True)]
    measured, error = block_average(paths)
    assert abs(measured / path - 1.0) <= 4.0 * error / path + FINITE / number
    return contacts


@pytest.mark.parametrize(
    ("number", "contacts"), [(500, 3e5), pytest.param(2000, 6e6, marks=pytest.mark.nightly)], ids=["", "long"]
)
@pytest.mark.parametrize("row", TABLE, ids=lambda row: f"phi={row[0]}")
def test_spheres_press_and_meet_as_molecular_dynamics_and_enskog_say(gas, row, number, contacts):
    assert number < 2000 or kinetic_gas.compressibility_noise(row[1], contacts) / (row[1] - 1.0) <= 0.003
    compare(gas, row, number, contacts)


@pytest.mark.parametrize(
    ("packing", "gravity", "planar"),
    [*((packing, gravity, False) for packing in (0.02, 0.1, 0.3) for gravity in (0.0, 0.2)), (0.25, 0.0, True)],
)
def test_the_virial_of_contacts_and_the_impulses_on_walls_are_one_pressure(gas, packing, gravity, planar):
    # d/dt sum(m r . v) = 2 K + contacts + walls + weight holds at every moment, so its integral does for a single run
    number = 200
    wide = math.sqrt(number * math.pi / 4.0 / packing) if planar else (number * math.pi / 6.0 / packing) ** (1.0 / 3.0)
    sides = (wide, 1.0, wide) if planar else (wide,) * 3
    box = gas(number, sides, gravity=gravity, planar=planar, seed=12)

    def product():
        here = box.snapshot()
        return float(np.sum(here.position * here.velocity))

    before, energy = product(), sum(box.energy())
    if gravity == 0.0:
        box.advance(500.0 * packing**0.5)
        height, allowed = 0.0, 1e-11
    else:
        # the integral of the potential energy, by fine trapezes: off by what gravity bends it, and a little at
        # every event, where a slope changes by about 2 m g v
        step = 0.002 / packing**0.5
        potential = [box.energy()[2]]
        for k in range(2000):
            box.advance((k + 1) * step)
            potential.append(box.energy()[2])
        height = step * (sum(potential) - 0.5 * (potential[0] + potential[-1]))
        events = box.contacts + box.wall_hits.sum()
        allowed = step**2 * (number * gravity**2 * box.time + 3.0 * gravity * math.sqrt(events)) / (energy * box.time)
        assert allowed < 1e-4
    along = [0, 2] if planar else [0, 1, 2]
    low, high = box.wall_impulse[::2], box.wall_impulse[1::2]
    walls = float(np.sum((0.5 * low - (box.length - 0.5) * high)[along]))
    assert box.contacts > 1000
    assert box.wall_hits[[0, 1, 4, 5]].min() > 20
    # 2 K minus the potential energy, K + potential being the energy
    surplus = 2.0 * energy * box.time - 3.0 * height + float(box.virial.sum()) + walls - (product() - before)
    assert abs(surplus) <= allowed * energy * box.time


@pytest.mark.nightly  # numba has other kernels for arrays of one
@pytest.mark.parametrize("diameter", [0.0, 1.0])
def test_a_molecule_alone_presses_by_the_room_that_its_centre_has(gas, diameter):
    # N molecules that never meet press with N kT / (A (L - sigma)): here N = 1, exact but for one more or one less hit
    speed = np.array([1.3, 0.7, 2.9])
    side = np.array([5.0, 6.0, 7.0])
    box = gas(1, tuple(side), diameter=diameter, seed=14, velocity=[speed])
    box.advance(1e4)
    force = box.wall_impulse / box.time
    exact = np.repeat(speed**2 / (side - diameter), 2)
    assert np.abs(force - exact).max() <= 2.0 * speed.max() / box.time
    assert box.contacts == 0

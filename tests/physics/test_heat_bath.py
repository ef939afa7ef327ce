"""Heat baths: they hold a gas at their temperature, and heat flows from the warmer to the colder one.

Means allow 4 standard errors from 20 blocks (a false alarm once in 1 500 for a fresh seed, never for these).
"""

import math

import numpy as np
import pytest
from scipy import stats

from atmosbox import theory
from atmosbox.engine import HeatBath, Periodic, Piston, Ramp, Specular
from atmosbox.scene.statistics import block_average
from tests.oracle.kinetic_gas import kolmogorov_smirnov_critical
from tests.physics.conftest import EVERYTHING

P = Periodic()


def averages(box, warm_up, step, samples, measure):
    """Return the block average of measurements at equal intervals of time after a warm-up."""
    box.advance(warm_up)
    values = []
    for _ in range(samples):
        box.advance(box.time + step)
        values.append(measure(box))
    return block_average(np.array(values))


def energies(box):
    kinetic, rotational, _ = box.energy()
    return np.array([kinetic, rotational]) / box.number


@pytest.mark.parametrize("accommodation", [1.0, 0.3])
def test_walls_give_a_gas_their_temperature_whatever_share_they_take_in(gas, accommodation):
    kT = 1.3
    walls = (HeatBath(kT, accommodation),) * 6
    walls = (*walls[:5], Piston())
    facts = {"rotation": 2, "collision_number": math.inf, "gravity": EVERYTHING["gravity"]}
    box = gas(300, (11.0,) * 3, walls=(P, P, *walls[2:]), kT=2.0, spin_kT=0.5, seed=31, **facts)
    mean, error = averages(box, 200.0, 5.0, 2000, energies)
    assert (error / kT < 0.005).all()
    # without contacts that exchange it, each kind of energy comes from the walls alone
    assert (np.abs(mean - [1.5 * kT, kT]) <= 4.0 * error).all()
    assert box.contacts > 1e6
    assert box.ledger() <= 1e-10


def test_points_between_heat_baths_are_everywhere_alike_and_maxwells(gas):
    number, kT, layers = 2000, 0.7, 10
    box = gas(number, (10.0, 8.0, 10.0), walls=(HeatBath(kT),) * 6, diameter=1e-3, kT=2.0, seed=33)
    box.advance(200.0)
    counts, velocity = [], []
    for k in range(500):
        box.advance(box.time + 5.0)
        here = box.snapshot()
        counts.append([np.histogram(here.position[:, axis], layers, (0.0, box.length[axis]))[0] for axis in range(3)])
        # slow molecules have a long correlation time
        if k % 50 == 0:
            velocity.append(here.velocity)
    mean, error = block_average(np.array(counts))
    assert error.max() < 0.01 * number / layers
    # 30 layers: a false alarm once in 50 for a fresh seed
    assert (np.abs(mean - number / layers) <= 4.0 * error).all()
    speed = np.sqrt(np.sum(np.concatenate(velocity) ** 2, axis=1))
    distance = stats.kstest(speed, lambda v: theory.maxwell_speed_cumulative(v, kT, 1.0)).statistic
    assert distance < kolmogorov_smirnov_critical(speed.size, 1e-4)


@pytest.mark.parametrize(
    ("hot", "accommodation", "rotation"),
    [pytest.param(4.0, 1.0, 0, marks=pytest.mark.nightly), (4.0, 0.5, 2), (4.0, 1.0, 2), (1e6, 1.0, 2)],
)
def test_a_very_thin_gas_between_two_walls_carries_the_heat_that_knudsen_found(gas, hot, accommodation, rotation):
    number, cold = 1000, 1.0
    walls = (HeatBath(hot, accommodation), HeatBath(cold, accommodation), P, P, Specular(), Piston())
    facts = {"diameter": 1e-3, "rotation": rotation, "gravity": EVERYTHING["gravity"]}
    box = gas(number, (10.0,) * 3, walls=walls, kT=math.sqrt(hot * cold), seed=34, **facts)
    truth = theory.free_molecular_slab(hot, cold, number / 1000.0, 1.0, rotation)
    # walls that accommodate a share a of all molecules pass on a / (2 - a) of the heat
    passed = accommodation / (2.0 - accommodation)
    # molecules spend most of the time with speeds of the cold wall
    crossing = 10.0 / math.sqrt(cold) + 10.0 / math.sqrt(hot)
    box.advance(20.0 * crossing)
    rows = []
    for _ in range(20):
        heat, impulse, time = box.wall_heat, box.wall_impulse, box.time
        box.advance(time + 20.0 * crossing)
        rate = 1.0 / (100.0 * (box.time - time))
        rows.append([*(rate * (box.wall_heat - heat)[:2]), *(rate * (box.wall_impulse - impulse)[:2])])
    mean, error = block_average(np.array(rows))
    exact = np.array([truth.heat_flux * passed, -truth.heat_flux * passed, truth.pressure, truth.pressure])
    assert (error / np.abs(exact) < 0.02).all()
    assert (np.abs(mean - exact) <= 4.0 * error).all()


def test_a_gas_follows_the_temperature_of_its_walls(gas):
    number = 300
    ramp = Ramp(1.0, 2.0, start=100.0, end=1100.0)
    box = gas(number, (10.0,) * 3, walls=(HeatBath(ramp),) * 6, diameter=0.8, seed=36)
    # half-way up the gas lags behind by less than a relaxation time of about ten
    for time, expected in ((50.0, 1.0), (600.0, 1.5), (1200.0, 2.0)):
        box.advance(time)
        assert box.wall_kT() == pytest.approx(expected, rel=1e-12)
        values = []
        for _ in range(100):
            box.advance(box.time + 1.0)
            values.append(box.energy()[0] / (1.5 * number))
        mean, error = block_average(values, blocks=5)
        drift = 0.05 if expected == 1.5 else 0.0
        # few blocks, so the error is at least that of as many independent thermometers
        error = max(error, theory.temperature_noise(number, 3.0, expected) / math.sqrt(5.0))
        assert abs(mean - drift - expected) <= 4.0 * error + 0.02 * (expected == 1.5)
    gained = sum(box.energy()) - 1.5 * number
    assert box.wall_heat.sum() == pytest.approx(gained, rel=1e-9)

"""Direct simulation Monte Carlo gives the dilute gas of kinetic theory, with errors as known from theory.

Means allow 4 standard errors from 20 blocks (a false alarm once in 1 500 for a fresh seed, never for these).
"""

import math

import numpy as np
import pytest
from scipy import stats

from atmosbox import theory
from atmosbox.engine import HeatBath, Periodic, Piston, Specular, maxwell_velocities
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.scene.statistics import block_average
from tests.oracle import kinetic_gas
from tests.oracle.kinetic_gas import kolmogorov_smirnov_critical

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many molecules take hours without numba")

S, P = Specular(), Periodic()


def new_gas(number, side, *, seed, kT=1.0, walls=(P,) * 6, diameter=1.0, **options):
    """Return a gas at random places whose kinetic energy is exactly that of kT, without mean motion."""
    rng = np.random.default_rng(seed)
    x = 0.5 * diameter + (side - diameter) * rng.random((number, 3))
    options.setdefault("velocity", maxwell_velocities(kT, np.ones(number), rng, exact=True))
    return DsmcParcel(x, length=(side,) * 3, walls=walls, diameter=diameter, seed=seed, **options)


def averages(box, warm_up, step, samples, measure):
    """Return the block average of measurements at equal intervals of time after a warm-up."""
    box.advance(warm_up)
    values = []
    for k in range(1, samples + 1):
        box.advance(warm_up + k * step)
        values.append(measure(box))
    return block_average(np.array(values))


@pytest.mark.parametrize(
    ("number", "side", "options", "duration"),
    [
        (10, 4.0, {"occupancy": 2.0}, 100_000.0),  # as few as ten: a molecule meets the nine others
        (20_000, 40.0, {}, 30.0),
        (20_000, 40.0, {"dt": 1.0, "occupancy": 40.0}, 30.0),  # in a uniform gas neither step nor cell matters
    ],
)
def test_molecules_collide_as_often_as_kinetic_theory_says(number, side, options, duration):
    box = new_gas(number, side, seed=41, **options)
    box.advance(duration)
    # no drift: 3 (N - 1) degrees of freedom share the energy, and it is constant
    freedom = 3.0 * (number - 1)
    relative = math.sqrt(16.0 / math.pi * number / (number - 1.0)) * float(
        kinetic_gas.constant_energy_speed_factor(freedom)
    )
    expected = 0.5 * number * (number - 1.0) * math.pi * relative / side**3 * box.time
    assert expected > 3e5
    assert abs(box.contacts / expected - 1.0) <= 4.0 / math.sqrt(expected)


def test_collisions_make_the_speeds_maxwells():
    number, rng = 50_000, np.random.default_rng(42)
    direction = rng.normal(size=(number, 3))
    velocity = math.sqrt(3.0) * direction / np.sqrt(np.sum(direction**2, axis=1))[:, None]
    box = new_gas(number, 60.0, velocity=velocity, seed=42)
    mean_free_time = box.time_step / 0.2
    box.advance(12.0 * mean_free_time)
    assert box.contacts > 5 * number
    velocity = box.snapshot().velocity
    speed = np.sqrt(np.sum(velocity**2, axis=1))
    critical = kolmogorov_smirnov_critical(number, 1e-4)
    assert stats.kstest(speed, lambda v: theory.maxwell_speed_cumulative(v, 1.0, 1.0)).statistic < critical
    for axis in range(3):
        assert stats.kstest(velocity[:, axis], "norm").statistic < critical


def test_a_column_between_heat_baths_is_barometric_and_isothermal():
    number, side, layers, kT = 8000, 20.0, 10, 1.0
    walls = (P, P, P, P, HeatBath(kT), HeatBath(kT))
    box = new_gas(number, side, walls=walls, diameter=0.3, gravity=0.1, kT=1.3, seed=43)
    low, high = 0.15, side - 0.15

    def profile(box):
        here = box.snapshot()
        z, energy = here.position[:, 2], np.sum(here.velocity**2, axis=1)
        counts = np.histogram(z, layers, (low, high))[0]
        return np.array([counts, np.histogram(z, layers, (low, high), weights=energy)[0]])

    mean, error = averages(box, 400.0, 4.0, 200, profile)
    edges = np.exp(-0.1 / kT * np.linspace(low, high, layers + 1))
    counts = number * -np.diff(edges) / (edges[0] - edges[-1])
    exact = np.array([counts, 3.0 * kT * counts])
    assert (error / exact).max() < 0.01
    # 20 layers: a false alarm once in 75 for a fresh seed
    assert (np.abs(mean - exact) <= 4.0 * error).all()
    assert box.ledger() <= 1e-12
    assert box.contacts > 10 * number


def test_collisions_share_energy_evenly_with_rotation():
    number = 5000
    box = new_gas(number, 30.0, rotation=2, rotational_energy=np.zeros(number), collision_number=5.0, seed=46)
    mean, error = averages(box, 100.0, 2.0, 200, lambda b: b.energy()[1] / sum(b.energy()[:2]))
    assert error < 0.002
    assert abs(mean - 2.0 / 5.0) <= 4.0 * error
    spin = box.snapshot().rotational_energy
    kT = 0.6
    assert stats.kstest(spin, "expon", (0.0, kT)).statistic < kolmogorov_smirnov_critical(number, 1e-4)
    frozen = new_gas(number, 30.0, rotation=2, rotational_energy=spin, collision_number=math.inf, seed=46)
    frozen.advance(5.0)
    assert frozen.contacts > number
    assert frozen.snapshot().rotational_energy.tobytes() == spin.tobytes()


def test_a_slow_piston_cools_and_warms_a_diatomic_gas_along_its_adiabat():
    number, speed, exponents, hits = 20_000, 0.02, [], 0
    for velocity in (speed, -speed):
        walls = (P, P, P, P, S, Piston(velocity))
        spin = np.random.default_rng(47).exponential(size=number)
        box = new_gas(number, 40.0, walls=walls, rotation=2, rotational_energy=spin, dt=0.4, seed=47)
        energy, height = sum(box.energy()), box.ceiling - 1.0
        box.advance(0.2 * height / speed)
        assert box.work == pytest.approx(sum(box.energy()) - energy, rel=1e-9)
        exponents.append(math.log(sum(box.energy()) / energy) / math.log((box.ceiling - 1.0) / height))
        hits += box.wall_hits[5]
    # T V^(2/5) is constant; what is lost in motion at a finite speed is of one sign in both, and so cancels
    noise = 0.4 * 1.128 / math.sqrt(hits)
    assert noise < 0.0025
    assert abs(np.mean(exponents) + 0.4) <= 4.0 * noise
    assert np.abs(np.array(exponents) + 0.4).max() < 0.03

r"""The errors of the classic schemes follow known laws.

Means allow 4 standard errors from 20 blocks (a false alarm once in 1 500 for a fresh seed, never for these). The laws
of late and missed contacts follow from one pair that flies straight and is looked at every step: with
:math:`a = g \Delta t / \sigma` for its relative speed g, a contact is missed with chance :math:`a^2/6` in a plane and
:math:`a^2/3` in space, and its virial is low by :math:`2a/\pi` and :math:`3a/4`; averaged over the speeds that meet.
The gas is therefore dilute: what neighbours change is of the order of (g(sigma) - 1) delta, which is allowed for.
"""

import math

import numpy as np
import pytest

from atmosbox import theory
from atmosbox.engine import HeatBath, Periodic, Specular, maxwell_velocities, random_positions
from atmosbox.engine.classic.classic import SCHEMES, ClassicParcel
from atmosbox.engine.core.jit import COMPILED
from atmosbox.scene.statistics import block_average
from tests.oracle import kinetic_gas

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many steps take hours without numba")

S, P = Specular(), Periodic()
ROOT_PI = math.sqrt(math.pi)


def contacts_by_theory(scheme, covered):
    """Return Z - 1 and the collision rate of a molecule, kT = m = sigma = 1."""
    if scheme == "spheres":
        excess = 4.0 * covered * float(theory.contact_value(covered))
        return excess, 6.0 * excess / ROOT_PI
    excess = 2.0 * covered * float(theory.contact_value_discs(covered))
    return excess, 4.0 * excess / ROOT_PI


def dilute_gas(scheme, number, covered, **options):
    rng = np.random.default_rng(81)
    planar = scheme != "spheres"
    side = math.sqrt(number * math.pi / 4.0 / covered) if planar else (number * math.pi / 6.0 / covered) ** (1.0 / 3.0)
    length = (side, 1.0, side) if planar else (side,) * 3
    periodic = (True, not planar, True)
    return ClassicParcel(
        random_positions(length, np.ones(number), rng, periodic=periodic, planar=planar),
        maxwell_velocities(1.0, np.ones(number), rng, planar=planar, exact=True),
        length=length,
        walls=(P, P, S, S, P, P) if planar else (P,) * 6,
        planar=planar,
        scheme=scheme,
        **options,
    )


def pressure_and_rate(box, excess, rate, contacts):
    """Return the collisional pressure and the collision rate, each over that of theory, with their errors."""
    number, kinetic = box.number, box.energy()[0]
    box.advance(10.0 / rate)
    pace = 2.0 * contacts / (20.0 * number * rate)
    pressure, met = [], []
    for _ in range(20):
        virial, before, time = box.virial.sum(), box.contacts, box.time
        box.advance(time + pace)
        elapsed = box.time - time
        pressure.append((box.virial.sum() - virial) / (2.0 * kinetic * elapsed * excess))
        met.append(2.0 * (box.contacts - before) / (number * elapsed * rate))
    dimensions = 2 if box.planar else 3
    few = kinetic_gas.constant_energy_speed_factor(dimensions * (number - 1)) * math.sqrt((number - 1) / number)
    assert box.energy()[0] == pytest.approx(kinetic, rel=1e-12)
    return block_average(pressure), block_average(np.array(met) / few)


@pytest.mark.parametrize(
    ("scheme", "number", "covered", "delta", "contacts"),
    [
        ("strips", 200, 0.005, 0.1, 4e4),
        ("strips", 200, 0.005, 0.2, 5e4),
        ("lookahead", 40, 0.005, 0.2, 3e4),
        ("spheres", 40, 0.005, 0.1, 5e4),
        ("spheres", 40, 0.005, 0.2, 5e4),
    ],
)
def test_contacts_come_late_and_some_are_missed(scheme, number, covered, delta, contacts):
    excess, rate = contacts_by_theory(scheme, covered)
    box = dilute_gas(scheme, number, covered, delta=delta)
    pressure, met = pressure_and_rate(box, excess, rate, contacts)
    if scheme == "spheres":
        late = 4.0 / ROOT_PI * delta - 8.0 / ROOT_PI * delta**3
        missed = 8.0 / 3.0 * delta**2
        neighbours = float(theory.contact_value(covered)) - 1.0
    else:
        late = 3.0 / ROOT_PI * delta - 2.5 / ROOT_PI * delta**3
        missed = delta**2 - 1.5 * delta**4
        neighbours = float(theory.contact_value_discs(covered)) - 1.0
    allowed = 3.0 * neighbours * delta + 1.5 * neighbours / number
    assert pressure.standard_error < 0.01
    assert abs(pressure.mean - (1.0 - late)) <= 4.0 * pressure.standard_error + allowed
    assert pressure.mean < 1.0 - 0.8 * late
    assert met.standard_error < 0.01
    assert abs(met.mean - (1.0 - missed)) <= 4.0 * met.standard_error + allowed


def test_spheres_that_forget_to_ask_whether_they_part_meet_far_too_often():
    _, rate = contacts_by_theory("spheres", 0.1)
    box = dilute_gas("spheres", 100, 0.1, delta=0.01, closing_only=False)
    energy = box.energy()[0]
    box.advance(20.0)
    assert 2.0 * box.contacts / (100 * box.time) > 2.0 * rate
    assert box.parting_contacts > 0.3 * box.contacts
    assert box.energy()[0] == pytest.approx(energy, rel=1e-12)
    right = dilute_gas("spheres", 100, 0.1, delta=0.01)
    right.advance(20.0)
    assert 2.0 * right.contacts / (100 * right.time) == pytest.approx(rate, rel=4.0 / math.sqrt(right.contacts) + 0.02)
    assert right.parting_contacts == 0


def test_looking_ahead_gives_heavy_and_light_discs_the_same_energy():
    number = 60
    rng = np.random.default_rng(82)
    mass = np.where(np.arange(number) < 20, 10.0, 1.0)
    length = (14.0, 1.0, 14.0)
    box = ClassicParcel(
        random_positions(length, np.ones(number), rng, planar=True),
        maxwell_velocities(1.0, mass, rng, planar=True, exact=True),
        length=length,
        planar=True,
        mass=mass,
    )
    box.advance(300.0)
    rows = []
    for _ in range(1000):
        box.advance(box.time + 6.0)
        energy = 0.5 * mass * np.sum(box.snapshot().velocity ** 2, axis=1)
        rows.append([energy[:20].mean(), energy[20:].mean()])
    mean, error = block_average(rows)
    assert box.scheme == "lookahead"
    assert box.contacts > 1e5
    assert (error < 0.01).all()
    assert (np.abs(mean - 1.0) <= 4.0 * error).all()


def column(scheme, number=400, height=40.0, **options):
    """Return molecules of no size in gravity, kT = m = 1, eight scale heights high."""
    rng = np.random.default_rng(83)
    z = -5.0 * np.log(1.0 - rng.random(number) * (1.0 - math.exp(-height / 5.0)))
    x = np.stack([10.0 * rng.random(number), np.full(number, 5.0), z], axis=1)
    return ClassicParcel(
        x,
        maxwell_velocities(1.0, np.ones(number), rng, planar=True),
        length=(10.0, 10.0, height),
        gravity=0.2,
        diameter=0.0,
        planar=True,
        scheme=scheme,
        **options,
    )


@pytest.mark.parametrize(("scheme", "part"), [("strips", 0.5), ("lookahead", 0.75), ("spheres", 1.0)])
def test_a_fall_in_steps_heats_a_column(scheme, part):
    dt = 0.02
    box = column(scheme, dt=dt)
    power = []
    for _ in range(20):
        before, time = box.numerical_heat, box.time
        box.advance(time + 50.0)
        power.append((box.numerical_heat - before) / (box.time - time) / (400 * 0.2**2 * dt))
    mean, error = block_average(power)
    assert error < 0.02
    assert abs(mean - part) <= 4.0 * error
    assert box.ledger() < 1e-11
    assert (box.wall_heat == 0.0).all()


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_floor_carries_the_weight_of_the_air(scheme):
    box = column(scheme, dt=0.05)
    before = np.sum(box.snapshot().velocity[:, 2])
    box.advance(500.0)
    change = np.sum(box.snapshot().velocity[:, 2]) - before
    force = (box.wall_impulse[4] - box.wall_impulse[5] - change) / box.time
    assert box.wall_hits[4] > 1e4
    assert force == pytest.approx(400 * 0.2, rel=1e-10)


@pytest.mark.parametrize(("scheme", "lost"), [("strips", 0.0), ("lookahead", 1.0), ("spheres", 0.0)])
def test_a_disc_put_back_onto_a_wall_presses_less(scheme, lost):
    number, side, dt, time = 2000, 10.0, 0.2, 2000.0
    rng = np.random.default_rng(84)
    x = side * rng.random((number, 3))
    x[:, 1] = 1.0
    v = maxwell_velocities(1.0, np.ones(number), rng, planar=True)
    box = ClassicParcel(x, v, length=(side, 2.0, side), planar=True, diameter=0.0, scheme=scheme, dt=dt)
    box.advance(time)
    for axis in (0, 2):
        speed = np.abs(v[:, axis])
        force = box.wall_impulse[2 * axis : 2 * axis + 2] / time
        # every flight from wall to wall takes half a step longer, on average, where the rest of the way is lost; a
        # molecule's own flights take a whole number of steps, all alike, so that its rounding up does not average out
        expected = np.sum(speed**2 / side / (1.0 + 0.5 * lost * speed * dt / side))
        rounding = math.sqrt(np.sum((speed**2 / side * speed * dt / side) ** 2) / 12.0)
        counting = math.sqrt(np.sum((2.0 * speed / time) ** 2))
        assert (np.abs(force - expected) <= 4.0 * (rounding + counting)).all()
    # which is the first-order law, told from none by many standard errors
    assert expected == pytest.approx(
        np.sum(speed**2) / side * (1.0 - lost * math.sqrt(2.0 / math.pi) * dt / side), rel=1e-3
    )
    assert 4.0 * (rounding + counting) < 0.3 * math.sqrt(2.0 / math.pi) * dt / side * expected


@pytest.mark.parametrize("scheme", SCHEMES)
def test_walls_that_emit_at_the_end_of_a_step_make_the_gas_too_hot(scheme):
    number, side, dt = 1000, 5.0, 0.2
    planar = scheme != "spheres"
    rng = np.random.default_rng(85)
    x = side * rng.random((number, 3))
    x[:, 1] = 1.0 if planar else x[:, 1]
    box = ClassicParcel(
        x,
        maxwell_velocities(1.0, np.ones(number), rng, planar=planar),
        length=(side,) * 3,
        walls=(HeatBath(1.0),) * 6,
        diameter=0.0,
        planar=planar,
        scheme=scheme,
        dt=dt,
        seed=85,
    )
    box.advance(50.0)
    kT = []
    for _ in range(3000):
        box.advance(box.time + 1.0)
        kT.append(2.0 * box.energy()[0] / ((2.0 if planar else 3.0) * number))
    mean, error = block_average(kT)
    # a flight takes 4 V / (S c) on average, pi A / (P c) in a plane, and ends half a step late; the molecule stays at
    # the wall with the energy of those emitted, which is 2 kT, or 3/2 kT
    chord = math.pi / 4.0 * side if planar else 4.0 / 6.0 * side
    late = 0.5 * dt / (chord / float(theory.mean_speed(1.0, 1.0, 2 if planar else 3)))
    expected = (1.0 + (1.5 if planar else 4.0 / 3.0) * late) / (1.0 + late)
    if scheme == "strips":  # where it starts as far from the wall as it was: on average pi/2 half steps sooner
        expected = (1.0 + (1.5 - math.pi / 2.0) * late) / (1.0 + (1.0 - math.pi / 2.0) * late)
    assert error < 0.1 * (expected - 1.0)
    assert abs(mean - expected) <= 4.0 * error
    assert mean - 1.0 > 10.0 * error
    assert box.ledger() < 1e-11

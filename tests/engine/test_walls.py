"""Each wall obeys its law: the velocities of molecules that it sends back, the heat that it takes, and refusals.

Statistical checks have a fixed seed and accept within 4 standard errors, which come from the closed-form
variances: each gives a false alarm for one seed in 16 000.
"""

import math

import numpy as np
import pytest
from scipy import stats

from atmosbox.engine import HeatBath, Piston, Ramp, Specular
from atmosbox.engine.core.walls import new_walls, resolve_wall_hit
from tests.engine.boxes import held, random_state

NUMBER = 30_000
KT, MASS = 2.5, 4.0


def walls_with(law, wall=4, height=1.0):
    """Return six walls, one of them under this law and the others smooth."""
    laws = [Specular()] * 6
    laws[wall] = law
    return new_walls(tuple(laws), height)


def emitted(law, *, wall=4, rotation=0.0, planar=False, number=NUMBER, time=0.0):
    """Return (normal, first, second, rotational energy) of molecules that hit a wall one after another.

    The first and the second velocity are those along the other two axes, in the order x, y, z.
    """
    walls, state, axis = walls_with(law, wall), random_state(), wall // 2
    before = [0.25, 0.0 if planar else 0.5]
    before.insert(axis, -3.0 if wall % 2 == 0 else 3.0)
    hits = []
    for _ in range(number):
        after, spin, change = resolve_wall_hit(wall, time, tuple(before), 7.0, (MASS, rotation), walls, planar, state)
        assert change == after[axis] - before[axis]
        hits.append([after[axis], *np.delete(after, axis), spin])
    return np.array(hits)


@pytest.fixture(scope="module")
def diatomic():
    return emitted(HeatBath(KT), rotation=2.0)


def test_a_smooth_wall_turns_the_normal_velocity_round_and_nothing_else():
    assert emitted(Specular(), number=3).tolist() == [[3.0, 0.25, 0.5, 7.0]] * 3


def test_a_heat_bath_emits_normal_velocities_as_rayleigh(diatomic):
    normal = diatomic[:, 0]
    assert (normal > 0.0).all()
    speed = math.sqrt(KT / MASS)
    assert held(normal, speed * math.sqrt(math.pi / 2.0), speed**2 * (2.0 - math.pi / 2.0))
    assert held(normal**2, 2.0 * speed**2, 4.0 * speed**4)
    assert stats.kstest(normal, "rayleigh", args=(0.0, speed)).pvalue > 1e-4


def test_a_heat_bath_emits_tangential_velocities_as_gaussian(diatomic):
    variance = KT / MASS
    for tangential in (diatomic[:, 1], diatomic[:, 2]):
        assert held(tangential, 0.0, variance)
        assert held(tangential**2, variance, 2.0 * variance**2)
        assert stats.kstest(tangential, "norm", args=(0.0, math.sqrt(variance))).pvalue > 1e-4
    assert held(diatomic[:, 1] * diatomic[:, 2], 0.0, variance**2)
    assert held(diatomic[:, 0] * diatomic[:, 1], 0.0, 2.0 * variance**2)


@pytest.mark.parametrize(
    ("rotation", "planar", "energy"), [(0.0, False, 2.0), (2.0, False, 3.0), (3.0, False, 3.5), (0.0, True, 1.5)]
)
def test_emitted_molecules_carry_the_energy_of_a_flux(rotation, planar, energy):
    # per kT: 1 in the normal velocity, 1/2 in each tangential one and each degree of freedom of rotation; the sum of as
    # many quadratic degrees of freedom, 2 of them in the normal velocity, has a variance equal to its mean
    gas = emitted(HeatBath(KT), rotation=rotation, planar=planar)
    carried = (0.5 * MASS * np.sum(gas[:, :3] ** 2, axis=1) + gas[:, 3]) / KT
    assert held(carried, energy, energy)


def test_a_plane_gas_is_sent_back_into_its_plane():
    for wall, dead in [(0, 1), (1, 1), (4, 2), (5, 2)]:
        gas = emitted(HeatBath(KT), wall=wall, planar=True, number=50)
        assert (gas[:, dead] == 0.0).all()
        assert (gas[:, 3 - dead] != 0.0).all()


def test_every_wall_sends_molecules_back_into_the_box():
    for wall in range(6):
        normal = emitted(HeatBath(KT), wall=wall, number=200)[:, 0]
        assert (normal > 0.0).all() if wall % 2 == 0 else (normal < 0.0).all()


@pytest.mark.parametrize("accommodation", [0.0, 0.3, 1.0])
def test_accommodation_is_the_part_that_the_wall_takes_in(accommodation):
    gas = emitted(HeatBath(KT, accommodation=accommodation), number=10_000)
    reflected = (gas == [3.0, 0.25, 0.5, 7.0]).all(axis=1)
    assert held(~reflected, accommodation, accommodation * (1.0 - accommodation))


def test_a_heat_bath_emits_at_the_temperature_of_the_moment():
    ramp = HeatBath(Ramp(1.0, 9.0, start=0.0, end=10.0))
    early, late = emitted(ramp, time=0.0, number=200), emitted(ramp, time=10.0, number=200)
    assert late[:, :3] == pytest.approx(3.0 * early[:, :3])


def test_a_piston_reflects_in_its_own_frame():
    for velocity in [-2.0, 0.0, 0.5, 2.0]:
        after = emitted(Piston(velocity), wall=5, number=1)[0]
        assert after.tolist() == [-3.0 + 2.0 * velocity, 0.25, 0.5, 7.0]
        assert after[0] - velocity == -(3.0 - velocity)

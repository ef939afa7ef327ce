"""Collisions, speeds, walls and noise: Maxwell's distribution and what follows from it."""

import numpy as np
import pytest
from scipy import integrate, stats

from atmosbox import theory
from tests.oracle import kinetic_gas


def test_the_mean_free_path_of_a_thin_gas_is_maxwells():
    assert theory.mean_free_path(1e-9, 1.0) == pytest.approx(1e9 / (np.sqrt(2.0) * np.pi), rel=1e-8)


def test_the_dilute_rate_between_species_is_flux_times_cross_section():
    # Mean relative speed sqrt(8 kT / pi mu), cross section pi sigma_12^2.
    rates = theory.collision_rate_between([1e-9, 2e-9], [1.0, 3.0], [1.0, 4.0], 2.0)
    expected = 2e-9 * np.pi * 2.0**2 * np.sqrt(8.0 * 2.0 / (np.pi * 0.8))
    assert rates[0, 1] == pytest.approx(expected, rel=1e-6)


def test_contact_values_of_a_mixture_give_its_closed_pressure():
    # Mansoori et al. (1971), equation 7, against the virial theorem.
    density, diameter = np.array([0.1, 0.25, 0.05]), np.array([1.3, 0.7, 1.0])
    contact = theory.contact_value_between(density, diameter)
    reach = (diameter[:, None] + diameter) / 2.0
    pairs = density[:, None] * density * reach**3 * contact
    virial = 1.0 + 2.0 * np.pi / 3.0 * pairs.sum() / density.sum()
    m0, m1, m2, m3 = (np.pi / 6.0 * (density @ diameter**k) for k in range(4))
    free = 1.0 - m3
    closed = 1.0 / free + 3.0 * m1 * m2 / (m0 * free**2) + m2**3 * (3.0 - m3) / (m0 * free**3)
    assert virial == pytest.approx(closed, rel=1e-13)


@pytest.mark.parametrize(("dimensions", "law"), [(3, stats.maxwell), (2, stats.rayleigh)])
def test_the_speed_distribution_is_maxwells(dimensions, law):
    kT, mass = 2.3, 0.7
    expected = law(scale=np.sqrt(kT / mass))
    speed = np.linspace(0.0, 10.0, 41)
    assert np.allclose(theory.maxwell_speed_density(speed, kT, mass, dimensions), expected.pdf(speed), rtol=1e-12)
    share = theory.maxwell_speed_cumulative(speed, kT, mass, dimensions)
    assert np.allclose(share, expected.cdf(speed), rtol=1e-12, atol=1e-15)
    assert theory.mean_speed(kT, mass, dimensions) == pytest.approx(expected.mean(), rel=1e-12)


def test_what_a_heat_bath_sends_out_balances_what_hits_it():
    # Integrals over the half of a Maxwell distribution that moves towards the wall, weighted with v_n.
    def through(power):
        return integrate.quad(lambda v: v**power * np.exp(-(v**2) / 2.0) / np.sqrt(2.0 * np.pi), 0.0, np.inf)[0]

    assert kinetic_gas.wall_flux(1.0, 1.0, 1.0) == pytest.approx(through(1), rel=1e-10)
    assert theory.emission_normal_speed(1.0, 1.0) == pytest.approx(through(2) / through(1), rel=1e-10)
    energy = through(3) / through(1) / 2.0 + 1.0  # and kT/2 for each of the two directions along the wall
    assert theory.emission_energy(1.0) == pytest.approx(energy, rel=1e-10)
    assert kinetic_gas.wall_flux(1.0, 1.0, 1.0) == pytest.approx(theory.mean_speed(1.0, 1.0) / 4.0, rel=1e-14)


def test_a_very_thin_gas_between_two_walls_is_two_streams():
    kT1, kT2, density, mass = 4.7, 1.3, 0.6, 2.1
    slab = theory.free_molecular_slab(kT1, kT2, density, mass, rotational_dof=2)
    # Half Maxwellians of densities n1/2 and n2/2 that carry equally many molecules each way.
    share = np.sqrt(kT2) / (np.sqrt(kT1) + np.sqrt(kT2))
    n1, n2 = 2.0 * density * share, 2.0 * density * (1.0 - share)
    flux = kinetic_gas.wall_flux(n1, kT1, mass)
    assert flux == pytest.approx(kinetic_gas.wall_flux(n2, kT2, mass), rel=1e-14)
    assert slab.kT == pytest.approx((n1 * kT1 + n2 * kT2) / (n1 + n2), rel=1e-14)
    assert slab.pressure == pytest.approx((n1 * kT1 + n2 * kT2) / 2.0, rel=1e-14)
    carried = theory.emission_energy(kT1, 3, 2) - theory.emission_energy(kT2, 3, 2)
    assert slab.heat_flux == pytest.approx(flux * carried, rel=1e-13)


def test_the_share_of_contacts_is_that_of_the_directions_that_no_wall_is_in():
    # the mean of (1 - |n_x| s_x)(1 - |n_y| s_y)(1 - |n_z| s_z) over all directions, by quadrature in one octant
    sides = np.array([1.2, 1.7, 2.5])

    def room(cosine, angle):
        sine = np.sqrt(1.0 - cosine**2)
        direction = np.array([sine * np.cos(angle), sine * np.sin(angle), cosine])
        return np.prod(1.0 - direction / sides) * 2.0 / np.pi

    share = integrate.dblquad(room, 0.0, np.pi / 2.0, 0.0, 1.0, epsabs=1e-10)[0]
    assert theory.contact_share(sides, 1.0, 5) == pytest.approx(0.8 * share, rel=1e-8)

"""Hard spheres and discs: published tables, molecular dynamics, and thermodynamic consistency.

A number written as text must agree to the last digit.
"""

import numpy as np
import pytest
from scipy import integrate

from atmosbox import theory


def agrees(value, printed):
    """Whether a value rounds to the digits of a printed number (a hair of tolerance for ties)."""
    decimals = len(printed.partition(".")[2])
    return abs(float(value) - float(printed)) <= 0.5000001 * 10.0**-decimals


# packing fraction, n sigma^3, Z Carnahan-Starling, Z Kolafa, their difference in %, g(sigma), collision rate,
# mean free time, mean free path; kT = mass = diameter = 1.
SPHERES = """
.01  .019099 1.041018  1.041019  -.0000 1.02547 .138854   7.20182  11.4924
.02  .038197 1.084149  1.084152  -.0003 1.05189 .284865   3.51044  5.60185
.05  .095493 1.227438  1.227485  -.004  1.13743 .770069   1.298585 2.072241
.10  .190986 1.521262  1.521647  -.025  1.30412 1.765845  .566301  .903686
.15  .286479 1.903725  1.905045  -.069  1.50841 3.063703  .326402  .520863
.20  .381972 2.406250  2.409403  -.131  1.76175 4.771023  .209599  .334471
.25  .477465 3.074074  3.080182  -.198  2.08018 7.041703  .142011  .226617
.30  .572958 3.973761  3.983983  -.257  2.48665 10.101194 .098998  .157978
.35  .668451 5.205735  5.220863  -.290  3.01490 14.288201 .069988  .111684
.40  .763944 6.925926  6.945460  -.281  3.71591 20.126198 .049686  .079288
.45  .859437 9.384673  9.404114  -.207  4.66895 28.449080 .035151  .056092
.494 .943471 12.484983 12.500092 -.121  5.81988 38.929393 .025688  .040991
"""
SPHERE_ROWS = [row.split() for row in SPHERES.strip().splitlines()]


@pytest.mark.parametrize("row", SPHERE_ROWS, ids=lambda row: f"phi={row[0]}")
def test_spheres_have_the_tabulated_pressure_and_collision_rate(row):
    phi, printed_density, carnahan, kolafa, difference, contact, rate, time, path = row
    density = 6.0 * float(phi) / np.pi
    assert agrees(density, printed_density)
    assert theory.packing_fraction(density, 1.0) == pytest.approx(float(phi), rel=1e-15)
    z_cs = theory.compressibility_factor(float(phi), "carnahan-starling")
    z = theory.compressibility_factor(float(phi))
    assert agrees(z_cs, carnahan)
    assert agrees(z, kolafa)
    assert agrees(100.0 * (z_cs / z - 1.0), difference)
    assert agrees(theory.contact_value(float(phi)), contact)
    assert agrees(theory.collision_rate(density, 1.0, 1.0, 1.0), rate)
    assert agrees(6.0 * (z - 1.0) / np.sqrt(np.pi), rate)
    assert agrees(theory.mean_free_time(density, 1.0, 1.0, 1.0), time)
    assert agrees(theory.mean_free_path(density, 1.0), path)


def test_spheres_agree_with_the_molecular_dynamics_of_erpenbeck_and_wood():
    for volume, measured in [(2, 5.85016), (1.8, 7.43040), (1.7, 8.60034), (1.6, 10.19388)]:
        # J. Stat. Phys. 35, 321 (1984); their quoted errors are near 2e-4.
        phi = theory.packing_fraction(np.sqrt(2.0) / volume, 1.0)
        assert theory.compressibility_factor(phi) == pytest.approx(measured, rel=2.2e-4)


def test_the_kolafa_series_has_the_virial_coefficients_of_hard_spheres():
    # Z = 1 + sum of B_k phi^(k-1), read off by Cauchy's integral on a circle around phi = 0.
    points = 0.2 * np.exp(2j * np.pi * np.arange(64) / 64)
    x = points / (1.0 - points)
    series = theory.equation_of_state._SERIES(x)
    virial = [float(np.mean(series / points**k).real) for k in range(1, 10)]
    exact = ["4.000000", "10.000000", "18.364768"]  # B2 to B4, known in closed form
    assert all(agrees(b, printed) for b, printed in zip(virial, exact, strict=False))
    # B5 to B10 by Monte Carlo integration. The last few are not built into the series; what they differ by
    # does not matter up to a quarter filled.
    measured = np.array([28.2245, 39.815, 53.344, 68.538, 85.81, 105.8])
    phi = np.array([0.05, 0.1, 0.2, 0.25])
    difference = np.sum((measured - virial[3:]) * phi[:, None] ** np.arange(4, 10), axis=1)
    assert np.all(np.abs(difference / theory.compressibility_factor(phi)) < 2.1e-6)


def test_free_energy_chemical_potential_and_stiffness_belong_to_one_pressure():
    for phi in [0.001, 0.1, 0.3, 0.49]:
        step = 1e-5 * phi
        sides = np.array([phi - step, phi + step])
        slope = np.diff(theory.excess_free_energy(sides)) / (2.0 * step)
        assert phi * slope[0] == pytest.approx(theory.compressibility_factor(phi) - 1.0, rel=1e-6)
        stiffness = theory.inverse_compressibility(phi)
        pressure = np.diff(sides * theory.compressibility_factor(sides)) / (2.0 * step)
        assert pressure[0] == pytest.approx(stiffness, rel=1e-8)
        potential = np.diff(np.log(sides) + theory.excess_chemical_potential(sides)) / (2.0 * step)
        assert phi * potential[0] == pytest.approx(stiffness, rel=1e-8)


def test_the_isentrope_of_spheres_solves_the_first_law():
    def cooling(log_volume, log_temperature):
        phi = 0.4 * np.exp(-log_volume)
        return [-(2.0 / 3.0) * float(theory.compressibility_factor(phi))]

    expansion = integrate.solve_ivp(cooling, (0.0, np.log(8.0)), [0.0], rtol=1e-11, atol=1e-13)
    expected = np.exp(expansion.y[0, -1])
    assert theory.hard_sphere_isentrope(0.05, 0.4, 3) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("phi", [-0.01, 0.55, np.nan])
def test_packing_outside_the_equation_of_state_is_refused(phi):
    with pytest.raises(ValueError, match=r"packing_fraction must lie in \[0, 0\.5393\) for the kolafa"):
        theory.compressibility_factor([0.1, phi])


def test_discs_have_the_tabulated_pressure():
    cases = [
        (0.1, "1.236111"),
        (0.2, "1.570312"),
        (0.3, "2.063776"),
        (0.4, "2.833333"),
        (0.5, "4.125"),
        (0.6, "6.53125"),
        (0.69, "11.0251"),
    ]
    for eta, henderson in cases:
        assert agrees(theory.compressibility_factor_discs(eta), henderson)


@pytest.mark.parametrize(("eta", "rate"), [(0.1, ".532846"), (0.3, "2.400684"), (0.5, "7.052370")])
def test_discs_have_the_tabulated_collision_rate(eta, rate):
    density = 4.0 * eta / np.pi
    assert theory.packing_fraction_discs(density, 1.0) == pytest.approx(eta, rel=1e-15)
    assert agrees(theory.collision_rate_discs(density, 1.0, 1.0, 1.0), rate)
    factor = theory.compressibility_factor_discs(eta)
    assert agrees(4.0 * (factor - 1.0) / np.sqrt(np.pi), rate)

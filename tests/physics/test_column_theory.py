"""Columns in gravity: the barometric law, and the density profiles of spheres and discs."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss
from scipy import integrate

from atmosbox import theory
from tests.oracle import column_at_rest


def test_a_finite_column_has_the_tabulated_profile():
    cases = [
        (0.1, 0.491668, 1.050833, 0.904837),
        (0.5, 0.458506, 1.270747, 0.606531),
        (1, 0.418023, 1.581977, 0.367879),
        (2, 0.343482, 2.313035, 0.135335),
        (5, 0.193216, 5.033918, 0.006738),
        (20, 0.05, 20.0, 2.1e-9),
    ]
    for depth, mean, floor, top in cases:
        column = depth, 1.0, 1.0, 1.0  # depth in scale heights
        assert theory.column_mean_height(*column) / depth == pytest.approx(mean, abs=5e-7)
        assert theory.column_floor_ratio(*column) == pytest.approx(floor, abs=5e-7)
        assert theory.barometric_pressure(depth, 1.0, 1.0, 1.0, 1.0) == pytest.approx(top, abs=min(5e-7, 0.03 * top))


DENSE = {"molecules_per_area": 3.0, "bottom": 0.5, "top": 11.5, "kT": 1.2, "mass": 1.5, "gravity": 0.2, "diameter": 1.0}


PLANE = DENSE | {"molecules_per_area": 4.0, "gravity": 0.3, "dimensions": 2}
of_spheres_and_discs = pytest.mark.parametrize("column", [DENSE, PLANE], ids=["spheres", "discs"])


@of_spheres_and_discs
def test_a_dense_column_holds_its_molecules_and_carries_their_weight(column):
    held, planar = column["molecules_per_area"], "dimensions" in column
    nodes, weights = leggauss(64)
    inside = column_at_rest.hydrostatic_column(6.0 + 5.5 * nodes, **column)
    assert 5.5 * weights @ inside == pytest.approx(held, rel=1e-11)
    ends = column_at_rest.hydrostatic_column([0.5, 11.5], **column)
    floor, ceiling = (theory.gas_pressure_discs if planar else theory.gas_pressure)(ends, 1.2, 1.0)
    assert floor - ceiling == pytest.approx(held * 1.5 * column["gravity"], rel=1e-12)


@pytest.mark.parametrize("deep", [1e-4, 0.3, 3.0, 40.0, 3400.0])
@pytest.mark.parametrize(("dimensions", "wide"), [(3, 0.0), (3, 0.55), (2, 0.4)])
def test_the_mean_height_of_a_column_is_that_of_its_balance_of_forces(deep, dimensions, wide):
    """Against dn/dz = -n m g / (kT d(nZ)/dn), integrated by another method from the density at the floor."""
    held = min(1.0, deep)
    column = held, 0.3, 0.3 + deep, 1.0, 1.0, 1.0, wide
    found = theory.hydrostatic_mean_height(*column, dimensions=dimensions)
    floor = float(column_at_rest.hydrostatic_column(0.3, *column, dimensions=dimensions))

    def rise(height, state):
        n = np.exp(state[0])
        if dimensions == 2:
            stiffness = theory.inverse_compressibility_discs(theory.packing_fraction_discs(n, wide))
        else:
            stiffness = theory.inverse_compressibility(theory.packing_fraction(n, wide))
        return [-1.0 / stiffness, n, n * height]

    high = min(deep, 60.0)
    walked = integrate.solve_ivp(rise, (0.0, high), [np.log(floor), 0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-14)
    _, number, lifted = walked.y[:, -1]
    assert number == pytest.approx(held, rel=1e-9)
    assert found == pytest.approx(0.3 + lifted / number, rel=1e-9)
    # a thick layer holds as much as the thin ones in it, even one of a hundred scale heights
    thick = theory.hydrostatic_layers([0.3, 0.3 + 0.5 * deep, 0.3 + deep], *column, dimensions=dimensions)
    assert thick.sum() * 0.5 * deep == pytest.approx(held, rel=1e-10)
    edges = np.linspace(0.3, 0.3 + 0.5 * deep, 500)
    thin = theory.hydrostatic_layers(edges, *column, dimensions=dimensions) @ np.diff(edges)
    assert thick[0] * 0.5 * deep == pytest.approx(thin, rel=1e-10)


def test_the_stiffness_of_discs_is_the_slope_of_their_pressure_and_of_their_potential():
    covered, step = np.linspace(0.01, 0.69, 18), 1e-6
    above, below = covered * (1.0 + step), covered * (1.0 - step)
    stiffness = theory.inverse_compressibility_discs(covered)

    def slope(pressure):
        return (pressure(above) - pressure(below)) / (2.0 * step)

    pressed = slope(lambda eta: eta * theory.compressibility_factor_discs(eta)) / covered
    assert np.allclose(pressed, stiffness, rtol=1e-8, atol=0.0)
    lifted = slope(lambda eta: np.log(eta) + theory.excess_chemical_potential_discs(eta))
    assert np.allclose(lifted, stiffness, rtol=1e-8, atol=0.0)
    # it increases, as the search for the packing fraction of a potential requires
    assert (np.diff(theory.inverse_compressibility_discs(np.linspace(0.0, 0.7, 1000))) > 0.0).all()


def test_the_mean_free_path_of_thin_discs_is_one_over_the_strip_that_they_sweep():
    density = 1e-6
    path = theory.mean_speed(1.3, 0.7, dimensions=2) / theory.collision_rate_discs(density, 0.9, 1.3, 0.7)
    assert path == pytest.approx(1.0 / (2.0 * np.sqrt(2.0) * density * 0.9), rel=1e-5)


def test_a_column_that_would_freeze_is_refused():
    with pytest.raises(ValueError, match="molecules_per_area = 12 is more than a gas can hold"):
        column_at_rest.hydrostatic_column(1.0, **(DENSE | {"molecules_per_area": 12.0}))
    with pytest.raises(ValueError, match="freeze"):
        column_at_rest.hydrostatic_column(1.0, **(DENSE | {"gravity": 100.0}))
    with pytest.raises(ValueError, match=r"more than 0\.7 of the plane and freeze"):
        column_at_rest.hydrostatic_column(1.0, **(PLANE | {"molecules_per_area": 12.0}))


def test_columns_that_make_no_sense_are_refused():
    cases = [
        ({"kT": 0.0}, "kT = 0.0 must be a finite number above 0"),
        ({"top": 0.5}, "top = 0.5 must lie above bottom = 0.5"),
        ({"dimensions": 4}, "dimensions = 4 must be 2 or 3"),
    ]
    for wrong, sentence in cases:
        with pytest.raises(ValueError, match=sentence):
            column_at_rest.hydrostatic_column(1.0, **(DENSE | wrong))

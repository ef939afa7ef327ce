r"""A column of spheres or discs with excluded volume in gravity: its density, and its temperature in equilibrium.

Each layer carries the weight of the layers above, :math:`dP/dz = -n m g`, and the column is isothermal. With
:math:`P = n k T Z(\phi)` this means that the chemical potential decreases by the work of lifting,

.. math:: \ln \phi + \mu_{ex}(\phi)/kT = \text{const} - m g z / kT,

which is solved here at each height, and for the constant that gives the right number of molecules. The density
oscillations within a few diameters of a wall are left out: this is the local-density approximation.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats, require_not_negative, require_positive
from atmosbox.theory.barometric import barometric_density, column_mean_height
from atmosbox.theory.equation_of_state import Crowding, crowding

__all__ = ["column_temperature", "hydrostatic_layers", "hydrostatic_mean_height"]

_NODES, _WEIGHTS = leggauss(16)
_NODES, _WEIGHTS = (_NODES + 1.0) / 2.0, _WEIGHTS / 2.0
_SHALLOW = 0.01
"""Depth in scale heights below which the mean density is an integral, not the difference of two pressures."""
_EMPTY = 100.0
"""Scale heights above which the gas is neglected: even the densest gas is thinner there by more than e^-60."""


def _potential(log_packing: ArrayLike, gas: Crowding) -> FloatArray:
    """Return the chemical potential over kT, except for a constant, of a gas at a ln(packing fraction)."""
    return as_floats(log_packing) + gas.chemical_potential(np.exp(log_packing))


def _packing_of_potential(potential: ArrayLike, gas: Crowding) -> FloatArray:
    """Return the packing fraction at which the gas has a chemical potential.

    Newton's method in ln(packing fraction). The potential is increasing and convex, so after a start above the root
    each step stays above it, and the steps shrink to rounding.
    """
    wanted = as_floats(potential)
    guess = np.minimum(wanted, np.log(gas.freezing))
    for _ in range(100):
        step = (_potential(guess, gas) - wanted) / gas.stiffness(np.exp(guess))
        guess = guess - step
        if np.all(np.abs(step) <= 1e-14 * np.maximum(1.0, np.abs(guess))):
            break
    packing: FloatArray = np.exp(guess)
    return packing


def _mean_packing(floor_potential: float, depth: float, gas: Crowding) -> float:
    """Return the mean packing fraction of a column, its depth given in scale heights.

    The column carries its own weight, so the mean is the difference between the pressures at its bottom and top over
    the depth.
    """
    if depth < _SHALLOW:
        return float(_packing_of_potential(floor_potential - depth * _NODES, gas) @ _WEIGHTS)
    ends = _packing_of_potential([floor_potential, floor_potential - depth], gas)
    pressure = ends * gas.compressibility_factor(ends)
    return float(pressure[0] - pressure[1]) / depth


def _profile(
    molecules_per_area: float,
    bottom: float,
    top: float,
    kT: float,
    mass: float,
    gravity: float,
    diameter: float,
    dimensions: int,
) -> Callable[[FloatArray], FloatArray]:
    """Return the function that gives the number density at a height inside the column."""
    from scipy import optimize  # loads slowly

    require_positive(molecules_per_area=molecules_per_area, kT=kT, mass=mass)
    require_not_negative(gravity=gravity, diameter=diameter)
    gas = crowding(dimensions)
    if not top > bottom:
        raise ValueError(f"top = {top} must lie above bottom = {bottom}.")
    if diameter == 0.0:
        return lambda height: barometric_density(height, molecules_per_area, bottom, top, kT, mass, gravity)

    mean = float(gas.packing_fraction(molecules_per_area / (top - bottom), diameter))
    depth = mass * gravity * (top - bottom) / kT
    low, high = np.log(mean) - 1e-6, np.log(gas.freezing)

    def surplus(log_floor: float) -> float:
        return _mean_packing(float(_potential(log_floor, gas)), depth, gas) / mean - 1.0

    if not mean < gas.freezing or surplus(high) < 0.0:
        space = "plane" if dimensions == 2 else "space"
        raise ValueError(
            f"molecules_per_area = {molecules_per_area:.4g} is more than a gas can hold in this column: "
            f"at the floor it would fill more than {gas.freezing} of the {space} and freeze."
        )
    log_floor = float(optimize.brentq(surplus, low, high, xtol=1e-14, rtol=1e-14))
    floor = float(_potential(log_floor, gas))
    volume = float(gas.packing_fraction(1.0, diameter))

    def density(height: FloatArray) -> FloatArray:
        return _packing_of_potential(floor - depth * (height - bottom) / (top - bottom), gas) / volume

    return density


def hydrostatic_layers(
    edges: ArrayLike,
    molecules_per_area: float,
    bottom: float,
    top: float,
    kT: float,
    mass: float,
    gravity: float,
    diameter: float = 0.0,
    dimensions: int = 3,
) -> FloatArray:
    """Return the mean number density in each layer of a closed isothermal column [length^-3; in a plane, length^-2].

    It is the expected count of molecules in the layer, (layers,), per volume. A layer carries its own weight, so its
    mean density is the difference between the pressures below and above it over m g times its thickness, however thick
    it is (Both and Hong 2001, doi:10.1103/PhysRevE.64.061105). In layers thinner than a hundredth of a scale height,
    where that difference has few digits, it is a Gauss-Legendre quadrature.

    Parameters
    ----------
    edges : (layers + 1,)
        Heights between the layers, rising [length]. The part of a layer outside the column counts as empty.
    molecules_per_area
        Molecules above each unit of area [length^-2]; in a plane, above each unit of length [length^-1].
    bottom, top
        Lowest and highest position of a molecule's centre [length].
    kT, mass
        Temperature as an energy [energy], and mass of a molecule [mass].
    gravity
        Acceleration of gravity [length time^-2]; zero is allowed.
    diameter
        Diameter of a molecule [length]; zero for an ideal gas.
    dimensions
        3, or 2 for discs in a plane.

    Raises
    ------
    ValueError
        If the edges do not rise, or the gas at the floor would freeze.

    Examples
    --------
    The layers together hold all the molecules, however they are divided:

    >>> edges = np.array([0.0, 1.0, 3.0, 6.0])
    >>> layers = hydrostatic_layers(edges, 0.3, 0.5, 5.5, 1.0, 1.0, 1.0, diameter=1.0)
    >>> round(float(np.sum(layers * np.diff(edges))), 10)
    0.3
    """
    z = as_floats(edges)
    if z.ndim != 1 or z.size < 2 or not np.all(np.diff(z) > 0.0):
        raise ValueError("edges must be at least two heights, each above the one before.")
    profile = _profile(molecules_per_area, bottom, top, kT, mass, gravity, diameter, dimensions)
    lower, upper = np.clip(z[:-1], bottom, top), np.clip(z[1:], bottom, top)
    reached = upper - lower
    held = profile(lower[:, np.newaxis] + reached[:, np.newaxis] * _NODES) @ _WEIGHTS * reached
    heavy = mass * gravity * reached / kT > _SHALLOW
    if np.any(heavy):
        ends = profile(np.stack([lower[heavy], upper[heavy]]))
        gas = crowding(dimensions)
        below, above = ends * kT * gas.compressibility_factor(gas.packing_fraction(ends, diameter))
        held[heavy] = (below - above) / (mass * gravity)
    layers: FloatArray = held / np.diff(z)
    return layers


def hydrostatic_mean_height(
    molecules_per_area: float,
    bottom: float,
    top: float,
    kT: float,
    mass: float,
    gravity: float,
    diameter: float = 0.0,
    dimensions: int = 3,
) -> float:
    r"""Return the mean height of the molecules of an isothermal column, :math:`\int n z\,dz / \int n\,dz` [length].

    For points it is the closed form of :func:`column_mean_height`. For spheres and discs it is a Gauss-Legendre
    quadrature with 16 points in each scale height, for any height of the column.

    Parameters
    ----------
    molecules_per_area, bottom, top, kT, mass, gravity, diameter, dimensions
        As in :func:`hydrostatic_layers`.

    Examples
    --------
    Spheres cannot all lie on the floor, and so their mean height is greater than that of points:

    >>> column = 0.3, 0.5, 100.0, 1.0, 1.0, 1.0
    >>> [round(hydrostatic_mean_height(*column, diameter), 3) for diameter in (0.0, 1.0)]
    [1.5, 1.78]
    """
    profile = _profile(molecules_per_area, bottom, top, kT, mass, gravity, diameter, dimensions)
    if diameter == 0.0:
        return bottom + float(column_mean_height(top - bottom, kT, mass, gravity))
    depth = min(mass * gravity * (top - bottom) / kT, _EMPTY)
    highest = top if depth < _EMPTY else bottom + depth * kT / (mass * gravity)
    edges = np.linspace(bottom, highest, 1 + max(1, math.ceil(depth)))
    height = (edges[:-1, np.newaxis] + np.diff(edges)[:, np.newaxis] * _NODES).ravel()
    share = profile(height) * np.tile(_WEIGHTS, len(edges) - 1)
    return float(share @ height / share.sum())


def column_temperature(
    energy: float,
    molecules_per_area: float,
    bottom: float,
    top: float,
    diameter: float = 0.0,
    *,
    mass: float = 1.0,
    gravity: float = 1.0,
    dimensions: int = 3,
    rotation: int = 0,
) -> float:
    r"""Return the temperature kT for a given energy per molecule, :math:`\tfrac{d + r}{2} kT + m g \bar z` [energy].

    The mean height rises with temperature, so there is exactly one solution.

    Parameters
    ----------
    energy
        Kinetic and potential energy per molecule [energy].
    molecules_per_area, bottom, top, diameter, mass, gravity, dimensions
        As in :func:`hydrostatic_layers`.
    rotation
        Degrees of freedom of rotation.

    Raises
    ------
    ValueError
        If the column would freeze at its floor, or is so dense that it would be less than half as warm as a gas of
        points.

    Examples
    --------
    In a very high column of points with 5/2 kT each, 3/2 kT are energy of motion and 1 kT is potential energy:

    >>> round(column_temperature(2.5, 1.0, 0.0, 60.0), 3)
    1.0
    """
    from scipy.optimize import brentq

    freedom = dimensions + rotation

    def missing(kT: float) -> float:
        column = molecules_per_area, bottom, top, kT, mass, gravity, diameter
        height = hydrostatic_mean_height(*column, dimensions=dimensions)
        return 0.5 * freedom * kT + mass * gravity * height - energy

    # all energy may be motion; in a high column of points kT per molecule is potential energy, of spheres a little more
    most = 2.0 * energy / freedom
    kT: float = brentq(missing, 0.5 * most * freedom / (freedom + 2.0), most, xtol=1e-14 * energy)
    return kT

r"""Convection between a warm floor and a cold ceiling: air at rest, the adiabat, and when the air begins to move.

At rest heat is conducted. The conductivity of molecules of hard core goes as :math:`\sqrt{T}`, and so in a thin gas
:math:`T^{3/2}` is linear in the height. Beside a wall the temperature has a jump along 2.127 mean free paths.

Air that rises slowly and without heat cools by :math:`\Gamma = \alpha T g / c_p` with height: in an ideal gas
:math:`\alpha T = 1` and :math:`c_p = (f + 2) k / 2m`. The air at rest can turn over only if its temperature falls
faster than that, and it does only if viscosity and conduction are weak enough, by the Rayleigh number

.. math:: \mathrm{Ra} = \frac{g \alpha (\Delta T - \Gamma L) L^3}{\nu \chi}

with viscosity :math:`\nu` and diffusivity of heat :math:`\chi`. Between plates without slip and for small differences
(Boussinesq) the critical value is 1707.76. Here differences are large and mean free paths are long, so the onset and
the rate of growth are those of the linearised Navier-Stokes equations of a compressible gas on the state at rest, with
the coefficients of Chapman and Enskog and with jump and slip at the walls.

All of it is in units in which a molecule has the mass 1.

References
----------
Chandrasekhar, S. (1961), Hydrodynamic and Hydromagnetic Stability, chapter II (the critical Rayleigh number).
Chapman, S., Cowling, T. G. (1970), The Mathematical Theory of Non-uniform Gases, 10.21 and 11.8.
Gass, D. M. (1971), J. Chem. Phys. 54, 1898, doi:10.1063/1.1675116 (discs by Enskog's theory).
Sone, Y. (2007), Molecular Gas Dynamics, 3.1.4 (jump and slip at a wall).
"""

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.equation_of_state import (
    FREEZING_PACKING_FRACTION_DISCS,
    compressibility_factor_discs,
    contact_value_discs,
    gas_pressure_discs,
    inverse_compressibility_discs,
    packing_fraction_discs,
)

__all__ = ["Gas", "RestState", "adiabatic_lapse_rate", "growth_rates", "rayleigh_number", "rest_state"]

_JUMP, _SLIP = 2.127, 1.111
"""Jump of the temperature, and slip of the wind, at a wall, in mean free paths [Sone]."""
_NODES = 400


class Gas(NamedTuple):
    r"""Discs or spheres: the degrees of freedom (2 of discs in a plane, 3 of spheres, 5 if these rotate), and diameter.

    Spheres are a thin gas; discs may be dense. Direct simulation Monte Carlo in cells of the side ``cell`` [length]
    raises conductivity and viscosity of spheres, by :math:`32/225\pi` and :math:`16/45\pi` times the square of the side
    in mean free paths (Alexander et al. 1998, doi:10.1063/1.869674).
    """

    freedom: int
    diameter: float
    cell: float = 0.0

    @property
    def planar(self) -> bool:
        """Whether the molecules are discs."""
        return self.freedom == 2

    def free_path(self, density: ArrayLike) -> FloatArray:
        """Return the mean free path at a number density [length]."""
        n = as_floats(density)
        if self.planar:
            contact = contact_value_discs(packing_fraction_discs(n, self.diameter))
            return 1.0 / (2.0 * math.sqrt(2.0) * n * self.diameter * contact)
        return 1.0 / (math.sqrt(2.0) * math.pi * n * self.diameter**2)

    def conductivity(self, density: ArrayLike, kT: ArrayLike) -> FloatArray:
        """Return the heat conductivity over Boltzmann's constant [1/length/time; of discs 1/time]."""
        if self.planar:
            thin = 1.029 * 2.0 / math.sqrt(math.pi) / self.diameter
            return thin * np.sqrt(as_floats(kT)) * self._crowded(density, 1.5, 0.8718)
        # spheres that rotate, and share their energy evenly in a contact, conduct a quarter more (first approximation)
        thin = 1.025218 * 75.0 / 64.0 / math.sqrt(math.pi) / self.diameter**2 * (1.25 if self.freedom > 3 else 1.0)
        return thin * np.sqrt(as_floats(kT)) * self._in_cells(density, 32.0 / 225.0)

    def viscosity(self, density: ArrayLike, kT: ArrayLike) -> FloatArray:
        """Return the viscosity [mass/length/time; of discs mass/time]."""
        if self.planar:
            thin = 1.022 / (2.0 * math.sqrt(math.pi) * self.diameter)
            return thin * np.sqrt(as_floats(kT)) * self._crowded(density, 1.0, 0.8729)
        thin = 1.016034 * 5.0 / 16.0 / math.sqrt(math.pi) / self.diameter**2
        return thin * np.sqrt(as_floats(kT)) * self._in_cells(density, 16.0 / 45.0)

    def _in_cells(self, density: ArrayLike, factor: float) -> FloatArray:
        """Return by how much cells raise a coefficient of spheres."""
        return 1.0 + factor / math.pi * (self.cell / self.free_path(density)) ** 2

    def _crowded(self, density: ArrayLike, first: float, second: float) -> FloatArray:
        """Return by how much a coefficient of crowded discs exceeds that of few, by Enskog's theory."""
        packing = packing_fraction_discs(density, self.diameter)
        contact = contact_value_discs(packing)
        met = 2.0 * packing * contact
        return (1.0 + first * met + second * met**2) / contact


class RestState(NamedTuple):
    """Air at rest that conducts heat.

    ``height``, ``temperature``, ``density``, ``pressure : (node,)`` [length, energy, 1/length^3, energy/length^3; of
    discs per length^2]; ``heat`` that flows up through a unit of area [energy/time/length^2]; ``gas`` and ``gravity``.
    """

    height: FloatArray
    temperature: FloatArray
    density: FloatArray
    pressure: FloatArray
    heat: float
    gas: Gas
    gravity: float


def adiabatic_lapse_rate(gas: Gas, density: ArrayLike, gravity: float) -> FloatArray:
    r"""Return how fast air that rises slowly and without heat cools with height, as an energy [energy/length].

    Of a thin gas :math:`2 m g / (f + 2)`; of discs with :math:`X = d(\phi Z) / d\phi`

    .. math:: m g\,\frac{Z / X}{1 + Z^2 / X}

    Parameters
    ----------
    gas, density
        The molecules, and their number density [1/length^3; of discs 1/length^2].
    gravity
        Acceleration of gravity [length/time^2].

    Examples
    --------
    Discs that cover a fifth of the plane cool by a third less than discs without volume:

    >>> density = 0.2 * 4.0 / math.pi
    >>> round(float(adiabatic_lapse_rate(Gas(2, 1.0), density, 1.0)), 4), float(adiabatic_lapse_rate(Gas(3, 1.0), 1, 1))
    (0.3246, 0.4)
    """
    n = as_floats(density)
    if not gas.planar:
        return np.full_like(n, 2.0 * gravity / (gas.freedom + 2.0))
    packing = packing_fraction_discs(n, gas.diameter)
    factor, stiff = compressibility_factor_discs(packing), inverse_compressibility_discs(packing)
    return gravity * (factor / stiff) / (1.0 + factor**2 / stiff)


def rest_state(
    gas: Gas,
    height: float,
    floor: float,
    ceiling: float,
    gravity: float,
    density: float,
    nodes: ArrayLike | None = None,
    *,
    jump: float = _JUMP,
) -> RestState:
    """Return the steady state of air at rest between a floor and a ceiling that are thermostats.

    Parameters
    ----------
    gas, height
        The molecules, and the height of the ceiling [length].
    floor, ceiling
        Temperature of floor and ceiling [energy].
    gravity, density
        Acceleration of gravity [length/time^2], and mean number density [1/length^3; of discs 1/length^2].
    nodes
        Heights at which the state is wanted [length]; by default 401 from floor to ceiling.
    jump
        Length along which the temperature has a jump at each wall [mean free path].

    Raises
    ------
    ValueError
        If discs would freeze anywhere.

    Examples
    --------
    Without jumps :math:`T^{3/2}` of a thin gas is linear in the height, here half-way between 1 and 1/8:

    >>> state = rest_state(Gas(3, 0.1), 50.0, 1.0, 0.25, 0.01, 1.0, jump=0.0)
    >>> round(float(state.temperature[200] ** 1.5), 6)
    0.5625
    """
    z = np.linspace(0.0, height, _NODES + 1)
    wanted = z if nodes is None else as_floats(nodes)
    lower, upper = floor, ceiling
    temperature, n = np.linspace(floor, ceiling, _NODES + 1), np.full_like(z, density)
    for _ in range(200):
        before = temperature
        pressure, n = _hydrostatic(gas, z, temperature, n, gravity, density)
        # k goes as the square root of T, so T^(3/2) is the integral of what density leaves of 1/k
        passed = _integral(np.sqrt(temperature) / gas.conductivity(n, temperature), z)
        heat = (lower**1.5 - upper**1.5) * 2.0 / 3.0 / float(passed[-1])
        temperature = np.maximum(lower**1.5 - 1.5 * heat * passed, 1e-12) ** (2.0 / 3.0)
        ends = [0, -1]
        apart = jump * gas.free_path(n[ends]) * heat / gas.conductivity(n[ends], temperature[ends])
        # half of the way, so that jumps along a path as long as the box do not make it swing
        lower = 0.5 * (lower + max(floor - float(apart[0]), 0.05 * floor))
        upper = 0.5 * (upper + max(ceiling + float(apart[1]), 0.05 * ceiling))
        if float(np.max(np.abs(temperature - before))) < 1e-11 * (floor + ceiling):
            break
    if gas.planar and float(np.max(packing_fraction_discs(n, gas.diameter))) > FREEZING_PACKING_FRACTION_DISCS:
        raise ValueError("at rest the discs would freeze where they are densest")
    if nodes is not None:
        # T^(3/2) and ln p are so smooth that a spline between 401 nodes leaves no error that matters
        from scipy.interpolate import CubicSpline  # loads slowly

        temperature = CubicSpline(z, temperature**1.5)(wanted) ** (2.0 / 3.0)
        pressure = np.exp(CubicSpline(z, np.log(pressure))(wanted))
        n = _density(gas, pressure, temperature)
    return RestState(wanted, temperature, n, pressure, heat, gas, gravity)


def _integral(values: FloatArray, z: FloatArray) -> FloatArray:
    """Return the integral from the first of equally spaced nodes on, by the corrected trapezoidal rule."""
    step = float(z[1] - z[0])
    slope = np.gradient(values, step, edge_order=2)
    parts = 0.5 * step * (values[1:] + values[:-1]) - step**2 / 12.0 * (slope[1:] - slope[:-1])
    return np.concatenate([[0.0], np.cumsum(parts)])


@functools.cache
def _states_of_discs(diameter: float) -> tuple[FloatArray, FloatArray]:
    """Return a table of the equation of state of discs: pressure over kT, and number density."""
    density = np.linspace(0.0, 0.95, 4001) / packing_fraction_discs(1.0, diameter)
    return gas_pressure_discs(density, 1.0, diameter), density


def _density(gas: Gas, pressure: FloatArray, kT: FloatArray) -> FloatArray:
    """Return the number density at a pressure; of discs from a table of their equation of state."""
    return np.interp(pressure / kT, *_states_of_discs(gas.diameter)) if gas.planar else pressure / kT


def _hydrostatic(
    gas: Gas, z: FloatArray, kT: FloatArray, before: FloatArray, gravity: float, density: float
) -> tuple[FloatArray, FloatArray]:
    """Return pressure and number density of a column of these temperatures with this mean density.

    The weight of discs above each height is that of the density before; the result is half-way to what follows from it.
    """
    held = density * float(z[-1])
    if not gas.planar:
        fallen = np.exp(-gravity * _integral(1.0 / kT, z))
        pressure = held / float(_integral(fallen / kT, z)[-1]) * fallen
        return pressure, pressure / kT
    above = _integral(before[::-1], z)[::-1] * gravity
    densest = 0.8 / packing_fraction_discs(1.0, gas.diameter)
    low, high = 0.0, 2.0 * float(gas_pressure_discs(densest, kT.max(), gas.diameter))
    for _ in range(50):
        top = 0.5 * (low + high)
        n = _density(gas, top + above, kT)
        low, high = (low, top) if float(np.mean(n[1:] + n[:-1])) * 0.5 > density else (top, high)
    return top + above, 0.5 * (n + before)


def rayleigh_number(state: RestState) -> float:
    r"""Return the Rayleigh number of air at rest, with the density and the temperature half-way up.

    :math:`g \alpha (\Delta T - \Gamma L) L^3 / \nu \chi`; negative where the air is stable.

    Examples
    --------
    >>> state = rest_state(Gas(3, 0.1), 2000.0, 1.9, 0.1, 1e-3, 1.0)
    >>> rayleigh_number(state) > 1708 > 0 > rayleigh_number(rest_state(Gas(3, 0.1), 2000.0, 1.0, 1.0, 1e-3, 1.0))
    True
    """
    gas, gravity = state.gas, state.gravity
    length = float(state.height[-1] - state.height[0])
    kT, n = (float(np.interp(0.5 * length, state.height, row)) for row in (state.temperature, state.density))
    lapse = float(adiabatic_lapse_rate(gas, n, gravity))
    expands, heat = 1.0 / kT, 0.5 * gas.freedom + 1.0
    if gas.planar:
        packing = packing_fraction_discs(n, gas.diameter)
        factor, stiff = float(compressibility_factor_discs(packing)), float(inverse_compressibility_discs(packing))
        expands, heat = factor / stiff / kT, 1.0 + factor**2 / stiff
    steep = float(state.temperature[0] - state.temperature[-1]) - lapse * length
    spread = float(gas.viscosity(n, kT)) / n * float(gas.conductivity(n, kT)) / (n * heat)
    return gravity * expands * steep * length**3 / spread


def _chebyshev(order: int) -> tuple[FloatArray, FloatArray]:
    """Return the matrix of the derivative at the Chebyshev points from 1 to -1, and the points."""
    x = np.cos(math.pi * np.arange(order + 1) / order)
    c = np.r_[2.0, np.ones(order - 1), 2.0] * (-1.0) ** np.arange(order + 1)
    apart = x[:, None] - x[None, :]
    matrix = np.outer(c, 1.0 / c) / (apart + np.eye(order + 1))
    return matrix - np.diag(matrix.sum(axis=1)), x


_WARM = 0.1  # least relative change of temperature in a wave of air, divided by that of density


def growth_rates(
    gas: Gas,
    height: float,
    floor: float,
    ceiling: float,
    gravity: float,
    density: float,
    wave_numbers: ArrayLike,
    *,
    order: int = 40,
    jump: float = _JUMP,
    slip: float = _SLIP,
) -> FloatArray:
    """Return how fast waves of convection grow in a thin gas at rest [1/time]; negative where they decay.

    Density, wind and temperature are perturbed by :math:`e^{st + ikx}` times functions of the height, at Chebyshev
    points; of all eigenvalues s, the growth rates, the one with the largest real part counts. Solutions of almost
    constant temperature are left out: they are no waves of air, but follow from the finite order of the polynomials.

    Parameters
    ----------
    gas, height, floor, ceiling, gravity, density, jump
        As for `rest_state`; the gas is thin.
    wave_numbers : (wave,)
        Horizontal wave numbers k [1/length].
    order
        Order of the polynomials in the height.
    slip
        Length along which the wind slips at the walls [mean free path].

    Raises
    ------
    ValueError
        If the molecules are discs.

    Examples
    --------
    Between plates 80 mean free paths apart, hot below, rolls grow; with more gravity they do not:

    >>> gas = Gas(3, (math.sqrt(2.0) * math.pi) ** -0.5)
    >>> light, heavy = (growth_rates(gas, 80.0, 1.9, 0.1, g, 1.0, [0.06])[0] for g in (0.025, 0.06))
    >>> bool(light > 0.006 > 0.0 > heavy)
    True
    """
    if gas.planar:
        raise ValueError("the growth of convection is known for a thin gas of spheres")
    from scipy.linalg import eig  # loads slowly

    derivative, x = _chebyshev(order)
    z = 0.5 * (x + 1.0) * height
    D = derivative * 2.0 / height
    state = rest_state(gas, height, floor, ceiling, gravity, density, z[::-1], jump=jump)
    n, p, kT = (row[::-1] for row in (state.density, state.pressure, state.temperature))
    mu, conducts = gas.viscosity(n, kT), gas.conductivity(n, kT)
    steep, warm, path = -state.heat / conducts, 0.5 * gas.freedom, gas.free_path(n)
    one, none, d = np.eye(order + 1), np.zeros((order + 1, order + 1)), np.diag
    found = []
    for k in as_floats(wave_numbers).ravel():
        # unknowns: density, u / i, w, temperature; the divergence of the wind is dw/dz - k u
        gap_u, gap_w = -k * one, D
        along_u, along_w = d(mu) @ (-2.0 * k * one - 2.0 / 3.0 * gap_u), d(mu) @ (-2.0 / 3.0 * gap_w)
        shear_u, shear_w = d(mu) @ D, d(mu) * k
        up_u, up_w = d(mu) @ (-2.0 / 3.0 * gap_u), d(mu) @ (2.0 * D - 2.0 / 3.0 * gap_w)
        conduction = D @ (d(conducts) @ D + d(conducts * steep / (2.0 * kT))) - k * k * d(conducts)
        left = np.block(
            [
                [none, k * d(n), -D @ d(n), none],
                [-k * d(kT), k * along_u + D @ shear_u, k * along_w + D @ shear_w, -k * d(n)],
                [-D @ d(kT) - gravity * one, -k * shear_u + D @ up_u, -k * shear_w + D @ up_w, -D @ d(n)],
                [none, -d(p) @ gap_u, -d(p) @ gap_w - d(n * warm * steep), conduction],
            ]
        )
        right = d(np.concatenate([np.ones(order + 1), n, n, n * warm]))
        size = order + 1
        for at, inward in ((0, -1.0), (order, 1.0)):  # the first point is at the ceiling
            for field, length in ((1, slip), (3, jump), (2, 0.0)):
                row = field * size + at
                left[row] = right[row] = 0.0
                left[row, field * size : (field + 1) * size] = -inward * length * path[at] * D[at]
                left[row, row] += 1.0
        values, shapes = eig(left, right)
        denser, warmer = (
            np.abs(each / of[:, None]).max(axis=0) for each, of in ((shapes[:size], n), (shapes[-size:], kT))
        )
        values = values[np.isfinite(values) & (np.abs(values) < 1e3 / path.min()) & (warmer > _WARM * denser)]
        found.append(float(values.real.max()))
    return np.array(found)

r"""A parcel of gas that is lifted, or compressed without heat: its adiabat, and how far a fast ascent deviates from it.

A molecule with f degrees of freedom has the heat capacity :math:`(f/2) k` at constant volume and
:math:`(f/2 + 1) k` at constant pressure. Air has f = 5, three of translation and two of rotation; spheres
that do not rotate have 3, and cool faster.

An infinitely slow ascent follows the adiabat. One of some hundred mean free times deviates a little: its finite rate
warms it, and the excluded volume of its molecules cools it.
"""

import functools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.constants import STANDARD_GRAVITY
from atmosbox.theory.environment import DRY_AIR_GAS_CONSTANT
from atmosbox.theory.equation_of_state import gas_pressure, hard_sphere_isentrope, packing_fraction

__all__ = ["DISSIPATION", "Ascent", "adiabatic_index", "dry_adiabat_temperature", "dry_lapse_rate"]


def adiabatic_index(dof: ArrayLike = 5) -> FloatArray:
    r"""Return the ratio of the heat capacities at constant pressure and constant volume, :math:`\gamma = 1 + 2/f`.

    Parameters
    ----------
    dof
        Degrees of freedom f of one molecule.

    Examples
    --------
    Discs in a plane, spheres, air:

    >>> [round(float(gamma), 4) for gamma in adiabatic_index([2, 3, 5])]
    [2.0, 1.6667, 1.4]
    """
    return 1.0 + 2.0 / as_floats(dof)


def dry_adiabat_temperature(
    pressure: ArrayLike, temperature0: ArrayLike, pressure0: ArrayLike, dof: float = 5
) -> FloatArray:
    """Return the temperature of dry air lifted to a pressure, :math:`T_0 (p/p_0)^{2/(f+2)}`.

    Parameters
    ----------
    pressure, pressure0
        Pressure now and at the start, in one unit.
    temperature0
        Temperature at the start, in K or as an energy; the result has its unit.
    dof
        Degrees of freedom f of one molecule: 5 for air, with the exponent 2/7; 3 for spheres, with 2/5.

    Examples
    --------
    From 1000 to 500 hPa air cools from 15 degC to -37 degC; spheres that do not rotate would cool to -55 degC:

    >>> [round(float(dry_adiabat_temperature(500.0, 288.15, 1000.0, dof)) - 273.15) for dof in (5, 3)]
    [-37, -55]
    """
    ratio = as_floats(pressure) / as_floats(pressure0)
    temperature: FloatArray = as_floats(temperature0) * ratio ** (2.0 / (dof + 2.0))
    return temperature


def dry_lapse_rate(
    gravity: ArrayLike = STANDARD_GRAVITY, specific_gas_constant: ArrayLike = DRY_AIR_GAS_CONSTANT, dof: float = 5
) -> FloatArray:
    """Return the cooling of dry air per metre of lift, :math:`g / c_p` [K m^-1].

    Parameters
    ----------
    gravity
        Acceleration of gravity [m s^-2].
    specific_gas_constant
        Gas constant per mass [J kg^-1 K^-1]; :math:`c_p` is :math:`f/2 + 1` times it.
    dof
        Degrees of freedom f of one molecule.

    Examples
    --------
    In kelvin per kilometre:

    >>> round(float(dry_lapse_rate()) * 1000.0, 2)
    9.76
    """
    return as_floats(gravity) / ((dof / 2.0 + 1.0) * as_floats(specific_gas_constant))


DISSIPATION = 2.0
"""Four thirds of the viscosity plus the bulk viscosity, over n k T and the mean free time: 2.01 by kinetic theory.

The viscosity of hard spheres is 1.016 x 5/4 in these units (Chapman and Cowling 1970, 10.21), which gives 1.69. In a
collision the rule of Larsen and Borgnakke divides the energy of two molecules among the 4 degrees of freedom of their
relative motion and the 4 of their rotation; so the temperature of the rotation relaxes within 2 mean free times. In a
gas that expands at the rate e it lags behind by 2 x 2/5 e, and the translation is colder than the mean by two fifths of
that: a bulk viscosity of 8/25. For molecules that do not rotate only the 1.69 is left.

Measured independently, with their spread: 1.99 +- 0.06 from 184 ascents of 50 to 1600 mean free times to 300 hPa,
and 1.5 +- 0.1 without rotation from 24 ascents of 200.
"""
_SHEAR, _ROTATION = 1.016 * 1.25, 2.0
"""Relaxation times of a shear, and of the rotation [mean free times]."""
_AVERAGED = 100.0
"""Time over which the piston averages Z - 1, see `atmosbox.engine.FollowPressure` [mean free times]."""


@dataclass(frozen=True)
class Ascent:
    """An ascent of some hundred mean free times.

    Parameters
    ----------
    route
        Pressure of the environment at equal intervals of time, from the start to the top [Pa].
    length
        Duration of the ascent, in mean free times at its start.
    height
        Height of the box at the start, over the thermal speed sqrt(kT/m) [mean free times].
    freedom
        Degrees of freedom of a molecule.

    Examples
    --------
    A parcel that climbs to 300 hPa in 1600 mean free times arrives a twentieth of a percent too warm:

    >>> even = tuple(np.geomspace(1e5, 3e4, 200))
    >>> round(100 * Ascent(even, 1600.0, 6.0).finite_speed(3e4), 3)
    0.047
    """

    route: tuple[float, ...]
    length: float
    height: float
    freedom: int = 5

    @property
    def pressure(self) -> float:
        """Pressure at the start [Pa]."""
        return self.route[0]

    @property
    def top_pressure(self) -> float:
        """Pressure at the end [Pa]."""
        return self.route[-1]

    @functools.cached_property
    def _warmth(self) -> tuple[FloatArray, FloatArray]:
        """Logarithm of the pressure over that at the start, and relative error of the temperature, along the route."""
        fallen = np.log(self.route[0]) - np.log(np.array(self.route))
        time = np.linspace(0.0, self.length, len(fallen))
        index, capacity = float(adiabatic_index(self.freedom)), 0.5 * self.freedom + 1.0
        rate = np.gradient(fallen, time) / index
        free_time = np.exp((self.freedom + 1.0) / (self.freedom + 2.0) * fallen)
        shear, rotation = 4.0 / 3.0 * _SHEAR, (DISSIPATION - 4.0 / 3.0 * _SHEAR if self.freedom > 3 else 0.0)
        made = (shear + rotation) * rate**2 * free_time
        steps = np.diff(time) * 0.5 * (made[1:] + made[:-1])
        gained = np.concatenate([[0.0], np.cumsum(steps)])
        # the stress builds up at the start, and lags behind when the gas becomes thinner
        late = 0.5 * (shear * _SHEAR + rotation * _ROTATION) * rate**2 * (free_time**2 + 1.0)
        gained = np.maximum(gained - late, 0.0)
        high = self.height * np.exp(fallen / index)
        flow = (rate * high) ** 2 / 6.0 * np.exp(2.0 / (self.freedom + 2.0) * fallen)
        return -fallen, (gained + flow) / capacity

    def finite_speed(self, pressure: float) -> float:
        r"""Return how much too warm a parcel arrives at a pressure [Pa], as a share of its temperature.

        A gas that expands at the rate :math:`e = -d \ln p/dt / \gamma` gains the entropy :math:`D e^2 \tau` per
        molecule and unit of time, in k, with D as in `DISSIPATION`, a sum of :math:`D_i`; along an adiabat :math:`\tau`
        grows as :math:`p^{-a}`, a = (f + 1)/(f + 2). The stress that produces this entropy lags behind by
        :math:`t_i \tau`, 1.27 mean free times for the shear and 2 for the rotation. In addition the energy of the flow
        counts as warmth: the box, of height h, is stretched at the rate e, which takes :math:`m e^2 h^2 / 6` for each
        molecule. Together,

        .. math:: \frac{\Delta T}{T} = \frac{1}{f/2 + 1} \left[ \int D e^2 \tau \, dt
                  - \sum_i D_i t_i e^2 \frac{\tau^2 + \tau_0^2}{2} + \frac{m e^2 h^2}{6 k T} \right] .

        The first term decreases as one over the length n of the ascent, the others as one over its square.

        Measured independently, at n = 50 to 300 hPa: 3.11, 3.45 and 3.61 K, each +- 0.10, for 500, 2000 and 4000
        molecules.
        """
        fallen, warmth = self._warmth
        return float(np.interp(math.log(pressure / self.pressure), fallen[::-1], warmth[::-1]))

    def scatter(self, molecules: int, crowding: float = 0.0) -> FloatArray:
        r"""Return the standard deviation of the temperature from run to run along the route, as a share of it.

        The work that is done on a gas scatters, and close to equilibrium its variance is 2 kT times the work that is
        dissipated (Jarzynski 1997, doi:10.1103/PhysRevLett.78.2690). So the variance of the entropy of N molecules, in
        k, is twice the entropy that they have gained on average, and at the pressure where they arrive

        .. math:: \left( \frac{\sigma_T}{T} \right)^2 = \frac{2}{N (f/2 + 1)} \frac{\Delta T}{T} ,

        with the mean warming :math:`\Delta T / T` of `finite_speed`. This holds as long as the gas responds linearly to
        its expansion, that is for :math:`e \tau \ll 1`. A second part does not depend on the speed: the pressure is
        known from Z - 1 (``crowding``; 0 for points), measured over 100 mean free times, in which 100 N collisions have
        a mean impulse that is known to :math:`\sqrt{4 / \pi}` over the root of their number.

        Examples
        --------
        Four times as many molecules halve the scatter:

        >>> ascent = Ascent(tuple(np.geomspace(1e5, 3e4, 200)), 1600.0, 6.0)
        >>> print(f"{ascent.scatter(1000)[-1] / ascent.scatter(4000)[-1]:.3f}")
        2.000
        """
        fallen, warmth = -self._warmth[0], self._warmth[1]
        capacity = 0.5 * self.freedom + 1.0
        thinner = np.exp(-fallen / float(adiabatic_index(self.freedom)))
        collisions = _AVERAGED * molecules * np.exp(-(self.freedom + 1.0) / (self.freedom + 2.0) * fallen)
        reading = crowding * thinner * np.sqrt(4.0 / math.pi / collisions)
        return np.asarray(np.sqrt(2.0 * warmth / (capacity * molecules) + (reading / capacity) ** 2))

    def room(self, pressure: float, density: float) -> float:
        """Return how much colder spheres arrive at a pressure [Pa] than points, as a share of the temperature.

        Both are lifted infinitely slowly; excluded volume cools spheres in second order of the packing fraction.
        ``density`` is the number of molecules at the start in the cube of their diameter.
        """
        density_on_the_way = density * np.geomspace(min(pressure, self.top_pressure) / self.pressure, 1.0, 200)
        filled = packing_fraction(density_on_the_way, 1.0)
        temperature = hard_sphere_isentrope(filled, filled[-1], self.freedom)
        falling = gas_pressure(density_on_the_way, temperature, 1.0)
        falling *= self.pressure / falling[-1]
        spheres = float(np.interp(pressure, falling, temperature))
        return 1.0 - spheres / float(dry_adiabat_temperature(pressure, 1.0, self.pressure, self.freedom))

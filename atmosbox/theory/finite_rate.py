"""A parcel that rises within nanoseconds: how much its haste warms it, and how much the room of its spheres cools it.

An ascent that takes for ever follows the adiabat. One of some hundred mean free times does not quite.
"""

import math
from dataclasses import dataclass

import numpy as np

from atmosbox.theory.entropy import hard_sphere_isentrope
from atmosbox.theory.equation_of_state import gas_pressure, packing_fraction
from atmosbox.theory.lifting import adiabatic_index, dry_adiabat_temperature

__all__ = ["DISSIPATION", "FINITE_SPEED", "Ascent"]

DISSIPATION = 2.0
"""Four thirds of the viscosity and the bulk viscosity, over n k T and the mean free time.

Measured: 1.99 +- 0.06, by 184 ascents of 50 to 1600 mean free times to 300 hPa, which end too warm by 151 +- 4 K
over their length. The viscosity of a thin gas, of Chapman and Enskog, makes 5/3 of it; rotation, which follows with
delay, adds a bulk viscosity. Spheres that do not rotate showed less, 1.5 +- 0.1 by 24 ascents of 200.
"""
FINITE_SPEED = 0.74
"""Warmth that an ascent from 1000 to 300 hPa leaves at its end, as a share of the temperature, times its length.

The length is in mean free times at the start, and long; see `Ascent.finite_speed`, whose first order this is.
"""


@dataclass(frozen=True)
class Ascent:
    """An even ascent: the pressure outside falls from one value to another in so many mean free times.

    Parameters
    ----------
    pressure, top_pressure
        Where it starts and where it ends [Pa].
    length
        How long it lasts, in mean free times at its start.
    freedom
        Degrees of freedom of a molecule.
    closing
        Within how many mean free times the piston closes a gap of pressure.

    Examples
    --------
    A parcel that climbs to 300 hPa in 1600 mean free times arrives a twentieth of a percent too warm:

    >>> round(100 * Ascent(1e5, 3e4, 1600.0).finite_speed(3e4), 3)
    0.047
    """

    pressure: float
    top_pressure: float
    length: float
    freedom: int = 5
    closing: float = 20.0

    def finite_speed(self, pressure: float) -> float:
        r"""Return how much too warm a parcel arrives at a pressure [Pa], as a share of its temperature.

        A gas that expands at the rate :math:`e = -d \ln V/dt` gains the entropy :math:`D e^2 \tau` per molecule,
        over k, with D as in `DISSIPATION`; at a given pressure that is a share 1/(f/2 + 1) of it in temperature. Here
        e is :math:`L / \gamma t_{top}`, for :math:`L = \ln p_0/p_{top}`, and along an adiabat :math:`\tau` grows as
        :math:`p^{-a}`, a = (f + 1)/(f + 2). So in an ascent of n mean free times

        .. math:: \frac{\Delta T}{T} = \frac{D}{\gamma^2 (f/2 + 1)} \frac{L}{n} \frac{(p_0/p)^a - 1}{a}
                  \left[ 1 + 4.4 \frac{L}{n} (p_0/p)^a \right] .

        The bracket is the next order, measured: 4.4 mean free times of the thin gas at p must be short, too. Down to
        n = 50, and to 50 hPa with n = 400, ascents agree with this at their end; at 700 hPa they are less warm, by a
        third, because the rate is not quite constant: it grows with height.
        """
        fall = math.log(self.pressure / self.top_pressure) / self.length
        power = (self.freedom + 1.0) / (self.freedom + 2.0)
        longer: float = (self.pressure / pressure) ** power
        share = DISSIPATION / (float(adiabatic_index(self.freedom)) ** 2 * (0.5 * self.freedom + 1.0))
        return share * fall * (longer - 1.0) / power * (1.0 + 4.4 * fall * longer)

    def lateness(self, pressure: float) -> float:
        """Return how much too warm it is where the air outside has a pressure [Pa], as a share of its temperature.

        The piston knows the pressure of a parcel that grows too warm, and follows; but only within the time that it
        takes to close a gap. So the parcel is still where the air has a little more pressure, which counts 2/f times
        what it warms meanwhile.
        """
        meanwhile = math.log(self.pressure / self.top_pressure) / self.length * self.closing
        later = max(pressure * math.exp(-meanwhile), min(pressure, self.top_pressure))
        gained = self.finite_speed(later) - self.finite_speed(pressure)
        return self.finite_speed(pressure) + 2.0 / self.freedom * gained

    def room(self, pressure: float, density: float) -> float:
        """Return how much colder spheres arrive at a pressure [Pa] than points, as a share of the temperature.

        Both are lifted without end slowly. What room they take cools them by a little, of second order in the packing.

        Parameters
        ----------
        pressure
            Where they arrive [Pa].
        density
            How many molecules there are at the start in the cube of their diameter.
        """
        density_on_the_way = density * np.geomspace(min(pressure, self.top_pressure) / self.pressure, 1.0, 200)
        filled = packing_fraction(density_on_the_way, 1.0)
        temperature = hard_sphere_isentrope(filled, filled[-1], self.freedom)
        falling = gas_pressure(density_on_the_way, temperature, 1.0)
        falling *= self.pressure / falling[-1]
        spheres = float(np.interp(pressure, falling, temperature))
        return 1.0 - spheres / float(dry_adiabat_temperature(pressure, 1.0, self.pressure, self.freedom))

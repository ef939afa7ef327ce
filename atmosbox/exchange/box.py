"""Moist air in a closed box of one temperature, as theory knows it: what saturates it, and how soon."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

from atmosbox import theory as law
from atmosbox.moisture import vapour_molecules
from atmosbox.units import BOLTZMANN, DRY_AIR, Scale

__all__ = ["MoistBox"]


@dataclass(frozen=True)
class MoistBox:
    """A cube of moist air between heat baths, with liquid in it.

    Parameters
    ----------
    molecules
        How many there are, of air and of vapour.
    temperature, pressure
        Of the walls [K], and of the gas at the start [Pa].
    humidity
        Relative humidity at the start [1].
    ideal
        Whether molecules take no room.

    Examples
    --------
    What condenses is what is too much; the fewer molecules there are, the more they scatter about that:

    >>> box = MoistBox(10_000, 293.15, 1e5, 1.5)
    >>> box.vapour, round(box.full)
    (350, 233)
    """

    molecules: int
    temperature: float
    pressure: float
    humidity: float
    ideal: bool = False

    @property
    def scale(self) -> Scale:
        """The units of the box."""
        return Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * self.temperature)

    @functools.cached_property
    def _packing(self) -> tuple[float, float]:
        """Number density [1/diameter^3] and compressibility factor."""
        wanted = self.pressure / self.scale.pressure
        density, factor = wanted, 1.0
        for _ in range(100):
            factor = 1.0 if self.ideal else float(law.compressibility_factor(law.packing_fraction(density, 1.0)))
            density = math.sqrt(density * wanted / factor)
        return density, factor

    @property
    def side(self) -> float:
        """Side of the cube that centres can reach [diameter]."""
        return float((self.molecules / self._packing[0]) ** (1.0 / 3.0))

    @property
    def face(self) -> float:
        """Area of one of its faces [m^2]."""
        return (self.side * self.scale.length) ** 2

    @property
    def saturated(self) -> float:
        """Vapour pressure of saturation [Pa]."""
        return float(law.saturation_vapor_pressure(self.temperature))

    @property
    def full(self) -> float:
        """How many molecules of vapour saturate the air, as far as pressure tells."""
        return self.molecules * self.saturated / self.pressure

    @property
    def vapour(self) -> int:
        """How many molecules of vapour there are at the start."""
        return vapour_molecules(self.molecules, self.humidity * self.saturated, self.pressure)

    @functools.cached_property
    def share(self) -> float:
        """Mean vapour pressure over that of saturation: a little less than 1, if so few molecules can saturate it."""
        room = (self.side * self.scale.length) ** 3 / self._packing[1]
        full = self.saturated * room / (BOLTZMANN * self.temperature)
        return law.isothermal_vapor_number(self.vapour, self.temperature, room).mean / full

    @property
    def flux(self) -> float:
        """How many molecules meet the liquid per area and time once they have settled [1/(m^2 s)]."""
        return self.share * float(law.hertz_knudsen_flux(self.temperature))

    def memory(self, faces: float) -> float:
        r"""Return how long the number of molecules of vapour remembers a chance surplus [s].

        A surplus must find liquid, :math:`4V/A\bar c`, but its latent heat must leave the droplets with the air that
        hits them, and the air with the walls: until then the liquid is too warm to keep it. A hit takes 3 kT along.
        With the share x of the vapour and :math:`\ell = L/kT`,

        .. math:: \frac{4 V}{A \bar c_v} + \frac{x \ell^2}{3} \frac{4 V}{\bar c_a} \left[\frac1A + \frac1{A_w}\right].

        Parameters
        ----------
        faces
            Area of the liquid, in faces of the box.
        """
        latent = law.BINDING_TEMPERATURE / self.temperature - (law.LIQUID_HEAT_CAPACITY - law.VAPOR_HEAT_CAPACITY)
        find, cool = (4.0 * self.side / float(law.mean_speed(1.0, mass)) for mass in (law.WATER_MASS_RATIO, 1.0))
        held = self.saturated / self.pressure * latent**2 / 3.0 * cool * (1.0 / faces + 1.0 / 6.0)
        return float((find / faces + held) * self.scale.time)

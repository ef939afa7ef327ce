"""Moist air in a closed box of one temperature, according to theory: what saturates it, and how soon."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox import theory as law
from atmosbox.scene.moisture import vapour_molecules
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR


@dataclass(frozen=True)
class MoistBox:
    """A cube of moist air between heat baths, with liquid in it.

    There are ``molecules`` of air and vapour together, without volume if ``ideal``; ``temperature`` is that of the
    walls [K], ``pressure`` and ``humidity`` are those of the gas at the start [Pa, 1].

    The excess over saturation condenses; with fewer molecules it fluctuates more:

    >>> box = MoistBox(10_000, 293.15, 1e5, 1.5)
    >>> box.vapour, round(box.full)
    (350, 233)
    """

    molecules: int
    temperature: float
    pressure: float
    humidity: float
    ideal: bool = False

    @classmethod
    def of(cls, settings: Any, *, ideal: bool) -> MoistBox:
        """Return the air of a scene with the settings molecules, temperature, pressure and humidity."""
        si = settings.si
        return cls(settings.molecules, si.temperature, si.pressure, si.humidity, ideal)

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
            before, density = density, math.sqrt(density * wanted / factor)
            if density == before:
                break
        return density, factor

    @property
    def side(self) -> float:
        """Side of the cube that centres can reach [diameter]."""
        return rounded(float((self.molecules / self._packing[0]) ** (1.0 / 3.0)))

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
        """Number of molecules of vapour that saturates the air, by the ratio of the pressures."""
        return self.molecules * self.saturated / self.pressure

    @property
    def vapour(self) -> int:
        """Number of molecules of vapour at the start."""
        return vapour_molecules(self.molecules, self.humidity * self.saturated, self.pressure)

    def share_at(self, temperature: float) -> float:
        """Return the mean vapour pressure over that of saturation between walls of a temperature [K].

        It is below 1 if there is hardly enough water to saturate the air.
        """
        room = (self.side * self.scale.length) ** 3 / self._packing[1]
        full = float(law.saturation_vapor_pressure(temperature)) * room / (BOLTZMANN * temperature)
        return law.isothermal_vapor_number(self.vapour, temperature, room).mean / full

    def flux_at(self, temperature: float) -> float:
        """Return how many molecules hit the liquid per area and time in equilibrium at a temperature [1/(m^2 s)]."""
        return self.share_at(temperature) * float(law.hertz_knudsen_flux(temperature))

    def over_drops(self, liquid: ArrayLike, drops: ArrayLike, ball: float) -> NDArray[np.float64]:
        r"""Return the vapour pressure over drops in equilibrium, over that of saturation.

        A drop that takes up a molecule pushes the gas away from the volume v that the molecule fills, which includes
        the volume excluded to the centres of others. That work raises the vapour pressure (Poynting),

        .. math:: e = e_s\, e^{n v} \frac{L + 1}{L + D} .

        The volume of real molecules is too small to show this: drops s times too wide have s^3 times the volume. The
        last factor counts the ways to divide L molecules among D drops; an empty drop has none to lose.

        >>> air = MoistBox(10_000, 293.15, 1e5, 1.5)
        >>> [round(float(air.over_drops(300, 1, size * 0.52)), 3) for size in (1, 6, 8)]
        [1.001, 1.176, 1.467]
        """
        liquid, drops = np.asarray(liquid, np.float64), np.asarray(drops, np.float64)
        radius = ball * np.cbrt(1.0 + liquid / drops)
        volume = 4.0 / 3.0 * math.pi * ball**3 * (1.0 + 0.5 / radius) ** 2
        room = self.side**3 - drops * 4.0 / 3.0 * math.pi * (radius + 0.5) ** 3
        gas = self.molecules - liquid
        return np.asarray(np.exp(gas / room * volume) * (liquid + 1.0) / (liquid + drops))

    def memory(self, faces: float) -> float:
        r"""Return the correlation time of the number of molecules of vapour [s].

        Surplus vapour must reach the liquid, :math:`4V/A\bar c`; in addition its latent heat must pass from the
        droplets to the air that hits them, and from the air to the walls: until then the liquid is too warm to keep the
        molecules. A hit carries 3 kT. With the share x of the vapour and :math:`\ell = L/kT`,

        .. math:: \frac{4 V}{A \bar c_v} + \frac{x \ell^2}{3} \frac{4 V}{\bar c_a} \left[\frac1A + \frac1{A_w}\right].
        """
        latent = law.BINDING_TEMPERATURE / self.temperature - (law.LIQUID_HEAT_CAPACITY - law.VAPOR_HEAT_CAPACITY)
        find, cool = (4.0 * self.side / float(law.mean_speed(1.0, mass)) for mass in (law.WATER_MASS_RATIO, 1.0))
        held = self.saturated / self.pressure * latent**2 / 3.0 * cool * (1.0 / faces + 1.0 / 6.0)
        return float((find / faces + held) * self.scale.time)


def refuse_vapour_alone(settings: Any) -> None:
    """Refuse so much vapour that no air is left."""
    most = settings.si.pressure / float(law.saturation_vapor_pressure(settings.si.temperature))
    if settings.si.humidity > most:
        place = f"{settings.pressure:g} hPa and {settings.temperature:g} degC"
        problem = f"needs more than the whole pressure at {place}"
        raise settings.refusal("humidity", problem, at_most=math.floor(100.0 * most))

"""The ascent of a parcel of moist air according to theory, and checks of its settings."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.errors import Setting, SettingError
from atmosbox.scene.moisture import nuclei_heat_capacity, vapour_molecules
from atmosbox.scene.piston import free_time_of, size_of_parcel
from atmosbox.scene.units import Scale
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

Array = NDArray[np.float64]
FLATNESS = 0.1
"""Height of the box over its width at the start.

The droplets flow with the air, the faster the higher they are, and the random pushes of the molecules on them do random
work: there is less of it in a low box, see `atmosbox.scene.ascent.drawn_parcels`.
"""
RAIN = 0.05
"""Rate at which each molecule in excess of what the cloud holds falls out as rain, per mean free time at the start.

Few molecules are liquid, and their number fluctuates: at a higher rate each random surplus would rain before it is
gone.
"""


@dataclass(frozen=True)
class MoistAscent:
    """The ascent of moist air according to theory.

    At the start there are ``molecules`` of air and vapour together, of a ``diameter`` [m], at ``temperature`` [K],
    ``pressure`` and ``vapour_pressure`` [Pa]. ``route`` is the pressure of the environment at equal intervals of time,
    from the start to the end [Pa], ``length`` the duration in mean free times at the start, and ``area`` that of all
    droplets, in units of the floor of the box at the start. ``most_liquid`` is how much liquid the cloud holds before
    it rains, as mass per mass of dry air [kg kg-1]; infinite if it does not rain.
    """

    molecules: int
    diameter: float
    temperature: float
    pressure: float
    vapour_pressure: float
    route: tuple[float, ...]
    length: float
    area: float
    most_liquid: float = math.inf

    @classmethod
    def of(
        cls, settings: Any, length: float, route: Array, temperature: float, pressure: float, dewpoint: float
    ) -> MoistAscent:
        """Return the ascent of a scene with the settings molecules, diameter, area, rain and cloud_water."""
        return cls(
            molecules=settings.molecules,
            diameter=settings.si.diameter,
            temperature=temperature,
            pressure=pressure,
            vapour_pressure=float(law.saturation_vapor_pressure(dewpoint)),
            route=tuple(route.tolist()),
            length=length,
            area=settings.area,
            most_liquid=settings.si.cloud_water if settings.rain else math.inf,
        )

    @classmethod
    def over_ground(cls, settings: Any, length: float, heights: Sequence[float] | Array) -> MoistAscent:
        """Return the ascent through these heights [m] in air of a constant lapse rate; see `of`."""
        si = settings.si
        route = law.environment_pressure(heights, si.temperature, si.pressure, si.lapse_rate)
        return cls.of(settings, length, route, si.temperature, si.pressure, si.dewpoint)

    @property
    def top_pressure(self) -> float:
        """Lowest pressure of the ascent [Pa]."""
        return min(self.route)

    @property
    def scale(self) -> Scale:
        """The units of the box."""
        return Scale(self.diameter, DRY_AIR.molecule_mass, BOLTZMANN * self.temperature)

    def box(self, *, ideal: bool) -> tuple[float, Array, float]:
        """Return density, sides within reach of the centres, and (Z - 1) / n at the start; see `size_of_parcel`."""
        return size_of_parcel(self.scale, self.molecules, self.pressure, ideal=ideal, flatness=FLATNESS)

    def mean_free_time(self, *, ideal: bool) -> float:
        """Return the mean free time at the start, in units of the box."""
        return free_time_of(self.box(ideal=ideal)[0], ideal=ideal)

    @property
    def vapour(self) -> int:
        """Number of molecules of vapour at the start."""
        return vapour_molecules(self.molecules, self.vapour_pressure, self.pressure)

    @property
    def total_water(self) -> float:
        """Mass of water per mass of dry air [kg kg-1]; whole molecules make it differ a little from the setting."""
        return law.WATER_MASS_RATIO * self.vapour / (self.molecules - self.vapour)

    @property
    def nuclei(self) -> float:
        """Heat capacity of the nuclei, in k."""
        return nuclei_heat_capacity(self.molecules - self.vapour)

    @property
    def nuclei_heat(self) -> float:
        """Heat capacity of the nuclei per molecule of air, in k."""
        return self.nuclei / (self.molecules - self.vapour)

    @property
    def keeps(self) -> int:
        """Number of molecules of liquid that the cloud holds before it rains; 0 if it does not rain."""
        air = self.molecules - self.vapour
        return round(self.most_liquid / law.WATER_MASS_RATIO * air) if self.rains else 0

    @property
    def rains(self) -> bool:
        """Whether liquid falls out."""
        return math.isfinite(self.most_liquid)

    def path(self, pressure: Array, share: Array) -> law.ParcelPath:
        """Return temperature and water at pressures [Pa] that are met at these shares of the time, 0 to 1."""
        start = self.pressure, self.temperature, self.total_water
        if not self.rains:
            return law.parcel_path(pressure, *start, nuclei_heat=self.nuclei_heat)
        rain = RAIN, self.most_liquid, self.nuclei_heat
        return law.raining_path(share * self.length, pressure, *start, *rain)

    @functools.cached_property
    def planned(self) -> tuple[Array, law.ParcelPath]:
        """The shares of the time at the points of the route, and the path along the route."""
        shares = np.linspace(0.0, 1.0, len(self.route))
        return shares, self.path(np.array(self.route), shares)

    def planned_at(self, pressure: float) -> law.ParcelPath:
        """Return temperature and water where the route first meets a pressure [Pa]."""
        path = self.planned[1]
        rising = slice(0, int(np.argmin(self.route)) + 1)
        where = np.log(np.array(self.route)[rising])[::-1]
        return law.ParcelPath(*(np.interp(np.log([pressure]), where, each[rising][::-1]) for each in path))

    @property
    def base(self) -> float:
        """Pressure of the lifting condensation level [Pa], 0 if the air is dry."""
        if not self.vapour:
            return 0.0
        e = self.pressure * self.vapour / self.molecules
        dewpoint = min(float(law.dewpoint(e)), self.temperature)
        return float(law.lcl(self.pressure, self.temperature, dewpoint, self.nuclei_heat)[0])

    @property
    def levels(self) -> tuple[float, ...]:
        """Pressures at which the temperature is compared with the adiabat [Pa]."""
        shown = dict.fromkeys((85_000.0, 70_000.0, 50_000.0, self.top_pressure))
        return tuple(p for p in shown if self.top_pressure <= p < self.pressure)


def refuse_descent(top_pressure: float, ground_pressure: float, ground: str = "the pressure at the ground") -> None:
    """Refuse an ascent that does not go up.

    >>> refuse_descent(990.0, 1000.0)
    Traceback (most recent call last):
        ...
    atmosbox.errors.SettingError: top_pressure = 990 hPa is not below the pressure at the ground, 1000 hPa:
    give top_pressure="300hPa".
    """
    if top_pressure > 0.98 * ground_pressure:
        problem, lower = f"is not below {ground}, {ground_pressure:g} hPa", f"{0.3 * ground_pressure:.0f}hPa"
        raise SettingError("top_pressure", f"{top_pressure:g} hPa", problem, Setting("top_pressure", lower))


def refuse_supersaturation(dewpoint: float, temperature: float) -> None:
    """Refuse a dewpoint above the temperature, both in degC.

    >>> refuse_supersaturation(26.0, 25.0)
    Traceback (most recent call last):
    ...
    atmosbox.errors.SettingError: dewpoint = 26 degC is above the temperature, 25 degC,
    so the air would be supersaturated: give dewpoint="25degC" for saturated air.
    """
    if dewpoint > temperature:
        problem = f"is above the temperature, {temperature:g} degC, so the air would be supersaturated"
        highest = Setting("dewpoint", f"{temperature:g}degC")
        raise SettingError("dewpoint", f"{dewpoint:g} degC", problem, highest, " for saturated air")

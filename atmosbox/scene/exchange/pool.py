"""Air over a pool at constant pressure, according to theory: its equilibrium, and the molecules that leave the pool."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.engine.core.lift import stiffness
from atmosbox.scene.headline import Headline
from atmosbox.scene.moisture import vapour_molecules
from atmosbox.scene.piston import size_of_parcel
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

FLATNESS = 0.3
"""Height of the box over its width: in a flatter box every molecule hits the pool more often."""
CLOSING = 5.0
"""Time in which the piston closes a gap in pressure [mean free times], at least three times what sound needs."""
AIR_HEAT = 3.5
"""Heat capacity of a molecule of air at constant pressure, in k."""

_stiffness = getattr(stiffness, "py_func", stiffness)  # called once: not worth compiling


@dataclass
class AirOverPool:
    """Air over a pool under a piston that keeps the pressure.

    At the start there are ``molecules`` of air and vapour together, and ``pool`` molecules in the liquid, all of one
    ``diameter`` [m] and without volume if ``ideal``; ``temperature`` [K], ``pressure`` and ``vapour_pressure`` [Pa] are
    those at the start.

    Attributes
    ----------
    density, sides, excess
        See `size_of_parcel`.
    vapour, air
        Numbers of molecules at the start.
    free_time, exchange, closing, settling
        Mean free time; mean time until a molecule of vapour hits the pool; time in which the piston closes a gap in
        pressure; and time to equilibrium [reduced time].
    """

    molecules: int
    pool: int
    diameter: float
    temperature: float
    pressure: float
    vapour_pressure: float
    ideal: bool = False

    def __post_init__(self) -> None:
        self.scale = Scale(self.diameter, DRY_AIR.molecule_mass, BOLTZMANN * self.temperature)
        self.density, self.sides, self.excess = size_of_parcel(
            self.scale, self.molecules, self.pressure, ideal=self.ideal, flatness=FLATNESS
        )
        self.vapour = vapour_molecules(self.molecules, self.vapour_pressure, self.pressure)
        self.air = self.molecules - self.vapour
        self.free_time = rounded(float(law.mean_free_time(self.density, 1.0, 1.0, 1.0)))
        height = float(self.sides[2])
        speed = float(law.mean_speed(1.0, law.WATER_MASS_RATIO))
        self.exchange = 4.0 * height / speed
        diffusing = 12.0 * height**2 / (math.pi**2 * self.free_time * speed**2)
        self.closing = max(CLOSING * self.free_time, 3.0 * height / math.sqrt(1.4))
        self.settling = 5.0 * max(self.exchange + diffusing, self.closing)

    @property
    def memory(self) -> float:
        """Correlation time of the number of molecules of vapour [s]."""
        return 0.5 * (self.exchange + self.free_time) * self.scale.time

    @property
    def end(self) -> law.EvaporationEquilibrium:
        """Final state of a large parcel, from the balance of enthalpy."""
        return law.evaporation_equilibrium(self.pressure, self.temperature, self.air, self.vapour, self.pool)

    @functools.cached_property
    def rest(self) -> law.IsobaricWater:
        """Mean final state of a parcel of so few molecules."""
        return law.isobaric_water(self.pressure, self.temperature, self.air, self.vapour, self.pool)

    @property
    def floor(self) -> float:
        """Area of the pool [m^2]."""
        return float(self.sides[0] * self.sides[1]) * self.scale.length**2

    def vapour_pressure_at(self, temperature: float) -> float:
        """Return the vapour pressure between walls of a temperature [K]: saturation, or that of all the water [Pa].

        A small pool in a warm room dries up:

        >>> room = AirOverPool(1000, 10, 3.7e-10, 293.15, 1e5, 1000.0)
        >>> [round(room.vapour_pressure_at(kelvin)) for kelvin in (283.15, 303.15)]
        [1227, 1980]
        """
        water = self.vapour + self.pool
        return min(float(law.saturation_vapor_pressure(temperature)), self.pressure * water / (water + self.air))

    def rate(self, vapour_pressure: NDArray[np.float64] | float, temperature: NDArray[np.float64] | float) -> Any:
        """Return the number of molecules of vapour that hit the pool per time [1/s]."""
        flux = law.hertz_knudsen_flux(temperature)
        return flux * vapour_pressure / law.saturation_vapor_pressure(temperature) * self.floor

    @property
    def latent(self) -> float:
        """Latent heat of a molecule at the end, over kT; also d ln e_s / d ln T."""
        return law.BINDING_TEMPERATURE / self.rest.temperature - law.LIQUID_HEAT_CAPACITY + law.VAPOR_HEAT_CAPACITY

    @property
    def heat_capacity(self) -> float:
        """Heat capacity of gas and pool at the end, at constant pressure and without the latent heat, in k."""
        rest = self.rest
        gas = AIR_HEAT * self.air + law.VAPOR_HEAT_CAPACITY * rest.vapor
        return gas + law.LIQUID_HEAT_CAPACITY * max(self.pool + self.vapour - rest.vapor, 0.0)

    def loss(self, time: float) -> float:
        r"""Return how much heat the piston may have taken until a time [reduced], as cooling of the whole parcel [K].

        The piston moves a little after the pressure has changed: while it recedes, the inner pressure is above the
        outer one, and the gas does more work than is needed; while the piston closes in, less. A sudden change S of ln
        p costs :math:`S^2 / 2 \Gamma` of p V. The fluctuations of ln p that the heat exchange between pool and air
        causes cost their variance over :math:`\Gamma`, once in each time that the piston needs.
        """
        rest = self.rest
        later = self.air + rest.vapor
        change = math.log(later * rest.temperature / (self.molecules * self.temperature))
        all_of_it = self.heat_capacity - later
        gas = (AIR_HEAT - 1.0) * self.air + (law.VAPOR_HEAT_CAPACITY - 1.0) * rest.vapor
        noise = 1.0 / gas - 1.0 / all_of_it + rest.variance * (self.latent / all_of_it) ** 2
        lost = (0.5 * change**2 + noise * time / self.closing) / _stiffness(1.0, 2.0 * gas / later)
        return float(self.temperature * later / self.heat_capacity * lost)

    def walk(self, time: float) -> float:
        r"""Return the standard deviation of that heat from run to run, as temperature [K].

        The variance of the work is twice the work lost, in units of kT (Jarzynski 1997,
        doi:10.1103/PhysRevLett.78.2690).
        """
        return math.sqrt(2.0 * self.rest.temperature * self.loss(time) / self.heat_capacity)


def temperature_of_those_that_left(dataset: xr.Dataset) -> float:
    """Return the mean temperature of the liquid at the moments when molecules left it [K]; NaN if none did.

    If the liquid has no temperature in some frames, that of the gas is taken: a pool that disappears now and then
    consists of a molecule or two that came from the gas, and has its temperature.
    """
    always = bool(np.isfinite(dataset.liquid_temperature.values).all())
    warm = (dataset.liquid_temperature if always else dataset.gas_temperature).values
    rate = dataset.evaporation_rate.values
    return float(np.average(warm, weights=rate)) if rate.any() else math.nan


def energy_of_those_that_leave(dataset: xr.Dataset, start: AirOverPool, few: int) -> tuple[Headline, ...]:
    """Return the mean energy of the molecules that leave, if many have left a pool of many molecules."""
    left = float(dataset.evaporation_rate.mean() * dataset.elapsed_time[-1]) * 1e-9
    if min(left, start.pool) < few or not np.isfinite(dataset.liquid_temperature.values).all():
        return ()
    warm = temperature_of_those_that_left(dataset)
    middle, width = dataset.energy.values, np.diff(dataset.energy_bnds.values)[:, 0]
    share = dataset.leaving_energy_probability_density.values * width
    mean = float(middle @ share)
    flux = BOLTZMANN * law.LEAVING_FREEDOM * warm
    answer = BOLTZMANN * law.BINDING_TEMPERATURE + flux
    error = math.sqrt(float((middle - mean) ** 2 @ share) / left)
    known = flux * law.BINDING_TEMPERATURE / warm / (law.LIQUID_HEAT_CAPACITY * start.pool)
    reason = "a pool of few molecules evaporates more while it is warm by chance"
    name, label = "energy_of_those_that_leave", "energy of leaving molecules"
    return (Headline(name, mean, error, answer, known, reason, "J", "zJ", label),)

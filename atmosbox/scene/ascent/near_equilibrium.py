r"""A parcel with a cloud, close to its equilibrium: how fast vapour and heat relax, and how far they fluctuate.

Two quantities may be out of equilibrium: the number n of liquid molecules and the energy E of the liquid. Let x be the
deviation of (n, E) from its equilibrium value. The second derivatives of the entropy, :math:`S = -\tfrac12 x^T G x`,
give the size of the fluctuations and the forces :math:`-G x` that drive x back; the rates at which molecules hit the
droplets give Onsager's matrix L, so that

.. math:: \dot x = -L G x + \text{noise}, \qquad \langle x x^T \rangle = G^{-1} .

G and L both follow from what is put into the box; nothing is fitted. Energies are in units of kT, times in mean free
times at the start.

References
----------
Onsager, L. (1931), doi:10.1103/PhysRev.37.405. Landau and Lifshitz, Statistical Physics, part 1, sections 110 and 118
to 120.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.way import RAIN, MoistAscent

Array = NDArray[np.float64]
_CARRIED = np.array([[1.0, 3.5], [3.5, 3.5**2 + 3.5]])
"""Means of 1, e and e^2 for a molecule that hits a droplet: its energy e has mean 7/2 kT and variance 7/2 (kT)^2."""
_NO_VAPOUR = 1e-6
"""Molecules of vapour, and relative humidity, that dry air is given, so that no logarithm is infinite."""
_AIR_HEAT = 3.0
"""Variance of the energy of a molecule of air that hits a droplet, in (kT)^2: 2 of its flight, 1 of its rotation."""


class Cloud(NamedTuple):
    """The parcel at some moments of its ascent; see the head of this file.

    ``moment`` is in mean free times at the start; ``resists : (moment, 2, 2)`` is G and ``yields : (moment, 2, 2)`` is
    L; ``warms : (moment, 2)`` is the derivative of the logarithm of the gas temperature by x at constant volume.
    """

    moment: Array
    pressure: Array
    """[Pa]."""
    temperature: Array
    """[K]."""
    vapour: Array
    """Molecules of vapour according to theory."""
    liquid: Array
    """Molecules of liquid according to theory, which leaves out clusters in clear air."""
    clustered: Array
    """Mean number of liquid molecules that fluctuations add to ``liquid``."""
    haze: Array
    """Molecules of liquid that air without a cloud holds at most; what is more is a cloud. See `cloud_along`."""
    resists: Array
    yields: Array
    warms: Array
    clear_heat: Array
    """Heat capacity of the whole parcel at constant pressure if no vapour condenses, in k."""
    slope: Array
    """d ln T / d ln p along the adiabat."""
    expansion: Array
    """Time derivative of the logarithm of the volume."""
    height: Array
    """Height of the box over the thermal speed sqrt(kT/m) of air [mean free times]."""
    free_time: Array
    """Mean free time of the gas, in mean free times at the start."""
    meets: Array
    """Mean time until a molecule of air hits the mist."""
    hits: Array
    """Number of molecules that hit or leave the mist per unit of time."""

    liquid_heat: Array
    """Heat capacity of liquid and nuclei, in k."""
    air: float
    """Molecules of dry air."""
    all_molecules: int
    """Molecules of air and water at the start."""
    humidity: Array
    """Relative humidity, at most 1."""
    keeps: float
    """Molecules of liquid that the cloud holds before it rains; infinite if it does not rain."""
    rains: float
    """Rate at which each molecule in excess of ``keeps`` falls out."""
    rained: Array
    """Molecules that have rained according to theory."""

    @property
    def cloudy_heat(self) -> Array:
        """Heat capacity of the whole parcel at constant pressure with the heat of condensation, in k."""
        return np.asarray(self.clear_heat + self.vapour * (1.0 + self.vapour / self.air) * self.latent**2)

    @property
    def dries(self) -> Array:
        """Number of molecules of vapour that a cloud gains per unit of entropy, which is k, at constant pressure."""
        return np.asarray(self.vapour * (1.0 + self.vapour / self.air) * self.latent / self.cloudy_heat)

    @property
    def heat(self) -> Array:
        """Heat capacity of the whole parcel at constant pressure according to theory, in k: with or without a cloud."""
        return np.where(self.liquid > 0.0, self.cloudy_heat, self.clear_heat)

    @property
    def gas(self) -> Array:
        """Molecules of the gas."""
        return self.air + self.vapour

    def seen(self, *, density: bool = False) -> Array:
        """Return how far a unit of x shifts the gas from the adiabat, as a share of T.

        The adiabat is taken at the pressure that the gas has after the shift.
        """
        gone = np.array([1.0, 0.0]) / self.gas[:, None]
        slope = (self.density_slope if density else self.slope)[:, None]
        return np.asarray(self.warms - density * gone - slope * (self.warms - gone))

    @property
    def behind(self) -> Array:
        """Return how far x lags behind its equilibrium while the cloud grows, (moment, 2)."""
        relaxes = np.einsum("tij,tjk->tik", self.yields, self.resists)
        return np.asarray(np.linalg.solve(relaxes, self.change[:, :, None])[:, :, 0])

    @property
    def liquid_scatter(self) -> Array:
        """Standard deviation of the number of liquid molecules, (moment,)."""
        return np.asarray(np.sqrt(np.linalg.inv(self.resists)[:, 0, 0]))

    def clusters(self, *, density: bool = False) -> Array:
        """Return by how much molecules in clusters warm the parcel, as a share of T or of the density temperature."""
        latent = self.latent - (3.5 if density else 0.0)  # they are missing among the light molecules of the gas
        return latent * self.clustered / (3.5 * self.all_molecules)

    @property
    def density_slope(self) -> Array:
        """The slope d ln T / d ln p of the adiabat for the density temperature, which depends on the vapour, too."""
        return np.asarray(self.slope + self.vapour_slope / self.gas)

    @property
    def vapour_slope(self) -> Array:
        """Derivative of the number of molecules of vapour by ln p along the adiabat: zero in clear air."""
        share = self.vapour / self.air
        along = self.vapour * (1.0 + share) * (self.latent * self.slope - 1.0)
        return np.where(self.liquid > 0.0, along, 0.0)

    @property
    def latent(self) -> Array:
        """Latent heat of a molecule, in kT."""
        excess = law.LIQUID_HEAT_CAPACITY - law.VAPOR_HEAT_CAPACITY
        return np.asarray(law.BINDING_TEMPERATURE / self.temperature - excess)

    @property
    def change(self) -> Array:
        """Rate at which x has to change so that the parcel stays on theory's adiabat, (moment, 2)."""
        condenses = -np.gradient(self.vapour, self.moment)
        binding, capacity = law.BINDING_TEMPERATURE / self.temperature, law.LIQUID_HEAT_CAPACITY
        warming = np.gradient(np.log(self.temperature), self.moment) * self.liquid_heat
        return np.stack([condenses, warming + (capacity - binding) * condenses], axis=1)


def _counted(vapour: Array, liquid: Array, humidity: Array, warming: Array) -> tuple[Array, Array]:
    r"""Return mean and variance of the number n of liquid molecules of so few that n cannot be negative.

    One more is as likely as the relative humidity says; each molecule that joins is missing in the vapour, and warms
    the air. So :math:`P(n + 1) / P(n) = f \, (v + l - n) / v \, e^{-b (n + 1/2 - l)}`.

    Examples
    --------
    In clear air the mean is RH / (1 - RH), in a cloud that of theory:

    >>> many, few = np.array([1e6]), np.array([1e-5])
    >>> for liquid, humidity in ((0.0, 0.75), (9000.0, 1.0)):
    ...     mean, variance = _counted(many, np.array([liquid]), np.array([humidity]), few)
    ...     print(f"{mean[0]:.1f} +- {variance[0] ** 0.5:.1f}")
    3.0 +- 3.5
    9000.0 +- 301.5
    """
    far = 9.0 / np.sqrt(warming + 1.0 / vapour)
    n = np.maximum(np.floor(liquid - far), 0.0)[:, None] + np.arange(int(2.0 * far.max()) + 40)
    left = np.maximum((vapour + liquid)[:, None] - n, 1e-300) / vapour[:, None]
    ratio = np.log(humidity[:, None] * left) - warming[:, None] * (n + 0.5 - liquid[:, None])
    power = np.cumsum(ratio, axis=1) - ratio
    chance = np.exp(power - power.max(axis=1, keepdims=True))
    chance /= chance.sum(axis=1, keepdims=True)
    mean = np.sum(n * chance, axis=1)
    return mean, np.sum((n - mean[:, None]) ** 2 * chance, axis=1)


def cloud_along(
    ascent: MoistAscent, pressure: Array, share: Array, *, ideal: bool = False, path: law.ParcelPath | None = None
) -> Cloud:
    r"""Return the parcel along its ascent, according to theory.

    In clear air the number n of molecules in clusters cannot be negative: it varies less, and G is larger.

    **What is a cloud.** Air without a cloud holds the most liquid by chance, called haze here, where it is saturated:
    n >= 0 then has a probability nearly proportional to :math:`e^{-(n - 1/2)^2 / 2 s^2}`, where :math:`s^2` is the
    variance of the liquid in a cloud. A cloud is liquid above the mean of this haze plus three standard deviations,

    .. math:: n > \langle n \rangle + 3 \sigma \approx \left[\sqrt{2/\pi} + 3 \sqrt{1 - 2/\pi}\right] s
              \approx 2.6 \, s .

    Examples
    --------
    In the cloud of the scene lifting-moist the number of liquid molecules scatters by a dozen at 700 hPa:

    >>> from atmosbox import scenarios
    >>> from atmosbox.simulation.preparation import prepare
    >>> ascent = scenarios.load("lifting-moist")._ascent(prepare("lifting-moist", {}).settings)
    >>> cloud = cloud_along(ascent, np.array([7.05e4, 7.0e4, 6.95e4]), np.array([0.25, 0.255, 0.26]))
    >>> round(float(np.sqrt(np.linalg.inv(cloud.resists)[1, 0, 0])))
    12

    Liquid is a cloud if it is more than chance puts together, some 31 molecules there:

    >>> round(float(cloud.haze[1]))
    31
    """
    path = path or ascent.path(pressure, share)
    t, moment = path.temperature, share * ascent.length
    air = float(ascent.molecules - ascent.vapour)
    vapour = np.maximum(path.vapor / law.WATER_MASS_RATIO * air, _NO_VAPOUR)
    liquid = np.maximum(path.liquid, 0.0) / law.WATER_MASS_RATIO * air
    humidity = law.vapor_pressure(pressure, path.vapor) / law.saturation_vapor_pressure(t)
    humidity = np.where(liquid > 0.0, 1.0, np.clip(humidity, _NO_VAPOUR, 1.0))
    binding, capacity = law.BINDING_TEMPERATURE / t, law.LIQUID_HEAT_CAPACITY
    gas_heat = 2.5 * air + 3.0 * vapour
    warms = np.stack([3.0 / gas_heat, -1.0 / gas_heat], axis=1)

    def stiffness(liquid_heat: Array) -> Array:
        """Return G: minus the derivative by x of the forces that drive molecules and energy from gas to liquid."""
        warmer = np.stack([(binding - capacity) / liquid_heat, 1.0 / liquid_heat], axis=1)
        driven = -3.0 * warms + (capacity - binding)[:, None] * warmer
        driven[:, 0] -= 1.0 / vapour
        return -np.stack([driven, warms - warmer], axis=1)

    free = np.linalg.inv(stiffness(ascent.nuclei + capacity * liquid))[:, 0, 0]
    warming = np.maximum(1.0 / free - 1.0 / vapour, 1e-12)
    mean, variance = _counted(vapour, liquid, humidity, warming)
    clustered = mean - liquid
    haze, scatter = _counted(vapour, np.zeros_like(free), np.ones_like(free), warming)
    liquid_heat = ascent.nuclei + capacity * (liquid + clustered)
    resists = stiffness(liquid_heat)
    resists[:, 0, 0] += np.maximum(1.0 / np.maximum(variance, 1e-9) - 1.0 / free, 0.0)

    density, sides, _ = ascent.box(ideal=ideal)
    packed = law.packing_fraction(density * (pressure / ascent.pressure) / (t / ascent.temperature), 1.0)
    squeezed = 1.0 if ideal else law.compressibility_factor(packed)
    tall = float(sides[2]) * ascent.pressure / pressure * t / ascent.temperature / ascent.mean_free_time(ideal=ideal)
    thermal = np.sqrt(t / ascent.temperature)
    meets = 4.0 * tall / (ascent.area * thermal * squeezed)
    of_air, of_vapour = (meets / float(law.mean_speed(1.0, mass)) for mass in (1.0, law.WATER_MASS_RATIO))
    condenses, hits = vapour * humidity / of_vapour, air / of_air
    free_time = ascent.pressure / pressure * thermal
    yields = condenses[:, None, None] * _CARRIED
    yields[:, 1, 1] += _AIR_HEAT * air / of_air

    held, latent = vapour / air, binding - (capacity - law.VAPOR_HEAT_CAPACITY)
    heat = 3.5 + ascent.nuclei_heat + law.VAPOR_HEAT_CAPACITY * held + capacity * liquid / air
    wet = heat + held * (1.0 + held) * latent**2
    slope = np.where(liquid > 0.0, (1.0 + held) * (1.0 + held * latent) / wet, (1.0 + held) / heat)
    return Cloud(
        moment=moment,
        pressure=pressure,
        temperature=t,
        vapour=vapour,
        liquid=liquid,
        clustered=np.asarray(clustered),
        haze=np.asarray(haze + 3.0 * np.sqrt(scatter)),
        resists=resists,
        yields=yields,
        warms=warms,
        clear_heat=air * heat,
        slope=slope,
        expansion=np.gradient(np.log(t) - np.log(pressure), moment),
        height=np.asarray(tall / thermal),
        free_time=np.asarray(free_time),
        meets=np.asarray(of_air),
        hits=np.asarray(hits + condenses),
        liquid_heat=np.asarray(liquid_heat),
        air=air,
        all_molecules=ascent.molecules,
        humidity=humidity,
        keeps=float(ascent.keeps) if ascent.rains else math.inf,
        rains=RAIN if ascent.rains else 0.0,
        rained=path.rain / law.WATER_MASS_RATIO * air,
    )

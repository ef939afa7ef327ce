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


class Cloud:
    r"""The parcel at some moments of its ascent, according to theory; see the head of this file.

    In clear air the number n of molecules in clusters cannot be negative: it varies less, and G is larger.

    **What is a cloud.** Air without a cloud holds the most liquid by chance, called haze here, where it is saturated:
    n >= 0 then has a probability nearly proportional to :math:`e^{-(n - 1/2)^2 / 2 s^2}`, where :math:`s^2` is the
    variance of the liquid in a cloud. A cloud is liquid above the mean of this haze plus three standard deviations,

    .. math:: n > \langle n \rangle + 3 \sigma \approx \left[\sqrt{2/\pi} + 3 \sqrt{1 - 2/\pi}\right] s
              \approx 2.6 \, s .

    It is made for pressures : (moment,) in the order in which the parcel meets them [Pa], and the share of the time of
    the whole ascent, 0 to 1, that has passed at each. With ``ideal``, molecules have no volume; ``path`` are
    temperature and water at these pressures, if they are known already.

    Attributes
    ----------
    moment, pressure, temperature : (moment,)
        Time [mean free times at the start], pressure [Pa] and temperature [K].
    vapour, gas, liquid, rained
        Numbers of molecules of vapour, of vapour and air, of liquid and of rain, without clusters in clear air.
    clustered, haze
        Mean number of liquid molecules that fluctuations add to ``liquid``; number above which liquid is a cloud.
    resists, yields, warms
        G and L, (moment, 2, 2); derivative by x of the logarithm of the gas temperature, at constant volume,
        (moment, 2).
    clear_heat, cloudy_heat, liquid_heat
        Heat capacities [k]: of the parcel at constant pressure, without and with condensation; of liquid and nuclei.
    dries
        Number of molecules of vapour that a cloud gains per unit of entropy, which is k, at constant pressure.
    slope, vapour_slope, expansion
        Along the adiabat d ln T / d ln p, and the derivative of the number of molecules of vapour by ln p, zero in
        clear air; and the time derivative of the logarithm of the volume.
    height
        Height of the box over the thermal speed sqrt(kT/m) of air [mean free times].
    free_time, meets, hits
        Mean free time; mean time until a molecule of air hits the mist; number of molecules that hit or leave the mist
        per unit of time.
    humidity, latent
        Relative humidity, at most 1; latent heat of a molecule [kT].
    air, all_molecules
        Molecules of dry air, and of air and water at the start.
    keeps, rains
        Molecules of liquid that the cloud holds before it rains, infinite if it does not rain; and the rate at which
        each molecule in excess falls out.

    In the cloud of the scene lifting-moist the number of liquid molecules scatters by a dozen at 700 hPa, and some 31
    may be liquid there by chance:

    >>> from atmosbox import scenarios
    >>> from atmosbox.simulation.preparation import prepare
    >>> ascent = scenarios.load("lifting-moist")._ascent(prepare("lifting-moist", {}).settings)
    >>> cloud = Cloud(ascent, np.array([7.05e4, 7.0e4, 6.95e4]), np.array([0.25, 0.255, 0.26]))
    >>> round(float(cloud.liquid_scatter[1])), round(float(cloud.haze[1]))
    (12, 31)
    """

    def __init__(
        self, ascent: MoistAscent, pressure: Array, share: Array, *, ideal: bool = False,
        path: law.ParcelPath | None = None,
    ) -> None:  # fmt: skip
        path = path or ascent.path(pressure, share)
        self.pressure, self.temperature, self.moment = pressure, path.temperature, share * ascent.length
        t = self.temperature
        self.all_molecules, self.air = ascent.molecules, float(ascent.molecules - ascent.vapour)
        per_mass = self.air / law.WATER_MASS_RATIO
        self.vapour: Array = np.maximum(path.vapor * per_mass, _NO_VAPOUR)
        self.gas: Array = self.air + self.vapour
        self.liquid: Array = np.maximum(path.liquid, 0.0) * per_mass
        self.rained: Array = path.rain * per_mass
        self.keeps = float(ascent.keeps) if ascent.rains else math.inf
        self.rains = RAIN if ascent.rains else 0.0
        humidity = law.vapor_pressure(pressure, path.vapor) / law.saturation_vapor_pressure(t)
        self.humidity = np.where(self.liquid > 0.0, 1.0, np.clip(humidity, _NO_VAPOUR, 1.0))
        self.latent: Array = law.BINDING_TEMPERATURE / t - (law.LIQUID_HEAT_CAPACITY - law.VAPOR_HEAT_CAPACITY)
        gas_heat = 2.5 * self.air + 3.0 * self.vapour
        self.warms = np.stack([3.0 / gas_heat, -1.0 / gas_heat], axis=1)

        capacity = law.LIQUID_HEAT_CAPACITY
        free = np.linalg.inv(self._stiffness(ascent.nuclei + capacity * self.liquid))[:, 0, 0]
        warming = np.maximum(1.0 / free - 1.0 / self.vapour, 1e-12)
        mean, variance = _counted(self.vapour, self.liquid, self.humidity, warming)
        self.clustered = mean - self.liquid
        haze, scatter = _counted(self.vapour, np.zeros_like(free), np.ones_like(free), warming)
        self.haze: Array = haze + 3.0 * np.sqrt(scatter)
        self.liquid_heat: Array = ascent.nuclei + capacity * (self.liquid + self.clustered)
        self.resists = self._stiffness(self.liquid_heat)
        self.resists[:, 0, 0] += np.maximum(1.0 / np.maximum(variance, 1e-9) - 1.0 / free, 0.0)

        density, sides, _ = ascent.box(ideal=ideal)
        hot, thin = t / ascent.temperature, ascent.pressure / pressure
        squeezed = 1.0 if ideal else law.compressibility_factor(law.packing_fraction(density / thin / hot, 1.0))
        tall = float(sides[2]) * thin * hot / ascent.mean_free_time(ideal=ideal)
        thermal = np.sqrt(hot)
        meets = 4.0 * tall / (ascent.area * thermal * squeezed)
        self.meets, of_vapour = (meets / float(law.mean_speed(1.0, mass)) for mass in (1.0, law.WATER_MASS_RATIO))
        condenses, hits = self.vapour * self.humidity / of_vapour, self.air / self.meets
        self.height, self.free_time, self.hits = tall / thermal, thin * thermal, hits + condenses
        self.yields = condenses[:, None, None] * _CARRIED
        self.yields[:, 1, 1] += _AIR_HEAT * hits

        held = self.vapour / self.air
        heat = 3.5 + ascent.nuclei_heat + law.VAPOR_HEAT_CAPACITY * held + capacity * self.liquid / self.air
        wet = heat + held * (1.0 + held) * self.latent**2
        self.clear_heat: Array = self.air * heat
        self.cloudy_heat: Array = self.clear_heat + self.vapour * (1.0 + held) * self.latent**2
        self.dries: Array = self.vapour * (1.0 + held) * self.latent / self.cloudy_heat
        cloudy = (1.0 + held) * (1.0 + held * self.latent) / wet
        self.slope = np.where(self.liquid > 0.0, cloudy, (1.0 + held) / heat)
        gains = self.vapour * (1.0 + held) * (self.latent * self.slope - 1.0)
        self.vapour_slope: Array = np.where(self.liquid > 0.0, gains, 0.0)
        self.expansion: Array = np.gradient(np.log(t) - np.log(pressure), self.moment)

    def _stiffness(self, liquid_heat: Array) -> Array:
        """Return G: minus the derivative by x of the forces that drive molecules and energy from gas to liquid."""
        excess = law.BINDING_TEMPERATURE / self.temperature - law.LIQUID_HEAT_CAPACITY
        warmer = np.stack([excess / liquid_heat, 1.0 / liquid_heat], axis=1)
        driven = -3.0 * self.warms - excess[:, None] * warmer
        driven[:, 0] -= 1.0 / self.vapour
        return -np.stack([driven, self.warms - warmer], axis=1)

    def seen(self, *, density: bool = False) -> Array:
        """Return how far a unit of x shifts the gas from the adiabat, as a share of T.

        The adiabat is taken at the pressure that the gas has after the shift.
        """
        gone = np.array([1.0, 0.0]) / self.gas[:, None]
        # the density temperature depends on the vapour, too
        slope = self.slope + self.vapour_slope / self.gas if density else self.slope
        return np.asarray(self.warms - density * gone - slope[:, None] * (self.warms - gone))

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

r"""A parcel with a cloud, close to its equilibrium: how fast vapour and heat come to rest, how far they scatter.

Two things may be out of balance: how many molecules n are liquid, and how much energy E the liquid holds. The second
derivatives of the entropy, :math:`S = -\tfrac12 x^T G x` for x = (n, E), say how far they scatter, and how hard they
are driven back; the counted rates at which molecules meet the droplets make Onsager's matrix L, so that

.. math:: \dot x = -L G x + \text{noise}, \qquad \langle x x^T \rangle = G^{-1} .

Both follow from what is put into the box; nothing is fitted. Energies are over kT, times in mean free times at the
start.

References
----------
Onsager, L. (1931), doi:10.1103/PhysRev.37.405. Landau and Lifshitz, Statistical Physics, part 1, sections 110 and 118
to 120.
"""

from __future__ import annotations

import functools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.way import MoistAscent

__all__ = ["Cloud", "cloud_along"]

Array = NDArray[np.float64]
_CARRIED = np.array([[1.0, 3.5], [3.5, 3.5**2 + 3.5]])
"""A molecule arrives with 7/2 kT on average, of variance 7/2: means of 1, e and e^2."""
_NO_VAPOUR = 1e-6
"""Molecules of vapour, and relative humidity, of dry air: so that no logarithm is infinite."""


class Cloud(NamedTuple):
    """The parcel at some moments of its way; see the head of this file.

    ``moment`` is in mean free times; ``resists : (moment, 2, 2)`` is G and ``yields : (moment, 2, 2)`` is L;
    ``warms : (moment, 2)`` by how much a change of x warms the gas, as a share of its temperature, at constant volume.
    """

    moment: Array
    pressure: Array
    """[Pa]."""
    temperature: Array
    """[K]."""
    vapour: Array
    """Molecules of vapour, by theory."""
    liquid: Array
    """Molecules of liquid, by theory, that forgets clusters in clear air."""
    clustered: Array
    """Molecules that chance adds to those."""
    resists: Array
    yields: Array
    warms: Array
    air_heat: Array
    """Heat capacity of the gas at constant volume, in k."""
    heat: Array
    """Heat capacity at constant pressure of all, that of condensing included, in k."""
    slope: Array
    """d ln T / d ln p along the adiabat."""
    expansion: Array
    """Rate at which the logarithm of the volume grows."""
    height: Array
    """Height of the box over the thermal speed sqrt(kT/m) of air [mean free times]."""
    free_time: Array
    """Mean free time of the gas."""
    meets: Array
    """How long a molecule of air flies until it meets the mist."""
    hits: Array
    """How many molecules meet or leave the mist per time."""

    liquid_heat: Array
    """Heat capacity of liquid and nuclei, in k."""
    bounded: Array
    """How much longer the number of liquid molecules is remembered because it cannot be less than none, 1 to 2."""
    air: float
    """Molecules of dry air."""

    @property
    def forgets(self) -> Array:
        """The matrix L by which fluctuations are forgotten, (moment, 2, 2)."""
        part = (1.0 - 1.0 / self.bounded) * self.yields[:, 0, 0]
        return np.asarray(self.yields - part[:, None, None] * _CARRIED)

    @property
    def gas(self) -> Array:
        """Molecules of the gas."""
        return self.air + self.vapour

    def seen(self, *, density: bool = False) -> Array:
        """Return by how much x shifts the gas from the adiabat at the pressure that it then has, as a share of T.

        Parameters
        ----------
        density
            Whether the density temperature is meant, which counts the molecules of vapour that are lost, too.

        Returns
        -------
        (moment, 2) ndarray
        """
        gone = np.array([1.0, 0.0]) / self.gas[:, None]
        slope = (self.density_slope if density else self.slope)[:, None]
        return np.asarray(self.warms - density * gone - slope * (self.warms - gone))

    @property
    def density_slope(self) -> Array:
        """The same slope of the density temperature, to which the vapour counts."""
        return np.asarray(self.slope + self.vapour_slope / self.gas)

    @property
    def vapour_slope(self) -> Array:
        """By how many molecules of vapour there are more for a rise of ln p along the adiabat: none in clear air."""
        share = self.vapour / self.air
        along = self.vapour * (1.0 + share) * (self.latent * self.slope - 1.0)
        return np.where(self.liquid > 0.0, along, 0.0)

    @property
    def latent(self) -> Array:
        """Latent heat of a molecule over kT."""
        excess = law.LIQUID_HEAT_CAPACITY - law.VAPOR_HEAT_CAPACITY
        return np.asarray(law.BINDING_TEMPERATURE / self.temperature - excess)

    @property
    def pressure_scatter(self) -> Array:
        """Variance of the logarithm of the pressure, at constant volume."""
        row = self.warms - np.array([1.0, 0.0]) / self.gas[:, None]
        return np.asarray(np.einsum("ti,tij,tj->t", row, np.linalg.inv(self.resists), row))

    @property
    def change(self) -> Array:
        """How fast theory's x changes on the way, (moment, 2)."""
        condenses = -np.gradient(self.vapour, self.moment)
        binding, capacity = law.BINDING_TEMPERATURE / self.temperature, law.LIQUID_HEAT_CAPACITY
        warming = np.gradient(np.log(self.temperature), self.moment) * self.liquid_heat
        return np.stack([condenses, warming + (capacity - binding) * condenses], axis=1)


def _counted(mode: Array, scatter: Array) -> tuple[Array, Array]:
    r"""Return mean and variance of a whole number n, none or more, with the chance :math:`e^{-(n - m)^2 / 2 s^2}`.

    Examples
    --------
    >>> [round(float(each[0]), 3) for each in _counted(np.array([0.0, 40.0]), np.array([1.0, 4.0]))]
    [0.52, 0.444]
    >>> [round(float(each[1]), 3) for each in _counted(np.array([0.0, 40.0]), np.array([1.0, 4.0]))]
    [40.0, 16.0]
    """
    low = np.maximum(np.floor(mode - 8.0 * scatter), 0.0)
    n = low[:, None] + np.arange(int(np.ceil(18.0 * scatter.max())) + 2)
    power = -0.5 * ((n - mode[:, None]) / scatter[:, None]) ** 2
    chance = np.exp(power - power.max(axis=1, keepdims=True))
    chance /= chance.sum(axis=1, keepdims=True)
    mean = np.sum(n * chance, axis=1)
    return mean, np.sum((n - mean[:, None]) ** 2 * chance, axis=1)


@functools.cache
def _memories() -> tuple[Array, Array]:
    r"""Return a = m/s, and how much longer a number that scatters about m, but cannot be less than none, is remembered.

    Diffusion with the density f keeps its correlation for :math:`\int g^2/f \, dx` over its variance, with
    :math:`g(x) = \int_x^\infty (y - \bar x) f dy`: once for a normal distribution, twice for an exponential one.
    """
    a = np.linspace(-30.0, 6.0, 145)
    widest = np.where(a < 0.0, 30.0 / (1.0 + np.abs(a)), 10.0 + a)
    x = np.linspace(0.0, 1.0, 4001) * widest[:, None]
    shape = np.exp(-0.5 * x * (x - 2.0 * a[:, None]))
    step = x[:, 1:2]
    density = shape / (shape.sum(axis=1, keepdims=True) - 0.5 * (shape[:, :1] + shape[:, -1:])) / step
    mean = np.sum(x * density, axis=1) * step[:, 0]
    moment = (x - mean[:, None]) * density
    variance = np.sum((x - mean[:, None]) ** 2 * density, axis=1) * step[:, 0]
    tail = np.cumsum((0.5 * (moment[:, 1:] + moment[:, :-1]))[:, ::-1], axis=1)[:, ::-1] * step
    kept = np.sum(tail**2 / np.maximum(density[:, :-1], 1e-250), axis=1) * step[:, 0]
    return a, kept / variance**2


def _longer(a: Array) -> Array:
    """Return how much longer a number is remembered that cannot be less than none, by its mean over its scatter.

    Examples
    --------
    >>> _longer(np.array([-20.0, 0.0, 5.0])).round(2)
    array([1.97, 1.27, 1.  ])
    """
    return np.interp(a, *_memories())


def cloud_along(
    ascent: MoistAscent, pressure: Array, share: Array, *, ideal: bool = False, path: law.ParcelPath | None = None
) -> Cloud:
    r"""Return the parcel along its way, by theory.

    The chance that n molecules are clustered is a product of relative humidities, one for each that joins, and each
    lowers the next: it leaves the vapour, and warms the air. In clear air, where n cannot be less than none, the mean
    is nearly RH / (1 - RH). There G is as stiff as the variance is small.

    Parameters
    ----------
    ascent
        The way.
    pressure : (moment,)
        Pressures in the order in which they are met [Pa].
    share : (moment,)
        Which share of the time has passed by then.
    ideal
        Whether molecules have no volume.
    path
        Temperature and water there, if they are known already.

    Examples
    --------
    In the cloud of the scene lifting-moist the number of liquid molecules scatters by a dozen at 700 hPa:

    >>> from atmosbox import scenarios
    >>> from atmosbox.simulation.preparation import prepare
    >>> ascent = scenarios.load("lifting-moist")._ascent(prepare("lifting-moist", {}).settings)
    >>> cloud = cloud_along(ascent, np.array([7.05e4, 7.0e4, 6.95e4]), np.array([0.25, 0.255, 0.26]))
    >>> round(float(np.sqrt(np.linalg.inv(cloud.resists)[1, 0, 0])))
    12
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
        """Return G: minus what drives molecules and energy from gas to liquid, for a change of either."""
        warmer = np.stack([(binding - capacity) / liquid_heat, 1.0 / liquid_heat], axis=1)
        driven = -3.0 * warms + (capacity - binding)[:, None] * warmer
        driven[:, 0] -= 1.0 / vapour
        return -np.stack([driven, warms - warmer], axis=1)

    free = np.linalg.inv(stiffness(ascent.nuclei + capacity * liquid))[:, 0, 0]
    # the last to join and the first to leave are half a molecule from the whole number where both are as likely
    mode = 0.5 + np.where(liquid > 0.0, liquid, np.log(humidity) * free)
    mean, variance = _counted(mode, np.sqrt(free))
    clustered = mean - liquid
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
    yields = condenses[:, None, None] * _CARRIED
    yields[:, 1, 1] += 3.0 * hits  # a molecule of air shares 3 kT with the liquid

    held, latent = vapour / air, binding - (capacity - law.VAPOR_HEAT_CAPACITY)
    heat = 3.5 + ascent.nuclei_heat + law.VAPOR_HEAT_CAPACITY * held
    wet = heat + capacity * liquid / air + held * (1.0 + held) * latent**2
    slope = np.where(liquid > 0.0, (1.0 + held) * (1.0 + held * latent) / wet, (1.0 + held) / heat)
    return Cloud(
        moment=moment,
        pressure=pressure,
        temperature=t,
        vapour=vapour,
        liquid=liquid,
        clustered=np.asarray(clustered),
        resists=resists,
        yields=yields,
        warms=warms,
        air_heat=np.asarray(gas_heat),
        heat=air * np.where(liquid > 0.0, wet, heat),
        slope=slope,
        expansion=np.gradient(np.log(t) - np.log(pressure), moment),
        height=np.asarray(tall / thermal),
        free_time=np.asarray(ascent.pressure / pressure * thermal),
        meets=np.asarray(of_air),
        hits=np.asarray(hits + condenses),
        liquid_heat=np.asarray(liquid_heat),
        bounded=_longer(mode / np.sqrt(free)),
        air=air,
    )

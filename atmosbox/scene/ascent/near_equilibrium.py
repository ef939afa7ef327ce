r"""A parcel with a cloud, close to its equilibrium: how fast vapour and heat relax, and how far they fluctuate.

Two quantities may be out of equilibrium: the number n of liquid molecules and the energy E of the liquid. Let x be the
deviation of (n, E) from its equilibrium value. The second derivatives of the entropy, :math:`S = -\tfrac12 x^T G x`,
give the size of the fluctuations and the forces :math:`-G x` that drive x back; the rates at which molecules hit the
droplets give Onsager's matrix L, so that

.. math:: \dot x = -L G x + \text{noise}, \qquad \langle x x^T \rangle = G^{-1} .

G and L both follow from what is put into the box; nothing is fitted. Energies are in units of kT, times in mean free
times at the start.

**The speeds near the droplets.** Fast molecules reach the droplets first; slow molecules stay behind until a collision
makes them fast. If collisions were so frequent that the speeds always had the Maxwell distribution, L would count the
molecules that hit the droplets. In a small box, whose droplets are nearer than a mean free path, L is smaller by a
fifth, and a deviation lasts longer by as much. Let collisions restore the Maxwell distribution f at the rate
:math:`\nu`, and let the gas have the distribution :math:`f (1 + \varphi)` beside a liquid with the force :math:`\psi`.
If hydrodynamics takes the flux s from the gas, the steady state is :math:`k v (\varphi - \psi) + \nu \varphi = -s`,
where k v is the rate at which a molecule of speed v hits the droplets. Here :math:`\psi` and s are linear combinations
of the quantities that collisions conserve, B = (1 for vapour, 1 for air, energy), and :math:`\varphi` is orthogonal to
all of B. With the sums over the molecules of the distribution f, :math:`M = \langle B B \rangle` and :math:`S = \langle
B B / (k v + \nu) \rangle`, the flux per force is

.. math:: L = M S^{-1} M - \nu M .

References
----------
Onsager, L. (1931), doi:10.1103/PhysRev.37.405. Landau and Lifshitz, Statistical Physics, part 1, sections 110 and 118
to 120. Bhatnagar, Gross and Krook (1954), doi:10.1103/PhysRev.94.511, for collisions that restore the distribution at
one rate.
"""

from __future__ import annotations

import functools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.way import RAIN, MoistAscent

__all__ = ["Cloud", "cloud_along"]

Array = NDArray[np.float64]
_CARRIED = np.array([[1.0, 3.5], [3.5, 3.5**2 + 3.5]])
"""Means of 1, e and e^2 for a molecule that hits a droplet: its energy e has mean 7/2 kT and variance 7/2 (kT)^2."""
_NO_VAPOUR = 1e-6
"""Molecules of vapour, and relative humidity, that dry air is given, so that no logarithm is infinite."""
_NODES, _FASTEST = 48, 6.0
"""Number of nodes of the sums over speeds, and the largest speed, in units of sqrt(2 kT/m)."""
_AIR_ROTATION, _VAPOUR_ROTATION = 1.0, 1.5
"""Mean energy of the rotation of a molecule, in kT; also its variance, in (kT)^2."""
_SPEEDS = 1.5 * 1.016 * 1.25
"""Relaxation time of the distribution of speeds [mean free times]: three halves of that of a shear.

Theory gives this for the fourth moment of the velocity. A rotation takes 2, a molecule of water in air 1.4; L differs
by a hundredth between these two times.
"""


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
    air_heat: Array
    """Heat capacity of the gas at constant volume, in k."""
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
    bounded: Array
    """Factor, 1 to 2, by which a fluctuation of the liquid lasts longer because no number of molecules is negative."""
    air: float
    """Molecules of dry air."""
    humidity: Array
    """Relative humidity, at most 1."""
    keeps: float
    """Molecules of liquid that the cloud holds before it rains; infinite if it does not rain."""
    rains: float
    """Rate at which each molecule in excess of ``keeps`` falls out."""

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
    def forgets(self) -> Array:
        """The matrix L that sets how fast fluctuations decay, (moment, 2, 2)."""
        part = (1.0 - 1.0 / self.bounded) * self.yields[:, 0, 0]
        return np.asarray(self.yields - part[:, None, None] * _CARRIED)

    @property
    def gas(self) -> Array:
        """Molecules of the gas."""
        return self.air + self.vapour

    def seen(self, *, density: bool = False) -> Array:
        """Return how far a unit of x shifts the gas from the adiabat, as a share of T.

        The adiabat is taken at the pressure that the gas has after the shift.

        Parameters
        ----------
        density
            Whether to take the density temperature, which also depends on the molecules of vapour that have condensed.

        Returns
        -------
        (moment, 2) ndarray
        """
        gone = np.array([1.0, 0.0]) / self.gas[:, None]
        slope = (self.density_slope if density else self.slope)[:, None]
        return np.asarray(self.warms - density * gone - slope * (self.warms - gone))

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
    def pressure_scatter(self) -> Array:
        """Variance of the logarithm of the pressure, at constant volume."""
        row = self.warms - np.array([1.0, 0.0]) / self.gas[:, None]
        return np.asarray(np.einsum("ti,tij,tj->t", row, np.linalg.inv(self.resists), row))

    @property
    def change(self) -> Array:
        """Rate at which x has to change so that the parcel stays on theory's adiabat, (moment, 2)."""
        condenses = -np.gradient(self.vapour, self.moment)
        binding, capacity = law.BINDING_TEMPERATURE / self.temperature, law.LIQUID_HEAT_CAPACITY
        warming = np.gradient(np.log(self.temperature), self.moment) * self.liquid_heat
        return np.stack([condenses, warming + (capacity - binding) * condenses], axis=1)


def _counted(mode: Array, scatter: Array) -> tuple[Array, Array]:
    r"""Return mean and variance of an integer n >= 0 with a probability proportional to :math:`e^{-(n - m)^2 / 2 s^2}`.

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
    r"""Return values of a = m/s, and how much longer a fluctuation lasts about m if the number cannot be negative.

    Diffusion with the stationary density f has the correlation time :math:`\int g^2/f \, dx` over the variance, with
    :math:`g(x) = \int_x^\infty (y - \bar x) f dy`. In units of the correlation time of a normal distribution with the
    same variance this is 1 for a normal distribution and 2 for an exponential one.
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
    """Return how much longer a fluctuation lasts if the number cannot be negative, for a = m/s as in `_memories`.

    Examples
    --------
    >>> _longer(np.array([-20.0, 0.0, 5.0])).round(2)
    array([1.97, 1.27, 1.  ])
    """
    return np.interp(a, *_memories())


def _conducts(vapour: Array, air: float, vapour_meets: Array, air_meets: Array, speeds: Array) -> Array:
    """Return L of vapour and air.

    Parameters
    ----------
    vapour, air
        Numbers of molecules; vapour : (moment,).
    vapour_meets, air_meets : (moment,)
        Mean times until a molecule of either gas hits the droplets.
    speeds : (moment,)
        Relaxation time of the distribution of speeds.

    Examples
    --------
    With very frequent collisions L counts the molecules that hit the droplets and the energy that they carry; a lack of
    fast molecules makes it less:

    >>> one = np.ones(1)
    >>> for speeds in (1e-4, 1.9):
    ...     print(_conducts(40.0 * one, 2000.0, 0.5 * one, 0.6 * one, speeds * one)[0].round())
    [[   80.   280.]
     [  280. 11259.]]
    [[  68.  237.]
     [ 237. 9205.]]
    """
    root, weight = np.polynomial.legendre.leggauss(_NODES)
    c = 0.5 * _FASTEST * (root + 1.0)
    weight = weight * c * c * np.exp(-c * c)
    weight /= weight.sum()
    often = c / np.sum(weight * c)
    found = np.zeros((2, len(vapour), 3, 3))  # S and M
    root_vapour, root_air = np.sqrt(vapour), np.full_like(vapour, math.sqrt(air))
    for k, (number, meets, r) in enumerate(
        ((root_vapour, vapour_meets, _VAPOUR_ROTATION), (root_air, air_meets, _AIR_ROTATION))
    ):
        waits = weight / (often / meets[:, None] + 1.0 / speeds[:, None])
        for matrix, at in zip(found, (waits, np.broadcast_to(weight, waits.shape)), strict=True):
            none, one, two = (np.sum(at * c**power, axis=1) for power in (0, 2, 4))
            share = number / root_air
            matrix[:, k, k] = none
            matrix[:, k, 2] = matrix[:, 2, k] = share * (one + r * none)
            matrix[:, 2, 2] += share * share * (two + 2.0 * r * one + (r * r + r) * none)
    waiting, kept = found
    whole = kept @ np.linalg.solve(waiting, kept) - kept / speeds[:, None, None]
    # the net flux of air into the liquid is zero
    pair = np.linalg.inv(np.linalg.inv(whole)[:, ::2, ::2])
    size = np.stack([root_vapour, root_air], axis=1)
    return np.asarray(pair * size[:, :, None] * size[:, None, :])


def cloud_along(
    ascent: MoistAscent, pressure: Array, share: Array, *, ideal: bool = False, path: law.ParcelPath | None = None
) -> Cloud:
    r"""Return the parcel along its ascent, according to theory.

    The probability that n molecules are in clusters is a product of relative humidities, one for each molecule that
    joins; each molecule lowers the next factor, because it leaves the vapour and warms the air. In clear air, where n
    cannot be negative, the mean is nearly RH / (1 - RH), and G is the larger the smaller the variance is there.

    **What is a cloud.** Air without a cloud holds the most liquid by chance, called haze here, where it is saturated:
    n >= 0 then has a probability proportional to :math:`e^{-(n - 1/2)^2 / 2 s^2}`, where :math:`s^2` is the variance of
    the liquid in a cloud. A cloud is liquid above the mean of this haze plus three of its standard deviations,

    .. math:: n > \langle n \rangle + 3 \sigma \approx \left[\sqrt{2/\pi} + 3 \sqrt{1 - 2/\pi}\right] s
              \approx 2.6 \, s .

    Parameters
    ----------
    ascent
        The ascent.
    pressure : (moment,)
        Pressures in the order in which the parcel meets them [Pa].
    share : (moment,)
        Share of the time of the whole ascent that has passed at each of them, 0 to 1.
    ideal
        Whether molecules have no volume.
    path
        Temperature and water at these pressures, if they are known already.

    Examples
    --------
    In the cloud of the scene lifting-moist the number of liquid molecules scatters by a dozen at 700 hPa:

    >>> from atmosbox import scenarios
    >>> from atmosbox.simulation.preparation import prepare
    >>> ascent = scenarios.load("lifting-moist")._ascent(prepare("lifting-moist", {}).settings)
    >>> cloud = cloud_along(ascent, np.array([7.05e4, 7.0e4, 6.95e4]), np.array([0.25, 0.255, 0.26]))
    >>> round(float(np.sqrt(np.linalg.inv(cloud.resists)[1, 0, 0])))
    12

    Liquid is a cloud if it is more than chance puts together, some 32 molecules there:

    >>> round(float(cloud.haze[1]))
    32
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
    # where joining and leaving are equally likely, n and n + 1 are equally probable: the peak is halfway between them
    mode = 0.5 + np.where(liquid > 0.0, liquid, np.log(humidity) * free)
    mean, variance = _counted(mode, np.sqrt(free))
    clustered = mean - liquid
    haze, scatter = _counted(np.full_like(free, 0.5), np.sqrt(free))
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
    yields = _conducts(vapour * humidity, air, of_vapour, of_air, _SPEEDS * free_time)

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
        air_heat=np.asarray(gas_heat),
        clear_heat=air * heat,
        slope=slope,
        expansion=np.gradient(np.log(t) - np.log(pressure), moment),
        height=np.asarray(tall / thermal),
        free_time=np.asarray(free_time),
        meets=np.asarray(of_air),
        hits=np.asarray(hits + condenses),
        liquid_heat=np.asarray(liquid_heat),
        bounded=_longer(mode / np.sqrt(free)),
        air=air,
        humidity=humidity,
        keeps=float(ascent.keeps) if ascent.rains else math.inf,
        rains=RAIN if ascent.rains else 0.0,
    )

"""Drops of two kinds in a closed box of moist air, according to theory: they grow and shrink, and share the vapour."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox import theory as law
from atmosbox.scene.exchange.moist_box import MoistBox
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

Array = NDArray[np.float64]


@dataclass(frozen=True)
class DropKind:
    """Drops that are alike: their number, the dissolved particles in each, and the volume of its core [m^3]."""

    count: int
    particles: float
    core: float


@dataclass(frozen=True)
class DropGrowth:
    r"""Drops that share the vapour of a box, at one temperature, by the law of Hertz and Knudsen.

    A drop whose radius is drawn w times too large catches vapour on its area a. It loses as many molecules as the
    humidity :math:`S_n` in balance with it would supply,

    .. math:: \dot n = J\, [a_n S - a_{n-1} S_n], \qquad S = (W - \textstyle\sum n) / W_s

    with the flux J of saturated vapour, the number W of all molecules of water in the box, and the number :math:`W_s`
    of molecules of vapour that saturates the space outside the drops.

    ``box`` is the moist air at the start, without the drops; each drop of the ``kinds`` starts with ``water``
    molecules; ``width`` is w, and ``tension`` the surface tension [N/m].

    Without salt, drops of sixty molecules evaporate completely at a humidity of 250 %:

    >>> growth = DropGrowth(MoistBox(6000, 293.15, 1e4, 2.5), (DropKind(2, 0.0, 3e-29),), 60, 3.0, 0.0727)
    >>> number, humidity = growth.path(np.array([0.0, 1e-7]))
    >>> number.round(1).tolist()
    [[60.0, 0.0]]
    """

    box: MoistBox
    kinds: tuple[DropKind, ...]
    water: int
    width: float
    tension: float

    def radius(self, number: ArrayLike, kind: DropKind) -> Array:
        """Return the real radius of a drop of ``number`` molecules [m]."""
        return law.drop_radius(number, law.WATER_VOLUME, kind.core)

    def area(self, number: ArrayLike, kind: DropKind) -> Array:
        """Return the area on which the centres of molecules hit a drop [m^2]."""
        return np.asarray(4.0 * np.pi * (self.width * self.radius(number, kind) + 0.5 * DRY_AIR.diameter) ** 2)

    def over(self, number: ArrayLike, kind: DropKind) -> Array:
        """Return the humidity in balance with a drop, taken at n - 1/2 molecules, halfway between n - 1 and n.

        A drop in the box is so wide that it also pushes the gas away from the volume that it gains (Poynting).
        """
        n = np.asarray(number, np.float64)
        half = np.maximum(n - 0.5, 0.0)
        curved = law.kelvin_radius(self.tension, law.WATER_VOLUME, BOLTZMANN * self.box.temperature)
        surface = curved / self.radius(half, kind)
        reach = 1.0 + 0.5 * DRY_AIR.diameter / self.width / self.radius(n, kind)
        volume = law.WATER_VOLUME * self.width**3 * reach**2
        room = (self.box.side * self.box.scale.length) ** 3
        activity = n / (n + kind.particles) if kind.particles else np.minimum(n, 1.0)
        return np.asarray(activity * np.exp(surface + self.box.molecules / room * volume))

    @functools.cached_property
    def flux(self) -> float:
        """Flux of saturated vapour that hits an area [1/(m^2 s)]."""
        return float(law.hertz_knudsen_flux(self.box.temperature))

    def humidity(self, number: Array) -> Array:
        """Return the relative humidity when each drop of a kind holds ``number : (kind, ...)`` molecules."""
        volume = (self.box.side * self.box.scale.length) ** 3
        water = float(self.box.vapour + self.water * sum(kind.count for kind in self.kinds))
        vapour, room = np.full(number.shape[1:], water), np.ones(number.shape[1:])
        for n, kind in zip(number, self.kinds, strict=True):
            reach = np.asarray(self.width * self.radius(n, kind) + 0.5 * DRY_AIR.diameter, np.float64)
            room -= 4.0 / 3.0 * np.pi * kind.count / volume * (reach * reach * reach)
            vapour -= kind.count * n
        return np.asarray(vapour / (self.box.full * room))

    def rates(self, number: Array, humidity: ArrayLike) -> Array:
        """Return how many molecules a drop of each kind gains per time [1/s], at a relative humidity."""
        air, gained = np.asarray(humidity, np.float64), []
        for n, kind in zip(number, self.kinds, strict=True):
            lost = self.area(np.maximum(n - 1.0, 0.0), kind) * self.over(n, kind)
            gained.append(self.area(n, kind) * air - lost)
        return self.flux * np.array(gained)

    def path(self, time: Array) -> tuple[Array, Array]:
        """Return the numbers of molecules in a drop of each kind, ``(kind, time)``, and the humidity, ``(time,)``."""
        return _path(self, tuple(time.tolist()))

    def scatter(self, time: Array, number: Array, humidity: Array) -> tuple[Array, Array]:
        r"""Return the variance of the mean number of molecules in the drops of the first kind, and its memory [s].

        Molecules hit and leave a drop at random, :math:`2 J a S` times per unit of time. The mean of c drops returns
        within the time :math:`\tau`, because vapour in the drops is missing in the air, and by the law of Koehler:

        .. math:: \frac1\tau = J a \left[\frac{c}{W_s} + \frac{dS_n}{dn}\right], \qquad
                  \dot V = \frac{2 J a S}{c} - \frac{2 V}{\tau} .
        """
        kind, n = self.kinds[0], number[0]
        steep = 0.5 * (self.over(n + 1.0, kind) - self.over(np.maximum(n - 1.0, 0.0), kind))
        flux = self.flux * self.area(n, kind)
        back = flux * (kind.count / self.box.full + steep)
        gained, variance = 2.0 * flux * humidity / kind.count, np.zeros(len(time))
        for k in range(1, len(time)):
            decayed = -np.expm1(-2.0 * back[k] * (time[k] - time[k - 1]))
            variance[k] = variance[k - 1] * (1.0 - decayed) + gained[k] / (2.0 * back[k]) * decayed
        return variance, 1.0 / np.abs(back)


@functools.lru_cache(maxsize=2)
def _path(growth: DropGrowth, time: tuple[float, ...]) -> tuple[Array, Array]:
    """Return the path of `DropGrowth.path`, which curves and headlines of a run both need."""
    from scipy import integrate  # loads slowly

    def slope(_: float, number: Array) -> Array:
        held = np.maximum(number, 0.0)
        return growth.rates(held, growth.humidity(held))

    start = np.full(len(growth.kinds), float(growth.water))
    found = integrate.solve_ivp(slope, (0.0, time[-1]), start, "LSODA", time, rtol=1e-8, atol=1e-8)
    number = np.maximum(found.y, 0.0)
    return number, growth.humidity(number)

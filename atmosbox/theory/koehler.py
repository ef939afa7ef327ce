r"""The vapour pressure over a drop: Kelvin's law of its curvature, and Koehler's law of the salt in it.

A drop of n molecules of volume v has the radius r and the surface energy :math:`4 \pi \gamma r^2`. A molecule that
leaves reduces the surface energy by :math:`2 \gamma v / r`, and so leaves more easily. Dissolved particles reduce the
share of water molecules, and fewer of them leave. The first effect decreases as one over the radius, the second as one
over its cube: over a drop with salt in it the vapour pressure has a maximum. At a higher humidity the drop grows
without end.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats, require_not_negative, require_positive
from atmosbox.theory._water import CRITICAL_TEMPERATURE, checked_temperature
from atmosbox.theory.constants import AVOGADRO, WATER

__all__ = [
    "SALT_VOLUME",
    "WATER_VOLUME",
    "CriticalDrop",
    "critical_drop",
    "drop_radius",
    "humidity_over_drop",
    "kelvin_radius",
    "water_surface_tension",
]

WATER_VOLUME: float = WATER.molar_mass / 998.2 / AVOGADRO
"""Volume of a molecule in liquid water at 20 degC, 998.2 kg m-3 [m3]."""
SALT_VOLUME: float = 58.44e-3 / 2165.0 / AVOGADRO / 2.0
"""Volume of an ion in a crystal of sodium chloride, 58.44 g/mol and 2165 kg m-3 for a pair [m3]."""


def water_surface_tension(temperature: ArrayLike) -> FloatArray:
    r"""Return the surface tension of water beside its vapour [N/m]; 0 at the critical point.

    .. math:: \gamma = 0.2358\,\mathrm{N/m}\; \tau^{1.256} (1 - 0.625 \tau), \qquad \tau = 1 - T / 647.096\,\mathrm{K}.

    By IAPWS (2014), Revised release on surface tension of ordinary water substance, R1-76(2014).

    Parameters
    ----------
    temperature
        Temperature [K]; below the triple point the water is supercooled, and the formula is extrapolated.

    Examples
    --------
    At 20 degC, in mN/m:

    >>> round(1000.0 * float(water_surface_tension(293.15)), 2)
    72.74
    """
    tau = 1.0 - checked_temperature(as_floats(temperature)) / CRITICAL_TEMPERATURE
    tension: FloatArray = 0.2358 * tau**1.256 * (1.0 - 0.625 * tau)
    return tension


def drop_radius(number: ArrayLike, volume: float, core: float = 0.0) -> FloatArray:
    """Return the radius of a drop of ``number`` molecules.

    Parameters
    ----------
    number
        Number of molecules in the drop.
    volume, core
        Volume of a molecule in the liquid, and of the insoluble core of the drop, or of the salt in it [length^3].

    Examples
    --------
    A hundred molecules of water make a drop of less than a nanometre:

    >>> round(1e9 * float(drop_radius(100, WATER_VOLUME)), 3)
    0.894
    """
    require_positive(volume=volume)
    require_not_negative(core=core)
    radius: FloatArray = np.cbrt(3.0 / (4.0 * np.pi) * (core + volume * as_floats(number)))
    return radius


def kelvin_radius(tension: float, volume: float, kT: float) -> float:
    r"""Return the radius at which curvature multiplies the vapour pressure by e, :math:`2 \gamma v / kT`.

    After Thomson, W. (1871), doi:10.1080/14786447108640606.

    Parameters
    ----------
    tension, volume, kT
        Surface tension [energy/length^2], volume of a molecule [length^3], temperature [energy].

    Examples
    --------
    For water at 20 degC it is a nanometre:

    >>> from atmosbox.theory.constants import BOLTZMANN
    >>> round(1e9 * kelvin_radius(0.07274, WATER_VOLUME, BOLTZMANN * 293.15), 3)
    1.077
    """
    require_not_negative(tension=tension)
    require_positive(volume=volume, kT=kT)
    return 2.0 * tension * volume / kT


def humidity_over_drop(
    number: ArrayLike, tension: float, volume: float, kT: float, *, particles: float = 0.0, core: float = 0.0
) -> FloatArray:
    r"""Return the relative humidity at which a drop neither grows nor shrinks.

    .. math:: \frac{e}{e_s} = \frac{n}{n + s}\, \exp\frac{2 \gamma v}{r\, kT}

    for n molecules of water and s dissolved particles. The first factor is the activity of the water in an ideal
    solution (Raoult), the second is Kelvin's; together they are Koehler's law (1936, doi:10.1039/TF9363201152). When a
    molecule leaves, the surface energy changes by E(n) - E(n - 1), and not by its derivative at n: for few molecules
    the exact ratio is the one at n - 1/2.

    Parameters
    ----------
    number, particles
        Number n of molecules of water in the drop, and number s of dissolved particles: two for each pair of ions.
    tension, volume, kT
        Surface tension [energy/length^2], volume of a molecule [length^3], temperature [energy].
    core
        Volume of the dissolved substance, or of an insoluble nucleus [length^3].

    Examples
    --------
    A thousand molecules of water, pure, and with twenty pairs of ions:

    >>> from atmosbox.theory.constants import BOLTZMANN
    >>> water = {"tension": 0.07274, "volume": WATER_VOLUME, "kT": BOLTZMANN * 293.15}
    >>> [round(float(humidity_over_drop(1000, **water, particles=s)), 3) for s in (0, 40)]
    [1.749, 1.682]
    """
    require_not_negative(particles=particles)
    n = as_floats(number)
    radius = drop_radius(n, volume, core)
    humidity: FloatArray = n / (n + particles) * np.exp(kelvin_radius(tension, volume, kT) / radius)
    return humidity


class CriticalDrop(NamedTuple):
    """The drop over which the humidity in balance with it is highest.

    ``number`` of its molecules of water, its ``radius`` [length], and the relative ``humidity`` over it [1].
    """

    number: float
    radius: float
    humidity: float


def critical_drop(tension: float, volume: float, kT: float, *, particles: float, core: float = 0.0) -> CriticalDrop:
    r"""Return Koehler's maximum: above its humidity a drop with salt in it grows without end.

    It is where :math:`s / n (n + s) = 2 \gamma v^2 / 4 \pi r^4 kT`. In thin solutions :math:`r_c = \sqrt{3 B / A}` and
    :math:`\ln S_c = 2 A / 3 r_c` with :math:`A = 2 \gamma v / kT` and :math:`B = 3 s v / 4 \pi`.

    Parameters
    ----------
    tension, volume, kT, particles, core
        See `humidity_over_drop`.

    Raises
    ------
    ValueError
        If a number is not above 0, or there are too few particles: then the humidity decreases with the radius
        everywhere.

    Examples
    --------
    A grain of salt 0.1 micrometres wide grows above 100.11 % of humidity, a grain of fifty ions only above 199.28 %:

    >>> from atmosbox.theory.constants import BOLTZMANN
    >>> water = {"tension": 0.07274, "volume": WATER_VOLUME, "kT": BOLTZMANN * 293.15}
    >>> grain = 4.0 / 3.0 * np.pi * 50e-9**3
    >>> for core in (grain, 50 * SALT_VOLUME):
    ...     found = critical_drop(**water, particles=core / SALT_VOLUME, core=core)
    ...     print(f"{1e9 * found.radius:.3g} nm, {100.0 * found.humidity:.5g} %")
    682 nm, 100.11 %
    1.08 nm, 199.28 %
    """
    require_positive(tension=tension, volume=volume, kT=kT, particles=particles)
    reach = kelvin_radius(tension, volume, kT)

    def falls(log_number: float) -> float:
        n = np.exp(log_number)
        radius = float(drop_radius(n, volume, core))
        return float(np.log(reach * volume / (4.0 * np.pi * radius**4)) + np.log(n) + np.log1p(n / particles))

    # the humidity rises from its steepest point, usually at n = s / 2, up to the maximum
    low, high = (np.log(each * particles) for each in (0.5, 1e6 * (1.0 + np.sqrt(particles))))
    if falls(low) >= 0.0:
        low, high = np.log(1e-6), low
        if falls(low) >= 0.0:
            raise ValueError(f"particles = {particles} are too few for a maximum: give more of them.")
    while low < (middle := 0.5 * (low + high)) < high:  # halve the interval until no number lies between
        low, high = (middle, high) if falls(middle) < 0.0 else (low, middle)
    number = float(np.exp(high))
    facts = {"particles": particles, "core": core}
    humidity = float(humidity_over_drop(number, tension, volume, kT, **facts))
    return CriticalDrop(number, float(drop_radius(number, volume, core)), humidity)

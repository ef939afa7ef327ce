"""The errors of the model itself: how far a parcel may be from its adiabat, and a cloud base from its level.

Three things are not as in a cloud of kilometres. The way takes nanoseconds; molecules have volume; and few of
them are vapour, so that a cloud consists of few molecules.
"""

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.way import RAIN, MoistAscent
from atmosbox.scene.piston import CLOSING, size_of_parcel

__all__ = [
    "blur",
    "comparable",
    "finite_rate",
    "haze",
    "lag",
    "least_cloud",
    "rain_scatter",
    "tolerance",
    "walk",
    "warmth_of",
]

Array = NDArray[np.float64]


def finite_rate(ascent: MoistAscent) -> law.Ascent:
    """Return the ascent at a constant rate that has the same finite-rate error; a detour makes the way faster."""
    detour = ascent.travel / math.log(ascent.pressure / ascent.top_pressure)
    return law.Ascent(ascent.pressure, ascent.top_pressure, ascent.length / detour**2, closing=CLOSING)


def walk(ascent: MoistAscent, pressure: Array) -> Array:
    r"""Return the scatter of the temperature by that of the piston's work, as a share of it, by pressure [Pa].

    As in dry air it is :math:`\sqrt{2 s / N} / c_p`, for the entropy s that the finite rate makes per molecule. The
    pressures are in the order in which they are met: the scatter at the lowest so far stays on the way down.
    """
    speed = finite_rate(ascent)
    lowest = np.minimum.accumulate(np.minimum(pressure.ravel(), ascent.pressure))
    gained = np.array([3.5 * speed.finite_speed(float(p)) for p in lowest])
    share: Array = np.sqrt(2.0 * gained.reshape(pressure.shape) / ascent.molecules) / 3.5
    return share


def _latent(temperature: float) -> float:
    """Return the latent heat of a molecule over kT."""
    return law.BINDING_TEMPERATURE / temperature - (law.LIQUID_HEAT_CAPACITY - law.VAPOR_HEAT_CAPACITY)


def warmth_of(water: float, temperature: float) -> float:
    """Return by how much so much water per dry air [kg kg-1] warms the air when it condenses [K]."""
    return temperature * _latent(temperature) / 3.5 * water / law.WATER_MASS_RATIO


def _steepness(ascent: MoistAscent, temperature: float) -> float:
    """Return by how much more a molecule that condenses lowers the relative humidity than by being gone."""
    return 1.0 + ascent.vapour / ascent.molecules * _latent(temperature) ** 2 / 3.5


def _scatter(ascent: MoistAscent, temperature: float) -> float:
    r"""Return by how many molecules the liquid of a saturated parcel scatters.

    The chance that n molecules are liquid is a product of relative humidities, one for each that joins, and each
    lowers the next: it leaves :math:`N_w - 1` of the vapour, and warms the air. So it falls off as
    :math:`\exp[-(1 + x \ell^2 / c_p) (n - \bar n)^2 / 2 N_w]`.
    """
    return math.sqrt(ascent.vapour / _steepness(ascent, temperature))


def blur(ascent: MoistAscent) -> float:
    r"""Return over how much pressure the cloud base is blurred, because few molecules are vapour [Pa].

    The cloud grows out of the clusters of a saturated parcel over a range of humidity of one over their scatter; the
    humidity goes as :math:`p^{1 - \ell \kappa}` on the way up.
    """
    if not ascent.base:
        return 0.0
    t = float(ascent.planned_at(ascent.base).temperature[0])
    return ascent.base / (_scatter(ascent, t) * (_latent(t) / 3.5 - 1.0))


def haze(ascent: MoistAscent, humidity: float, liquid: float, temperature: float) -> float:
    r"""Return how much the molecules warm the air that are clustered beyond what theory has as liquid [K].

    Of a number that scatters by s about m, but cannot be less than none, the mean is :math:`m + s \phi(m/s) /
    \Phi(m/s)`, with the normal density and its integral. In clear air, where theory has no liquid, m is below zero, and
    the mean is nearly RH / (1 - RH); in a cloud it soon is m.

    Parameters
    ----------
    ascent
        The way.
    humidity, liquid, temperature
        Relative humidity [1], liquid per dry air [kg kg-1] and temperature [K] by theory.
    """
    if not ascent.vapour:
        return 0.0
    air = ascent.molecules - ascent.vapour
    scatter = _scatter(ascent, temperature)
    cloudy = max(liquid, 0.0) / law.WATER_MASS_RATIO * air
    mean = cloudy if cloudy > 0.0 else (humidity - 1.0) * scatter**2
    a = max(mean / scatter, -30.0)
    more = scatter * math.sqrt(2.0 / math.pi) * math.exp(-0.5 * a * a) / math.erfc(-a / math.sqrt(2.0))
    return warmth_of(law.WATER_MASS_RATIO * (min(mean, 0.0) + more) / air, temperature)


def least_cloud(ascent: MoistAscent) -> float:
    """Return how much liquid a cloud must hold before it rains, so that no chance surplus does [kg kg-1].

    Three times by how much the liquid scatters: what a cluster loses as rain does not come back.
    """
    if not ascent.vapour:
        return 0.0
    t = float(ascent.planned_at(ascent.top_pressure).temperature[0])
    return law.WATER_MASS_RATIO * 3.0 * _scatter(ascent, t) / (ascent.molecules - ascent.vapour)


def comparable(ascent: MoistAscent) -> bool:
    """Tell whether theory, which leaves chance out, says how much it rains."""
    return not ascent.rains or ascent.most_liquid >= least_cloud(ascent)


def _meeting(ascent: MoistAscent, pressure: float) -> float:
    r"""Return how long a molecule of vapour flies until it meets liquid, :math:`4 V / A \bar v` [mean free times]."""
    density, sides, _ = size_of_parcel(ascent.scale, ascent.molecules, ascent.pressure, ideal=False)
    speed = float(law.mean_speed(1.0, law.WATER_MASS_RATIO))
    lasts = 4.0 * float(sides[2]) * ascent.pressure / pressure / (ascent.area * speed)
    return lasts / float(law.mean_free_time(density, 1.0, 1.0, 1.0))


def lag(ascent: MoistAscent, pressure: float) -> float:
    r"""Return how much too cold the cloud is at a pressure because vapour must find liquid first [K].

    Vapour is left over for the time :math:`4 V / A \bar c_v` that it takes to meet liquid, while saturation falls at
    the rate at which the parcel rises. The heat that it has not yet given up is missing, to air and vapour. And what
    has condensed makes the droplets warmer than the air, until the molecules of air that hit them have taken its heat
    along, 3 k for each degree: so more evaporates from them, and more vapour is left, by :math:`x \ell^2/3` times
    the time :math:`4 V / A \bar c_a`.
    """
    if pressure >= ascent.base:
        return 0.0
    step = 0.01
    start = ascent.pressure, ascent.temperature, ascent.total_water
    falling = law.parcel_path([pressure, pressure * (1.0 - step)], *start, nuclei_heat=ascent.nuclei_heat)
    per_log = (falling.vapor[0] - falling.vapor[1]) / step
    t = float(falling.temperature[0])
    share = float(falling.vapor[0]) / law.WATER_MASS_RATIO
    slower = float(law.mean_speed(1.0, law.WATER_MASS_RATIO) / law.mean_speed(1.0, 1.0))
    warm = 1.0 + share * _latent(t) ** 2 / 3.0 * slower
    late = float(per_log * ascent.travel / ascent.length * _meeting(ascent, pressure)) * warm
    return warmth_of(late, t) / (1.0 + share * _latent(t) ** 2 / 3.5)


def rain_scatter(ascent: MoistAscent) -> float:
    r"""Return by how much the rain scatters, per dry air [kg kg-1].

    Rain depends on what the cloud held during the last time 1/r, and the scatter s of the cloud decays within the time
    :math:`\tau` in which vapour meets liquid, over the steepness; what is left is :math:`s \sqrt{r \tau}`.
    """
    t = float(ascent.planned_at(ascent.top_pressure).temperature[0])
    memory = _meeting(ascent, ascent.top_pressure) / _steepness(ascent, t)
    lost = max(_scatter(ascent, t) * math.sqrt(RAIN * memory), 1.0)
    return law.WATER_MASS_RATIO * lost / (ascent.molecules - ascent.vapour)


def tolerance(ascent: MoistAscent, pressure: float, *, ideal: bool) -> float:
    """Return how far from the adiabat the model itself may take the parcel where it first meets a pressure [K]."""
    density = size_of_parcel(ascent.scale, ascent.molecules, ascent.pressure, ideal=ideal)[0]
    speed = finite_rate(ascent)
    room = 0.0 if ideal else speed.room(min(pressure, ascent.pressure), density)
    path = ascent.planned_at(pressure)
    t = float(path.temperature[0])
    humidity = float(law.vapor_pressure(pressure, path.vapor[0]) / law.saturation_vapor_pressure(t))
    clustered = haze(ascent, humidity, float(path.liquid[0]), t)
    return t * (speed.finite_speed(pressure) + room) + lag(ascent, pressure) + clustered

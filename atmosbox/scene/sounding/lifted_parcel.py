"""What a sounding means for a parcel lifted from the ground: its levels and energies by MetPy; the levels' heights."""

from __future__ import annotations

import math
import warnings
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.errors import SoundingError, shown
from atmosbox.scene.sounding.profile import Sounding
from atmosbox.theory.constants import DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY


class Level(NamedTuple):
    """A level that a lifted parcel meets: its pressure [Pa], and the temperature of the parcel there [K]."""

    pressure: float
    temperature: float


class Indices(NamedTuple):
    """Levels and energies of a parcel that is lifted from the lowest level of a sounding.

    Parameters
    ----------
    lcl, lfc, el
        Lifting condensation level; level of free convection, None if there is none; equilibrium level, None if there is
        none within the sounding.
    cape, cin
        Convective available potential energy, 0 if the parcel never becomes free, and convective inhibition, 0 or
        negative [J kg-1].
    """

    lcl: Level
    lfc: Level | None
    el: Level | None
    cape: float
    cin: float


def indices(sounding: Sounding) -> Indices:
    r"""Return LCL, LFC, EL, CAPE and CIN of the parcel of the lowest level.

    Raises
    ------
    SoundingError
        If MetPy has no answer for this ascent.

    Notes
    -----
    The numbers are those of MetPy's ``lcl``, ``lfc``, ``el`` and ``surface_based_cape_cin``; of several levels of free
    convection the highest is taken. MetPy's LFC and EL are where the *temperatures* of parcel and environment cross, as
    lines do on a skew-T, while its CAPE and CIN belong to *virtual* temperatures and to the lowest LFC of those [1]_.
    So there can be CAPE without an LFC, or an EL without CAPE. From the lowest LFC to the highest EL, a stable layer in
    between reduces CAPE; if the sounding ends below the EL, CAPE is summed up to its end.

    References
    ----------
    .. [1] C. A. Doswell III and E. N. Rasmussen, The effect of neglecting the virtual temperature correction on CAPE
       calculations, Wea. Forecasting 9, 625 (1994),
       https://doi.org/10.1175/1520-0434(1994)009<0625:TEONTV>2.0.CO;2.

    Examples
    --------
    Moist air below cold air: a lifted parcel forms a cloud at 890 hPa, and above 830 hPa it rises by itself.

    >>> from atmosbox.scene.sounding.analytic import weisman_klemp
    >>> found = indices(weisman_klemp())
    >>> [round(level.pressure, -3) for level in (found.lcl, found.lfc, found.el)]
    [89000.0, 83000.0, 22000.0]
    """
    import metpy.calc as mpcalc
    from metpy.units import units

    p, t, td = sounding.pressure * units.Pa, sounding.temperature * units.K, sounding.dewpoint * units.K
    try:
        with warnings.catch_warnings(action="ignore"), np.errstate(all="ignore"):
            lcl = mpcalc.lcl(p[0], t[0], td[0])
            lfc = mpcalc.lfc(p, t, td)
            el = mpcalc.el(p, t, td)
            cape, cin = mpcalc.surface_based_cape_cin(p, t, td)
    except Exception as error:  # MetPy raises errors of many kinds on an unusual ascent
        raise SoundingError(
            f"{shown(sounding.name)}: MetPy finds no parcel's path ({shown(str(error))}): give an ascent that reaches "
            "above the cloud base."
        ) from error
    lowest, free, end = (_level(each) for each in (lcl, lfc, el))
    if lowest is None:
        raise SoundingError(f"{shown(sounding.name)}: MetPy finds no cloud base for the ground: check its dewpoint.")
    energies = (float(np.nan_to_num(energy.to("J/kg").magnitude)) for energy in (cape, cin))
    return Indices(lowest, free, end, *energies)


def _level(found: Any) -> Level | None:
    """Return a level from MetPy's pressure and temperature, None if they are NaN."""
    pressure, temperature = (float(each.to(unit).magnitude) for each, unit in zip(found, ("Pa", "K"), strict=True))
    return None if math.isnan(pressure) or math.isnan(temperature) else Level(pressure, temperature)


def hydrostatic_height(sounding: Sounding) -> NDArray[np.float64]:
    r"""Return the height of each level above the lowest one, in hydrostatic balance [m].

    Moist air is light; so the hypsometric equation dz = -(R_d T_v / g) d ln p uses the virtual temperature [1]_.

    Notes
    -----
    The integral from level to level is the trapezoidal rule in ln p, as in MetPy's ``thickness_hydrostatic``.

    References
    ----------
    .. [1] J. M. Wallace and P. V. Hobbs, Atmospheric Science, 2nd ed. (2006), section 3.2.

    Examples
    --------
    About half of the air lies below 5.5 km:

    >>> air = Sounding([1000e2, 850e2, 700e2, 500e2, 300e2], [288, 279, 270, 253, 230], [278, 270, 260, 240, 210])
    >>> round(float(hydrostatic_height(air)[3]), -2)
    5500.0
    """
    vapour = law.mixing_ratio(law.saturation_vapor_pressure(sounding.dewpoint), sounding.pressure)
    virtual = np.asarray(law.virtual_temperature(sounding.temperature, vapour))
    scale = GAS_CONSTANT / (DRY_AIR.molar_mass * STANDARD_GRAVITY)
    layers = scale * (virtual[1:] + virtual[:-1]) / 2 * np.log(sounding.pressure[:-1] / sounding.pressure[1:])
    return np.concatenate([[0.0], np.cumsum(layers)])

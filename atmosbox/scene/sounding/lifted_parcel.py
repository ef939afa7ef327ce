"""The levels and energies of a parcel that is lifted from the ground in a sounding, computed by MetPy."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.sounding.hydrostatics import hydrostatic_height
from atmosbox.scene.sounding.profile import Sounding

__all__ = ["Indices", "Level", "indices"]


@dataclass(frozen=True)
class Level:
    """A level that a lifted parcel meets.

    Parameters
    ----------
    pressure
        Pressure [Pa].
    temperature
        Temperature of the parcel there [K].
    height
        Height above the lowest level of the sounding; None if it lies above the highest [m].
    """

    pressure: float
    temperature: float
    height: float | None


@dataclass(frozen=True)
class Indices:
    """Levels and energies of a parcel that is lifted from the lowest level of a sounding.

    Parameters
    ----------
    lcl
        Lifting condensation level.
    lfc
        Level of free convection, None if there is none.
    el
        Equilibrium level, None if there is none within the sounding.
    cape
        Convective available potential energy, 0 if the parcel never becomes free [J kg-1].
    cin
        Convective inhibition, 0 or negative [J kg-1].
    """

    lcl: Level
    lfc: Level | None
    el: Level | None
    cape: float
    cin: float


def indices(sounding: Sounding) -> Indices:
    r"""Return LCL, LFC, EL, CAPE and CIN of the parcel of the lowest level.

    Parameters
    ----------
    sounding
        The ascent.

    Returns
    -------
    Indices
        The numbers in SI units. A level that does not exist is None, but CAPE and CIN are 0.

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
    Moist air below cold air: a parcel that is lifted a kilometre forms a cloud, and above 1.6 km it rises by itself.

    >>> from atmosbox.scene.sounding.analytic import weisman_klemp
    >>> found = indices(weisman_klemp())
    >>> [round(level.height, -2) for level in (found.lcl, found.lfc, found.el)]
    [1000.0, 1600.0, 11400.0]
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
    height = hydrostatic_height(sounding)
    lowest = _level(lcl, sounding, height)
    if lowest is None:
        raise SoundingError(f"{shown(sounding.name)}: MetPy finds no cloud base for the ground: check its dewpoint.")
    energies = (_number(energy, "J/kg") for energy in (cape, cin))
    cape_, cin_ = (0.0 if math.isnan(energy) else energy for energy in energies)
    return Indices(lowest, _level(lfc, sounding, height), _level(el, sounding, height), cape_, cin_)


def _number(quantity: Any, unit: str) -> float:
    """Return a quantity of MetPy as a number."""
    return float(quantity.to(unit).magnitude)


def _level(found: Any, sounding: Sounding, height: np.ndarray[Any, np.dtype[np.float64]]) -> Level | None:
    """Return a level from MetPy's pressure and temperature, None if they are NaN."""
    pressure, temperature = _number(found[0], "Pa"), _number(found[1], "K")
    if math.isnan(pressure) or math.isnan(temperature):
        return None
    above: float | None = None
    if pressure >= sounding.pressure[-1]:
        above = float(np.interp(-math.log(pressure), -np.log(sounding.pressure), height))
    return Level(pressure, temperature, above)

"""Whether a parcel rises by itself: its buoyancy, and the energy in a sounding.

Between the levels of a sounding all quantities are taken as linear in the logarithm of pressure, so that crossings and
integrals are exact. Units are SI.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import checked_positive
from atmosbox.theory.constants import STANDARD_GRAVITY
from atmosbox.theory.environment import DRY_AIR_GAS_CONSTANT

__all__ = ["Convection", "cape_cin", "parcel_buoyancy"]


def parcel_buoyancy(
    parcel_virtual_temperature: ArrayLike, virtual_temperature: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY
) -> FloatArray:
    r"""Return the acceleration of a parcel that is lighter than its environment, :math:`g (T_v' - T_v) / T_v` [m s^-2].

    Parameters
    ----------
    parcel_virtual_temperature, virtual_temperature, gravity
        Virtual temperature of the parcel and of its environment [K]; acceleration of gravity g [m s^-2].

    Examples
    --------
    >>> round(float(parcel_buoyancy(303.0, 300.0)), 3)
    0.098
    """
    parcel = checked_positive(as_floats(parcel_virtual_temperature), "parcel_virtual_temperature")
    around = checked_positive(as_floats(virtual_temperature), "virtual_temperature")
    acceleration: FloatArray = as_floats(gravity) * (parcel - around) / around
    return acceleration


class Convection(NamedTuple):
    """Energies and levels of a parcel in a sounding."""

    cape: float
    """Convective available potential energy [J kg^-1]."""
    cin: float
    """Convective inhibition, zero or negative [J kg^-1]."""
    lfc: float | None
    """Pressure of the level of free convection [Pa]; None if the parcel is buoyant nowhere."""
    el: float | None
    """Pressure of the equilibrium level [Pa]; None without an LFC, or if the parcel still rises at the top."""


def _sounding(
    pressure: ArrayLike, around: ArrayLike, parcel: ArrayLike, lcl_pressure: float | None
) -> tuple[FloatArray, FloatArray, float]:
    """Return ln p, the difference of the virtual temperatures, and ln p of the cloud base."""
    p = checked_positive(as_floats(pressure), "pressure")
    t, t_parcel = as_floats(around), as_floats(parcel)
    if p.ndim != 1 or p.size < 2 or not np.all(np.diff(p) < 0.0):
        raise ValueError("pressure must be at least two levels, each lower than the one before.")
    if t.shape != p.shape or t_parcel.shape != p.shape:
        raise ValueError("pressure and both virtual temperatures must have the same number of levels.")
    warmer = checked_positive(t_parcel, "parcel_virtual_temperature") - checked_positive(t, "virtual_temperature")
    if lcl_pressure is None:
        return np.log(p), warmer, float(np.log(p[0]))
    if not 0.0 <= lcl_pressure < np.inf:
        raise ValueError(f"lcl_pressure = {lcl_pressure} must be finite and at least 0.")
    return np.log(p), warmer, float(np.log(lcl_pressure)) if lcl_pressure > 0.0 else -np.inf


def _free_layer(x: FloatArray, warmer: FloatArray, base: float) -> tuple[FloatArray, FloatArray, int, int] | None:
    """Return the sounding with all crossings and the cloud base as levels, and the indices of LFC and EL in it."""
    below, above = warmer[:-1], warmer[1:]
    crossed = below * above < 0.0
    zero = x[:-1][crossed] + (np.diff(x) * below)[crossed] / (below - above)[crossed]
    more = zero if not x[-1] < base < x[0] else np.append(zero, base)
    values = np.append(np.zeros(zero.size), np.interp(more[zero.size :], x[::-1], warmer[::-1]))
    levels, first = np.unique(np.append(x, more), return_index=True)
    levels, difference = levels[::-1], np.append(warmer, values)[first][::-1]
    rises = (difference[:-1] + difference[1:] > 0.0) & (levels[:-1] <= base)
    if not np.any(rises):
        return None
    where = np.flatnonzero(rises)
    return levels, difference, int(where[0]), int(where[-1]) + 1


def cape_cin(
    pressure: ArrayLike,
    virtual_temperature: ArrayLike,
    parcel_virtual_temperature: ArrayLike,
    lcl_pressure: float | None = None,
) -> Convection:
    r"""Return the energy that buoyancy gives to a rising parcel, and the energy that must be spent before.

    :math:`\mathrm{CAPE} = R_d \int_{EL}^{LFC} (T_v' - T_v)\, d \ln p`, and CIN is the same from the start to the LFC
    (Emanuel 1994, Atmospheric Convection, chapter 6). The LFC is the lowest level, not below the cloud base, from which
    the parcel is buoyant; the EL is the highest level at which it ceases to be buoyant. Stable layers between the two
    reduce CAPE. Without an LFC both energies are 0.0; without an EL, CAPE ends with the sounding.

    Parameters
    ----------
    pressure : (level,)
        Pressure, decreasing upward from the parcel's start [Pa].
    virtual_temperature, parcel_virtual_temperature : (level,)
        Virtual temperature of the environment and of the parcel [K].
    lcl_pressure
        Pressure of the parcel's cloud base [Pa]; None lets the parcel be free from the start.

    Notes
    -----
    These are the choices of MetPy's ``cape_cin``, ``which_lfc="bottom"`` and ``which_el="top"``, except for a parcel
    that is buoyant at its cloud base, stable farther up and buoyant again: here the LFC is the cloud base, in MetPy it
    is the upper crossing.

    Examples
    --------
    One kelvin too cold at 900 hPa, three too warm at 500 hPa, one too cold at 300 hPa:

    >>> energy = cape_cin([900e2, 500e2, 300e2], [290.0, 260.0, 240.0], [289.0, 263.0, 239.0])
    >>> round(energy.cape), round(energy.cin), round(energy.lfc, -2), round(energy.el, -2)
    (355, -21, 77700.0, 34100.0)
    """
    x, warmer, base = _sounding(pressure, virtual_temperature, parcel_virtual_temperature, lcl_pressure)
    free = _free_layer(x, warmer, base)
    if free is None:
        return Convection(0.0, 0.0, None, None)
    levels, difference, bottom, top = free
    work = -DRY_AIR_GAS_CONSTANT * np.diff(levels) * 0.5 * (difference[:-1] + difference[1:])
    end = None if top == levels.size - 1 and difference[top] > 0.0 else float(np.exp(levels[top]))
    cape, cin = float(np.sum(work[bottom:top])), min(0.0, float(np.sum(work[:bottom])))
    return Convection(cape, cin, float(np.exp(levels[bottom])), end)

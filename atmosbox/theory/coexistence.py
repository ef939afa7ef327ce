"""Liquid and vapour in coexistence at several temperatures: the critical point, and the rise of the vapour pressure."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["CriticalPoint", "critical_point", "slope_of_pressure"]

Array = NDArray[np.float64]

_BETA = 0.326
"""Exponent of 1 - T / T_c with which the difference of both densities goes to zero: the same for all simple fluids."""


class CriticalPoint(NamedTuple):
    """The temperature and density at which liquid and vapour become identical, each with its standard error."""

    temperature: float
    temperature_se: float
    density: float
    density_se: float


def _line(x: Array, y: Array, error: Array) -> tuple[Array, Array]:
    """Return offset and slope of the straight line through points with standard errors, and their covariance."""
    design = np.stack([np.ones_like(x), x], axis=1)
    weight = 1.0 / error**2
    covariance = np.linalg.inv(design.T @ (weight[:, None] * design))
    return covariance @ (design.T @ (weight * y)), np.asarray(covariance, np.float64)


def critical_point(
    temperature: ArrayLike, liquid: ArrayLike, vapor: ArrayLike, liquid_se: ArrayLike, vapor_se: ArrayLike
) -> CriticalPoint:
    r"""Return the critical point from densities of liquid and vapour in coexistence.

    :math:`(\rho_l - \rho_v)^{1/\beta}` falls to zero along a straight line, at T_c; the mean of both densities is
    another straight line (the law of rectilinear diameters), whose value at T_c is the critical density (Rowlinson and
    Swinton 1982, Liquids and Liquid Mixtures, section 3.2).

    Parameters
    ----------
    temperature, liquid, vapor : (point,)
        At least two temperatures, and both densities there.
    liquid_se, vapor_se : (point,)
        Their standard errors.

    Examples
    --------
    >>> t = np.array([0.9, 1.0, 1.1])
    >>> half = 0.4 * (1.0 - t / 1.2) ** 0.326
    >>> mean = 0.3 + 0.1 * (1.2 - t)
    >>> found = critical_point(t, mean + half, mean - half, 0.001 + 0 * t, 0.001 + 0 * t)
    >>> round(found.temperature, 6), round(found.density, 6)
    (1.2, 0.3)
    """
    t, dense, thin, dense_se, thin_se = (
        np.asarray(values, np.float64) for values in (temperature, liquid, vapor, liquid_se, vapor_se)
    )
    difference, both = dense - thin, np.hypot(dense_se, thin_se)
    power = difference ** (1.0 / _BETA)
    (offset, slope), covariance = _line(t, power, power / _BETA * both / difference)
    critical = -offset / slope
    to_line = np.array([-1.0 / slope, offset / slope**2])
    critical_se = float(np.sqrt(to_line @ covariance @ to_line))
    (low, rise), covariance = _line(t, 0.5 * (dense + thin), 0.5 * both)
    along = np.array([1.0, critical])
    density_se = float(np.hypot(np.sqrt(along @ covariance @ along), rise * critical_se))
    return CriticalPoint(float(critical), critical_se, float(low + rise * critical), density_se)


def slope_of_pressure(temperature: ArrayLike, pressure: ArrayLike, pressure_se: ArrayLike) -> tuple[float, float]:
    r"""Return :math:`-\mathrm{d} \ln p / \mathrm{d}(1/T)` from measured vapour pressures, and its standard error.

    By the law of Clausius and Clapeyron it is the latent heat of a molecule over k ΔZ (Rowlinson and Swinton 1982,
    Liquids and Liquid Mixtures, section 2.3).

    Parameters
    ----------
    temperature, pressure, pressure_se : (point,)
        At least two temperatures, the pressures there and their standard errors.

    Examples
    --------
    >>> t = np.array([100.0, 110.0, 120.0])
    >>> round(slope_of_pressure(t, np.exp(9.0 - 800.0 / t), 0.1 * np.ones(3))[0], 6)
    800.0
    """
    t, p, error = (np.asarray(values, np.float64) for values in (temperature, pressure, pressure_se))
    (_, slope), covariance = _line(1.0 / t, np.log(p), error / p)
    return -float(slope), float(np.sqrt(covariance[1, 1]))

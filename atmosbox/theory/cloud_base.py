"""Where the cloud base of a measured ascent is: at the kink of its temperature."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory.humidity import vapor_pressure
from atmosbox.theory.moist_lifting import lcl, parcel_path
from atmosbox.theory.saturation import dewpoint

__all__ = ["CloudBase", "fitted_cloud_base"]

_REACH = 0.7


class CloudBase(NamedTuple):
    """A cloud base that was found [Pa], and its standard error [Pa]."""

    pressure: float
    standard_error: float


def fitted_cloud_base(
    pressure: ArrayLike,
    temperature: ArrayLike,
    error: ArrayLike,
    pressure0: float,
    temperature0: float,
    total_water: float,
    most_liquid: float = np.inf,
    nuclei_heat: float = 0.0,
) -> CloudBase | None:
    """Return where the temperature of rising air has its kink, or None where it has none.

    A moist adiabat is laid through the temperatures, of which the total water and a constant are free: the base is
    where that much water becomes saturated. The first crossing of a relative humidity of 100 % would be a worse
    answer, for that scatters.

    Parameters
    ----------
    pressure, temperature, error : (level,)
        What was measured on the way up, and its standard error [Pa, K, K].
    pressure0, temperature0
        At the start [Pa, K].
    total_water
        Water per dry air by which the search begins [kg kg^-1].
    most_liquid, nuclei_heat
        See :func:`atmosbox.theory.parcel_path`.

    Returns
    -------
    CloudBase or None
        None where too few levels lie on either side of the base.

    Examples
    --------
    An ascent shows its lifting condensation level of 888.8 hPa, here without noise:

    >>> levels = np.linspace(1000e2, 600e2, 40)
    >>> path = parcel_path(levels, 1000e2, 298.15, 0.0122722)
    >>> found = fitted_cloud_base(levels, path.temperature, 0.1, 1000e2, 298.15, 0.0130)
    >>> round(found.pressure / 100.0, 1)
    888.8
    """
    from scipy.optimize import least_squares

    p, t = as_floats(pressure).ravel(), as_floats(temperature).ravel()
    sigma = np.broadcast_to(as_floats(error), p.shape)

    def base(water: float) -> float:
        humid = min(float(dewpoint(vapor_pressure(pressure0, water))), temperature0)
        return float(lcl(pressure0, temperature0, humid, nuclei_heat)[0])

    if not total_water > 0.0:
        return None
    expected = base(total_water)
    near = (p >= _REACH * expected) & np.isfinite(sigma) & (sigma > 0.0)
    if np.sum(near & (p > expected)) < 3 or np.sum(near & (p < expected)) < 5:
        return None
    levels, seen, weight = p[near], t[near], 1.0 / sigma[near]

    def misfit(free: FloatArray) -> FloatArray:
        path = parcel_path(levels, pressure0, temperature0, float(np.exp(free[0])), most_liquid, nuclei_heat)
        residual: FloatArray = (path.temperature + free[1] - seen) * weight
        return residual

    fit = least_squares(misfit, (np.log(total_water), 0.0), diff_step=1e-4, x_scale=(0.1, 0.1))
    log_water = float(fit.x[0])
    spread = float(np.sqrt(np.linalg.inv(fit.jac.T @ fit.jac)[0, 0]))
    found = base(math.exp(log_water))
    step = 1e-3
    slope = (base(math.exp(log_water + step)) - base(math.exp(log_water - step))) / (2.0 * step)
    return CloudBase(found, abs(slope) * spread)

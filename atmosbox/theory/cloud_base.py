"""The cloud base of a measured ascent: where its liquid begins, from the water of the parcel alone."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import as_floats

__all__ = ["CloudBase", "measured_cloud_base"]

MOST = 0.75
"""Share of all water that has condensed up to which the curve is used."""


class CloudBase(NamedTuple):
    """The measured cloud base [Pa], and its standard error [Pa]."""

    pressure: float
    standard_error: float


def measured_cloud_base(
    pressure: ArrayLike, vapor: ArrayLike, condensed: ArrayLike, covariance: ArrayLike, least: float = 0.1
) -> CloudBase | None:
    """Return the pressure above which the water of rising air begins to stay liquid; None if there is no cloud base.

    In a gas of few molecules some are in clusters already in clear air. So the growth of the cloud is extrapolated back
    to its beginning: a parabola in ln p is fitted to the share of the water that has condensed; its zero is the base.
    There is none if no level is clear, or too few levels lie in the cloud.

    Parameters
    ----------
    pressure, vapor, condensed : (level,)
        The measured ascent: pressure [Pa], and vapour and liquid, rain included, per dry air [kg kg^-1].
    covariance : (level, level)
        Covariance of the measured vapour at these pressures.
    least
        Share of all water above which the liquid counts as a cloud and not as clusters.

    Examples
    --------
    An ascent with a lifting condensation level of 888.8 hPa; without noise it is found 2 hPa too high up:

    >>> from atmosbox.theory.moist_lifting import parcel_path
    >>> levels = np.geomspace(1000e2, 400e2, 60)
    >>> path = parcel_path(levels, 1000e2, 298.15, 0.0122722)
    >>> found = measured_cloud_base(levels, path.vapor, path.liquid, 1e-10 * np.eye(60))
    >>> round(found.pressure / 100.0)
    886
    """
    p, v, c = (as_floats(each).ravel() for each in (pressure, vapor, condensed))
    noise = as_floats(covariance)
    water = c + v
    with np.errstate(divide="ignore", invalid="ignore"):
        share = c / water
    cloudy = share > least
    full = np.flatnonzero(share > MOST)
    end = int(full[0]) if full.size else len(p)
    clear = np.flatnonzero(~cloudy[:end])
    if not cloudy.any() or not clear.size or least > 0.5 * MOST:
        return None
    near = slice(int(clear[-1]) + 1, end)
    if len(p[near]) < 8 or not np.isfinite(share[near]).all():
        return None
    # the amount of water is known: convert the noise of the vapour to that of its share of the water
    scale = 1.0 / water[near]
    logs = np.log(p[near])
    middle = float(logs.mean())
    x = logs - middle
    rows = np.array([np.ones_like(x), x, x * x])
    weight = 1.0 / (np.diag(noise)[near] * (scale * scale))
    solve = np.linalg.solve(rows * weight @ rows.T, rows * weight)
    a, b, d = solve @ share[near]
    inside = b * b - 4.0 * a * d
    if not (b < 0.0 and inside > 0.0):
        return None
    root = -2.0 * a / (b - np.sqrt(inside))
    slope = b + 2.0 * d * root
    gain = np.array([1.0, root, root * root]) @ solve / slope
    found = float(np.exp(middle + root))
    error = found * float(np.sqrt(gain @ (noise[near, near] * np.outer(scale, scale)) @ gain))
    return CloudBase(found, error) if found <= 1.05 * p[0] and np.isfinite(error) else None

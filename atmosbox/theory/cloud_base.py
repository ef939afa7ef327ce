"""Where the cloud base of a measured ascent is: where its liquid begins, by what the parcel holds alone."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory._array import as_floats

__all__ = ["CloudBase", "measured_cloud_base"]

MOST = 0.75
"""Up to which share of all water that has condensed the curve is used."""


class CloudBase(NamedTuple):
    """A cloud base that was found [Pa], and its standard error [Pa]."""

    pressure: float
    standard_error: float


def measured_cloud_base(
    pressure: ArrayLike,
    vapor: ArrayLike,
    condensed: ArrayLike,
    covariance: ArrayLike,
    least: float = 0.1,
) -> CloudBase | None:
    r"""Return where the water of rising air begins to stay liquid, or None where it does not.

    Of few molecules some are clustered in clear air already. So the growth of the cloud above is followed back to where
    it began: the share of the water that has condensed is laid through with a parabola in ln p, whose zero is the base.

    Parameters
    ----------
    pressure, vapor, condensed : (level,)
        What was measured on the way up: pressure [Pa], and vapour and liquid, rain included, per dry air [kg kg^-1].
    covariance : (level, level)
        Covariance of the measured vapour at these pressures.
    least
        From which share of all water on the cloud is taken to be more than clusters [1].

    Returns
    -------
    CloudBase or None
        None where no level is clear, or too few lie in the cloud.

    Examples
    --------
    An ascent shows its lifting condensation level of 888.8 hPa, found 2 hPa too high up without noise:

    >>> from atmosbox.theory.moist_lifting import parcel_path
    >>> levels = np.geomspace(1000e2, 400e2, 60)
    >>> path = parcel_path(levels, 1000e2, 298.15, 0.0122722)
    >>> found = measured_cloud_base(levels, path.vapor, path.liquid, 1e-10 * np.eye(60))
    >>> round(found.pressure / 100.0)
    886
    """
    p, v, c = (as_floats(each).ravel() for each in (pressure, vapor, condensed))
    noise = as_floats(covariance)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = c / (c + v)
    cloudy = np.flatnonzero(share > least)
    clear = np.flatnonzero(~(share > least))
    full = np.flatnonzero(share > MOST)
    end = int(full[0]) if full.size else len(p)
    clear = clear[clear < end]
    if not cloudy.size or not clear.size or least > 0.5 * MOST:
        return None
    near = np.arange(int(clear[-1]) + 1, end)
    if near.size < 8 or not np.all(np.isfinite(share[near])):
        return None
    # of the water, all of which is known, so much is vapour
    scale = np.outer(1.0 / (c + v)[near], 1.0 / (c + v)[near])
    middle = float(np.log(p[near]).mean())
    x = np.log(p[near]) - middle
    rows = np.stack([np.ones_like(x), x, x * x])
    weight = 1.0 / (np.diag(noise)[near] * np.diag(scale))
    solve = np.linalg.solve(rows * weight @ rows.T, rows * weight)
    a, b, d = solve @ share[near]
    inside = b * b - 4.0 * a * d
    if not (b < 0.0 and inside > 0.0):
        return None
    root = -2.0 * a / (b - np.sqrt(inside))
    slope = b + 2.0 * d * root
    gain = np.array([1.0, root, root * root]) @ solve / slope
    found = float(np.exp(middle + root))
    error = found * float(np.sqrt(gain @ (noise[np.ix_(near, near)] * scale) @ gain))
    return CloudBase(found, error) if found <= 1.05 * p[0] and np.isfinite(error) else None

"""How high the levels of a sounding are, from the weight of the air between them."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import NDArray

from atmosbox.scene.sounding.profile import Sounding

__all__ = ["hydrostatic_height"]


def hydrostatic_height(sounding: Sounding) -> NDArray[np.float64]:
    r"""Return the height of each level above the lowest one, in hydrostatic balance.

    Moist air is light, so that the hypsometric equation dz = -(R_d T_v / g) d ln p takes the virtual temperature [1]_.

    Parameters
    ----------
    sounding
        The ascent; its own heights, if it has any, are not looked at.

    Returns
    -------
    ndarray
        Geopotential height (level,), 0 at the lowest level [m].

    Notes
    -----
    T_v, R_d and g are MetPy's. The integral from level to level is the trapezoid in ln p, that of MetPy's
    ``thickness_hydrostatic``.

    References
    ----------
    .. [1] J. M. Wallace and P. V. Hobbs, Atmospheric Science, 2nd ed. (2006), section 3.2.

    Examples
    --------
    Half of the air lies below some 5.5 km:

    >>> air = Sounding([1000e2, 850e2, 700e2, 500e2, 300e2], [288, 279, 270, 253, 230], [278, 270, 260, 240, 210])
    >>> round(float(hydrostatic_height(air)[3]), -2)
    5500.0
    """
    import metpy.calc as mpcalc
    from metpy import constants
    from metpy.units import units

    with warnings.catch_warnings(action="ignore"):
        virtual = mpcalc.virtual_temperature_from_dewpoint(
            sounding.pressure * units.Pa, sounding.temperature * units.K, sounding.dewpoint * units.K
        )
    warmth = np.asarray(virtual.to("K").magnitude, dtype=np.float64)
    scale = float((constants.Rd / constants.g).to("m / K").magnitude)
    layers = scale * (warmth[1:] + warmth[:-1]) / 2 * np.log(sounding.pressure[:-1] / sounding.pressure[1:])
    return np.concatenate([[0.0], np.cumsum(layers)])

"""The heights of the levels of a sounding, from the weight of the air between them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.sounding.profile import Sounding
from atmosbox.theory.constants import DRY_AIR, GAS_CONSTANT, STANDARD_GRAVITY

__all__ = ["hydrostatic_height"]


def hydrostatic_height(sounding: Sounding) -> NDArray[np.float64]:
    r"""Return the height of each level above the lowest one, in hydrostatic balance.

    Moist air is light; so the hypsometric equation dz = -(R_d T_v / g) d ln p uses the virtual temperature [1]_.

    Parameters
    ----------
    sounding
        The ascent; its own heights, if it has any, are ignored.

    Returns
    -------
    ndarray
        Geopotential height (level,), 0 at the lowest level [m].

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

"""CAPE, CIN, LFC and EL of a measured parcel, with their errors.

Buoyancy depends on the density of the parcel: on its temperature, its vapour and its liquid, all as measured. The
difference from the environment is smoothed, because the levels are where two curves cross, and noisy curves cross
often. The standard error of the numbers, and the effect of the smoothing on them, come from parcels drawn at random
about theory's parcel and measured in the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.scene.ascent.drawn_parcels import draw
from atmosbox.scene.ascent.way import MoistAscent
from atmosbox.scene.headline import Headline

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]
_NEAR = 4
"""Number of frames on either side that smooth one frame."""
_THEORY = "theory is the mean of parcels with the known errors of the ascent, measured in the same way"
_LEAST = 0.9
"""Share of the parcels drawn that must have a level for it to be reported."""


def convection_headlines(
    dataset: xr.Dataset, ascent: MoistAscent, frames: int, samples: int, around: Callable[[Array], Array], *,
    ideal: bool,
) -> tuple[Headline, ...]:  # fmt: skip
    """Return CAPE, CIN and the levels between which the parcel rises by itself, from a whole ascent.

    ``around`` gives the virtual temperature [K] of the environment at pressures [Pa].
    """
    outside, pressure = dataset.environment_pressure.values, dataset.parcel_pressure.values
    warmer = dataset.parcel_density_temperature.values - around(pressure)
    levels = np.concatenate([[ascent.pressure], outside, [ascent.top_pressure]])
    beside, smooth = around(levels), _smoother(len(outside))

    def energies(differences: Array, base: float) -> law.Convection:
        # it starts with the environment's temperature and vapour
        smoothed = smooth @ differences
        whole = np.concatenate([[0.0], smoothed, smoothed[-1:]])
        return law.cape_cin(levels, beside, beside + whole, base)

    here = energies(warmer, ascent.base)
    route, path = np.array(ascent.route), ascent.planned[1]
    dense = law.density_temperature(path.temperature, path.vapor, path.liquid)
    expected = law.cape_cin(route, around(route), dense, ascent.base)

    drawn = draw(ascent, outside, frames, samples, ideal=ideal).density_warmth
    at_frames = np.interp(-np.log(outside), -np.log(route), dense)
    seen = [energies(at_frames * (1.0 + each) - around(outside), ascent.base) for each in drawn]
    rows = (
        ("cape", "J kg-1", "J kg-1", "CAPE of the parcel, with its water"),
        ("cin", "J kg-1", "J kg-1", "CIN of the parcel"),
        ("lfc", "Pa", "hPa", "level of free convection"),
        ("el", "Pa", "hPa", "equilibrium level"),
    )
    found = []
    for name, unit, shown, label in rows:
        value, answer = getattr(here, name), getattr(expected, name)
        others = [level for each in seen if (level := getattr(each, name)) is not None]
        if value is None or answer is None or len(others) < _LEAST * len(seen):
            continue
        mean, scatter = float(np.mean(others)), float(np.std(others, ddof=1))
        if unit == "J kg-1" and abs(mean - answer) > 0.5 * abs(answer) > 0.0:  # the clusters hide the energy
            continue
        low, high = (ascent.top_pressure, ascent.pressure) if unit == "Pa" else (None, None)
        found.append(Headline(name, value, scatter, mean, 0.0, _THEORY, unit, shown, label, low=low, high=high))
    return tuple(found)


def _smoother(number: int) -> Array:
    """Return the matrix that fits a parabola to each value and its neighbours, and takes the parabola's value.

    >>> curve = np.arange(20.0) ** 2
    >>> bool(np.allclose(_smoother(20) @ curve, curve))
    True
    """
    rows = np.zeros((number, number))
    for k in range(number):
        near = np.arange(max(k - _NEAR, 0), min(k + _NEAR + 1, number))
        powers = (near - k)[:, None] ** np.arange(min(3, len(near)))
        rows[k, near] = np.linalg.pinv(powers.astype(float))[0]
    return rows

"""A box of molecules that attract each other, as the arrays that the kernels of a page work on."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.engine.core.state import EVENT, aligned_records
from atmosbox.engine.exact.calendar import new_calendar
from atmosbox.engine.wells.vicinity import new_vicinity
from atmosbox.engine.wells.well_advance import Lists
from atmosbox.engine.wells.well_events import WellGas
from atmosbox.lab.kernels.clustering import Crowd
from atmosbox.lab.stage import instrument_of
from atmosbox.scene.instruments import Clusters
from atmosbox.scene.setup import Setup

_LONGER = 4
"""Factor by which the lists of neighbours can grow, because memory is reserved for that."""
_POWERS = 4


def well_gas(parcel: Any) -> WellGas:
    """Return the gas before the neighbours of its molecules are listed, with memory for longer lists."""
    number, gas = parcel.number, parcel.arrays().gas
    old = gas.vicinity
    vicinity = new_vicinity(parcel.length, parcel.periodic, number, old.reach, planar=parcel.planar)
    entry = np.zeros(number * _LONGER * old.stride, np.uint32)
    made: WellGas = gas._replace(
        events=aligned_records(number, EVENT),
        calendar=new_calendar(number),
        vicinity=vicinity._replace(entry=entry, stride=old.stride),
    )
    return made


def lists(parcel: Any) -> Lists:
    """Return the lengths of the lists of neighbours."""
    return Lists(np.array([parcel.arrays().gas.vicinity.stride]), np.zeros(1, np.int64))


def crowd(setup: Setup) -> Crowd:
    """Return the data of the drops at the start, without any drop."""
    parcel: Any = setup.parcel
    clusters = instrument_of(setup, Clusters) or Clusters(0)
    wells, drop, size = (np.zeros(parcel.number, np.int64) for _ in range(3))
    return Crowd(
        members=clusters.molecules, wells=wells, drop=drop, size=size, liquid=clusters.liquid, virial=np.zeros(1),
        gas_law=_gas_law(), full_depth=parcel.arrays().full_depth, strength=np.array([parcel.strength]),
        work=np.zeros(1),
    )  # fmt: skip


def _gas_law() -> NDArray[np.float64]:
    """Return the coefficients of B2 and B3, which are polynomials in x = e^(1 / T*) - 1, from theory at four x.

    >>> x = np.expm1(1.0 / 1.3)
    >>> second, third = (float(row @ x ** np.arange(4)) for row in _gas_law())
    >>> bool(abs(second / law.square_well_second_virial(1.3) - 1.0) < 1e-12)
    True
    """
    x = np.array([0.25, 0.5, 1.0, 2.0])
    warmth = 1.0 / np.log1p(x)
    told = np.stack([law.square_well_second_virial(warmth), law.square_well_third_virial(warmth)])
    return np.ascontiguousarray(np.linalg.solve(np.vander(x, _POWERS, increasing=True), told.T).T)

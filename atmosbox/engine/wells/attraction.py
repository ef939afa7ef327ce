"""The additional parameters of a box of attracting molecules: its wells, and a bath of random velocities."""

import math
from collections import namedtuple
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.inputs import numbers
from atmosbox.engine.core.refusal import RefusedError, number
from atmosbox.engine.core.schedule import Schedule, as_schedule

Array = NDArray[np.float64]

_WIDEST = 5.0


@dataclass(frozen=True)
class SquareWell:
    """Range and depth of the attraction between molecules.

    Parameters
    ----------
    range
        Radius of the well in units of the contact distance of the pair: lambda, from 1 to 5.
    depth
        Depth of the well [energy], 0 or above.

    Either may be a symmetric table, (species, species). With a range of 1 or a depth of 0, the pair are hard spheres.

    Examples
    --------
    Vapour molecules that attract each other, and air molecules that neither attract vapour nor each other:

    >>> SquareWell(range=1.5, depth=[[1.0, 0.0], [0.0, 0.0]]).depth
    [[1.0, 0.0], [0.0, 0.0]]
    """

    range: ArrayLike = 1.5
    depth: ArrayLike = 1.0


@dataclass(frozen=True)
class RandomBath:
    """A heat bath without walls: at random times it draws the velocity of a molecule again.

    Parameters
    ----------
    kT
        Temperature of the bath [energy], a number or a schedule.
    rate
        Average number of such draws per molecule and time [1/time].

    References
    ----------
    Andersen, H. C. (1980), doi:10.1063/1.439486.
    """

    kT: float | Schedule
    rate: float


class Wells(namedtuple("Wells", "core edge depth distance number count stress")):
    """The wells in the form that the kernels take.

    ``core``, ``edge`` and ``depth : (kind, kind)``: see `square_well.Well`; ``distance : (kind, kind)`` is the radius
    [length]. ``number : (kind, kind)``: the pairs of a lower and a higher kind that are inside their wells now.
    ``count : (4,)`` captures, releases, bounces, velocities drawn again by the bath; ``stress : (axis,)`` sums of
    r_a dp_a over all events of pairs since the start [energy].
    """


class Bath(namedtuple("Bath", "clock rate schedule schedule_time schedule_kT heat")):
    """The bath in the form that the kernels take.

    ``clock : (1,)``: the time of the next draw [time, local]; ``rate``: draws per molecule and time [1/time];
    ``schedule``, ``schedule_time``, ``schedule_kT``: its temperature as that of a wall, see `state.Walls`;
    ``heat : (1,)``: the energy that it has given [energy].
    """


def well_table(well: SquareWell, species: int) -> tuple[Array, Array]:
    """Return range and depth as tables, (species, species), after checks; larger tables are cut to that size."""
    limits = {"range": (1.0, _WIDEST), "depth": (0.0, math.inf)}
    tables = []
    for name, (least, most) in limits.items():
        table = numbers(getattr(well, name), f"{name} of the well")
        if table.ndim == 0:
            table = np.full((species, species), float(table))
        if table.ndim != 2 or table.shape[0] != table.shape[1] or len(table) < species:
            raise RefusedError(
                f"{name} of the well has shape {table.shape} for {species} species: give one number, or a table of "
                f"{species} by {species}"
            )
        for value in table.flat:
            number(value, f"{name} of the well", least=least, most=most)
        if (table != table.T).any():
            raise RefusedError(f"{name} of the well is not symmetric: the attraction of a pair is mutual")
        tables.append(table[:species, :species])
    return tables[0], tables[1]


def new_wells(well: SquareWell, species: NDArray[np.int64], radius: Array) -> Wells:
    """Return the wells of the kinds of molecules: ``species : (kind,)`` and ``radius : (kind,)`` [length].

    >>> wells = new_wells(SquareWell(1.5, [[1, 0], [0, 0]]), np.array([0, 1]), np.array([0.5, 0.5]))
    >>> wells.distance
    array([[1.5, 1. ],
           [1. , 1. ]])
    """
    ranges, depths = well_table(well, int(species.max(initial=0)) + 1)
    contact = radius[:, None] + radius[None, :]
    range_of, depth = ranges[np.ix_(species, species)], depths[np.ix_(species, species)]
    hard = (depth == 0.0) | (range_of == 1.0)
    distance = np.where(hard, contact, range_of * contact)
    core = contact * contact
    return Wells(
        core=core,
        edge=np.where(hard, core, distance * distance),
        depth=np.where(hard, 0.0, depth),
        distance=distance,
        number=np.zeros(core.shape, np.int64),
        count=np.zeros(4, np.int64),
        stress=np.zeros(3),
    )


def new_bath(bath: RandomBath | None) -> Bath:
    """Return a bath for the kernels, after checks; without a bath, one that never acts."""
    rate = 0.0 if bath is None else number(bath.rate, "rate of the random bath", least=0.0)
    corners = [(0.0, 1.0)] if bath is None else as_schedule(bath.kT, "kT of the random bath")
    return Bath(
        clock=np.full(1, math.inf),
        rate=rate,
        schedule=np.array([0, len(corners)]),
        schedule_time=np.array([time for time, _ in corners]),
        schedule_kT=np.array([kT for _, kT in corners]),
        heat=np.zeros(1),
    )

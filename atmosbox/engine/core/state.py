"""The data of the engine: molecules, events, cells, walls and tallies, as NamedTuples of arrays.

Everything is in reduced units: the caller chooses a length, a mass and an energy, and time follows as
length * sqrt(mass / energy). ``kT`` is an energy; the engine knows no kelvin.
"""

from collections import namedtuple
from typing import Any, NamedTuple

import numpy as np

MOLECULE = np.dtype(
    [(name, "f8") for name in ("x", "y", "z", "vx", "vy", "vz", "clock")] + [("count", "u4"), ("kind", "u4")]
)
"""One molecule, one 64-byte line of memory.

Its centre [length] and velocity [length/time] *at the time of its clock* [time], the number of encounters it has had,
and its kind (a row of `Kinds`). These fields change at an encounter; the centre also at a periodic boundary, by a
length of the box, and the clock when all clocks are set back. In the liquid a molecule has a clock of infinity.
"""

_NAMES = ["contact_time", "partner", "partner_count", "slot_x", "slot_y", "slot_z", "what"]
EVENT = np.dtype({"names": _NAMES, "formats": ["f8", "u4", "u4", "u2", "u2", "u2", "u1"], "itemsize": 32})
"""The next event of one molecule.

The time of its next contact [time], the partner, and how many encounters the partner had had when that contact was
predicted (if it has had more since, the prediction is stale); its slots along the three axes (`cells`); and which of
contact, crossing or wall hit comes first. A contact with itself means that its events are predicted again at that time.
The last eight bytes, which have no name here, are its places in the rows of its cells (`rows`)::

    byte   0             8        12             16      18      20      22    23    24 ... 31
           contact_time  partner  partner_count  slot_x  slot_y  slot_z  what  free  places
"""

SLOT_OFFSET = 16
"""Byte of an `EVENT` at which the three slots begin."""

PLACE_OFFSET = 24
"""Byte of an `EVENT` at which the eight places begin."""

KIND = np.dtype([("mass", "f8"), ("radius", "f8"), ("rotation", "f8"), ("size_class", "i8")])
"""A kind of molecule.

Mass [mass], radius [length], rotational degrees of freedom, and its row in the tables of cell boundaries.
"""


class Modes(NamedTuple):
    """The features that a scene requires, as flags.

    In this order: whether molecules collide at all (points never do); gravity; rotation; several kinds of molecule;
    spheres larger than cells; periodic axes; a piston; molecules that change between vapour and liquid; a floor of
    liquid (`pool`); the number of the first kind that is a drop, 0 if there is none; a periodic axis so short that a
    molecule meets several images of another; a piston that follows a pressure, whose velocity compiled code sets;
    whether the rows of cells hold copies of trajectories (`rows`).
    """

    contacts: bool = False
    gravity: bool = False
    rotation: bool = False
    mixed: bool = False
    spanning: bool = False
    periodic: bool = False
    piston: bool = False
    phases: bool = False
    pool: bool = False
    drops: int = 0
    images: bool = False
    ascends: bool = False
    rows: bool = False

    def without(self, *flags: str) -> "Modes":
        """Return the modes of a kernel that must not read some flags: the compiler refuses one that does."""
        left_out: dict[str, Any] = dict.fromkeys(flags)
        return self._replace(**left_out)


class Box(namedtuple("Box", "length_x length_y length_z inverse_x inverse_y inverse_z gravity planar exchange stall")):
    """The box: its sides, and the constants that hold everywhere in it.

    Sides [length], ``inverse_*`` 1/side on a periodic axis and 0 on a walled one [1/length], gravity along -z
    [length/time^2], whether the gas is plane, the share of contacts that exchange energy with rotation, and
    ``stall`` [time]: if very many events happen within less time, the run counts as stalled.
    """


class Kinds(namedtuple("Kinds", "table rotational_energy")):
    """The kinds of molecules.

    ``table : (kind,)`` of `KIND`, and ``rotational_energy : (molecule,)`` [energy] where molecules rotate.
    """


class Copies(namedtuple("Copies", "value occupied place centre horizon slack epoch room radius")):
    """What the rows of cells hold beside indices of molecules, where they hold copies of trajectories: see `rows`.

    ``value`` and ``occupied`` are the memory of ``Cells.row``, read as float32 and as words of 64 bits; ``place`` is
    the memory of the events, read as bytes. ``centre : (axis, cell)`` [length] are the centres of the cells;
    ``horizon : (layer,)`` is how far ahead contacts are searched [time]. ``slack : (layer, 3)`` bounds the errors of
    the copies; ``epoch : (4,)`` holds the times from which and until which [time], and the speed [length/time] up to
    which, these bounds hold: see `rows`. ``room : (layer,)`` [length^3; planar: length^2] and ``radius``
    [length] of a usual molecule tell how dense a layer is.
    """


class Cells(
    namedtuple(
        "Cells",
        "row stride boundary first span slot number_x number_y number_z last_slot_x last_slot_y last_slot_z copies",
    )
):
    """Which molecules lie in which cell.

    ``row : (cell * stride,)``: each cell's molecules (`cells`, or `rows`). ``boundary : (size,
    axis, slot)`` [length], ``first`` and ``span : (size, axis, slot)``: the first cell, and the number of
    cells, that a sphere of that size overlaps when its centre lies between ``boundary[slot]`` and
    ``boundary[slot + 1]``. ``slot : (molecule, 3)`` is a view of the events. ``last_slot_*`` is the
    number of slots minus one.
    """


class Calendar(namedtuple("Calendar", "time winner leaf node depth")):
    """A tournament tree of the molecules' next events: see `calendar`."""


class Walls(namedtuple("Walls", "law accommodation schedule schedule_time schedule_kT piston epoch")):
    """The six walls, in the order x low, x high, y low, y high, z low, z high.

    ``law : (wall,)`` (see `walls`), ``accommodation : (wall,)``, and the temperatures as straight lines between points
    in time: wall w has the points ``schedule[w] <= k < schedule[w + 1]`` of ``schedule_time`` [time] and
    ``schedule_kT`` [energy]. ``piston`` is the motion of the ceiling: (position [length], velocity [length/time], time
    at which it had that position [time]). ``epoch`` is the time at which all clocks read zero.
    """


class Tallies(namedtuple("Tallies", "count impulse heat hits work virial layer_scale random progress")):
    """Counts and sums since the start.

    ``count : (5,)`` contacts, cells entered, cells left, stale predictions, wall hits; ``impulse``,
    ``heat``, ``hits``, ``work : (wall,)`` [momentum, energy, 1, energy]: the normal impulse that each wall has taken
    up (outward), the heat that it has given, the number of hits, the work that it has done; ``virial : (layer,)``
    [energy]: sum of r . dp over contacts by height; ``layer_scale`` [1/length]: layers per height; ``random : (1,)``
    state of the random numbers; ``progress : (2,)`` a time [time] and the number of events since: many events in no
    time are a stalled run.
    """


class Motion(namedtuple("Motion", "x y z vx vy vz")):
    """Position and velocity of one molecule at one time: ``x, y, z`` [length], ``vx, vy, vz`` [length/time]."""


class Gas(namedtuple("Gas", "molecules events kinds cells calendar box walls tallies")):
    """All data of the exact engine, as its kernels receive them.

    ``molecules : (molecule,)`` of `MOLECULE` and ``events : (molecule,)`` of `EVENT`; the others are described at the
    types of these names. A kernel that takes a ``gas`` reads only the parts it needs; passing the others costs nothing.
    """


def aligned_records(number: int, dtype: np.dtype[Any]) -> Any:
    """Return a zeroed record array that starts on a cache line.

    >>> aligned_records(3, MOLECULE).ctypes.data % 64
    0
    """
    buffer = np.zeros(number * dtype.itemsize + 64, np.uint8)
    start = -buffer.ctypes.data % 64
    return buffer[start : start + number * dtype.itemsize].view(dtype).view(np.recarray)

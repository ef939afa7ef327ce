"""What the engine knows of its molecules: NamedTuples of arrays, and nothing else.

Everything is in reduced units: the caller chooses a length, a mass and an energy, and time follows as
length * sqrt(mass / energy). ``kT`` is an energy; the engine knows no kelvin.
"""

from typing import Any, NamedTuple

import numpy as np

__all__ = [
    "EVENT",
    "KIND",
    "MOLECULE",
    "PLACE_OFFSET",
    "SLOT_OFFSET",
    "Box",
    "Calendar",
    "Cells",
    "Copies",
    "Gas",
    "Kinds",
    "Modes",
    "Motion",
    "Tallies",
    "Walls",
    "aligned_records",
]

MOLECULE = np.dtype(
    [
        ("x", "f8"),
        ("y", "f8"),
        ("z", "f8"),
        ("vx", "f8"),
        ("vy", "f8"),
        ("vz", "f8"),
        ("clock", "f8"),
        ("count", "u4"),
        ("kind", "u4"),
    ]
)
"""One molecule, one 64-byte line of memory.

Its centre [length] and velocity [length/time] *at the time of its clock* [time], how many encounters it
has had, and its kind (a row of `Kinds`). Only an encounter writes it.
"""

EVENT = np.dtype(
    {
        "names": ["contact_time", "partner", "partner_count", "slot_x", "slot_y", "slot_z", "what"],
        "formats": ["f8", "u4", "u4", "u2", "u2", "u2", "u1"],
        "itemsize": 32,
    }
)
"""What lies ahead of one molecule.

Its next contact [time], with whom, how many encounters the partner had had when that was predicted (if it
has had more since, the prediction is stale), where it stands among the cells (`cells`), and which of
contact, crossing or wall comes first. A contact with itself means that it plans anew at that time. The last eight
bytes, which have no name here, tell its places in the rows of its cells (`rows`).
"""

SLOT_OFFSET = 16
"""Where in the bytes of an `EVENT` the three slots begin."""

PLACE_OFFSET = 24
"""Where in the bytes of an `EVENT` the eight places begin."""

KIND = np.dtype([("mass", "f8"), ("radius", "f8"), ("rotation", "f8"), ("size_class", "i8")])
"""A kind of molecule.

Mass [mass], radius [length], rotational degrees of freedom, row of the table of cell boundaries.
"""


class Modes(NamedTuple):
    """What a scene requires.

    Contacts at all (points never meet), gravity, rotation, several kinds of molecule, spheres larger than
    cells, periodic axes, a piston; molecules that come and go between vapour and liquid, and a floor of liquid; the
    first kind that is a drop, 0 if none is; a periodic axis so short that a molecule meets several images of another;
    a piston that follows a pressure, whose turns compiled code makes; whether the rows of cells hold copies of
    trajectories (`rows`).
    """

    contacts: bool
    gravity: bool
    rotation: bool
    mixed: bool
    spanning: bool
    periodic: bool
    piston: bool
    phases: bool = False
    pool: bool = False
    drops: int = 0
    images: bool = False
    ascends: bool = False
    rows: bool = False

    def without(self, *flags: str) -> "Modes":
        """Return the modes of a kernel that does without some flags: the compiler refuses one that reads them."""
        left_out: dict[str, Any] = dict.fromkeys(flags)
        return self._replace(**left_out)


class Box(NamedTuple):
    """The box, and what holds everywhere in it.

    Sides [length], ``inverse_*`` 1/side on a periodic axis and 0 on a walled one, gravity along -z
    [length/time^2], whether the gas is a plane, the share of contacts that exchange energy with rotation,
    and the time [time] in which many events without progress are a pile-up.
    """

    length_x: float
    length_y: float
    length_z: float
    inverse_x: float
    inverse_y: float
    inverse_z: float
    gravity: float
    planar: bool
    exchange: float
    stall: float


class Kinds(NamedTuple):
    """The kinds of molecule.

    ``table : (kind,)`` of `KIND`, and ``rotational_energy : (molecule,)`` [energy] where molecules rotate.
    """

    table: Any
    rotational_energy: Any


class Copies(NamedTuple):
    """What the rows of cells hold beside names, where they hold copies of trajectories: see `rows`.

    ``value`` and ``occupied`` are the memory of ``Cells.row``, read as float32 and as words of 64 bits; ``place`` is
    that of the events, read as bytes. ``centre : (axis, cell)`` [length]; ``horizon : (layer,)`` how far ahead contacts
    are looked for [time]; ``slack : (layer, 3)`` how far the copies may be wrong, ``epoch : (4,)`` from when until when
    [time], and up to which speed [length/time], they hold: see `glance`. ``room : (layer,)`` [length^3; planar:
    length^2] and ``radius`` [length] of a usual molecule tell how dense a layer is.
    """

    value: Any
    occupied: Any
    place: Any
    centre: Any
    horizon: Any
    slack: Any
    epoch: Any
    room: Any
    radius: float


class Cells(NamedTuple):
    """Which molecules stand where.

    ``row : (cell * stride,)``: each cell's molecules (`cells`, or `rows`). ``boundary : (size,
    axis, slot)`` [length], ``first`` and ``span : (size, axis, slot)``: the first cell, and the number of
    cells, that a sphere of that size overlaps when its centre lies between ``boundary[slot]`` and
    ``boundary[slot + 1]``. ``slot : (molecule, 3)`` is a view into the events. ``last_slot_*`` is the
    number of slots less one.
    """

    row: Any
    stride: int
    boundary: Any
    first: Any
    span: Any
    slot: Any
    number_x: int
    number_y: int
    number_z: int
    last_slot_x: int
    last_slot_y: int
    last_slot_z: int
    copies: Copies


class Calendar(NamedTuple):
    """A tournament of next events: see `calendar`."""

    time: Any
    winner: Any
    leaf: int
    node: int
    depth: int


class Walls(NamedTuple):
    """The six walls, in the order x low, x high, y low, y high, z low, z high.

    ``law : (wall,)`` (see `walls`), ``accommodation : (wall,)``, their temperatures as polygons in time:
    wall w has the points ``schedule[w] <= k < schedule[w + 1]`` of ``schedule_time`` [time] and
    ``schedule_kT`` [energy]. ``piston`` holds the ceiling's position [length] and velocity at a time
    [time]: (position, velocity, time). ``epoch`` is the time at which all clocks read zero.
    """

    law: Any
    accommodation: Any
    schedule: Any
    schedule_time: Any
    schedule_kT: Any
    piston: Any
    epoch: Any


class Tallies(NamedTuple):
    """What has been counted since the start.

    ``count : (5,)`` contacts, cells entered, cells left, stale predictions, wall hits; ``impulse``,
    ``heat``, ``hits``, ``work : (wall,)`` [momentum, energy, 1, energy]: what each wall took up as normal
    impulse (outward), gave as heat, how often it was hit, what it did as work; ``virial : (layer,)``
    [energy]: sum of r . dp over contacts by height; ``layer_scale`` [1/length]; ``random : (1,)`` state
    of the random numbers; ``progress : (2,)`` a time [time], and the events since: many in no time are a
    pile-up.
    """

    count: Any
    impulse: Any
    heat: Any
    hits: Any
    work: Any
    virial: Any
    layer_scale: float
    random: Any
    progress: Any


class Motion(NamedTuple):
    """Where one molecule is and how it moves, at one time: ``x, y, z`` [length], ``vx, vy, vz`` [length/time]."""

    x: float
    y: float
    z: float
    vx: float
    vy: float
    vz: float


class Gas(NamedTuple):
    """All that the exact engine works on, as its kernels receive it.

    ``molecules : (molecule,)`` of `MOLECULE` and ``events : (molecule,)`` of `EVENT`; the others are described at their
    types. A kernel that takes a ``gas`` reads what it needs of it: the compiler passes the parts at no cost.
    """

    molecules: Any
    events: Any
    kinds: Kinds
    cells: Cells
    calendar: Calendar
    box: Box
    walls: Walls
    tallies: Tallies


def aligned_records(number: int, dtype: np.dtype[Any]) -> Any:
    """Return a zeroed record array that starts on a cache line.

    Examples
    --------
    >>> aligned_records(3, MOLECULE).ctypes.data % 64
    0
    """
    buffer = np.zeros(number * dtype.itemsize + 64, np.uint8)
    start = -buffer.ctypes.data % 64
    return buffer[start : start + number * dtype.itemsize].view(dtype).view(np.recarray)

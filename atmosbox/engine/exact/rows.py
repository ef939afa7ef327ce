r"""The rows of cells, where they hold copies of trajectories, and the quick test of eight copies at once.

Beside the indices of its members, the row of a cell holds a copy of the trajectory of each in single precision,
relative to the centre of the cell and to a common time, the start of the epoch. So all data that `screen` needs for
eight members lie in one piece of memory. The row of a cell is ``stride`` words of four bytes, whole lines of 64 bytes::

    | occupied . . . | names | x | y | z | vx | vy | vz | extent | names | x | ...
      half a line of     8     8   8   8   8    8    8      8
      64 bytes       |<---------------- a block --------------->|<-- the next --

The first 64 bits of a row tell which of its places are occupied, at most `MOST`. "names" are the indices of the
members. Extents are there only if molecules differ in size. In gravity the copies are in the frame that falls from the
start of the epoch, in which all paths are straight.

Along each axis a molecule is in one cell, or in two neighbours: that is its slot (`cells`). But here it keeps a
cell that it has left until its next event, because leaving a cell is not an event. Of its cells, eight at most, no two
have the same parities of their three numbers. So eight bits tell which cells they are (`members_of`), and eight bytes
of its event tell its place in the row of each::

    cell numbers (x, y, z)   even even even   even even odd   ...   odd odd odd
    bit, and byte of place         0                1                    7

On a periodic axis the number of cells is even, so that parities continue across the border, and at least four: then the
image of a member that belongs to a row is the one nearest to the centre of its cell, from which no member is further
than one and a half cells.

Most pairs in a cell miss each other, and to find that out is most of the work of a search. The processor takes eight
single-precision numbers in one or two instructions, so the rows of cells hold copies of trajectories in single
precision, and `screen` tells which of eight may be met before a given time. It may name one that is not met,
but it never leaves out one that is. The exact test of those that it names is made in double precision.

**Why none is left out.** Take a pair that shares the cell from now until it meets, after :math:`\tau \le T`, at the
distance :math:`\sigma`. Let u = 2^-24 be the rounding of single precision, W the largest distance along an axis between
a member of the row and the centre of its cell, V a bound of the speed of all copies, and H the length of their epoch,
with

.. math:: V H \le 64\,W, \qquad g H \le V / 2 .

Copies count time from the start of the epoch, in the frame that falls with gravity. So along an axis a copy is
x(0) + v s with :math:`0 \le s \le H`, where :math:`|v s| \le 64\,W` and
:math:`|x(0)| \le W + VH/4 + VH \le 81\,W`; the middle term is the fall.

1. *Position.* The distance r of the pair along an axis is v s + (x(0) - x'). Roundings of x(0), of v, of s, of the
   difference, of x' and of the sum amount to u (81 + 64 + 64 + 98 + 17 + 2) W = 326 u W along z, and to 262 u W along x
   and y, where nothing falls: together 494 u W. Where the processor does not fuse product and sum it is 604 u W.
2. *Velocity.* Its roundings, u \|v\| twice and u \|v - v'\|, act during the time until the pair meets. In that time no
   molecule of the row moves further than 2 W along x and y. Along z in the falling frame it moves
   2 W + g tau^2 / 2 + g s tau; no molecule stays in a layer of 2 W for longer than g tau^2 = 16 W, so that is 33 W. All
   this is less than 134 u W.
3. Hence there is a moment until T at which the pair *as the copies give it* is no further apart than sigma + e, with
   :math:`e = 1024\,u W = 2^{-14} W`, which is more than (604 + 134) u W.
4. *Rounding of the test itself.* With :math:`|r|^2 \le 12\,W^2`, the roundings of r.r, r.v, v.v and of the products
   change the square of the distance by less than 32 u \|r\|^2; the test takes :math:`(\sigma + e)^2 + m` with
   :math:`m = 2^{-14} W^2 = 1024\,u W^2`.
5. *Approach.* r.v < 0 for the pair; from the copies it may come out larger by 2 V (e + 26 u W) < :math:`2^{-12} V W`.

So this is the one place in the engine where it does not matter that some processors fuse product and sum and others do
not. They may name other pairs, and double precision, the same everywhere, finds the same soonest contact among them.

None of this depends on how large sigma is: a law of longer range has the same slack. W grows with the cells, and with
it the number of molecules that are named in vain, as if sigma were longer by W / 16384 and its square by the square of
W / 128: in a cell some W wide that is always a small share.

The velocity of a molecule faster than V is stored as NaN, for a copy and for the molecule that searches; every
comparison with NaN counts as true. So no molecule is missed because it exceeds the bound, whatever heats it: it is
tested in double precision alone until the next epoch. Products too small for single precision are smaller than `TINY`,
which is added as a tolerance for all.
"""

import math
from typing import Any

import numpy as np

from atmosbox.engine.core.jit import COMPILED, POSITIVE, Kernel, kernel, lowest_bit
from atmosbox.engine.core.pair import extent
from atmosbox.engine.core.state import PLACE_OFFSET, Motion
from atmosbox.engine.exact.encounter import motion_at, size_and_radius, slots_of

BATCH = 8
"""Number of members tested together: an AVX2 register holds as many; elsewhere they are taken by twos or fours."""
PATH = 64.0
"""Longest flight of a copy in an epoch, in widths W: VH / W above."""
SLACK = 2.0**-14
"""e / W and m / W^2 above."""
DISTANCE, SQUARE, CLOSING = range(3)
"""The three numbers in the slack of a layer: e [length], m [length^2], and the bound of r.v [length^2/time]."""
SPEEDS = 1e9
"""Largest speed of a copy [length/time], so that the squares of products do not overflow."""
TINY = 1e-30
"""A squared product [length^4/time^2] far above the smallest number of single precision: see the module's docstring."""


def screen(values, first, mixed, place, velocity, since, slack, within):
    """Return which of eight copies may be met, bit k for the copy ``first + k``; the module's docstring has the proof.

    ``values : (word,)`` are the rows, read as float32; from ``first`` on they hold x, y, z, vx, vy, vz and, if
    ``mixed``, their extents, eight numbers each. ``place`` and ``velocity`` are those of the molecule that searches,
    relative to the centre of the cell, ``since`` the time since the start of the epoch, ``within`` how far ahead to
    look. ``slack`` is its reach (that of the pair, unless ``mixed``) plus the slack e [length], the slack m [length^2],
    and the largest r.v of a pair that approaches. All are float32.
    """
    copies = values[int(first) : int(first) + 7 * BATCH].reshape(7, BATCH) if mixed else None
    if copies is None:
        copies = values[int(first) : int(first) + 6 * BATCH].reshape(6, BATCH)
    r = copies[:3] - np.array(place)[:, None] + copies[3:6] * since
    v = copies[3:6] - np.array(velocity)[:, None]
    reach = slack[0] + (copies[6] if mixed else np.float32(0.0))
    a, b, c = (v * v).sum(axis=0), (r * v).sum(axis=0), (r * r).sum(axis=0) - (reach * reach + slack[1])
    near = ~(a * c > b * b + np.float32(TINY))
    turn = a * within + b
    soon = ~(turn <= 0.0) | ~(within * (b + turn) + c >= 0.0)
    found = near & ~(b >= slack[2]) & soon
    return sum(1 << k for k in np.flatnonzero(found).tolist())


if COMPILED:

    def _vectors() -> Any:
        from atmosbox.engine.core import compiler

        return compiler.screen_of(BATCH, TINY)

    screen = Kernel(screen, _vectors)


_HEAD = 8
FEWEST, MORE, MOST = 32, 16, 64
"""Number of places that a row has at first, number that it gains when it is full, and the largest number.

One word of 64 bits tells which are occupied.
"""
START, STOP, TOP_SPEED, LONGEST = range(4)
"""The numbers of an epoch: its start and its end [time], the top speed V [length/time], its greatest length [time]."""
_PLACE, _SPEED, _EXTENT = BATCH, 4 * BATCH, 7 * BATCH
_SLOW = 1e-12
"""Smallest speed of which copies are made [length/time]."""
_DILUTE, _DENSE = 0.05, 0.2
"""Below the first packing fraction a horizon gains nothing (measured); above the second a shorter one is enough."""


@kernel(plain=True)
def row_stride(places, mixed):
    """Return the number of words in the row of a cell that has ``places`` places.

    >>> row_stride(16, False), row_stride(32, True)
    (128, 272)
    """
    # rounded up to whole lines of 16 words
    return -(-(_HEAD + (8 if mixed else 7) * places) // 16) * 16


@kernel(plain=True)
def _farthest(edge, k, wraps):
    """Return the largest distance along an axis of a member of cell k from its centre, W above [length].

    A member may also be anywhere in a neighbour of the cell.
    """
    last = edge.size - 2
    low = k - 1 if k > 0 else last
    high = k + 1 if k < last else 0
    below = edge[low + 1] - edge[low] if wraps or k > 0 else 0.0
    above = edge[high + 1] - edge[high] if wraps or k < last else 0.0
    return 0.5 * (edge[k + 1] - edge[k]) + max(below, above)


@kernel(plain=True)
def describe_cells(edges, periodic, planar, copies):
    """Write the centres of the cells, and for each layer its size and the slack of the copies in it."""
    beside = 0.0
    for axis in range(3):
        edge = edges[axis]
        n = edge.size - 1
        for k in range(n):
            copies.centre[axis, k] = 0.5 * (edge[k + 1] + edge[k])
            if axis == 0 or (axis == 1 and not planar):
                beside = max(beside, _farthest(edge, k, periodic[axis]))
        if periodic[axis]:  # after the last cell comes the first again
            copies.centre[axis, n] = copies.centre[axis, 0] + edge[n]
    x, y, z = edges
    area = x[x.size - 1] * (1.0 if planar else y[y.size - 1])
    copies.slack[:] = math.inf  # also for layers that the memory has room for but that do not exist
    copies.room[:] = 1.0
    for k in range(z.size - 1):
        layer = max(_farthest(z, k, periodic[2]), beside)
        copies.slack[k, DISTANCE] = SLACK * layer
        copies.slack[k, SQUARE] = SLACK * layer * layer
        copies.slack[k, CLOSING] = 4.0 * SLACK * layer  # times V
        copies.room[k] = area * (z[k + 1] - z[k])


@kernel
def members_of(slots):
    """Return the cells of three slots as eight bits, one for each combination of parities of their numbers."""
    x = 0xFF if slots[0] & 1 else (0xF0 if slots[0] & 2 else 0x0F)
    y = 0xFF if slots[1] & 1 else (0xCC if slots[1] & 2 else 0x33)
    z = 0xFF if slots[2] & 1 else (0xAA if slots[2] & 2 else 0x55)
    return x & y & z


@kernel
def number_of(bit, axis, slots):
    """Return the number along an axis of the cell, among those of three slots, that belongs to a bit."""
    lower = slots[axis] >> 1
    return lower + ((bit >> (2 - axis) ^ lower) & 1)


@kernel
def _turned(cell, number, modes):
    """Return the number of a cell along an axis of ``number`` cells; a periodic axis begins again after its end."""
    if modes.periodic:
        cell -= number if cell >= number else 0
    return cell


@kernel
def start_of(bit, slots, cells, modes):
    """Return where in memory the row begins of the cell, among those of three slots, that belongs to a bit."""
    x = _turned(number_of(bit, 0, slots), cells.number_x, modes)
    y = _turned(number_of(bit, 1, slots), cells.number_y, modes)
    z = _turned(number_of(bit, 2, slots), cells.number_z, modes)
    return (((x * cells.number_y + y) * cells.number_z + z) * cells.stride) & POSITIVE


@kernel
def _length_of_block(modes):
    """Return the number of words in a block of a row."""
    return 8 * BATCH if modes.mixed else 7 * BATCH


@kernel
def _name_of(place, modes):
    """Return the word of a row that holds the index of the molecule in a place."""
    return _HEAD + place // BATCH * _length_of_block(modes) + place % BATCH


@kernel
def copies_in_block(start, block, modes):
    """Return where in memory the copies of a block of a row begin."""
    return start + _HEAD + block * _length_of_block(modes) + _PLACE


@kernel
def number_of_places(cells, modes):
    """Return the number of places of a row."""
    return (cells.stride - _HEAD) // _length_of_block(modes) * BATCH


@kernel
def name_at(start, place, cells, modes):
    """Return the molecule in an occupied place of a row."""
    return np.int64(cells.row[start + _name_of(place, modes)])


@kernel
def name_in(start, place, cells, modes):
    """Return the molecule in a place of a row, -1 if the place is free."""
    if (cells.copies.occupied[start >> 1] >> place) & 1 == 0:
        return -1
    return name_at(start, place, cells, modes)


@kernel
def _free_place(start, cells):
    """Return the lowest place of a row that is free; `MOST` if none of the 64 is."""
    taken = cells.copies.occupied[start >> 1]
    return lowest_bit(~taken) if taken != -1 else MOST


@kernel
def has_place(start, cells, modes):
    """Return whether a row has a free place."""
    return _free_place(start, cells) < number_of_places(cells, modes)


@kernel
def enter(i, bit, start, cells, modes):
    """Give molecule i a place in a row, with NaN as its copy until that is written; return whether there was none."""
    place = _free_place(start, cells)
    if place >= number_of_places(cells, modes):
        return True
    cells.copies.occupied[start >> 1] |= np.int64(1) << place
    cells.copies.place[((i << 5) + PLACE_OFFSET + bit) & POSITIVE] = place
    at = start + _name_of(place, modes)
    cells.row[at] = i
    cells.copies.value[at + _PLACE] = np.nan
    return False


@kernel
def leave(i, bit, start, cells):
    """Remove molecule i from a row."""
    cells.copies.occupied[start >> 1] &= ~own_place(i, bit, cells.copies)


@kernel
def path_of(at, since, gas, modes):
    """Return the trajectory to be copied of a molecule whose `Motion` is ``at`` at the time ``since`` in the epoch.

    It is a `Motion` at the start of the epoch, in the frame that falls from then on. For a molecule faster than the top
    speed of copies it is NaN.
    """
    top = gas.cells.copies.epoch[TOP_SPEED]
    vx, vz, fall = at.vx, at.vz, 0.0
    if modes.gravity:
        vz += gas.box.gravity * since
        fall = 0.5 * gas.box.gravity * since * since
    vx = vx if vx * vx + at.vy * at.vy + vz * vz <= top * top else math.nan
    return Motion(at.x - vx * since, at.y - at.vy * since, at.z + fall - vz * since, vx, at.vy, vz)


@kernel
def write_copy(i, bit, start, path, centre, radius, copies, modes):
    """Write the copy of molecule i, from its `path_of`, into the row of a cell with this `centre_of`."""
    place = np.int64(copies.place[((i << 5) + PLACE_OFFSET + bit) & POSITIVE])
    first = start + _name_of(place, modes)
    value = copies.value
    value[first + _PLACE] = path.x - centre[0]
    value[first + _PLACE + BATCH] = path.y - centre[1]
    value[first + _PLACE + 2 * BATCH] = path.z - centre[2]
    value[first + _SPEED] = path.vx
    value[first + _SPEED + BATCH] = path.vy
    value[first + _SPEED + 2 * BATCH] = path.vz
    if modes.mixed:
        value[first + _EXTENT] = extent(radius)


@kernel
def fill(now, gas, modes):
    """Begin an epoch: write the copies of all molecules again; return whether a row is too short for its members."""
    cells, copies, molecules = gas.cells, gas.cells.copies, gas.molecules
    for cell in range(cells.number_x * cells.number_y * cells.number_z):
        copies.occupied[((cell * cells.stride) & POSITIVE) >> 1] = 0
    # the largest and the mean square speed, and the number of molecules in each layer
    number = 0
    squares = 0.0
    fastest = 0.0
    copies.horizon[:] = 0.0
    for i in range(molecules.size):
        if modes.phases and math.isinf(molecules[i].clock):
            continue
        at = motion_at(i, now, gas, modes)
        square = at.vx * at.vx + at.vy * at.vy + at.vz * at.vz
        number += 1
        squares += square
        fastest = max(fastest, square)
        copies.horizon[slots_of(i, gas)[2] >> 1] += 1.0
    mean_square = squares / max(number, 1)
    _new_epoch(now, math.sqrt(fastest), math.sqrt(mean_square), copies, gas.box.gravity)
    # how far ahead contacts are searched depends on the density of a layer
    for layer in range(copies.horizon.size):
        copies.horizon[layer] = _horizon(copies.horizon[layer] / copies.room[layer], mean_square, gas)
    for i in range(molecules.size):
        if modes.phases and math.isinf(molecules[i].clock):
            continue
        at = motion_at(i, now, gas, modes)
        slots = slots_of(i, gas)
        _, radius = size_and_radius(i, gas, modes)
        path = path_of(at, 0.0, gas, modes)
        members = members_of(slots)
        while members != 0:
            bit = lowest_bit(members)
            members &= members - 1
            start = start_of(bit, slots, cells, modes)
            if enter(i, bit, start, cells, modes):
                return True
            write_copy(i, bit, start, path, centre_of(bit, slots, copies), radius, copies, modes)
    return False


@kernel
def centre_of(bit, slots, copies):
    """Return the centre of the cell, among those of three slots, that belongs to a bit."""
    x = copies.centre[0, number_of(bit, 0, slots) & POSITIVE]
    y = copies.centre[1, number_of(bit, 1, slots) & POSITIVE]
    z = copies.centre[2, number_of(bit, 2, slots) & POSITIVE]
    return x, y, z


@kernel
def own_place(i, bit, copies):
    """Return, as a bit of the occupied places, the place of molecule i in the row of its cell for ``bit``."""
    return np.int64(1) << np.int64(copies.place[((i << 5) + PLACE_OFFSET + bit) & POSITIVE])


@kernel
def _new_epoch(now, fastest, usual, copies, gravity):
    """Begin an epoch for molecules of this greatest speed and root mean square speed, with the bounds above.

    A few molecules much faster than the others do not shorten the epoch: their copies are NaN.
    """
    epoch = copies.epoch
    width = math.inf
    for layer in range(copies.slack.shape[0]):
        width = min(width, copies.slack[layer, DISTANCE] / SLACK)
    speed = 1.25 * min(fastest, 6.0 * usual)
    if gravity > 0.0:
        # with 128 g W <= V^2, V H = 64 W means g H <= V / 2
        speed = max(2.0 * speed, math.sqrt(2.0 * PATH * gravity * width))
    speed = min(speed, SPEEDS)
    if speed < _SLOW:
        speed = 0.0  # copies of all that move are NaN: single precision could not hold their products
    epoch[START] = now
    epoch[STOP] = now + (min(epoch[LONGEST], PATH * width / speed) if speed > 0.0 else epoch[LONGEST])
    epoch[TOP_SPEED] = speed


@kernel
def _horizon(density, mean_square, gas):
    """Return how far ahead to search for contacts at a number density [time]: some mean free times.

    In a dense gas few molecules fly further. The rate of collisions is that of Enskog's theory; it need not be exact,
    since a molecule that finds no contact within the horizon searches again at its end.
    """
    diameter = 2.0 * gas.cells.copies.radius
    if gas.box.planar:
        filled = min(0.25 * math.pi * density * diameter * diameter, 0.7)
        free = 1.0 - filled
        excess = (1.0 - 0.4375 * filled) / (free * free)
        rate = 2.0 * density * diameter * math.sqrt(0.5 * math.pi * mean_square) * excess
    else:
        filled = min(math.pi / 6.0 * density * diameter * diameter * diameter, 0.6)
        free = 1.0 - filled
        excess = (1.0 - 0.5 * filled) / (free * free * free)
        rate = 4.0 * density * diameter * diameter * math.sqrt(math.pi / 3.0 * mean_square) * excess
    if filled < _DILUTE or not rate > 0.0:
        return math.inf
    return (3.0 if filled > _DENSE else 4.0) / rate

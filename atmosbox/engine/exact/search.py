"""The search for a molecule's next contact, where the rows of cells hold copies of trajectories.

A molecule with a new velocity searches the rows of all its cells. A molecule that reaches the boundary of new cells
searches only the rows of these. One function does both, so that the search is compiled once. It also takes the molecule
out of the cells that it no longer overlaps, because leaving a cell is not an event.
"""

from collections import namedtuple

import numpy as np

from atmosbox.engine.core.jit import kernel, lowest_bit
from atmosbox.engine.core.pair import approach, extent, predict, reach
from atmosbox.engine.core.state import Motion
from atmosbox.engine.exact.encounter import motion_at, size_and_radius, slots_of
from atmosbox.engine.exact.rows import (
    BATCH,
    CLOSING,
    DISTANCE,
    SQUARE,
    START,
    TOP_SPEED,
    centre_of,
    copies_in_block,
    enter,
    leave,
    members_of,
    name_at,
    own_place,
    path_of,
    screen,
    start_of,
    write_copy,
)

CONTACT = 6
"""Which event comes first: 0 to 5 a boundary or wall (twice the axis, plus 1 for the upper side), 6 a contact."""


_OTHERS = (1 << 64 - BATCH) - 1
"""The bits that remain in a word of occupied places when those of one block are shifted out.

A shift of a negative number to the right fills it with ones from the left; these bits cut them off.
"""


class Seeker(namedtuple("Seeker", "t at radius fall velocity since slack")):
    """A molecule that searches for partners, and what the quick test of `screen` needs of it.

    ``since`` is the time since the start of the copies' epoch [time], ``fall`` how far a molecule falls from rest in
    that time [length], ``slack`` what errors the test allows for.
    """


class Found(namedtuple("Found", "at slots after partner full")):
    """The result of a search.

    The `Motion` of the molecule, brought back into a periodic box; its slots; the time until its soonest contact [time]
    and the partner, -1 if that contact was known before or there is none; whether a row had no place for the molecule.
    """


@kernel
def _narrowed(x, slot, size, axis, cells):
    """Return the slot along an axis of a sphere centred at x, after leaving a cell if it no longer overlaps both."""
    if slot & 1 == 1:
        return slot - (x < cells.boundary[size, axis, slot]) + (x > cells.boundary[size, axis, slot + 1])
    return slot


@kernel
def _widened(slot, up):
    """Return the slot of a molecule that reaches the next cell along an axis: between that cell and the one before."""
    lower = slot >> 1
    return 2 * (lower + (slot & 1)) + 1 if up == 1 else 2 * lower - 1


@kernel
def _turns(slot, number):
    """Return by how many lengths of the box, -1, 0 or 1, a slot lies outside a periodic axis of ``number`` cells."""
    return (1 if slot >= 2 * number else 0) - (1 if slot < 0 else 0)


@kernel
def _brought_back(i, at, sx, sy, sz, gas):
    """Return the `Motion` of molecule i and its slots, brought back into the periodic box; update its record."""
    cells, box, molecule = gas.cells, gas.box, gas.molecules[i]
    x, y, z = at.x, at.y, at.z
    turns = _turns(sx, cells.number_x)
    if turns != 0:
        x -= turns * box.length_x
        sx -= 2 * turns * cells.number_x
        molecule.x -= turns * box.length_x
    turns = _turns(sy, cells.number_y)
    if turns != 0:
        y -= turns * box.length_y
        sy -= 2 * turns * cells.number_y
        molecule.y -= turns * box.length_y
    turns = _turns(sz, cells.number_z)
    if turns != 0:
        z -= turns * box.length_z
        sz -= 2 * turns * cells.number_z
        molecule.z -= turns * box.length_z
    return Motion(x, y, z, at.vx, at.vy, at.vz), sx, sy, sz


@kernel
def _image_shift(q, length, inverse):
    """Return what to subtract from a coordinate relative to the centre of a cell to get that of the nearest image."""
    return length * np.rint(q * inverse)


@kernel
def _seeker(t, at, radius, since, path, layer, gas, modes):
    """Return the `Seeker` of a molecule in a layer, from its `Motion` at time t and its `path_of`."""
    copies = gas.cells.copies
    fall = 0.5 * gas.box.gravity * since * since if modes.gravity else 0.0
    velocity = np.float32(path.vx), np.float32(path.vy), np.float32(path.vz)
    distance = extent(radius) if modes.mixed else reach(radius, radius)
    slack = (
        np.float32(distance + copies.slack[layer, DISTANCE]),
        np.float32(copies.slack[layer, SQUARE]),
        np.float32(copies.slack[layer, CLOSING] * copies.epoch[TOP_SPEED]),
    )
    return Seeker(t, at, radius, fall, velocity, np.float32(since), slack)


@kernel
def _soonest_in_row(start, centre, own, seeker, after, partner, gas, modes):
    """Return the earlier of the known contact (``after``, ``partner``) and the first one with a member of a row.

    ``own`` is the bit of the seeker's own place in the row, 0 if it has none.
    """
    cells, box = gas.cells, gas.box
    copies = cells.copies
    t, at, radius = seeker.t, seeker.at, seeker.radius
    x, y, z = at.x - centre[0], at.y - centre[1], at.z - centre[2]
    place = np.float32(x), np.float32(y), np.float32(z + seeker.fall)
    # first the quick test of all blocks, eight members at once (it is faster if it is separate from the exact test).
    # The bits of one number tell which places of the row are occupied, those of another which members may be hit:
    #
    #   bit    ...  15 14 13 12 11 10  9  8 |  7  6  5  4  3  2  1  0
    #   block                1              |           0
    occupied = copies.occupied[start >> 1] & ~own
    within = np.float32(after)
    named = np.int64(0)
    block = 0
    left = occupied
    while left != 0:
        first = copies_in_block(start, block, modes)
        seen = screen(copies.value, first, modes.mixed, place, seeker.velocity, seeker.since, seeker.slack, within)
        named |= seen << block * BATCH
        left = (left >> BATCH) & _OTHERS
        block += 1
    named &= occupied
    # then the exact test of the members that it names, each at its image nearest to the centre of the cell
    while named != 0:
        j = name_at(start, lowest_bit(named), cells, modes)
        named &= named - 1  # removes the lowest bit
        other = motion_at(j, t, gas, modes)
        rx, ry, rz = at.x - other.x, at.y - other.y, at.z - other.z
        if modes.periodic:  # x - rx is the coordinate of the other one
            rx += _image_shift(x - rx, box.length_x, box.inverse_x)
            ry += _image_shift(y - ry, box.length_y, box.inverse_y)
            if not (modes.gravity or modes.piston):
                rz += _image_shift(z - rz, box.length_z, box.inverse_z)
        other_radius = radius
        if modes.mixed:
            _, other_radius = size_and_radius(j, gas, modes)
        distance = reach(radius, other_radius)
        ux, uy, uz = at.vx - other.vx, at.vy - other.vy, at.vz - other.vz
        discriminant, b, c = approach(rx, ry, rz, ux, uy, uz, distance)
        if discriminant > 0.0:
            then = predict(discriminant, b, c)
            if then < after and b < 0.0:
                after = then
                partner = j
    return after, partner


@kernel
def search(i, t, at, boundary, gas, modes):
    """Update the cells of molecule i, whose `Motion` at time t is ``at``, and search for its soonest contact.

    Parameters
    ----------
    i, t, at
        Index of the molecule, the time, and its `Motion`.
    boundary
        The boundary of a cell that it has reached, 0 to 5; `CONTACT` or more if its velocity may be new.
    gas, modes
        All data of the engine, and the flags of the scene.

    Returns
    -------
    Found
        Its `Motion`, its slots and its contact.
    """
    cells, copies = gas.cells, gas.cells.copies
    event = gas.events[i]
    size, radius = size_and_radius(i, gas, modes)
    before = slots_of(i, gas)
    # the cells that it no longer overlaps
    sx = _narrowed(at.x, before[0], size, 0, cells)
    sy = _narrowed(at.y, before[1], size, 1, cells)
    sz = _narrowed(at.z, before[2], size, 2, cells)
    # at a boundary it enters cells of one layer: their numbers along that axis are all even or all odd, so a fixed set
    # of bits names them (x is odd in the cells of bits 4 to 7, y in those of 2, 3, 6, 7, z in those of 1, 3, 5, 7)
    crossing = boundary < CONTACT
    entered = 0xFF
    if crossing:
        axis, up = boundary >> 1, boundary & 1
        slot = _widened(before[axis], up)
        odd = (slot >> 1) + up & 1
        if axis == 0:
            sx = slot
            entered = 0xF0 if odd else 0x0F
        elif axis == 1:
            sy = slot
            entered = 0xCC if odd else 0x33
        else:
            sz = slot
            entered = 0xAA if odd else 0x55
    if modes.periodic:
        at, sx, sy, sz = _brought_back(i, at, sx, sy, sz, gas)
    slots = sx, sy, sz
    new = members_of(slots)
    # cells that it leaves: also those whose bit now stands for the entered cell, which lies two cells further on
    gone = members_of(before) & ((entered if crossing else 0) | ~new)
    while gone != 0:
        bit = lowest_bit(gone)
        gone &= gone - 1
        leave(i, bit, start_of(bit, before, cells, modes), cells)
    # search: at a boundary only the new cells, and only for contacts before the known one
    after = event.contact_time - t if crossing else copies.horizon[slots[2] >> 1]
    partner = -1
    full = False
    since = t - copies.epoch[START]
    path = path_of(at, since, gas, modes)
    seeker = _seeker(t, at, radius, since, path, slots[2] >> 1, gas, modes)
    # copies are written into its new cells, and into all its cells if its velocity is new (its clock then reads t)
    moved = crossing or gas.molecules[i].clock == t
    left = new & entered
    while left != 0:
        bit = lowest_bit(left)
        left &= left - 1
        start = start_of(bit, slots, cells, modes)
        centre = centre_of(bit, slots, copies)
        own = np.int64(0) if crossing else own_place(i, bit, copies)
        after, partner = _soonest_in_row(start, centre, own, seeker, after, partner, gas, modes)
        if crossing:
            full |= enter(i, bit, start, cells, modes)
        if moved and not full:
            write_copy(i, bit, start, path, centre, radius, copies, modes)
    event.slot_x, event.slot_y, event.slot_z = slots
    return Found(at, slots, after, partner, full)

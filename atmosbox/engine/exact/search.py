"""Whom a molecule meets next, where the rows of cells hold copies of trajectories.

A molecule searches the rows of its cells when its velocity is new, and the rows of new cells alone when it reaches
their boundary. Both are done here, so that the search is compiled once. On the way it leaves the cells that it no
longer overlaps: nothing else ever happens because a cell is left.
"""

from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel, lowest_bit
from atmosbox.engine.core.pair import approach, extent, predict, reach
from atmosbox.engine.core.state import Motion
from atmosbox.engine.exact.encounter import motion_at, size_and_radius, slots_of
from atmosbox.engine.exact.glance import CLOSING, DISTANCE, LANES, SQUARE, glance
from atmosbox.engine.exact.rows import (
    START,
    TOP_SPEED,
    enter,
    first_of_block,
    leave,
    members_of,
    relative,
    start_of,
    write_copy,
)

__all__ = ["CONTACT", "Found", "search"]

CONTACT = 6
"""What comes first: 0 to 5 is a boundary or wall (twice the axis, plus 1 for the upper side), 6 a contact."""


class Seeker(NamedTuple):
    """A molecule that looks for partners: number, time, its `Motion` then, its radius, the time since the epoch."""

    i: int
    t: float
    at: Motion
    radius: float
    since: float


class Found(NamedTuple):
    """What a search has found.

    Where the molecule is, brought back into a periodic box; its slots; how long until its soonest contact [time] and
    with which molecule, -1 if that contact was known before or there is none; whether a row had no place for it.
    """

    at: Any
    slots: Any
    after: float
    partner: int
    full: bool


@kernel
def _narrowed(x, slot, size, axis, cells):
    """Return the slot along an axis of a sphere centred at x that has left one of its two cells, or has not."""
    if slot & 1 == 1:
        return slot - (x < cells.boundary[size, axis, slot]) + (x > cells.boundary[size, axis, slot + 1])
    return slot


@kernel
def _widened(slot, up):
    """Return the slot of a molecule that reaches the next cell along an axis: that cell, and the one before it."""
    lower = slot >> 1
    return 2 * (lower + (slot & 1)) + 1 if up == 1 else 2 * lower - 1


@kernel
def _turns(slot, number):
    """Return how often a slot on a periodic axis of so many cells has gone round: -1, 0 or 1."""
    return (1 if slot >= 2 * number else 0) - (1 if slot < 0 else 0)


@kernel
def _brought_back(i, at, sx, sy, sz, gas):
    """Return where molecule i is, and its slots, brought back into the periodic box; write it down."""
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
    """Return by how much a coordinate relative to the centre of a cell must be shifted to be the nearest image."""
    return length * np.rint(q * inverse)


@kernel
def _soonest_in_row(start, bit, slots, seeker, after, partner, gas, modes):
    """Return the earlier of the contact known, ``after`` and ``partner``, and the first one with a member of a row."""
    cells, box = gas.cells, gas.box
    copies = cells.copies
    i, t, at, radius, since = seeker
    layer = slots[2] >> 1
    here = relative(at, bit, slots, copies)
    fall, gain = 0.0, 0.0
    if modes.gravity:
        fall = 0.5 * box.gravity * since * since
        gain = box.gravity * since
    speed_squared = at.vx * at.vx + at.vy * at.vy + (at.vz + gain) * (at.vz + gain)
    top = copies.epoch[TOP_SPEED]
    x = np.float32(here.x if speed_squared <= top * top else np.nan)
    place = x, np.float32(here.y), np.float32(here.z + fall)
    velocity = np.float32(at.vx), np.float32(at.vy), np.float32(at.vz + gain)
    distance = extent(radius) if modes.mixed else reach(radius, radius)
    slack = (
        np.float32(distance + copies.slack[layer, DISTANCE]),
        np.float32(copies.slack[layer, SQUARE]),
        np.float32(copies.slack[layer, CLOSING] * top),
    )
    occupied = copies.occupied[start >> 1]
    block = 0
    while occupied != 0:
        first = first_of_block(start, block, modes)
        named = glance(copies.value, first, modes.mixed, place, velocity, np.float32(since), slack, np.float32(after))
        named &= occupied
        while named != 0:
            lane = lowest_bit(named)
            named &= named - 1
            j = np.int64(cells.row[first - LANES + lane])
            if j != i:
                # double precision judges; the image of a member is the one nearest to the centre of the cell
                other = motion_at(j, t, gas, modes)
                rx, ry, rz = at.x - other.x, at.y - other.y, at.z - other.z
                if modes.periodic:
                    rx += _image_shift(here.x - rx, box.length_x, box.inverse_x)
                    ry += _image_shift(here.y - ry, box.length_y, box.inverse_y)
                    if not (modes.gravity or modes.piston):
                        rz += _image_shift(here.z - rz, box.length_z, box.inverse_z)
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
        occupied = (occupied >> LANES) & 0x0000FFFFFFFFFFFF
        block += 1
    return after, partner


@kernel
def search(i, t, at, boundary, gas, modes):
    """Bring molecule i, which is where ``at`` says at time t, into its cells, and look for its soonest contact.

    Parameters
    ----------
    i, t, at
        Its number, the time, its `Motion`.
    boundary
        The boundary of a cell that it has reached, 0 to 5; `CONTACT` or more if its velocity may be new.
    gas, modes
        All the rest.

    Returns
    -------
    Found
        Its place, its slots and its contact.
    """
    cells, copies = gas.cells, gas.cells.copies
    event = gas.events[i]
    size, radius = size_and_radius(i, gas, modes)
    before = slots_of(i, gas)
    # the cells that it no longer overlaps
    sx = _narrowed(at.x, before[0], size, 0, cells)
    sy = _narrowed(at.y, before[1], size, 1, cells)
    sz = _narrowed(at.z, before[2], size, 2, cells)
    # the cells that it enters: those along one axis whose number has one parity
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
    gone = members_of(before) & ((entered if crossing else 0) | ~new)
    while gone != 0:
        bit = lowest_bit(gone)
        gone &= gone - 1
        leave(i, bit, start_of(bit, before, cells, modes), cells)
    # who is in the others? On entering a cell, only those in it are asked for, and only sooner than what is known
    after = event.contact_time - t if crossing else copies.horizon[slots[2] >> 1]
    partner = -1
    full = False
    seeker = Seeker(i, t, at, radius, t - copies.epoch[START])
    moved = crossing or gas.molecules[i].clock == t
    left = new & entered
    while left != 0:
        bit = lowest_bit(left)
        left &= left - 1
        start = start_of(bit, slots, cells, modes)
        after, partner = _soonest_in_row(start, bit, slots, seeker, after, partner, gas, modes)
        if crossing:
            full |= enter(i, bit, start, cells, modes)
        if moved and not full:
            write_copy(i, bit, start, relative(at, bit, slots, copies), radius, seeker.since, gas, modes)
    event.slot_x = sx
    event.slot_y = sy
    event.slot_z = sz
    return Found(at, slots, after, partner, full)

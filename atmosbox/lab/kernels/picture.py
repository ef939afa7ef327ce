"""What a page draws of a box: molecules as `atmosbox.page.frame` wants them, and the liquid as that file draws it."""

import functools
import math
from collections import namedtuple
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.encounter import motion_at
from atmosbox.engine.liquid.reservoir import LIQUID, RAINED
from atmosbox.lab.kernels.clustering import count_wells
from atmosbox.lab.kernels.sums import ceiling, is_away
from atmosbox.page.frame import POOL, RAIN

_FINEST, _FASTEST = 65535, 255


class Picture(namedtuple("Picture", "shown length place colour highest state drops many unit water clump spread")):
    """The data of a picture.

    ``shown : (shown,)`` are the molecules that are drawn; ``length : (3,)`` the present sides of the box [length];
    ``place : (shown, 3)`` uint16 and ``colour : (shown,)`` uint8 as in `atmosbox.page.frame`; ``highest`` is the speed
    at the top of the scale of colours [velocity].

    ``state : (shown,)`` uint8 is 1 for a molecule that is not in the gas; ``drops : (drop, 4)`` float32 are the pieces
    of liquid to draw, in the unit of the page, and ``many : (1,)`` their present number. A scene with liquid also has:
    ``unit``, the unit of the page over the length of the engine; ``water``, the number of molecules of water;
    ``spread : (clump, axis)``, the places of the clumps of a mist as shares of the box, and ``clump``, the size of a
    clump of one molecule.
    """


@functools.cache
def picture(modes: Modes, *, wells: bool = False) -> Callable[..., Any]:
    """Return the kernel ``look`` of one set of modes; ``wells`` if molecules attract each other."""

    @kernel
    def look(gas, book, layout, crowd, picture):
        """Write positions and colours of the molecules that are shown: by speed, or by the wells that each is in."""
        now, box = book.now[0], gas.box
        picture.length[0] = box.length_x
        picture.length[1] = box.length_y
        picture.length[2] = ceiling(gas, now)
        if wells:
            count_wells(gas.vicinity, layout.stride[0], crowd.wells)
        for k in range(picture.shown.size):
            picture.state[k] = is_away(picture.shown[k], gas, modes)
            if picture.state[k] == 1:
                picture.place[k, 0] = picture.place[k, 1] = picture.place[k, 2] = 0
                picture.colour[k] = 0
                continue
            at = motion_at(picture.shown[k], now, gas, modes)
            picture.place[k, 0] = _share(at.x, picture.length[0], box.inverse_x)
            picture.place[k, 1] = _share(at.y, picture.length[1], box.inverse_y)
            picture.place[k, 2] = _share(at.z, picture.length[2], box.inverse_z)
            value = math.sqrt(at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
            if wells:
                value = crowd.wells[picture.shown[k]]
            picture.colour[k] = math.floor(min(value / picture.highest, 1.0) * _FASTEST + 0.5)
        if modes.phases:
            _look_at_liquid(gas, book, picture, modes)
        return 0

    return look  # type: ignore[no-any-return]


@kernel
def _share(u, length, inverse):
    """Return a coordinate over a side of the box, as a 16-bit number."""
    part = u / length
    if inverse != 0.0:
        part -= math.floor(part)
    return int(min(max(part, 0.0), 1.0) * _FINEST + 0.5)


@kernel
def _draw(x, y, z, size, picture):
    """Add a piece of liquid to those that are drawn, in the unit of the page."""
    row = picture.drops[picture.many[0]]
    row[0], row[1], row[2], row[3] = x, y, z, size
    picture.many[0] += 1


@kernel
def _look_at_liquid(gas, book, picture, modes):
    """Write the liquid as drops, as clumps that are all alike and have fixed places, or as layers on the floor."""
    box, drops, count, unit = gas.box, book.moisture.drops, book.moisture.reservoir.count, picture.unit
    picture.many[0] = 0
    if modes.drops > 0:
        for k in range(drops.record.size):
            if drops.alive[k] == 1:
                at = motion_at(drops.record[k], book.now[0], gas, modes)
                x = at.x - math.floor(at.x * box.inverse_x) * box.length_x
                y = at.y - math.floor(at.y * box.inverse_y) * box.length_y
                z = at.z - math.floor(at.z * box.inverse_z) * box.length_z
                _draw(x * unit, y * unit, z * unit, gas.kinds.table[modes.drops + k].radius * unit, picture)
    elif not modes.pool:
        many, side = min(picture.spread.shape[0], count[LIQUID]), picture.length
        for k in range(many):
            at, radius = picture.spread[k], picture.clump * cbrt(count[LIQUID] / many)
            _draw(at[0] * side[0] * unit, at[1] * side[1] * unit, at[2] * side[2] * unit, radius, picture)
    for number, what in ((count[LIQUID] if modes.pool else 0, POOL), (count[RAINED], RAIN)):
        if number > 0 and picture.water > 0:
            _draw(0.0, 0.0, min(number / picture.water, 1.0), what, picture)

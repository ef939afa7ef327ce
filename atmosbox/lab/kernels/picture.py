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
def picture(modes: Modes) -> Callable[..., Any]:
    """Return the kernel ``look`` of one set of modes."""
    look_at_liquid = _liquid(modes)

    @kernel
    def share(u, length, inverse):
        """Return a coordinate over a side of the box, as a 16-bit number."""
        part = u / length
        if inverse != 0.0:
            part -= math.floor(part)
        return math.floor(min(max(part, 0.0), 1.0) * _FINEST + 0.5)

    @kernel
    def look(gas, book, picture):
        """Write the positions and the colours, by speed, of all molecules that are shown."""
        now, box = book.now[0], gas.box
        picture.length[0] = box.length_x
        picture.length[1] = box.length_y
        picture.length[2] = ceiling(gas, now)
        for k in range(picture.shown.size):
            picture.state[k] = 0
            if is_away(picture.shown[k], gas, modes):
                picture.place[k, 0] = picture.place[k, 1] = picture.place[k, 2] = 0
                picture.colour[k] = 0
                picture.state[k] = 1
                continue
            at = motion_at(picture.shown[k], now, gas, modes)
            picture.place[k, 0] = int(share(at.x, picture.length[0], box.inverse_x))
            picture.place[k, 1] = int(share(at.y, picture.length[1], box.inverse_y))
            picture.place[k, 2] = int(share(at.z, picture.length[2], box.inverse_z))
            speed = math.sqrt(at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
            picture.colour[k] = math.floor(min(speed / picture.highest, 1.0) * _FASTEST + 0.5)
        if modes.phases:
            look_at_liquid(gas, book, picture)
        return 0

    return look  # type: ignore[no-any-return]


@functools.cache
def _liquid(modes: Modes) -> Callable[..., Any]:
    """Return the kernel of one set of modes that writes which drops are drawn."""

    @kernel
    def draw_layer(number, what, picture):
        """Draw this number of molecules as a layer on the floor."""
        if number > 0 and picture.water > 0:
            row = picture.drops[picture.many[0]]
            row[0] = row[1] = 0.0
            row[2] = min(number / picture.water, 1.0)
            row[3] = what
            picture.many[0] += 1

    @kernel
    def draw_mist(number, picture):
        """Draw this number of molecules as clumps, which are all alike and have fixed places."""
        if number <= 0:
            return
        many = min(picture.spread.shape[0], number)
        radius = picture.clump * cbrt(number / many)
        for k in range(many):
            for axis in range(3):
                picture.drops[k, axis] = picture.spread[k, axis] * picture.length[axis] * picture.unit
            picture.drops[k, 3] = radius
        picture.many[0] = many

    @kernel
    def draw_drops(gas, book, picture):
        """Draw the drops at their positions, in their size."""
        drops, box = book.moisture.drops, gas.box
        for k in range(drops.record.size):
            if drops.alive[k] == 1:
                row = picture.drops[picture.many[0]]
                at = motion_at(drops.record[k], book.now[0], gas, modes)
                row[0] = (at.x - math.floor(at.x * box.inverse_x) * box.length_x) * picture.unit
                row[1] = (at.y - math.floor(at.y * box.inverse_y) * box.length_y) * picture.unit
                row[2] = (at.z - math.floor(at.z * box.inverse_z) * box.length_z) * picture.unit
                row[3] = gas.kinds.table[modes.drops + k].radius * picture.unit
                picture.many[0] += 1

    @kernel
    def look_at_liquid(gas, book, picture):
        """Write the drops, clumps or layers to draw, in the unit of the page."""
        count = book.moisture.reservoir.count
        picture.many[0] = 0
        if modes.drops > 0:
            draw_drops(gas, book, picture)
        elif modes.pool:
            draw_layer(count[LIQUID], POOL, picture)
        else:
            draw_mist(count[LIQUID], picture)
        draw_layer(count[RAINED], RAIN, picture)

    return look_at_liquid  # type: ignore[no-any-return]

"""The picture of a box in a page: the positions of its molecules, in the format of a frame of the page."""

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.encounter import motion_at
from atmosbox.lab.kernels.liquid_sight import liquid_sight
from atmosbox.lab.kernels.presence import is_away

__all__ = ["Sight", "sight"]

_FINEST, _FASTEST = 65535, 255


class Sight(NamedTuple):
    """The data of a picture.

    ``shown : (shown,)`` are the molecules that are drawn; ``length : (3,)`` the present sides of the box [length];
    ``place : (shown, 3)`` uint16 and ``colour : (shown,)`` uint8 as in `atmosbox.page.frame`; ``highest`` is the speed
    at the top of the scale of colours [velocity].

    ``state : (shown,)`` uint8 is 1 for a molecule that is not in the gas; ``drops : (drop, 4)`` float32 are the pieces
    of liquid to draw, in the unit of the page, and ``many : (1,)`` their present number. A scene with liquid also has:
    ``unit``, the unit of the page over the length of the engine; ``water``, the number of molecules of water;
    ``spread : (clump, axis)``, the places of the clumps of a mist as shares of the box, and ``clump``, the size of a
    clump of one molecule; ``layers : (2,)``, the values that stand instead of a radius for a pool and for rain.
    """

    shown: Any
    length: Any
    place: Any
    colour: Any
    highest: float
    state: Any
    drops: Any
    many: Any
    unit: float
    water: int
    clump: float
    spread: Any
    layers: Any


@functools.cache
def sight(modes: Modes) -> Callable[..., Any]:
    """Return the kernel ``look`` of one set of modes."""
    look_at_liquid = liquid_sight(modes)

    @kernel
    def share(u, length, inverse):
        """Return a coordinate over a side of the box, as a 16-bit number."""
        part = u / length
        if inverse != 0.0:
            part -= math.floor(part)
        return math.floor(min(max(part, 0.0), 1.0) * _FINEST + 0.5)

    @kernel
    def look(gas, book, sight):
        """Write the positions and the colours, by speed, of all molecules that are shown."""
        now, box = book.now[0], gas.box
        piston = gas.walls.piston
        sight.length[0] = box.length_x
        sight.length[1] = box.length_y
        sight.length[2] = piston[0] + piston[1] * (now - piston[2])
        for k in range(sight.shown.size):
            sight.state[k] = 0
            if is_away(sight.shown[k], gas, modes):
                sight.place[k, 0] = sight.place[k, 1] = sight.place[k, 2] = 0
                sight.colour[k] = 0
                sight.state[k] = 1
                continue
            at = motion_at(sight.shown[k], now, gas, modes)
            sight.place[k, 0] = int(share(at.x, sight.length[0], box.inverse_x))
            sight.place[k, 1] = int(share(at.y, sight.length[1], box.inverse_y))
            sight.place[k, 2] = int(share(at.z, sight.length[2], box.inverse_z))
            speed = math.sqrt(at.vx * at.vx + at.vy * at.vy + at.vz * at.vz)
            sight.colour[k] = math.floor(min(speed / sight.highest, 1.0) * _FASTEST + 0.5)
        look_at_liquid(gas, book, sight)
        return 0

    return look  # type: ignore[no-any-return]

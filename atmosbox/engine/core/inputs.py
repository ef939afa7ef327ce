"""Checks of the parameters of a box: every number is checked once, and every refusal is a sentence."""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.refusal import LARGEST, SMALLEST, RefusedError, shown
from atmosbox.engine.core.walls import PISTON, WALL_NAMES, first_bath_kT

Array = NDArray[np.float64]

_PIECE = 1 << 20  # number of molecules whose squares are summed at once


def numbers(values: ArrayLike, name: str, **kind: Any) -> Array:
    """Return an array of numbers of this ``kind`` of `numpy.array`, or refuse."""
    try:
        return np.array(values, np.float64, **kind)
    except (TypeError, ValueError):
        raise RefusedError(f"{name} holds something that is not a number: give numbers alone") from None


def matrix(values: ArrayLike, name: str, *, copy: bool = True) -> Array:
    """Return three finite numbers per molecule as (molecule, axis), or refuse.

    A copy is stored column by column. Without a copy the result may be the caller's own array: do not change it.
    """
    array = numbers(values, name, order="F" if copy else "K", copy=copy or None)
    if array.size == 0:
        array = array.reshape(0, 3)
    if array.ndim != 2 or array.shape[1] != 3:
        raise RefusedError(f"{name} has shape {array.shape}: give three numbers per molecule")
    if not np.isfinite(array).all():
        i = int(np.argmax(~np.isfinite(array).all(axis=1)))
        raise RefusedError(f"{name} of molecule {i} is not finite: give finite numbers")
    return array


def column(
    values: ArrayLike, n: int, name: str, *, positive: bool = False, small: float = 0.0, shared: bool = False
) -> Array:
    """Return one number per molecule as (molecule,), 0 or above, or else ``positive``; or refuse.

    No number may lie between 0 and ``small``. If ``shared``, one number given for all molecules is stored once, and the
    result cannot be changed.
    """
    array = numbers(values, name)
    if array.ndim > 1 or (array.ndim == 1 and array.size != n):
        raise RefusedError(f"{name} has shape {array.shape}: give one number, or one for each of {n} molecules")
    bad = ~((array > 0.0 if positive else array >= 0.0) & (array <= LARGEST)) | ((array > 0.0) & (array < small))
    if bad.any():
        value = float(array.reshape(-1)[np.argmax(bad.reshape(-1))])
        limit = "above 0" if positive else "0 or above"
        limit += f" and at most {LARGEST:g}" + (f", but not between 0 and {small:g}" if small else "")
        raise RefusedError(f"{name} = {value:g} of a molecule is impossible: give a finite number, {limit}")
    column = np.broadcast_to(array, (n,))
    return column if shared else column.copy()


def sides_of(length: Any) -> Array:
    """Return the three sides of a box, or refuse."""
    try:
        sides = np.array(length, np.float64)
    except (TypeError, ValueError):
        sides = np.zeros(0)
    if sides.shape != (3,) or not ((sides >= SMALLEST) & (sides <= LARGEST)).all():
        raise RefusedError(
            f"length = {shown(length)}: give three sides, each above 0 (from {SMALLEST:g} to {LARGEST:g})"
        )
    return sides


def speeds(velocity: Array) -> None:
    """Refuse velocities so large, or all so small, that their squares times those of lengths would not be numbers."""
    top = max(float(velocity.max(initial=0.0)), -float(velocity.min(initial=0.0)))
    if top > LARGEST or 0.0 < top < SMALLEST:
        raise RefusedError(
            f"velocity = {top:g}, the largest component of all, is impossible: give 0, or one from {SMALLEST:g} to "
            f"{LARGEST:g} (in another unit of time)"
        )


def inside(x: Array, diameter: Array, sides: Array, periodic: tuple[bool, bool, bool]) -> Array:
    """Return the centres, moved in place where rounding has put them into a wall; refuse any that lie outside."""
    alike = diameter.size > 0 and diameter.strides == (0,)
    radius = 0.5 * (diameter[0] if alike else diameter)  # one number where possible: an array of ten million is large
    for axis in range(3):
        if periodic[axis]:
            continue
        slack = 1e-12 * sides[axis]
        low = x[:, axis] < radius - slack
        high = x[:, axis] > sides[axis] - radius + slack
        if (low | high).any():
            i = int(np.argmax(low | high))
            wall = WALL_NAMES[2 * axis + (0 if low[i] else 1)]
            reach = 0.5 * float(diameter[i])
            raise RefusedError(
                f"molecule {i} at {'xyz'[axis]} = {x[i, axis]:.6g} reaches through wall {wall}: its centre must lie "
                f"between {reach:.6g} and {sides[axis] - reach:.6g}"
            )
        np.clip(x[:, axis], radius, sides[axis] - radius, out=x[:, axis])
    return x


def natural_time(v: Array, sides: Array, n: int, walls: Any, mass: Array, gravity: float) -> float:
    """Return the time in which a molecule moves by the mean distance between neighbours [time]."""
    spacing = float(cbrt(math.prod(float(side) for side in sides) / max(n, 1)))
    total = sum(sum_of_squares(column) for column in v.T)
    speeds = [math.sqrt(total / n)] if n else []
    speeds += [math.sqrt(kT / float(mass.mean())) for kT in first_bath_kT(walls) if n]
    if gravity > 0.0:
        speeds.append(math.sqrt(gravity * spacing))
    if walls.law[5] == PISTON:
        speeds.append(abs(float(walls.piston[1])))
    fastest = max(speeds, default=0.0)
    return spacing / fastest if fastest > 0.0 and math.isfinite(spacing / fastest) else 1.0


def sum_of_squares(column: Array) -> float:
    """Return the sum of the squares of a column, without making a second array of its size."""
    pieces = (column[first : first + _PIECE] for first in range(0, column.size, _PIECE))
    return sum((float(np.sum(piece * piece)) for piece in pieces), 0.0)

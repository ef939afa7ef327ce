r"""One step of free flight, for all molecules that meet no wall.

Nearly all molecules meet no wall in a step. They are moved by three loops, one per axis, that a processor runs
for four molecules at a time. The few that come near a wall are not moved here: see `bounce`.

The rule for the fall in gravity can be chosen, because simple programs have different rules:

``PARABOLA``
    the exact parabola, :math:`z + v \Delta t - g \Delta t^2 / 2`.
``EULER``
    with the velocity before the step, :math:`z + v \Delta t`, which heats by :math:`m g^2 \Delta t / 2` per
    molecule and unit time.
``SEMI_IMPLICIT``
    with the velocity after the step, :math:`z + (v - g \Delta t) \Delta t`, which cools by the same amount.
"""

import math
from typing import NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel

__all__ = ["BLOCK", "EULER", "PARABOLA", "SEMI_IMPLICIT", "drift"]

PARABOLA, EULER, SEMI_IMPLICIT = 0, 1, 2

_AWAY = np.int32(-(1 << 28))
BLOCK = 512
"""Number of molecules that are moved together; their data fit into the nearest cache."""


class Axis(NamedTuple):
    """An axis along which molecules move.

    The side of the box and its inverse, 0 unless the axis is periodic; ``low`` and ``high``: no wall is near between
    them [length]; the number of cells per length [1/length], and in all; the step of a cell's number from
    one cell to the next; whether the box is periodic along any axis.
    """

    side: float
    inverse: float
    low: float
    high: float
    per_length: float
    number: int
    stride: int
    periodic: bool


@kernel
def _ahead(x, v, dt, fall, axis):
    """Return a coordinate one step later; on a periodic axis, brought back into the box."""
    x = x + v * dt - fall
    if axis.periodic:
        x = x - axis.side * np.floor(x * axis.inverse)
        x = 0.0 if axis.inverse > 0.0 and x >= axis.side else x
    return x


@kernel
def _along(at, axis):
    """Return what a coordinate contributes to the number of a cell; a very negative number near a wall."""
    here = min(np.int32(at * axis.per_length), np.int32(axis.number - 1)) * np.int32(axis.stride)
    return _AWAY if (at < axis.low) | (at > axis.high) else here


@kernel
def _glide(x, v, old, cell, dt, axis):
    """Move molecules along a horizontal axis, store their old coordinates, and add the axis to their cell numbers."""
    for p in range(x.size):
        at = _ahead(x[p], v[p], dt, 0.0, axis)
        old[p] = x[p]
        x[p] = at
        cell[p] += _along(at, axis)


@kernel
def _fall(z, v, cell, dt, fall, gain, axis):
    """Add the vertical axis to the cell numbers of molecules, and move along it those that come near no wall at all."""
    for p in range(z.size):
        at = _ahead(z[p], v[p], dt, fall, axis)
        cell[p] += _along(at, axis)
        stays = cell[p] >= 0
        z[p] = at if stays else z[p]
        if gain is not None:
            v[p] = v[p] - gain if stays else v[p]


@kernel
def drift(part, first, last, step, layers, gas, modes):
    """Move the molecules of one part that meet no wall, and count them into their cells.

    Parameters
    ----------
    part, first, last
        The part, and its slots ``first`` to ``last - 1``. Its row of the histogram is filled with the number of
        molecules in each cell after the step, without those that come near a wall.
    step
        The step: see `atmosbox.engine.stepped.stepped.Step`.
    layers
        Number of layers of cells now.
    gas, modes
        The data of the engine, see `atmosbox.engine.stepped.stepped.Filed`; the flags of the scene. Of the
        molecules, ``cell`` is filled with the cell of each after the step, or a negative number if it comes near a
        wall; ``hitting``, from ``first`` on, with the slots of the latter.

    Returns
    -------
    int
        Number of molecules that come near a wall.
    """
    state, grid, box = gas.state, gas.grid, gas.box
    before, histogram = state.before[part], gas.records.histogram[part]
    dt = step.length
    gain = box.gravity * dt if modes.gravity else 0.0
    share = 0.5 if step.motion == PARABOLA else (1.0 if step.motion == SEMI_IMPLICIT else 0.0)
    fall = share * gain * dt
    top = step.ceiling + step.ceiling_velocity * dt
    # if the ceiling comes down, its lowest height counts; a parabola may reach it although neither of its ends does
    low_top = min(step.ceiling, top) - 0.5 * gain * dt
    near_x = grid.margin if box.inverse_x == 0.0 else -math.inf
    near_y = grid.margin if box.inverse_y == 0.0 else -math.inf
    near_z = grid.margin if box.inverse_z == 0.0 else -math.inf
    wide_x, wide_y = box.length_x, box.length_y
    along_x = Axis(
        wide_x, box.inverse_x, near_x, wide_x - near_x, grid.inverse_x, grid.number_x, 1, modes.periodic
    )  # fmt: skip
    along_y = Axis(
        wide_y, box.inverse_y, near_y, wide_y - near_y, grid.inverse_y, grid.number_y, grid.number_x, modes.periodic
    )  # fmt: skip
    along_z = Axis(
        box.length_z, box.inverse_z, near_z, low_top - near_z, layers / top, layers, grid.number_x * grid.number_y,
        modes.periodic and not (modes.gravity or modes.piston),
    )  # fmt: skip
    histogram[:] = 0
    many = 0
    for begin in range(first, last, BLOCK):
        end = min(begin + BLOCK, last)
        c = state.cell[begin:end]
        x, y, z = state.position[0, begin:end], state.position[1, begin:end], state.position[2, begin:end]
        vx, vy, vz = state.velocity[0, begin:end], state.velocity[1, begin:end], state.velocity[2, begin:end]
        old_x, old_y = before[0, : end - begin], before[1, : end - begin]
        c[:] = 0
        _glide(x, vx, old_x, c, dt, along_x)
        if not box.planar:
            _glide(y, vy, old_y, c, dt, along_y)
        _fall(z, vz, c, dt, fall, gain if modes.gravity else None, along_z)
        for p in range(c.size):
            if c[p] >= 0:
                histogram[np.uint32(c[p])] += np.int32(1)
            else:
                x[p] = old_x[p]
                if not box.planar:
                    y[p] = old_y[p]
                state.hitting[first + many] = begin + p
                many += 1
    return many

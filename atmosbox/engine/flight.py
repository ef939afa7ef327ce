r"""One step of free flight, for all that meet no wall.

Nearly all molecules meet no wall in a step. They are moved by three loops, one per axis, that a processor runs
four molecules at a time. The few that come near a wall are left where they are: see `bounce`.

How molecules fall is a choice, because simple programs choose differently:

``PARABOLA``
    as bodies do, :math:`z + v \Delta t - g \Delta t^2 / 2`.
``EULER``
    with the velocity from before the step, :math:`z + v \Delta t`, which heats by :math:`m g^2 \Delta t / 2` per
    molecule and unit time.
``SEMI_IMPLICIT``
    with the velocity from after it, :math:`z + (v - g \Delta t) \Delta t`, which cools by as much.
"""

import math

import numpy as np

from atmosbox.engine._jit import kernel

__all__ = ["EULER", "PARABOLA", "SEMI_IMPLICIT", "drift"]

PARABOLA, EULER, SEMI_IMPLICIT = 0, 1, 2

_AWAY = np.int32(-(1 << 28))
_BLOCK = 1024


@kernel
def _ahead(x, v, dt, fall, side, inverse, end):
    """Return where a coordinate is a step later; on a periodic axis back in the box."""
    x = x + v * dt - fall
    x = x - side * np.floor(x * inverse)
    return 0.0 if x >= end else x


@kernel
def _look_along(x, v, cell, dt, fall, side, inverse, low, high, per_length, number, stride):
    """Add one axis to the cell of each molecule's next place; one that comes near a wall gets a negative number."""
    end = side if inverse > 0.0 else math.inf
    last = np.int32(number - 1)
    stride = np.int32(stride)
    for p in range(x.size):
        at = _ahead(x[p], v[p], dt, fall, side, inverse, end)
        here = min(np.int32(at * per_length), last) * stride
        cell[p] += _AWAY if (at < low) | (at > high) else here


@kernel
def _go_along(x, v, cell, dt, fall, side, inverse):
    """Move along one axis those molecules that meet no wall."""
    end = side if inverse > 0.0 else math.inf
    for p in range(x.size):
        at = _ahead(x[p], v[p], dt, fall, side, inverse, end)
        x[p] = at if cell[p] >= 0 else x[p]


@kernel
def drift(state, histogram, first, last, step, layers, grid, box, modes):
    """Move the molecules of one part that meet no wall, and count them into their cells.

    Parameters
    ----------
    state
        The molecules: see `atmosbox.engine.stepped.State`. Its ``cell`` is filled with the cell that each will be
        in, a negative number for one that comes near a wall; its ``hitting``, from ``first`` on, with those.
    histogram : (cell,)
        Filled with how many of the others will stand in each cell.
    first, last
        The part: slots ``first`` to ``last - 1``.
    step
        The step: see `atmosbox.engine.stepped.Step`.
    layers
        Number of layers of cells now.
    grid, box, modes
        The cells, the box, what the scene requires.

    Returns
    -------
    int
        How many come near a wall.
    """
    dt = step.length
    gain = box.gravity * dt if modes.gravity else 0.0
    share = 0.5 if step.motion == PARABOLA else (1.0 if step.motion == SEMI_IMPLICIT else 0.0)
    fall = share * gain * dt
    top = step.ceiling + step.ceiling_velocity * dt
    # where the ceiling comes down the lowest that it is counts; a parabola may reach it although neither end does
    low_top = min(step.ceiling, top) - 0.5 * gain * dt
    near_x = grid.margin if box.inverse_x == 0.0 else -math.inf
    near_y = grid.margin if box.inverse_y == 0.0 else -math.inf
    near_z = grid.margin if box.inverse_z == 0.0 else -math.inf
    histogram[:] = 0
    many = 0
    for begin in range(first, last, _BLOCK):
        end = min(begin + _BLOCK, last)
        c = state.cell[begin:end]
        x, y, z = state.position[0, begin:end], state.position[1, begin:end], state.position[2, begin:end]
        vx, vy, vz = state.velocity[0, begin:end], state.velocity[1, begin:end], state.velocity[2, begin:end]
        c[:] = 0
        side = box.length_x
        _look_along(
            x, vx, c, dt, 0.0, side, box.inverse_x, near_x, side - near_x, grid.inverse_x, grid.number_x, 1
        )  # fmt: skip
        if not box.planar:
            side = box.length_y
            _look_along(
                y, vy, c, dt, 0.0, side, box.inverse_y, near_y, side - near_y, grid.inverse_y, grid.number_y,
                grid.number_x,
            )  # fmt: skip
        _look_along(
            z, vz, c, dt, fall, box.length_z, box.inverse_z, near_z, low_top - near_z,
            layers / top, layers, grid.number_x * grid.number_y,
        )  # fmt: skip
        _go_along(x, vx, c, dt, 0.0, box.length_x, box.inverse_x)
        if not box.planar:
            _go_along(y, vy, c, dt, 0.0, box.length_y, box.inverse_y)
        _go_along(z, vz, c, dt, fall, box.length_z, box.inverse_z)
        if modes.gravity:
            for p in range(vz.size):
                vz[p] -= gain if c[p] >= 0 else 0.0
        for p in range(c.size):
            if c[p] >= 0:
                histogram[np.uint32(c[p])] += np.int32(1)
            else:
                state.hitting[first + many] = begin + p
                many += 1
    return many

"""Checks of a start in time steps: the step must not be too long for the box, and no molecules may overlap."""

import math
import warnings

import numpy as np

from atmosbox.engine.core.parcel import Array
from atmosbox.engine.core.refusal import CoarseStepWarning, RefusedError

__all__ = ["judge_overlap", "judge_step"]

_COARSE = 0.1
_CAREFUL = 0.1
_OVERLAP = 1e-9


def judge_step(step: float, speed: Array, room: Array, radius: float) -> None:
    """Refuse a time step that is impossible, and warn of one that is coarse.

    Parameters
    ----------
    step
        Length of the step [time].
    speed : (axis,)
        Speed of the fastest molecule along each axis [length/time].
    room
        How far a centre can move along each axis [length].
    radius
        Radius of the smallest molecule [length]; 0 if molecules have no size.

    Raises
    ------
    RefusedError
        If a molecule would cross the box in one step.

    Warns
    -----
    CoarseStepWarning
        If a molecule crosses more than a tenth of a radius in one step.

    Examples
    --------
    >>> judge_step(0.01, np.ones(3), np.full(3, 8.0), 0.5)
    """
    fastest = float(speed.max())
    moving = speed > 0.0
    fine = _COARSE * radius / fastest if fastest > 0.0 and radius > 0.0 else math.inf
    too_far = speed * step > room
    if too_far.any():
        axis = int(np.argmax(too_far))
        least = float(np.min(room[moving] / speed[moving]))
        if least <= 0.0:
            raise RefusedError(
                f"a molecule moves along {'xyz'[axis]} where the box is no longer than itself: make the box longer"
            )
        raise RefusedError(
            f"dt = {step:.4g} is so long that a molecule as fast as {speed[axis]:.4g} would cross the box along "
            f"{'xyz'[axis]} in one step: give dt = {min(fine, _CAREFUL * least):.4g} or less"
        )
    if step > fine:
        warnings.warn(
            f"the step is coarse: delta_max = dt v_max / radius = {step * fastest / radius:.3g}, the part of a radius "
            f"that the fastest molecule crosses in it, is above {_COARSE}, so that collisions come late and some are "
            f"missed: dt = {fine:.4g} would do",
            CoarseStepWarning,
            stacklevel=6,
        )


def judge_overlap(pairs: Array, position: Array, diameter: Array, sides: Array, periodic: tuple[bool, ...]) -> None:
    """Refuse molecules that overlap.

    Parameters
    ----------
    pairs : (pair, 2)
        Pairs of molecules that are near each other.
    position : (axis, molecule)
        Centres [length].
    diameter : (molecule,)
        Diameters [length].
    sides, periodic
        The sides of the box [length], and whether each axis is periodic.

    Raises
    ------
    RefusedError
        If a pair overlaps; the message names the deepest overlap.

    Examples
    --------
    >>> touching = np.array([[1.0, 2.0], [1.0, 1.0], [1.0, 1.0]])
    >>> judge_overlap(np.array([[0, 1]]), touching, np.ones(2), np.full(3, 5.0), (False, False, False))
    """
    if not len(pairs):
        return
    i, j = pairs.min(axis=1), pairs.max(axis=1)
    apart = position[:, i] - position[:, j]
    length = sides[:, None]
    apart -= np.where(np.array(periodic)[:, None], length * np.rint(apart / length), 0.0)
    touching = 0.5 * (diameter[i] + diameter[j])
    gap = np.sqrt(np.sum(apart**2, axis=0))
    depth = np.where(touching > 0.0, 1.0 - gap / np.where(touching > 0.0, touching, 1.0), 0.0)
    worst = int(np.argmax(depth))
    if depth[worst] > _OVERLAP:
        raise RefusedError(
            f"molecules {i[worst]} and {j[worst]} overlap at the start, by {depth[worst]:.3g} of their diameter: "
            "move them apart or make them smaller"
        )

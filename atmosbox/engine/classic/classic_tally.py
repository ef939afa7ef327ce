"""The common part of the three classic schemes: the molecules as plain arrays, their walls, and the tallies."""

from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.walls import HEAT_BATH, resolve_wall_hit

__all__ = ["Discs", "Frame", "Score", "beyond", "meet_wall", "tally_contact", "wrap"]


class Discs(NamedTuple):
    """The molecules, discs or spheres.

    ``position``, ``velocity : (axis, molecule)`` [length, length/time]; ``mass``, ``radius : (molecule,)``
    [mass, length]; ``partner``, ``met : (molecule,)``: partner and step of the last contact of each molecule.
    """

    position: Any
    velocity: Any
    mass: Any
    radius: Any
    partner: Any
    met: Any


class Frame(NamedTuple):
    """The box and its clock.

    ``length : (axis,)`` [length]; ``inverse : (axis,)`` one over the length of a periodic axis, 0 for a walled
    one [1/length]; ``gravity`` [length/time^2]; ``time_step`` [time]; ``planar``: whether nothing moves along y;
    ``contacts``: whether any molecule has a size.
    """

    length: Any
    inverse: Any
    gravity: float
    time_step: float
    planar: bool
    contacts: bool


class Score(NamedTuple):
    """The tallies that only an approximate scheme has.

    ``numerical_heat : (1,)`` [energy]: energy made by the scheme itself. ``count : (3,)``: pairs tested, contacts
    of a pair that had one in the step before, contacts of pairs that were already moving apart.
    """

    numerical_heat: Any
    count: Any


@kernel
def wrap(x, length, inverse):
    """Return a coordinate [length] brought back into a periodic box of that length.

    Examples
    --------
    >>> float(wrap(4.5, 4.0, 0.25))
    0.5
    """
    x -= length * np.floor(x * inverse)
    return x if 0.0 <= x < length else 0.0


@kernel
def beyond(x, radius, length, inverse):
    """Return -1 or 1 if a coordinate [length] lies beyond the lower or upper wall of its axis, else 0.

    Examples
    --------
    >>> beyond(0.4, 0.5, 4.0, 0.0), beyond(0.4, 0.5, 4.0, 0.25)
    (-1, 0)
    """
    if inverse > 0.0:
        return 0
    if x < radius:
        return -1
    return 1 if x > length - radius else 0


@kernel
def _square(velocity):
    """Return the square of a velocity, a tuple."""
    return velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2]


@kernel
def meet_wall(i, axis, side, time, discs, frame, walls, tallies):
    r"""Give a molecule that has come beyond a wall, and moves outward, its velocity by the law of the wall.

    The schemes differ in where they put it then. The molecule gets its velocity at the end of the step and does not fly
    for the rest of it, as in the applets. At a heat bath that makes the gas too hot: each flight
    ends about :math:`\Delta t / 2` late, and the molecules that walls emit carry more energy than the mean one, in
    space :math:`2 kT` instead of :math:`3/2\,kT`.

    Parameters
    ----------
    i, axis, side
        The molecule; the axis, and -1 or 1 for its lower or upper wall.
    time
        Time since the start, at the end of the step [time].
    discs, frame, walls, tallies
        The molecules, the box, its walls, and the tallies.
    """
    v = discs.velocity
    if v[axis, i] * side <= 0.0:
        return
    wall = 2 * axis + (1 if side > 0 else 0)
    mass = discs.mass[i]
    before = (v[0, i], v[1, i], v[2, i])
    after, _, change = resolve_wall_hit(wall, time, before, 0.0, (mass, 0.0), walls, frame.planar, tallies.random)
    v[0, i], v[1, i], v[2, i] = after
    if walls.law[wall] == HEAT_BATH:
        tallies.heat[wall] += 0.5 * mass * (_square(after) - _square(before))
    tallies.impulse[wall] -= mass * side * change
    tallies.hits[wall] += 1
    tallies.count[4] += 1


@kernel
def tally_contact(pair, step, height, virial, parting, discs, tallies, score):
    """Count the contact of a pair of molecules at a height [length], with its virial r . dp [energy].

    Contacts of the same two in successive steps count as repeated, as far as the last partner of each tells.
    """
    i, j = pair
    layer = min(max(int(height * tallies.layer_scale), 0), tallies.virial.size - 1)
    tallies.virial[layer] += virial
    tallies.count[0] += 1
    if discs.partner[i] == j and discs.partner[j] == i and discs.met[i] == step - 1 and discs.met[j] == step - 1:
        score.count[1] += 1
    if parting:
        score.count[2] += 1
    discs.partner[i] = j
    discs.partner[j] = i
    discs.met[i] = step
    discs.met[j] = step

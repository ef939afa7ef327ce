"""Pairs of molecules: their range, the time at which they meet, and the change of velocity when they do.

Everything that needs the law of a pair calls this file: the exact engine and the time-stepped one, drops, and the
checks for overlap. The law itself is in a file of its own, `hard_sphere`. To add another law that acts at one distance,
write a second such file and a branch on a mode in `reach`, `approach`, `predict` and `resolve`; nothing else of the
engine changes. The law of the square well, `square_well`, acts at two distances and remembers which pairs are between
them: it has a loop of its own, in `wells`.
"""

import math

import numpy as np

from atmosbox.engine.core.hard_sphere import earlier_root, quadratic, resolve_contact
from atmosbox.engine.core.jit import kernel


@kernel
def extent(radius):
    """Return how far from its centre a molecule acts on others [length]: its contribution to `reach`."""
    return radius


@kernel
def reach(radius, other_radius):
    """Return the distance of two centres at which the pair begins to interact [length]: the sum of both extents.

    >>> reach(0.5, 0.7)
    1.2
    """
    return extent(radius) + extent(other_radius)


@kernel
def nearest_along(r, length, inverse):
    """Return a distance along one axis [length] to the nearest image; ``inverse`` is 1/length, or 0 between walls.

    In a periodic box of length 10, a molecule 9 to the right is 1 to the left:

    >>> float(nearest_along(9.0, 10.0, 0.1)), float(nearest_along(9.0, 10.0, 0.0))
    (-1.0, 9.0)
    """
    return r - length * np.rint(r * inverse)


@kernel
def nearest_image(rx, ry, rz, box, modes):
    """Return the position of a molecule relative to the nearest periodic image of another [length]."""
    if modes.periodic:
        rx = nearest_along(rx, box.length_x, box.inverse_x)
        ry = nearest_along(ry, box.length_y, box.inverse_y)
        # floor and ceiling are walls where there is gravity or a piston
        if not (modes.gravity or modes.piston):
            rz = nearest_along(rz, box.length_z, box.inverse_z)
    return rx, ry, rz


@kernel
def soonest_image(rx, ry, rz, ux, uy, uz, distance, box):
    """Return how long it takes a molecule to meet another or one of its periodic images [time], ``inf`` for never.

    Along each periodic axis two images are within a box length: the nearest one, whose relative position is given, and
    the one on the other side. Here the nearest image is one above, and is missed; the one below is three away:

    >>> from atmosbox.engine.core.state import Box
    >>> box = Box(4.0, 4.0, 4.0, 0.25, 0.25, 0.25, gravity=0.0, planar=False, exchange=1.0, stall=1.0)
    >>> soonest_image(0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 1.0, box)
    1.0
    """
    soonest = math.inf
    for a in range(2 if box.inverse_x > 0.0 else 1):
        x = rx - a * math.copysign(box.length_x, rx) if a > 0 else rx
        for b in range(2 if box.inverse_y > 0.0 else 1):
            y = ry - b * math.copysign(box.length_y, ry) if b > 0 else ry
            for c in range(2 if box.inverse_z > 0.0 else 1):
                z = rz - c * math.copysign(box.length_z, rz) if c > 0 else rz
                discriminant, slope, gap = approach(x, y, z, ux, uy, uz, distance)
                if discriminant > 0.0 and slope < 0.0:
                    soonest = min(soonest, predict(discriminant, slope, gap))
    return soonest


@kernel(early=True)
def approach(rx, ry, rz, ux, uy, uz, distance):
    """Return how a pair approaches: a discriminant, not above zero if the pair misses, and two numbers for `predict`.

    Most pairs miss, so the time of meeting is computed in two steps, of which the second is rarely needed. The first of
    the two numbers is below zero while the pair approaches. Three diameters apart, closing at unit speed:

    >>> predict(*approach(3.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0))
    2.0
    """
    return quadratic(rx, ry, rz, ux, uy, uz, distance * distance)


@kernel(early=True)
def predict(discriminant, b, c):
    """Return the time until a pair meets [time from now] from what `approach` returned; for a pair that meets."""
    return earlier_root(discriminant, b, c)


@kernel
def resolve(rx, ry, rz, ux, uy, uz, mass, other_mass):
    """Return the change of velocity of the first molecule when the pair meets [length/time]: see `resolve_contact`."""
    return resolve_contact(rx, ry, rz, ux, uy, uz, mass, other_mass)

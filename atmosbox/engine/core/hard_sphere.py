r"""The law of hard spheres: when two of them touch, and their velocities after the collision.

Gravity accelerates both molecules alike, so their relative motion is a straight line with or without it.
"""

import math

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import gamma


@kernel(early=True)
def quadratic(rx, ry, rz, vx, vy, vz, diameter_squared):
    r"""Return discriminant, b and c of the equation :math:`v^2 t^2 + 2 b t + c = 0` for the contact of two molecules.

    With the position r [length] and the velocity v [length/time] of one molecule relative to the other they touch when
    :math:`|r + v t|^2 = \sigma^2`, where :math:`\sigma` is the sum of their radii. So :math:`b = r \cdot v`, which is
    below zero while they approach, and :math:`c = r^2 - \sigma^2`. The discriminant is computed with min(b, 0) instead
    of b. For a pair that moves apart it is then not above zero either, unless the two overlap. So one test rejects
    nearly all pairs that do not meet.
    """
    b = rx * vx + ry * vy + rz * vz
    speed_squared = vx * vx + vy * vy + vz * vz
    c = rx * rx + ry * ry + rz * rz - diameter_squared
    closing = min(b, 0.0)
    return closing * closing - speed_squared * c, b, c


@kernel(early=True)
def earlier_root(discriminant, b, c):
    """Return the time until two molecules touch: the earlier root of `quadratic` [time from now], 0 if it is past.

    Call it only if the discriminant d is above zero and b below zero: otherwise the two never touch. The usual formula,
    (-b - sqrt(d)) / v^2, subtracts nearly equal numbers when the two nearly touch, and loses digits; c / (-b + sqrt(d))
    is the same root without a difference. A pair that overlaps by rounding touches at once if it approaches, and never
    if it moves apart (Bannerman et al. 2014, doi:10.1007/s40571-014-0021-8).

    They are three diameters apart and approach at a speed of one, so they fly the gap of two in a time of two:

    >>> earlier_root(*quadratic(3.0, 0.0, 0.0, -1.0, 0.0, 0.0, 1.0))
    2.0
    """
    return max(c / (math.sqrt(discriminant) - b), 0.0)


@kernel
def resolve_contact(rx, ry, rz, vx, vy, vz, mass, other_mass):
    r"""Return the change of velocity [length/time] that an elastic contact gives a molecule.

    With position r and velocity v relative to its partner the impulse acts along the line of centres,
    :math:`\Delta v_i = -\frac{2 m_j}{m_i + m_j} \frac{(v \cdot r)}{|r|^2} r`; the partner's change is -m_i / m_j times
    this. The distance at contact equals sigma only up to rounding. Dividing by the actual \|r\|^2 instead of sigma^2
    conserves the energy to the last digits nevertheless.

    A head-on contact of molecules of equal mass swaps their velocities:

    >>> resolve_contact(1.0, 0.0, 0.0, -2.0, 0.0, 0.0, 1.0, 1.0)[0]
    2.0
    """
    b = rx * vx + ry * vy + rz * vz
    # the change of velocity is f times the vector between the centres
    f = -(2.0 * other_mass / (mass + other_mass)) * b / (rx * rx + ry * ry + rz * rz)
    return f * rx, f * ry, f * rz


@kernel
def share_energy(energy, dimensions, rotation, other_rotation, state):
    r"""Share the energy of a contact between relative motion and the two rotations; return the three shares [energy].

    They are in the ratio of three random numbers with gamma distributions, of shapes :math:`(d + 1)/2` for the relative
    motion in d dimensions and :math:`\zeta_i/2`, :math:`\zeta_j/2` for the rotations, with :math:`\zeta` rotational
    degrees of freedom (Borgnakke, C., Larsen, P. S. 1975, doi:10.1016/0021-9991(75)90094-7). In three dimensions the
    first shape is 2. For the kinetic energy of a molecule it would be 3/2; but hard spheres collide at a rate
    proportional to their relative speed, so fast pairs collide more often. With this shape collisions do not change the
    distribution of energy in equilibrium.

    >>> import numpy as np
    >>> round(sum(share_energy(3.0, 3.0, 2.0, 2.0, np.array([1], np.uint64))), 12)
    3.0
    """
    a = gamma(dimensions + 1.0, state)  # gamma takes twice the shape: the number of degrees of freedom
    b = gamma(rotation, state)
    c = gamma(other_rotation, state)
    scale = energy / (a + b + c)
    return a * scale, b * scale, c * scale

r"""The law of the square well: hard spheres that attract each other while they are near.

Two molecules are inside each other's well while their centres are closer than :math:`\lambda \sigma`; there their
potential energy is :math:`-\varepsilon`, farther away it is zero, and nearer than :math:`\sigma` they cannot come. So a
pair changes its motion at two distances only, and flies straight in between (gravity accelerates both alike). With the
relative velocity :math:`u_n` along the line of centres and the reduced mass :math:`\mu`:

========  =====================================================  ==========================================
core      at sigma, approaching                                  :math:`u_n' = -u_n`
capture   at lambda sigma, outside, approaching                  :math:`u_n' = -\sqrt{u_n^2 + 2\varepsilon/\mu}`
release   at lambda sigma, inside, parting, fast enough          :math:`u_n' = \sqrt{u_n^2 - 2\varepsilon/\mu}`
bounce    at lambda sigma, inside, parting, too slow for that    :math:`u_n' = -u_n`
========  =====================================================  ==========================================

Whether a pair is inside is remembered and never deduced from its distance. At the edge a distance cannot tell: a pair
that approaches there is about to be captured, or has just been.

References
----------
Alder, B. J., Wainwright, T. E. (1959), doi:10.1063/1.1730376 (the method, for this potential too).
"""

import math
from typing import NamedTuple

from atmosbox.engine.core.jit import kernel

__all__ = ["BOUNCE", "CAPTURE", "CORE", "RELEASE", "Well", "resolve_crossing", "time_to_crossing"]

CORE, CAPTURE, RELEASE, BOUNCE = range(4)
"""What happens to a pair; a release that is too slow becomes a bounce when it is resolved."""


class Well(NamedTuple):
    """The law of a pair: squares of sigma and of lambda sigma [length^2], equal for hard spheres; depth [energy]."""

    core: float
    edge: float
    depth: float


@kernel
def time_to_crossing(rx, ry, rz, ux, uy, uz, well, inside, within):
    r"""Return how long it takes a pair to reach its core, or the edge of its well, if that comes soon.

    Parameters
    ----------
    rx, ry, rz, ux, uy, uz
        Position [length] and velocity [length/time] of one relative to the other.
    well
        The law of the pair, a `Well`.
    inside
        Whether it is inside the well now.
    within
        Until when it is asked for [time from now]; what comes later may count as never.

    Returns
    -------
    (float, int)
        Time from now [time], ``inf`` for never; and which: `CORE`, `CAPTURE` or `RELEASE`.

    Notes
    -----
    Most pairs do nothing so soon, and one test without a root or a division tells so: where would the pair be then?
    Both roots are written so that nothing cancels. A pair that rounding has put on the wrong side of the core or edge
    acts at once, and one whose path would lie outside the edge altogether turns back where it is nearest: none is lost.

    Examples
    --------
    From a distance of 3 at unit speed to the edge at 1.5, from there to the core; from the core outwards to the edge:

    >>> well = Well(core=1.0, edge=2.25, depth=1.0)
    >>> time_to_crossing(3.0, 0.0, 0.0, -1.0, 0.0, 0.0, well, False, 9.0)
    (1.5, 1)
    >>> time_to_crossing(1.5, 0.0, 0.0, -1.0, 0.0, 0.0, well, True, 9.0)
    (0.5, 0)
    >>> time_to_crossing(1.0, 0.0, 0.0, 1.0, 0.0, 0.0, well, True, 9.0)
    (0.5, 2)
    """
    b = rx * ux + ry * uy + rz * uz
    speed_squared = ux * ux + uy * uy + uz * uz
    distance_squared = rx * rx + ry * ry + rz * rz
    past_edge = distance_squared - well.edge
    gap = distance_squared - well.core if inside else past_edge
    discriminant = b * b - speed_squared * gap
    # what the square of the distance will have grown by, and whether the pair will part by then
    turn = speed_squared * within + b
    grown = within * (turn + b)
    meets = (discriminant > 0.0) & (b < 0.0) & ((turn > 0.0) | (grown + gap < 0.0))
    leaves = inside & (grown + past_edge >= 0.0)
    after = math.inf
    which = RELEASE
    if meets | leaves:
        if meets:
            after = max(gap / (math.sqrt(discriminant) - b), 0.0)
            which = CORE if inside or well.edge == well.core else CAPTURE
        elif speed_squared > 0.0:
            root = math.sqrt(max(b * b - speed_squared * past_edge, 0.0))
            after = -past_edge / (b + root) if b > 0.0 else (root - b) / speed_squared
            after = max(after, 0.0)
    return after, which


@kernel
def resolve_crossing(r, u, which, mass, other_mass, depth):
    r"""Return the change of velocity of the first molecule of a pair at its core or edge, and what has happened.

    Parameters
    ----------
    r, u : (axis,)
        Its position [length] and velocity [length/time] relative to its partner, tuples.
    which
        `CORE`, `CAPTURE` or `RELEASE`.
    mass, other_mass, depth
        Its mass and the partner's [mass]; depth of the well [energy].

    Returns
    -------
    (tuple, int)
        Change of its velocity [length/time], of which the partner gets -mass / other_mass; and which of the four.

    Notes
    -----
    u_n is taken with the actual distance, which is sigma or lambda sigma to rounding only: that keeps the energy.

    Examples
    --------
    Two of unit mass that meet with a relative velocity of 2 are captured and go on with sqrt(8); one that leaves with
    1.9 bounces back:

    >>> resolve_crossing((1.5, 0.0, 0.0), (-2.0, 0.0, 0.0), CAPTURE, 1.0, 1.0, 1.0)[0][0] * 2.0 - 2.0 == -math.sqrt(8.0)
    True
    >>> change, what = resolve_crossing((1.5, 0.0, 0.0), (1.9, 0.0, 0.0), RELEASE, 1.0, 1.0, 1.0)
    >>> round(1.9 + 2.0 * change[0], 12), what == BOUNCE
    (-1.9, True)
    """
    b = r[0] * u[0] + r[1] * u[1] + r[2] * u[2]
    distance_squared = r[0] * r[0] + r[1] * r[1] + r[2] * r[2]
    normal_squared = b * b / distance_squared
    gained = 2.0 * depth * ((mass + other_mass) / (mass * other_mass))
    what = which
    if which == CORE:
        after = max(-b, b) / distance_squared
    elif which == CAPTURE:
        after = -math.sqrt((normal_squared + gained) / distance_squared)
    elif normal_squared > gained:
        after = math.sqrt((normal_squared - gained) / distance_squared)
    else:
        what = BOUNCE
        after = -max(-b, b) / distance_squared
    share = (after - b / distance_squared) * (other_mass / (mass + other_mass))
    return (share * r[0], share * r[1], share * r[2]), what

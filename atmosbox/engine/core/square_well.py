r"""The law of the square well: hard spheres that attract each other at short distances.

Two molecules are inside each other's well while their centres are closer than :math:`\lambda \sigma`; there their
potential energy is :math:`-\varepsilon`; farther away it is zero, and they cannot come nearer than :math:`\sigma`. So
the velocities of a pair change at two distances only, and its relative motion is straight in between (gravity
accelerates both alike). With the relative velocity :math:`u_n` along the line of centres and the reduced mass
:math:`\mu`:

========  =====================================================  ==========================================
core      at sigma, approaching                                  :math:`u_n' = -u_n`
capture   at lambda sigma, outside, approaching                  :math:`u_n' = -\sqrt{u_n^2 + 2\varepsilon/\mu}`
release   at lambda sigma, inside, parting, fast enough          :math:`u_n' = \sqrt{u_n^2 - 2\varepsilon/\mu}`
bounce    at lambda sigma, inside, parting, too slow for that    :math:`u_n' = -u_n`
========  =====================================================  ==========================================

Whether a pair is inside is stored and never computed from its distance. At the edge the distance cannot tell: a pair
that approaches there is about to be captured, or has just been.

References
----------
Alder, B. J., Wainwright, T. E. (1959), doi:10.1063/1.1730376 (the method, for this potential too).
"""

import math
from collections import namedtuple

from atmosbox.engine.core.jit import kernel

CORE, CAPTURE, RELEASE, BOUNCE = range(4)
"""The four events of a pair; a release that is too slow becomes a bounce when it is resolved."""


class Well(namedtuple("Well", "core edge depth")):
    """The law of a pair: squares of sigma and of lambda sigma [length^2], equal for hard spheres; depth [energy]."""


@kernel
def time_to_crossing(r, u, well, inside, within):
    """Return how long it takes a pair to reach its core or the edge of its well, and the event.

    The event is `CORE`, `CAPTURE` or `RELEASE`. The time is ``inf`` for never, and may be for an event later than
    ``within`` [time from now]. Most pairs reach neither so soon. One test without a root or a division rejects them: it
    computes the distance that the pair would have then. Both roots are written without cancellation. A pair that
    rounding has put on the wrong side of the core or edge has its event at once. A pair inside whose path would lie
    outside the edge altogether, by rounding, has its event where the two are nearest. So no event is lost.

    From a distance of 3 at unit speed to the edge at 1.5; from there to the core; from the core outwards to the edge:

    >>> well = Well(core=1.0, edge=2.25, depth=1.0)
    >>> time_to_crossing((3.0, 0.0, 0.0), (-1.0, 0.0, 0.0), well, False, 9.0)
    (1.5, 1)
    >>> time_to_crossing((1.5, 0.0, 0.0), (-1.0, 0.0, 0.0), well, True, 9.0)
    (0.5, 0)
    >>> time_to_crossing((1.0, 0.0, 0.0), (1.0, 0.0, 0.0), well, True, 9.0)
    (0.5, 2)
    """
    rx, ry, rz = r
    ux, uy, uz = u
    b = rx * ux + ry * uy + rz * uz
    speed_squared = ux * ux + uy * uy + uz * uz
    distance_squared = rx * rx + ry * ry + rz * rz
    past_edge = distance_squared - well.edge
    gap = distance_squared - well.core if inside else past_edge
    discriminant = b * b - speed_squared * gap
    # by how much the square of the distance will have grown, and whether the pair will move apart by then
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
    """Return the change of velocity of the first molecule of a pair at the core or edge, and the event.

    The event is one of the four in the table above. The change of its partner is -mass / other_mass times this. u_n is
    computed with the actual distance, equal to sigma or lambda sigma to rounding only: this conserves energy.

    Two molecules of unit mass that meet with a relative velocity of 2 are captured and go on with sqrt(8); a pair that
    moves apart with 1.9 bounces back:

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

r"""Free flight: straight lines, and the exact parabola of gravity.

Between encounters a molecule moves as :math:`x + v t` along the floor and :math:`z + v_z t - g t^2 / 2`
along the vertical. The time at which it reaches a plane is the root of a linear or a quadratic equation, written so
that no digits are lost by cancellation.
"""

import math

from atmosbox.engine.core.jit import kernel


@kernel
def time_to_leave(x, v, low, high):
    """Return when a molecule in uniform motion leaves an interval [time from now], and at which end: 1 for the upper.

    The lower end is 0. The time is ``inf`` if it stands still.

    One length below the upper end at half a length per time:

    >>> time_to_leave(2.0, 0.5, 0.0, 3.0)
    (2.0, 1)
    """
    up = v > 0.0
    gap = (high if up else low) - x
    t = gap / v if v != 0.0 else math.inf
    return max(t, 0.0), (1 if up else 0)


@kernel
def time_to_leave_in_gravity(z, v, low, high, gravity):
    r"""Return when a molecule in free fall leaves a layer [time from now], and at which end: 1 for the upper.

    It reaches the upper end if :math:`v^2 > 2 g h`, at :math:`t = 2 h / (v + \sqrt{v^2 - 2 g h})`; else it falls out of
    the lower end (0), at the later root of the same parabola. Both roots are sums of numbers of the same sign, so that
    no digits are lost by cancellation.

    Thrown upward at unit speed in unit gravity from the floor it is back after two units of time:

    >>> time_to_leave_in_gravity(0.0, 1.0, 0.0, 9.0, 1.0)
    (2.0, 0)
    """
    gap = high - z
    square = v * v - 2.0 * gravity * gap
    if v > 0.0 and square >= 0.0:
        t = 2.0 * gap / (v + math.sqrt(square))
        up = 1
    else:
        up = 0
        gap = z - low
        root = math.sqrt(max(v * v + 2.0 * gravity * gap, 0.0))
        t = (v + root) / gravity if v >= 0.0 else 2.0 * gap / (root - v)
    return max(t, 0.0), up


@kernel
def time_to_ceiling(gap, closing_speed, gravity):
    """Return when a molecule meets a ceiling that moves at constant speed [time from now], ``inf`` for never.

    ``gap`` is the height of the ceiling above the top of the molecule, ``closing_speed`` the upward velocity of the
    molecule minus that of the ceiling.

    >>> time_to_ceiling(1.0, 0.5, 0.0)
    2.0
    >>> time_to_ceiling(1.0, 1.0, 1.0)
    inf
    """
    if closing_speed <= 0.0:
        return math.inf
    square = closing_speed * closing_speed - 2.0 * gravity * gap
    if square < 0.0:
        return math.inf
    return max(2.0 * gap / (closing_speed + math.sqrt(square)), 0.0)

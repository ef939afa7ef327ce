r"""A glance at eight members of a row at once: who of them can be met at all.

Most pairs in a cell miss each other, and to find that out is most of the work of a search. The processor takes eight
single-precision numbers in one or two instructions, so the rows of cells hold copies of trajectories in single
precision (`rows`), and `glance` tells which of eight may be met before a given time. It may name one that is not met.
It never leaves out one that is, and that is all that it decides: whom it names, double precision judges.

**Why none is left out.** Take a pair that shares the cell from now until it meets, after :math:`\tau \le T`, at the
distance :math:`\sigma`. Let u = 2^-24 be the rounding of single precision, W the farthest that a member of the row can
be from the centre of its cell along an axis, V a bound of the speed of all copies, and H the length of their epoch,
with

.. math:: V H \le 64\,W, \qquad g H \le V / 2 .

Copies count from the start of the epoch, in the frame that falls with gravity. So along an axis a copy is x(0) + v s
with :math:`0 \le s \le H`, where :math:`|v s| \le 64\,W` and :math:`|x(0)| \le W + VH/4 + VH \le 81\,W`; the middle
term is the fall.

1. *Position.* The distance r of the pair along an axis is v s + (x(0) - x'). Roundings of x(0), of v, of s, of the
   difference, of x' and of the sum amount to u (81 + 64 + 64 + 98 + 17 + 2) W = 326 u W along z, and to 262 u W along x
   and y, where nothing falls: together 494 u W. Where the processor does not fuse product and sum it is 604 u W.
2. *Velocity.* Its roundings, u \|v\| twice and u \|v - v'\|, count for as long as it takes to meet. In that time no
   molecule of the row moves further than 2 W along x and y. Along z in the falling frame it moves
   2 W + g tau^2 / 2 + g s tau; nothing stays in a layer of 2 W for longer than g tau^2 = 16 W, so that is 33 W. All
   this is less than 134 u W.
3. Hence there is a moment until T at which the pair *as it is seen* is no further apart than sigma + e, with
   :math:`e = 1024\,u W = 2^{-14} W`, which is more than (604 + 134) u W.
4. *Rounding of the test itself.* With :math:`|r|^2 \le 12\,W^2`, the roundings of r.r, r.v, v.v and of the products are
   worth less than 32 u \|r\|^2 in the square of the distance; the test takes :math:`(\sigma + e)^2 + m` with
   :math:`m = 2^{-14} W^2 = 1024\,u W^2`.
5. *Approach.* r.v < 0 for the pair; as it is seen it may be larger by 2 V (e + 26 u W) < :math:`2^{-12} V W`.

So it does not matter that some processors fuse product and sum and others do not, which nothing else in the engine may
ask for: they may name other pairs, and double precision, the same everywhere, finds the same soonest contact in them.

Nothing of this asks how large sigma is: a law of longer reach has the same slack. W grows with the cells, and with it
the number of those that are named in vain, as if sigma were longer by W / 16384 and its square by the square of
W / 128: in a cell some W wide that is always a small share.

The velocity of a molecule faster than V is no number (NaN), be it a copy or one that looks; every comparison with it
holds. So no molecule outruns the bound, whatever heats it: it is judged in double precision alone until the next epoch.
Products too small for single precision are smaller than `TINY`, which is granted to all.
"""

from typing import Any

import numpy as np

from atmosbox.engine.core.jit import COMPILED, Kernel

__all__ = ["CLOSING", "DISTANCE", "LANES", "PATH", "SLACK", "SPEEDS", "SQUARE", "TINY", "glance"]

LANES = 8
"""How many members are looked at together: as many as AVX2 has in a register; elsewhere two or four take their part."""
PATH = 64.0
"""How far the fastest copy flies in an epoch, in widths W: VH / W above."""
SLACK = 2.0**-14
"""e / W and m / W^2 above."""
DISTANCE, SQUARE, CLOSING = range(3)
"""What the slack of a layer is: e [length], m [length^2], and the bound of r.v [length^2/time]."""
SPEEDS = 1e9
"""No copy is of a molecule faster than this [length/time]: the squares of products must not overflow."""
TINY = 1e-30
"""A square product [length^4/time^2] far above the smallest of single precision: see the head of this file."""


def glance(values, first, mixed, place, velocity, since, slack, within):
    """Tell which of eight copies may be met: see the head of this file.

    Parameters
    ----------
    values : (word,)
        The rows, read as float32.
    first
        Where the eight begin: x, y, z, vx, vy, vz and, if ``mixed``, their extents, eight each.
    mixed
        Whether molecules differ in size.
    place, velocity : (axis,)
        Of the molecule that looks, relative to the centre of the cell; tuples of float32 [length, length/time].
    since
        Time since the start of the epoch, float32 [time].
    slack
        Reach of the molecule that looks (of the pair, unless ``mixed``) with the slack e [length], the slack m
        [length^2], and the largest r.v of a pair that approaches; a tuple of float32.
    within
        Until when to look, float32 [time from now].

    Returns
    -------
    int64
        Bit k is set if the copy ``first + k`` may be met.
    """
    lanes = values[int(first) : int(first) + 7 * LANES].reshape(7, LANES) if mixed else None
    if lanes is None:
        lanes = values[int(first) : int(first) + 6 * LANES].reshape(6, LANES)
    r = lanes[:3] - np.array(place)[:, None] + lanes[3:6] * since
    v = lanes[3:6] - np.array(velocity)[:, None]
    reach = slack[0] + (lanes[6] if mixed else np.float32(0.0))
    a, b, c = (v * v).sum(axis=0), (r * v).sum(axis=0), (r * r).sum(axis=0) - (reach * reach + slack[1])
    near = ~(a * c > b * b + np.float32(TINY))
    turn = a * within + b
    soon = ~(turn <= 0.0) | ~(within * (b + turn) + c >= 0.0)
    found = near & ~(b >= slack[2]) & soon
    return sum(1 << lane for lane in np.flatnonzero(found).tolist())


if COMPILED:

    def _lanes() -> Any:
        from atmosbox.engine.exact import lanes

        return lanes.glance_of(LANES, TINY)

    glance = Kernel(glance, _lanes)

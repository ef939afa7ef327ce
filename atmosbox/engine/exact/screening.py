r"""A quick test of eight members of a row at once: which of them may be met at all.

Most pairs in a cell miss each other, and to find that out is most of the work of a search. The processor takes eight
single-precision numbers in one or two instructions, so the rows of cells hold copies of trajectories in single
precision (`rows`), and `screen` tells which of eight may be met before a given time. It may name one that is not met,
but it never leaves out one that is. The exact test of those that it names is made in double precision.

**Why none is left out.** Take a pair that shares the cell from now until it meets, after :math:`\tau \le T`, at the
distance :math:`\sigma`. Let u = 2^-24 be the rounding of single precision, W the largest distance along an axis between
a member of the row and the centre of its cell, V a bound of the speed of all copies, and H the length of their epoch,
with

.. math:: V H \le 64\,W, \qquad g H \le V / 2 .

Copies count time from the start of the epoch, in the frame that falls with gravity. So along an axis a copy is
x(0) + v s with :math:`0 \le s \le H`, where :math:`|v s| \le 64\,W` and
:math:`|x(0)| \le W + VH/4 + VH \le 81\,W`; the middle term is the fall.

1. *Position.* The distance r of the pair along an axis is v s + (x(0) - x'). Roundings of x(0), of v, of s, of the
   difference, of x' and of the sum amount to u (81 + 64 + 64 + 98 + 17 + 2) W = 326 u W along z, and to 262 u W along x
   and y, where nothing falls: together 494 u W. Where the processor does not fuse product and sum it is 604 u W.
2. *Velocity.* Its roundings, u \|v\| twice and u \|v - v'\|, act during the time until the pair meets. In that time no
   molecule of the row moves further than 2 W along x and y. Along z in the falling frame it moves
   2 W + g tau^2 / 2 + g s tau; no molecule stays in a layer of 2 W for longer than g tau^2 = 16 W, so that is 33 W. All
   this is less than 134 u W.
3. Hence there is a moment until T at which the pair *as the copies give it* is no further apart than sigma + e, with
   :math:`e = 1024\,u W = 2^{-14} W`, which is more than (604 + 134) u W.
4. *Rounding of the test itself.* With :math:`|r|^2 \le 12\,W^2`, the roundings of r.r, r.v, v.v and of the products
   change the square of the distance by less than 32 u \|r\|^2; the test takes :math:`(\sigma + e)^2 + m` with
   :math:`m = 2^{-14} W^2 = 1024\,u W^2`.
5. *Approach.* r.v < 0 for the pair; from the copies it may come out larger by 2 V (e + 26 u W) < :math:`2^{-12} V W`.

So this is the one place in the engine where it does not matter that some processors fuse product and sum and others do
not. They may name other pairs, and double precision, the same everywhere, finds the same soonest contact among them.

None of this depends on how large sigma is: a law of longer range has the same slack. W grows with the cells, and with
it the number of molecules that are named in vain, as if sigma were longer by W / 16384 and its square by the square of
W / 128: in a cell some W wide that is always a small share.

The velocity of a molecule faster than V is stored as NaN, for a copy and for the molecule that searches; every
comparison with NaN counts as true. So no molecule is missed because it exceeds the bound, whatever heats it: it is
tested in double precision alone until the next epoch. Products too small for single precision are smaller than `TINY`,
which is added as a tolerance for all.
"""

from typing import Any

import numpy as np

from atmosbox.engine.core.jit import COMPILED, Kernel

__all__ = ["BATCH", "CLOSING", "DISTANCE", "PATH", "SLACK", "SPEEDS", "SQUARE", "TINY", "screen"]

BATCH = 8
"""Number of members tested together: an AVX2 register holds as many; elsewhere they are taken by twos or fours."""
PATH = 64.0
"""Longest flight of a copy in an epoch, in widths W: VH / W above."""
SLACK = 2.0**-14
"""e / W and m / W^2 above."""
DISTANCE, SQUARE, CLOSING = range(3)
"""The three numbers in the slack of a layer: e [length], m [length^2], and the bound of r.v [length^2/time]."""
SPEEDS = 1e9
"""Largest speed of a copy [length/time], so that the squares of products do not overflow."""
TINY = 1e-30
"""A squared product [length^4/time^2] far above the smallest number of single precision: see the module's docstring."""


def screen(values, first, mixed, place, velocity, since, slack, within):
    """Return which of eight copies may be met; the module's docstring has the proof.

    Parameters
    ----------
    values : (word,)
        The rows, read as float32.
    first
        Index of the first of them: x, y, z, vx, vy, vz and, if ``mixed``, their extents, eight numbers each.
    mixed
        Whether molecules differ in size.
    place, velocity : (axis,)
        Of the molecule that searches, relative to the centre of the cell; tuples of float32 [length, length/time].
    since
        Time since the start of the epoch, float32 [time].
    slack
        Reach of the molecule that searches (of the pair, unless ``mixed``) plus the slack e [length], the slack m
        [length^2], and the largest r.v of a pair that approaches; a tuple of float32.
    within
        How far ahead to look, float32 [time from now].

    Returns
    -------
    int64
        Bit k is set if the copy ``first + k`` may be met.
    """
    copies = values[int(first) : int(first) + 7 * BATCH].reshape(7, BATCH) if mixed else None
    if copies is None:
        copies = values[int(first) : int(first) + 6 * BATCH].reshape(6, BATCH)
    r = copies[:3] - np.array(place)[:, None] + copies[3:6] * since
    v = copies[3:6] - np.array(velocity)[:, None]
    reach = slack[0] + (copies[6] if mixed else np.float32(0.0))
    a, b, c = (v * v).sum(axis=0), (r * v).sum(axis=0), (r * r).sum(axis=0) - (reach * reach + slack[1])
    near = ~(a * c > b * b + np.float32(TINY))
    turn = a * within + b
    soon = ~(turn <= 0.0) | ~(within * (b + turn) + c >= 0.0)
    found = near & ~(b >= slack[2]) & soon
    return sum(1 << k for k in np.flatnonzero(found).tolist())


if COMPILED:

    def _vectors() -> Any:
        from atmosbox.engine.core import compiler

        return compiler.screen_of(BATCH, TINY)

    screen = Kernel(screen, _vectors)

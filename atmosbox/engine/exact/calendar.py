"""The next event of all: a tournament tree of the molecules' next events.

Leaves hold one time per molecule, in groups of eight (a cache line). Above them is a binary
tournament whose nodes hold the winning (earliest) time *and* its molecule. So the next event is read at the root,
and a change needs one comparison per level. There is nothing to tune. All times stand in one array::

    free | root | 2 nodes | 4 nodes | ... | times of molecules 0 to 7 | of 8 to 15 | ...
"""

import numpy as np

from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.core.state import Calendar


def new_calendar(molecules: int) -> Calendar:
    """Return an empty calendar, in which no molecule has an event."""
    # -(-n // 8): n / 8, rounded up
    groups = -(-max(molecules, 1) // 8)
    depth = max(1, (groups - 1).bit_length())
    leaf = -(-(2 ** (depth + 1)) // 8) * 8
    size = leaf + 8 * groups
    buffer = np.full(size + 8, np.inf)
    start = -(buffer.ctypes.data // 8) % 8
    return Calendar(buffer[start : start + size], np.zeros(max(8, 2 ** (depth + 1)), np.uint32), leaf, 2**depth, depth)


@kernel
def schedule(calendar, i, time):
    """Set the time of molecule i's next event [time] and update the tournament up to the root."""
    times = calendar.time
    leaf = calendar.leaf & POSITIVE
    times[leaf + i] = time
    group = (i >> 3) << 3
    o = leaf + group
    a0, a1, a2, a3 = times[o], times[o + 1], times[o + 2], times[o + 3]
    a4, a5, a6, a7 = times[o + 4], times[o + 5], times[o + 6], times[o + 7]
    # the earliest (m) of the eight leaves of its group, and which one it is (w)
    w0 = 1 if a1 < a0 else 0
    m0 = min(a0, a1)
    w1 = 3 if a3 < a2 else 2
    m1 = min(a2, a3)
    w2 = 5 if a5 < a4 else 4
    m2 = min(a4, a5)
    w3 = 7 if a7 < a6 else 6
    m3 = min(a6, a7)
    w0 = w1 if m1 < m0 else w0
    m0 = min(m0, m1)
    w2 = w3 if m3 < m2 else w2
    m2 = min(m2, m3)
    w0 = w2 if m2 < m0 else w0
    best = min(m0, m2)
    winner = group + w0
    # the node of the group, then each node above it
    node = (calendar.node + (i >> 3)) & POSITIVE
    times[node] = best
    calendar.winner[node] = winner
    for _ in range(calendar.depth):
        rival = node ^ 1
        rival_time = times[rival]
        rival_winner = np.int64(calendar.winner[rival])
        winner = rival_winner if rival_time < best else winner
        best = rival_time if rival_time < best else best
        node >>= 1
        times[node] = best
        calendar.winner[node] = winner


@kernel
def next_event(calendar):
    """Return the molecule whose event comes next, and its time [time]; ``inf`` if there is none."""
    return np.int64(calendar.winner[1]), calendar.time[1]

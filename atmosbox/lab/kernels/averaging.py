"""The average of many frames and its standard error by blocks, as kernels; and profiles by height.

The frames are gathered into blocks of equal length; when there is no room for another block, neighbouring blocks are
merged in pairs. So there are always 20 to 40 blocks once there have been 20, and the memory does not grow however long
the page is open. The standard error of the average is computed from the scatter of the blocks.
"""

import math
from collections import namedtuple

from atmosbox.engine.core.jit import kernel

BLOCKS = 40
"""Largest number of blocks; half as many are left after a merger."""
FEWEST = 4
"""Smallest number of blocks for a standard error."""
HELD, FRAMES, LENGTH = range(3)
ALL = BLOCKS + 1


class Average(namedtuple("Average", "blocks state mean error")):
    """The blocks of some quantities.

    ``blocks : (BLOCKS + 2, number)`` are sums over the frames of each full block, then of the block that is being
    filled; the last row is the sum of all frames. ``state : (4,)`` is the number of full blocks, the number of
    frames in the block that is being filled, the number of frames in a full block, and that number at the start.
    ``mean, error : (number of averages,)`` are the average and its standard error, NaN while there are too few blocks.
    """


@kernel
def _gather(values, average):
    """Add the values of a frame to the blocks."""
    state, blocks = average.state, average.blocks
    for k in range(values.size):
        blocks[state[HELD], k] = values[k] + (blocks[state[HELD], k] if state[FRAMES] > 0 else 0.0)
        blocks[ALL, k] += values[k]
    state[FRAMES] += 1
    if state[FRAMES] == state[LENGTH] and state[HELD] < BLOCKS:
        state[HELD] += 1
        state[FRAMES] = 0
    elif state[FRAMES] == state[LENGTH]:  # no row is left
        for k in range(values.size):
            for block in range(BLOCKS // 2):
                blocks[block, k] = blocks[2 * block, k] + blocks[2 * block + 1, k]
            blocks[BLOCKS // 2, k] = blocks[BLOCKS, k]
        state[HELD] = BLOCKS // 2
        state[LENGTH] *= 2


@kernel
def _quantity(k, sums, frames, layers, box):
    """Return average ``k`` from the sums over some frames: as it is summed, or in layers, see `instruments.Layers`.

    In ``layers`` these are first the number densities, then kT, pressures and winds.
    """
    if layers == 0:
        return sums[k] / frames
    which, layer = k // layers, k % layers
    if which == 3:
        return sums[4 * layers + layer] / frames
    number, energy, freedom = sums[layer], sums[layers + layer], sums[2 * layers + layer]
    share = frames * box.length_x * box.length_z * (1.0 if box.planar else box.length_y) / layers
    if which == 0:
        return number / share
    kT = 2.0 * energy / freedom if freedom > 0.0 else math.nan
    return kT if which == 1 else (number * kT + sums[3 * layers + layer] / (2.0 if box.planar else 3.0)) / share


@kernel
def update(values, average, layers, box):
    """Add the values of a frame, and update the averages and their standard errors."""
    _gather(values, average)
    blocks, held, length = average.blocks, average.state[HELD], average.state[LENGTH]
    frames = held * length + average.state[FRAMES]
    for k in range(average.mean.size):
        average.mean[k] = _quantity(k, blocks[ALL], frames, layers, box)
        if held < FEWEST:
            continue
        mean = squares = 0.0
        for block in range(held):
            # running mean and sum of squares by Welford's method
            each = _quantity(k, blocks[block], length, layers, box)
            step = each - mean
            mean += step / (block + 1)
            squares += step * (each - mean)
        average.error[k] = math.sqrt(squares / (held - 1.0) / held)


@kernel
def begin_averages_anew(speeds, layers):
    """Begin the averages of many frames again."""
    for average in (speeds, layers):
        average.state[HELD] = average.state[FRAMES] = 0
        average.state[LENGTH] = average.state[3]
        average.blocks[:] = 0.0
        average.mean[:] = math.nan
        average.error[:] = math.nan
    return 0

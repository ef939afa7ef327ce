"""The average of many frames, and its standard error by blocks, as kernels.

The frames are gathered into blocks of equal length; when there is no room for another block, neighbouring blocks are
merged in pairs. So there are always 20 to 40 blocks once there have been 20, and the memory does not grow however long
the page is open. The standard error of the average is computed from the scatter of the blocks.
"""

import math
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel

__all__ = ["BLOCKS", "FEWEST", "FRAMES", "HELD", "LENGTH", "Average", "average", "forget", "gather"]

BLOCKS = 40
"""Largest number of blocks; half as many are left after a merger."""
FEWEST = 4
"""Smallest number of blocks for a standard error."""
HELD, FRAMES, LENGTH = range(3)


class Average(NamedTuple):
    """The blocks of some quantities.

    ``blocks : (BLOCKS + 1, number)`` are sums over the frames of each block; the last row is the block that is
    being filled. ``state : (4,)`` is the number of full blocks, the number of frames in the block that is being filled,
    the number of frames in a full block, and that number at the start. ``mean, error : (number,)`` are the average and
    its standard error, NaN while there are too few blocks.
    """

    blocks: Any
    state: Any
    mean: Any
    error: Any


@kernel
def forget(average):
    """Forget all frames."""
    average.state[HELD] = 0
    average.state[FRAMES] = 0
    average.state[LENGTH] = average.state[3]
    average.blocks[:] = 0.0
    average.mean[:] = math.nan
    average.error[:] = math.nan


@kernel
def gather(values, average):
    """Add the values of a frame to the blocks."""
    state, blocks = average.state, average.blocks
    for k in range(values.size):
        blocks[BLOCKS, k] += values[k]
    state[FRAMES] += 1
    if state[FRAMES] < state[LENGTH]:
        return
    if state[HELD] == BLOCKS:
        for block in range(BLOCKS // 2):
            for k in range(values.size):
                blocks[block, k] = blocks[2 * block, k] + blocks[2 * block + 1, k]
        state[HELD] = BLOCKS // 2
        state[LENGTH] *= 2
        return
    for k in range(values.size):
        blocks[state[HELD], k] = blocks[BLOCKS, k]
        blocks[BLOCKS, k] = 0.0
    state[HELD] += 1
    state[FRAMES] = 0


@kernel
def average(values, average):
    """Add the values of a frame, and update mean and standard error."""
    gather(values, average)
    state, blocks = average.state, average.blocks
    held, length = state[HELD], state[LENGTH]
    for k in range(values.size):
        total = blocks[BLOCKS, k]
        for block in range(held):
            total += blocks[block, k]
        average.mean[k] = total / (held * length + state[FRAMES])
        if held < FEWEST:
            continue
        mean = 0.0
        for block in range(held):
            mean += blocks[block, k] / length
        mean /= held
        squares = 0.0
        for block in range(held):
            squares += (blocks[block, k] / length - mean) ** 2
        average.error[k] = math.sqrt(squares / (held - 1.0) / held)

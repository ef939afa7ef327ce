"""The average of many frames and its standard error by blocks, as kernels; and profiles by height.

The frames are gathered into blocks of equal length; when there is no room for another block, neighbouring blocks are
merged in pairs. So there are always 20 to 40 blocks once there have been 20, and the memory does not grow however long
the page is open. The standard error of the average is computed from the scatter of the blocks.
"""

import math
from typing import Any, NamedTuple

from atmosbox.engine.core.jit import kernel

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


@kernel
def _quantity(which, number, energy, freedom, rate, wind, volume, planes):
    """Return number density, kT, pressure or wind (0 to 3) of a layer: see `instruments.Layers` and `Flow`."""
    if which == 3:
        return wind
    if which == 0:
        return number / volume
    kT = 2.0 * energy / freedom if freedom > 0.0 else math.nan
    return kT if which == 1 else (number * kT + rate / planes) / volume


@kernel
def end_profile(gas, gauges, profile):
    """Add the layers of the frame that has ended, and update the profiles and their standard errors.

    ``profile.mean`` holds first the densities of the layers, then their kT, pressures and winds.
    """
    layers = gauges.sums.shape[1]
    if layers == 0:
        return
    gather(gauges.layers, profile)
    blocks, state, box = profile.blocks, profile.state, gas.box
    held, length = state[HELD], state[LENGTH]
    frames = held * length + state[FRAMES]
    volume = box.length_x * box.length_z * (1.0 if box.planar else box.length_y) / layers
    planes = 2.0 if box.planar else 3.0
    for layer in range(layers):
        number = energy = freedom = rate = wind = 0.0
        for block in range(BLOCKS + 1):
            if block < held or block == BLOCKS:
                number += blocks[block, layer]
                energy += blocks[block, layers + layer]
                freedom += blocks[block, 2 * layers + layer]
                rate += blocks[block, 3 * layers + layer]
                wind += blocks[block, 4 * layers + layer]
        for which in range(4):
            mean = squares = 0.0
            for block in range(held):
                each = _quantity(
                    which,
                    blocks[block, layer] / length,
                    blocks[block, layers + layer] / length,
                    blocks[block, 2 * layers + layer] / length,
                    blocks[block, 3 * layers + layer] / length,
                    blocks[block, 4 * layers + layer] / length,
                    volume,
                    planes,
                )
                # running mean and sum of squares by Welford's method
                step = each - mean
                mean += step / (block + 1)
                squares += step * (each - mean)
            profile.mean[which * layers + layer] = _quantity(
                which, number / frames, energy / frames, freedom / frames, rate / frames, wind / frames, volume, planes
            )
            profile.error[which * layers + layer] = (
                math.sqrt(squares / (held - 1.0) / held) if held >= FEWEST else math.nan
            )

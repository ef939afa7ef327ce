"""Density, temperature, pressure and wind by height, averaged over many frames."""

import math

from atmosbox.engine.core.jit import kernel
from atmosbox.lab.kernels.averaging import BLOCKS, FEWEST, FRAMES, HELD, LENGTH, gather

__all__ = ["end_profile"]


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

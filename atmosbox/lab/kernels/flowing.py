"""Wind and rolls of air that turns over, and the adiabat: see `instruments.Flow`."""

import math
from collections import namedtuple

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.lab.kernels.readings import Reading
from atmosbox.lab.kernels.sums import Sum

_FRESH = 0.2
"""Share by which the newest frame counts in the wind that is drawn."""


class Flow(namedtuple("Flow", "sums frames high wave column wind lapse dense adiabat")):
    """The data of the wind in the parts of the layers; all arrays are empty in a scene that does not show it.

    ``sums : (3, part)`` are number and velocities along x and z of the molecules of each part in this frame, and
    ``frames : (1,)`` is the number of frames. ``high : (layer,)`` and ``wave : (wave, column)`` are the shapes of
    rolls; ``column : (2, column)`` is scratch.

    ``wind : (2, part)`` is the wind along x and
    z of the last frames [velocity], of which the newest counts most. ``lapse : (density,)`` is how fast air cools that
    rises, over gravity [mass], at the densities from 0 to ``dense``, and ``adiabat : (layer,)`` the temperature of such
    air through the middle of the height [energy].
    """


def can_flow(modes: Modes) -> bool:
    """Return whether the kernels of a set of modes measure the wind: those of one gas in a box at rest."""
    return not (modes.rotation or modes.mixed or modes.piston or modes.phases)


@kernel
def begin_wind(flow):
    """Begin to measure."""
    flow.sums[:] = 0.0
    flow.frames[0] = 0.0
    flow.wind[:] = 0.0


@kernel
def sample_wind(gas, gauges):
    """Add the wind of a sample, whose sums over the parts of the layers are known: see `instruments.Flow`."""
    flow, columns, mass = gauges.flow, gauges.flow.wave.shape[1], gas.kinds.table[0].mass
    if columns == 0:
        return
    molecules = gauges.whole.sums[0, Sum.NUMBER]
    wind = rolls = 0.0
    flow.column[:] = 0.0
    for part in range(flow.high.size * columns):
        sums = gauges.parts.sums[part]
        number, along, up = sums[Sum.NUMBER], sums[Sum.X] / mass, sums[Sum.Z] / mass
        flow.sums[0, part] += number
        flow.sums[1, part] += along
        flow.sums[2, part] += up
        if number > 1.0:
            wind += (along * along + up * up - 2.0 * sums[Sum.KINETIC] / mass) / (number - 1.0)
        size = 2.0 * flow.high[part // columns] / molecules
        flow.column[0, part % columns] += size * up
        flow.column[1, part % columns] += size * size * sums[Sum.UPRIGHT]
    for k in range(flow.wave.shape[0]):
        amplitude = alone = 0.0
        for column in range(columns):
            amplitude += flow.wave[k, column] * flow.column[0, column]
            alone += flow.wave[k, column] ** 2 * flow.column[1, column]
        rolls += amplitude * amplitude - alone
    gauges.means[Reading.WIND_SPEED] += wind / molecules
    gauges.means[Reading.ROLL_SPEED] += rolls


@kernel
def end_wind(gauges):
    """Finish the wind of a frame, and read its speed, that of rolls, and the wind in the middle half of each layer."""
    flow, sums, reading = gauges.flow, gauges.flow.sums, gauges.reading
    if flow.high.size == 0:
        return
    for speed in (Reading.WIND_SPEED, Reading.ROLL_SPEED):  # their squares, negative where noise has made them so
        reading[speed] = math.copysign(math.sqrt(abs(reading[speed])), reading[speed])
    flow.frames[0] += 1.0
    fresh = max(_FRESH, 1.0 / flow.frames[0])
    columns, layers = flow.wave.shape[1], flow.high.size
    first, last = columns // 4, max(columns - columns // 4, columns // 4 + 1)
    for part in range(layers * columns):
        if sums[0, part] > 0.0:
            for axis in range(2):
                flow.wind[axis, part] += fresh * (sums[1 + axis, part] / sums[0, part] - flow.wind[axis, part])
    for layer in range(layers):
        mean = 0.0
        for part in range(layer * columns + first, layer * columns + last):
            mean += sums[1, part] / sums[0, part] if sums[0, part] > 0.0 else math.nan
        gauges.layers[4 * layers + layer] = mean / (last - first)
    sums[:] = 0.0


@kernel
def _cooling(density, flow):
    """Return how fast air of a density cools that rises, over gravity [mass], from the table."""
    last = flow.lapse.size - 1
    place = min(max(density / flow.dense, 0.0), 1.0) * last
    low = min(int(place), last - 1)
    return flow.lapse[low] + (place - low) * (flow.lapse[low + 1] - flow.lapse[low])


@kernel
def write_adiabat(box, mean, flow):
    """Write the temperature of air that has risen or sunk from the middle: `mean` holds densities, then kT of layers.

    It is NaN as long as a layer has no density.
    """
    layers = flow.adiabat.size
    if layers == 0:
        return
    thick = box.length_z / layers
    for layer in range(layers):
        flow.adiabat[layer] = 0.0
        if layer > 0:
            step = 0.5 * (_cooling(mean[layer], flow) + _cooling(mean[layer - 1], flow))
            flow.adiabat[layer] = flow.adiabat[layer - 1] - box.gravity * step * thick
    low, high = (layers - 1) // 2, layers // 2
    off = 0.5 * (mean[layers + low] + mean[layers + high] - flow.adiabat[low] - flow.adiabat[high])
    for layer in range(layers):
        flow.adiabat[layer] += off

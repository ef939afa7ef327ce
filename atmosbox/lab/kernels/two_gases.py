"""Two gases that mix: the measurements of `atmosbox.scene.instruments.Mixing`, as kernels."""

import math
from collections import namedtuple

from atmosbox.engine.core.elementary import log
from atmosbox.engine.core.jit import kernel
from atmosbox.lab.kernels.readings import Reading
from atmosbox.lab.kernels.sums import Sum
from atmosbox.scene.instruments.mixing import PRIOR


class Mixture(namedtuple("Mixture", "moments frame off expected scatter mean error")):
    """The data of two gases that mix; all arrays are empty in a scene without such gases.

    ``moments : (moment,)`` are the times to measure at [time], ``off : (moment,)`` the distance of the nearest end of a
    frame, at most half a ``frame`` [time]. ``expected, scatter : (moment * bin,)`` are the share of the left gas by
    theory, and its variance over that of independent draws; ``mean, error : (moment * bin,)`` the measured share and
    its standard error. ``Gauges.sides`` are the bins of the left and then of the right gas.
    """


@kernel
def _entropy(left, right):
    """Return the part of the entropy of mixing from a bin with these numbers of molecules: see `entropy_of_counts`."""
    both, kinds, found = left + right, 0.0, 0.0
    for part in (left, right):
        if part > 0.0:
            found -= part * log(part / both)
            kinds += 1.0
    return found + 0.5 * (kinds - 1.0) if both > 0.0 else 0.0


@kernel
def end_mixing(time, gauges):
    """Read the slowest mode, the entropy of mixing (1 if fully mixed), and the shares of the left gas."""
    mixture, sides = gauges.mixture, gauges.sides.sums
    bins, number = gauges.sides.columns, gauges.whole.sums[0, Sum.NUMBER]
    amplitude = entropy = 0.0
    for b in range(bins):
        amplitude += sides[b, Sum.COSINE] - sides[bins + b, Sum.COSINE]
        entropy += _entropy(sides[b, Sum.NUMBER], sides[bins + b, Sum.NUMBER])
    gauges.reading[Reading.MIXING_AMPLITUDE] = 0.5 * math.pi * amplitude / number
    gauges.reading[Reading.MIXING_ENTROPY] = entropy / number / log(2.0)
    for m in range(mixture.moments.size):
        off = abs(time - mixture.moments[m])
        if off < mixture.off[m] and off <= 0.5 * mixture.frame:
            mixture.off[m] = off
            for b in range(bins):
                left, place = sides[b, Sum.NUMBER], m * bins + b
                both = left + sides[bins + b, Sum.NUMBER]
                # as in `Mixing`: two more molecules, distributed as theory expects
                guess = (left + PRIOR * mixture.expected[place]) / (both + PRIOR)
                counted = max(both, 1.0) * (1.0 - both / ((both + PRIOR) * (both + PRIOR)))
                mixture.mean[place] = left / both if both > 0.0 else math.nan
                mixture.error[place] = math.sqrt(mixture.scatter[place] * guess * (1.0 - guess) / counted)

"""Two gases that mix: the measurements of `atmosbox.scene.instruments.Mixing`, as kernels."""

import functools
import math
from collections.abc import Callable
from typing import Any, NamedTuple

from atmosbox.engine.core.elementary import circle, log
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.encounter import motion_at
from atmosbox.scene.instruments.mixing import PRIOR


class Mixture(NamedTuple):
    """The data of two gases that mix; all arrays are empty in a scene without such gases.

    ``right : (molecule,)`` is 1 for molecules that were on the right at the start, else 0. ``low`` and ``width`` are
    the lower end and the length of the range of the centres along x [length]. ``moments : (moment,)`` are the times to
    measure at [time], ``off : (moment,)`` the distance of the nearest end of a frame, at most half a ``frame`` [time].
    ``expected, scatter : (moment * bin,)`` are the share of the left gas by theory, and its variance over that of
    independent draws; ``mean, error : (moment * bin,)`` the measured share and its standard error. ``counts : (2,
    bin)`` are the molecules of both gases at the end of the last frame.
    """

    right: Any
    low: float
    width: float
    moments: Any
    frame: float
    off: Any
    expected: Any
    scatter: Any
    mean: Any
    error: Any
    counts: Any


@functools.cache
def mixing(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``begin`` and ``end_frame`` of one set of modes."""

    @kernel
    def begin(mixture):
        """Forget the measured shares."""
        mixture.off[:] = math.inf
        mixture.mean[:] = math.nan
        mixture.error[:] = math.nan

    @kernel
    def entropy(counts):
        """Return the entropy of mixing per molecule, in units of k: see `entropy_of_counts`."""
        total = found = 0.0
        for b in range(counts.shape[1]):
            both = counts[0, b] + counts[1, b]
            if both > 0.0:
                kinds = term = 0.0
                for gas in range(2):
                    part = counts[gas, b] / both
                    if part > 0.0:
                        term -= part * log(part)
                        kinds += 1.0
                found += both * (term + 0.5 * (kinds - 1.0) / both)
                total += both
        return found / total

    @kernel
    def end_frame(gas, now, time, mixture):
        """Count both gases across the box; return the slowest mode, and the entropy of mixing (1 if fully mixed)."""
        counts, bins = mixture.counts, mixture.counts.shape[1]
        counts[:] = 0.0
        amplitude = 0.0
        for i in range(gas.molecules.size):
            across = (motion_at(i, now, gas, modes).x - mixture.low) / mixture.width
            # by rounding, a molecule that touches a wall may be a little beyond the range
            inside = min(max(across, 0.0), 1.0)
            cosine, _ = circle(0.5 * inside)
            amplitude += -cosine if mixture.right[i] else cosine
            counts[mixture.right[i], min(int(inside * bins), bins - 1)] += 1.0
        for m in range(mixture.moments.size):
            off = abs(time - mixture.moments[m])
            if off < mixture.off[m] and off <= 0.5 * mixture.frame:
                mixture.off[m] = off
                for b in range(bins):
                    both = counts[0, b] + counts[1, b]
                    place = m * bins + b
                    # as in `Mixing`: two more molecules, distributed as theory expects
                    guess = (counts[0, b] + PRIOR * mixture.expected[place]) / (both + PRIOR)
                    counted = max(both, 1.0) * (1.0 - both / ((both + PRIOR) * (both + PRIOR)))
                    mixture.mean[place] = counts[0, b] / both if both > 0.0 else math.nan
                    mixture.error[place] = math.sqrt(mixture.scatter[place] * guess * (1.0 - guess) / counted)
        return 0.5 * math.pi * amplitude / gas.molecules.size, entropy(counts) / log(2.0)

    return begin, end_frame

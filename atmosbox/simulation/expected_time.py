"""Expected time of a run: the time measured where atmosbox was made."""

from __future__ import annotations

import math

import numpy as np

from atmosbox.simulation.accuracy import load
from atmosbox.simulation.preparation import Prepared

_WIDEST = 30.0  # largest ratio of a setting to the nearest one that was measured


def in_words(seconds: float) -> str:
    """Return an expected time in words.

    >>> in_words(312.0), in_words(0.04)
    ('about 5 min, if this computer is as fast as ours', 'less than 1 s, if this computer is as fast as ours')
    """
    size, unit = (1.0, "s") if seconds < 90.0 else (60.0, "min") if seconds < 5400.0 else (3600.0, "h")
    number = seconds / size
    said = f"about {float(f'{number:.{1 if number < 10.0 else 2}g}'):g} {unit}"
    return f"{'less than 1 s' if seconds < 1.0 else said}, if this computer is as fast as ours"


def expected_time(prepared: Prepared) -> float | None:
    """Return the processor time of a run on the computer where atmosbox was made [s]; None if it is not known.

    It is that of the nearest run that was measured, times powers of the ratios of their settings. The powers are those
    nearest to one (twice the size, twice the time) with which the measured runs agree.

    >>> from atmosbox.simulation.preparation import prepare
    >>> short, long = (expected_time(prepare("lifting-dry", {"ascent": ascent})) for ascent in (200.0, 800.0))
    >>> 3.0 < long / short < 5.0
    True
    """
    table = load().get(prepared.scene)
    if table is None or "seconds" not in table.how:
        return None
    settings, defaults = prepared.settings.as_dict(), type(prepared.settings)().as_dict()
    told = {name for way in table.ways for name in way.settings} | {"molecules"}
    words = {name for name in told if isinstance(defaults.get(name), bool | str)}
    sizes = sorted(name for name in told - words if isinstance(settings.get(name), int | float))
    cost, far = [], []
    for way in table.ways:
        whole = {**defaults, **way.settings}
        if way.engine == str(prepared.engine) and all(settings[name] == whole[name] for name in words):
            cost.append(math.log(way.cost))
            far.append([_log_ratio(float(whole[name]), float(settings[name])) for name in sizes])
    there = np.isfinite(np.array(far).reshape(len(cost), len(sizes))).all(axis=1)
    if not there.any():
        return None
    ratios, costs = np.array(far)[there], np.array(cost)[there]
    nearest = np.abs(ratios).sum(axis=1).argmin()
    if np.abs(ratios[nearest]).max(initial=0.0) > math.log(_WIDEST):
        return None
    steps = ratios - ratios[nearest]
    power = 1.0 + np.linalg.lstsq(steps, costs - costs[nearest] - steps.sum(axis=1))[0]
    return float(table.how["seconds"]) * math.exp(costs[nearest] - ratios[nearest] @ power)


def _log_ratio(one: float, other: float) -> float:
    """Return the logarithm of the ratio of two sizes, infinite if only one of them is above zero."""
    return 0.0 if one == other else math.log(one / other) if one > 0.0 < other else math.inf

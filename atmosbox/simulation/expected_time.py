"""Expected time of a run on this computer: the time measured where atmosbox was made, times the pace of this one."""

from __future__ import annotations

import math
import statistics
from typing import NamedTuple

import numpy as np

from atmosbox.simulation.accuracy import load
from atmosbox.simulation.compilation import remember, remembered
from atmosbox.simulation.preparation import Prepared

_ENOUGH = 0.2  # seconds of the engine's processor time; shorter runs do not tell the pace of a computer
_KEPT = 9
_WIDEST = 30.0  # largest ratio of a setting to the nearest one that was measured
_FILE = "pace.json"


class ExpectedTime(NamedTuple):
    """Expected time that the engine needs for a run.

    Attributes
    ----------
    seconds
        Processor time [s].
    here
        Whether the pace of this computer is known; if not, it is that of the computer where the table was measured.
    """

    seconds: float
    here: bool

    def __str__(self) -> str:
        """Return it in words.

        Examples
        --------
        >>> str(ExpectedTime(312.0, True)), str(ExpectedTime(0.04, False))
        ('about 5 min', 'less than 1 s, if this computer is as fast as ours')
        """
        size, unit = (1.0, "s") if self.seconds < 90.0 else (60.0, "min") if self.seconds < 5400.0 else (3600.0, "h")
        number = self.seconds / size
        said = f"about {float(f'{number:.{1 if number < 10.0 else 2}g}'):g} {unit}"
        if self.seconds < 1.0:
            said = "less than 1 s"
        return said if self.here else f"{said}, if this computer is as fast as ours"


def expected_time(prepared: Prepared) -> ExpectedTime | None:
    """Return the expected time of a run; None if no similar run was measured.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> short, long = (expected_time(prepare("lifting-dry", {"ascent": ascent})) for ascent in (200.0, 800.0))
    >>> 3.0 < long.seconds / short.seconds < 5.0
    True
    """
    seconds = _measured_seconds(prepared)
    if seconds is None:
        return None
    paces = _paces()
    return ExpectedTime(seconds * (statistics.median(paces) if paces else 1.0), bool(paces))


def remember_pace(prepared: Prepared, seconds: float) -> None:
    """Store how long the engine took for a run [s], which improves the next expected time."""
    expected = _measured_seconds(prepared)
    if expected is not None and seconds > _ENOUGH:
        remember(_FILE, [*_paces(), round(seconds / expected, 3)][-_KEPT:])


def _paces() -> list[float]:
    """Return the ratios of measured to expected time of the last runs on this computer."""
    held = remembered(_FILE)
    good = isinstance(held, list) and all(isinstance(each, int | float) and 0.0 < each < 1e6 for each in held)
    return [float(each) for each in held] if good else []


def _measured_seconds(prepared: Prepared) -> float | None:
    """Return the time of a run on the computer where the table was measured [s]; None if it is not known.

    It is that of the nearest run that was measured, times powers of the ratios of their settings. The powers are those
    nearest to one (twice the size, twice the time) with which the measured runs agree.
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

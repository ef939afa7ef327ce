"""Expected time of a run on this computer: the time measured where atmosbox was made, times the pace of this one."""

from __future__ import annotations

import contextlib
import json
import math
import os
import statistics
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from atmosbox.simulation.accuracy.measured import load
from atmosbox.simulation.compilation import cache_home
from atmosbox.simulation.preparation import Prepared

__all__ = ["ExpectedTime", "expected_time", "remember_pace"]

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

    Parameters
    ----------
    prepared
        From `atmosbox.simulation.preparation.prepare`.

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
    paces = _paces(cache_home())
    return ExpectedTime(seconds * statistics.median(paces), True) if paces else ExpectedTime(seconds, False)


def remember_pace(prepared: Prepared, seconds: float) -> None:
    """Store how long the engine took for a run [s], which improves the next expected time.

    An error in writing is ignored, because nothing depends on this file.
    """
    expected = _measured_seconds(prepared)
    home = cache_home() if expected is not None and seconds > _ENOUGH else None
    if home is None or expected is None:
        return
    new = home / f"pace.{os.getpid()}"
    with contextlib.suppress(OSError):
        new.write_text(json.dumps([*_paces(home), round(seconds / expected, 3)][-_KEPT:]), encoding="ascii")
        new.replace(home / _FILE)


def _paces(home: Path | None) -> list[float]:
    """Return the ratios of measured to expected time of the last runs on this computer."""
    try:
        held = json.loads((home / _FILE).read_text(encoding="ascii")) if home else []
    except (OSError, ValueError):
        return []
    good = isinstance(held, list) and all(isinstance(each, int | float) and 0.0 < each < 1e6 for each in held)
    return [float(each) for each in held] if good else []


def _measured_seconds(prepared: Prepared) -> float | None:
    """Return the time of a run on the computer where the table was measured [s]; None if it is not known."""
    table = load().get(prepared.scene)
    if table is None or "seconds" not in table.how:
        return None
    settings, defaults = prepared.settings.as_dict(), type(prepared.settings)().as_dict()
    told = {name for way in table.ways for name in way.settings} | {"molecules"}
    words = {name for name in told if isinstance(defaults.get(name), bool | str)}
    sizes = sorted(name for name in told - words if isinstance(settings.get(name), int | float))
    alike = [
        way
        for way in table.ways
        if way.engine == str(prepared.engine)
        and all(settings[name] == way.settings.get(name, defaults[name]) for name in words)
    ]
    if not alike:
        return None
    places = [{name: float(way.settings.get(name, defaults[name])) for name in sizes} for way in alike]
    here = {name: float(settings[name]) for name in sizes}
    nearest = min(range(len(alike)), key=lambda k: sum(_ratio(here[n], places[k][n]) for n in sizes))
    cost = alike[nearest].cost
    for name in sizes:
        if _ratio(here[name], places[nearest][name]) > math.log(_WIDEST):
            return None
        if here[name] != places[nearest][name]:
            power = _slope(name, here[name], places, [way.cost for way in alike])
            cost *= (here[name] / places[nearest][name]) ** power
    return float(table.how["seconds"]) * cost


def _ratio(one: float, other: float) -> float:
    """Return the distance of two sizes, the absolute logarithm of their ratio."""
    if one == other:
        return 0.0
    return abs(math.log(one / other)) if one > 0.0 < other else math.inf


def _slope(name: str, here: float, places: Sequence[Mapping[str, float]], costs: Sequence[float]) -> float:
    """Return the power of a setting with which the cost grows, from the two runs nearest to its value.

    If no two runs differ in this setting alone, the cost is taken as proportional to it.
    """
    pairs = [
        (_ratio(one[name], here) + _ratio(other[name], here), j, k)
        for j, one in enumerate(places)
        for k, other in enumerate(places[:j])
        if 0.0 < _ratio(one[name], other[name]) < math.inf and all(one[n] == other[n] for n in one if n != name)
    ]
    if not pairs:
        return 1.0
    _, j, k = min(pairs)
    return math.log(costs[j] / costs[k]) / math.log(places[j][name] / places[k][name])

"""The data for the graphs of the page: points to append to a series, and arrays that replace the ones before."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.file.variables import known
from atmosbox.live.trace import Trace, plain
from atmosbox.scene.panels import Panel

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Report", "while_it_runs", "without_headlines"]

TIME = "elapsed_time"
_MOST = 1500


class Report:
    """The data for the graphs of a scene, sent in parts.

    If all series are drawn against time, only their new points are sent. A scene that draws one series against
    another, for example the temperature of a parcel against its pressure, sends all values each time.

    Parameters
    ----------
    panels
        The graphs.
    names
        The variables that the graphs need; "heat_from_wall[z_low]" is a part of one.
    """

    def __init__(self, panels: Iterable[Panel], names: Sequence[str]) -> None:
        self._names = tuple(name for name in names if name != TIME)
        self._lines = [(panel.kind, line) for panel in panels for line in panel.lines]
        self._trace = Trace()
        self._last = -np.inf
        self._arrays: dict[str, Any] | None = None

    def messages(self, found: xr.Dataset) -> list[dict[str, Any]]:
        """Return the messages with the new data of a dataset."""
        whole = self._against_each_other(found)
        series: dict[str, list[float | None]] = {}
        arrays: dict[str, list[float | None]] = {}
        times = found[TIME].values
        fresh = times > self._last
        for name in (*self._names, *(() if whole else _warm_walls(found))):
            values = _part(found, name)
            if values is None:
                continue
            if whole:
                arrays[name] = plain(_thinned(values.values, values.dims == (TIME,)))
            elif values.dims == (TIME,):
                series[name] = plain(values.values[fresh])
            else:
                arrays[name] = plain(values.values)
        made = []
        if whole:
            arrays[TIME] = plain(_thinned(times, True))
        elif fresh.any():
            before = len(self._trace)
            thinned = self._trace.append([float(f"{t:.9g}") for t in times[fresh]], series)
            made.append(self._trace.message(reset=thinned, since=0 if thinned else before))
            self._last = float(times[-1])
        if arrays:
            self._arrays = {"type": "arrays", "values": arrays}
            made.append(self._arrays)
        return made

    def everything(self) -> list[dict[str, Any]]:
        """Return messages with all data so far, for a page that has just connected."""
        arrays = [] if self._arrays is None else [self._arrays]
        return [self._trace.message(reset=True), *arrays]

    def _against_each_other(self, found: xr.Dataset) -> bool:
        """Return whether any curve draws one series against another."""
        for _, line in self._lines:
            ends = [_part(found, name) for name in (line.x, line.y)]
            if line.x != TIME and all(end is not None and end.dims == (TIME,) for end in ends):
                return True
        return False


def _part(found: xr.Dataset, name: str) -> xr.DataArray | None:
    """Return a variable, or the part of it at a label; None if there is none."""
    variable, _, label = name.removesuffix("]").partition("[")
    if variable not in found:
        return None
    values = found[variable]
    if label:
        dim = next((d for d in values.dims if d in found.coords and label in found[d].values), None)
        return None if dim is None else values.sel({dim: label})
    return values if values.dtype.kind in "fiu" else None


def _warm_walls(found: xr.Dataset) -> list[str]:
    """Return the names of the wall temperatures, for walls that have a temperature."""
    if "wall_temperature" not in found:
        return []
    known = np.isfinite(found["wall_temperature"].values).any(axis=0)
    return [f"wall_temperature[{wall}]" for wall, is_known in zip(found["wall"].values, known, strict=True) if is_known]


def _thinned(values: Any, thin: bool) -> Any:
    """Return at most as many values as a graph can show, including the last one."""
    every = -(-len(values) // _MOST) if thin and len(values) else 1
    return values[::-1][::every][::-1] if every > 1 else values


def while_it_runs(panel: Panel) -> Panel | None:
    """Return a panel without what is known only after a whole run, such as headlines; None if nothing is left.

    The time axis is made linear, so that late changes can be seen as well as the start.

    Examples
    --------
    >>> from atmosbox.scene.panels import Line
    >>> warmth = Panel("line", "Warmth", (Line("elapsed_time", "air_temperature", "air"),), x_scale="log")
    >>> while_it_runs(warmth).x_scale
    'linear'
    """
    found = without_headlines(panel)
    evenly = found is not None and found.lines and all(line.x == TIME for line in found.lines)
    return replace(found, x_scale="linear") if found is not None and evenly else found


def without_headlines(panel: Panel) -> Panel | None:
    """Return a panel without curves that come from the headlines of a whole run; None if nothing is left.

    Examples
    --------
    >>> from atmosbox.scene.panels import Line
    >>> base = Line("air_temperature", "cloud_base_of_this_run", "cloud base")
    >>> without_headlines(Panel("profile", "Cloud", (base,))) is None
    True
    """
    if panel.kind == "discs":
        return panel
    lines = tuple(line for line in panel.lines if all(known(name.partition("[")[0]) for name in line.variables))
    return replace(panel, lines=lines, headlines=()) if lines else None

"""The figure of a sweep: how the headlines of a scene depend on the settings that were varied."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from atmosbox.plot.caption import number
from atmosbox.plot.coexistence_figure import draw_coexistence, is_coexistence
from atmosbox.plot.field import draw_fields
from atmosbox.plot.layout import figure as figure_of_panels
from atmosbox.plot.theme import find, style
from atmosbox.plot.unit import convert, of_difference, spelled
from atmosbox.plot.varied import Varied
from atmosbox.scene.panels import Line, Panel, to_json

__all__ = ["MOST_PANELS", "figure", "is_sweep"]

MOST_PANELS = 4
_MOST_CURVES = 3
"""A second setting with at most this many values is drawn as one curve for each value, with more as a field."""
_ALIKE = 1e-3
"""Theory curves that differ by no more than this share of their range are drawn once."""

_WIDE = 100.0
"""Positive numbers whose largest is more than this many times the smallest are shown on a logarithmic axis."""
_LONGEST = 60
"""Greatest length of a label of an axis [characters]."""

Floats = NDArray[np.float64]


def is_sweep(dataset: xr.Dataset) -> bool:
    """Tell whether a file holds a sweep.

    Examples
    --------
    >>> import xarray as xr
    >>> is_sweep(xr.Dataset())
    False
    """
    try:
        return "sweep" in json.loads(dataset.attrs.get("atmosbox_parameters", "{}"))
    except (TypeError, ValueError):
        return False


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the headlines of a sweep against the settings that were varied.

    One setting is on the horizontal axis. A second one gives a curve for each of its values or, if it has more than
    three, the vertical axis of a field, with contours of the theory. Theory is known only at the points of the sweep;
    straight lines join these. Vapour pressures at several temperatures are drawn as ln p against 1/T, each with the
    slope that was measured in the same run.

    Parameters
    ----------
    dataset : xarray.Dataset
        What `atmosbox sweep` writes.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, with a panel for each of the first four headlines; those with a theory come first.

    Raises
    ------
    FileError
        If more than two settings were varied, or no run has measured anything.
    SettingError
        If there is no such theme.

    Examples
    --------
    >>> import xarray as xr
    >>> made = {"dimensions": {"temperature": "temperature"}, "headlines": ["speed"], "members": 4}
    >>> swept = xr.Dataset(
    ...     {"speed": ("temperature", [448.0, 468.0], {"units": "m s-1", "long_name": "mean speed"})},
    ...     {"temperature": ("temperature", [273.15, 298.15], {"units": "K", "display_units": "degC"})},
    ...     {"atmosbox_parameters": json.dumps({"sweep": made})},
    ... )
    >>> axes = figure(swept).axes[0]
    >>> axes.get_xlabel(), axes.get_ylabel()
    ('temperature (°C)', 'mean speed (m s⁻¹)')
    """
    look = find(theme)
    swept = Varied.read(dataset)
    across, other = swept.across, swept.other
    if is_coexistence(swept):
        return draw_coexistence(swept, look)
    if other is not None and swept.dataset.sizes[other] > _MOST_CURVES:
        return draw_fields(swept, swept.names[:MOST_PANELS], look)
    flat, made = _panels(swept)
    drawing = figure_of_panels(flat.assign_attrs(atmosbox_panels=to_json(made)), theme)
    if not swept.numeric(across):
        with style(look):
            for axes in drawing.axes:
                axes.set_xticks(swept.places(across), swept.words(across), minor=False)
                axes.set_xticks([], minor=True)
                axes.set_xlabel(swept.name(across))
    return drawing


def _panels(swept: Varied) -> tuple[xr.Dataset, tuple[Panel, ...]]:
    """Return a sweep as curves along one dimension, and a panel for each of the first four headlines."""
    dataset, across, other = swept.dataset, swept.across, swept.other
    unit = swept.units(across)[0] if swept.numeric(across) else "1"
    places = dataset[across].values if swept.numeric(across) else swept.places(across)
    flat = dataset.drop_vars([*dataset.data_vars, *dataset.coords]).assign_coords(
        {across: (across, places, {"units": unit})}
    )
    parts = [""] if other is None else swept.words(other)
    made = []
    for name in swept.names[:MOST_PANELS]:
        data: list[Line] = []
        theory: list[Line] = []
        for k, word in enumerate(parts):
            here = dataset if other is None else dataset.isel({other: k})
            stem = name if other is None else f"{name}__{k}"
            for suffix in ("", "_se", "_theory"):
                if name + suffix in dataset:
                    variable = here[name + suffix]
                    flat[stem + suffix] = (across, variable.values, dict(variable.attrs))
            runs = "one run" if swept.members == 1 else f"mean of {swept.members} runs"
            label = runs if other is None else f"{swept.name(other)} {word}"
            data.append(Line(across, stem, label, error=f"{stem}_se" if f"{stem}_se" in flat else None))
            if f"{stem}_theory" in flat:
                said = "theory, joined" if other is None else f"theory, {label}"
                theory.append(Line(across, f"{stem}_theory", said, "theory"))
        made.append(_panel(swept, flat, name, (*data, *_different(theory, flat))))
    return flat, tuple(made)


def _different(theory: list[Line], flat: xr.Dataset) -> list[Line]:
    """Return the theory curves; only one if all are the same."""
    if len(theory) < 2:
        return theory
    values = np.array([flat[line.y].values for line in theory])
    known = np.isfinite(values).all(axis=0)
    if known.any() and np.ptp(values[:, known], axis=0).max() > _ALIKE * np.ptp(values[:, known]):
        return theory
    return [replace(theory[0], label="theory, joined")]


def _panel(swept: Varied, flat: xr.Dataset, name: str, lines: tuple[Line, ...]) -> Panel:
    attributes = swept.dataset[name].attrs
    label = str(attributes.get("long_name", name))
    across = swept.across
    return Panel(
        "line",
        label[:1].upper() + label[1:],
        lines,
        x_label=swept.label(across, _LONGEST),
        y_label=label,
        x_unit=swept.units(across)[1] if swept.numeric(across) else "1",
        y_unit=str(attributes.get("display_units", "")),
        x_scale="log" if swept.geometric(across) else "linear",
        y_scale="log" if _spans(np.concatenate([flat[line.y].values for line in lines])) else "linear",
        note=_misfit(swept, name),
    )


def _spans(values: Floats) -> bool:
    """Tell whether all values are positive and span more than a factor of 100."""
    seen = values[np.isfinite(values)]
    return bool(seen.size and seen.min() > 0.0 and seen.max() > _WIDE * seen.min())


def _misfit(swept: Varied, name: str) -> str:
    """Return text with the difference from theory where it is most standard errors; empty without theory or errors."""
    dataset, answer = swept.dataset, swept.theory(name)
    if answer is None or f"{name}_se" not in dataset:
        return ""
    attributes = dataset[name].attrs
    unit = str(attributes.get("units", "1"))
    shown = str(attributes.get("display_units", unit))
    misfit = dataset[name].values - answer
    error = dataset[f"{name}_se"].values
    known = np.isfinite(misfit) & np.isfinite(error) & (error > 0.0)
    if not known.any():
        return ""
    sizes = np.where(known, np.abs(misfit) / np.where(known, error, 1.0), -1.0)
    place = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
    values = [float(convert(each[place], unit, shown, name=name, difference=True)) for each in (misfit, error)]
    where = []
    for dim, k in zip(map(str, dataset[name].dims), place, strict=True):
        word = swept.words(dim)[int(k)]
        where.append(word if swept.numeric(dim) and " " in word else f"{swept.name(dim)} {word}")
    spelling = of_difference(shown)
    units = "" if spelling == "1" else f" {spelled(spelling)}"
    return f"largest difference (at {', '.join(where)}) = {number(*values, signed=True)}{units}"

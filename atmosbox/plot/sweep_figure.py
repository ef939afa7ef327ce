"""The figure of a sweep: how the headlines of a scene depend on the settings that were varied."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from matplotlib.figure import Figure
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.plot.caption import stated
from atmosbox.plot.coexistence_figure import coexistence, is_coexistence
from atmosbox.plot.curve import convert, spelled
from atmosbox.plot.run_figure import figure as figure_of_panels
from atmosbox.plot.theme import DATA_COLOURS, find, style
from atmosbox.scene.panels import Line, Panel, to_json

MOST_PANELS = 4
_MOST_CURVES = len(DATA_COLOURS)
"""Of a second setting with more values, only as many are drawn, at even steps."""
_MOST_NAMED = 3
"""Theory curves of more than this number are not told apart in the legend: each runs through its points."""
_ALIKE = 1e-3
"""Theory curves that differ by no more than this share of their range are drawn once."""
_WIDE = 100.0
"""Positive numbers whose largest is more than this many times the smallest are shown on a logarithmic axis."""
_UNEVEN = 4.0
"""An axis is logarithmic if both ratios exceed this: largest step to smallest step, last value to first value."""
_LONGEST = 60
"""Greatest length of a label of an axis [characters]."""

Floats = NDArray[np.float64]


class _Setting(NamedTuple):
    """A setting that was varied."""

    dim: str
    name: str
    label: str
    numeric: bool
    values: Floats
    """Its values in the unit of the file; words are at 0, 1, 2 and so on."""
    unit: str
    shown: str
    words: list[str]
    """Its values as text with their unit, for a legend."""

    @property
    def geometric(self) -> bool:
        """Whether it needs a logarithmic axis: positive values with very uneven steps over a wide range."""
        if len(self.values) < 3 or not self.values[0] > 0.0:
            return False
        steps = np.diff(self.values)
        return bool(steps.max() > _UNEVEN * steps.min() and self.values[-1] > _UNEVEN * self.values[0])


def _setting(dataset: xr.Dataset, dim: str) -> _Setting:
    """Return a setting that was varied, from its coordinate."""
    found, name = dataset[dim], dim.removesuffix("_setting").replace("_", " ")
    if found.dtype.kind not in "fi":
        words = [str(word) for word in np.char.decode(found.values.astype("S"))]
        return _Setting(dim, name, name, False, np.arange(len(words), dtype=float), "1", "1", words)
    unit = str(found.attrs.get("units", "1"))
    shown = str(found.attrs.get("display_units", "")) or unit
    values = convert(found.values, unit, shown, name=dim)
    words = [f"{value:.6g} {spelled(shown)}".replace("-", "−").rstrip() for value in values]
    label = str(found.attrs.get("long_name", ""))
    label = label if 0 < len(label) <= _LONGEST else name
    return _Setting(dim, name, label, True, found.values.astype(np.float64), unit, shown, words)


def is_sweep(dataset: xr.Dataset) -> bool:
    """Tell whether a file holds a sweep."""
    return "sweep" in stated(dataset, "atmosbox_parameters", dict)


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the first four headlines of a sweep, those with a theory first, against the settings that were varied.

    One setting is on the horizontal axis. A second one gives a curve for each of its values, of at most six values.
    Theory is known only at the points of the sweep; straight lines join these. Vapour pressures at several temperatures
    are drawn as ln p against 1/T, each with the slope that was measured in the same run.
    """
    look = find(theme)
    about = stated(dataset, "atmosbox_parameters", dict)["sweep"]
    dims = [str(name) for name in about["dimensions"].values()]
    if len(dims) > 2:
        raise FileError(
            f"A figure shows at most two settings that vary, and this sweep varies {', '.join(dims)}: "
            "sweep over two of them, or draw parts of the file yourself."
        )
    dataset = dataset.swap_dims({dim: name for dim, name in about["dimensions"].items() if dim != name})
    names = [str(name) for name in about["headlines"] if name in dataset and np.isfinite(dataset[name].values).any()]
    if not names:
        raise FileError("The file has nothing to draw: no run of this sweep has measured anything; see member_reason.")
    names.sort(key=lambda name: not _has_theory(dataset, name))
    # on the horizontal axis: a numeric setting if there is any, and of these the one with the most values
    dims.sort(key=lambda dim: (dataset[dim].dtype.kind in "fi", dataset.sizes[dim]), reverse=True)
    runs = "one run" if about["members"] == 1 else f"mean of {about['members']} runs"
    if dims == ["temperature"] and is_coexistence(dataset, names):
        return figure_of_panels(coexistence(dataset, runs), theme)
    if len(dims) > 1:
        shown = np.linspace(0, dataset.sizes[dims[1]] - 1, min(_MOST_CURVES, dataset.sizes[dims[1]]))
        dataset = dataset.isel({dims[1]: shown.round().astype(int)})
    settings = [_setting(dataset, dim) for dim in dims]
    across = settings[0]
    flat, made = _panels(dataset, names[:MOST_PANELS], settings, runs)
    drawing = figure_of_panels(flat.assign_attrs(atmosbox_panels=to_json(made)), theme)
    if not across.numeric:
        with style(look):
            for axes in drawing.axes:
                axes.set_xticks(across.values, across.words)
                axes.set_xlabel(across.name)
    return drawing


def _has_theory(dataset: xr.Dataset, name: str) -> bool:
    """Tell whether a headline has a theory that is not zero everywhere."""
    return f"{name}_theory" in dataset and bool(np.nan_to_num(dataset[f"{name}_theory"].values).any())


def _panels(
    dataset: xr.Dataset, names: list[str], settings: list[_Setting], runs: str
) -> tuple[xr.Dataset, tuple[Panel, ...]]:
    """Return a sweep as curves along one dimension, and a panel for each headline."""
    across, *others = settings
    coordinate = (across.dim, across.values, {"units": across.unit})
    flat = dataset.drop_vars([*dataset.data_vars, *dataset.coords]).assign_coords({across.dim: coordinate})
    made = []
    for name in names:
        data: list[Line] = []
        theory: list[Line] = []
        for k, word in enumerate(others[0].words if others else [""]):
            here, stem, label = dataset, name, runs
            for other in others:
                here, stem, label = dataset.isel({other.dim: k}), f"{name}__{k}", f"{other.name} {word}"
            for suffix in ("", "_se", "_theory"):
                if name + suffix in dataset:
                    flat[stem + suffix] = here[name + suffix].variable
            data.append(Line(across.dim, stem, label, error=f"{stem}_se" if f"{stem}_se" in flat else None))
            if f"{stem}_theory" in flat:
                said = f"theory, {label}" if others and len(others[0].words) <= _MOST_NAMED else "theory, joined"
                theory.append(Line(across.dim, f"{stem}_theory", said, "theory"))
        lines = (*data, *_different(theory, flat))
        label, unit = (str(dataset[name].attrs.get(key, "")) for key in ("long_name", "display_units"))
        label = label or name
        title = label[:1].upper() + label[1:]
        x_scale, y_scale = ("log" if log else "linear" for log in (across.geometric, _spans(flat, lines)))
        made.append(Panel("line", title, lines, across.label, label, across.shown, unit, x_scale, y_scale))
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


def _spans(flat: xr.Dataset, lines: tuple[Line, ...]) -> bool:
    """Tell whether the numbers of some lines are positive and span a wide range."""
    values = np.concatenate([flat[line.y].values for line in lines])
    seen = values[np.isfinite(values)]
    return bool(seen.size and seen.min() > 0.0 and seen.max() > _WIDE * seen.min())

"""From a line of a panel to the numbers of its curve, in the units that are shown."""

from typing import NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from atmosbox.errors import FileError
from atmosbox.scene.conversion import known_unit, power_of_ten, spelled
from atmosbox.scene.panels import Line, Panel

__all__ = ["convert", "labelled", "of_difference", "power_of_ten", "spelled"]

_AGAIN = "run the scene again with this version of atmosbox"


def convert(
    value: ArrayLike, unit: str, shown: str, *, name: str = "value", difference: bool = False
) -> NDArray[np.float64]:
    """Convert a quantity from the units of the file to those that are shown, which are the same if none are given.

    No offset is added to a difference or an error: a difference of 10 K is one of 10 degC.

    >>> float(convert(273.15, "K", "degC")), float(convert(10.0, "K", "degC", difference=True))
    (0.0, 10.0)
    """
    numbers = np.asarray(value, dtype=np.float64)
    shown = shown or unit
    if shown == unit:
        return numbers
    there, here = known_unit(unit), known_unit(shown)
    if there is None or here is None or there.si != here.si:
        raise FileError(f"The file holds {name} in {unit!r}, which cannot be drawn in {shown!r}: {_AGAIN}.")
    offset = 0.0 if difference else there.offset - here.offset
    return (numbers * (there.up / there.down) + offset) * (here.down / here.up)


def of_difference(unit: str) -> str:
    """Return the unit of a difference of two quantities: the difference of two temperatures in degC is in kelvin."""
    return "K" if unit == "degC" else unit


def labelled(label: str, unit: str, power: int = 0) -> str:
    """Return the label of an axis: the quantity and, unless it is a pure number, its unit in brackets.

    ``power`` is the exponent of the power of ten by which the numbers on the axis must be multiplied.

    >>> labelled("speed", "m s-1"), labelled("molecules", "1"), labelled("molecules", "1", 6)
    ('speed (m/s)', 'molecules', 'molecules (10⁶)')
    """
    return label if unit == "1" and not power else f"{label} ({spelled(unit, power)})"


WORST = 0.2
"""A temperature is not drawn if its standard error is more than this share of it."""


class Curve(NamedTuple):
    """A curve in the units of its panel: x, y, and the error of the measured coordinate, None without errors."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    error: NDArray[np.float64] | None


def read(dataset: xr.Dataset, name: str) -> xr.DataArray:
    """Return a variable of the file, or raise an error that says that the file lacks it.

    "heat_from_wall[z_low]" is the part of ``heat_from_wall`` at the label ``z_low``.
    """
    name, _, label = name.rstrip("]").partition("[")
    if name not in dataset.variables:
        raise FileError(f"The file has no variable {name!r}, which its figure needs: {_AGAIN}.")
    variable = dataset[name]
    if variable.size == 0:
        raise FileError(
            f"The file has no values of {name!r}: the run was stopped before its first frame; run it again."
        )
    if not label:
        return variable
    for dimension in variable.dims:
        if dimension in dataset.coords:
            labels = [str(each) for each in np.char.decode(dataset[dimension].values.astype("S"))]
            if label in labels:
                return variable.isel({dimension: labels.index(label)})
    raise FileError(f"The variable {name!r} of the file has no part {label!r}, which its figure needs: {_AGAIN}.")


def curve(dataset: xr.Dataset, panel: Panel, line: Line) -> Curve:
    """Return a line of a panel as numbers of one length, in the units of the panel.

    A single number beside a list of values is repeated along the list. Values that a logarithmic axis cannot show
    become NaN. If the panel asks for averages, measured values without errors are averaged over equal parts of the x
    axis; their error is then the scatter (standard deviation) of the single values in each part. A measured temperature
    whose error is more than `WORST` of it becomes NaN, such as that of a layer with two molecules.
    """
    measured_is_x = panel.measured_across
    axes = [(line.x, panel.x_unit), (line.y, panel.y_unit)]
    (name, unit), other = axes if measured_is_x else axes[::-1]
    along = series(dataset, *other)
    measured = series(dataset, name, unit)
    error = None if line.error is None else series(dataset, line.error, unit, difference=True)
    try:
        along, measured = np.broadcast_arrays(np.atleast_1d(along), measured)
        if error is not None:
            error = np.broadcast_to(error, measured.shape).copy()
    except ValueError as fault:
        raise FileError(
            f"The variables {', '.join(line.variables)} of the file differ in length and cannot be drawn "
            f"together: {_AGAIN}."
        ) from fault
    if line.error is not None and line.role == "data" and _unit(read(dataset, name)) == "K":
        error_in_file = read(dataset, line.error).values
        unknown = ~(error_in_file <= WORST * read(dataset, name).values)
        measured = np.where(unknown & np.isfinite(error_in_file).any(), np.nan, measured)
    x, y = (measured, along) if measured_is_x else (along, measured)
    if panel.averages and line.role == "data" and error is None:
        x, y, error = _averaged(x, y, panel)
    if panel.y_limits and panel.kind == "profile":  # what lies beyond does not widen the other axis
        x = np.where((y < min(panel.y_limits)) | (y > max(panel.y_limits)), np.nan, x)
    return Curve(_for_scale(x, panel.x_scale), _for_scale(y, panel.y_scale), error)


def edges(dataset: xr.Dataset, panel: Panel, line: Line) -> NDArray[np.float64]:
    """Return the bounds of the bins of a histogram, (bin + 1,); half-way between the centres if the file has none."""
    centre = read(dataset, line.x)
    bounds = dataset.variables.get(str(centre.attrs.get("bounds", f"{line.x}_bnds")))
    if bounds is not None:
        both = convert(bounds.values, _unit(centre), panel.x_unit, name=line.x)
        return np.append(both[:, 0], both[-1, 1])
    middle = convert(centre.values, _unit(centre), panel.x_unit, name=line.x)
    between = (middle[1:] + middle[:-1]) / 2
    return np.concatenate(([2 * middle[0] - between[0]], between, [2 * middle[-1] - between[-1]]))


def unit_of(dataset: xr.Dataset, panel: Panel, axis: str) -> str:
    """Return the unit of the "x" or "y" axis of a panel or, if the panel gives none, that of the file."""
    first = panel.lines[0]
    unit = panel.x_unit if axis == "x" else panel.y_unit
    return unit or _unit(read(dataset, first.x if axis == "x" else first.y))


def series(dataset: xr.Dataset, name: str, shown: str, *, difference: bool = False) -> NDArray[np.float64]:
    """Return a single number or a list of values of the file in the unit that is shown."""
    variable = read(dataset, name)
    if variable.ndim > 1:
        raise FileError(
            f"The variable {name!r} of the file has the dimensions {', '.join(map(str, variable.dims))}, "
            f"and a line has one: {_AGAIN}."
        )
    return convert(variable.values, _unit(variable), shown, name=name, difference=difference)


def _unit(variable: xr.DataArray) -> str:
    return str(variable.attrs.get("units", "1"))


def _averaged(
    x: NDArray[np.float64], y: NDArray[np.float64], panel: Panel
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None]:
    """Return the means of x and y over equal parts of the x axis that contain values, and the scatter of y in each."""
    seen = np.isfinite(x) & np.isfinite(y) & ((x > 0.0) | (panel.x_scale == "linear"))
    x, y = x[seen], y[seen]
    if not x.size or np.ptp(x) == 0.0:
        return x, y, None
    along = np.log(x) if panel.x_scale == "log" else x
    part = np.minimum((along - along.min()) / np.ptp(along) * panel.averages, panel.averages - 1).astype(int)
    number = np.bincount(part)
    held = number > 0
    means = [np.bincount(part, each)[held] / number[held] for each in (x, y)]
    square = np.bincount(part, (y - means[1][np.cumsum(held)[part] - 1]) ** 2)[held] / number[held]
    return means[0], means[1], np.sqrt(square)


def _for_scale(values: NDArray[np.float64], scale: str) -> NDArray[np.float64]:
    return np.where(values > 0, values, np.nan) if scale == "log" else values

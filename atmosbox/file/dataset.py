"""The dataset of a run: its numbers in SI, with the names, units and CF attributes that `VARIABLES` declares."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt
import xarray as xr

from atmosbox.errors import EngineError
from atmosbox.file.variables import SUFFIXES, VARIABLES, Variable, derived, variable

__all__ = ["VARIABLES", "Variable", "dataset", "extended", "headline_variables", "variable"]

_LABELS = {"wall": ("x_low", "x_high", "y_low", "y_high", "z_low", "z_high"), "axis": ("x", "y", "z")}


def headline_variables(headline: Any) -> dict[str, xr.Variable]:
    """Return the variables that hold one headline: its value, standard error, answer of theory and tolerance.

    A value of None becomes NaN; other parts that are None get no variable. Attributes keep the unit in which a table
    shows them and, if the headline has them, how far it may be from theory, whether it is that near, its possible
    range, whether the run is large enough to measure it (``resolved``), and another program that computed it.
    """
    parent = Variable(headline.name, (), headline.unit, headline.label, comment=headline.reason or None)
    stated = {
        parent: math.nan if headline.value is None else headline.value,
        derived(parent, "_se"): headline.standard_error,
        derived(parent, "_theory"): headline.theory,
        derived(parent, "_tolerance"): headline.tolerance,
    }
    held = {entry.name: entry.holding(float(number)) for entry, number in stated.items() if number is not None}
    held[parent.name].attrs["display_units"] = headline.display_unit
    if headline.verdict is not None:
        allowed = {"misfit_allowed_by_chance": headline.chance, "misfit_allowed_as_known": headline.known}
        held[parent.name].attrs |= {**allowed, "within_error": headline.verdict}
    if headline.low is not None and headline.high is not None:
        held[parent.name].attrs |= {"possible_range": [headline.low, headline.high], "resolved": int(headline.resolved)}
    if headline.program:
        held[parent.name].attrs["program"] = headline.program
    return held


def _array(declared: Variable, values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return the values in their declared type; refuse values of the state that are not finite."""
    array = np.asarray(values)
    if array.ndim != len(declared.dims):
        raise ValueError(f"{declared.name} has the shape {array.shape}, but the dimensions {declared.dims}")
    if declared.dtype == "U":
        return array.astype(str)
    if (declared.ledger or declared.dtype[0] == "i") and not np.isfinite(array).all():
        place = [int(index) for index in np.argwhere(~np.isfinite(array))[0]]
        raise EngineError(f"{declared.name} is not finite at {place}: the state of the run is damaged.")
    return array.astype(declared.dtype)


def _coordinate(name: str, values: npt.ArrayLike, time_unit: str) -> xr.Variable:
    """Return a coordinate or its bounds."""
    if name.endswith("_bnds"):
        parent = VARIABLES[name.removesuffix("_bnds")]
        declared = replace(parent, name=name, dims=(*parent.dims, "bounds"))
        return xr.Variable(declared.dims, _array(declared, values), {}, declared.encoding(()))
    declared = VARIABLES[name]
    if declared.dims != (name,):
        raise KeyError(f"{name!r} is not a coordinate")
    array = _array(declared, values)
    if declared.dtype != "U" and (np.diff(array) <= 0).any():
        raise ValueError(f"the coordinate {name} does not rise from each value to the next")
    return (replace(declared, units=time_unit) if name == "elapsed_time" else declared).holding(array)


def dataset(
    frames: Mapping[str, npt.ArrayLike],
    coords: Mapping[str, npt.ArrayLike],
    attrs: Mapping[str, Any],
    headlines: Iterable[Any] = (),
    time_unit: str = "ns",
    own: Mapping[str, Variable] = MappingProxyType({}),
) -> xr.Dataset:
    """Put the numbers of a run into one dataset with all names and attributes that the CF conventions ask for.

    Parameters
    ----------
    frames, coords
        Arrays by the name of their variable or coordinate, in SI, with the dimensions that `variable` declares;
        ``elapsed_time`` is in `time_unit`: s, ns or ps. The bounds of cells are coordinates, too, of shape (n, 2), such
        as ``height_bnds``. The labels of the six walls and three axes need not be given.
    attrs, headlines
        The global attributes, and the main results of the run, whose names ``atmosbox_headlines`` lists.
    own
        The variables that the scene declares, by name.

    Raises
    ------
    KeyError
        If a name is not declared, or a dimension lacks its coordinate.
    ValueError
        If a shape is not the declared one, a coordinate does not rise, or a headline has the name of a variable.
    EngineError
        If a value of a ledger variable or a count is not finite.

    Examples
    --------
    >>> run = dataset(
    ...     {"air_temperature": [300.0, 301.0]}, {"elapsed_time": [0.5, 1.0]}, {"title": "A box of air"}
    ... )
    >>> run.air_temperature.sel(elapsed_time=1.0).item(), run.elapsed_time.units
    (301.0, 'ns')
    """
    if time_unit not in ("s", "ns", "ps"):
        raise ValueError(f"elapsed_time cannot be in {time_unit!r}, only in s, ns or ps")
    axes = {name: _coordinate(name, values, time_unit) for name, values in coords.items()}
    for name in axes:
        if f"{name}_bnds" in axes:
            axes[name].attrs["bounds"] = f"{name}_bnds"
    bounds = {name: entry for name, entry in axes.items() if name.endswith("_bnds")}
    only = {name: entry for name, entry in axes.items() if name not in bounds}
    return extended(xr.Dataset(bounds, only, dict(attrs)), frames, headlines, own)


def extended(
    run: xr.Dataset,
    frames: Mapping[str, npt.ArrayLike],
    headlines: Iterable[Any] = (),
    own: Mapping[str, Variable] = MappingProxyType({}),
) -> xr.Dataset:
    """Return a dataset with more variables, such as those that theory predicts, and with headlines.

    Arguments and errors are those of `dataset`; a variable of the same name is replaced.
    """
    declared = {name: variable(name, own) for name in frames}
    held = {name: declared[name].holding(_array(declared[name], values)) for name, values in frames.items()}
    sizes = {dim: size for entry in held.values() for dim, size in entry.sizes.items()}
    wanted = {dim: names for dim, names in _LABELS.items() if sizes.get(dim) == len(names) and dim not in run.coords}
    run = run.assign_coords({dim: _coordinate(dim, names, "") for dim, names in wanted.items()})
    for dim in sizes:
        if dim not in run.coords and dim not in ("molecule", "drop"):
            raise KeyError(f"the dimension {dim!r} has no coordinate")
    names = []
    for headline in headlines:
        names.append(headline.name)
        for name, entry in headline_variables(headline).items():
            if name in held or name in run.variables:
                raise ValueError(f"the headline {name} has the name of a variable")
            held[name] = entry
    places = [name for name in held if name in VARIABLES and VARIABLES[name].coordinate]
    whole = run.assign(held).set_coords(places)
    for parent, entry in whole.variables.items():
        companions = [f"{parent}{suffix}" for suffix in SUFFIXES if f"{parent}{suffix}" in whole.variables]
        if companions:
            entry.attrs["ancillary_variables"] = " ".join(companions)
    whole.attrs["atmosbox_headlines"] = json.dumps(names)
    return whole

"""A saved run as tables for a spreadsheet: one CSV file for each dimension of its variables."""

from __future__ import annotations

import csv
import io
import json
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["tables"]

_LABELLED = ("wall", "axis")


def tables(dataset: xr.Dataset) -> dict[str, bytes]:
    """Return the tables of a run as CSV, one for each dimension.

    A column is headed by the name of the variable and its unit; all units but that of time are SI. A variable with a
    value for each wall or axis becomes one column for each. Molecules are left out: a trajectory is not a table.

    Parameters
    ----------
    dataset : xarray.Dataset
        A run, or a sweep.

    Returns
    -------
    dict
        The tables by name: ``headlines``, the main results of the run, and one for each dimension, such as
        ``elapsed_time``, ``height`` or ``speed``.

    Examples
    --------
    >>> from atmosbox import run
    >>> made = tables(run("elastic-collisions", duration="2 s"))
    >>> made["headlines"].decode().splitlines()[0]
    'name,what it is,value,standard error,theory,unit'
    >>> made["elapsed_time"].decode().partition(",")[0]
    'elapsed_time [s]'
    """
    made = {"headlines": _headlines(dataset)} if json.loads(dataset.attrs.get("atmosbox_headlines", "[]")) else {}
    for dimension in map(str, dataset.dims):
        if dimension not in dataset.coords or dimension in (*_LABELLED, "member"):
            continue
        columns = [_headed(dataset[dimension], "")]
        for name, values in dataset.variables.items():
            extra = [dim for dim in values.dims if dim != dimension]
            if name == dimension or dimension not in values.dims or not set(extra) <= set(_LABELLED):
                continue
            if not extra:
                columns.append(_headed(dataset[name], ""))
            elif len(extra) == 1:
                labels = dataset[extra[0]].values
                columns += [_headed(dataset[name].isel({extra[0]: k}), f" {label}") for k, label in enumerate(labels)]
        if len(columns) > 1:
            head, body = zip(*columns, strict=True)
            made[dimension] = _csv([head, *zip(*body, strict=True)])
    return made


def _headed(values: xr.DataArray, which: str) -> tuple[str, list[object]]:
    """Return a column: its heading and its cells, empty for values that are not finite."""
    unit = str(values.attrs.get("units", ""))
    shown = f" [{unit}]" if unit not in ("", "1") else ""
    cells = [
        "" if isinstance(cell, float) and not np.isfinite(cell) else cell for cell in np.asarray(values.values).tolist()
    ]
    return f"{values.name}{which}{shown}", cells


def _headlines(dataset: xr.Dataset) -> bytes:
    """Return the table of headlines, one in each row."""
    rows: list[tuple[object, ...]] = [("name", "what it is", "value", "standard error", "theory", "unit")]
    for name in json.loads(dataset.attrs["atmosbox_headlines"]):
        if name in dataset and dataset[name].ndim == 0:
            attributes = dataset[name].attrs
            numbers = [float(dataset[key]) if key in dataset else "" for key in (name, f"{name}_se", f"{name}_theory")]
            rows.append((name, attributes["long_name"], *numbers, attributes["units"]))
    return _csv(rows)


def _csv(rows: list[tuple[object, ...]]) -> bytes:
    """Return rows as CSV."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue().encode()

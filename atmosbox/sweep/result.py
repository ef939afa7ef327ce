"""All runs of a sweep as one dataset, whose dimensions are the settings that vary."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any, TypeAlias

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox.errors import EngineError
from atmosbox.file.declaration import Variable, derived
from atmosbox.file.provenance import global_attributes
from atmosbox.scene.conversion import declared_unit
from atmosbox.sweep.axis import Axis
from atmosbox.sweep.plan import Plan, member_seed
from atmosbox.version import __version__

__all__ = ["FEWEST", "join", "mean_and_error", "row"]

FEWEST = 4
"""Least number of members whose scatter gives the standard error of their mean."""

Floats = NDArray[np.float64]

Key: TypeAlias = tuple[int, int]
"""Point and member of a run, counted from 1."""

_STATES = ("complete", "failed", "missing")
_PLACES = {"height", "altitude", "depth", "level", "time", "latitude", "longitude", "lat", "lon", "x", "y", "z"}
"""Names that mean a place or a time in any file; a setting with such a name gets the suffix ``_setting``."""
_OWN = ("member", "member_seed", "member_status", "member_ledger", "member_reason", "engine")


def mean_and_error(value: Floats, error: Floats) -> tuple[Floats, Floats]:
    """Return the mean of the members at each point, and its standard error.

    Parameters
    ----------
    value, error
        Values and standard errors of the members, (point, member); NaN where there is none.

    Returns
    -------
    mean, standard_error
        Mean and its standard error, (point,). The standard error comes from the scatter of the members or, if there are
        fewer than `FEWEST`, from their own standard errors, because the scatter of so few says little.

    Examples
    --------
    >>> mean, se = mean_and_error(np.array([[1.0, 3.0, 5.0, 3.0]]), np.full((1, 4), 9.0))
    >>> mean.tolist(), round(float(se[0]), 3)
    ([3.0], 0.816)
    >>> mean, se = mean_and_error(np.array([[1.0, 3.0], [2.0, np.nan]]), np.array([[0.3, 0.4], [0.2, 9.0]]))
    >>> mean.tolist(), se.tolist()
    ([2.0, 2.0], [0.25, 0.2])
    """
    known = np.isfinite(value)
    count = known.sum(axis=1)
    least = np.maximum(count, 1)
    mean = np.where(known, value, 0.0).sum(axis=1) / least
    square = (np.where(known, value - mean[:, None], 0.0) ** 2).sum(axis=1)
    scatter = np.sqrt(square / np.maximum(count - 1, 1) / least)
    own = np.sqrt((np.where(known, error, 0.0) ** 2).sum(axis=1)) / least
    nothing = count == 0
    return np.where(nothing, np.nan, mean), np.where(nothing, np.nan, np.where(count < FEWEST, own, scatter))


def join(plan: Plan, rows: Mapping[Key, xr.Dataset], failed: Mapping[Key, str], history: str = "") -> xr.Dataset:
    """Return the runs of a sweep as one dataset.

    Parameters
    ----------
    plan
        The sweep.
    rows
        The results of its runs by point and member, from `row`; others are missing.
    failed
        The reason of each run that failed, by point and member.
    history
        The line that this command adds to the history of the file.

    Returns
    -------
    xarray.Dataset
        For each headline NAME of the scene, as functions of the varied settings: ``NAME``, the mean of the members;
        ``NAME_se``, its standard error; ``NAME_theory`` and ``NAME_tolerance`` if the scene gives them; and
        ``NAME_by_member`` with ``NAME_by_member_se``, the values of each run. Also seed, status and residual of the
        energy budget of every run, and the reason if a run failed.

    Raises
    ------
    EngineError
        If a headline has different units at different points.

    Examples
    --------
    >>> from atmosbox.sweep.plan import plan
    >>> grid = join(plan("temperature", ["temperature=0degC,25degC"], members=3), {}, {})
    >>> dict(grid.sizes), grid.temperature.values.tolist(), int(grid.member_status.max())
    ({'temperature': 2, 'member': 3}, [273.15, 298.15], 2)
    """
    # The order of the headlines is that of a run that has measured as many as any
    longest = sorted(rows.values(), key=lambda each: -len(each.attrs["names"]))
    names = list(dict.fromkeys(name for each in longest for name in each.attrs["names"]))
    taken = {name + suffix for name in names for suffix in ("", *_SUFFIXES)} | set(_OWN)
    called = [f"{axis.name}_setting" if axis.name in taken | _PLACES else axis.name for axis in plan.axes]
    coords = {}
    dims: tuple[str, ...] = ()
    for axis, own in zip(plan.axes, called, strict=True):
        # CF takes a coordinate in pascal for a vertical axis; so a pressure is a label, not a dimension, of the grid
        dims += (f"{axis.name}_setting" if _is_pressure(axis) else own,)
        coords[own] = _coordinate(axis, own, dims[-1])
    member = Variable("member", ("member",), "1", "number of the member", "realization", dtype="i8", ledger=True)
    coords["member"] = member.holding(np.arange(1, plan.members + 1))
    data = _about_members(plan, rows, failed, dims)
    for name in names:
        data |= _headline(name, rows, plan, dims)
    used = sorted(set(plan.engines))
    parameters: dict[str, Any] = {"scene": plan.scene, "settings": dict(plan.defaults)}
    parameters |= {"engine": used[0]} if len(used) == 1 else {}
    parameters |= {"version": __version__, "save_molecules": False}
    parameters["sweep"] = {
        "vary": {axis.name: list(axis.values) for axis in plan.axes},
        "dimensions": dict(zip(dims, called, strict=True)),
        "members": plan.members,
        "seed": plan.seed,
        "accuracy": plan.accuracy,
        "headlines": names,
    }
    varied = [axis.name.replace("_", " ") for axis in plan.axes]
    varied = [", ".join(varied[:-1]), varied[-1]] if len(varied) > 1 else varied
    attributes = global_attributes(
        parameters,
        title=f"{plan.title}: {' and '.join(varied)} varied",
        command="",
        comment=" ".join((plan.prepared[0].module.__doc__ or "").split()),
        references=plan.prepared[0].engine.engine.reference,
        status="complete",
    )
    if history:
        attributes["history"] = history
    return xr.Dataset(data, coords, attributes)


_SUFFIXES = ("_se", "_theory", "_tolerance", "_by_member", "_by_member_se")


def row(run: xr.Dataset) -> xr.Dataset:
    """Return the headlines of a run, with their names as an attribute and the residual of its energy budget."""
    names = json.loads(run.attrs.get("atmosbox_headlines", "[]"))
    kept = [name + suffix for name in names for suffix in ("", "_se", "_theory", "_tolerance") if name + suffix in run]
    return run[kept].assign(ledger=run["ledger_residual"].max()).assign_attrs(names=names)


def _gathered(name: str, rows: Mapping[Key, xr.Dataset], plan: Plan) -> Floats:
    """Return the values of a variable in all runs, (point, member); NaN where there is none."""
    made = np.full((plan.points, plan.members), np.nan)
    for (point, member), found in rows.items():
        if name in found:
            made[point - 1, member - 1] = float(found[name])
    return made


def _is_pressure(axis: Axis) -> bool:
    return axis.numeric and declared_unit(axis.parameter.unit).si == "Pa"


def _coordinate(axis: Axis, name: str, dim: str) -> xr.Variable:
    """Return the values of a setting as a coordinate."""
    p = axis.parameter
    if not axis.numeric:
        words = ["on" if value is True else "off" if value is False else str(value) for value in axis.values]
        declared = Variable(name, (dim,), "", p.help, dtype="U")
        return declared.holding(np.array(words, dtype=str))
    unit = declared_unit(p.unit).si
    known = "[" not in unit  # values in an unusual unit stay in their documented unit
    values = np.array(axis.si if known else [float(value) for value in axis.values])
    standard = "air_pressure" if _is_pressure(axis) else None
    made = Variable(name, (dim,), unit if known else p.unit, p.help, standard, ledger=True).holding(values)
    made.attrs["display_units"] = p.unit
    return made


def _about_members(
    plan: Plan, rows: Mapping[Key, xr.Dataset], failed: Mapping[Key, str], dims: tuple[str, ...]
) -> dict[str, xr.Variable]:
    """Return seed, status and residual of the energy budget of every run, and the reason if a run failed."""
    shape = (plan.points, plan.members)
    seed = np.array([[member_seed(plan.seed, j + 1, k + 1) for k in range(shape[1])] for j in range(shape[0])])
    status = np.full(shape, _STATES.index("missing"), dtype=np.int8)
    reason = np.full(shape, "", dtype=object)
    for point, member in rows:
        status[point - 1, member - 1] = _STATES.index("complete")
    for (point, member), why in failed.items():
        status[point - 1, member - 1], reason[point - 1, member - 1] = _STATES.index("failed"), why
    both = (*dims, "member")
    declared = {
        Variable("member_seed", both, "1", "seed of the run", dtype="i8", ledger=True): seed,
        Variable("member_status", both, "", "status of the run", dtype="i1", ledger=True, flags=_STATES): status,
        Variable("member_ledger", both, "1", "residual of the energy budget of the run"): _gathered(
            "ledger", rows, plan
        ),
    }
    if failed:
        declared[Variable("member_reason", both, "", "why the run failed", dtype="U")] = reason.astype(str)
    made = {each.name: each.holding(values.reshape(*plan.shape, plan.members)) for each, values in declared.items()}
    if len(set(plan.engines)) > 1:
        engine = Variable("engine", dims, "", "engine and its options", dtype="U")
        made["engine"] = engine.holding(np.array(plan.engines, dtype=str).reshape(plan.shape))
    return made


def _headline(name: str, rows: Mapping[Key, xr.Dataset], plan: Plan, dims: tuple[str, ...]) -> dict[str, xr.Variable]:
    """Return the variables of one headline."""
    about = [each[name].attrs for each in rows.values() if name in each]
    units = sorted({each["units"] for each in about})
    if len(units) > 1:
        raise EngineError(f"The headline {name} is in {' and '.join(units)} at different points: give it one unit.")
    value, error, theory, known = (
        _gathered(name + suffix, rows, plan) for suffix in ("", "_se", "_theory", "_tolerance")
    )
    mean, scatter = mean_and_error(value, error)
    both, label = (*dims, "member"), str(about[0]["long_name"])
    average = Variable(name, dims, units[0], label, comment="mean over the members")
    own = Variable(f"{name}_by_member", both, units[0], f"{label} in each run")
    made = {
        name: average.holding(mean.reshape(plan.shape)),
        f"{name}_se": derived(average, "_se").holding(scatter.reshape(plan.shape)),
        own.name: own.holding(value.reshape(*plan.shape, plan.members)),
        f"{own.name}_se": derived(own, "_se").holding(error.reshape(*plan.shape, plan.members)),
    }
    if np.isfinite(theory).any():
        answer, _ = mean_and_error(theory, theory)
        made[f"{name}_theory"] = derived(average, "_theory").holding(answer.reshape(plan.shape))
    there = np.isfinite(known)
    tolerance = np.where(there.any(axis=1), np.max(known, axis=1, where=there, initial=0.0), np.nan)
    made[f"{name}_tolerance"] = derived(average, "_tolerance").holding(tolerance.reshape(plan.shape))
    if reason := about[0].get("comment"):
        made[f"{name}_tolerance"].attrs["comment"] = reason
    made[name].attrs["display_units"] = about[0].get("display_units", units[0])
    made[name].attrs["ancillary_variables"] = " ".join(each for each in made if each.startswith(f"{name}_"))
    made[own.name].attrs["ancillary_variables"] = f"{own.name}_se"
    return made

"""All runs of a sweep as one dataset, whose dimensions are the settings that vary."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox import scenarios
from atmosbox.errors import EngineError
from atmosbox.file.declaration import Variable, derived
from atmosbox.file.provenance import global_attributes
from atmosbox.scene import engines
from atmosbox.scene.conversion import declared_unit
from atmosbox.sweep.axis import Axis
from atmosbox.sweep.member import COMPLETE, Record
from atmosbox.sweep.plan import Plan, member_seed
from atmosbox.version import __version__

__all__ = ["FEWEST", "assemble", "mean_and_error"]

FEWEST = 4
"""Least number of members whose scatter gives the standard error of their mean."""

Floats = NDArray[np.float64]

_STATES = ("complete", "failed", "missing")
_PLACES = {"height", "altitude", "depth", "level", "time", "latitude", "longitude", "lat", "lon", "x", "y", "z"}
"""Names that mean a place or a time in any file; a setting with such a name gets the suffix ``_setting``."""
_OWN = ("member", "member_seed", "member_status", "member_ledger", "member_reason", "engine")


class _Measured(NamedTuple):
    """The values of one headline number in all members, ``(point, member)``."""

    said: Mapping[str, Any]
    value: Floats
    error: Floats
    theory: Floats
    tolerance: Floats


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


def assemble(
    plan: Plan, records: Iterable[Record], *, history: Sequence[str] = (), status: str = "complete"
) -> xr.Dataset:
    """Return the runs of a sweep as one dataset.

    Parameters
    ----------
    plan
        The sweep.
    records
        The records of its runs, in any order.
    history
        The lines of the file's history.
    status
        ``complete``, ``partial`` or ``interrupted``.

    Returns
    -------
    xarray.Dataset
        For each headline NAME of the scene, as functions of the varied settings: ``NAME``, the mean of the members;
        ``NAME_se``, its standard error; ``NAME_theory`` and ``NAME_tolerance`` if the scene gives them; and
        ``NAME_by_member`` with ``NAME_by_member_se``, the values of each run. Also seed, status and residual of the
        energy ledger of every run, and the reason if a run failed.

    Raises
    ------
    EngineError
        If a headline has different units at different points.

    Examples
    --------
    >>> from atmosbox.sweep.plan import plan
    >>> grid = assemble(plan("temperature", ["temperature=0degC,25degC"], members=3), [])
    >>> dict(grid.sizes), grid.temperature.values.tolist(), int(grid.member_status.max())
    ({'temperature': 2, 'member': 3}, [273.15, 298.15], 2)
    """
    ordered = sorted(records, key=lambda record: (record["point"], record["member"]))
    measured = _measured(plan, ordered)
    taken = {name + suffix for name in measured for suffix in ("", *_SUFFIXES)} | set(_OWN)
    names = [f"{axis.name}_setting" if axis.name in taken | _PLACES else axis.name for axis in plan.axes]
    coords = {}
    dims: tuple[str, ...] = ()
    for axis, own in zip(plan.axes, names, strict=True):
        # CF takes a coordinate in pascal for a vertical axis; so a pressure is a label, not a dimension, of the grid
        dims += (f"{axis.name}_setting" if _is_pressure(axis) else own,)
        coords[own] = _coordinate(axis, own, dims[-1])
    member = Variable("member", ("member",), "1", "number of the member", "realization", dtype="i8", ledger=True)
    coords["member"] = member.holding(np.arange(1, plan.members + 1))
    data = _about_members(plan, ordered, dims)
    for name, found in measured.items():
        data |= _headline(name, found, plan, dims)
    module = scenarios.load(plan.scene)
    used = sorted({text for text in plan.engines if text})
    parameters: dict[str, Any] = {"scene": plan.scene, "settings": dict(plan.defaults)}
    parameters |= {"engine": used[0]} if len(used) == 1 else {}
    parameters |= {"version": __version__, "save_molecules": False}
    parameters["sweep"] = {
        "vary": {axis.name: list(axis.values) for axis in plan.axes},
        "dimensions": dict(zip(dims, names, strict=True)),
        "members": plan.members,
        "seed": plan.seed,
        "accuracy": plan.accuracy,
        "headlines": list(measured),
    }
    varied = [axis.name.replace("_", " ") for axis in plan.axes]
    varied = [", ".join(varied[:-1]), varied[-1]] if len(varied) > 1 else varied
    attributes = global_attributes(
        parameters,
        title=f"{plan.title}: {' and '.join(varied)} varied",
        command="",
        comment=" ".join((module.__doc__ or "").split()),
        references=engines.choose(used[0]).engine.reference if used else "",
        status=status,
    )
    if history:
        attributes["history"] = "\n".join(history)
    return xr.Dataset(data, coords, attributes)


_SUFFIXES = ("_se", "_theory", "_tolerance", "_by_member", "_by_member_se")


def _measured(plan: Plan, records: Sequence[Record]) -> dict[str, _Measured]:
    """Return the values of all members by headline, point and member."""
    found: dict[str, _Measured] = {}
    # The order of the headlines is that of a run that has measured as many as any
    for record in sorted(records, key=lambda record: -len(record.get("headlines", ()))):
        for headline in record.get("headlines", ()):
            name = headline["name"]
            if name not in found:
                empty = (np.full((plan.points, plan.members), np.nan) for _ in range(4))
                found[name] = _Measured(headline, *empty)
            one = found[name]
            if headline["unit"] != one.said["unit"]:
                units = f"{one.said['unit']} and {headline['unit']}"
                raise EngineError(f"The headline {name} is in {units} at different points: give it one unit.")
            place = record["point"] - 1, record["member"] - 1
            parts = ("value", "standard_error", "theory", "tolerance")
            for array, part in zip(one[1:], parts, strict=True):
                array[place] = math.nan if headline[part] is None else headline[part]
    return found


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


def _about_members(plan: Plan, records: Sequence[Record], dims: tuple[str, ...]) -> dict[str, xr.Variable]:
    """Return seed, status and residual of the ledger of every run, and the reason if a run failed."""
    shape = (plan.points, plan.members)
    seed = np.array([[member_seed(plan.seed, j + 1, k + 1) for k in range(shape[1])] for j in range(shape[0])])
    status = np.full(shape, _STATES.index("missing"), dtype=np.int8)
    ledger = np.full(shape, np.nan)
    reason = np.full(shape, "", dtype=object)
    for point, why in plan.refused.items():
        status[point - 1], reason[point - 1] = _STATES.index("failed"), why
    for record in records:
        place = record["point"] - 1, record["member"] - 1
        status[place] = _STATES.index(record["status"])
        if record["status"] == COMPLETE:
            ledger[place] = record["ledger"]
        else:
            reason[place] = record["reason"]
    both = (*dims, "member")
    declared = {
        Variable("member_seed", both, "1", "seed of the run", dtype="i8", ledger=True): seed,
        Variable("member_status", both, "", "status of the run", dtype="i1", ledger=True, flags=_STATES): status,
        Variable("member_ledger", both, "1", "residual of the energy ledger of the run"): ledger,
    }
    if any(reason.ravel()):
        declared[Variable("member_reason", both, "", "why the run failed", dtype="U")] = reason.astype(str)
    made = {each.name: each.holding(values.reshape(*plan.shape, plan.members)) for each, values in declared.items()}
    if len({text for text in plan.engines if text}) > 1:
        engine = Variable("engine", dims, "", "engine and its options", dtype="U")
        made["engine"] = engine.holding(np.array(plan.engines, dtype=str).reshape(plan.shape))
    return made


def _headline(name: str, found: _Measured, plan: Plan, dims: tuple[str, ...]) -> dict[str, xr.Variable]:
    """Return the variables of one headline."""
    said = found.said
    mean, error = mean_and_error(found.value, found.error)
    both = (*dims, "member")
    average = Variable(name, dims, said["unit"], said["label"], comment="mean over the members")
    own = Variable(f"{name}_by_member", both, said["unit"], f"{said['label']} in each run")
    made = {
        name: average.holding(mean.reshape(plan.shape)),
        f"{name}_se": derived(average, "_se").holding(error.reshape(plan.shape)),
        own.name: own.holding(found.value.reshape(*plan.shape, plan.members)),
        f"{own.name}_se": derived(own, "_se").holding(found.error.reshape(*plan.shape, plan.members)),
    }
    if np.isfinite(found.theory).any():
        answer, _ = mean_and_error(found.theory, found.theory)
        made[f"{name}_theory"] = derived(average, "_theory").holding(answer.reshape(plan.shape))
    known = np.isfinite(found.tolerance)
    tolerance = np.where(known.any(axis=1), np.max(found.tolerance, axis=1, where=known, initial=0.0), np.nan)
    made[f"{name}_tolerance"] = derived(average, "_tolerance").holding(tolerance.reshape(plan.shape))
    if said["reason"]:
        made[f"{name}_tolerance"].attrs["comment"] = said["reason"]
    made[name].attrs["display_units"] = said["display_unit"]
    made[name].attrs["ancillary_variables"] = " ".join(each for each in made if each.startswith(f"{name}_"))
    made[own.name].attrs["ancillary_variables"] = f"{own.name}_se"
    return made

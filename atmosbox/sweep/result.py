"""All runs of a sweep as one dataset, whose dimensions are the settings that vary."""

import itertools
import json
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox.file.provenance import global_attributes
from atmosbox.file.variables import Variable, derived
from atmosbox.scene.conversion import declared_unit, to_si
from atmosbox.scene.settings import Parameter, Value
from atmosbox.sweep.plan import Plan, member_seed
from atmosbox.version import __version__

FEWEST = 4
"""Least number of members whose scatter gives the standard error of their mean."""

Floats = NDArray[np.float64]
Key = tuple[int, int]
"""Point and member of a run, counted from 1."""

_STATES = ("complete", "failed", "missing")
_PLACES = {"height", "altitude", "depth", "level", "time", "latitude", "longitude", "lat", "lon", "x", "y", "z"}
"""Names that mean a place or a time in any file; a setting with such a name gets the suffix ``_setting``."""
_MEASURED = ("", "_se", "_theory", "_tolerance")
_SUFFIXES = (*_MEASURED, "_by_member", "_by_member_se")


def mean_and_error(value: Floats, error: Floats) -> tuple[Floats, Floats]:
    """Return the mean of the members at each point, and its standard error, from values and errors (..., member).

    The standard error comes from the scatter of the members or, if there are fewer than `FEWEST`, from their own
    standard errors, because the scatter of so few says little. A value is NaN where there is none.

    >>> mean, se = mean_and_error(np.array([[1.0, 3.0, 5.0, 3.0]]), np.full((1, 4), 9.0))
    >>> mean.tolist(), round(float(se[0]), 3)
    ([3.0], 0.816)
    >>> mean, se = mean_and_error(np.array([[1.0, 3.0], [2.0, np.nan]]), np.array([[0.3, 0.4], [0.2, 9.0]]))
    >>> mean.tolist(), se.tolist()
    ([2.0, 2.0], [0.25, 0.2])
    """
    known = np.isfinite(value)
    count = known.sum(-1)
    with np.errstate(invalid="ignore"):  # 0 / 0 is NaN where no member has a value
        mean = value.sum(-1, where=known) / count
        square = ((value - mean[..., None]) ** 2).sum(-1, where=known)
        scatter = np.sqrt(square / np.maximum(count - 1, 1) / count)
        own = np.sqrt((error**2).sum(-1, where=known)) / count
    return mean, np.where(count < FEWEST, own, scatter)


def join(plan: Plan, rows: Mapping[Key, xr.Dataset], failed: Mapping[Key, str], command: str = "") -> xr.Dataset:
    """Return the runs of a sweep as one dataset.

    For each headline NAME of the scene it has, as functions of the varied settings: ``NAME``, the mean of the members;
    ``NAME_se``, its standard error; ``NAME_theory`` and ``NAME_tolerance`` if the scene gives them; and
    ``NAME_by_member`` with ``NAME_by_member_se``, the values of each run. Also seed, status and residual of the
    energy budget of every run, and the reason if a run failed.

    ``rows`` are the results by point and member, from `row`, and ``failed`` the reasons of the runs that failed.
    """
    # The order of the headlines is that of a run that has measured as many as any
    longest = sorted(rows.values(), key=lambda each: -len(each.attrs["names"]))
    names = list(dict.fromkeys(name for each in longest for name in each.attrs["names"]))
    taken = {name + suffix for name in names for suffix in _SUFFIXES} | _PLACES
    coords = dict(_coordinate(plan.parameters[name], plan.vary[name], name in taken) for name in plan.vary)
    dims = tuple(str(coordinate.dims[0]) for coordinate in coords.values())
    dimensions = dict(zip(dims, coords, strict=True))
    member = Variable("member", ("member",), "1", "number of the member", "realization", dtype="i8", ledger=True)
    coords["member"] = member.holding(np.arange(1, plan.members + 1))
    both = (*dims, "member")
    keys = list(itertools.product(range(1, len(plan.prepared) + 1), range(1, plan.members + 1)))

    def grid(values: Iterable[Any]) -> NDArray[Any]:
        """Return a value of each run, in the order of `keys`, as an array of the dimensions `both`."""
        return np.array(list(values)).reshape(*map(len, plan.vary.values()), plan.members)

    def measured(name: str) -> Floats:
        """Return what each run has measured; NaN where there is none."""
        return grid(float(rows[key][name]) if name in rows.get(key, ()) else np.nan for key in keys)

    seed = grid(member_seed(plan.seed, *key) for key in keys)
    status = grid(1 if key in failed else 0 if key in rows else 2 for key in keys)
    data: list[tuple[Variable, NDArray[Any]]] = [
        (Variable("member_seed", both, "1", "seed of the run", dtype="i8", ledger=True), seed),
        (Variable("member_status", both, "", "status of the run", dtype="i1", ledger=True, flags=_STATES), status),
        (Variable("member_ledger", both, "1", "residual of the energy budget of the run"), measured("ledger")),
    ]
    if failed:
        why = Variable("member_reason", both, "", "why the run failed", dtype="U")
        data.append((why, grid(failed.get(key, "") for key in keys)))
    made = {declared.name: declared.holding(values) for declared, values in data}
    for name in names:
        about = next(each[name].attrs for each in rows.values() if name in each)
        made |= _headline(name, about, [measured(name + suffix) for suffix in _MEASURED], dims)
    return xr.Dataset(made, coords, _attributes(plan, names, dimensions, command))


def row(run: xr.Dataset) -> xr.Dataset:
    """Return the headlines of a run, with their names as an attribute and the residual of its energy budget."""
    names = json.loads(run.attrs.get("atmosbox_headlines", "[]"))
    kept = [name + suffix for name in names for suffix in _MEASURED if name + suffix in run]
    return run[kept].assign(ledger=run["ledger_residual"].max()).assign_attrs(names=names)


def _coordinate(p: Parameter, given: Sequence[Value], taken: bool) -> tuple[str, xr.Variable]:
    """Return the name of a setting in the file, and its values; a name that is taken gets a suffix."""
    name = f"{p.name}_setting" if taken else p.name
    if p.kind not in ("int", "float"):
        words = Variable(name, (name,), "", p.help, dtype="U")
        return name, words.holding([p.typed(value) for value in given])
    unit = declared_unit(p.unit).si
    known = "[" not in unit  # values in an unusual unit stay in their documented unit
    # CF takes a coordinate in pascal for a vertical axis; so a pressure is a label, not a dimension, of the grid
    dim, standard = (f"{p.name}_setting", "air_pressure") if unit == "Pa" else (name, None)
    made = Variable(name, (dim,), unit if known else p.unit, p.help, standard, ledger=True)
    values = made.holding([to_si(float(value), p.unit) for value in given] if known else given)
    values.attrs["display_units"] = p.unit
    return name, values


def _headline(name: str, about: dict[str, Any], found: list[Floats], dims: tuple[str, ...]) -> dict[str, xr.Variable]:
    """Return the variables of one headline, from its attributes and its numbers in each run."""
    value, error, theory, tolerance = found
    mean, scatter = mean_and_error(value, error)
    unit, label = about["units"], about["long_name"]
    average = Variable(name, dims, unit, label, comment="mean over the members")
    own = Variable(f"{name}_by_member", (*dims, "member"), unit, f"{label} in each run")
    data = [(average, mean), (derived(average, "_se"), scatter), (own, value), (derived(own, "_se"), error)]
    if np.isfinite(theory).any():
        data.append((derived(average, "_theory"), mean_and_error(theory, theory)[0]))
    data.append((derived(average, "_tolerance"), np.fmax.reduce(tolerance, axis=-1)))
    made = {declared.name: declared.holding(values) for declared, values in data}
    if reason := about.get("comment"):
        made[f"{name}_tolerance"].attrs["comment"] = reason
    made[name].attrs["display_units"] = about.get("display_units", unit)
    made[name].attrs["ancillary_variables"] = " ".join(each for each in made if each != name)
    made[own.name].attrs["ancillary_variables"] = f"{own.name}_se"
    return made


def _attributes(plan: Plan, names: list[str], dimensions: dict[str, str], command: str) -> dict[str, Any]:
    """Return the global attributes of the file of a sweep."""
    engines = " and ".join(sorted({str(each.engine) for each in plan.prepared}))
    vary = {name: list(values) for name, values in plan.vary.items()}
    grid: dict[str, Any] = {"vary": vary, "dimensions": dimensions, "members": plan.members, "seed": plan.seed}
    grid |= {"accuracy": plan.accuracy, "headlines": names}
    parameters: dict[str, Any] = {"scene": plan.scene, "settings": plan.defaults, "engine": engines}
    parameters |= {"version": __version__, "save_molecules": False, "sweep": grid}
    *others, last = [name.replace("_", " ") for name in plan.vary]
    return global_attributes(
        parameters,
        title=f"{plan.title} ({', '.join(others)}{' and ' * bool(others)}{last} varied)",
        command=command,
        comment=" ".join((plan.prepared[0].module.__doc__ or "").split()),
        references=plan.prepared[0].engine.engine.reference,
        status="complete",
    )

"""Checks of a finished run: whether its energy budget is closed, and whether it agrees with theory."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from atmosbox.errors import FileError, PhysicsError
from atmosbox.scene.engines import EXACT
from atmosbox.scene.headline import Headline
from atmosbox.simulation.accuracy import ExpectedError

if TYPE_CHECKING:
    import xarray as xr

LEDGER_LIMIT = 1e-10
"""Largest residual of the energy budget of a correct run, relative to the energy in the box or exchanged so far."""
_GIVEN_BEFORE = ("work_by_stirring",)
"""Terms of the budget that only files of earlier versions hold."""


class Check(NamedTuple):
    """One check of a file and its result."""

    name: str
    passed: bool
    sentence: str


def check_ledger(residual: float, whose: str, remedy: str) -> None:
    """Refuse a run whose energy budget is not closed."""
    if not residual <= LEDGER_LIMIT:
        raise PhysicsError(
            f"The energy budget of {whose} is off by {residual:.0e}, more than {LEDGER_LIMIT:.0e}: {remedy}."
        )


def with_bias(headlines: Iterable[Headline], parameters: Mapping[str, Any]) -> tuple[Headline, ...]:
    """Return headlines with the measured bias of an approximate engine, if it was measured at the same settings."""
    known = parameters.get("accuracy")
    if not known or known["differs"] or known["engine"] == str(EXACT):
        return tuple(headlines)
    found = []
    for headline in headlines:
        if headline.name in known["errors"]:
            stated = known["errors"][headline.name]
            error = ExpectedError(*(stated[name] for name in ExpectedError._fields))
            size = error.size(headline.theory)
            headline = replace(headline, bias=size * error.bias, bias_se=size * error.bias_se)
        found.append(headline)
    return tuple(found)


def headlines_of(dataset: xr.Dataset) -> tuple[Headline, ...]:
    """Return the headlines that a dataset holds; raise FileError if it names some that it does not contain.

    >>> from atmosbox import run
    >>> box = run("elastic-collisions", duration="2 s")
    >>> headlines_of(box)[0].name
    'energy_of_light_discs'
    """

    def number(name: str, default: float | None = 0.0) -> Any:
        return float(dataset[name]) if name in dataset else default

    found = []
    try:
        for name in json.loads(dataset.attrs.get("atmosbox_headlines", "[]")):
            about = dataset[name].attrs
            low, high = map(float, about["possible_range"]) if "resolved" in about else (None, None)
            theory, tolerance = number(f"{name}_theory", None), number(f"{name}_tolerance")
            numbers = float(dataset[name]), number(f"{name}_se"), theory, tolerance
            unit, reason, program = (str(about.get(key, "")) for key in ("units", "comment", "program"))
            words = reason, unit, str(about.get("display_units", unit)), str(about["long_name"])
            found.append(Headline(name, *numbers, *words, low=low, high=high, program=program))
        return with_bias(found, json.loads(dataset.attrs.get("atmosbox_parameters", "{}")))
    except (KeyError, ValueError, TypeError) as error:
        raise FileError(f"The headlines of this file cannot be read ({error}): run the scene again.") from error


def verify(dataset: xr.Dataset) -> list[Check]:
    """Check a dataset again: it is complete, its energy budget is closed, and it agrees with theory.

    >>> from atmosbox import run
    >>> all(check.passed for check in verify(run("elastic-collisions", seed=2)))
    True
    """
    checks = []
    status = str(dataset.attrs.get("atmosbox_status", "unknown"))
    frames = int(dataset.sizes.get("elapsed_time", 0))
    what = f"the sweep is {status}" if "member" in dataset.sizes else f"the run is {status}, with {frames} frames"
    checks.append(Check("complete", status == "complete", what))
    floats = {name: each for name, each in dataset.variables.items() if each.dtype.kind == "f"}
    bad = [str(name) for name, each in floats.items() if np.isinf(each.values).any()]
    checks.append(Check("finite", not bad, f"infinite numbers in {', '.join(bad)}" if bad else "no number is infinite"))
    if "ledger_residual" in dataset:
        worst = float(np.max(dataset["ledger_residual"].values)) if frames else math.nan
        closed = bool(worst <= LEDGER_LIMIT)
        said = f"closed to {worst:.0e}" if closed else f"not closed: {worst:.0e} is missing"
        checks.append(Check("ledger", closed, f"the energy budget of the run is {said}"))
        checks.append(_balance(dataset))
    for headline in headlines_of(dataset):
        if headline.agrees is not None:
            checks.append(Check(headline.name, headline.agrees, _agreement(headline)))
    return checks


def _agreement(headline: Headline) -> str:
    """Return a sentence with the difference of a headline from theory, and how far it is expected to be at most."""
    difference = headline.shown(headline.misfit or 0.0, "+" if (headline.misfit or 0.0) > 0.0 else "")
    within = f"{'' if headline.agrees else 'not '}within {headline.shown(headline.allowed, '±')}"
    return f"{headline.label}: difference {difference}, {within}: {headline.expectation}"


def _balance(dataset: xr.Dataset) -> Check:
    """Check the energy budget again from its terms in the file."""
    from atmosbox.engine.core.account import GIVEN, STORES, residual

    terms = {name: dataset[name].values for name in (*STORES, *GIVEN, *_GIVEN_BEFORE) if name in dataset}
    worst = float(np.max(residual(terms))) if dataset.sizes["elapsed_time"] else math.nan
    passed = bool(worst <= LEDGER_LIMIT)
    what = f"energy minus heat{', error of the engine' if 'numerical_heat' in terms else ''} and work"
    said = f"is{'' if passed else ' not'} constant: it changes by {worst:.0e} of the largest energy"
    return Check("balance", passed, f"{what} {said}")

"""The expected errors of a run beside those that it found, as lines of text and as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from atmosbox.scene.target import TARGETS
from atmosbox.simulation.accuracy import cost, said
from atmosbox.text.table import table, wrapped

if TYPE_CHECKING:
    from atmosbox.scene.headline import Headline
    from atmosbox.scene.target import Target
    from atmosbox.simulation.accuracy import Expectation, ExpectedError


def expectation_lines(
    expectation: Expectation | None, headlines: Sequence[Headline], engine: str, width: int
) -> list[str]:
    """Return the lines that say which engine and settings were picked, which errors are expected and which were found.

    There are no `headlines` before the run; `engine` is empty for the default engine of the scene.
    """
    if expectation is None:
        if not engine:
            return []
        nothing = f"no error was measured for the engine {engine} at these settings: compare with --engine exact"
        return wrapped(nothing, width)
    way, target = expectation.way, expectation.target
    asked = "" if target is None else f"accuracy {target.text}{_meaning(target)}: "
    lines = wrapped(f"{asked}{way.label}, at {cost(way.cost)}; its errors were measured in {way.members} runs", width)
    if target is not None and not expectation.met:
        lines += wrapped(f"Nothing that was measured is within {target.limits}: this comes nearest.", width)
    found = _found(expectation, headlines)
    rows = []
    for name, error in way.errors.items():
        bias = f"{_shown(error, error.bias, '+')} ± {_shown(error, error.bias_se)}"
        cells = [expectation.labels[name], _shown(error, error.total), bias, _shown(error, error.noise)]
        rows.append([*cells, _shown(error, found[name], "+") if name in found else "-"])
    header = ["expected of a single run", "error", "bias", "noise", "found"]
    if not headlines:
        header, rows = header[:-1], [row[:-1] for row in rows]
    lines += table(header, rows, width)
    if expectation.differs:
        known = way.settings
        other = (said(name, known[name]) if name in known else f"the default of {name}" for name in expectation.differs)
        lines += wrapped(
            f"These errors were measured at other settings, with {', '.join(other)}; here they may be different.", width
        )
    return lines


def _meaning(target: Target) -> str:
    """Return the meaning of a named accuracy, in brackets; empty for any other accuracy."""
    if target.text not in TARGETS:
        return ""
    return f" ({'the most accurate that was measured' if target.best else target.limits})"


def _shown(error: ExpectedError, size: float, sign: str = "") -> str:
    """Return an error with two digits and its unit."""
    number = size if error.unit == "K" else 100.0 * size
    return f"{float(f'{number:.2g}'):{sign}g} {'K' if error.unit == 'K' else '%'}"


def _found(expectation: Expectation, headlines: Sequence[Headline]) -> dict[str, float]:
    """Return the differences of a run from theory, each in the unit of its expected error."""
    judged = {each.name: each for each in headlines if each.misfit is not None}
    sizes = {name: error.size(judged[name].theory) for name, error in expectation.way.errors.items() if name in judged}
    return {name: (judged[name].misfit or 0.0) / size for name, size in sizes.items() if size}


def expectation_json(expectation: Expectation | None, headlines: Sequence[Headline] = ()) -> dict[str, Any] | None:
    """Return the expected errors as a record for JSON, with those that the run found; None if none are known."""
    if expectation is None:
        return None
    made = expectation.as_dict()
    for name, difference in _found(expectation, headlines).items():
        made["errors"][name]["found"] = difference
    return made

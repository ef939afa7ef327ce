"""Several runs side by side as a table: which settings differ, and by how much the results differ."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from atmosbox.text.table import digits, measurement, number, table, wrapped

if TYPE_CHECKING:
    from atmosbox.plot.compare import Compared, Naming

__all__ = ["comparison_lines"]


def comparison_lines(files: Sequence[str], names: Naming, numbers: Sequence[Compared], columns: int) -> list[str]:
    """Return the comparison as text: the settings that differ, and the results of all runs with their differences."""
    head = f"{' and '.join(dict.fromkeys(names.scenes))}: {names.title}"
    runs = [f"{label}: {file}" for label, file in zip(names.labels, files, strict=True) if label != Path(file).stem]
    made = [*wrapped(head, columns), *(line for run in runs for line in wrapped(run, columns, indent="  ")), ""]
    if not numbers:
        return [*made, "No number is in both files: each run shows its own with atmosbox check."]
    rows = []
    for each in numbers:
        unit = "" if each.unit in ("", "1") else f" [{each.unit}]"
        if len(files) == 2:
            rows.append(
                [each.label + unit, *(_said(each, run) for run in (0, 1)), _changed(each, 1), _expected(each, 1)]
            )
            continue
        for run, label in enumerate(names.labels):
            first = run == 0
            rows.append(
                [each.label + unit if first else "", label, _said(each, run)]
                + ["", ""] * first
                + [_changed(each, run), _expected(each, run)] * (not first)
            )
    if len(files) == 2:
        header = ["quantity", *names.labels, "difference", "by theory"]
    else:
        header = ["quantity", "run", "measured", "minus the first", "by theory"]
    return [*made, *table(header, rows, columns)]


def _said(each: Compared, run: int) -> str:
    """Return a measurement of a run."""
    value, error = each.runs[run].value, each.runs[run].error
    if not math.isfinite(value):
        return "-"
    return measurement(value, error) if math.isfinite(error) else number(value)


def _changed(each: Compared, run: int) -> str:
    """Return the difference from the first run with its standard error, and their ratio."""
    difference, error = each.difference(run), each.error(run)
    if not math.isfinite(difference):
        return "-"
    decimals, power = digits(difference, error)
    if decimals is None:
        return number(difference, sign="+") if difference else "0"
    shown = f"{number(difference, decimals, power, '+')} ± {number(error, decimals, power)}"
    return f"{shown} ({abs(each.sigma(run)):.1f}σ)"


def _expected(each: Compared, run: int) -> str:
    """Return the difference that theory predicts, with as many digits as the measured difference."""
    expected = each.expected(run)
    if not math.isfinite(expected):
        return "-"
    return number(expected, *digits(each.difference(run), each.error(run)), "+") if expected else "0"

"""The command ``compare``: several runs in one figure, and a table of their numbers."""

from __future__ import annotations

import math
import shlex
from collections.abc import Sequence
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from atmosbox.cli.application import app, examples
from atmosbox.cli.option import Force, Json, Theme, Verbose, out_option, quiet_option
from atmosbox.cli.output_name import beside
from atmosbox.cli.terminal import guarded, say, say_json, tell, width
from atmosbox.errors import SettingError
from atmosbox.text.table import digits, measurement, number, table, wrapped

if TYPE_CHECKING:
    from atmosbox.plot.compare import Compared, Naming


class Comparison(StrEnum):
    """The formats of a comparison."""

    png = "png"
    svg = "svg"
    pdf = "pdf"
    html = "html"


@app.command(
    epilog=examples(
        "atmosbox compare cold.nc warm.nc",
        "atmosbox compare cold.nc mild.nc warm.nc --format pdf --theme slides",
        "atmosbox compare dry.nc moist.nc --out both.html",
    )
)
@guarded
def compare(
    files: Annotated[list[str], typer.Argument(metavar="FILE FILE...", help="Two to six runs.")],
    out: Annotated[str | None, out_option("The figure.  [default: beside FILE, named after all files]")] = None,
    format: Annotated[
        Comparison | None,
        typer.Option(
            help="The format, where the name of the figure does not say it; html is a page of two boxes with one clock."
        ),
    ] = None,
    theme: Annotated[Theme, typer.Option(help="For a page or for a screen.")] = Theme.notes,
    force: Force = False,
    as_json: Json = False,
    quiet: Annotated[bool, quiet_option("Print the path of the figure, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Lay runs over each other: one figure, and by how much their numbers differ.

    What is not the same in all of them is named, and nothing else.
    """
    if len(files) < 2:
        raise SettingError("FILE", None, "is given once", f"give a second run to compare {files[0]} with")
    from atmosbox.file.netcdf import read
    from atmosbox.file.output_path import check_writable

    kind = Path(out or "").suffix[1:].lower() if format is None else format.value
    path = beside(files, kind or "png") if out is None else Path(out)
    datasets = [read(file) for file in files]

    from atmosbox.plot.compare import compared, naming, save

    names = naming(datasets, [Path(file).stem for file in files])
    numbers = compared(datasets)
    if kind == "html":
        if len(files) > 2:
            pair = shlex.join(["atmosbox", "view", *files[:2]])
            raise SettingError("FILE", None, f"is given {len(files)} times, and a page shows two runs", f"type {pair}")
        from atmosbox.page import save as save_page

        check_writable(path, force)
        path = save_page(datasets, path, force=force)
    else:
        path = save(datasets, names, path, format and format.value, theme=theme.value, force=force)
    if names.same:
        tell(f"note: {' and '.join(files)} hold the same run")
    if as_json:
        say_json({"file": str(path), **as_record(files, names, numbers)})
    elif quiet:
        say(str(path))
    else:
        say("\n".join([*lines(files, names, numbers, width()), "", f"file: {path}"]))


def lines(files: Sequence[str], names: Naming, numbers: Sequence[Compared], columns: int) -> list[str]:
    """Return the comparison as text: what differs, and the numbers of all runs with their differences."""
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
        header = ["quantity", "run", "measured", "less the first", "by theory"]
    return [*made, *table(header, rows, columns)]


def _said(each: Compared, run: int) -> str:
    """Return a measurement of a run."""
    value, error = each.runs[run].value, each.runs[run].error
    if not math.isfinite(value):
        return "-"
    return measurement(value, error) if math.isfinite(error) else number(value)


def _changed(each: Compared, run: int) -> str:
    """Return the difference from the first run, with its standard error, and how many of these it is."""
    difference, error = each.difference(run), each.error(run)
    if not math.isfinite(difference):
        return "-"
    decimals, power = digits(difference, error)
    if decimals is None:
        return number(difference, sign="+") if difference else "0"
    shown = f"{number(difference, decimals, power, '+')} ± {number(error, decimals, power)}"
    return f"{shown} ({abs(each.sigma(run)):.1f}σ)"


def _expected(each: Compared, run: int) -> str:
    """Return the difference that theory expects, in the digits of the measured one."""
    expected = each.expected(run)
    if not math.isfinite(expected):
        return "-"
    return number(expected, *digits(each.difference(run), each.error(run)), "+") if expected else "0"


def as_record(files: Sequence[str], names: Naming, numbers: Sequence[Compared]) -> dict[str, Any]:
    """Return the comparison for JSON."""
    return {
        "same": names.same,
        "changes": {change.name: list(change.values) for change in names.changes},
        "runs": [
            {"file": file, "label": label, "scene": scene}
            for file, label, scene in zip(files, names.labels, names.scenes, strict=True)
        ],
        "headlines": [
            {
                "name": each.name,
                "label": each.label,
                "unit": each.unit,
                "runs": [
                    {
                        "value": run.value,
                        "standard_error": run.error,
                        "theory": run.theory,
                        "difference": each.difference(k),
                        "difference_standard_error": each.error(k) if k else math.nan,
                        "sigma": each.sigma(k) if k else math.nan,
                        "difference_by_theory": each.expected(k),
                    }
                    for k, run in enumerate(each.runs)
                ],
            }
            for each in numbers
        ],
    }

"""The command ``compare``: several runs in one figure, and a table of their numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import FigureFormat, Result, Theme, beside
from atmosbox.cli.terminal import tell, width
from atmosbox.errors import SettingError
from atmosbox.text.report import comparison_lines

if TYPE_CHECKING:
    from atmosbox.plot.compare import Compared, Naming


@command(
    "atmosbox compare cold.nc warm.nc",
    "atmosbox compare cold.nc mild.nc warm.nc --format pdf --theme slides",
    out="The figure.  [default: beside FILE, named after all files]",
    quiet="Print only the path of the figure.",
)
def compare(
    files: Annotated[list[str], typer.Argument(metavar="FILE FILE...", help="Two to six runs.")],
    to: Result,
    format: FigureFormat = None,
    theme: Theme = "notes",
) -> None:
    """Compare runs in one figure, and show by how much their numbers differ.

    Settings in which they differ are listed.
    """
    if len(files) < 2:
        raise SettingError("FILE", None, "is given once", f"give a second run to compare {files[0]} with")
    from atmosbox.file.netcdf import read

    path = to.path(beside(files, format or "png"))
    datasets = [read(file) for file in files]

    from atmosbox.plot.compare import compared, naming, save

    names = naming(datasets, [Path(file).stem for file in files])
    numbers = compared(datasets)
    path = save(datasets, names, path, format, theme=theme, force=to.force)
    if names.same:
        tell(f"note: {' and '.join(files)} hold the same run")
    lines = [*comparison_lines(files, names, numbers, width()), "", f"file: {path}"]
    to.say(path, {"file": str(path), **as_record(files, names, numbers)}, lines)


def as_record(files: Sequence[str], names: Naming, numbers: Sequence[Compared]) -> dict[str, Any]:
    """Return the comparison as a record for JSON."""
    named = zip(files, names.labels, names.scenes, strict=True)
    runs = [{"file": file, "label": label, "scene": scene} for file, label, scene in named]
    headlines = []
    for each in numbers:
        measured = [
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
        ]
        headlines.append({"name": each.name, "label": each.label, "unit": each.unit, "runs": measured})
    changes = {change.name: list(change.values) for change in names.changes}
    return {"same": names.same, "changes": changes, "runs": runs, "headlines": headlines}

"""The command ``export``: a run for other programs."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Output, RunFile, beside
from atmosbox.cli.terminal import say


@command(
    "atmosbox export temperature.nc --format extxyz",
    "atmosbox export lifting-dry.nc --format csv",
    out="The file.  [default: beside FILE, named after it]",
    quiet="Print only the path of the file.",
)
def export(
    file: RunFile,
    to: Output,
    format: Annotated[
        Literal["extxyz", "csv"] | None,
        typer.Option(help="extxyz holds the molecules, for OVITO and VMD; csv holds the tables, for a spreadsheet."),
    ] = None,
) -> None:
    """Write a run for OVITO, VMD or a spreadsheet.

    Molecules can be exported if the run kept them: small runs do, others with --save-molecules. CSV is one file for
    each dimension, such as NAME-elapsed_time.csv and NAME-height.csv, and NAME-headlines.csv.
    """
    from atmosbox.file.netcdf import read
    from atmosbox.file.output_path import check_writable, named, write_whole

    dataset = read(file)
    default = beside([file], format or "extxyz")
    if format == "csv" or (format is None and Path(to.out or "").suffix.lower() == ".csv"):
        from atmosbox.file.export import tables

        made = tables(dataset)

        def written(path: Path) -> list[Path]:
            stem = path.with_suffix("") if path.suffix.lower() == ".csv" else path
            return [stem.with_name(f"{stem.name}-{name}.csv") for name in made]

        paths = [check_writable(each, to.force) for each in written(to.path(default, written))]
        for place, content in zip(paths, made.values(), strict=True):
            write_whole(place, content)
        say("\n".join(map(str, paths)))
        return
    place, _ = named(to.path(default), format, ("extxyz", "csv"), force=to.force, what="box")
    from atmosbox.file.export import extended_xyz

    write_whole(place, extended_xyz(dataset))
    say(str(place))

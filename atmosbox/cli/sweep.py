"""The command ``sweep``: run a scene with many settings, save the runs, and print the results."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from atmosbox.cli.application import command, typed
from atmosbox.cli.option import (
    Accuracy,
    Engine,
    Force,
    Json,
    SceneName,
    ValuesOfAll,
    Verbose,
    out_option,
    quiet_option,
)
from atmosbox.cli.output_name import for_scene, netcdf_name, say_number
from atmosbox.cli.terminal import prints_to_stderr, say, say_json, tell, width
from atmosbox.errors import AtmosboxError, EngineError, PhysicsError, on_command_line
from atmosbox.text.progress import progress
from atmosbox.text.table import measurement, number, table, wrapped

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.sweep import Plan, Swept

_MOST_NAMED = 5
"""Largest number of failures that are printed one by one."""


@command(
    "atmosbox sweep condensation --vary temperature=-10degC:40degC:6 --members 8",
    "atmosbox sweep temperature --vary molecules=50:5000:5log --vary start=equal,maxwell",
    "atmosbox sweep lifting-dry --vary ascent=50,100,200,400 --scheduler tcp://10.0.0.1:8786",
)
def sweep(
    ctx: typer.Context,
    scene: Annotated[str, SceneName],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=A:B:N",
            help="A setting that varies: N values from A to B, with Nlog at even ratios, or the values X,Y,Z; any "
            "number of them make a grid.",
        ),
    ] = None,
    members: Annotated[str, typer.Option(metavar="N", help="Number of runs at each point.")] = "1",
    values: ValuesOfAll = None,
    seed: Annotated[
        str | None, typer.Option(metavar="N", help="Seed, from which that of each run is made.  [default: 1]")
    ] = None,
    engine: Engine = None,
    accuracy: Accuracy = None,
    jobs: Annotated[
        str | None, typer.Option(metavar="N", help="Number of processes.  [default: one for each core]")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Run on the workers of this Dask scheduler: tcp://host:8786."),
    ] = None,
    out: Annotated[str | None, out_option("The netCDF file.  [default: SCENE-sweep.nc in this folder]")] = None,
    force: Force = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show the points, compute nothing and write nothing.")
    ] = False,
    as_json: Json = False,
    quiet: Annotated[bool, quiet_option("Print the path of the file, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Run a scene with many settings: how its numbers depend on them.

    Every run is a file in a folder beside the one that joins them. A stopped sweep goes on where it was when the same
    command is typed again, and runs that are there are not repeated. `atmosbox plot` draws the joined file.
    """
    from atmosbox.file.output_path import unused
    from atmosbox.scene.spelling import assignments
    from atmosbox.sweep import SweepInterrupted, folder_of, is_taken, plan
    from atmosbox.sweep import sweep as run

    with prints_to_stderr():
        grid = plan(
            scene,
            vary or (),
            settings=assignments(values or ()),
            members=members,
            seed=seed,
            engine=engine,
            accuracy=accuracy,
        )
    default = for_scene(scene, "-sweep.nc")
    path = netcdf_name(default if out is None else Path(out))
    if out is None and not force:
        path = unused(default, lambda each: is_taken(each, grid))
        if not quiet:
            say_number(default, path)
    if dry_run:
        _describe(grid, path, as_json=as_json, quiet=quiet)
        return
    try:
        with prints_to_stderr(), progress(grid.scene, quiet=quiet) as show:
            swept = run(
                grid,
                path,
                jobs=jobs,
                scheduler=scheduler,
                force=force,
                progress=show,
                note=None if quiet else lambda text: tell(text if text.startswith("warning") else f"note: {text}"),
                command=typed(ctx),
            )
    except SweepInterrupted as stop:
        tell(f"stopped: {stop.saved} of {grid.runs} runs are saved in {folder_of(path)}, type the same again to go on")
        raise typer.Exit(stop.exit_code) from stop
    _say(grid, swept, path, as_json=as_json, quiet=quiet)
    _judge(grid, swept, path)


def _describe(grid: Plan, path: Path, *, as_json: bool, quiet: bool) -> None:
    """Print which runs the sweep would make."""
    names = [axis.name for axis in grid.axes]
    if as_json:
        points = [dict(grid.values(point)) for point in range(1, grid.points + 1)]
        facts = {"dry_run": True, "scene": grid.scene, "title": grid.title, "file": str(path), "runs": grid.runs}
        say_json({**facts, "members": grid.members, "settings": dict(grid.defaults), "points": points})
        return
    if quiet:
        say(str(path))
        return
    rows = [list(grid.typed(point)) for point in range(1, grid.points + 1)]
    lines = [
        f"{grid.scene}: {grid.title}",
        "",
        *table(names, rows, width()),
        "",
        f"runs: {grid.runs}, {grid.members} at each of {grid.points} points",
        f"file: {path} (not written: this is a dry run)",
    ]
    say("\n".join(lines))


def _say(grid: Plan, swept: Swept, path: Path, *, as_json: bool, quiet: bool) -> None:
    """Print the results."""
    from atmosbox.simulation.runner import LEDGER_LIMIT
    from atmosbox.text.report import ledger_line, next_command

    if as_json:
        made = {"scene": grid.scene, "file": str(path), "runs": grid.runs, "computed": swept.computed}
        failed = [{"point": point, "member": member, "reason": why} for point, member, why in swept.failures]
        say_json({**made, "failed": failed, "ledger": swept.ledger, "points": records(grid, swept.dataset)})
    elif quiet:
        say(str(path))
    else:
        said = lines(grid, swept.dataset, width())
        said += ["", ledger_line(swept.ledger, LEDGER_LIMIT), f"file: {path}", f"next: {next_command('plot', path)}"]
        say("\n".join(said))


def records(grid: Plan, dataset: xr.Dataset) -> list[dict[str, Any]]:
    """Return one record for each point, in SI units, for JSON."""
    names = _headlines(dataset)
    made = []
    for point in range(1, grid.points + 1):
        record: dict[str, Any] = {"settings": grid.values(point), "headlines": {}}
        for name in names:
            parts = {"mean": name, "standard_error": f"{name}_se", "theory": f"{name}_theory"}
            record["headlines"][name] = {
                part: float(dataset[key].values.ravel()[point - 1]) for part, key in parts.items() if key in dataset
            } | {"unit": str(dataset[name].attrs["units"])}
        made.append(record)
    return made


def lines(grid: Plan, dataset: xr.Dataset, columns: int) -> list[str]:
    """Return a table for each headline: at each point the mean of the members with its standard error, and theory."""
    from atmosbox.scene.conversion import from_si
    from atmosbox.sweep import FEWEST

    made = []
    for name in _headlines(dataset):
        unit = str(dataset[name].attrs["display_units"])
        known = f"{name}_theory" in dataset
        parts = [name, f"{name}_se", *([f"{name}_theory"] if known else [])]
        rows = []
        for point, found in enumerate(zip(*(dataset[part].values.ravel() for part in parts), strict=True), start=1):
            mean, error = from_si(float(found[0]), unit), from_si(float(found[1]), unit, difference=True)
            cells = [measurement(mean, error) if math.isfinite(mean) else "no run"]
            cells += [number(from_si(float(answer), unit)) for answer in found[2:]]
            rows.append([*grid.typed(point), *cells])
        shown = "" if unit == "1" else f" [{unit}]"
        made += [f"{dataset[name].attrs['long_name']}{shown}"]
        made += [*table([*(axis.name for axis in grid.axes), "measured", *["theory"] * known], rows, columns), ""]
    words = "measured: a single run ± its standard error"
    if grid.members > 1:
        source = "own error bars" if grid.members < FEWEST else "scatter"
        words = f"measured: mean of {grid.members} runs ± its standard error, from their {source}"
    return [*made, *wrapped(words, columns)]


def _headlines(dataset: xr.Dataset) -> list[str]:
    from atmosbox.file.provenance import parameters

    return [str(name) for name in parameters(dataset)["sweep"]["headlines"]]


def _judge(grid: Plan, swept: Swept, path: Path) -> None:
    """Raise the error of the sweep, if any run has failed."""
    from atmosbox.simulation.runner import LEDGER_LIMIT

    failed: AtmosboxError | None = None
    if swept.failures:
        named = [
            f"{grid.named(point)}, member {member} ({why.rstrip('.')})"
            for point, member, why in swept.failures[:_MOST_NAMED]
        ]
        more = len(swept.failures) - len(named)
        named += [f"and {more} more, see member_reason in the file"] if more else []
        failed = EngineError(
            f"{len(swept.failures)} of {grid.runs} runs failed and are missing in {path}: {'; '.join(named)}."
        )
    if not swept.ledger <= LEDGER_LIMIT:
        if failed is not None:
            tell(f"error: {failed.said(on_command_line)}")
        raise PhysicsError(
            f"The energy budget of a run of this sweep is off by {swept.ledger:.0e}, more than {LEDGER_LIMIT:.0e}: "
            f"see member_ledger in {path}."
        )
    if failed is not None:
        raise failed

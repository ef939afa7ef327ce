"""The command ``sweep``: run a scene with many settings, save the runs, and print the results."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from atmosbox.cli import option
from atmosbox.cli.application import command, typed
from atmosbox.cli.option import for_scene, netcdf_name, say_number
from atmosbox.cli.terminal import prints_to_stderr, say, say_json, tell, width
from atmosbox.errors import EngineError, PhysicsError
from atmosbox.text.progress import progress
from atmosbox.text.table import measurement, number, table, wrapped

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.sweep import Plan

_MOST_NAMED = 5
"""Largest number of failures that are printed one by one."""


@command(
    "atmosbox sweep condensation --vary temperature=-10degC:40degC:6 --members 8",
    "atmosbox sweep temperature --vary molecules=50:5000:5log --vary start=equal,maxwell",
    "atmosbox sweep lifting-dry --vary ascent=50,100,200,400 --scheduler tcp://10.0.0.1:8786",
)
def sweep(
    ctx: typer.Context,
    scene: Annotated[str, option.SceneName],
    vary: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=A:B:N",
            help="A setting that varies: N values from A to B in equal steps (Nlog: in equal ratios), or the values "
            "X,Y,Z. Several --vary make a grid.",
        ),
    ] = None,
    members: Annotated[str, typer.Option(metavar="N", help="Number of runs at each point.")] = "1",
    values: option.ValuesOfAll = None,
    seed: Annotated[
        str | None, typer.Option(metavar="N", help="Seed, from which that of each run is made.  [default: 1]")
    ] = None,
    engine: option.Engine = None,
    accuracy: option.Accuracy = None,
    jobs: Annotated[
        str | None, typer.Option(metavar="N", help="Number of processes.  [default: one for each core]")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Run on the workers of this Dask scheduler: tcp://host:8786."),
    ] = None,
    out: Annotated[str | None, option.out_option("The netCDF file.  [default: SCENE-sweep.nc in this folder]")] = None,
    force: option.Force = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show the points, compute nothing and write nothing.")
    ] = False,
    as_json: option.Json = False,
    quiet: Annotated[bool, option.quiet_option("Print only the path of the file.")] = False,
    verbose: option.Verbose = False,
) -> None:
    """Run a scene with many settings, to see how its results depend on them.

    Every run is a file in a folder, beside the file that joins them. To go on with a stopped sweep type the same
    command again: finished runs are not repeated. `atmosbox plot` draws the joined file.
    """
    from atmosbox.file.output_path import unused
    from atmosbox.scene.spelling import assignments
    from atmosbox.sweep import folder_of, is_taken, plan
    from atmosbox.sweep import sweep as run

    with prints_to_stderr():
        fixed = assignments(values or ())
        grid = plan(
            scene, vary or (), settings=fixed, members=members, seed=seed, engine=engine, accuracy=accuracy
        )  # fmt: skip
    default = for_scene(scene, "-sweep.nc")
    path = netcdf_name(default if out is None else Path(out))
    if out is None and not force:
        path = unused(default, lambda each: is_taken(each, grid))
        if not quiet:
            say_number(default, path)
    if dry_run:
        _describe(grid, path, as_json=as_json, quiet=quiet)
        return
    folder = folder_of(path)

    def saved() -> str:
        count = sum(Path(task.path).exists() for task in grid.tasks(folder))
        return f"{count} of {grid.runs} runs are saved in {folder}"

    if folder.exists() and not is_taken(path, grid) and not quiet:
        tell(f"note: {saved()}: going on with the rest")
    try:
        with prints_to_stderr(), progress(grid.scene, quiet=quiet) as show:
            found = run(grid, path, jobs=jobs, scheduler=scheduler, force=force, progress=show, command=typed(ctx))
    except KeyboardInterrupt:
        tell(f"{saved()}: type the same again to go on")
        raise
    _say(grid, found, path, as_json=as_json, quiet=quiet)


def _describe(grid: Plan, path: Path, *, as_json: bool, quiet: bool) -> None:
    """Print which runs the sweep would make."""
    points = range(1, len(grid.prepared) + 1)
    if as_json:
        facts = {"dry_run": True, "scene": grid.scene, "title": grid.title, "file": str(path), "runs": grid.runs}
        facts |= {"members": grid.members, "settings": dict(grid.defaults)}
        say_json({**facts, "points": [grid.values(point) for point in points]})
    elif quiet:
        say(str(path))
    else:
        lines = [f"{grid.scene}: {grid.title}", "", *table(list(grid.vary), [*map(grid.typed, points)], width()), ""]
        lines += [f"runs: {grid.runs}, {grid.members} at each of {len(points)} points"]
        say("\n".join([*lines, f"file: {path} (not written: this is a dry run)"]))


def _say(grid: Plan, found: xr.Dataset, path: Path, *, as_json: bool, quiet: bool) -> None:
    """Print the results, and raise an error if a run has failed or its energy budget is not closed."""
    from atmosbox.simulation.runner import LEDGER_LIMIT
    from atmosbox.text.report import ledger_line, next_command

    failed: list[dict[str, Any]] = [
        {"point": place // grid.members + 1, "member": place % grid.members + 1, "reason": str(reason)}
        for place, reason in enumerate(found.member_reason.values.flat if "member_reason" in found else ())
        if reason
    ]
    ledger = float(found.member_ledger.max().fillna(0.0))
    if as_json:
        about = {"scene": grid.scene, "file": str(path), "runs": grid.runs, "failed": failed, "ledger": ledger}
        say_json({**about, "points": records(grid, found)})
    elif quiet:
        say(str(path))
    else:
        last = [ledger_line(ledger, LEDGER_LIMIT), f"file: {path}", f"next: {next_command('plot', path)}"]
        say("\n".join([*lines(grid, found, width()), "", *last]))
    if not ledger <= LEDGER_LIMIT:
        raise PhysicsError(
            f"The energy budget of a run of this sweep is off by {ledger:.0e}, more than {LEDGER_LIMIT:.0e}: "
            f"see member_ledger in {path}."
        )
    if failed:
        named = []
        for each in failed[:_MOST_NAMED]:
            point = zip(grid.vary, grid.typed(each["point"]), strict=True)
            where = ", ".join(f"{name}={value}" for name, value in point)
            named.append(f"{where}, member {each['member']} ({each['reason'].rstrip('.')})")
        named += [f"and {len(failed) - len(named)} more"] if len(failed) > len(named) else []
        why = f"{len(failed)} of {grid.runs} runs failed and are missing in {path}, see member_reason there"
        raise EngineError(f"{why}: {'; '.join(named)}.")


def records(grid: Plan, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return one record for each point, in SI units, for JSON."""
    made = []
    for place in range(len(grid.prepared)):
        headlines = {}
        for name in _headlines(found):
            parts = {"mean": name, "standard_error": f"{name}_se", "theory": f"{name}_theory"}
            numbers = {part: float(found[key].values.flat[place]) for part, key in parts.items() if key in found}
            headlines[name] = numbers | {"unit": str(found[name].attrs["units"])}
        made.append({"settings": grid.values(place + 1), "headlines": headlines})
    return made


def lines(grid: Plan, found: xr.Dataset, columns: int) -> list[str]:
    """Return a table for each headline: at each point the mean of the members with its standard error, and theory."""
    from atmosbox.scene.conversion import from_si
    from atmosbox.sweep import FEWEST

    made = []
    for name in _headlines(found):
        unit = str(found[name].attrs["display_units"])
        theory = f"{name}_theory" in found
        rows = []
        for place in range(len(grid.prepared)):
            mean, error = (float(found[part].values.flat[place]) for part in (name, f"{name}_se"))
            shown = measurement(from_si(mean, unit), from_si(error, unit, difference=True))
            rows.append([*grid.typed(place + 1), shown if math.isfinite(mean) else "no run"])
            if theory:
                rows[-1].append(number(from_si(float(found[f"{name}_theory"].values.flat[place]), unit)))
        made += [f"{found[name].attrs['long_name']}{'' if unit == '1' else f' [{unit}]'}"]
        made += [*table([*grid.vary, "measured", *["theory"] * theory], rows, columns), ""]
    words = "measured: a single run ± its standard error"
    if grid.members > 1:
        source = "own error bars" if grid.members < FEWEST else "scatter"
        words = f"measured: mean of {grid.members} runs ± its standard error, from their {source}"
    return [*made, *wrapped(words, columns)]


def _headlines(found: xr.Dataset) -> list[str]:
    """Return the names of the headlines, in the order of the scene."""
    from atmosbox.file.provenance import parameters

    return [str(name) for name in parameters(found)["sweep"]["headlines"]]

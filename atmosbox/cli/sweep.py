"""The command ``sweep``: run a scene with many settings, save the runs, and print the results."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from atmosbox.cli import option
from atmosbox.cli.application import command, typed
from atmosbox.cli.option import Result, for_scene, netcdf_name, text
from atmosbox.cli.terminal import prints_to_stderr, tell, width
from atmosbox.errors import EngineError
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
    out="The netCDF file.  [default: SCENE-sweep.nc in this folder]",
    quiet="Print only the path of the file.",
    dry_run="Show the points, compute nothing and write nothing.",
)
def sweep(
    ctx: typer.Context,
    scene: Annotated[str, option.SceneName],
    to: Result,
    vary: Annotated[
        list[str] | None,
        text(
            "NAME=A:B:N",
            "A setting that varies: N values from A to B in equal steps (Nlog: in equal ratios), or the values X,Y,Z. "
            "Several --vary make a grid.",
        ),
    ] = None,
    members: Annotated[str, text("N", "Number of runs at each point.")] = "1",
    values: option.ValuesOfAll = None,
    seed: Annotated[str | None, text("N", "Seed from which the seeds of all runs are made.  [default: 1]")] = None,
    engine: option.Engine = None,
    accuracy: option.Accuracy = None,
    jobs: Annotated[str | None, text("N", "Number of processes.  [default: one for each core]")] = None,
    scheduler: Annotated[
        str | None, text("ADDRESS", "Run on the workers of this Dask scheduler: tcp://host:8786.")
    ] = None,
    dry_run: option.DryRun = False,
) -> None:
    """Run a scene with many settings, to see how its results depend on them.

    Each run is saved in a folder; one file beside it joins all runs. To go on with a stopped sweep type the same
    command again: finished runs are not repeated. `atmosbox plot` draws the joined file.
    """
    from atmosbox.scene.spelling import assignments
    from atmosbox.sweep import folder_of, is_taken, plan
    from atmosbox.sweep import sweep as run

    with prints_to_stderr():
        fixed = assignments(values or ())
        grid = plan(scene, vary or (), settings=fixed, members=members, seed=seed, engine=engine, accuracy=accuracy)
    default = netcdf_name(for_scene(scene, "-sweep.nc") if to.out is None else Path(to.out))
    path = to.numbered(default, lambda each: is_taken(each, grid)) if to.out is None else default
    if dry_run:
        return _describe(grid, path, to)
    folder = folder_of(path)

    def saved() -> str:
        count = sum(Path(task.path).exists() for task in grid.tasks(folder))
        return f"{count} of {grid.runs} runs are saved in {folder}"

    if folder.exists() and not is_taken(path, grid) and not to.quiet:
        tell(f"note: {saved()}: going on with the rest")
    try:
        with prints_to_stderr(), progress(grid.scene, quiet=to.quiet) as show:
            found = run(grid, path, jobs=jobs, scheduler=scheduler, force=to.force, progress=show, command=typed(ctx))
    except KeyboardInterrupt:
        tell(f"{saved()}: type the same command again to go on")
        raise
    _say(grid, found, path, to)


def _describe(grid: Plan, path: Path, to: Result) -> None:
    """Print which runs the sweep would make."""
    points = range(1, len(grid.prepared) + 1)
    record: dict[str, Any] = {"dry_run": True, "scene": grid.scene, "title": grid.title, "file": str(path)}
    record |= {"runs": grid.runs, "members": grid.members}
    record |= {"settings": dict(grid.defaults), "points": list(map(grid.values, points))}
    lines = [f"{grid.scene}: {grid.title}", "", *table(list(grid.vary), [*map(grid.typed, points)], width()), ""]
    lines += [f"runs: {grid.runs}, {grid.members} at each of {len(points)} points"]
    to.say(path, record, [*lines, f"file: {path} (not written: this is a dry run)"])


def _say(grid: Plan, found: xr.Dataset, path: Path, to: Result) -> None:
    """Print the results, and raise an error if a run has failed or its energy budget is not closed."""
    from atmosbox.simulation.verification import check_ledger
    from atmosbox.text.report import ledger_line, next_command

    failed: list[dict[str, Any]] = [
        {"point": place // grid.members + 1, "member": place % grid.members + 1, "reason": str(reason)}
        for place, reason in enumerate(found.member_reason.values.flat if "member_reason" in found else ())
        if reason
    ]
    ledger = float(found.member_ledger.max().fillna(0.0))
    record = {"scene": grid.scene, "file": str(path), "runs": grid.runs, "failed": failed, "ledger": ledger}
    last = [ledger_line(ledger), f"file: {path}", f"next: {next_command('plot', path)}"]
    to.say(path, record | {"points": records(grid, found)}, [*lines(grid, found, width()), "", *last])
    check_ledger(ledger, "a run of this sweep", f"see member_ledger in {path}")
    if failed:
        named = []
        for each in failed[:_MOST_NAMED]:
            point = zip(grid.vary, grid.typed(each["point"]), strict=True)
            where = ", ".join(f"{name}={value}" for name, value in point)
            named.append(f"{where}, member {each['member']} ({each['reason'].rstrip('.')})")
        named += [f"and {len(failed) - len(named)} more"] if len(failed) > len(named) else []
        why = f"{len(failed)} of {grid.runs} runs failed and are missing in {path}, see member_reason there"
        raise EngineError(f"{why}: {'; '.join(named)}.")


def _numbers(found: xr.Dataset, name: str, place: int) -> dict[str, float]:
    """Return mean, standard error and, if there is one, theory of a headline at a point, in SI units."""
    parts = {"mean": name, "standard_error": f"{name}_se", "theory": f"{name}_theory"}
    return {part: float(found[key].values.flat[place]) for part, key in parts.items() if key in found}


def records(grid: Plan, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return one record for each point, in SI units, for JSON."""
    units = {name: str(found[name].attrs["units"]) for name in _headlines(found)}
    return [
        {
            "settings": grid.values(place + 1),
            "headlines": {name: _numbers(found, name, place) | {"unit": unit} for name, unit in units.items()},
        }
        for place in range(len(grid.prepared))
    ]


def lines(grid: Plan, found: xr.Dataset, columns: int) -> list[str]:
    """Return a table for each headline: at each point the mean of the members with its standard error, and theory."""
    from atmosbox.scene.conversion import from_si
    from atmosbox.sweep import FEWEST

    made = []
    for name in _headlines(found):
        unit = str(found[name].attrs["display_units"])
        rows = []
        for place in range(len(grid.prepared)):
            mean, error, *theory = _numbers(found, name, place).values()
            shown = measurement(from_si(mean, unit), from_si(error, unit, difference=True))
            shown = shown if math.isfinite(mean) else "no run"
            rows.append([*grid.typed(place + 1), shown, *(number(from_si(each, unit)) for each in theory)])
        made += [f"{found[name].attrs['long_name']}{'' if unit == '1' else f' [{unit}]'}"]
        header = [*grid.vary, "measured", "theory"]
        made += [*table(header[: len(rows[0])], rows, columns), ""]
    words = "measured: a single run ± its standard error"
    if grid.members > 1:
        source = "own error bars" if grid.members < FEWEST else "scatter"
        words = f"measured: mean of {grid.members} runs ± its standard error, from their {source}"
    return [*made, *wrapped(words, columns)]


def _headlines(found: xr.Dataset) -> list[str]:
    """Return the names of the headlines, in the order of the scene."""
    from atmosbox.file.provenance import parameters

    return [str(name) for name in parameters(found)["sweep"]["headlines"]]

"""The command ``tradeoff``: measure speed against accuracy, and print and save the results."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from atmosbox.cli.application import command, typed
from atmosbox.cli.option import Result, SceneName, ValuesOfAll, for_scene, netcdf_name, text
from atmosbox.cli.terminal import INTERRUPTED, tell, width
from atmosbox.errors import Option
from atmosbox.text.progress import progress
from atmosbox.text.table import measurement, number, table, wrapped

if TYPE_CHECKING:
    import xarray as xr

_COLUMNS = ("wall_seconds", "engine_seconds", "cost", "members", "energy_drift", "ledger", "missed", "escaped")


@command(
    "atmosbox tradeoff lifting-dry",
    "atmosbox tradeoff atmosphere --budget 5min --set height=15km --out trade.nc",
    out="The netCDF file.  [default: SCENE-tradeoff.nc]",
    quiet="Print only the path of the file.",
)
def tradeoff(
    ctx: typer.Context,
    scene: Annotated[str, SceneName],
    to: Result,
    values: ValuesOfAll = None,
    budget: Annotated[str, text("TIME", "How long to measure.")] = "40s",
    seed: Annotated[str | None, text("N", "The first seed.  [default: 1]")] = None,
) -> None:
    """Measure speed against accuracy: errors and seconds of a scene on several engines and settings.

    Each engine and setting runs as often as the budget allows, at most 64 times, with different seeds; the engines are
    compiled first. Ctrl-C ends it early and keeps what was measured. If it was killed, type the same command again to
    go on.
    """
    from atmosbox.file.output_path import check_writable
    from atmosbox.plot.tradeoff_figure import recommended
    from atmosbox.scene.settings import Parameter
    from atmosbox.scene.spelling import assignments
    from atmosbox.text.report import next_command
    from atmosbox.trade.tradeoff import measure

    seconds = float(Parameter("budget", "s", 40.0, 1.0, 1e6, given_as=Option).parse(budget))
    first = int(Parameter("seed", "1", 1, 0, 2**62, kind="int", given_as=Option).parse(seed or "1"))

    path = check_writable(netcdf_name(to.path(for_scene(scene, "-tradeoff.nc"))), to.force)
    with progress(scene, quiet=to.quiet) as show:
        how: dict[str, Any] = {"budget": seconds, "seed": first, "out": path, "force": to.force, "command": typed(ctx)}
        note = None if to.quiet else lambda remark: tell(f"note: {remark}")
        found = measure(scene, settings=assignments(values or ()), progress=show, note=note, **how)
    records = rows(found)
    best = recommended(found)
    way = None if best is None else str(found.configuration.values[best[0]])
    about = {"scene": scene, "file": str(path), "recommended": way, "configurations": records}
    to.say(path, about, [*lines(found, width()), "", f"file: {path}", f"next: {next_command('plot', path)}"])
    if found.attrs["atmosbox_status"] == "interrupted":
        tell("stopped: what was measured is kept")
        raise typer.Exit(INTERRUPTED)


def rows(found: xr.Dataset) -> list[dict[str, object]]:
    """Return the measurement as records for JSON, one for each engine with its settings."""
    made = []
    for k, label in enumerate(found.configuration.values):
        record: dict[str, object] = {"run": str(label), "engine": str(found.engine.values[k])}
        record["settings"] = str(found.settings.values[k])
        record |= {name: found[name].values[k].item() for name in _COLUMNS}
        for q, name in enumerate(found.quantity.values):
            unit = "K" if str(found.unit.values[q]) == "K" else "share"
            for part in ("bias", "bias_se", "noise"):
                record[f"{name}_{part}_{unit}"] = found[part].values[k, q].item()
        record["left_out"] = str(found.left_out.values[k])
        made.append(record)
    return made


def lines(found: xr.Dataset, columns: int) -> list[str]:
    """Return the measurement as text: bias with its standard error, and in brackets the noise of a single run."""
    from atmosbox.plot.tradeoff_figure import WANTED, foremost, recommended

    chosen = foremost(found)
    header = ["run", "seconds", "cost", "runs"]
    header += [f"{found.label.sel(quantity=name).item()} [{_unit(found, name)}]" for name in chosen]
    body: list[list[str]] = []
    missing: dict[str, list[str]] = {}
    for k, label in enumerate(found.configuration.values):
        if why := str(found.left_out.values[k]):
            missing.setdefault(why, []).append(str(label))
        if not (members := int(found.members.values[k])):
            continue
        cells = [str(label), number(found.engine_seconds.values[k], 2), number(found.cost.values[k], 3), str(members)]
        for name in chosen:
            scale = 1.0 if _unit(found, name) == "K" else 100.0
            bias, se, noise = (
                scale * found[part].sel(quantity=name).values[k] for part in ("bias", "bias_se", "noise")
            )
            cells.append(f"{measurement(bias, se)} ({noise:.2g})" if math.isfinite(bias) else "-")
        body.append(cells)
    words = ["bias ± its standard error (noise of a single run); cost: 1 is the reference"]
    if (best := recommended(found)) is not None:
        head = f"recommended, the cheapest within {WANTED.limits}" if best[1] else "the most accurate"
        words += [f"{head}: {found.configuration.values[best[0]]}, {number(found.engine_seconds.values[best[0]], 2)} s"]
    words += [f"{why}: {'; '.join(labels)}" for why, labels in missing.items()]
    return [*table(header, body, columns), "", *(line for said in words for line in wrapped(said, columns))]


def _unit(found: xr.Dataset, name: str) -> str:
    """Return the unit in which the error of a quantity is shown."""
    return "K" if str(found.unit.sel(quantity=name).item()) == "K" else "%"

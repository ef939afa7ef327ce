"""The command ``tradeoff``: measure speed against accuracy, and print, save and draw the results."""

from __future__ import annotations

import csv
import io
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atmosbox.cli.application import command, typed
from atmosbox.cli.option import AllPanels, Force, Json, SceneName, ValuesOfAll, Verbose, out_option, quiet_option
from atmosbox.cli.output_name import chosen, for_scene, netcdf_name
from atmosbox.cli.terminal import INTERRUPTED, say, say_json, tell, width
from atmosbox.errors import Option
from atmosbox.text.progress import progress
from atmosbox.text.table import measurement, number, table, wrapped

if TYPE_CHECKING:
    import xarray as xr

_COLUMNS = ("wall_seconds", "engine_seconds", "cost", "members", "energy_drift", "ledger", "missed", "escaped")


@command(
    "atmosbox tradeoff lifting-dry",
    "atmosbox tradeoff atmosphere --budget 5min --set height=15km --out trade.nc",
)
def tradeoff(
    ctx: typer.Context,
    scene: Annotated[str, SceneName],
    values: ValuesOfAll = None,
    budget: Annotated[str, typer.Option(metavar="TIME", help="For how long to measure.")] = "60s",
    seed: Annotated[str | None, typer.Option(metavar="N", help="The first seed.  [default: 1]")] = None,
    out: Annotated[
        str | None, out_option("The netCDF file; .csv and .png stand beside it.  [default: SCENE-tradeoff.nc]")
    ] = None,
    all_panels: AllPanels = False,
    force: Force = False,
    as_json: Json = False,
    quiet: Annotated[bool, quiet_option("Print the path of the file, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Measure speed against accuracy: a scene through engines and settings, errors beside seconds.

    Every way of running is run again and again, with other seeds, while the budget lasts. Ctrl-C ends it
    early and keeps what was measured; what was killed goes on where it was when the same is typed again.
    """
    from atmosbox.file.netcdf import write
    from atmosbox.file.output_path import check_writable, write_whole
    from atmosbox.plot import save
    from atmosbox.plot.tradeoff_choice import recommended
    from atmosbox.scene.settings import Parameter
    from atmosbox.scene.spelling import assignments
    from atmosbox.trade.tradeoff import KeptRuns, measure

    seconds = float(Parameter("budget", "s", 60.0, 1.0, 1e6, given_as=Option).parse(budget))
    first = int(Parameter("seed", "1", 1, 0, 2**62, kind="int", given_as=Option).parse(seed or "1"))

    def written(path: Path) -> list[Path]:
        return [path, path.with_suffix(".csv"), path.with_suffix(".png")]

    default = for_scene(scene, "-tradeoff.nc")
    path = check_writable(netcdf_name(chosen(out, default, force=force, quiet=quiet, files=written)), force)
    files = [check_writable(each, force) for each in written(path)]
    with progress(scene, quiet=quiet) as show:
        found = measure(
            scene,
            settings=assignments(values or ()),
            budget=seconds,
            seed=first,
            progress=show,
            command=typed(ctx),
            out=path,
            force=force,
            note=None if quiet else lambda text: tell(f"note: {text}"),
        )
    write(found, path, force=force)
    write_whole(files[1], as_csv(found).encode())
    save(found, files[2], force=force, all_panels=all_panels)
    KeptRuns.remove(path)
    interrupted = found.attrs["atmosbox_status"] == "interrupted"
    if as_json:
        best = recommended(found)
        way = None if best is None else str(found.rung.values[best[0]])
        say_json({"scene": scene, "files": [str(file) for file in files], "recommended": way, "rungs": rows(found)})
    elif quiet:
        say(str(path))
    else:
        say("\n".join([*lines(found, width()), "", *(f"file: {file}" for file in files)]))
    if interrupted:
        tell("stopped: what was measured is kept")
        raise typer.Exit(INTERRUPTED)


def rows(found: xr.Dataset) -> list[dict[str, object]]:
    """Return the measurement as records for JSON and CSV, one for each engine with its settings."""
    made = []
    for k, label in enumerate(found.rung.values):
        record: dict[str, object] = {"run": str(label), "engine": str(found.engine.values[k])}
        record["settings"] = str(found.settings.values[k])
        record |= {name: _plain(found[name].values[k]) for name in _COLUMNS}
        for q, name in enumerate(found.quantity.values):
            unit = "K" if str(found.unit.values[q]) == "K" else "share"
            for part in ("bias", "bias_se", "noise"):
                record[f"{name}_{part}_{unit}"] = _plain(found[part].values[k, q])
        record["left_out"] = str(found.left_out.values[k])
        made.append(record)
    return made


def _plain(value: float) -> float | int | None:
    """Return a number as JSON can hold it."""
    if not math.isfinite(value):
        return None
    return int(value) if float(value).is_integer() and abs(value) < 1e9 else float(value)


def as_csv(found: xr.Dataset) -> str:
    """Return the measurement as a table of comma-separated values."""
    records = rows(found)
    stream = io.StringIO()
    writer = csv.DictWriter(stream, list(records[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(records)
    return stream.getvalue()


def lines(found: xr.Dataset, columns: int) -> list[str]:
    """Return the measurement as text: bias with its standard error, and in brackets the noise of a single run."""
    from atmosbox.plot.tradeoff_choice import WANTED, foremost, recommended

    chosen = foremost(found)
    header = ["run", "seconds", "cost", "runs"]
    header += [f"{found.label.sel(quantity=name).item()} [{_unit(found, name)}]" for name in chosen]
    body, notes = [], []
    for k, label in enumerate(found.rung.values):
        members = int(found.members.values[k])
        if not members:
            notes.append(f"{label}: {found.left_out.values[k]}")
            continue
        cells = [str(label), number(found.engine_seconds.values[k], 2), number(found.cost.values[k], 3), str(members)]
        for name in chosen:
            one = found.isel(rung=k).sel(quantity=name)
            scale = 1.0 if _unit(found, name) == "K" else 100.0
            if math.isfinite(one.bias.item()):
                shown = measurement(scale * one.bias.item(), scale * one.bias_se.item())
                cells.append(f"{shown} ({scale * one.noise.item():.2g})")
            else:
                cells.append("-")
        body.append(cells)
    words = "bias ± its standard error (noise of a single run); cost: 1 is the reference, all of the energy is kept"
    drift = found.energy_drift.values
    if (drift[drift == drift] > 1e-12).any():
        words = "bias ± its standard error (noise of a single run); cost: 1 is the reference"
    best, advice = recommended(found), ""
    if best is not None:
        head = f"recommended, the cheapest within {WANTED.limits}" if best[1] else "the most accurate"
        advice = f"{head}: {found.rung.values[best[0]]}, {number(found.engine_seconds.values[best[0]], 2)} s"
    return [
        *table(header, body, columns),
        "",
        *wrapped(words, columns),
        *wrapped(advice, columns),
        *(w for n in notes for w in wrapped(n, columns)),
    ]


def _unit(found: xr.Dataset, name: str) -> str:
    """Return the unit in which the error of a quantity is shown."""
    return "K" if str(found.unit.sel(quantity=name).item()) == "K" else "%"

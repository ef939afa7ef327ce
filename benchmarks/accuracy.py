"""How accurate a scene is, and what that costs, by engine and settings: the table that comes with atmosbox.

    python benchmarks/accuracy.py [SCENE ...] [--budget 60s]
    python benchmarks/accuracy.py FILE.nc ...                  from measurements of `atmosbox tradeoff`

`atmosbox.trade.tradeoff` measures every scene that declares series of runs: each way of running it as often as the
budget allows, with different seeds. For each headline the table holds the mean difference from theory (bias), its
standard error, and the standard deviation of a single run (noise), in K or as a share of the theory. For each way of
running it holds the processor time of the engine as a ratio to that of the scene's default run in the same measurement.
It also holds the seconds of the default run on the computer of the measurement.

The table leaves out ways that ran less than four times (the scatter of so few seeds says little), ways in which
molecules left the box, and ways whose energy budget did not close. Entries of scenes that are not named stay as they
are.
"""

import argparse
import json
import math
import os
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from atmosbox import scenarios  # noqa: E402
from atmosbox.errors import AtmosboxError  # noqa: E402
from atmosbox.file.netcdf import read  # noqa: E402
from atmosbox.file.provenance import parameters  # noqa: E402
from atmosbox.scene.settings import Parameter  # noqa: E402
from atmosbox.simulation.accuracy import said  # noqa: E402
from atmosbox.simulation.preparation import usual_engine  # noqa: E402
from atmosbox.simulation.runner import LEDGER_LIMIT  # noqa: E402
from atmosbox.trade import tradeoff  # noqa: E402
from atmosbox.trade.timed_run import PROFILES  # noqa: E402

TABLE = ROOT / "atmosbox" / "simulation" / "accuracy.json"
CURVES = set(PROFILES) - {"parcel_temperature"}
"""Curves that the table leaves out. That of a parcel is compared with the textbook's adiabat, and tells what a fast
ascent costs; the theory of its headlines includes that."""
FEWEST = 4
"""Least number of runs of a way in the table; the scatter of fewer says little."""


def varies(module: Any) -> list[str]:
    """Return the settings that the series of a scene vary, in order to trade accuracy for time."""
    own = {parameter.name for parameter in module.Settings.describe()}
    return sorted({series.vary for series in module.series} & own)


def ways(dataset: Any, module: Any) -> tuple[list[dict[str, Any]], float]:
    """Return the reliable ways of running a scene, each once, with their costs relative to the default run.

    The second result is the processor time of the engine in the default run [s].
    """
    names = [name for name in dataset.quantity.values if name not in CURVES]
    found: dict[str, dict[str, Any]] = {}
    for k in range(dataset.sizes["configuration"]):
        one = dataset.isel(configuration=k)
        members, why = int(one.members), str(one.left_out.values)
        if one.escaped > 0:
            why = "molecules left the box"
        elif one.ledger > LEDGER_LIMIT:
            why = "its energy budget does not close"
        elif members >= FEWEST and why.startswith("left out"):
            why = ""
        if why or members < FEWEST:
            print(f"  not in the table: {one.configuration.values}: {why or f'{members} runs, give a longer --budget'}")
            continue
        errors = {}
        for name in names:
            numbers = [float(one[part].sel(quantity=name)) for part in ("bias", "bias_se", "noise")]
            if all(map(math.isfinite, numbers)):
                errors[str(name)] = [float(f"{number:.4g}") for number in numbers]
        settings = module.Settings.from_user(json.loads(str(one.settings.values))).changed()
        way = {
            "engine": str(one.engine.values),
            "settings": settings,
            "cost": float(one.engine_seconds),
            "members": members,
            "errors": errors,
        }
        key = json.dumps([way["engine"], settings], sort_keys=True)
        if key not in found or found[key]["members"] < members:  # two series may share a run
            found[key] = way
    usual = usual_engine(module, module.Settings())
    default = found.get(json.dumps([str(usual), {}]))
    if default is None:
        raise AtmosboxError("The scene's default run did not run often enough: give a longer --budget.")
    seconds = default["cost"]
    for way in found.values():
        way["cost"] = float(f"{way['cost'] / seconds:.3g}")
    return list(found.values()), seconds


def measured(scene: str, budget: float, seed: int, command: str) -> Any:
    """Return the measurement of a scene."""
    last = -1

    def tell(share: float, word: str) -> None:
        nonlocal last
        if int(10 * share) > last:
            last = int(10 * share)
            print(f"  {100 * share:.0f} %: {word}", file=sys.stderr, flush=True)

    return tradeoff.measure(scene, budget=budget, seed=seed, progress=tell, command=command)


def entry_of(dataset: Any) -> tuple[str, dict[str, Any]]:
    """Return the scene of a measurement and its entry in the table."""
    made = parameters(dataset)
    scene = str(made["scene"])
    module = scenarios.load(scene)
    names = [str(name) for name in dataset.quantity.values if name not in CURVES]
    about = dataset.sel(quantity=names)
    measured_ways, seconds = ways(dataset, module)
    return scene, {
        "measured": {
            "version": dataset.attrs["product_version"],
            "budget": made["tradeoff"]["budget"],
            "command": dataset.attrs["history"].partition(": ")[2],
            "seconds": float(f"{seconds:.3g}"),
        },
        "varies": varies(module),
        "headlines": {
            name: {"label": str(label), "unit": str(unit), "theory": float(f"{theory:.6g}")}
            for name, label, unit, theory in zip(
                names, about.label.values, about.unit.values, about.theory.values, strict=True
            )
        },
        "ways": measured_ways,
    }


def printed(entry: dict[str, Any]) -> str:
    """Return an entry as a table."""
    heads = [f"{one['label']}, {'K' if one['unit'] == 'K' else '%'}" for one in entry["headlines"].values()]
    lines = [f"| run | cost | runs | {' | '.join(heads)} |", "|---" * (3 + len(heads)) + "|"]
    for way in entry["ways"]:
        cells = []
        for name, one in entry["headlines"].items():
            unit = 1.0 if one["unit"] == "K" else 100.0
            bias, error, noise = (unit * number for number in way["errors"].get(name, [math.nan] * 3))
            cells.append("-" if math.isnan(bias) else f"{bias:+.2g} ± {error:.1g}, noise {noise:.2g}")
        label = ", ".join([way["engine"], *(said(name, value) for name, value in way["settings"].items())])
        lines.append(f"| {label} | {way['cost']:g} | {way['members']} | {' | '.join(cells)} |")
    return "\n".join(lines)


def write(path: Path, scene: str, entry: dict[str, Any]) -> None:
    """Write the entry of a scene into the table; the file is replaced only when the new one is complete."""
    held = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {"scenes": {}}
    held["scenes"] = dict(sorted({**held["scenes"], scene: entry}.items()))
    hidden = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    hidden.write_text(json.dumps(held, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    os.replace(hidden, path)


def main(arguments: list[str] | None = None) -> None:
    """Measure, print the tables and save them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "sources", nargs="*", metavar="SCENE|FILE.nc", help="scenes or measurements; all that declare series by default"
    )
    parser.add_argument("--budget", default="60s", help="for how long each of them is measured")
    parser.add_argument("--seed", type=int, default=1, help="the first seed")
    parser.add_argument("--json", type=Path, default=TABLE, help="file for the table")
    asked = parser.parse_args(arguments)
    try:
        budget = float(Parameter("budget", "s", 60.0, 1.0, 1e6).parse(asked.budget))
        declared = [name for name in scenarios.names() if hasattr(scenarios.load(name), "series")]
        for source in asked.sources or declared:
            print(f"\n{source}", flush=True)
            command = f"python benchmarks/accuracy.py {source} --budget {asked.budget} --seed {asked.seed}"
            file = source.endswith(".nc")
            scene, entry = entry_of(read(source) if file else measured(source, budget, asked.seed, command))
            write(asked.json, scene, entry)
            print(printed(entry), flush=True)
    except AtmosboxError as error:
        sys.exit(f"error: {error}")


if __name__ == "__main__":
    main()

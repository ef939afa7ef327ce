"""Onset and growth of rolls in an ideal gas over sixty seeds, as the page of ``convection`` quotes them.

    python benchmarks/convection.py [--processes 2]

It runs a small box 60 times at each of five gravities on either side of the onset, and 60 times a larger box in which
rolls grow: about an hour of one processor. Each run is written into ``convection.json`` as soon as it ends. If the
command is stopped and given again it goes on with the runs that are missing; to measure all of them, delete the file.

At the onset the file keeps, of each run, the amplitude of the strongest roll in the last third of the run (root mean
square), as a multiple of its thermal noise in air at rest, and the Nusselt number. Beside them it has the Rayleigh
number and the growth rate of linear theory [1/s] at each gravity, and the gravity at which rolls neither grow nor decay
[m/s2]. Where rolls grow it keeps the growth rate of the strongest roll with its standard error and the rate of linear
theory [1/s], or null if no roll grew enough.
"""

import argparse
import json
import multiprocessing
import os
import signal
import sys
from pathlib import Path
from typing import Any

import numpy as np
from measured_on import machine
from scipy.optimize import brentq

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from atmosbox import theory  # noqa: E402
from atmosbox.scenarios import load  # noqa: E402
from atmosbox.simulation import runner  # noqa: E402
from atmosbox.text.progress import progress  # noqa: E402
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR  # noqa: E402
from atmosbox.version import __version__  # noqa: E402

TABLE = Path(__file__).with_suffix(".json")
SEEDS = range(1, 61)
GRAVITIES = (10.0, 14.0, 16.0, 18.0, 21.0)
"""Gravities on either side of the onset in the small box [m/s2]."""
SETTINGS: dict[str, dict[str, float]] = {
    "onset": {"molecules": 16_000, "width": 0.7, "duration": 800.0},
    "growth": {"molecules": 100_000, "duration": 500.0},
}
"""The settings of both boxes, on the engine dsmc; all others are the scene's."""
ABOUT = {"version": __version__, "engine": "dsmc", "settings": SETTINGS}
"""What must be the same for runs in one file."""


def known(gravity: float) -> dict[str, float]:
    """Return what linear theory says of the small box."""
    prepared = runner.prepare("convection", {**SETTINGS["onset"], "gravity": gravity}, engine="dsmc")
    box = prepared.module.Box(prepared.settings, prepared.engine)
    fastest = float(np.max(box.growth((box.floor, box.ceiling), box.gravity))) / box.scale.time
    return {"gravity": gravity, "rayleigh_number": theory.rayleigh_number(box.rest()), "growth_rate": fastest}


def linear_theory() -> dict[str, Any]:
    """Return what linear theory says at the five gravities, and the gravity of the onset [m/s2]."""
    onset = brentq(lambda gravity: known(gravity)["growth_rate"], 16.0, 18.0, xtol=0.01)
    return {"onset": round(onset, 2), "gravities": [short(known(gravity)) for gravity in GRAVITIES]}


def short(values: dict[str, Any]) -> dict[str, Any]:
    """Return numbers to five digits."""
    return {name: value and float(f"{value:.5g}") for name, value in values.items()}


def measured(settings: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Run a box; return its data, and its headlines by name."""
    outcome = runner.execute(runner.prepare("convection", settings, engine="dsmc"))
    return outcome.dataset, {each.name: each for each in outcome.headlines}


def onset(**settings: Any) -> dict[str, Any]:
    """Return how strong the strongest roll of a box is in the last third of the run, and how much heat passes."""
    dataset, found = measured(settings)
    late = dataset.isel(elapsed_time=slice(load("convection").SETTLE, None))
    noise = BOLTZMANN * float(late.air_temperature.mean()) / DRY_AIR.molecule_mass / settings["molecules"]
    strongest = float((late.roll_amplitude.values**2).mean(axis=0).max())
    return {"roll": (strongest / noise) ** 0.5, "nusselt_number": found["nusselt_number"].value}


def growth(**settings: Any) -> dict[str, Any]:
    """Return how fast the strongest roll of a box grows, with the error of this run and the rate of linear theory."""
    rate = measured(settings)[1].get("growth_rate")
    if rate is None:
        return {"rate": None}
    return {"rate": rate.value, "standard_error": rate.standard_error, "theory": rate.theory}


def once(asked: tuple[str, dict[str, Any]]) -> tuple[str, dict[str, Any]]:
    """Make one run of a kind; return the kind, and the run with its gravity and seed."""
    kind, given = asked
    found = {"onset": onset, "growth": growth}[kind](**SETTINGS[kind], **given)
    return kind, {**given, **short(found)}


def write(path: Path, beside: dict[str, Any], runs: dict[str, list[dict[str, Any]]]) -> None:
    """Write what has been measured, a run a line; the file is replaced only when the new one is complete."""
    lines = [f' "{name}": {json.dumps(each)},' for name, each in (ABOUT | {"measured_on": machine()}).items()]
    held = [f'  "theory": {json.dumps(beside)}']
    for name, each in runs.items():
        rows = sorted(each, key=lambda run: (run.get("gravity", 0.0), run["seed"]))
        held.append(f'  "{name}": [\n   ' + ",\n   ".join(map(json.dumps, rows)) + "\n  ]")
    hidden = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    body = ",\n".join(held)
    hidden.write_text("\n".join(["{", *lines, f' "results": {{\n{body}\n }}', "}", ""]), encoding="utf-8")
    os.replace(hidden, path)


def main(arguments: list[str] | None = None) -> None:
    """Make the runs that are missing in the file."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--json", type=Path, default=TABLE, help="file for the numbers")
    parser.add_argument("--processes", type=int, default=1, help="how many runs are made at a time")
    asked = parser.parse_args(arguments)
    path, beside, runs = asked.json, None, {"onset": [], "growth": []}
    if path.exists():
        held = json.loads(path.read_text(encoding="utf-8"))
        if {name: held[name] for name in ABOUT} != ABOUT:
            sys.exit(f"error: {path} is of another version or has other settings; delete it to measure again")
        beside, runs = held["results"].pop("theory"), held["results"]
    done = {(kind, run.get("gravity"), run["seed"]) for kind, each in runs.items() for run in each}
    wanted = [
        (kind, {} if gravity is None else {"gravity": gravity}, seed)
        for seed in SEEDS
        for kind, gravity in (*(("onset", gravity) for gravity in GRAVITIES), ("growth", None))
        if (kind, gravity, seed) not in done
    ]
    # a run in which rolls grow takes as long as six at the onset
    cost = {"onset": 1.0 / 11.0 / len(SEEDS), "growth": 6.0 / 11.0 / len(SEEDS)}
    share = sum(cost[kind] for kind, *_ in done)
    pool = multiprocessing.get_context("spawn").Pool(asked.processes, signal.signal, (signal.SIGINT, signal.SIG_IGN))
    try:
        with progress("convection", quiet=False) as show, pool:
            beside = beside or linear_theory()
            show(share, "running")
            for kind, run in pool.imap_unordered(once, [(kind, {**at, "seed": seed}) for kind, at, seed in wanted]):
                runs[kind].append(run)
                write(path, beside, runs)
                share += cost[kind]
                show(share, "running")
    except KeyboardInterrupt:
        print("stopped; the same command goes on with the runs that are missing", file=sys.stderr)
        sys.exit(130)
    print(f"{path}: {len(runs['onset'])} runs at the onset, {len(runs['growth'])} in which rolls grow")


if __name__ == "__main__":
    main()

"""What a class waits for: whole processes of ``atmosbox run SCENE``, and what their time goes into.

    python benchmarks/scenes.py
    python benchmarks/scenes.py lifting-dry temperature --against FOLDER --repeats 5
    python benchmarks/scenes.py --cold

Each run is a process of its own, as when a user starts it. The processor time of the whole process is divided into
start-up (until the scene is known), compilation (in a warm run, loading of stored machine code), building and measuring
the box, kernels (compiled code), and theory and files; the rest is the end of Python itself. FOLDER is an older
checkout, whose runs take turns with ours; the ratio is the median over pairs. With ``--cold`` each run has an empty
cache.
"""

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np
from measured_on import keep

ROOT = Path(__file__).resolve().parents[1]
PARTS = ("start", "compile", "build", "kernel", "files")

INSIDE = """
import sys, time, json
def now():
    return time.process_time()
spent = {"start": 0.0, "compile": 0.0, "build": 0.0, "kernel": 0.0, "files": 0.0}
doing, since = ["start"], [0.0]
def begin(what):
    t = now(); spent[doing[-1]] += t - since[0]; since[0] = t; doing.append(what)
def end():
    t = now(); spent[doing.pop()] += t - since[0]; since[0] = t
def become(what):
    t = now(); spent[doing[-1]] += t - since[0]; since[0] = t; doing[-1] = what
def within(holder, name, what):
    inner = getattr(holder, name)
    def outer(*given, **named):
        begin(what)
        try:
            return inner(*given, **named)
        finally:
            end()
    setattr(holder, name, outer)
import numba.core.dispatcher as dispatcher
from atmosbox.simulation import recording, runner
within(dispatcher.Dispatcher, "compile", "compile")
within(runner, "build", "build")
within(recording.Recording, "advance", "build")
within(recording.Recording, "dataset", "files")
try:
    from atmosbox.engine.core.jit import Kernel
    within(Kernel, "__call__", "kernel")
except ImportError:
    pass
inner = runner.execute
def execute(*given, **named):
    begin("files")
    try:
        return inner(*given, **named)
    finally:
        end()
        become("files")
runner.execute = execute
from atmosbox.cli import main
sys.argv = ["atmosbox", *sys.argv[1:]]
try:
    main()
finally:
    end()
    json.dump(spent, sys.stderr)
"""


def timed(root: Path, scene: str, settings: list[str], cache: str | None) -> dict[str, float]:
    """Run a scene with a checkout in a process of its own; return CPU and wall seconds, and the parts of CPU time."""
    environment = {**os.environ, "PYTHONPATH": str(root)} | ({"NUMBA_CACHE_DIR": cache} if cache else {})
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-c", INSIDE, "run", scene, "--out", f"{folder}/run.nc", "--quiet"]
        command += [word for each in settings for word in ("--set", each)]
        before, began = os.times(), time.perf_counter()
        done = subprocess.run(command, env=environment, cwd=folder, capture_output=True, text=True, check=False)
        wall, after = time.perf_counter() - began, os.times()
    if done.returncode:
        raise SystemExit(f"atmosbox run {scene} in {root} failed:\n{done.stderr}")
    parts = json.loads(done.stderr.splitlines()[-1])
    cpu = after.children_user - before.children_user + after.children_system - before.children_system
    return {"cpu": cpu, "wall": wall, **parts}


def measure(
    scene: str, roots: list[Path], settings: list[str], repeats: int, cold: bool
) -> list[dict[str, list[float]]]:
    """Run a scene several times with all checkouts in turn; return their times."""
    found: list[dict[str, list[float]]] = [{key: [] for key in ("cpu", "wall", *PARTS)} for _ in roots]
    if not cold:
        for root in roots:  # compile now, so that the runs that count do not compile
            timed(root, scene, settings, None)
    for _ in range(repeats):
        for k in random.sample(range(len(roots)), len(roots)):
            with tempfile.TemporaryDirectory() as cache:
                one = timed(roots[k], scene, settings, cache if cold else None)
            for key, values in found[k].items():
                values.append(one[key])
    return found


def main(arguments: list[str] | None = None) -> list[dict[str, Any]]:
    """Run the scenes asked for and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", help="which scenes; all that come with atmosbox if none is named")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a setting of all runs")
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--cold", action="store_true", help="with an empty cache each time")
    parser.add_argument("--against", type=Path, help="folder of an older checkout, to take turns with")
    parser.add_argument("--json", type=Path, help="file for the numbers")
    asked = parser.parse_args(arguments)
    if not asked.scenes:
        sys.path.insert(0, str(ROOT))
        from atmosbox import scenarios

        asked.scenes = list(scenarios.names())
    roots = [ROOT, asked.against.resolve()] if asked.against else [ROOT]
    print("| scene | CPU | wall | start | compile | build | kernel | files | other CPU | ratio |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    results = []
    for scene in asked.scenes:
        found = measure(scene, roots, asked.set, asked.repeats, asked.cold)
        result: dict[str, Any] = {"scene": scene, "cold": asked.cold, "settings": asked.set}
        result |= {key: float(np.median(values)) for key, values in found[0].items()}
        beside = "| "
        if asked.against:
            result["other_cpu"] = float(np.median(found[1]["cpu"]))
            result["ratio"] = float(np.median(np.array(found[0]["cpu"]) / np.array(found[1]["cpu"])))
            beside = f"{result['other_cpu']:.2f} | {result['ratio']:.2f}"
        results.append(result)
        shares = " | ".join(f"{result[key]:.2f}" for key in ("cpu", "wall", *PARTS))
        print(f"| {scene} | {shares} | {beside} |", flush=True)
    keep(asked.json, results)
    return results


if __name__ == "__main__":
    main()

"""The pace of the time-stepped engine: molecule-steps per CPU second, alone or beside another engine in the same run.

    python benchmarks/stepped.py
    python benchmarks/stepped.py --against FOLDER --repeats 9

The gas is equal spheres in gravity between two heat baths. Machines are noisy: use the ratio of two engines that take
turns, the median over many short slices. FOLDER contains a module ``stepped.py`` with ``Sim(N, phi, delta, mgH=...,
thermal=...)``, which places N equal spheres itself, and advances them by ``go(steps)``.
"""

import argparse
import gc
import importlib
import math
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from measured_on import keep

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from atmosbox.engine import CoarseStepWarning, HeatBath, Specular, maxwell_velocities, random_positions
from atmosbox.engine.stepped.stepped_parcel import SteppedParcel

WARM_UP = 70
HEIGHT = 1.0  # height of the box, in scale heights


def column(n: int, phi: float, delta: float) -> SteppedParcel:
    """Return a column of equal spheres."""
    side = (n * math.pi / 6.0 / phi) ** (1.0 / 3.0)
    rng = np.random.default_rng(1)
    x = random_positions((side,) * 3, np.ones(n), rng)
    v = maxwell_velocities(1.0, np.ones(n), rng, exact=True)
    walls = (Specular(),) * 4 + (HeatBath(1.0),) * 2
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CoarseStepWarning)
        return SteppedParcel(
            x, v, length=(side,) * 3, walls=walls, gravity=HEIGHT / side, delta=delta
        )  # fmt: skip


def pace(advance: Callable[[int], Any], steps: int, n: int) -> float:
    """Return the molecule-steps per second of one slice."""
    start = time.process_time()
    advance(steps)
    return steps * n / (time.process_time() - start)


def measure(n: int, phi: float, delta: float, repeats: int, other: Any) -> dict[str, Any]:
    """Return the medians of one case."""
    box = column(n, phi, delta)

    def advance(steps: int) -> None:
        box.advance((box.steps + steps) * box.time_step)

    advance(WARM_UP)
    theirs = other.Sim(n, phi, delta, mgH=HEIGHT, thermal=True) if other else None
    if theirs:
        theirs.go(WARM_UP)
    slice_ = max(4, 2_000_000 // n)
    paces, others = [], []
    gc.disable()
    for _ in range(repeats):
        paces.append(pace(advance, slice_, n))
        if theirs:
            others.append(pace(theirs.go, slice_, n))
    gc.enable()
    result = {
        "packing_fraction": phi,
        "delta": delta,
        "molecules": n,
        "threads": 1,
        "molecule_steps_per_second": float(np.median(paces)),
        "bytes_per_molecule": box.memory() / n,
        "contacts_per_molecule_step": box.contacts / (n * box.steps),
    }
    if theirs:
        result["other_molecule_steps_per_second"] = float(np.median(others))
        result["ratio"] = float(np.median(np.array(paces) / np.array(others)))
    return result


def main(arguments: list[str] | None = None) -> list[dict[str, Any]]:
    """Run the cases asked for and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, nargs="+", default=[10_000, 100_000, 1_000_000])
    parser.add_argument("--phi", type=float, nargs="+", default=[0.01, 0.1])
    parser.add_argument("--delta", type=float, nargs="+", default=[0.02, 0.1])
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--against", type=Path, help="folder of another engine, to take turns with")
    parser.add_argument("--json", type=Path, help="file for the numbers")
    asked = parser.parse_args(arguments)
    other = None
    if asked.against:
        sys.path.insert(0, str(asked.against))
        sys.modules.pop("stepped", None)
        other = importlib.import_module("stepped")
    print("| phi | delta | N | million molecule-steps / s | other | ratio | bytes per molecule |")
    print("|---|---|---|---|---|---|---|")
    results = []
    for phi in asked.phi:
        for n in asked.n:
            for delta in asked.delta:
                r = measure(n, phi, delta, asked.repeats, other)
                results.append(r)
                beside = f"{r['other_molecule_steps_per_second'] / 1e6:.1f} | {r['ratio']:.3f}" if other else " | "
                print(
                    f"| {phi:g} | {delta:g} | {n} | {r['molecule_steps_per_second'] / 1e6:.1f} "
                    f"| {beside} | {r['bytes_per_molecule']:.0f} |",
                    flush=True,
                )
    keep(asked.json, results)
    return results


if __name__ == "__main__":
    main()

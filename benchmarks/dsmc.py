"""The pace of direct simulation Monte Carlo: million molecules moved per second, alone or beside another engine.

    python benchmarks/dsmc.py
    python benchmarks/dsmc.py --threads 1 2 --against FOLDER --repeats 9

The gas is in gravity between two heat baths; the box is two scale heights high. A cell holds ten molecules, its side is
half a mean free path, and a step is 0.14 mean free times. Machines are noisy: use the ratio of two engines that take
turns, the median over many short slices; CPU time on one thread, wall time on several.
FOLDER contains a module ``dsmc.py`` with ``Sim(N, T, par, mgH, thermal, ppc)``, which advances N molecules on T threads
by ``go(steps)``, in parallel if ``par`` is true, and counts collisions in ``out[thread, 1]``.
"""

import argparse
import gc
import importlib
import math
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from measured_on import keep

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from atmosbox.engine import HeatBath, Periodic, Specular
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel

OCCUPANCY, PATH, STEP, HEIGHTS = 10.0, 2.0, 0.14, 2.0  # molecules, cell sides, mean free times, scale heights
SIDES = {"specular": (Specular(),) * 4, "periodic": (Periodic(),) * 4}


class Ours:
    """Our engine."""

    def __init__(self, n: int, threads: int, sides: str) -> None:
        side = float(max(2, round((n / OCCUPANCY) ** (1.0 / 3.0))))
        sigma = math.sqrt(1.0 / (math.sqrt(2.0) * n / side**3 * PATH * math.pi))
        rng = np.random.default_rng(1)
        x = rng.random((n, 3))
        x[:, 2] = -np.log1p(-x[:, 2] * -math.expm1(-HEIGHTS)) / HEIGHTS
        x *= side - sigma
        x += 0.5 * sigma
        self.box = DsmcParcel(
            x, rng.normal(size=(n, 3)), length=(side,) * 3, walls=(*SIDES[sides], HeatBath(1.0), HeatBath(1.0)),
            diameter=sigma, gravity=HEIGHTS / side, dt=STEP, occupancy=OCCUPANCY, threads=threads,
        )  # fmt: skip

    def go(self, steps: int) -> None:
        """Advance by a number of steps."""
        self.box.advance((self.box.steps + steps) * self.box.time_step)

    def contacts(self) -> int:
        """Return the number of collisions so far."""
        return self.box.contacts


class Theirs:
    """Another engine, from the folder named on the command line."""

    def __init__(self, module: Any, n: int, threads: int) -> None:
        self.sim = module.Sim(n, threads, threads > 1, mgH=HEIGHTS, thermal=True, ppc=int(OCCUPANCY))

    def go(self, steps: int) -> None:
        """Advance by a number of steps."""
        self.sim.go(steps)

    def contacts(self) -> int:
        """Return the number of collisions so far."""
        return int(self.sim.out[:, 1].sum())


def times(go: Callable[[int], None], steps: int) -> tuple[float, float]:
    """Return CPU and wall time of a number of steps [s]."""
    cpu, wall = time.process_time(), time.perf_counter()
    go(steps)
    return time.process_time() - cpu, time.perf_counter() - wall


def measure(n: int, threads: int, sides: str, repeats: int, other: Any) -> dict[str, Any]:
    """Return the medians of one case."""
    ours = Ours(n, threads, sides)
    theirs = Theirs(other, n, threads) if other else None
    steps = 32 * max(1, 100_000 // n)  # a multiple of the steps between two sortings
    for engine in filter(None, (ours, theirs)):
        engine.go(33)
    rows, others = [], []
    before, marched = ours.contacts(), ours.box.steps
    gc.disable()
    for _ in range(repeats):
        rows.append(times(ours.go, steps))
        if theirs:
            others.append(times(theirs.go, steps))
    gc.enable()
    moves = n * steps
    cpu, wall = np.array(rows).T
    result = {
        "molecules": n,
        "threads": threads,
        "sides": sides,
        "moves_per_cpu_second": float(np.median(moves / cpu)),
        "moves_per_second": float(np.median(moves / wall)),
        "collisions_per_move": (ours.contacts() - before) / (n * (ours.box.steps - marched)),
        "bytes_per_molecule": ours.box.memory() / n,
    }
    if theirs:
        other_cpu, other_wall = np.array(others).T
        result["other_moves_per_cpu_second"] = float(np.median(moves / other_cpu))
        result["other_moves_per_second"] = float(np.median(moves / other_wall))
        result["ratio_cpu"] = float(np.median(other_cpu / cpu))
        result["ratio"] = float(np.median(other_wall / wall))
    return result


def main(arguments: list[str] | None = None) -> list[dict[str, Any]]:
    """Run the cases asked for and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, nargs="+", default=[10_000, 100_000, 1_000_000])
    parser.add_argument("--threads", type=int, nargs="+", default=[1])
    parser.add_argument("--sides", nargs="+", default=["specular"], choices=sorted(SIDES))
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--against", type=Path, help="folder of another engine, to take turns with")
    parser.add_argument("--json", type=Path, help="file for the numbers")
    asked = parser.parse_args(arguments)
    other = None
    if asked.against:
        sys.path.insert(0, str(asked.against))  # before this folder, whose dsmc.py runs as __main__
        other = importlib.import_module("dsmc")
    print(
        "| sides | threads | N | million moves / CPU s | per s | collisions / move | bytes | other | per s | ratios |"
    )
    print("|---|---|---|---|---|---|---|---|---|---|")
    results = []
    for sides in asked.sides:
        for threads in asked.threads:
            for n in asked.n:
                r = measure(n, threads, sides, asked.repeats, other)
                results.append(r)
                beside = " | | "
                if other:
                    beside = (
                        f"{r['other_moves_per_cpu_second'] / 1e6:.1f} | {r['other_moves_per_second'] / 1e6:.1f} | "
                        f"{r['ratio_cpu']:.3f} {r['ratio']:.3f}"
                    )
                print(
                    f"| {sides} | {threads} | {n} | {r['moves_per_cpu_second'] / 1e6:.1f} | "
                    f"{r['moves_per_second'] / 1e6:.1f} | {r['collisions_per_move']:.4f} | "
                    f"{r['bytes_per_molecule']:.0f} | {beside} |",
                    flush=True,
                )
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    print(f"\nMost memory of the process, Python and what the start is made from included: {peak / 1e9:.2f} GB")
    keep(asked.json, results)
    return results


if __name__ == "__main__":
    main()

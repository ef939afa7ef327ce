"""The pace of the exact engine: collisions per CPU second, alone or beside another engine in the same run.

    python benchmarks/engine.py
    python benchmarks/engine.py --against FOLDER --repeats 9

Machines are noisy: use the ratio of two engines that take turns, the median over many short slices.
FOLDER is a checkout of another commit of atmosbox, whose engine runs in a second process. Or it contains a module
``exact.py`` with ``make(PX, PZ, GRAV, THERM, K)``, which returns kernels, and ``Sim(kernels, X, V, L, g, m, PX, PZ)``,
which advances equal spheres of unit diameter by ``go(nc=collisions)`` and counts the collisions in ``cnt[0]``.
"""

import argparse
import gc
import importlib
import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from measured_on import keep

sys.path.insert(0, os.environ.get("ATMOSBOX_CHECKOUT", str(Path(__file__).resolve().parents[1])))

from atmosbox.engine import HeatBath, ParcelSet, Periodic

RATE = {0.01: 0.138854, 0.1: 1.765845, 0.3: 9.6, 0.49: 32.0}  # collisions of a molecule per reduced time, about


class Ours:
    """Our engine in a periodic box, or in gravity between two heat baths."""

    def __init__(self, x: np.ndarray, v: np.ndarray, side: float, gravity: float) -> None:
        ends = (HeatBath(1.0), HeatBath(1.0)) if gravity else (Periodic(), Periodic())
        self.box = ParcelSet(x, v, length=(side,) * 3, walls=(Periodic(),) * 4 + ends, gravity=gravity)

    def advance(self, collisions: int) -> int:
        """Advance by about a number of collisions; return how many there were."""
        before = self.box.contacts
        rate = self.box.contacts / self.box.time if self.box.time else 0.0
        self.box.advance(self.box.time + (collisions / rate if rate else 1e-3))
        return self.box.contacts - before

    def warm_up(self, time: float) -> None:
        """Advance to a time, so that the engine is compiled and the rate of collisions is known."""
        self.box.advance(time)


class Checkout:
    """The engine of another checkout, in a process of its own, which computes only on request."""

    def __init__(self, folder: Path, x: np.ndarray, v: np.ndarray, side: float, gravity: float) -> None:
        with tempfile.TemporaryDirectory() as place:
            start = Path(place) / "start.npz"
            np.savez(start, x=x, v=v, side=side, gravity=gravity)
            self.process = subprocess.Popen(
                [sys.executable, str(Path(__file__).resolve()), "--serve", str(start)],
                env=os.environ | {"ATMOSBOX_CHECKOUT": str(folder), "PYTHONPATH": str(folder)},
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=folder,
            )  # fmt: skip
            self.warm = self._ask(0)

    def _ask(self, collisions: int) -> float:
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        print(collisions, file=self.process.stdin, flush=True)
        return float(self.process.stdout.readline())

    def pace(self, collisions: int) -> float:
        """Return the collisions per CPU second of one slice."""
        return self._ask(collisions)

    def close(self) -> None:
        """End the process."""
        self.process.communicate()


def serve(start: Path) -> None:
    """Advance the box of a file by the number of collisions on each line of the input; print the pace each time."""
    with np.load(start) as told:
        ours = Ours(told["x"], told["v"], float(told["side"]), float(told["gravity"]))
    n = ours.box.number
    for line in sys.stdin:
        if int(line):
            print(pace(ours.advance, int(line)), flush=True)
        else:
            ours.warm_up(4.0 / RATE.get(round(n * math.pi / 6.0 / ours.box.volume, 3), 1.0))
            print(0.0, flush=True)


class Theirs:
    """Another engine, from the folder named on the command line."""

    def __init__(self, module: Any, x: np.ndarray, v: np.ndarray, side: float, gravity: float, phi: float) -> None:
        walled = bool(gravity)
        kernels = module.make(PX=True, PZ=not walled, GRAV=walled, THERM=walled, K=32)
        self.sim = module.Sim(
            kernels, x.copy(), v.copy(), np.array([side] * 3), g=gravity, m=4.0 if phi < 0.05 else 2.5,
            PX=True, PZ=not walled,
        )  # fmt: skip

    def pace(self, collisions: int) -> float:
        """Return the collisions per CPU second of one slice."""
        return pace(self.advance, collisions)

    def close(self) -> None:
        """Do nothing: it runs in this process."""

    def advance(self, collisions: int) -> int:
        """Advance by a number of collisions; return how many there were."""
        before = int(self.sim.cnt[0])
        self.sim.go(nc=collisions)
        return int(self.sim.cnt[0]) - before


def pace(advance: Callable[[int], int], collisions: int) -> float:
    """Return collisions per CPU second of one slice."""
    start = time.process_time()
    done = advance(collisions)
    return done / (time.process_time() - start)


def start_of(n: int, phi: float, *, walled: bool) -> tuple[np.ndarray, np.ndarray, float]:
    """Return positions, velocities and the side of the box: random positions or, in a dense gas, a lattice."""
    from atmosbox.engine import maxwell_velocities, random_positions

    side = (n * math.pi / 6.0 / phi) ** (1.0 / 3.0)
    rng = np.random.default_rng(1)
    if phi <= 0.3:
        x = random_positions((side,) * 3, np.ones(n), rng, periodic=(True, True, not walled))
    else:
        # the face-centred cubic lattice, with vacancies
        cubes = math.ceil((n / 4.0) ** (1.0 / 3.0))
        corner = np.stack(np.meshgrid(*[np.arange(cubes)] * 3, indexing="ij"), axis=-1).reshape(-1, 1, 3)
        sites = np.array([[0.25, 0.25, 0.25], [0.75, 0.75, 0.25], [0.75, 0.25, 0.75], [0.25, 0.75, 0.75]])
        x = (corner + sites).reshape(-1, 3) * side / cubes
        x = x[np.sort(rng.permutation(len(x))[:n])]
        if walled:  # move the lattice between floor and ceiling; it is compressed so little that no molecules overlap
            low, high = x[:, 2].min(), x[:, 2].max()
            x[:, 2] = 0.501 + (x[:, 2] - low) * (side - 1.002) / (high - low)
    return x, maxwell_velocities(1.0, np.ones(n), rng, exact=True), side


def measure(n: int, phi: float, case: str, repeats: int, other: Any) -> dict[str, Any]:
    """Return the medians of one case; ``other`` is a module or the folder of a checkout, or None."""
    walled = case == "gravity"
    x, v, side = start_of(n, phi, walled=walled)
    gravity = 1.0 / side if walled else 0.0
    ours = Ours(x, v, side, gravity)
    ours.warm_up(4.0 / RATE.get(phi, 1.0))
    theirs: Checkout | Theirs | None = None
    if isinstance(other, Path):
        theirs = Checkout(other, x, v, side, gravity)
    elif other:
        theirs = Theirs(other, x, v, side, gravity, phi)
        theirs.advance(2 * n)
    slice_ = max(30_000, n // 2)
    paces, others = [], []
    gc.disable()
    for _ in range(repeats):
        paces.append(pace(ours.advance, slice_))
        if theirs:
            others.append(theirs.pace(slice_))
    gc.enable()
    if theirs:
        theirs.close()
    events = ours.box.events
    result = {
        "case": case,
        "packing_fraction": phi,
        "molecules": n,
        "collisions_per_second": float(np.median(paces)),
        "bytes_per_molecule": ours.box.memory() / n,
        "events_per_collision": sum(events.values()) / events["contacts"],
    }
    if theirs:
        result["other_collisions_per_second"] = float(np.median(others))
        result["ratio"] = float(np.median(np.array(paces) / np.array(others)))
    return result


def main(arguments: list[str] | None = None) -> list[dict[str, Any]]:
    """Run the cases asked for and print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, nargs="+", default=[1_000, 10_000, 100_000])
    parser.add_argument("--phi", type=float, nargs="+", default=[0.01, 0.1])
    parser.add_argument("--cases", nargs="+", default=["periodic", "gravity"], choices=["periodic", "gravity"])
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--against", type=Path, help="folder of another engine, to take turns with")
    parser.add_argument("--json", type=Path, help="file for the numbers")
    parser.add_argument("--serve", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args(arguments)
    if asked.serve:
        serve(asked.serve)
        return []
    other = None
    if asked.against and (asked.against / "atmosbox").is_dir():
        other = asked.against.resolve()
    elif asked.against:
        sys.path.insert(0, str(asked.against))
        other = importlib.import_module("exact")
    print("| case | phi | N | thousand collisions / s | other | ratio | bytes per molecule |")
    print("|---|---|---|---|---|---|---|")
    results = []
    for case in asked.cases:
        for phi in asked.phi:
            for n in asked.n:
                r = measure(n, phi, case, asked.repeats, other)
                results.append(r)
                beside = f"{r['other_collisions_per_second'] / 1e3:.0f} | {r['ratio']:.3f}" if other else " | "
                print(
                    f"| {case} | {phi:g} | {n} | {r['collisions_per_second'] / 1e3:.0f} | {beside} "
                    f"| {r['bytes_per_molecule']:.0f} |",
                    flush=True,
                )
    keep(asked.json, results)
    return results


if __name__ == "__main__":
    main()

"""What the classic schemes cost: per molecule and step, and beside the exact engine where both are equally right.

    python benchmarks/classic.py
    python benchmarks/classic.py --molecules 100 --phi 0.1 --contacts 1000000

There are two tables. The first gives the CPU time of each scheme for several numbers of molecules. The second compares
spheres in steps with the exact engine. The step is the one at which the collisional pressure Z - 1 of the spheres is
too low by 1 %. A pilot run with a longer step finds it, because the error is proportional to the step: 4 / sqrt(pi)
delta in a dilute gas, more in a dense one. Both engines run in turns on the same gas and measure Z - 1. The factor is
the ratio of their CPU times per contact. Machines are noisy: only ratios from one run count.
"""

import argparse
import gc
import json
import math
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from atmosbox.engine import Parcel, ParcelSet, Periodic, Specular, maxwell_velocities, random_positions
from atmosbox.engine.classic.classic import SCHEMES, ClassicParcel

PILOT = 0.04  # the step of the pilot run, in delta, which measures the error of Z - 1
RATE = {0.01: 0.138854, 0.1: 1.765845}  # collisions of a molecule per reduced time


def gas(number: int, covered: float, planar: bool) -> dict[str, Any]:
    """Return the arguments of a periodic box of equal molecules, with a covered area (planar) or packing fraction."""
    rng = np.random.default_rng(1)
    side = math.sqrt(number * math.pi / 4.0 / covered) if planar else (number * math.pi / 6.0 / covered) ** (1.0 / 3.0)
    length = (side, 1.0, side) if planar else (side,) * 3
    middle = Specular() if planar else Periodic()
    return {
        "position": random_positions(length, np.ones(number), rng, periodic=(True, not planar, True), planar=planar),
        "velocity": maxwell_velocities(1.0, np.ones(number), rng, planar=planar, exact=True),
        "length": length,
        "walls": (Periodic(), Periodic(), middle, middle, Periodic(), Periodic()),
        "planar": planar,
    }


def cost(scheme: str, number: int, seconds: float, repeats: int) -> dict[str, Any]:
    """Return the CPU time of a scheme per molecule and step, and the number of pairs that it tests in a step."""
    box = ClassicParcel(**gas(number, 0.02, scheme != "spheres"), scheme=scheme)
    box.advance(3 * box.time_step)
    steps = 1
    while True:  # find the number of steps that takes the wanted time
        start = time.process_time()
        box.advance(box.time + steps * box.time_step)
        spent = time.process_time() - start
        if spent > 0.25 * seconds / repeats:
            break
        steps *= 2
    steps = max(1, round(steps * seconds / repeats / spent))
    before, done = box.pair_tests, box.steps
    paces = []
    for _ in range(repeats):
        taken = box.steps
        start = time.process_time()
        box.advance((box.steps + steps) * box.time_step)
        paces.append((time.process_time() - start) / (box.steps - taken))
    return {
        "scheme": scheme,
        "molecules": number,
        "ns_per_molecule_step": float(np.median(paces)) / number * 1e9,
        "tests_per_step": (box.pair_tests - before) / (box.steps - done),
    }


def turn(box: Parcel, until: float) -> tuple[float, float, int]:
    """Return CPU time, virial per time and number of contacts while a box is advanced to a time."""
    virial, contacts, begun = box.virial.sum(), box.contacts, box.time
    start = time.process_time()
    box.advance(until)
    spent = time.process_time() - start
    return spent, (box.virial.sum() - virial) / (box.time - begun), box.contacts - contacts


def in_turns(number: int, covered: float, delta: float, contacts: float) -> tuple[np.ndarray, ClassicParcel]:
    """Run spheres and the exact engine in turns on the same gas; return the results of `turn`, (block, engine, 3)."""
    made = gas(number, covered, planar=False)
    spheres = ClassicParcel(**made, scheme="spheres", delta=delta)
    exact = ParcelSet(**made)
    pace = 2.0 * contacts / (20.0 * number * RATE[covered])
    warm = 4.0 / RATE[covered]
    turn(spheres, warm)
    turn(exact, warm)
    rows = [[turn(box, warm + block * pace) for box in (spheres, exact)] for block in range(1, 21)]
    return np.array(rows), spheres


def low(table: np.ndarray) -> tuple[float, float]:
    """Return the share by which the collisional pressure of the spheres is too low, and its standard error."""
    mean = table[:, :, 1].mean(axis=0)
    spread = table[:, :, 1].std(axis=0, ddof=1) / math.sqrt(len(table))
    return float(1.0 - mean[0] / mean[1]), float(np.hypot(*(spread / mean)))


def beside(number: int, covered: float, error: float, contacts: float) -> dict[str, Any]:
    """Compare spheres at a given error of Z - 1 with the exact engine, in turns on the same gas."""
    late, _ = low(in_turns(number, covered, PILOT, 3.0 * contacts)[0])
    table, spheres = in_turns(number, covered, PILOT * error / late, contacts)
    measured, uncertain = low(table)
    per_contact = table[:, :, 0].sum(axis=0) / table[:, :, 2].sum(axis=0)
    ratios = table[:, 0, 0] / table[:, 0, 2] / (table[:, 1, 0] / table[:, 1, 2])
    return {
        "packing_fraction": covered,
        "molecules": number,
        "late_per_delta": late / PILOT,
        "delta": spheres.time_step,
        "error_measured": measured,
        "error_of_that": uncertain,
        "spheres_us_per_contact": float(per_contact[0]) * 1e6,
        "exact_us_per_contact": float(per_contact[1]) * 1e6,
        "factor": float(np.median(ratios)),
        "energy_error": abs(spheres.energy()[0] / (1.5 * number) - 1.0),
    }


def main(arguments: list[str] | None = None) -> dict[str, Any]:
    """Run the cases asked for and print two tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, nargs="*", default=[60, 200, 600, 1000, 3000], help="for the first table")
    parser.add_argument("--seconds", type=float, default=1.0, help="CPU time of a row of the first table")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--molecules", type=int, nargs="*", default=[100, 500], help="for the second table")
    parser.add_argument("--phi", type=float, nargs="+", default=[0.1, 0.01], choices=sorted(RATE))
    parser.add_argument("--error", type=float, default=0.01, help="of Z - 1, at which engines are compared")
    parser.add_argument("--contacts", type=float, default=3e4, help="of each engine in the second table")
    parser.add_argument("--json", type=Path, help="file for the numbers")
    asked = parser.parse_args(arguments)
    result: dict[str, Any] = {"cost": [], "beside": []}
    gc.disable()
    print("| scheme | N | ns per molecule and step | pair tests per step |\n|---|---|---|---|")
    for scheme in SCHEMES:
        for number in asked.n:
            r = cost(scheme, number, asked.seconds, asked.repeats)
            result["cost"].append(r)
            print(f"| {scheme} | {number} | {r['ns_per_molecule_step']:.0f} | {r['tests_per_step']:.0f} |", flush=True)
    print("\n| phi | N | low per delta | delta | Z - 1 low by | us a contact: spheres | exact | factor | energy |")
    print("|---|---|---|---|---|---|---|---|---|")
    for covered in asked.phi:
        for number in asked.molecules:
            r = beside(number, covered, asked.error, asked.contacts)
            result["beside"].append(r)
            print(
                f"| {covered:g} | {number} | {r['late_per_delta']:.2f} | {r['delta']:.4f} "
                f"| {100 * r['error_measured']:.2f} ± {100 * r['error_of_that']:.2f} % "
                f"| {r['spheres_us_per_contact']:.1f} | {r['exact_us_per_contact']:.2f} | {r['factor']:.0f} "
                f"| {r['energy_error']:.0e} |",
                flush=True,
            )
    gc.enable()
    if asked.json:
        asked.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return result


if __name__ == "__main__":
    main()

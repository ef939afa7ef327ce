"""What molecules in single precision would gain `dsmc`, and what they would cost.

    python benchmarks/precision.py --json benchmarks/precision.json

The columns of positions and velocities have 32 bits a number in place of 64; nothing else is changed. Both kinds of box
run in turns.

Pace: of a gas in gravity between heat baths, as in ``benchmarks/dsmc.py``. Energy: the relative error after some steps
of a gas in gravity between smooth walls, whose energy is conserved. Gravity: the error of the velocity that molecules
gain in one step, compared with g dt, for gains that become smaller and smaller relative to the thermal speed. A
velocity can change only by whole units of its last digit, and is rounded in the same direction each time.
"""

import argparse
import gc
import json
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from dsmc import OCCUPANCY, Ours

from atmosbox.engine.dsmc import dsmc_parcel
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel

BITS = (64, 32)
ENERGY_STEPS = 300
GAINS = (1e-2, 1e-4, 1e-6, 1e-7, 1e-8)


@contextmanager
def columns_of(bits: int) -> Iterator[None]:
    """Within this context, new boxes keep positions and velocities with a number of bits each."""
    usual = dsmc_parcel.new_columns

    def new_columns(number: int, many: int) -> list[Any]:
        return [column.view(f"f{bits // 8}")[:number] for column in usual(number, many)]

    dsmc_parcel.new_columns = new_columns
    try:
        yield
    finally:
        dsmc_parcel.new_columns = usual


def paces(n: int, repeats: int) -> dict[str, Any]:
    """Return the pace of both kinds of box, and the ratio, the median over turns."""
    boxes = []
    for bits in BITS:
        with columns_of(bits):
            boxes.append(Ours(n, 1, "specular"))
    steps = max(4, 3_000_000 // n)
    seconds = []
    gc.disable()
    for turn in range(repeats + 1):
        taken = []
        for box in boxes:
            start = time.process_time()
            box.go(17 if turn == 0 else steps)  # the first turn sorts the molecules by cells
            taken.append(time.process_time() - start)
        seconds.append(taken)
    gc.enable()
    double, single = np.array(seconds[1:]).T
    return {
        "molecules": n,
        "moves_per_cpu_second": [float(np.median(steps * n / each)) for each in (double, single)],
        "ratio": float(np.median(double / single)),
        "bytes_per_molecule": [box.box.memory() / n for box in boxes],
    }


def energy_error(bits: int, n: int) -> float:
    """Return the relative error of the energy of a closed box after some steps."""
    side = float(round((n / OCCUPANCY) ** (1.0 / 3.0)))
    rng = np.random.default_rng(2)
    gravity = 1.0 / side
    with columns_of(bits):
        box = DsmcParcel(
            0.05 + (side - 0.1) * rng.random((n, 3)), rng.normal(size=(n, 3)), length=(side,) * 3, diameter=0.1,
            gravity=gravity, dt=0.1,
        )  # fmt: skip

    def energy() -> float:
        now = box.snapshot()
        return 0.5 * float(np.sum(now.velocity**2)) + gravity * float(np.sum(now.position[:, 2]))

    before = energy()
    box.advance(ENERGY_STEPS * box.time_step)
    return abs(energy() / before - 1.0)


def fall_error(bits: int, gain: float, n: int) -> float:
    """Return the relative error of the mean velocity gained by falling, for a gain in units of the thermal speed."""
    rng = np.random.default_rng(3)
    velocity = rng.normal(size=(n, 3)).astype(np.float32).astype(np.float64)  # numbers that both precisions can hold
    position = 40.0 + 20.0 * rng.random((n, 3))

    def space(gravity: float) -> DsmcParcel:
        return DsmcParcel(position, velocity, length=(100.0,) * 3, collisions=False, gravity=gravity, dt=0.01)

    with columns_of(bits):
        box = space(gain / space(0.0).time_step)
    box.advance(box.time_step)
    fallen = velocity[:, 2] - box.snapshot().velocity[:, 2]
    return float(np.mean(fallen)) / gain - 1.0


def main(arguments: list[str] | None = None) -> dict[str, Any]:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, nargs="+", default=[10_000, 100_000, 1_000_000, 10_000_000])
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--json", type=Path, help="file for the numbers")
    asked = parser.parse_args(arguments)
    few = min(100_000, max(asked.n))
    result: dict[str, Any] = {
        "energy": {"steps": ENERGY_STEPS, "error": [energy_error(bits, few) for bits in BITS]},
        "fall": [{"gain": gain, "error": [fall_error(bits, gain, few) for bits in BITS]} for gain in GAINS],
        "pace": [],
    }
    print("energy after", ENERGY_STEPS, "steps: relative error", *(f"{each:.1e}" for each in result["energy"]["error"]))
    for one in result["fall"]:
        print(f"a fall that changes velocities by {one['gain']:g}: off by", *(f"{each:+.1e}" for each in one["error"]))
    print("\n| N | million moves / CPU s, double | single | ratio | bytes per molecule, double | single |")
    print("|---|---|---|---|---|---|")
    for n in asked.n:
        one = paces(n, asked.repeats)
        result["pace"].append(one)
        cells = [*(f"{each / 1e6:.1f}" for each in one["moves_per_cpu_second"]), f"{one['ratio']:.3f}"]
        cells += [f"{each:.0f}" for each in one["bytes_per_molecule"]]
        print(f"| {n} | {' | '.join(cells)} |", flush=True)
    if asked.json:
        asked.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return result


if __name__ == "__main__":
    main()

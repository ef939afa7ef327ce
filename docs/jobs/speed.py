"""How fast the engines are, as the benchmarks have measured it."""

import datetime
import json

from jobs.registry import BENCHMARKS, SCENES, Findings, job, results

CASES = {"periodic": "periodic box", "gravity": "gravity between heat baths"}


@job("speed", quick=True)
def speed(found: Findings) -> None:
    """Make the tables of what the benchmarks have measured."""
    measured = results("engine")
    pace: dict[str, list[str]] = {}
    for r in measured:
        gas = f"{CASES[r['case']]}, φ = {r['packing_fraction']:g}"
        pace.setdefault(gas, []).append(f"{r['collisions_per_second'] / 1e3:.0f}")
    numbers = sorted({r["molecules"] for r in measured})
    found.table(["gas", *(f"{n:,} molecules" for n in numbers)], [[gas, *cells] for gas, cells in pace.items()])
    held = [r["bytes_per_molecule"] for r in measured]
    found.number("bytes", f"{min(held):.0f} to {max(held):.0f}")
    on = json.loads((BENCHMARKS / "engine.json").read_text(encoding="utf-8"))["measured_on"]
    date = datetime.date.fromisoformat(on["date"])
    found.number("machine", f"{date.day} {date:%B %Y}, {on['processor']}, Python {on['python']}, numba {on['numba']}")


@job("waiting", quick=True)
def waiting(found: Findings) -> None:
    """Make the table of what a class waits for."""
    rows = [
        [f"[{each['scene']}](scenes/{each['scene']}.md)", *(f"{each[part]:.1f}" for part in ("cpu", "kernel"))]
        for each in results("scenes")
        if each["scene"] in SCENES
    ]
    found.table(["scene", "processor time [s]", "compiled code alone [s]"], rows)


@job("pace-in-steps", quick=True)
def pace_in_steps(found: Findings) -> None:
    """Make the table of how fast the engines that go in steps are."""
    pace: dict[str, list[str]] = {}
    for r in results("stepped"):
        gas = f"`stepped`, φ = {r['packing_fraction']:g}, δ = {r['delta']:g}"
        pace.setdefault(gas, []).append(f"{r['molecule_steps_per_second'] / 1e6:.0f}")
    for r in results("dsmc"):
        gas = f"`dsmc`, threads: {r['threads']}"
        pace.setdefault(gas, []).append(f"{r['moves_per_second'] / 1e6:.0f}")
    numbers = sorted({r["molecules"] for r in results("dsmc")})
    found.table(["engine", *(f"{n:,} molecules" for n in numbers)], [[gas, *cells] for gas, cells in pace.items()])

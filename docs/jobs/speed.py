"""How fast the engine is, as the benchmarks have measured it."""

import datetime
import json
from typing import Any

from jobs.registry import ROOT, SCENES, Findings, job

FOLDER = ROOT / "benchmarks"
CASES = {"periodic": "periodic box", "gravity": "gravity between heat baths"}


def results(name: str) -> Any:
    """Return what a benchmark has written."""
    return told(name)["results"]


def told(name: str) -> Any:
    """Return what a benchmark has written, with the machine that it ran on."""
    return json.loads((FOLDER / f"{name}.json").read_text(encoding="utf-8"))


def machine(name: str) -> str:
    """Return when and on what a benchmark ran."""
    on = told(name)["measured_on"]
    date = datetime.date.fromisoformat(on["date"])
    return f"{date.day} {date:%B %Y}, {on['processor']}, Python {on['python']}, numba {on['numba']}"


@job("speed", quick=True)
def speed(found: Findings) -> None:
    """Make the tables of what the benchmarks have measured."""
    rows = [
        [CASES[r["case"]], f"{r['packing_fraction']:g}", f"{r['molecules']:,}",
         f"{r['collisions_per_second'] / 1e3:.0f}", f"{r['ratio']:.2f}", f"{r['bytes_per_molecule']:.0f}"]
        for r in results("engine")
    ]  # fmt: skip
    head = ["gas", "packing fraction", "molecules", "thousand collisions per CPU second", "over the pace without rows"]
    found.table([*head, "bytes per molecule"], rows)
    found.number("machine", machine("engine"))


@job("waiting", quick=True)
def waiting(found: Findings) -> None:
    """Make the table of what a class waits for."""
    rows = [
        [f"[{each['scene']}](scenes/{each['scene']}.md)",
         *(f"{each[part]:.1f}" for part in ("cpu", "wall", "start", "kernel")),
         f"{each['compile'] + each['build'] + each['files']:.1f}"]
        for each in results("scenes")
        if each["scene"] in SCENES
    ]  # fmt: skip
    head = ["scene", "processor time [s]", "wall time [s]", "start-up", "engine", "measuring and files"]
    found.table(head, rows)
    found.number("machine", machine("scenes"))


@job("pace-in-steps", quick=True)
def pace_in_steps(found: Findings) -> None:
    """Make the table of how fast the engines that go in steps are."""
    rows = [
        ["`stepped`", f"φ = {r['packing_fraction']:g}, δ = {r['delta']:g}", f"{r['molecules']:,}", r["threads"],
         f"{r['molecule_steps_per_second'] / 1e6:.0f}", f"{r['bytes_per_molecule']:.0f}"]
        for r in results("stepped")
    ] + [
        ["`dsmc`", "10 in a cell, 0.09 collisions a step", f"{r['molecules']:,}", r["threads"],
         f"{r['moves_per_second'] / 1e6:.0f}", f"{r['bytes_per_molecule']:.0f}"]
        for r in results("dsmc")
    ]  # fmt: skip
    head = ["engine", "gas in gravity between heat baths", "molecules", "threads", "million molecules moved per second"]
    found.table([*head, "bytes per molecule"], rows)
    found.number("machine", machine("stepped"))

"""How fast the engine is, as the benchmarks have measured it."""

import json
from typing import Any

from jobs.registry import ROOT, Findings, job

FOLDER = ROOT / "benchmarks"
CASES = {"periodic": "periodic box", "gravity": "gravity between heat baths"}


def results(name: str) -> Any:
    """Return what a benchmark has written, or None."""
    path = FOLDER / f"{name}.json"
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else None


@job("speed", quick=True)
def speed(found: Findings) -> None:
    """Make the tables of what the benchmarks have measured."""
    paces, features = results("engine"), results("features")
    if paces is None:
        found.text("`python benchmarks/engine.py` measures it.")
    else:
        rows = [
            [CASES[r["case"]], f"{r['packing_fraction']:g}", f"{r['molecules']:,}",
             f"{r['collisions_per_second'] / 1e3:.0f}", f"{r['bytes_per_molecule']:.0f}"] for r in paces
        ]  # fmt: skip
        head = ["gas", "packing fraction", "molecules", "thousand collisions per CPU second", "bytes per molecule"]
        found.table(head, rows)
    if features is None:
        found.text("`python benchmarks/features.py` measures it.", key="features")
        return
    rows = []
    for name, each in features["on"].items():
        off = features["off"].get({"unequal sizes": "mixed"}.get(name, name))
        idle = f"{off['ratio']:.2f} ± {off['error']:.2f}" if off else "–"
        rows.append([name, f"{each['ratio']:.2f} ± {each['error']:.2f}", idle, f"{each['bytes']:.0f}"])
    if "nothing" in features["off"]:
        idle = features["off"]["nothing"]
        rows.append(
            [
                "none; the others are relative to it",
                "–",
                f"{idle['ratio']:.2f} ± {idle['error']:.2f}",
                "–",
            ]
        )
    head = ["feature", "time of a collision over that of the plain gas", "where it is off, over an engine without it"]
    found.table([*head, "bytes per molecule"], rows, key="features")

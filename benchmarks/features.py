"""What a feature costs where a scene has it, and where it does not.

    python benchmarks/features.py

On: nanoseconds per collision and bytes per molecule of a gas with the feature, beside the plain gas. Off: the
plain gas in the engine as it is, beside the plain gas in a copy of the engine from whose sources the feature
has been struck out (every ``modes.FEATURE`` made ``False`` before compiling). Both take turns in one run;
medians of ratios.
The row ``nothing`` is a copy from which nothing was struck; the other rows are relative to it.
"""

import argparse
import gc
import importlib
import json
import math
import re
import shutil
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
PHI = 0.01
FEATURES = ("nothing", "gravity", "rotation", "mixed", "spanning", "periodic", "piston")


def engine(root: Path) -> Any:
    """Import the engine that stands in a folder, beside any that was imported before."""
    for name in [name for name in sys.modules if name.split(".")[0] == "atmosbox"]:
        del sys.modules[name]
    sys.path.insert(0, str(root))
    try:
        module = importlib.import_module("atmosbox.engine")
        module.start = importlib.import_module("atmosbox.engine.start")
    finally:
        sys.path.pop(0)
    return module


def without(feature: str, folder: Path) -> Path:
    """Copy the engine into a folder, with one feature struck out of its sources."""
    root = folder / f"without_{feature}"
    shutil.copytree(
        ROOT / "atmosbox" / "engine", root / "atmosbox" / "engine", ignore=shutil.ignore_patterns("__pycache__")
    )
    (root / "atmosbox" / "__init__.py").write_text("", encoding="utf-8")
    for file in (root / "atmosbox" / "engine").glob("*.py"):
        text = file.read_text(encoding="utf-8")
        file.write_text(re.sub(rf"\bmodes\.{feature}\b", "False", text), encoding="utf-8")
    return root


def gas(module: Any, n: int, feature: str | None = None) -> Any:
    """Return a gas between smooth walls, plain or with one feature."""
    rng = np.random.default_rng(1)
    side = (n * math.pi / 6.0 / PHI) ** (1.0 / 3.0)
    smooth = module.Specular()
    walls = [smooth] * 6
    options: dict[str, Any] = {}
    periodic = (False, False, False)
    sizes = np.ones(n)
    if feature == "gravity":
        options["gravity"] = 0.1 / side
    elif feature == "heat baths":
        walls = [module.HeatBath(1.0)] * 6
    elif feature == "rotation":
        options |= {"rotation": 2.0, "rotational_energy": np.ones(n)}
    elif feature == "two masses":
        options["mass"] = np.where(np.arange(n) % 2, 1.0, 2.0)
    elif feature == "unequal sizes":
        sizes = np.where(np.arange(n) % 2, 0.9, 1.09)
        options["diameter"] = sizes
    elif feature == "periodic":
        walls, periodic = [module.Periodic()] * 6, (True, True, True)
    elif feature == "piston":
        walls[5] = module.Piston(0.0)
    elif feature == "50 layers":
        options["layers"] = 50
    x = module.start.random_positions((side,) * 3, sizes, rng, periodic=periodic)
    v = module.start.maxwell_velocities(1.0, np.ones(n), rng, exact=True)
    box = module.ParcelSet(x, v, length=(side,) * 3, walls=tuple(walls), **options)
    box.advance(40.0)
    return box


def cost(box: Any, span: float) -> float:
    """Return CPU nanoseconds per collision of one slice."""
    before = box.contacts
    start = time.process_time()
    box.advance(box.time + span)
    return 1e9 * (time.process_time() - start) / max(box.contacts - before, 1)


def compare(first: Any, second: Any, repeats: int, span: float) -> tuple[float, float, float, float]:
    """Return the median costs of two boxes that take turns, the median of their ratio, and its standard error."""
    pairs = []
    for turn in range(repeats):
        order = (first, second) if turn % 2 else (second, first)
        costs = {id(box): cost(box, span) for box in order}
        pairs.append((costs[id(first)], costs[id(second)]))
    table = np.array(pairs)
    ratio = table[:, 0] / table[:, 1]
    error = 1.25 * float(np.std(ratio)) / math.sqrt(repeats)
    return float(np.median(table[:, 0])), float(np.median(table[:, 1])), float(np.median(ratio)), error


def main(arguments: list[str] | None = None) -> dict[str, Any]:
    """Measure, and print two tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, default=4_000)
    parser.add_argument("--repeats", type=int, default=15)
    parser.add_argument("--span", type=float, default=100.0, help="reduced time of a slice")
    parser.add_argument("--json", type=Path, help="file for the numbers")
    asked = parser.parse_args(arguments)
    gc.disable()
    now = engine(ROOT)
    plain = gas(now, asked.n)
    result: dict[str, Any] = {"on": {}, "off": {}}
    print("| on | ns per collision | of the plain gas | bytes per molecule |\n|---|---|---|---|")
    print(f"| plain gas | {cost(plain, asked.span):.0f} | 1 | {plain.memory() / asked.n:.0f} |")
    for feature in (
        "gravity", "heat baths", "rotation", "two masses", "unequal sizes", "periodic", "piston", "50 layers",
    ):  # fmt: skip
        box = gas(now, asked.n, feature)
        dear, _, ratio, error = compare(box, plain, asked.repeats, asked.span)
        result["on"][feature] = {"ns": dear, "ratio": ratio, "error": error, "bytes": box.memory() / asked.n}
        print(f"| {feature} | {dear:.0f} | {ratio:.2f} | {box.memory() / asked.n:.0f} |", flush=True)
    print("\n| off | engine as it is over one without the feature |\n|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for feature in FEATURES:
            bare = gas(engine(without(feature, Path(folder))), asked.n)
            whole = gas(now, asked.n)
            _, _, ratio, error = compare(whole, bare, asked.repeats, asked.span)
            # what is common to all copies, such as where their memory lies, is no cost of a feature
            common = result["off"]["nothing"]["ratio"] if feature != "nothing" else 1.0
            result["off"][feature] = {"ratio": ratio / common, "error": error / common}
            print(f"| {feature} | {ratio / common:.3f} ± {error / common:.3f} |", flush=True)
    if asked.json:
        asked.json.write_text(json.dumps(result, indent=1) + "\n", encoding="utf-8")
    return result


if __name__ == "__main__":
    main()

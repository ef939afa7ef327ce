"""What a feature costs where a scene has it, and where it does not.

    python benchmarks/features.py --json benchmarks/features.json

On: nanoseconds per collision, bytes per molecule and lines of code of a gas with the feature, compared with the plain
gas; and of a scene with an instrument that records molecules or layers, compared with the scene without it.

Off: the whole engine, compared with a copy from whose sources the feature has been removed (every ``modes.FEATURE``
replaced by ``False``), both with a gas that does not have the feature. The row ``nothing`` is the control: a copy from
which nothing was removed, and which must cost the same.

Three effects can change such a comparison by some per cent; they are excluded here:

- The positions of arrays in memory decide which arrays displace each other from the cache. So all copies of the engine
  work on the same arrays, reset to the same state each time, and process the same events.
- The same machine code takes 3 % more or less time if it has just been compiled and was not read from disk, and 2 %
  less if it is the first that a process loads. So the whole engine is a copy like the others, all copies are read from
  disk, none of them is the first, and each of many processes loads them in another order. The median and its standard
  error are over processes.
- Other programs can only increase a time. So the same work is done several times in a process, and the shortest time
  counts.

Lines of code are the lines of the engine that a gas of sixty molecules executes while time passes, counted without
compilation.
"""

import argparse
import functools
import gc
import importlib
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
import tracemalloc
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
from measured_on import keep

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))
ENGINE = ROOT / "atmosbox" / "engine"
PHI = 0.01
FREE_TIME = 7.2
"""Mean free time at that packing fraction [reduced time]."""
GASES = {
    "plain gas": "contacts",
    "gravity": "gravity",
    "heat baths": "",
    "rotation": "rotation",
    "two masses": "mixed",
    "unequal sizes": "spanning",
    "periodic": "periodic",
    "periodic, 3 diameters high": "images",
    "piston": "piston",
    "lift": "ascends",
    "50 layers": "",
}
"""The gases that are timed, each with the mode of the engine whose cost it shows; heat baths and layers have none."""
SCENES = {
    "trails: discs": ("elastic-collisions", "Discs"),
    "trails: --save-molecules": ("temperature-large", "Molecules"),
    "profiles: 25 layers": ("atmosphere", "Layers"),
}
"""The instruments that are timed, each with its scene."""


class Swing:
    """A piston that moves a little up and down, and whose velocity is set as often as that of a rising parcel."""

    interval = FREE_TIME / 4.0

    def __init__(self, height: float) -> None:
        self._speed = 1e-4 * height / self.interval

    def velocity(self, parcel: Any) -> float:
        """Return the velocity for the next interval, which changes its sign each time."""
        self._speed = -self._speed
        return self._speed


def engine(root: Path) -> Any:
    """Import the engine of a folder; engines that were imported before stay usable."""
    for name in [name for name in sys.modules if name.split(".")[0] == "atmosbox"]:
        del sys.modules[name]
    sys.path.insert(0, str(root))
    try:
        module = importlib.import_module("atmosbox.engine")
        # import all of its modules now: later, their names would lead to another folder
        for name in module.__all__:
            getattr(module, name)
        module.loop = importlib.import_module("atmosbox.engine.exact.exact")
        module.types = importlib.import_module("atmosbox.engine.core.state")
    finally:
        sys.path.pop(0)
    module.modules = {name: each for name, each in sys.modules.items() if name.split(".")[0] == "atmosbox"}
    return module


def without(feature: str, folder: Path) -> Path:
    """Copy the engine into a folder and remove one feature from its sources; return the folder."""
    root = folder / feature
    shutil.copytree(ENGINE, root / "atmosbox" / "engine", ignore=shutil.ignore_patterns("__pycache__"))
    (root / "atmosbox" / "__init__.py").write_text("", encoding="utf-8")
    for file in (root / "atmosbox" / "engine").rglob("*.py"):
        text = file.read_text(encoding="utf-8")
        file.write_text(re.sub(rf"\bmodes\.{feature}\b", "False", text), encoding="utf-8")
    return root


def gas(module: Any, n: int, feature: str, seed: int = 1) -> Any:
    """Return a gas: plain between smooth walls, with one feature, or of points."""
    rng = np.random.default_rng(seed)
    side = (n * math.pi / 6.0 / PHI) ** (1.0 / 3.0)
    length = (side,) * 3
    walls: list[Any] = [module.Specular()] * 6
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
    elif feature == "periodic":
        walls, periodic = [module.Periodic()] * 6, (True, True, True)
    elif feature == "periodic, 3 diameters high":
        walls, periodic = [module.Periodic()] * 6, (True, True, True)
        length = (side * math.sqrt(side / 3.0),) * 2 + (3.0,)
    elif feature == "lift":
        pressure = 6.0 * PHI / math.pi
        walls[5] = module.Piston(0.0)
        options["driver"] = module.FollowPressure([0.0], [pressure], mean_free_time=FREE_TIME)
    elif feature == "piston":
        walls[5] = module.Piston(0.0)
        options["driver"] = Swing(side)
    elif feature == "50 layers":
        options["layers"] = 50
    elif feature == "points":
        sizes = np.zeros(n)
    x = module.random_positions(length, sizes, rng, periodic=periodic)
    v = module.maxwell_velocities(1.0, np.ones(n), rng, exact=True)
    return module.ParcelSet(x, v, length=length, walls=tuple(walls), diameter=sizes, **options)


def leaves(parts: tuple[Any, ...]) -> Iterator[Any]:
    """Yield the elements of nested tuples."""
    for part in parts:
        if isinstance(part, tuple):
            yield from leaves(part)
        else:
            yield part


def of_another(part: Any, state: Any) -> Any:
    """Return a copy of nested NamedTuples, made of the classes of another engine."""
    if not isinstance(part, tuple):
        return part
    return getattr(state, type(part).__name__)(*(of_another(each, state) for each in part))


class Bench:
    """The arrays of one box, on which the kernels of several engines repeat the same work."""

    def __init__(self, box: Any, span: float) -> None:
        self._modes = box._modes
        self._gas = box._gas()
        self._until = box._now + span
        self._arrays = [part for part in leaves(self._gas) if isinstance(part, np.ndarray)]
        self._before = [np.array(each) for each in self._arrays]

    def kernel(self, module: Any) -> Callable[[], float]:
        """Return a function that does the work with another engine's kernel and returns its CPU time [s]."""
        # numba finds machine code on disk only if its arguments have the classes of the modules in sys.modules
        sys.modules.update(module.modules)
        state = module.types
        gas = of_another(self._gas, state)
        _, advance, _, _, refill = module.loop.specialise(state.Modes(*self._modes))
        over = module.loop.Status.EPOCH_OVER

        def work() -> float:
            for array, before in zip(self._arrays, self._before, strict=True):
                np.copyto(array, before)
            start = time.process_time()
            while (status := advance(gas, self._until, 1 << 60)[0]) == over:
                refill(gas, gas.calendar.time[1])
            lasted = time.process_time() - start
            if status != module.loop.Status.DONE:
                raise RuntimeError("a row of the cells is full: choose another seed")
            return lasted

        work()
        return work


def shortest(works: dict[str, Callable[[], float]], repeats: int) -> dict[str, float]:
    """Return the shortest time of each work over several turns, in each of which the order is random."""
    times: dict[str, list[float]] = {name: [] for name in works}
    gc.disable()
    for _ in range(repeats):
        for name in random.sample(list(works), len(works)):
            times[name].append(works[name]())
    gc.enable()
    return {name: min(each) for name, each in times.items()}


def time_off(asked: argparse.Namespace) -> dict[str, float]:
    """Return the time of the whole engine divided by that of each copy, in this process."""
    copies = [asked.only] if asked.only else [path.name for path in asked.folder.iterdir()]
    random.shuffle(copies)
    builder = engine(ROOT)  # not compared: the engine whose machine code is loaded first has an advantage of 2 %
    engines = {}
    for name in copies:
        os.environ["NUMBA_CACHE_DIR"] = str(asked.folder / name / "cache")
        engines[name] = engine(asked.folder / name)
    ratios = {}
    for what, of_points in (("plain gas", False), ("points", True)):
        sys.modules.update(builder.modules)
        box = gas(builder, asked.n, what, asked.seed)
        box.advance(5.0 * FREE_TIME)
        bench = Bench(box, asked.span)
        chosen = [name for name in copies if name == "whole" or of_points == (name == "contacts")]
        if not (chosen := [name for name in chosen if name in engines]):
            continue
        found = shortest({name: bench.kernel(engines[name]) for name in chosen}, asked.repeats)
        ratios |= {name: found["whole"] / each for name, each in found.items() if name != "whole" and not asked.only}
    return ratios


def time_on(asked: argparse.Namespace) -> dict[str, dict[str, Any]]:
    """Return, by feature, nanoseconds per collision and their ratio to those of the plain gas, in this process."""
    module = engine(ROOT)

    def cost(box: Any) -> float:
        before = box.contacts
        start = time.process_time()
        box.advance(box.time + asked.span)
        return 1e9 * (time.process_time() - start) / max(box.contacts - before, 1)

    plain = gas(module, asked.n, "plain gas", asked.seed)
    plain.advance(5.0 * FREE_TIME)
    found = {}
    for feature in random.sample(list(GASES), len(GASES)):
        box = gas(module, asked.n, feature, asked.seed)
        box.advance(5.0 * FREE_TIME)
        gc.disable()
        costs = np.array([[cost(each) for each in (box, plain)] for _ in range(asked.repeats)])
        gc.enable()
        dear, cheap = np.median(costs, axis=0)
        modes = [name for name, on in box._modes._asdict().items() if on]
        found[feature] = {"ns": dear, "ratio": dear / cheap, "bytes": box.memory() / asked.n, "modes": modes}
    return found


def scene(name: str, instrument: str, small: bool) -> tuple[Any, Callable[[bool], None]]:
    """Return the set-up of a scene, and a function that computes one frame with or without an instrument."""
    from atmosbox.scene import instruments
    from atmosbox.simulation import runner

    prepared = runner.prepare(name, {"molecules": 60} if small else {})
    setup = prepared.module.build(prepared.settings)
    kind = getattr(instruments, instrument)
    chosen = next((each for each in setup.instruments if isinstance(each, kind)), None) or kind()
    others = [each for each in setup.instruments if each is not chosen]

    def frame(watched: bool) -> None:
        parcel = setup.parcel
        watching = [*others, chosen] if watched else others
        for _ in range(setup.samples):
            parcel.advance(parcel.time + setup.frame / setup.samples)
            snapshot = parcel.snapshot()
            for each in watching:
                each.sample(parcel, snapshot)
        for each in watching:
            each.end_frame(parcel, snapshot)

    return setup, frame


def time_instruments(asked: argparse.Namespace) -> dict[str, dict[str, float]]:
    """Return, by instrument, the cost of a collision with it, the ratio to that without it, and the memory.

    Frames with and without the instrument take turns.
    """
    found = {}
    for feature, (name, instrument) in SCENES.items():
        setup, frame = scene(name, instrument, asked.trial)
        for watched in (False, True):
            frame(watched)
        before, times = setup.parcel.contacts, []
        for turn in range(1 if asked.trial else 4 * asked.repeats):
            pair = [0.0, 0.0]
            for watched in (False, True) if turn % 2 else (True, False):
                start = time.process_time()
                frame(watched)
                pair[watched] = time.process_time() - start
            times.append(pair)
        collisions = (setup.parcel.contacts - before) / (2 * len(times))
        bare, full = np.median(times, axis=0)
        grown: dict[bool, list[int]] = {True: [], False: []}
        filmed, turns = (1, 1) if asked.trial else (10, 5)
        tracemalloc.start()
        frame(True)
        for watched in turns * (False, True):  # Python's own memory varies: the median counts
            gc.collect()
            held = tracemalloc.get_traced_memory()[0]
            for _ in range(filmed):
                frame(watched)
            gc.collect()
            grown[watched].append(tracemalloc.get_traced_memory()[0] - held)
        tracemalloc.stop()
        kept = float(np.median(grown[True]) - np.median(grown[False]))
        found[feature] = {
            "ns": 1e9 * full / max(collisions, 1e-9),
            "ratio": full / bare,
            "bytes": kept / (filmed * setup.parcel.number),
        }
    return found


def lines_of(work: Callable[[], None], files: tuple[str, ...]) -> set[tuple[str, int]]:
    """Return the lines of code that a piece of work executes in files whose paths begin with one of ``files``."""
    seen: set[tuple[str, int]] = set()

    def follow(frame: FrameType, event: str, argument: Any) -> Any:
        file = frame.f_code.co_filename
        if not file.startswith(files):
            return None

        def note(frame: FrameType, event: str, argument: Any) -> Any:
            if event == "line":
                seen.add((file, frame.f_lineno))
            return note

        return note

    sys.settrace(follow)
    try:
        work()
    finally:
        sys.settrace(None)
    return seen


def count_lines(molecules: int) -> dict[str, int]:
    """Return the number of lines of code that each gas, and each instrument in its scene, executes."""
    module = engine(ROOT)
    counted = {}
    for feature in (*GASES, "points"):
        box = gas(module, molecules, feature)
        counted[feature] = len(lines_of(functools.partial(box.advance, 10.0 * FREE_TIME), (str(ENGINE),)))
    watching = (str(ROOT / "atmosbox" / "scene" / "instruments"), str(ENGINE / "core" / "measure.py"))
    for feature, (name, instrument) in SCENES.items():
        _, frame = scene(name, instrument, True)
        bare = lines_of(functools.partial(frame, False), watching)
        counted[feature] = len(lines_of(functools.partial(frame, True), watching) - bare)
    return counted


def child(task: str, asked: argparse.Namespace, **changed: Any) -> Any:
    """Do a task in a process of its own and return its result."""
    command = [sys.executable, __file__, "--task", task]
    for name, value in (vars(asked) | changed).items():
        if name == "trial":
            command += ["--trial"] * value
        elif name not in ("task", "json") and value is not None:
            command += [f"--{name}", str(value)]
    environment = os.environ | ({"NUMBA_DISABLE_JIT": "1"} if task == "lines" else {})
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return json.loads(done.stdout.splitlines()[-1])


def middle(values: list[float]) -> tuple[float, float]:
    """Return the median and its standard error, which is computed from the quartiles."""
    quarters = np.percentile(values, [25.0, 75.0])
    spread = float(quarters[1] - quarters[0]) / 1.349
    return float(np.median(values)), 1.2533 * spread / math.sqrt(len(values))


def measure(asked: argparse.Namespace) -> dict[str, Any]:
    """Measure everything, in many processes."""
    from atmosbox.engine.core.state import Modes

    hasty = {"repeats": 1, "span": 1.0}
    with tempfile.TemporaryDirectory() as name:
        folder = asked.folder or Path(name)
        missing = [feature for feature in ("whole", "nothing", *Modes._fields) if not (folder / feature).exists()]
        for feature in missing:
            without(feature, folder)
        with ThreadPoolExecutor(os.cpu_count()) as workers:
            counting = workers.submit(child, "lines", asked)
            compiling = [workers.submit(child, "on", asked, **hasty)]
            compiling += [workers.submit(child, "off", asked, folder=folder, only=each, **hasty) for each in missing]
        lines = counting.result()
        for each in compiling:
            each.result()
        samples = []
        for seed in range(1, asked.processes + 1):
            print(f"process {seed} of {asked.processes}", file=sys.stderr, flush=True)
            sample = child("on", asked, seed=seed)
            samples.append(sample | {"off": child("off", asked, seed=seed, folder=folder)})
    result: dict[str, Any] = {"molecules": asked.n, "packing_fraction": PHI, "processes": asked.processes}
    for part in ("on", "instruments"):
        result[part] = {}
        for feature in samples[0][part]:
            each = [sample[part][feature] for sample in samples]
            ratio, error = middle([one["ratio"] for one in each])
            result[part][feature] = {
                "ns": float(np.median([one["ns"] for one in each])),
                "ratio": ratio,
                "error": error,
                "bytes": float(np.median([one["bytes"] for one in each])),
                "lines": lines[feature],
                **({"modes": each[0]["modes"], "shows": GASES[feature]} if part == "on" else {}),
            }
        result[part] = {feature: result[part][feature] for feature in (GASES if part == "on" else SCENES)}
    result["off"] = {}
    for feature in ("nothing", *Modes._fields):
        ratio, error = middle([sample["off"][feature] for sample in samples])
        result["off"][feature] = {"ratio": ratio, "error": error}
    result["lines_of_points"] = lines["points"]
    return result


def show(result: dict[str, Any]) -> None:
    """Print the tables."""
    print("| on | ns per collision | over the plain gas | bytes per molecule | lines of code |")
    print("|---|---|---|---|---|")
    for feature, each in result["on"].items():
        cells = f"{each['ns']:.0f} | {each['ratio']:.3f} ± {each['error']:.3f} | {each['bytes']:.0f} | {each['lines']}"
        print(f"| {feature} | {cells} |")
    print("\n| with | ns per collision | over the scene without | bytes per molecule and frame | more lines of code |")
    print("|---|---|---|---|---|")
    for feature, each in result["instruments"].items():
        cells = f"{each['ns']:.0f} | {each['ratio']:.3f} ± {each['error']:.3f} | {each['bytes']:.0f} | {each['lines']}"
        print(f"| {feature} | {cells} |")
    print("\n| off | engine as it is over one without the feature |\n|---|---|")
    for feature, each in result["off"].items():
        print(f"| {feature} | {each['ratio']:.3f} ± {each['error']:.3f} |")


def main(arguments: list[str] | None = None) -> None:
    """Measure, and print the tables; or do one task of the measurement."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--n", type=int, default=4_000)
    parser.add_argument("--processes", type=int, default=12, help="over how many processes the medians are taken")
    parser.add_argument("--repeats", type=int, default=5, help="turns that everything has in a process")
    parser.add_argument("--span", type=float, default=100.0, help="reduced time of a turn")
    parser.add_argument("--folder", type=Path, help="where to keep the copies of the engine for another time")
    parser.add_argument("--trial", action="store_true", help="scenes of few molecules, to see that all works")
    parser.add_argument("--json", type=Path, help="file for the numbers")
    parser.add_argument("--seed", type=int, default=1, help=argparse.SUPPRESS)
    parser.add_argument("--only", help=argparse.SUPPRESS)
    parser.add_argument("--task", choices=["lines", "on", "off"], help=argparse.SUPPRESS)
    asked = parser.parse_args(arguments)
    if asked.task == "lines":
        print(json.dumps(count_lines(8 if asked.trial else 60)))
    elif asked.task == "on":
        print(json.dumps({"on": time_on(asked), "instruments": time_instruments(asked)}))
    elif asked.task == "off":
        print(json.dumps(time_off(asked)))
    else:
        result = measure(asked)
        show(result)
        keep(asked.json, result)


if __name__ == "__main__":
    main()

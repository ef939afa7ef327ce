"""Speed against accuracy, as `atmosbox tradeoff` has measured it."""

import math
import warnings

import numpy as np
from jobs.registry import BENCHMARKS, Findings, job, rounded

from atmosbox import theory
from atmosbox.engine import Periodic, maxwell_velocities, random_positions
from atmosbox.file.netcdf import read
from atmosbox.plot import tradeoff_figure
from atmosbox.scene import engines
from atmosbox.simulation import accuracy
from atmosbox.trade.timed_run import PROFILES

SCENES = ("lifting-dry", "atmosphere", "temperature-large")


def measured(scene: str):
    """Return what ``atmosbox tradeoff`` has written for a scene, without engines that atmosbox no longer has."""
    data = read(BENCHMARKS / f"tradeoff-{scene}.nc")
    return data.isel(configuration=[str(each).partition(":")[0] in engines.names() for each in data.engine.values])


@job("tradeoff", quick=True)
def trade(found: Findings) -> None:
    """Draw the figure of each scene."""
    for scene in SCENES:
        found.figure(tradeoff_figure.figure(measured(scene)), f"tradeoff-{scene}", 130)


@job("answer", quick=True)
def answer(found: Findings) -> None:
    """Make the table of what runs for each of the three accuracies that have a name."""
    rows = []
    for scene, table in accuracy.load().items():
        for target in accuracy.TARGETS:
            picked = accuracy.choose(scene, target)
            error = [
                f"{rounded(scale * max(of))} {unit}"
                for kind, unit, scale in (("K", "K", 1.0), ("1", "%", 100.0))
                if (of := [one.total for one in picked.way.errors.values() if one.unit == kind])
            ]
            short = "" if picked.met else " (the best there is)"
            seconds = rounded(picked.way.cost * float(table.how["seconds"]))
            name = scene if target == "sketch" else ""
            rows.append([name, target, f"`{picked.way.label}`", seconds, ", ".join(error) + short])
    found.table(["scene", "accuracy", "what runs", "seconds", "error"], rows)


@job("exact-beside", quick=True)
def exact_beside(found: Findings) -> None:
    """Lay the exact engine beside dsmc, in the scenes that run on dsmc, at the longest run measured of both."""
    rows = []
    for scene, table in accuracy.load().items():
        pairs = [
            (exact, other)
            for exact in table.ways
            for other in table.ways
            if (exact.engine, other.engine) == ("exact", "dsmc") and exact.settings == other.settings
        ]
        if not (pairs and any(way.engine == "dsmc" and way.cost == 1.0 for way in table.ways)):  # the default costs 1
            continue
        exact, other = max(pairs, key=lambda pair: pair[1].cost)
        apart = {
            name: (one.bias - other.errors[name].bias, math.hypot(one.bias_se, other.errors[name].bias_se))
            for name, one in exact.errors.items()
            if name not in PROFILES  # their error has no sign
        }
        name, (difference, error) = max(apart.items(), key=lambda each: abs(each[1][0]) / each[1][1])
        share, unit = (1.0, "K") if exact.errors[name].unit == "K" else (100.0, "%")
        rows.append(
            [scene, f"`{exact.label}`", f"{exact.members} and {other.members}", rounded(exact.cost / other.cost),
             f"{table.labels[name]}: {rounded(share * difference)} ± {rounded(share * error, 1)} {unit}"]
        )  # fmt: skip
    head = ["scene", "compared at", "runs", "time of exact / dsmc", "most significant difference"]
    found.table(head, rows)


@job("approaching")
def approaching(found: Findings) -> None:
    """Leave out the test whether a pair approaches, and count its collisions as time goes on."""
    n, phi = 2000, 0.01
    side = (n * math.pi / 6.0 / phi) ** (1.0 / 3.0)
    rng = np.random.default_rng(3)
    start = (
        random_positions((side,) * 3, np.ones(n), rng, periodic=(True,) * 3),
        maxwell_velocities(1.0, np.ones(n), rng),
    )
    expected = float(theory.collision_rate(n / side**3, 1.0, 1.0, 1.0)) * n / 2.0
    rows = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a coarse step is what is shown
        boxes = [
            engines.choose(f"stepped:delta=0.01,rule={rule}").make(
                *start, length=(side,) * 3, walls=(Periodic(),) * 6, seed=1
            )
            for rule in ("pairwise", "every-overlap")
        ]
    energy = [sum(box.energy()) for box in boxes]
    before, last = [0, 0], 0.0
    for time in (10.0, 20.0, 40.0, 80.0):
        row = [f"{last:g} to {time:g}"]
        for k, box in enumerate(boxes):
            box.advance(time)
            row.append(f"{(box.contacts - before[k]) / (expected * (time - last)):.2f}")
            before[k] = box.contacts
        row += [rounded(abs(sum(box.energy()) / e - 1.0), 1) for box, e in zip(boxes, energy, strict=True)]
        rows.append(row)
        last = time
    found.table(
        ["time [σ/√(kT/m)]", "collisions over theory", "without the test", "change of the energy", "without the test"],
        rows,
    )

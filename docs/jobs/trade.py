"""Speed against accuracy, as `atmosbox tradeoff` has measured it."""

import json
import math
import warnings

import numpy as np
from jobs.registry import ROOT, Findings, job, rounded

from atmosbox import scenarios, theory
from atmosbox.engine import Periodic, maxwell_velocities, random_positions
from atmosbox.file.netcdf import read
from atmosbox.plot import tradeoff_figure
from atmosbox.scene import engines
from atmosbox.simulation import accuracy

FOLDER = ROOT / "benchmarks"
SCENES = ("lifting-dry", "atmosphere", "temperature-large")


def measured(scene: str):
    """Return what ``atmosbox tradeoff`` has written for a scene, without engines that atmosbox no longer has."""
    data = read(FOLDER / f"tradeoff-{scene}.nc")
    return data.isel(rung=[str(each).partition(":")[0] in engines.names() for each in data.engine.values])


def percent(one) -> float:
    """Return by how much an error is multiplied in the unit in which it is shown."""
    return 1.0 if str(one.unit.values) == "K" else 100.0


@job("tradeoff", quick=True)
def trade(found: Findings) -> None:
    """Draw the figure and make the table of each scene."""
    for scene in SCENES:
        data = measured(scene)
        found.figure(tradeoff_figure.figure(data), f"tradeoff-{scene}", 130)
        names = tradeoff_figure.foremost(data)
        units = ["K" if str(data.unit.sel(quantity=name).item()) == "K" else "%" for name in names]
        head = ["run", "cost", "runs"]
        head += [f"{data.label.sel(quantity=n).item()} [{u}]" for n, u in zip(names, units, strict=True)]
        settings = scenarios.load(scene).Settings
        rows: dict[str, list[object]] = {}
        for k in np.argsort(np.nan_to_num(data.cost.values, nan=math.inf), kind="stable"):
            if not int(data.members.values[k]):
                continue
            row: list[object] = [rounded(float(data.cost.values[k])), int(data.members.values[k])]
            for name in names:
                one = data.isel(rung=k).sel(quantity=name)
                bias, se, noise = (percent(one) * one[key].item() for key in ("bias", "bias_se", "noise"))
                row.append(f"{rounded(bias)} ± {rounded(se, 1)} ({rounded(noise, 1)})" if math.isfinite(bias) else "–")
            # two series may share a way of running: it is named by what differs from the scene
            changed = settings.from_user(json.loads(str(data.settings.values[k]))).changed()
            way = ", ".join([str(data.engine.values[k]), *(f"{name}={value}" for name, value in changed.items())])
            rows.setdefault(way, row)
        found.table(head, [[f"`{way}`", *row] for way, row in rows.items()], key=scene)
        found.number(f"{scene}-escaped", int(np.nanmax(data.escaped.values)))


@job("answer", quick=True)
def answer(found: Findings) -> None:
    """Make the table of what to type in class, for homework and for a paper."""
    rows = []
    for scene, table in accuracy.load().items():
        for purpose, target in (("class", "sketch"), ("homework", "lecture"), ("paper", "reference")):
            picked = accuracy.choose(scene, target)
            seconds = picked.way.cost * float(table.how["seconds"])
            worst = {
                unit: max((one.total for one in picked.way.errors.values() if one.unit == unit), default=math.nan)
                for unit in ("K", "1")
            }
            error = [f"{rounded(worst['K'])} K"] if worst["K"] > 0.0 else []
            error += [f"{rounded(100.0 * worst['1'])} %"] if worst["1"] > 0.0 else []
            short = "" if picked.met else " (the best there is)"
            rows.append(
                [scene if purpose == "class" else "", purpose, f"`atmosbox run {scene} --accuracy {target}`",
                 f"`{picked.way.label}`", rounded(seconds), ", ".join(error) + short]
            )  # fmt: skip
    found.table(["scene", "for", "type", "what runs", "seconds", "error"], rows)


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
        found.number(scene, rounded(exact.cost / other.cost))
        apart = {
            name: (one.bias - other.errors[name].bias, math.hypot(one.bias_se, other.errors[name].bias_se))
            for name, one in exact.errors.items()
        }
        name, (difference, error) = max(apart.items(), key=lambda each: abs(each[1][0]) / each[1][1])
        share, unit = (1.0, "K") if exact.errors[name].unit == "K" else (100.0, "%")
        rows.append(
            [scene, f"`{exact.label}`", f"{exact.members} and {other.members}", rounded(exact.cost / other.cost),
             f"{table.labels[name]}: {rounded(share * difference)} ± {rounded(share * error, 1)} {unit}"]
        )  # fmt: skip
    head = ["scene", "compared at", "runs", "times as long", "what differs most, in units of its error"]
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


@job("precision", quick=True)
def precision(found: Findings) -> None:
    """Make the tables of what single precision would gain dsmc, and of what it would cost."""
    data = json.loads((FOLDER / "precision.json").read_text(encoding="utf-8"))
    rows = [
        [f"{one['molecules']:,}", *(f"{each / 1e6:.0f}" for each in one["moves_per_cpu_second"]),
         f"{one['ratio']:.2f}", *(f"{each:.0f}" for each in one["bytes_per_molecule"])] for one in data["pace"]
    ]  # fmt: skip
    head = ["molecules", "million moves per second, 64 bits", "32 bits", "times faster"]
    found.table([*head, "bytes per molecule, 64 bits", "32 bits"], rows, key="pace")
    rows = [[rounded(one["gain"]), *(f"{rounded(100.0 * each, 1)} %" for each in one["error"])] for one in data["fall"]]
    found.table(["gain of a step over the thermal speed", "error of the fall, 64 bits", "32 bits"], rows, key="fall")
    found.number("energy", rounded(data["energy"]["error"][1], 1))
    found.number("steps", data["energy"]["steps"])

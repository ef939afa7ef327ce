"""Speed against accuracy, as `atmosbox tradeoff` has measured it."""

import math

import numpy as np
from jobs.registry import ROOT, Findings, job, rounded

from atmosbox.output import read
from atmosbox.plot import tradeoff

FOLDER = ROOT / "benchmarks"
SCENES = ("lifting-dry", "atmosphere", "temperature-large")


def measured(scene: str):
    """Return what ``atmosbox tradeoff`` has written for a scene."""
    return read(FOLDER / f"tradeoff-{scene}.nc")


def percent(one) -> float:
    """Return by how much an error is multiplied in the unit in which it is shown."""
    return 1.0 if str(one.unit.values) == "K" else 100.0


@job("tradeoff", quick=True)
def trade(found: Findings) -> None:
    """Draw the figure and make the table of each scene."""
    for scene in SCENES:
        data = measured(scene)
        found.figure(tradeoff.figure(data), f"tradeoff-{scene}", 130)
        names = tradeoff.foremost(data)
        units = ["K" if str(data.unit.sel(quantity=name).item()) == "K" else "%" for name in names]
        head = ["run", "cost", "runs"]
        head += [f"{data.label.sel(quantity=n).item()} [{u}]" for n, u in zip(names, units, strict=True)]
        rows = []
        for k in np.argsort(np.nan_to_num(data.cost.values, nan=math.inf), kind="stable"):
            if not int(data.members.values[k]):
                continue
            row = [f"`{data.rung.values[k]}`", rounded(float(data.cost.values[k])), int(data.members.values[k])]
            for name in names:
                one = data.isel(rung=k).sel(quantity=name)
                bias, se, noise = (percent(one) * one[key].item() for key in ("bias", "bias_se", "noise"))
                row.append(f"{rounded(bias)} ± {rounded(se, 1)} ({rounded(noise, 1)})" if math.isfinite(bias) else "–")
            rows.append(row)
        found.table(head, rows, key=scene)
        drift = float(np.nanmax(np.abs(data.energy_drift.values)))
        found.number(f"{scene}-drift", rounded(drift))
        found.number(f"{scene}-escaped", int(np.nanmax(data.escaped.values)))

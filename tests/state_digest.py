"""Digests of the final state of a short run of each scene; `state_digest.json` holds the expected ones.

``python state_digest.py CASE...`` prints the digests of some cases, or of all, as JSON.
"""

import hashlib
import json
import sys
import warnings
from typing import Any, NamedTuple

import numpy as np

from atmosbox.simulation.preparation import build, prepare


class Case(NamedTuple):
    """A scene with a few molecules, the share of its time that it runs, and its engine."""

    scene: str
    settings: dict[str, Any]
    share: float
    engine: str = "exact"


FEW = {"molecules": 200, "diameter": "1.6nm"}
CASES = {
    "temperature": Case("temperature", {"molecules": 60}, 0.02),
    "elastic-collisions": Case("elastic-collisions", {}, 0.05),
    "atmosphere": Case("atmosphere", {"molecules": 100}, 0.005),
    "atmosphere-plane": Case("atmosphere", {"molecules": 100, "plane": True, "start": "uniform"}, 0.005),
    "lifting-dry": Case("lifting-dry", {"molecules": 100, "ascent": 20}, 0.2),
    "lifting-dry-smooth": Case("lifting-dry", {"molecules": 300, "ascent": 20, "rotation": False}, 0.1),
    "lifting-moist": Case("lifting-moist", FEW | {"ascent": 20}, 0.1),
    "lifting-sounding": Case("lifting-sounding", FEW | {"ascent": 20}, 0.1),
    "mountains": Case("mountains", FEW | {"travel": 40}, 0.1),
    "condensation": Case("condensation", {"molecules": 100}, 0.01),
    "condensation-drops": Case("condensation", {"molecules": 500, "drops": 4}, 0.002),
    "nuclei": Case("nuclei", {"molecules": 500, "humidity": 300, "pure": 2}, 0.02),
    "evaporation": Case("evaporation", {"molecules": 200}, 0.01),
    "diffusion": Case("diffusion", {"molecules": 1000}, 0.002),
    "attraction": Case("attraction", {"molecules": 200}, 0.001),
    "attraction-vapour": Case("attraction", {"molecules": 200, "start": "vapour", "air": 0.5, "bath": "walls"}, 0.002),
    "stepped": Case("temperature", {"molecules": 60}, 0.002, "stepped:delta=0.1"),
    "dsmc": Case("temperature", {"molecules": 60}, 0.02, "dsmc"),
    "dsmc-moist": Case("lifting-moist", FEW | {"ascent": 20}, 0.1, "dsmc"),
    "applet": Case("elastic-collisions", {"molecules": 30}, 0.01, "stepped:applet-discs"),
}


def digest(name: str) -> str:
    """Return a digest of all molecules and all counters after a short run."""
    case = CASES[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a coarse step will do
        setup = build(prepare(case.scene, case.settings | {"seed": 7}, engine=case.engine))
    parcel = setup.parcel
    for part in (0.5, 1.0):
        parcel.advance(part * case.share * setup.duration)
    assert parcel.contacts > 0
    gas = parcel.snapshot()
    numbers = [parcel.time, *parcel.energy(), parcel.work, parcel.ceiling, parcel.condensed_energy, parcel.contacts]
    columns = [*gas[1:], parcel.present, parcel.wall_heat, parcel.wall_impulse, parcel.virial, np.array(numbers, float)]
    return hashlib.sha256(b"".join(np.ascontiguousarray(each).tobytes() for each in columns)).hexdigest()[:16]


if __name__ == "__main__":
    print(json.dumps({name: digest(name) for name in sys.argv[1:] or CASES}, indent=1))

"""The scene of the column: in a plane, and with an engine whose molecules have no excluded volume.

Means allow 4 standard errors from 20 blocks: a false alarm once in 1 500 per comparison for a fresh seed (there are
some 90 here), and never for these.
"""

import json

import numpy as np
import pytest

from atmosbox.engine import ParcelSet
from atmosbox.scene import engines
from atmosbox.scene.engines import engine_choice
from atmosbox.scene.statistics import block_average
from atmosbox.simulation import runner


def run(**settings):
    return runner.execute(runner.prepare("atmosphere", settings), command="atmosbox run atmosphere")


def facts(engine=engines.EXACT, **settings):
    prepared = runner.prepare("atmosphere", settings)
    return prepared.module.build(prepared.settings, engine).facts


@pytest.fixture
def ideal(monkeypatch):
    """Return an engine that says of itself that its molecules have no excluded volume."""
    each = engines.Engine("roomless", "molecules without volume", lambda: ParcelSet, ideal=True)
    monkeypatch.setattr(engine_choice, "ENGINES", {**engines.ENGINES, each.name: each})
    return engines.EngineChoice(each)


@pytest.mark.parametrize(("floor", "start"), [("heat-bath", "equilibrium"), ("isolated", "bottom")])
def test_a_plane_column_stands_presses_and_warms_as_hydrostatics_of_discs_say(floor, start):
    outcome = run(plane=True, molecules=300, knudsen=0.1, duration=2000.0, floor=floor, start=start)
    assert outcome.ledger < 1e-12
    assert len(outcome.headlines) == 3
    for each in outcome.headlines:
        assert abs(each.value - each.theory) <= 4.0 * each.standard_error + each.tolerance, each.name
    found = outcome.dataset
    low = found.height.values < 15e3
    for name in ("number_density", "layer_pressure", "layer_temperature"):
        truth, error = found[f"{name}_theory"].values, found[f"{name}_se"].values
        # discs pile up a little along the floor, of which the bulk's equation of state knows nothing
        allowed = 4.0 * error + 0.005 * truth
        assert (np.abs(found[name].values - truth) <= allowed)[low][1:].all(), name
        assert (error / truth)[low].max() < 0.04, name
    pressure, error = block_average(found.wall_pressure.values[40:, 4])
    if floor == "heat-bath":
        assert abs(pressure - 101_325.0) <= 4.0 * error + 0.005 * pressure
        assert error < 0.005 * pressure


def test_the_facts_of_a_plane_column_are_those_of_discs():
    plane, space = facts(plane=True), facts()
    assert plane["gamma"].startswith("2:")
    assert space["gamma"].startswith("5/3:")
    assert plane["exaggeration"].startswith("discs 3.1 m wide")
    assert "slab 8.43 km thick" in plane["box"]
    # as many molecules stand for as much air
    assert plane["weight of a molecule"] == space["weight of a molecule"]
    assert plane["scale height"] == space["scale height"]


@pytest.mark.parametrize("plane", [False, True])
def test_the_theory_of_molecules_without_volume_is_barometric(ideal, plane):
    settings = {"plane": plane, "molecules": 300, "knudsen": 0.05, "duration": 1.0}
    prepared = runner.prepare("atmosphere", settings)
    hard = run(**settings).dataset
    parameters = json.loads(hard.attrs["atmosbox_parameters"]) | {"engine": str(ideal)}
    roomless = hard.assign_attrs(atmosbox_parameters=json.dumps(parameters))
    theory = [prepared.module.theory(dataset, prepared.settings) for dataset in (hard, roomless)]
    for name in ("number_density", "layer_pressure"):
        points = theory[0][f"{name}_barometric"]
        assert np.array_equal(points, theory[1][f"{name}_barometric"])
        assert np.allclose(theory[1][f"{name}_theory"], points, rtol=1e-12, atol=0.0)
        assert np.abs(theory[0][f"{name}_theory"] / points - 1.0).max() > 0.05
    heights = [
        next(each.theory for each in prepared.module.headlines(dataset, prepared.settings) if each.unit == "m")
        for dataset in (hard, roomless)
    ]
    assert heights[1] < 0.99 * heights[0]
    assert "without excluded volume" in facts(ideal, **settings)["exaggeration"]
    assert "excluded volume" not in facts(**settings)["exaggeration"]

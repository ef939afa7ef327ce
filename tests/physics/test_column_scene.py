"""The scene of the column: in a plane, and with an engine whose molecules have no excluded volume.

Means allow 4 standard errors from 20 blocks: a false alarm once in 1 500 per comparison for a fresh seed (there are
some 90 here), and never for these.
"""

import json
import math

import numpy as np
import pytest

from atmosbox.engine import ParcelSet
from atmosbox.scene import engines
from atmosbox.scene.engines import engine_choice
from atmosbox.scene.statistics import block_average
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR


def run(**settings):
    return runner.execute(runner.prepare("atmosphere", settings), command="atmosbox run atmosphere")


def facts(engine=engines.EXACT, **settings):
    prepared = runner.prepare("atmosphere", settings)
    return prepared.module.build(prepared.settings, engine).facts


@pytest.fixture
def ideal(monkeypatch):
    """Return an engine that declares that its molecules have no excluded volume."""
    each = engines.Engine("roomless", "molecules without volume", lambda: ParcelSet, ideal=True)
    monkeypatch.setattr(engine_choice, "ENGINES", {**engines.ENGINES, each.name: each})
    return engines.EngineChoice(each)


@pytest.mark.parametrize(("floor", "start"), [("heat-bath", "equilibrium"), ("isolated", "bottom")])
def test_a_plane_column_stands_presses_and_warms_as_hydrostatics_of_discs_say(floor, start):
    outcome = run(plane=True, molecules=300, knudsen=0.1, duration=2000.0, floor=floor, start=start)
    assert outcome.ledger < 1e-12
    assert len(outcome.headlines) == 5
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


def test_the_barometric_law_is_that_of_the_textbook():
    found = run(molecules=60, duration=5.0, start="equilibrium").dataset
    scale_height = BOLTZMANN * 288.15 / (DRY_AIR.molecule_mass * 9.80665)
    law = 101_325.0 * np.exp(-found.height.values / scale_height)
    assert law[0] == pytest.approx(95_493.0, abs=1.0)  # 954.9 hPa at 500 m
    assert np.allclose(found.layer_pressure_barometric, law, rtol=1e-12)
    assert np.allclose(found.number_density_barometric, law / (BOLTZMANN * 288.15), rtol=1e-12)


@pytest.mark.parametrize(
    ("corner", "points"),
    [
        ({"gravity": 100, "temperature": 50, "height": 100}, 143.5),
        ({"temperature": 10, "height": 1000}, 292.7),
        ({"temperature": 2000, "height": 3}, 1487.2),
        ({}, 7074.0),
    ],
)
def test_the_mean_height_is_that_of_the_closed_form_however_high_the_column(corner, points):
    settings = {"molecules": 60, "duration": 5.0, "start": "equilibrium", **corner}
    prepared = runner.prepare("atmosphere", settings, engine="dsmc")  # its molecules have no volume
    stated = {each.name: each for each in runner.execute(prepared).headlines}["mean_height"]
    si = prepared.settings.si
    scale_height = BOLTZMANN * si.temperature / (DRY_AIR.molecule_mass * si.gravity)

    def closed(high):
        return high * (scale_height / high - 1.0 / math.expm1(min(high / scale_height, 700.0)))

    assert closed(si.height) == pytest.approx(points, rel=1e-3)
    # centres are between one radius above the floor and one below the ceiling
    radius = 0.5 * prepared.module.Column(prepared.settings).diameter * scale_height
    assert stated.theory == pytest.approx(radius + closed(si.height - 2.0 * radius), rel=1e-12)


@pytest.mark.parametrize("plane", [False, True])
def test_the_theory_of_molecules_without_volume_is_barometric(ideal, plane):
    settings = {"plane": plane, "molecules": 300, "knudsen": 0.05, "duration": 1.0, "start": "equilibrium"}
    prepared = runner.prepare("atmosphere", settings)
    hard = run(**settings).dataset
    parameters = json.loads(hard.attrs["atmosbox_parameters"]) | {"engine": str(ideal)}
    roomless = hard.assign_attrs(atmosbox_parameters=json.dumps(parameters))
    theory = [prepared.module.theory(dataset, prepared.settings) for dataset in (hard, roomless)]
    # layers between the walls follow the exponential; only half a diameter at each wall has no centres
    scale_height = BOLTZMANN * 288.15 / (DRY_AIR.molecule_mass * 9.80665)
    radius = 0.5 * prepared.module.Column(prepared.settings).diameter * scale_height
    edges = np.clip(np.append(hard.height_bnds[:, 0], hard.height_bnds[-1, 1]), radius, 25e3 - radius)
    above = np.exp(-edges / scale_height)
    share = -np.diff(above) / (above[0] - above[-1])
    for name in ("number_density", "layer_pressure"):
        found = theory[1][f"{name}_theory"]
        assert np.allclose(found / found.sum(), share, rtol=1e-11, atol=0.0)
        assert np.array_equal(theory[0][f"{name}_barometric"], theory[1][f"{name}_barometric"])
        assert np.abs(theory[0][f"{name}_theory"] / found - 1.0).max() > 0.05
    heights = [
        next(each.theory for each in prepared.module.headlines(dataset, prepared.settings) if each.unit == "m")
        for dataset in (hard, roomless)
    ]
    assert heights[1] < 0.99 * heights[0]
    assert "without excluded volume" in facts(ideal, **settings)["exaggeration"]
    assert "excluded volume" not in facts(**settings)["exaggeration"]


def test_a_column_that_starts_uniform_falls_warms_and_comes_to_the_profile_of_equilibrium():
    """Measured in eight runs: the mean height of the air, and its temperature, before and after it has settled."""
    settings = {"molecules": 400, "duration": 200.0, "engine": "dsmc"}
    outcomes = []
    for seed in range(8):
        prepared = runner.prepare("atmosphere", {k: v for k, v in settings.items() if k != "engine"} | {"seed": seed},
                                  engine="dsmc")  # fmt: skip
        outcomes.append(runner.execute(prepared))
    frame = 200.0 / 240.0
    warm = np.mean([each.dataset.air_temperature.values for each in outcomes], axis=0)
    column = prepared.module.Column(prepared.settings, prepared.engine)
    units = 400.0 * column.scale.total_energy
    height = np.mean([each.dataset.potential_energy.values for each in outcomes], axis=0) / units
    # it starts at half the height of the ceiling, and a third of a scale height's work goes into heat on the way down
    assert height[0] > 1.2
    assert warm[int(1.0 / frame) : int(3.0 / frame)].mean() > 310.0
    settled = prepared.module._settled(column, prepared.settings)
    assert settled == 40
    assert settled * frame > column.settling(prepared.settings) > 4.0 * column.memory
    names = ("mean_temperature", "mean_height")
    mean = np.array(
        [[each.value - each.theory for each in outcome.headlines if each.name in names] for outcome in outcomes]
    )
    error = mean.std(axis=0, ddof=1) / math.sqrt(len(outcomes))
    assert (np.abs(mean.mean(axis=0)) <= 4.0 * error).all()
    assert (error < [0.9, 40.0]).all()

"""The scene of the column: in a plane, and with an engine whose molecules have no excluded volume.

Means allow 4 standard errors from 20 blocks: a false alarm once in 1 500 per comparison for a fresh seed (there are
some 90 here), and never for these.
"""

import math

import numpy as np
import pytest

from atmosbox.scene.statistics import block_average
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR


def run(**settings):
    return runner.execute(runner.prepare("atmosphere", settings), command="atmosbox run atmosphere")


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


def test_a_column_that_starts_uniform_falls_warms_and_comes_to_the_profile_of_equilibrium():
    """Measured in five runs: the mean height of the air, and its temperature, before and after it has settled."""
    settings = {"molecules": 400, "duration": 200.0, "engine": "dsmc"}
    outcomes = []
    for seed in range(5):
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

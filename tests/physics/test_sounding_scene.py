"""The scene lifting-sounding: any format, any stability, and what is refused."""

import functools
import math

import numpy as np
import pytest

from atmosbox import scenarios, theory
from atmosbox.scene import sounding
from atmosbox.simulation import runner
from atmosbox.simulation.verification import verify

SCENE = "lifting-sounding"
SMALL = {"molecules": 1000, "ascent": 60}
PRESSURE = (1000.0, 925.0, 850.0, 700.0, 500.0, 400.0, 300.0, 250.0)
STABLE = (20.0, 19.0, 18.0, 10.0, -5.0, -15.0, -30.0, -38.0)
LOADED = (30.0, 24.0, 18.0, 6.0, -14.0, -26.0, -42.0, -51.0)


def csv(path, temperature, dewpoint):
    rows = zip(PRESSURE, temperature, dewpoint, strict=True)
    lines = ["pressure [hPa],temperature [degC],dewpoint [degC]", *(",".join(map(str, row)) for row in rows)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return str(path)


@functools.cache
def outcome(**settings):
    """Return the outcome of a run, which several tests may read."""
    return runner.execute(runner.prepare(SCENE, SMALL | settings))


def headline(found, name):
    return next((each for each in found.headlines if each.name == name), None)


def test_the_built_in_sounding_is_weisman_and_klemps_and_passes_its_own_check():
    # of a thousand molecules nineteen are water, too few for theories that assume many
    found = outcome(molecules=4000, ascent=100)
    assert all(check.passed for check in verify(found.dataset))
    air = sounding.weisman_klemp()
    assert found.dataset.environment_temperature.values[0] == pytest.approx(air.temperature[0], abs=1.0)
    for name, near in (("metpy_cape", 0.05), ("metpy_lcl", 0.002), ("metpy_el", 0.04)):
        of_metpy = headline(found, name)
        assert (of_metpy.program, of_metpy.verdict) == ("MetPy", None)
        assert of_metpy.value == pytest.approx(of_metpy.theory, rel=near)


def test_the_buoyancy_is_that_of_the_weight_of_all_that_the_parcel_holds():
    data = outcome().dataset
    warmer = data.parcel_virtual_temperature.values - data.parcel_temperature.values
    vapour, liquid = data.humidity_mixing_ratio.values, data.cloud_liquid_water_mixing_ratio.values
    # T_v is T (1 + 0.608 r) to a percent of the difference, and each gram of liquid counts as a thousandth of T
    assert warmer == pytest.approx(0.608 * vapour * data.parcel_temperature.values, rel=0.02)
    loaded = data.parcel_virtual_temperature.values / data.parcel_density_temperature.values - 1.0
    assert loaded == pytest.approx(liquid, rel=0.03)
    assert liquid.max() > 0.01
    air = sounding.weisman_klemp()
    levels = -np.log(air.pressure)
    moist = theory.mixing_ratio(theory.saturation_vapor_pressure(air.dewpoint), air.pressure)
    around = np.interp(-np.log(data.parcel_pressure), levels, theory.virtual_temperature(air.temperature, moist))
    expected = theory.parcel_buoyancy(data.parcel_density_temperature, around)
    # the scene interpolates temperature and dewpoint, which is not quite the same between levels 250 m apart
    assert data.parcel_buoyancy.values == pytest.approx(np.asarray(expected), abs=0.002)


def test_a_cloud_that_carries_its_water_has_half_the_energy_of_one_that_does_not_weigh():
    module = scenarios.load(SCENE)
    settings = runner.prepare(SCENE, {"molecules": 1_000_000}).settings
    loaded, light = (module._convection(settings, weight=weight).cape for weight in (True, False))
    # computed independently, at 14 g/kg: 1253 J/kg with the weight of the water, 2212 without
    assert loaded == pytest.approx(1253.0, abs=15.0)
    assert light == pytest.approx(2212.0, abs=15.0)


def test_a_stable_sounding_has_no_energy_and_the_word_for_it(tmp_path):
    path = csv(tmp_path / "stable.csv", STABLE, [t - 3.0 for t in STABLE])
    found = outcome(sounding=path)
    # few molecules may be buoyant for a moment at the ground, where both temperatures are the same
    assert 0.0 <= headline(found, "cape").theory < 5.0
    assert 0.0 <= headline(found, "cape").value < 5.0
    assert headline(found, "lfc") is None
    assert runner.card(runner.prepare(SCENE, {"sounding": path})).facts[-1] == ("verdict", "stable")
    assert math.isfinite(headline(found, "cape").value)


def test_moist_air_below_cold_air_is_unstable(tmp_path):
    path = csv(tmp_path / "loaded.csv", LOADED, [24.0, 20.0, 14.0, 0.0, -25.0, -40.0, -60.0, -70.0])
    facts = dict(runner.card(runner.prepare(SCENE, {"sounding": path})).facts)
    assert facts["verdict"] in ("unstable", "conditionally unstable")
    module = scenarios.load(SCENE)
    energy = module._convection(runner.prepare(SCENE, {"sounding": path}).settings)
    assert energy.cape > 1000.0
    # MetPy's own, to five percent
    metpy = sounding.indices(sounding.read(path))
    settings = runner.prepare(SCENE, {"sounding": path, "rain": True, "cloud_water": 0.0}).settings
    rows = {each.name: each for each in module._metpy(settings)}
    assert rows["metpy_cape"].value == metpy.cape
    assert rows["metpy_cape"].theory == pytest.approx(metpy.cape, rel=0.05)

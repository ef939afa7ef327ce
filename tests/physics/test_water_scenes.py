"""The scenes condensation, lifting-moist and mountains: their results, extreme settings, and refusals.

Headlines allow 4 standard errors and the known error of the model: a false alarm once in 1 500 per number for a
fresh seed, and never for these. Runs are short and of few molecules, so their errors are large; docs/jobs measures
the same more finely.
"""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from atmosbox import scenarios, theory
from atmosbox.engine.core.jit import COMPILED
from atmosbox.file.netcdf import read, write
from atmosbox.file.variables import VARIABLES
from atmosbox.scene.ascent.drawn_parcels import along_frames, draw, entropy_gain, gathered, walk
from atmosbox.simulation import runner

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")

SHORT = {
    "condensation": {"molecules": 2000, "duration": 8.0},
    "lifting-moist": {"molecules": 3000, "ascent": 150},
    "mountains": {"molecules": 3000, "travel": 200, "cloud_water": 3.0},
}
DRY = {"condensation": {"humidity": 0.0}, "lifting-moist": {"dewpoint": -100.0}, "mountains": {"dewpoint": -80.0}}
COLD = {
    "condensation": {"temperature": -60.0},
    "lifting-moist": {"temperature": -60.0, "dewpoint": -60.0},
    "mountains": {"temperature": -40.0, "dewpoint": -40.0},
}
FEW = {
    "condensation": {"molecules": 50, "duration": 20.0},
    "lifting-moist": {"molecules": 200},
    "mountains": {"molecules": 200},
}


LONG = pytest.param("mountains", marks=pytest.mark.nightly)
"""A run of the mountains takes two seconds; its balances are checked in the runs with rain or saved molecules."""


def run(scene, save_molecules=False, **settings):
    return runner.execute(runner.prepare(scene, {**SHORT[scene], **settings}, save_molecules=save_molecules))


def found(outcome):
    return {each.name: each for each in outcome.headlines}


def is_sound(outcome):
    """Check the balances of a run to rounding, and that no value is NaN."""
    assert outcome.ledger < 1e-11
    assert outcome.escaped == 0
    data = outcome.dataset
    kept = [name for name in data.data_vars if name in VARIABLES and VARIABLES[name].ledger]
    assert {"kinetic_energy", "condensed_energy"} <= {*map(str, kept)}
    assert not [name for name in kept if not np.isfinite(data[name].values).all()]
    loose = [name for name in data.data_vars if data[name].dtype.kind == "f" and data[name].isnull().any()]
    assert loose in ([], ["wall_temperature"])  # a smooth wall has none
    water = data.vapor_molecule_count + data.liquid_molecule_count + data.rained_molecule_count
    assert (water == water[0]).all()
    assert (data.vapor_molecule_count >= 0).all()


@pytest.mark.parametrize("scene", ["condensation", "lifting-moist", LONG])
@pytest.mark.parametrize(
    "extreme",
    [*(pytest.param(each, marks=pytest.mark.nightly) for each in (DRY, COLD)), FEW],  # without vapour: other kernels
    ids=["dry", "cold", "few"],
)
def test_energy_and_water_are_kept_at_extreme_settings(scene, extreme):
    outcome = run(scene, **extreme[scene])
    is_sound(outcome)
    assert outcome.headlines
    for each in outcome.headlines:
        assert math.isfinite(each.value)
        assert math.isfinite(each.standard_error)
    if extreme is not FEW:
        assert "cloud_base" not in found(outcome)
        assert all(each.agrees for each in outcome.headlines)


@pytest.mark.nightly  # without vapour it needs other kernels
def test_a_parcel_too_dry_for_a_cloud_follows_the_dry_adiabat_and_states_no_base():
    outcome = run("lifting-moist", dewpoint=-80.0, ascent=300)
    dry = outcome.dataset
    assert "cloud_base" not in found(outcome)
    assert not dry.liquid_molecule_count.any()
    # the nuclei, half a percent of the heat capacity, keep it a little warmer
    expected = theory.dry_adiabat_temperature(dry.parcel_pressure.values / 100.0, 298.15, 1000.0, 5)
    assert dry.adiabat_temperature.values == pytest.approx(expected, rel=3e-3)
    assert "Too dry for a cloud" in dry.attrs["atmosbox_panels"]


def allowed_at(settings, level):
    """Return the deviation of lifting-moist that chance may cause at a level [K]: four standard errors."""
    ascent = scenarios.load("lifting-moist")._ascent(settings)
    outside = np.exp(np.interp((np.arange(60) + 0.5) / 60, np.linspace(0.0, 1.0, 400), np.log(ascent.route)))
    near = int(np.argmin(np.abs(outside - level)))
    near = slice(min(max(near - 3, 0), 53), min(max(near - 3, 0), 53) + 7)
    chance = float(draw(ascent, outside, 60, 10, ideal=False).warmth[:, near].mean(axis=1).std())
    warmth = float(ascent.planned_at(level).temperature[0])
    return 4.0 * chance * warmth


def test_neither_a_tenth_less_water_nor_a_pseudo_adiabat_is_within_what_is_allowed_by_default():
    settings = runner.prepare("lifting-moist", {}).settings
    ascent = scenarios.load("lifting-moist")._ascent(settings)
    levels = np.array([700e2, 500e2, 300e2])
    start = ascent.pressure, ascent.temperature
    right, less, pseudo = (
        theory.parcel_path(levels, *start, share * ascent.total_water, keeps, ascent.nuclei_heat).temperature
        for share, keeps in ((1.0, math.inf), (0.9, math.inf), (1.0, 0.0))
    )
    allowed = np.array([allowed_at(settings, level) for level in levels])
    # one standard error is left for chance: 1.2, 1.6 and 2.3 K of less water, 1.4 K at 300 hPa of a pseudo-adiabat
    assert (allowed < 0.85 * (right - less)).all()
    assert allowed[2] < 0.85 * (right - pseudo)[2]


def test_rain_takes_what_the_cloud_may_not_hold_and_no_rain_takes_nothing():
    rain = {"rain": True, "cloud_water": 0.0}
    keeps, rains = (run("lifting-moist", molecules=1000, **more) for more in ({}, rain))
    is_sound(rains)
    assert "rain_mixing_ratio" not in keeps.dataset
    fallen, held = rains.dataset.rain_mixing_ratio.values, rains.dataset.cloud_liquid_water_mixing_ratio.values
    assert (np.diff(fallen) >= 0.0).all()
    assert fallen[-1] > 0.6 * float(keeps.dataset.cloud_liquid_water_mixing_ratio[-1])
    assert held[-10:].mean() < 0.2 * float(keeps.dataset.cloud_liquid_water_mixing_ratio[-10:].mean())


def test_air_that_rained_on_the_mountains_arrives_warmer_than_air_that_did_not():
    # 5.4 K are expected, and with this many molecules the error of the difference is 0.5 K
    more = {"molecules": 6000, "cloud_water": 2.0}
    outcomes = {rain: run("mountains", rain=rain, **more) for rain in (True, False)}
    for outcome in outcomes.values():
        is_sound(outcome)
    ends = {rain: found(outcome)["arrival_temperature"] for rain, outcome in outcomes.items()}
    assert 0.0 < ends[False].theory - 298.15 < 1.0  # what so fast a journey adds
    assert ends[True].theory - ends[False].theory > 2.0
    gap = ends[True].value - ends[False].value
    assert gap > 4.0 * math.hypot(ends[True].standard_error, ends[False].standard_error)


# ------------------------------------------------------------------ the molecules themselves


@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        ("condensation", {"molecules": 1000, "humidity": 300.0}),
        ("mountains", {"molecules": 1000, "travel": 60, "cloud_water": 0.0}),
        ("evaporation", {"molecules": 400, "pool": 60, "duration": 2.0}),
    ],
)
def test_saved_molecules_keep_their_number_and_have_no_place_in_the_liquid(scene, settings, tmp_path):
    outcome = runner.execute(runner.prepare(scene, settings, save_molecules=True))
    data = read(write(outcome.dataset, tmp_path / "molecules.nc"))
    nowhere = np.isnan(data.molecule_speed.values)
    assert (np.isnan(data.molecule_position.values) == nowhere[:, :, None]).all()
    absent = (data.liquid_molecule_count + data.rained_molecule_count).values
    assert (nowhere.sum(axis=1) == absent).all()
    assert absent.any()
    water = data.species.values == 1
    assert list(data.species.attrs["flag_meanings"].split()) == ["dry_air", "water"]
    assert not nowhere[:, ~water].any()
    assert water.sum() == int(data.vapor_molecule_count[0] + absent[0])
    assert all(check.passed for check in runner.verify(data) if check.name in ("finite", "ledger", "balance"))
    assert json.loads(data.attrs["atmosbox_parameters"])["save_molecules"] is True
    if scene == "condensation":
        one = np.flatnonzero(water & (nowhere.sum(axis=0) > 0))[0]
        seen = data.molecule_position.values[~nowhere[:, one], one]
        assert (seen >= 0.0).all()


def test_the_pushes_of_molecules_on_droplets_that_flow_with_the_air_are_those_of_kinetic_theory():
    ascent = scenarios.load("lifting-moist")._ascent(runner.prepare("lifting-moist", {}).settings)
    outside = np.geomspace(1e5, 3e4, 60)
    cloud = along_frames(ascent, outside, 60, 1, ideal=False)
    gain = entropy_gain(cloud)
    pushes = (gain.variance - 2.0 * (gain.friction + gain.condensing))[30]
    rng = np.random.default_rng(1)
    # those that hit have the energy Gamma(2) kT before and after, and come from anywhere
    before, after = (np.sqrt(2.0 * rng.gamma(2.0, size=400_000)) * rng.uniform(-1.0, 1.0, 400_000) for _ in range(2))
    work = cloud.expansion[30] * cloud.height[30] * rng.uniform(size=400_000) * (after - before)
    # the mean square is known to 0.3 %
    assert pushes == pytest.approx(np.mean(work**2) * cloud.hits[30], rel=0.015)


def test_parcels_drawn_at_random_scatter_as_the_liquid_and_the_entropy_of_theory():
    ascent = scenarios.load("lifting-moist")._ascent(runner.prepare("lifting-moist", {}).settings)
    cloud = along_frames(ascent, np.geomspace(1e5, 3e4, 60), 60, 10, ideal=False)
    x, entropy, rain = walk(cloud)
    assert not rain.any()
    # a thousand know each variance by 4.5 %, and liquid of a moment is hardly correlated with that of the next frame
    assert np.mean(x[:, :, 0].var(axis=0) / cloud.liquid_scatter**2) == pytest.approx(1.0, abs=0.02)
    gained = np.diff(gathered(entropy_gain(cloud).variance, cloud.moment), prepend=0.0)
    scatter = np.diff(entropy, axis=1, prepend=0.0).var(axis=0)
    assert scatter.sum() == pytest.approx(gained.sum(), rel=0.015)


def over_mountains(**settings):
    """Return the course over the mountains, and its parcel at 8 samples in each of 96 frames."""
    ascent = scenarios.load("mountains")._ascent(runner.prepare("mountains", settings).settings)
    shares = np.linspace(0.0, 1.0, len(ascent.route))
    outside = np.exp(np.interp((np.arange(96) + 0.5) / 96, shares, np.log(ascent.route)))
    return ascent, along_frames(ascent, outside, 96, 8, ideal=True)


def test_water_that_has_rained_leaves_the_cloud_as_warm_and_the_clear_air_behind_it_warmer():
    ascent, cloud = over_mountains()
    share = cloud.moment / ascent.length
    less, more = (replace(ascent, most_liquid=keeps).path(cloud.pressure, share) for keeps in (1.001e-3, 0.999e-3))
    lost = (more.rain - less.rain) / theory.WATER_MASS_RATIO * cloud.air
    assert lost[-1] > 0.09
    gained = np.cumsum(theory.LIQUID_HEAT_CAPACITY * lost * np.gradient(np.log(cloud.temperature)))
    warmer = (more.temperature - less.temperature) / cloud.temperature
    wet, dry = cloud.liquid > 10.0, (cloud.liquid == 0.0) & (share > 0.9)
    # a molecule that leaves a cloud takes heat along, and changes its temperature a hundredth as much as behind it
    assert np.abs(warmer - gained / cloud.cloudy_heat)[wet].max() < 2e-9
    behind = (gained + (cloud.latent - np.log(cloud.humidity)) * lost) / cloud.clear_heat
    assert warmer[dry] == pytest.approx(behind[dry], rel=1e-3)

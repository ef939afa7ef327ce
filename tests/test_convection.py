"""Convection: air at rest, the adiabat and the onset in theory; and in the box rolls, inversion, breeze, stable air."""

import functools
import math

import numpy as np
import pytest
from scipy import stats
from scipy.optimize import brentq

from atmosbox import theory
from atmosbox.errors import AtmosboxError
from atmosbox.scene.statistics import growth_per_step
from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
from atmosbox.version import __version__

SPHERES = theory.Gas(3, (math.sqrt(2.0) * math.pi) ** -0.5)  # mean free path 1 at density 1
DISCS = theory.Gas(2, 1.0)
TURNS = {"molecules": 4000, "gravity": 12.0, "width": 1.5, "duration": 800.0}
"""A small box in which the air turns over."""


@functools.cache
def ran(engine=None, **settings):
    return runner.execute(runner.prepare("convection", settings, engine=engine))


def number(outcome, name):
    return next(each for each in outcome.headlines if each.name == name)


def test_the_critical_rayleigh_number_of_two_plates_is_that_of_boussinesq():
    high, apart = 1e4, 0.02

    def growth(rayleigh):
        def state(gravity):
            return theory.rest_state(SPHERES, high, 1.0 + apart / 2, 1.0 - apart / 2, gravity, 1.0, jump=0.0)

        gravity = brentq(lambda g: theory.rayleigh_number(state(g)) - rayleigh, 1e-12, apart / high)
        given = SPHERES, high, 1.0 + apart / 2, 1.0 - apart / 2, gravity, 1.0
        return theory.growth_rates(*given, [3.117 / high], order=24, jump=0.0, slip=0.0)[0]

    assert brentq(growth, 1650.0, 1750.0, xtol=0.05) == pytest.approx(1707.76, rel=5e-4)


def test_at_rest_the_power_three_halves_of_the_temperature_is_linear_and_the_weight_is_carried():
    state = theory.rest_state(SPHERES, 80.0, 1.9, 0.1, 0.02, 1.0)
    power = state.temperature**1.5
    assert np.ptp(np.diff(power)) < 1e-9
    assert 0.0 < 1.9 - state.temperature[0] < 0.05 < state.temperature[-1] - 0.1 < 0.15  # jumps, of thin warm air less
    for gas in (SPHERES, DISCS):
        found = theory.rest_state(gas, 80.0, 1.5, 0.5, 0.02, 0.2)
        weight = 0.02 * np.trapezoid(found.density, found.height)
        assert found.pressure[0] - found.pressure[-1] == pytest.approx(weight, rel=1e-5)
        assert weight == pytest.approx(0.02 * 80.0 * 0.2, rel=1e-3)


@pytest.mark.parametrize(
    ("packing", "lapse"), [(0.0, 0.5), (0.05, 0.4516), (0.1, 0.4064), (0.2, 0.3246), (0.3, 0.2536)]
)
def test_crowded_discs_that_rise_cool_less(packing, lapse):
    assert theory.adiabatic_lapse_rate(DISCS, packing * 4.0 / math.pi, 1.0) == pytest.approx(lapse, abs=5e-5)


def test_rolls_grow_where_the_temperature_falls_faster_than_the_adiabat_and_the_air_is_thin_enough():
    waves = np.pi * np.arange(1, 7) / 160.0
    weights = {gravity: gravity * 2.5 * 1.8 / 80.0 for gravity in (0.45, 0.6, 0.75, 0.9)}
    found = {share: theory.growth_rates(SPHERES, 80.0, 1.9, 0.1, g, 1.0, waves) for share, g in weights.items()}
    # an independent program, with 64 polynomials and the state at rest by shooting
    assert found[0.45] == pytest.approx([0.0028, 0.0060, 0.0069, 0.0060, 0.0041, 0.0013], abs=6e-5)
    assert found[0.6][:5] == pytest.approx([0.0017, 0.0044, 0.0048, 0.0034, 0.0007], abs=6e-5)
    assert abs(found[0.75].max()) < 5e-4
    assert found[0.9].max() < 0.0
    # decay, too, is that of rolls, and not of solutions that depend on the order of the polynomials
    finer = theory.growth_rates(SPHERES, 80.0, 1.9, 0.1, weights[0.9], 1.0, waves, order=60)
    assert finer == pytest.approx(found[0.9], rel=1e-3)


def test_the_growth_of_a_fluctuation_that_noise_drives_is_found_within_its_error():
    rng = np.random.default_rng(5)
    growth, decay, apart = 0.08, 0.1, []
    while len(apart) < 300:
        values = [0.0]
        while abs(values[-1]) < 15.0:
            kick = math.sqrt(2.0 * decay) * rng.normal()
            values.append(math.exp(growth) * values[-1] + kick)
        found = growth_per_step(values, 1.0, decay)
        if math.isfinite(found.mean):
            apart.append((found.mean - growth) / found.standard_error)
    assert abs(np.mean(apart)) < 0.3
    assert 0.6 < np.std(apart) < 1.2


def test_air_turns_over_by_itself_its_core_is_mixed_and_its_energy_is_accounted_for():
    outcome = ran(**TURNS)
    data = outcome.dataset
    assert number(outcome, "mean_wind_speed").value > 25.0
    core, heat = number(outcome, "mean_core_lapse_rate"), number(outcome, "nusselt_number")
    at_rest = -np.polyfit(data.height.values[5:11], data.layer_temperature_conduction.values[5:11], 1)[0]
    assert core.theory is heat.theory is None  # nothing derived is known for discs
    assert core.value + 4.0 * core.standard_error < at_rest
    assert heat.value - 2.0 * heat.standard_error > 1.0
    assert number(outcome, "weight_of_the_air").agrees
    assert all(check.passed for check in runner.verify(data))
    late = data.isel(elapsed_time=slice(80, None))
    # warm air rises: where it goes up in the middle of the height it is warmer than where it goes down
    middle = data.sizes["height"] // 2
    up, warm = (late[name].values[:, :, middle].mean(axis=0) for name in ("upward_wind", "cell_temperature"))
    assert np.corrcoef(up, warm)[0, 1] > 0.5
    # the profile is the mean of the field
    number_of = late.cell_number_density.values
    profile = np.nansum(number_of * late.cell_temperature.values, axis=(0, 1)) / np.nansum(number_of, axis=(0, 1))
    assert profile == pytest.approx(data.layer_temperature.values, rel=0.01)
    density = number_of.mean(axis=(0, 1))
    assert density == pytest.approx(data.number_density.values, rel=1e-6)


def test_an_ideal_gas_under_more_weight_stays_at_rest_as_theory_says():
    outcome = ran(case="stable", molecules=6000, duration=500.0)
    assert {each.name for each in outcome.headlines} >= {"mean_square_wind", "nusselt_number", "mean_core_lapse_rate"}
    for each in outcome.headlines:
        assert each.agrees is not False, each
    assert (
        "stays at rest"
        in dict(runner.card(runner.prepare("convection", {"case": "stable"})).facts)["onset by linear theory"]
    )


@pytest.mark.nightly
def test_rolls_of_sixty_seeds_grow_as_linear_theory_says_within_their_errors():
    """Of one processor it takes half an hour."""
    runs = [ran("dsmc", molecules=100_000, duration=500.0, seed=seed) for seed in range(1, 61)]
    grown = [each for outcome in runs for each in outcome.headlines if each.name == "growth_rate"]
    assert len(grown) >= 55
    apart = np.array([(each.value - each.theory) / each.standard_error for each in grown])
    assert stats.chi2.ppf(0.0005, len(grown)) < np.sum(apart**2) < stats.chi2.ppf(0.9995, len(grown))
    ratio = np.array([each.value / each.theory for each in grown])
    assert -0.09 - 4.0 * stats.sem(ratio) < ratio.mean() - 1.0 < 4.0 * stats.sem(ratio)  # grown rolls are slower


@pytest.mark.nightly
def test_most_boxes_turn_over_far_below_the_gravity_of_the_onset_and_none_far_above():
    """Of one processor it takes two minutes."""

    def turns_over(gravity, seed):
        outcome = ran("dsmc", molecules=16_000, width=0.7, duration=800.0, gravity=gravity, seed=seed)
        late = outcome.dataset.isel(elapsed_time=slice(80, None))
        noise = BOLTZMANN * float(late.air_temperature.mean()) / DRY_AIR.molecule_mass / 16_000
        return float((late.roll_amplitude.values**2).mean(axis=0).max()) > 36.0 * noise

    assert sum(turns_over(10.0, seed) for seed in range(1, 13)) >= 8
    assert not any(turns_over(21.0, seed) for seed in range(1, 13))


@pytest.mark.nightly
def test_the_errors_of_lapse_rate_and_heat_in_stable_air_are_the_scatter_of_sixty_seeds():
    """Of one processor it takes a minute."""
    runs = [ran(case="stable", molecules=6000, duration=500.0, seed=seed) for seed in range(1, 61)]
    for name in ("mean_core_lapse_rate", "nusselt_number"):
        found = [number(outcome, name) for outcome in runs]
        scatter = np.var([each.value for each in found], ddof=1)
        stated = np.mean([each.standard_error**2 for each in found])
        assert stats.chi2.ppf(0.0005, 59) < 59 * scatter / stated < stats.chi2.ppf(0.9995, 59), name


def turned(settings, turns, frames):
    """Return a run in which knobs are turned after some frames, and its headlines before, of all, and afterwards."""
    link = f"#atmosbox={__version__}&scene=convection&{settings}&seed=1&turns={turns}&frames={frames}&end"
    prepared = runner.replayed(link)
    data, first = runner.execute(prepared).dataset, int(turns.partition(":")[0])
    parts = data.isel(elapsed_time=slice(0, first)), data, data.isel(elapsed_time=slice(first, None))
    return data, *({each.name: each for each in prepared.module.headlines(part, prepared.settings)} for part in parts)


def test_below_an_inversion_smoke_stays_low_until_the_floor_is_warmed():
    data, before, after, _ = turned(
        "case=inversion&molecules=4000&gravity=12&width=1.5&duration=800",
        "120:floor_temperature:270,120:ceiling_temperature:-245",
        230,
    )
    assert before["share_from_the_floor"].value < 0.15
    assert before["mean_core_lapse_rate"].value < 0.0
    assert data.tracer_share_aloft.values[210:].min() > 0.35  # half of mixed molecules are in the upper half
    assert after["share_from_the_floor"].value > before["share_from_the_floor"].value + 0.2


def test_between_land_and_sea_the_wind_blows_to_the_warm_side_below_and_back_above_and_turns_if_the_sides_do():
    _, before, _, after = turned(
        "case=sea-breeze&molecules=2000&duration=400",
        "120:floor_temperature:-101,120:ceiling_temperature:127",
        240,
    )
    for wind in (part[name] for part in (before, after) for name in ("onshore_wind", "return_wind")):
        assert wind.value > max(10.0, 4.0 * wind.standard_error)


def test_no_run_stands_for_a_cheaper_one_of_another_size():
    for target in ("lecture", "2%"):
        with pytest.raises(AtmosboxError, match=r"make another flow.*: leave it out"):
            runner.prepare("convection", {}, accuracy=target)


@pytest.mark.parametrize(
    ("settings", "engine", "refused"),
    [
        ({"floor_temperature": 20.0, "ceiling_temperature": 20.0}, None, ""),
        ({"gravity": 0.0}, None, ""),
        ({"floor_temperature": -50.0, "ceiling_temperature": 50.0}, None, ""),
        ({"molecules": 300, "width": 10.0}, None, ""),
        ({"molecules": 50, "width": 1.0}, None, ""),
        ({"packing": 0.01}, None, ""),
        ({"molecules": 50, "width": 10.0, "packing": 0.4}, None, "molecules"),
        ({"packing": 0.5}, None, "packing"),
        ({"packing": 0.5, "floor_temperature": 50.0, "ceiling_temperature": 0.0, "start": "mixed"}, None, ""),
        ({"floor_temperature": 300.0, "ceiling_temperature": -267.5}, None, ""),  # 100 : 1
        ({"gravity": 500.0}, None, "gravity"),
        ({"rotation": True}, None, "rotation"),
        ({"rotation": True, "molecules": 2000, "sides": "periodic"}, "dsmc", ""),
        ({"sides": "periodic", "start": "mixed"}, None, ""),
    ],
)
def test_what_is_extreme_is_right_or_refused_in_a_sentence(settings, engine, refused):
    prepared = functools.partial(
        runner.prepare, "convection", {"molecules": 400, "duration": 30.0} | settings, engine=engine
    )
    if refused:
        with pytest.raises(AtmosboxError, match=f"^{refused}.*give ") as error:
            runner.execute(prepared())
        assert len(str(error.value).splitlines()) == 1
        return
    outcome = runner.execute(prepared())
    data = outcome.dataset
    assert outcome.ledger < runner.LEDGER_LIMIT
    warm = np.sort(data.wall_temperature.values[-1][np.isfinite(data.wall_temperature.values[-1])])
    at_rest = data.layer_temperature_conduction.values
    assert ((at_rest >= warm[0] - 1e-6) & (at_rest <= warm[-1] + 1e-6)).all()
    assert np.isfinite(data.layer_temperature_adiabatic.values).all()
    pressure = data.air_pressure.values.mean()
    assert 0.3 * 1013.25e2 < pressure < 3.0 * 1013.25e2

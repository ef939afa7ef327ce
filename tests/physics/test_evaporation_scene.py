"""The scene of evaporation: its final state, the error due to the piston, which molecules leave, and refusals.

Means allow 4 standard errors from 20 blocks, and what the piston may take: a false alarm once in 1 500 per
comparison for a fresh seed (there are some 40 here), and never for these.
"""

import math

import numpy as np
import pytest

from atmosbox import theory
from atmosbox.errors import SettingError
from atmosbox.simulation import runner
from atmosbox.simulation.preparation import build, prepare
from atmosbox.simulation.recording import Recording
from atmosbox.simulation.verification import LEDGER_LIMIT
from atmosbox.theory import LEAVING_FREEDOM, isobaric_water
from atmosbox.theory.constants import BOLTZMANN


def run(**settings):
    return runner.execute(runner.prepare("evaporation", settings), command="atmosbox run evaporation")


def found(outcome):
    return {each.name: each for each in outcome.headlines}


def agree(outcome):
    for each in outcome.headlines:
        assert abs(each.value - each.theory) <= 4.0 * each.standard_error + each.tolerance, each.name


def test_a_large_parcel_comes_to_the_balance_of_enthalpy():
    gaps = []
    for size in (1, 10, 100):
        large = theory.evaporation_equilibrium(1e5, 303.15, 990 * size, 10 * size, 200 * size)
        small = isobaric_water(1e5, 303.15, 990 * size, 10 * size, 200 * size)
        gaps.append(small.temperature - float(large.temperature))
        assert small.probability.sum() == pytest.approx(1.0)
    # the error of few molecules is proportional to one over their number
    assert gaps[0] / gaps[1] == pytest.approx(10.0, rel=0.1)
    assert gaps[1] / gaps[2] == pytest.approx(10.0, rel=0.1)
    assert 0.1 < gaps[0] < 0.2


@pytest.mark.parametrize(
    "settings",
    [
        {"molecules": 4000, "pool": 800, "duration": 8.0},
        {"molecules": 2000, "pool": 400, "duration": 8.0, "humidity": 150.0},
        {"molecules": 1000, "pool": 200, "duration": 12.0, "temperature": 70.0},
        {"molecules": 2000, "pool": 400, "duration": 4.0, "pressure": 5000.0, "diameter": 0.8},
    ],
    ids=["dry", "supersaturated", "hot", "dense"],
)
def test_air_over_a_pool_ends_saturated_where_its_enthalpy_says(settings):
    outcome = run(**settings)
    assert outcome.ledger < 1e-12
    assert {"mean_gas_temperature", "mean_liquid_temperature", "final_humidity"} <= found(outcome).keys()
    agree(outcome)
    assert all(check.passed for check in runner.verify(outcome.dataset))


def test_a_pool_that_dries_out_leaves_air_that_is_not_saturated():
    outcome = run(molecules=1000, pool=5, duration=20.0)
    agree(outcome)
    ends = found(outcome)
    assert "mean_liquid_temperature" not in ends
    assert 0.2 < ends["final_humidity"].value < 0.6
    assert (outcome.dataset.liquid_molecule_count.values[-50:] == 0).any()


def test_the_work_of_the_piston_is_that_of_a_constant_pressure_but_for_what_it_is_late():
    losses = []
    for seed in range(1, 5):
        prepared = runner.prepare("evaporation", {"molecules": 3000, "pool": 600, "seed": seed})
        setup = runner.build(prepared)
        start = prepared.module._start(prepared.settings, ideal=False)
        parcel = setup.parcel
        pressure = prepared.settings.si.pressure / setup.scale.pressure
        before, volume = sum(parcel.energy()) + parcel.condensed_energy, parcel.number / parcel.open_density
        until = 5.0e-9 / setup.scale.time
        parcel.advance(until)
        work = pressure * (parcel.number / parcel.open_density - volume)
        assert abs(work) > 50.0
        gained = sum(parcel.energy()) + parcel.condensed_energy - before + work
        capacity = 3.5 * 3000 + theory.LIQUID_HEAT_CAPACITY * 600
        losses.append(-gained / capacity * prepared.settings.si.temperature)
    # the piston fluctuates; on average it is a loss, and less than what is stated: the scatter is 0.02 K
    assert 0.0 < np.mean(losses) < start.loss(until) < 0.15
    assert np.std(losses, ddof=1) < 0.04


def test_molecules_that_leave_have_the_binding_energy_and_the_energies_of_a_flux():
    outcome = run(molecules=2000, pool=2000, humidity=100.0, duration=8.0, temperature=50.0)
    data = outcome.dataset
    width = np.diff(data.energy_bnds.values)[:, 0]
    share = data.leaving_energy_probability_density.values * width
    expected = data.leaving_energy_probability_density_theory.values * width
    below = data.energy_bnds.values[:, 1] <= BOLTZMANN * theory.BINDING_TEMPERATURE * (1.0 + 1e-9)
    assert share.sum() == pytest.approx(1.0)
    assert not share[below].any()
    assert (data.staying_energy_probability_density.values * width)[below].sum() > 0.99
    number = float(data.evaporation_rate.mean() * data.elapsed_time[-1]) * 1e-9
    many = expected * number > 10.0
    chi = ((share - expected)[many] ** 2 / expected[many]).sum() * number
    degrees = many.sum()
    assert number > 5000
    # 4 standard deviations of chi-squared
    assert abs(chi - degrees) < 4.0 * math.sqrt(2.0 * degrees) + 1.0
    leaver = found(outcome)["energy_of_those_that_leave"]
    warm = (leaver.theory / BOLTZMANN - theory.BINDING_TEMPERATURE) / LEAVING_FREEDOM
    assert warm == pytest.approx(323.15, abs=2.0)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"pressure": 42.0}, "makes water boil at 42 hPa.*temperature=.29degC"),
        ({"pressure": 1.0, "temperature": 95.0}, "boil.*temperature=.-23degC"),
        ({"humidity": 600.0, "temperature": 60.0}, "hardly any air is left.*humidity=.4[0-9][0-9]percent"),
        ({"pressure": 20_000.0, "diameter": 1.0}, r"20000 hPa too dense for vapour.*diameter=.0\.[0-9]+nm"),
    ],
)
def test_what_cannot_be_is_refused_with_what_to_type_instead(settings, words):
    with pytest.raises(SettingError, match=words) as refusal:
        runner.prepare("evaporation", settings)
    runner.prepare("evaporation", {**settings, **dict([refusal.value.remedy[0]])})


def test_the_walls_cool_the_air_over_a_pool_and_a_cover_slows_both_rates_alike():
    prepared = prepare("evaporation", {"molecules": 1500, "pool": 300, "duration": "20 ns"}, engine="exact")
    setup = build(prepared)
    parcel, recording = setup.parcel, Recording(prepared, setup, {})
    walls, cover = setup.knobs

    def after(frames):
        for _ in range(frames):
            recording.advance(lambda passed: None)
        return recording.dataset("knobs", settle=0, judged=False)[0]

    def agrees(values, expected, frames):
        """Return whether the mean of the last frames is within 4 errors of 20 blocks: a false alarm once in 1 300."""
        blocks = values[-frames:].values.reshape(20, -1).mean(axis=1)
        return abs(blocks.mean() - expected) < 4.0 * blocks.std(ddof=1) / 20**0.5

    after(20)
    began = parcel.number + parcel.liquid
    assert np.isnan(parcel.wall_kT()).all(), "walls that nobody turned let no heat pass"
    walls.set(10.0)
    found, saturated = after(500), float(theory.saturation_vapor_pressure(283.15))
    assert agrees(found.gas_temperature, 283.15, 400)
    assert agrees(found.liquid_temperature, 283.15, 400)
    assert agrees(found.water_vapor_partial_pressure, saturated, 400)
    assert found.water_vapor_partial_pressure_theory[-1] == pytest.approx(saturated)
    rate = float(found.condensation_rate_theory[-1])
    assert agrees(found.evaporation_rate, rate, 400)

    cover.set(25.0)
    found = after(300)
    assert found.condensation_rate_theory[-1] == pytest.approx(0.25 * rate)
    assert agrees(found.evaporation_rate, 0.25 * rate, 280)

    cover.set(0.0)
    shut = parcel.evaporated, parcel.condensed
    walls.set(30.0)
    found = after(300)
    assert (parcel.evaporated, parcel.condensed) == shut
    assert agrees(found.liquid_temperature, 303.15, 200), "heat passes the cover"
    assert parcel.number + parcel.liquid == began
    assert parcel.ledger() < LEDGER_LIMIT

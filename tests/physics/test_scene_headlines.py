"""Scenes against the theory of their known errors: a parcel that rises at a finite speed, a small box of gas.

Each bound is stated with its test: 4 standard errors (a false alarm once in 1 500 for fresh seeds, and never for
these), plus what the theory itself leaves out.
"""

import math

import numpy as np
import pytest

from atmosbox import scenarios
from atmosbox.simulation import runner


def run(scene, **settings):
    """Return the outcome of a scene."""
    return runner.execute(runner.prepare(scene, settings))


def ascents(seeds, **settings):
    """Return how much too warm rising parcels are along their pressures [K], and the last of them."""
    warmer = []
    for seed in seeds:
        found = run("lifting-dry", seed=seed, **settings).dataset
        warmer.append(found.parcel_temperature.values - found.adiabat_temperature.values)
    return np.array(warmer), found


@pytest.mark.parametrize(
    "settings", [pytest.param({}, marks=pytest.mark.nightly), {"rotation": False}, {"top_pressure": "100 hPa"}]
)
def test_a_fast_parcel_is_as_much_too_warm_as_the_viscosity_of_its_gas_demands(settings):
    length = 200
    misfits, found = ascents(range(16), molecules=1000, ascent=length, **settings)
    scene = scenarios.load("lifting-dry")
    prepared = runner.prepare("lifting-dry", {"ascent": length, **settings}).settings
    pressure = float(found.parcel_pressure[-1])
    temperature = float(found.adiabat_temperature[-1])
    ascent = scene._ascent(prepared)
    expected = (ascent.finite_speed(pressure) - ascent.room(pressure, scene._start(prepared)[1])) * temperature
    mean = misfits[:, -1].mean()
    error = misfits[:, -1].std(ddof=1) / math.sqrt(len(misfits))
    # 2 for D is that of rotating molecules; those that do not have 5/3 at most
    least = 1.4 / 2.0 if "rotation" in settings else 0.85
    assert error < 0.2 * expected
    assert least * expected - 4.0 * error <= mean <= 1.15 * expected + 4.0 * error


@pytest.mark.parametrize(("molecules", "seeds"), [(500, 48), (4000, 16)])
def test_the_energy_of_the_flow_makes_a_larger_parcel_warmer(molecules, seeds):
    # a uniform gas and the flow: 3.02 K at 300 hPa for 500 molecules, 3.61 K for 4000; without the flow 2.94 K for both
    length = 50
    misfits, found = ascents(range(seeds), molecules=molecules, ascent=length)
    scene = scenarios.load("lifting-dry")
    settings = runner.prepare("lifting-dry", {"molecules": molecules, "ascent": length}).settings
    ascent, density = scene._ascent(settings), scene._start(settings)[1]
    pressure, temperature = float(found.parcel_pressure[-1]), float(found.adiabat_temperature[-1])
    expected = (ascent.finite_speed(pressure) - ascent.room(pressure, density)) * temperature
    error = misfits[:, -1].std(ddof=1) / math.sqrt(seeds)
    assert error < 0.15
    assert abs(misfits[:, -1].mean() - expected) <= 4.0 * error


@pytest.mark.parametrize("pressure", [1000, 10_000, 50_000, 100_000])
def test_two_hundred_molecules_press_and_meet_as_theory_says_at_any_density(pressure):
    # the walls warm the gas within a fiftieth of it
    outcome = run("temperature", pressure=f"{pressure} hPa", duration=f"{max(1.0, 10_000.0 / pressure)} ns", seed=1)
    found = {headline.name: headline for headline in outcome.headlines}
    assert set(found) == {"mean_temperature", "mean_pressure", "mean_speed", "collision_rate"}
    assert all(headline.agrees for headline in found.values())
    assert found["mean_pressure"].theory == pytest.approx(100.0 * pressure, rel=1e-12)
    assert not any(headline.tolerance for headline in found.values())

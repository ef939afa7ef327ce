"""A stirred column cools with height by g/c_p; one in which molecules change places one by one stays isothermal.

Measured lapse rates allow 4 standard errors of 20 blocks: a false alarm once in 1,500 for a fresh seed, and never for
these. The columns are small and share the two sets of kernels of dsmc, for molecules that rotate and that do not.
"""

import math

import numpy as np
import pytest

from atmosbox import scenarios
from atmosbox.errors import SettingError
from atmosbox.scene.statistics import block_average
from atmosbox.simulation import runner
from atmosbox.simulation.preparation import card
from atmosbox.simulation.verification import verify
from atmosbox.theory import stirred_column, thin_gas_conductivity
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR, STANDARD_GRAVITY
from tests.oracle.heat_conduction import conduction_of_rotating_spheres
from tests.oracle.stirred_kinetic import lapse, stirred_profiles
from tests.oracle.weak_stirring import gradient_of_weak_stirring

STIRS = {"parcel": 0.05, "lifts": (0.15, 0.35)}
LIFTS = [step / 120 for step in range(18, 43)]
CEILING = 1.2


def profile(rate, freedom=5, diameter=3.0, **changes):
    return stirred_column(
        1.0, 0.0, CEILING, 1.0, 1.0, diameter, **{"freedom": freedom, "rate": rate, **STIRS} | changes
    )


def run(**settings):
    return runner.execute(runner.prepare("atmosphere", {"molecules": 1500, "duration": 120, **settings}))


def lapse_of(outcome):
    found = {each.name: each for each in outcome.headlines}["lapse_rate_of_the_air"]
    return found.value, found.standard_error, found.theory, found.tolerance


# ---------------------------------------------------------------------- theory


@pytest.mark.parametrize("freedom", [3, pytest.param(5, marks=pytest.mark.validate)])
def test_weak_stirring_is_that_of_first_order(freedom):
    rate, conducts = 1e-7, thin_gas_conductivity(1.0, 1.0, 3.0, freedom)
    column = profile(rate, freedom)
    slope = np.diff(column.temperature) / np.diff(column.height) / rate
    shares = np.arange(1, len(column.height)) / len(column.height)
    for k in (5, 20, 47, 60, 95, 113):
        truth = gradient_of_weak_stirring(
            float(shares[k]), CEILING, conducts, freedom=freedom, parcel=0.05, lifts=LIFTS
        )
        assert slope[k] == pytest.approx(truth, rel=0.02)
    assert profile(0.0, freedom).temperature == pytest.approx(np.ones(120), abs=1e-12)


@pytest.mark.parametrize("freedom", [pytest.param(3, marks=pytest.mark.validate), 5])
def test_strong_stirring_mixes_the_potential_temperature_and_its_work_leaves_by_the_floor(freedom):
    column = profile(1e5, freedom)
    theta = column.temperature * column.pressure ** (-2.0 / (freedom + 2.0))
    assert np.ptp(theta[12:-12]) < 5e-4 * theta.mean()
    inner = slice(12, -12)
    slope = np.polyfit(column.height[inner], column.temperature[inner], 1)[0]
    assert slope == pytest.approx(-2.0 / (freedom + 2.0), rel=3e-3)
    # the ideal gas fills the column, and each element carries what is above it
    assert np.sum(column.temperature / column.pressure) / len(theta) == pytest.approx(CEILING, rel=1e-10)
    assert np.diff(column.pressure) == pytest.approx(-1.0 / len(theta))
    middle = profile(300.0, freedom)
    jump = 2.127 / (math.sqrt(2.0) * math.pi * 9.0) * middle.temperature[0] / middle.pressure[0]
    half = 0.5 / len(theta) * middle.temperature[0] / middle.pressure[0]
    leaves = thin_gas_conductivity(1.0, 1.0, 3.0, freedom) * (middle.temperature[0] - 1.0) / (half + jump)
    assert middle.work == pytest.approx(leaves, rel=1e-9)
    assert profile(300.0, freedom, works=False).temperature == pytest.approx(np.ones(120), abs=1e-10)


def test_rotation_makes_spheres_conduct_five_quarters():
    factor, error = conduction_of_rotating_spheres(20_000, np.random.default_rng(7))
    assert error < 0.01
    assert abs(factor - 1.25) < 4.0 * error
    both = [thin_gas_conductivity(1.0, 1.0, 0.3, freedom) for freedom in (3, 5)]
    assert both[1] / both[0] == pytest.approx(1.25)


@pytest.mark.parametrize("freedom", [3, 5])
def test_what_the_headline_allows_is_what_the_kinetic_equation_says_fouriers_law_leaves_out(freedom):
    """Molecules with a long mean free path carry less heat: the column is nearer to the adiabat than by Fourier."""
    allowed = scenarios.load("atmosphere").FOURIER
    shares = []
    for knudsen in (0.02, 0.05, 0.33):
        for stirring in (0.3, 1.0, 30.0):
            kinetic, fourier = lapse(stirred_profiles(knudsen, stirring, freedom, layers=60, points=4))
            reached, taken = stirring / (1.0 + stirring), 1.0 / (1.0 + stirring)
            shares.append(0.5 * (freedom + 2.0) * (kinetic - fourier) / (knudsen * reached * taken))
    assert 1.0 < min(shares) < max(shares) < allowed
    assert max(shares) > 0.75 * allowed or freedom == 5
    near = stirred_profiles(0.0005, 1.0, freedom, layers=60, points=4)
    assert near.kinetic == pytest.approx(near.fourier, abs=1e-4)


# ---------------------------------------------------------------------- the scene


@pytest.mark.parametrize(("rotation", "heat"), [(True, 3.5), pytest.param(False, 2.5, marks=pytest.mark.validate)])
def test_air_that_is_stirred_fast_has_the_lapse_rate_of_the_adiabat(rotation, heat):
    outcome = run(stirring=60, rotation=rotation)
    value, error, theory, known = lapse_of(outcome)
    adiabat = STANDARD_GRAVITY * DRY_AIR.molecule_mass / (heat * BOLTZMANN)
    assert adiabat == pytest.approx(9.76e-3 if rotation else 13.67e-3, abs=1e-5)
    assert abs(theory / adiabat - 1.0) < 0.02
    assert abs(value - adiabat) <= 0.02 * adiabat + 4.0 * error
    assert error < 0.02 * adiabat
    assert abs(value - theory) <= 4.0 * error + known
    assert outcome.ledger < 1e-12
    found = outcome.dataset
    # the work of stirring leaves through the floor, apart from the change of energy of the column
    work, heat_in = (found[name].values for name in ("work_by_stirring", "heat_from_wall"))
    assert work[-1] > 0.0 > heat_in[-1, 4]
    stored = found.kinetic_energy + found.rotational_energy + found.potential_energy
    balance = stored.values - work - heat_in.sum(axis=1)
    assert np.ptp(balance) < 1e-12 * stored.values.max()
    assert all(check.passed for check in verify(found))
    assert found.lapse_rate.attrs["standard_name"] == "air_temperature_lapse_rate"


def test_molecules_that_change_places_one_by_one_leave_the_column_isothermal():
    outcome = run(stirring=60, exchange="molecules")
    value, error, theory, _ = lapse_of(outcome)
    assert abs(theory) < 1e-12
    assert abs(value) < 4.0 * error < 0.1 * 9.76e-3
    assert "work_by_stirring" not in outcome.dataset


def test_between_rest_and_fast_stirring_the_lapse_rate_is_between():
    value, error, theory, known = lapse_of(run(stirring=1, duration=200))
    assert 0.5 < theory / 9.76e-3 < 0.65
    assert abs(value - theory) <= 4.0 * error + known
    assert error < 0.05 * theory


def test_rotation_changes_nothing_of_a_column_at_rest():
    settings = {"molecules": 300, "duration": 100, "rotation": True, "knudsen": 0.3, "height": 15}
    outcome = runner.execute(runner.prepare("atmosphere", settings | {"start": "equilibrium"}, engine="dsmc"))
    for each in outcome.headlines:
        assert abs(each.value - each.theory) <= 4.0 * each.standard_error + each.tolerance, each.name
    shaken = settings | {"start": "bottom", "floor": "isolated"}
    freed = runner.execute(runner.prepare("atmosphere", shaken, engine="dsmc"))
    warm = {each.name: each for each in freed.headlines}["mean_temperature"]
    assert 0.70 * 288.15 < warm.theory < 0.80 * 288.15  # of 5/2 k T + what falls, 5/2 k T' + k T' is left
    assert abs(warm.value - warm.theory) <= 4.0 * warm.standard_error + warm.tolerance


def test_what_is_not_set_suits_a_stirred_column_and_what_is_set_stays():
    stirred = runner.prepare("atmosphere", {"stirring": "50"})
    assert str(stirred.engine) == "dsmc"
    assert (stirred.settings.rotation, stirred.settings.height, stirred.settings.knudsen) == (True, 11.0, 0.02)
    chosen = runner.prepare("atmosphere", {"stirring": 50, "height": 8, "rotation": False}).settings
    assert (chosen.rotation, chosen.height) == (False, 8.0)
    rest = runner.prepare("atmosphere", {"stirring": 0})
    assert (str(rest.engine), rest.settings) == ("dsmc", runner.prepare("atmosphere", {}).settings)
    again = runner.prepare("atmosphere", stirred.settings.as_dict())
    assert (str(again.engine), again.settings) == ("dsmc", stirred.settings)
    assert dict(card(stirred).facts)["adiabat"] == "g/c_p = 9.76 K/km"


def test_what_cannot_be_stirred_is_refused_with_what_to_give():
    for settings, engine, words in [
        ({}, "exact", "cannot stir.*--engine dsmc"),
        ({}, "stepped", "cannot stir.*--engine dsmc"),
        ({"floor": "isolated"}, None, "floor=heat-bath"),
        ({"plane": True}, None, "plane=off"),
        ({"height": 25}, None, "height=20.6 or less"),
        ({"height": 16, "rotation": False}, None, "height=14.7 or less"),
        ({"molecules": 100}, None, "molecules=200 or more"),
    ]:
        with pytest.raises(SettingError, match=words):
            runner.build(runner.prepare("atmosphere", {"stirring": 10, **settings}, engine=engine))


def test_discs_do_not_rotate():
    with pytest.raises(SettingError, match="rotation=off"):
        runner.prepare("atmosphere", {"plane": True, "rotation": True})


@pytest.mark.validate
@pytest.mark.parametrize("stirring", [0.3, 1.0, 3.0, 10.0, 100.0])
@pytest.mark.parametrize("rotation", [True, False])
def test_the_curve_of_the_lapse_rate_is_that_of_theory(stirring, rotation):
    outcomes = [
        runner.execute(runner.prepare("atmosphere", {"stirring": stirring, "rotation": rotation, "seed": seed}))
        for seed in range(4)
    ]
    values = np.array([lapse_of(outcome) for outcome in outcomes])
    error = math.hypot(*values[:, 1]) / len(outcomes)
    assert abs(values[:, 0].mean() - values[0, 2]) <= 4.0 * error + values[0, 3]


@pytest.mark.validate
@pytest.mark.parametrize("rotation", [True, False])
def test_stirred_air_is_warmer_than_by_fouriers_law_as_the_kinetic_equation_says(rotation):
    """The same at all heights, after the effect of parcels of few molecules, proportional to 1 / N, is subtracted."""
    warmer = []
    for molecules in (4000, 16000):
        found = run(stirring=100, rotation=rotation, molecules=molecules, duration=300).dataset
        above = found.layer_temperature.values - found.layer_temperature_theory.values
        warmer.append(above.mean())
        assert abs(above[3:12].mean() - above[-12:-3].mean()) < 0.5 * above.mean()
    many = (4.0 * warmer[1] - warmer[0]) / 3.0
    assert warmer[0] > warmer[1] > many
    column = stirred_profiles(0.02, 100.0, 5 if rotation else 3)
    assert many == pytest.approx(288.15 * (column.kinetic - column.fourier)[30:-30].mean(), rel=0.3)


@pytest.mark.validate
def test_no_flow_is_left_behind():
    """The mean square of the momentum is that of independent molecules."""
    prepared = runner.prepare("atmosphere", {"stirring": 50, "molecules": 1500, "duration": 400})
    setup = runner.build(prepared)
    box = setup.parcel
    box.advance(40.0)
    seen = []
    for k in range(1440):
        box.advance(40.0 + 0.25 * (k + 1))
        velocity = box.snapshot().velocity
        seen.append((velocity.sum(axis=0) ** 2 - (velocity**2).sum(axis=0)) / 1500)
    mean, error = block_average(np.array(seen))
    assert (error < 0.15).all()
    assert (np.abs(mean) <= 4.0 * error).all(), (mean, error)

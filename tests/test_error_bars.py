"""Standard errors compared with the scatter between runs, for every headline and every profile of every scene.

For each number x of n runs that differ in their seed, the sum of (x - theory)^2 over the mean square of the errors
stated is chi-square of n degrees of freedom: more says that errors are stated too small or that the mean is off, less
that errors are too large. Where the model states a known error, the mean may be off by that much. Each bound is the
99.9 % range; as a run reads its error from 20 blocks or more, which know its square by 40 % at worst, the range is that
of an F distribution of n and 12 n degrees.

The cheap tier does so with a few runs of small boxes, a few seconds each. With ``--nightly`` each scene runs 60 times
as it comes: of one processor one or two minutes for temperature, discs, atmosphere, evaporation and lifting-dry, and
five or six for condensation and each moist ascent, half an hour in all. No headline is left out: one
that states no error must be among those known to have none, and every headline that a scene names must be seen in a
case.
"""

import ast
import math
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest
from scipy import stats

from atmosbox import scenarios
from atmosbox.simulation import accuracy, runner
from atmosbox.theory.constants import BOLTZMANN
from atmosbox.trade.timed_run import PROFILES
from tests.few_frames import FRAMES, cut


def runs(scene, number, **settings):
    """Return the outcomes of runs that differ in their seed."""
    return [runner.execute(runner.prepare(scene, settings | {"seed": 1000 + seed})) for seed in range(number)]


@pytest.fixture
def fewer_frames(monkeypatch):
    """Cut the runs of a test into fewer frames."""
    cut(monkeypatch, FRAMES)


def range_of_ratio(number):
    """Return the 99.9 % range of a mean square over the stated one, for a number of degrees of freedom."""
    return stats.f.ppf([0.0005, 0.9995], number, 12 * number)


def ratio_of(misfit, stated, known):
    """Return the mean square of misfits over the stated one, after at most the known error is subtracted."""
    apart = misfit - np.clip(misfit.mean(axis=0), -known, known)
    return apart**2 / np.mean(stated**2, axis=0)


class Row(NamedTuple):
    """The results of the runs for one headline."""

    ratio: float
    least: float
    most: float

    @property
    def right(self):
        return self.least <= self.ratio <= self.most


def headlines_of(outcomes):
    """Return the row of each headline that states an error, and the names of those that state none."""
    rows: dict[str, list[Any]] = {}
    for outcome in outcomes:
        for headline in outcome.headlines:
            rows.setdefault(headline.name, []).append(headline)
    found, without = {}, set()
    for name, each in rows.items():
        if len(each) < 0.8 * len(outcomes):  # a result that some runs lack has a biased mean
            continue
        value, stated, known = (
            np.array([getattr(headline, part) for headline in each])
            for part in ("value", "standard_error", "tolerance")
        )
        if not stated.any():
            without.add(name)
            continue
        theory = [headline.theory for headline in each]
        lost = 0 if None not in theory and not known.any() else 1  # a mean that is subtracted costs a degree of freedom
        if None in theory:
            misfit, known = value - value.mean(), np.zeros(1)
        else:
            misfit = value - np.array(theory)
        freedom = len(each) - lost
        ratio = float(ratio_of(misfit, stated, known.mean()).sum() / freedom)
        found[name] = Row(ratio, *range_of_ratio(freedom))
    return found, without


def assert_headlines_are_covered(outcomes, without=frozenset()):
    """Check each headline; only those named may have no standard error."""
    found, silent = headlines_of(outcomes)
    assert found
    assert silent <= without
    assert {name: row for name, row in found.items() if not row.right} == {}


def profiles_of(outcome):
    """Return the names of the curves that state an error."""
    dims = {name: each.dims for name, each in outcome.dataset.data_vars.items() if str(name).endswith("_se")}
    return [str(name).removesuffix("_se") for name, each in dims.items() if each]


def assert_profiles_are_covered(outcomes, names, generous=()):
    """Check the scatter of profiles, averaged over their layers; of those named last, that the error is not too small.

    Layers are correlated: k ratios with a covariance matrix C count as (tr C)^2 / tr C^2 independent ones.
    """
    wrong = {}
    for name in names:
        values, errors = (np.array([o.dataset[each].values for o in outcomes]) for each in (name, f"{name}_se"))
        if (beside := PROFILES.get(name)) in outcomes[0].dataset:  # a parcel is at another pressure in each run
            values = values - np.array([o.dataset[beside].values for o in outcomes])
        known = np.isfinite(values).all(axis=0) & np.isfinite(errors).all(axis=0) & (errors > 0.0).any(axis=0)
        if name.startswith("left_gas_share_"):  # without scatter where one gas has not come in any run
            known &= (values > 0.0).any(axis=0) & (values < 1.0).any(axis=0)
        assert known.any()
        values, errors = values[:, known], errors[:, known]
        apart = (values - values.mean(axis=0)) / np.sqrt(np.mean(errors**2, axis=0))
        covariance = apart.T @ apart / (len(outcomes) - 1)
        ratio = float(np.trace(covariance) / len(covariance))
        alone = np.trace(covariance) ** 2 / np.sum(covariance**2)
        least, most = range_of_ratio((len(outcomes) - 1) * alone)
        if not (name in generous or least <= ratio) or ratio > most:
            wrong[name] = Row(ratio, least, most)
    assert wrong == {}


@pytest.mark.usefixtures("fewer_frames")
def test_a_dense_column_has_the_pressure_n_k_t_z_and_its_errors_are_its_scatter(seen):
    outcomes = runs("atmosphere", 8, molecules=100, knudsen=0.1, duration=60)
    seen.setdefault("atmosphere", set()).update(names_of(outcomes))
    # 96 other runs: the stated error of the density of crowded spheres is 1.15 times their scatter
    assert_profiles_are_covered(outcomes, profiles_of(outcomes[0]), ("number_density", "air_density"))
    assert_headlines_are_covered(outcomes)
    # spheres as wide as the mean free path of a thin gas makes them, in scale heights; 100 stand on one of them squared
    found = outcomes[0].dataset
    height = 288.15 * BOLTZMANN / (28.9647e-3 / 6.02214076e23 * 9.80665)
    held = -math.expm1(-25e3 / height)
    ball = math.pi / 6.0 * (math.sqrt(2.0) * math.pi * (100.0 / held) * 0.1) ** -1.5

    def factor(number_density):
        per_area = found.number_density.values.sum() * 25e3 / found.sizes["height"]
        filled = ball * 100.0 * height * number_density / per_area
        return (1.0 + filled + filled**2 - filled**3) / (1.0 - filled) ** 3  # Carnahan and Starling

    density, temperature, pressure = (
        np.mean([outcome.dataset[name].values[2:12] for outcome in outcomes], axis=0)
        for name in ("number_density", "layer_temperature", "layer_pressure")
    )
    assert factor(density)[0] > 1.3
    # a run knows the pressure of a layer by 4 %, 8 runs the mean of ten that share much by less than a per cent
    ratio = pressure / (density * BOLTZMANN * temperature * factor(density))
    assert ratio.mean() == pytest.approx(1.0, abs=0.02)
    expected = found.number_density_theory.values[2:12]
    law = found.layer_pressure_theory.values[2:12] / (expected * BOLTZMANN * 288.15)
    assert np.allclose(law, factor(expected), rtol=3e-3)


class Case(NamedTuple):
    """A scene with settings, the number of its runs, and the headlines that do not depend on chance.

    ``long`` cases are left to the nightly tier: those that take minutes, and second cases of a scene.
    """

    scene: str
    settings: dict[str, Any]
    number: int
    without: frozenset[str] = frozenset()
    long: bool = False


ROUNDING = frozenset({"largest_energy_change", "largest_momentum_residual"})
COUNTS = frozenset({"last_largest_drop_molecule_count", "last_vapor_molecule_count"})  # of a gas: clusters are rare
UNKNOWN = frozenset({"mean_temperature"})  # without a thermostat it depends on the energy of the start
METPY = frozenset({"metpy_lcl", "metpy_cape", "metpy_el"})
THIN = {"molecules": 150, "density": 0.08, "temperature": 200.0, "duration": 2.0}
CASES = [
    Case("temperature", {"duration": 10.0}, 8),
    Case("temperature", {"molecules": 50, "duration": 10.0}, 24, long=True),
    Case("temperature-large", {"duration": 5.0}, 12, long=True),
    Case("elastic-collisions", {}, 24, ROUNDING, long=True),
    Case("elastic-collisions", {"duration": 10.0}, 8, ROUNDING),
    Case("atmosphere", {"molecules": 100, "duration": 100.0}, 24, long=True),  # the dense one above covers it
    Case("atmosphere", {"molecules": 100, "duration": 100.0, "plane": True}, 24, long=True),
    Case("attraction", THIN, 5, COUNTS),
    Case("attraction", THIN, 12, COUNTS, long=True),
    Case("attraction", {"molecules": 200}, 24, long=True),
    Case("attraction", {"molecules": 200, "start": "drop", "density": 0.15, "bath": "none"}, 24, UNKNOWN, long=True),
    Case(
        "attraction", {"molecules": 200, "density": 0.06, "temperature": 180.0, "bath": "walls"}, 24, COUNTS, long=True
    ),
    Case(
        "attraction",
        {"molecules": 300, "start": "slab", "density": 1.0, "temperature": 130.0, "duration": 2.0},
        12,
        long=True,
    ),
    Case("condensation", {"molecules": 500, "duration": 20.0}, 6),
    Case("convection", {"molecules": 150, "duration": 400.0, "gravity": 0.0}, 8),
    Case("convection", {"molecules": 150, "duration": 400.0, "gravity": 0.0}, 24, long=True),
    Case("evaporation", {"molecules": 1000, "pool": 200}, 5),
    Case("diffusion", {"molecules": 800}, 8),
    Case("nuclei", {"molecules": 1500, "duration": 100.0}, 24, long=True),
    Case("nuclei", {"molecules": 1000, "duration": 30.0, "salted": 0}, 24, long=True),
    Case("diffusion", {"molecules": 1000, "mass_ratio": 10.0, "duration": 2.0}, 24, long=True),
    Case("lifting-dry", {"molecules": 200, "ascent": 400.0}, 12),
    Case("lifting-dry", {"molecules": 200, "ascent": 150.0}, 60, long=True),
    Case("lifting-moist", {"molecules": 2000}, 60, long=True),
    Case("lifting-sounding", {"molecules": 4000, "ascent": 400.0}, 60, METPY, long=True),
    Case("mountains", {"molecules": 4000, "cloud_water": 3.0}, 60, long=True),
]
"""Small boxes of every scene."""
QUICK = {("attraction", True): {"molecules": 200, "duration": 0.5}, ("mountains", True): {"molecules": 400}}
QUICK["nuclei", True] = {"molecules": 500, "duration": 20.0}
"""Settings for long cases that are enough to get the names of their headlines."""


def named(case):
    """Return the name of a case."""
    return ", ".join([case.scene, *(f"{name}={value}" for name, value in case.settings.items())])


def spelled(scene):
    """Return the headlines that are named in the source of a scene."""
    source = Path(scenarios.load(scene).headlines.__code__.co_filename)
    calls = [node for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)]
    return {
        str(call.args[0].value)
        for call in calls
        if getattr(call.func, "id", "") == "Headline" and call.args and isinstance(call.args[0], ast.Constant)
    }


def names_of(outcomes):
    """Return the headlines that at least one run has."""
    return {headline.name for outcome in outcomes for headline in outcome.headlines}


@pytest.fixture(scope="module")
def seen():
    """The headlines of each scene that the cases have seen."""
    return {}


def test_every_scene_has_a_case():
    assert {case.scene for case in CASES} == set(scenarios.names())


@pytest.mark.parametrize(
    "case", [pytest.param(case, id=named(case), marks=pytest.mark.nightly if case.long else ()) for case in CASES]
)
def test_the_errors_of_a_small_box_are_its_scatter(case, seen, request):
    if not case.long:
        request.getfixturevalue("fewer_frames")
    outcomes = runs(case.scene, case.number, **case.settings)
    seen.setdefault(case.scene, set()).update(names_of(outcomes))
    assert_profiles_are_covered(outcomes, profiles_of(outcomes[0]))
    assert_headlines_are_covered(outcomes, case.without)


@pytest.mark.parametrize("scene", scenarios.names())
@pytest.mark.usefixtures("fewer_frames")
def test_every_headline_that_a_scene_names_is_seen_in_a_case(scene, seen):
    if not spelled(scene) <= seen.get(scene, set()):  # this test alone, or a case of the nightly tier
        cases = [case.settings | QUICK.get((scene, case.long), {}) for case in CASES if case.scene == scene]
        own = [each for settings in cases for each in runs(scene, 1, **settings)]
        seen[scene] = names_of(own)
    assert spelled(scene) <= seen.get(scene, set())


@pytest.mark.nightly
@pytest.mark.parametrize("scene", scenarios.names())
def test_the_errors_of_sixty_runs_of_a_scene_as_it_comes_are_their_scatter(scene):
    if scene == "attraction":
        pytest.skip("as it comes it ends in two counts, which are what they are")
    if scene == "convection":
        pytest.skip("the number of rolls is chance, and runs differ by more than one of them fluctuates")
    outcomes = runs(scene, 60)
    table = accuracy.load().get(scene)
    assert table is None or set(table.labels) - set(PROFILES) <= names_of(outcomes)
    assert_profiles_are_covered(outcomes, profiles_of(outcomes[0]))
    assert_headlines_are_covered(outcomes, ROUNDING | METPY)

"""Error bars against the scatter from run to run: of headlines and of profiles, in many short runs of small boxes.

The misfits x of n runs about their mean, over the mean square of the errors stated, are chi-square of n - 1 degrees
of freedom: more says that errors are stated too small, less that they are too large. Each bound is the 99.9 % range;
as a run reads its error from 20 blocks, which know it by 20 % at worst, the range is that of an F distribution of
n - 1 and 12 n degrees. What a model leaves out moves the mean, which the tests of each scene bound.
"""

import math

import numpy as np
import pytest
from scipy import stats

from atmosbox.simulation import runner
from atmosbox.theory.constants import BOLTZMANN


def runs(scene, number, **settings):
    """Return the outcomes of so many runs that differ in their seed."""
    return [runner.execute(runner.prepare(scene, settings | {"seed": 1000 + seed})) for seed in range(number)]


def range_of_ratio(number):
    """Return the 99.9 % range of scatter over stated variance of so many runs."""
    return stats.f.ppf([0.0005, 0.9995], number - 1, 12 * number)


def assert_headlines_are_covered(outcomes):
    """Assert it of each headline that states an error."""
    rows = {}
    for outcome in outcomes:
        for headline in outcome.headlines:
            rows.setdefault(headline.name, []).append(headline)
    least, most = range_of_ratio(len(outcomes))
    found = {}
    for name, each in rows.items():
        stated = np.mean([headline.standard_error**2 for headline in each])
        if len(each) == len(outcomes) and stated > 0.0:
            misfit = [headline.value - (headline.theory or 0.0) for headline in each]
            found[name] = float(np.var(misfit, ddof=1) / stated)
    assert found
    assert {name: ratio for name, ratio in found.items() if not least <= ratio <= most} == {}


def assert_profiles_are_covered(outcomes, names):
    """Assert it of profiles on average over their layers, a third of which are taken to know nothing of each other."""
    for name in names:
        values, errors = (np.array([o.dataset[each].values for o in outcomes]) for each in (name, f"{name}_se"))
        ratio = float(np.mean(values.var(axis=0, ddof=1) / np.mean(errors**2, axis=0)))
        least, most = range_of_ratio(1 + (len(outcomes) - 1) * values.shape[1] // 3)
        assert least <= ratio <= most, (name, ratio)


def test_a_dense_column_has_the_pressure_n_k_t_z_and_its_errors_are_its_scatter():
    outcomes = runs("atmosphere", 24, molecules=100, knudsen=0.1, duration=60)
    assert_headlines_are_covered(outcomes)
    assert_profiles_are_covered(outcomes, ("number_density", "layer_temperature", "layer_pressure"))
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
    # a run knows the pressure of a layer by 4 %, 24 runs the mean of ten that share much by less than half a per cent
    ratio = pressure / (density * BOLTZMANN * temperature * factor(density))
    assert ratio.mean() == pytest.approx(1.0, abs=0.02)
    expected = found.number_density_theory.values[2:12]
    law = found.layer_pressure_theory.values[2:12] / (expected * BOLTZMANN * 288.15)
    assert np.allclose(law, factor(expected), rtol=3e-3)


SCENES = [
    pytest.param("temperature", 200, {"molecules": 200, "duration": 20}, id="temperature"),
    pytest.param("atmosphere", 200, {"molecules": 200, "duration": 100}, id="atmosphere"),
    pytest.param("elastic-collisions", 200, {"duration": 10}, id="elastic-collisions, ten seconds"),
    pytest.param("elastic-collisions", 200, {}, id="elastic-collisions"),
    pytest.param("condensation", 200, {"molecules": 500, "duration": 20}, id="condensation"),
    pytest.param("lifting-dry", 200, {"molecules": 200, "ascent": 400}, id="lifting-dry"),
    pytest.param("lifting-moist", 60, {"molecules": 2000}, id="lifting-moist"),
    pytest.param("lifting-sounding", 60, {"molecules": 4000, "ascent": 400}, id="lifting-sounding"),
    pytest.param("mountains", 60, {"molecules": 4000, "cloud_water": 3.0}, id="mountains"),
]
"""Small boxes of each scene whose errors have been mended."""


def test_the_errors_of_a_rising_cloud_are_its_scatter():
    """The walk of the entropy and the noise of condensing are both as large as the whole error at such a length."""
    outcomes = runs("lifting-moist", 24, molecules=2000, ascent=60)
    assert_headlines_are_covered(outcomes)
    misfit, stated = (
        np.array([each(outcome.dataset) for outcome in outcomes])
        for each in (lambda d: (d.parcel_temperature - d.adiabat_temperature).values, lambda d: d.parcel_temperature_se)
    )
    # a molecule of vapour that condenses is forgotten in a frame or two: 60 frames of 24 runs know their scatter by 4 %
    ratio = float(np.mean(misfit.var(axis=0, ddof=1) / np.mean(stated**2, axis=0)))
    assert 0.8 <= ratio <= 1.25


@pytest.mark.validate
@pytest.mark.parametrize(("scene", "number", "settings"), SCENES)
def test_the_errors_of_headlines_are_their_scatter(scene, number, settings):
    assert_headlines_are_covered(runs(scene, number, **settings))

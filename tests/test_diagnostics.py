"""The dataset that is made from the numbers of a run."""

import numpy as np
import pytest

from atmosbox.errors import EngineError
from atmosbox.file.dataset import dataset, headline_variables
from atmosbox.scene.headline import Headline

TIMES = {"elapsed_time": [1.0, 2.0, 3.0]}


def headline():
    """Return a headline as a scene states it."""
    return Headline("lapse_rate", 9.7e-3, 1e-4, 9.8e-3, 4e-4, "a finite rise", "K m-1", "K km-1", "lapse rate")


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_an_energy_budget_that_is_not_finite_stops_the_run(value):
    with pytest.raises(EngineError, match=r"kinetic_energy is not finite at \[1\]"):
        dataset({"kinetic_energy": [1.0, value, 2.0]}, TIMES, {})


def test_a_headline_becomes_four_numbers_in_si():
    held = headline_variables(headline())
    assert {name: pytest.approx(float(number.values)) for name, number in held.items()} == {
        "lapse_rate": 9.7e-3,
        "lapse_rate_se": 1e-4,
        "lapse_rate_theory": 9.8e-3,
        "lapse_rate_tolerance": 4e-4,
    }
    assert held["lapse_rate"].attrs["units"] == "K m-1"
    assert held["lapse_rate"].attrs["display_units"] == "K km-1"
    assert held["lapse_rate"].attrs["comment"] == "a finite rise"
    assert held["lapse_rate"].attrs["units_metadata"] == "temperature: difference"

"""The dataset that is made from the numbers of a run."""

from types import SimpleNamespace

import numpy as np
import pytest

from atmosbox.errors import EngineError
from atmosbox.file.dataset import dataset, headline_variables

TIMES = {"elapsed_time": [1.0, 2.0, 3.0]}


def headline(name="lapse_rate", value=9.7e-3, **fields):
    """Return a headline as a scene states it."""
    stated = {
        "standard_error": 1e-4,
        "theory": 9.8e-3,
        "tolerance": 4e-4,
        "unit": "K m-1",
        "display_unit": "K km-1",
        "reason": "a finite rise",
        "chance": 4e-4,
        "known": 4e-4,
        "verdict": None,
        "low": None,
        "high": None,
        "resolved": True,
        "program": "",
    }
    return SimpleNamespace(**{"name": name, "value": value, "label": "lapse rate", **stated, **fields})


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

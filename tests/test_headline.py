"""The few numbers that a run is about."""

import math

import pytest

from atmosbox.scene.headline import Headline


def headline(value=10.0, standard_error=1.0, theory=12.0, tolerance=0.0):
    return Headline("z", value, standard_error, theory, tolerance, "why", "K", "degC", "temperature")


@pytest.mark.parametrize(
    ("numbers", "misfit", "agrees"),
    [
        ({}, -2.0, True),
        ({"theory": 14.0}, -4.0, True),
        ({"theory": 14.5}, -4.5, False),
        ({"theory": 14.5, "tolerance": 0.5}, -4.5, True),
        ({"theory": 5.5}, 4.5, False),
        ({"theory": 10.0, "standard_error": 0.0}, 0.0, True),
        ({"theory": None}, None, None),
        ({"theory": None, "value": math.nan}, None, None),
        ({"theory": 10.0, "standard_error": math.nan}, 0.0, False),
        ({"theory": 10.0, "standard_error": math.inf}, 0.0, False),
        ({"value": math.inf}, math.inf, False),
    ],
)
def test_a_headline_agrees_within_four_standard_errors_and_its_tolerance(numbers, misfit, agrees):
    assert headline(**numbers).misfit == misfit
    assert headline(**numbers).agrees is agrees


@pytest.mark.parametrize("numbers", [{"value": math.nan}, {"theory": math.nan}])
def test_a_headline_that_is_not_a_number_agrees_with_nothing(numbers):
    assert headline(**numbers).agrees is False

"""Headlines: the few main results of a run."""

import math
from dataclasses import replace

import pytest

from atmosbox.file.dataset import dataset
from atmosbox.scene.headline import Headline
from atmosbox.simulation.verification import verify
from atmosbox.text.report import headline_lines


def headline(value=10.0, standard_error=1.0, theory=12.0, tolerance=0.0):
    return Headline("z", value, standard_error, theory, tolerance, "why", "K", "degC", "temperature")


def test_chance_alone_explains_four_standard_errors_and_the_known_error_the_rest():
    cases = [
        ({}, -2.0, "yes"),
        ({"theory": 14.0}, -4.0, "yes"),
        ({"theory": 14.5}, -4.5, "no"),
        ({"theory": 14.5, "tolerance": 0.5}, -4.5, "as stated"),
        ({"theory": 14.0, "tolerance": 0.5}, -4.0, "yes"),
        ({"theory": 5.5}, 4.5, "no"),
        ({"theory": 10.0, "standard_error": 0.0}, 0.0, "yes"),
        ({"theory": 12.0, "standard_error": 0.0, "tolerance": 3.0}, -2.0, "as stated"),
        ({"theory": None}, None, None),
        ({"theory": None, "value": math.nan}, None, None),
        ({"theory": 10.0, "standard_error": math.nan}, 0.0, "no"),
        ({"theory": 10.0, "standard_error": math.inf}, 0.0, "no"),
        ({"value": math.inf}, math.inf, "no"),
    ]
    for numbers, misfit, verdict in cases:
        found = headline(**numbers)
        assert found.misfit == misfit
        assert found.verdict == verdict
        assert found.agrees is {"yes": True, "as stated": True, "no": False, None: None}[verdict]


def test_what_is_allowed_is_split_into_chance_and_the_known_error():
    found = replace(headline(tolerance=0.5), bias=-0.25, bias_se=1.0)
    assert (found.chance, found.known) == (4.0, pytest.approx(4.0 * (math.sqrt(2.0) - 1.0) + 0.75))
    assert found.allowed == found.chance + found.known
    assert replace(found, value=13.0).known == pytest.approx(found.known - 0.25), "the bias is to the other side"


def test_a_headline_that_is_not_a_number_agrees_with_nothing():
    for numbers in [{"value": math.nan}, {"theory": math.nan}]:
        assert headline(**numbers).verdict == "no"


@pytest.mark.parametrize(
    ("theory", "tolerance", "allowed", "verdict"), [(12.0, 0.0, "4σ", "yes"), (15.0, 1.5, "4σ+1.5", "as stated")]
)
def test_the_table_shows_what_is_allowed_and_fits_a_page(theory, tolerance, allowed, verdict):
    head, row, *notes = headline_lines([headline(theory=theory, tolerance=tolerance)], 100)
    assert [cell for cell in row.split("  ") if cell][-2].strip() == allowed
    assert head.index("allowed") == row.index(allowed)
    assert row.endswith(f"  {verdict}")
    assert any("up to 1.5 K off" in note for note in notes) is (verdict == "as stated")


def test_check_and_the_file_say_what_is_allowed():
    stated = headline(theory=14.5, tolerance=0.75)
    found = dataset({}, {}, {}, [stated])
    attrs = found.z.attrs
    assert (attrs["misfit_allowed_by_chance"], attrs["misfit_allowed_as_known"]) == (4.0, 0.75)
    assert attrs["within_error"] == "as stated"
    (check,) = (check for check in verify(found) if check.name == "z")
    assert check.passed
    for words in ("-4.5 K", "4 K by chance", "0.75 K as known", "why"):
        assert words in check.sentence

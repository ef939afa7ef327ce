"""Headlines: the few main results of a run."""

import math
import re
from dataclasses import replace

import pytest

from atmosbox.file.dataset import dataset
from atmosbox.plot import caption
from atmosbox.scene.headline import AS_STATED, ROUNDING, Headline
from atmosbox.simulation.verification import verify
from atmosbox.text.report import headline_lines


def headline(value=10.0, standard_error=1.0, theory=12.0, tolerance=0.0):
    return Headline("z", value, standard_error, theory, tolerance, "why", "K", "degC", "temperature")


def test_a_difference_within_four_standard_errors_agrees_and_beyond_only_with_the_model_error():
    cases = [
        ({}, -2.0, "yes"), ({"theory": 14.0}, -4.0, "yes"), ({"theory": 14.5}, -4.5, "no"),
        ({"theory": 14.5, "tolerance": 0.5}, -4.5, AS_STATED), ({"theory": 14.0, "tolerance": 0.5}, -4.0, "yes"),
        ({"theory": 5.5}, 4.5, "no"), ({"theory": 10.0, "standard_error": 0.0}, 0.0, "yes"),
        ({"theory": 12.0, "standard_error": 0.0, "tolerance": 3.0}, -2.0, AS_STATED), ({"theory": None}, None, None),
        ({"theory": None, "value": math.nan}, None, None), ({"theory": 10.0, "standard_error": math.nan}, 0.0, "no"),
        ({"theory": 10.0, "standard_error": math.inf}, 0.0, "no"), ({"value": math.inf}, math.inf, "no"),
    ]  # fmt: skip
    for numbers, misfit, verdict in cases:
        found = headline(**numbers)
        assert found.misfit == misfit
        assert found.verdict == verdict
        assert found.agrees is {"yes": True, AS_STATED: True, "no": False, None: None}[verdict]


def test_what_is_expected_is_split_into_chance_and_the_known_error():
    found = replace(headline(tolerance=0.5), bias=-0.25, bias_se=1.0)
    assert (found.chance, found.known) == (4.0, pytest.approx(4.0 * (math.sqrt(2.0) - 1.0) + 0.75))
    assert found.allowed == found.chance + found.known
    assert replace(found, value=13.0).known == pytest.approx(found.known - 0.25), "the bias is to the other side"


def test_the_table_says_what_is_expected_in_one_number_and_why_in_words():
    cases = [
        (12.0, 0.0, "±4 K", "yes", "expected within: 4 standard errors (chance)."),
        (15.0, 1.5, "±5.5 K", AS_STATED, "expected within: 4 standard errors (chance) plus 1.5 K, because why."),
    ]
    for theory, tolerance, within, verdict, sentence in cases:
        head, row, *notes = headline_lines([headline(theory=theory, tolerance=tolerance)], 120)
        assert re.split("  +", head) == ["quantity", "measured", "theory", "difference", "expected within", "agrees?"]
        cells = re.split("  +", row)
        assert cells[:5] == [
            "temperature [degC]",
            "-263.1 ± 1.0",
            f"{theory - 273.15:.1f}",
            f"{10.0 - theory:.1f} K",
            within,
        ]
        assert cells[5] == verdict
        assert notes[-1] == sentence


def test_rounding_of_what_is_conserved_agrees_without_an_excuse():
    kept = Headline("e", 2e-15, 0.0, 0.0, 1e-12, ROUNDING, "1", "1", "largest relative change of the energy")
    assert (kept.verdict, replace(kept, value=2e-12).verdict) == ("yes", "no")
    assert headline_lines([kept], 80)[-1] == "expected within: 1e-12, because a computer rounds at every collision."


def test_what_a_run_is_too_small_to_measure_is_no_result_and_the_run_says_what_to_set():
    base = Headline("z", 1013e2, 51e2, 888e2, 1e3, "", "Pa", "hPa", "cloud base", low=300e2, high=1000e2)
    assert base.agrees is None
    line = " ".join(headline_lines([base], 80))
    assert line.startswith("cloud base: this run is too small to measure it (1013 ± 51 hPa, where 300 to 1000 hPa")
    assert line.endswith("set 4 times as many molecules.")
    for measured, counts in (({"value": 890e2}, True), ({"value": 890e2, "standard_error": 71e2}, False)):
        assert (replace(base, **measured).agrees is not None) is counts
    found = dataset({}, {}, {"atmosbox_headlines": '["z"]'}, [base])
    assert [check.name for check in verify(found)] == ["complete", "finite"]
    assert caption.headline(found, "z") is None


def test_check_and_the_file_say_what_is_expected():
    stated = headline(theory=14.5, tolerance=0.75)
    found = dataset({}, {}, {}, [stated])
    attrs = found.z.attrs
    assert (attrs["misfit_allowed_by_chance"], attrs["misfit_allowed_as_known"]) == (4.0, 0.75)
    assert attrs["within_error"] == AS_STATED
    (check,) = (check for check in verify(found) if check.name == "z")
    assert check.passed
    known = "4 standard errors (chance) plus 0.75 K, because why"
    assert check.sentence == f"temperature: difference -4.5 K, within ±4.8 K: {known}"
    (check,) = (check for check in verify(dataset({}, {}, {}, [headline(theory=20.0)])) if check.name == "z")
    assert not check.passed
    assert check.sentence == "temperature: difference -10 K, not within ±4 K: 4 standard errors (chance)"

import math

import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.conversion import known_unit
from atmosbox.scene.sounding.column import QUANTITIES, number, stated_columns, unit_of


def test_every_name_of_a_quantity_is_found_and_is_of_no_other():
    for quantity in QUANTITIES:
        for name in QUANTITIES[quantity].names:
            assert stated_columns(["other", name], "here") == {quantity: (1, None)}


def test_the_best_name_with_a_fitting_unit_is_chosen():
    cases = [
        (["T_K"], {"temperature": (0, "K")}),
        (["t", "T"], {"temperature": (1, None)}),
        (["t [s]", "temp [K]"], {"temperature": (1, "K")}),
        (["level", "pressure"], {"pressure": (1, None)}),
        (["level [1]", "lev [hPa]"], {"pressure": (1, "hPa")}),
        (["dew point (°C)"], {"dewpoint": (0, "°C")}),
        (["T_virtual", "p_sea"], {}),
    ]
    for header, found in cases:
        assert stated_columns(header, "here") == found


def test_the_same_name_twice_is_refused():
    with pytest.raises(SoundingError, match=r"here: Td is a second column of dewpoint: delete one of the two"):
        stated_columns(["td", "Td"], "here")


def test_units_are_known_in_capitals_too():
    for text in ["hPa", "HPA", "mb", "millibars", " mbar "]:
        assert unit_of("pressure", text, "here") == known_unit("hPa")


def test_a_wrong_unit_is_refused_with_the_usual_one():
    cases = [
        (None, "has no unit"),
        ("", "has no unit"),
        ("K", "K is not a unit"),
        ("#!", "the unit #! of the pressure is not"),
    ]
    for text, sentence in cases:
        with pytest.raises(SoundingError, match=rf"here: .*{sentence}.*: name it, as in .pressure \[hPa\]"):
            unit_of("pressure", text, "here")


def test_a_number_is_read():
    for token, value in [("1", 1.0), (" -1.5e2 ", -150.0), ("+.5", 0.5), ("7.", 7.0), ("−3", -3.0), ('"4"', 4.0)]:
        assert number(token, "pressure", "here") == value


def test_a_mark_of_a_missing_value_is_nan():
    for token in ["", " ", "nan", "NaN", "NA", "n/a", "None", "null", "M", "missing", "-", "///", "***"]:
        assert math.isnan(number(token, "pressure", "here"))


def test_anything_else_is_refused():
    cases = [
        ("one", "one is not a number"),
        ("1,5", "1,5 is written with a comma"),
        ("-inf", "-inf is not finite"),
        ("1e31", "1e31 is too large"),
        ("9" * 70, "is too large"),
        ("0x10", "0x10 is not a number"),
        ("٣", "٣ is not a number"),
    ]
    for token, sentence in cases:
        with pytest.raises(SoundingError, match=f"here: the pressure .*{sentence}"):
            number(token, "pressure", "here")

"""A value that a user types is read as the intended number, or is refused with what to type instead."""

import math
import subprocess
import sys
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from atmosbox.errors import SettingError, UnitError
from atmosbox.scene.conversion import phrase, typed
from atmosbox.scene.settings import Parameter

UNITS = [
    "1", "%", "kg kg-1", "g kg-1", "K", "degC", "Pa", "hPa", "m", "km", "um", "nm", "s", "h", "ns", "ps", "m s-1",
    "km h-1", "m s-2", "m/s2", "K km-1", "K/km", "J", "kg", "g mol-1", "hPa/ns",
]  # fmt: skip
WARM = Parameter("temperature", "degC", 25.0, -100.0, 500.0)
MOLECULES = Parameter("molecules", "1", 4000, 1, 10_000_000, kind="int")

finite = st.floats(-1e300, 1e300)


def parse(value, unit):
    return Parameter("x", unit, 1.0).parse(value)


def refusal(parameter, value, error=UnitError):
    with pytest.raises(SettingError) as caught:
        parameter.parse(value)
    sentence = str(caught.value)
    assert type(caught.value) is error
    assert sentence.isprintable()
    assert sentence.startswith(f"{parameter.name} = ")
    parameter.parse(caught.value.remedy[0].value)
    return sentence


# Reading


@given(value=finite, unit=st.sampled_from(UNITS))
def test_what_is_said_and_what_is_typed_is_read_again(value, unit):
    rounded = float(f"{value:.12g}")
    assert parse(typed(value, unit), unit) == parse(phrase(value, unit), unit) == rounded
    assert " " not in typed(value, unit)


@given(value=finite)
def test_bare_numbers_are_read_as_they_are(value):
    assert parse(value, "hPa") == parse(repr(value), "hPa") == parse(f"{value!r} hPa", "hPa") == value


@given(value=st.integers(-(2**63), 2**63))
def test_whole_numbers_keep_all_their_digits(value):
    count = Parameter("x", "1", 1, kind="int")
    assert count.parse(value) == count.parse(str(value)) == value


@given(
    value=st.floats(-1e6, 1e6),
    pair=st.sampled_from([("degC", "K"), ("degF", "degC"), ("km", "nm"), ("atm", "hPa"), ("h", "ps")]),
)
def test_a_number_survives_the_way_to_another_unit_and_back(value, pair):
    ours, theirs = pair
    there = parse(f"{value!r} {ours}", theirs)
    assert parse(f"{there!r} {theirs}", ours) == pytest.approx(value, rel=1e-10, abs=1e-8)


def test_every_spelling_of_25_degrees_is_25_degrees():
    cases = [
        "25", "25.", "+25", "2.5e1", "25degC", "25 degC", "25C", "25 c", "25°C", "25 °C", "25º C", "25℃",
        "25 celsius", "25 Celsius", "25 deg C", "25 degrees Celsius", "25 degree_Celsius", "298.15 K", "298.15K",
        "298.15 kelvin", "298.15k", "77 degF", "77F", "77 °F", "77 fahrenheit", "536.67 rankine", " 25\tdegC ",
        "25\u00a0°C", 25, 25.0, np.float32(25), np.int64(25), Fraction(25),
    ]  # fmt: skip
    for text in cases:
        assert parse(text, "degC") == 25.0


def test_every_spelling_of_standard_pressure_is_1013_hpa():
    cases = [
        "1013.25", "1013.25 hPa", "1013.25hpa", "1013.25 mbar", "1013.25mb", "101325 Pa", "1.01325e5 pa",
        "101.325 kPa", "1 atm", "760 Torr", "101325 N/m2", "101325 J m^-3", "1_013.25 hPa",
    ]  # fmt: skip
    for text in cases:
        assert parse(text, "hPa") == pytest.approx(1013.25, rel=1e-9)


def test_every_spelling_of_an_acceleration_is_that_acceleration():
    cases = [
        "9.8", "9.8 m/s2", "9.8 m s-2", "9.8m/s^2", "9.8 m/s**2", "9.8 m s**-2", "9.8 m s^-2", "9.8 m s⁻²",
        "9.8 m/s²", "9.8 m / s ^ 2", "9.8 m/s/s", "9.8 m·s-2", "9.8 m*s-2", "9.8 m per s2", "9.8 N/kg",
        "0.0098 km/s2",
    ]  # fmt: skip
    for text in cases:
        for unit in ["m s-2", "m/s2"]:
            assert parse(text, unit) == 9.8


def test_a_degree_in_a_lapse_rate_is_one_of_difference():
    for text in ["6.5 K/km", "6.5 K km-1", "6.5 degC/km", "6.5 °C per km", "6.5C/km", "0.0065 K/m", "11.7 degF/km"]:
        assert parse(text, "K/km") == 6.5


def test_a_value_is_read_in_the_unit_of_the_setting():
    cases = [
        ("0.032 µm", "nm", 32.0),
        ("320 Å", "nm", 32.0),
        ("1 ft", "m", 0.3048),
        ("70 %", "1", 0.7),
        ("0.7", "%", 0.7),
        ("5 mg/kg", "g kg-1", 0.005),
        ("-40 degF", "degC", -40.0),
        ("−5 °C", "degC", -5.0),
        (".5", "1", 0.5),
    ]
    for text, unit, value in cases:
        assert parse(text, unit) == value


def test_whole_numbers_may_be_spelled_as_numbers_are():
    for value in [4000, "4000", "4e3", "4E+3", 4000.0, "4_000", "400000%", np.int32(4000)]:
        assert MOLECULES.parse(value) == 4000
        assert type(MOLECULES.parse(value)) is int


# Refusing


@given(low=finite, span=st.floats(0.0, 1e6))
def test_the_limits_themselves_are_allowed_as_they_are_typed(low, span):
    low, high = (float(f"{limit:.12g}") for limit in (low, low + span))
    within = Parameter("x", "hPa", low, low, high)
    assert [within.parse(typed(limit, "hPa")) for limit in (low, high)] == [low, high]


def test_a_value_out_of_range_is_refused_with_the_range():
    assert "-150 degC is below the lowest allowed, -100 degC to 500 degC" in refusal(WARM, -150, SettingError)
    assert "2000 K is above the highest allowed" in refusal(WARM, "2000 K", SettingError)
    assert "1 to 10000000" in refusal(MOLECULES, "-4e3", SettingError)
    assert WARM.parse("932 degF") == 500.0  # a limit may be typed in another unit


def test_a_wrong_dimension_is_named_with_the_right_one():
    cases = [
        ("5 m", "degC", "a length", "a temperature in degC"),
        ("5 C", "hPa", "a temperature", "a pressure in hPa"),
        ("5 K", "K/km", "a temperature", "a lapse rate in K/km"),
        ("5 degC/km", "degC", "a lapse rate", "a temperature in degC"),
        ("5 K", "1", "a temperature", "a pure number"),
        ("5 %", "m", "a pure number", "a length in m"),
        ("5 g/kg", "%", "a mixing ratio", "a percentage"),
        ("5 knots", "m", "a speed", "a length in m"),
        ("5 V", "m", "a quantity of another kind", "a length in m"),
    ]
    for value, unit, kind, wanted in cases:
        sentence = refusal(Parameter("height", unit, 1.0), value)
        assert f"is {kind}," in sentence
        assert wanted in sentence


def test_what_is_no_temperature_is_refused_with_the_reason():
    cases = [
        ("", "is empty"),
        (math.nan, "is not finite"),
        ("-Infinity", "is not finite"),
        ("inf degC", "is not finite"),
        (10**400, "is too large"),
        ("1e400 K", "is too large"),
        ("1e99999999999999999999", "is too large"),
        (True, "is not a number"),
        ([25], "is not a number"),
        (Decimal(25), "is not a number"),
        (np.array([25.0]), "is not a number"),
        ("warm", "is not a number"),
        ("٢٥", "is not a number"),
        ("2" * 300, "is not a number"),
        ("25,5", "is written with a comma"),
        ("25 deg", "has an unknown unit"),
        ("25°", "has an unknown unit"),
        ("25 blorp", "has an unknown unit"),
        ("25 degC 300", "has an unknown unit"),
        ("2*25 K", "has an unknown unit"),
        ("10⁵ K", "has an unknown unit"),
        ("5 dB", "has an unknown unit"),
        ("5 dBm", "has an unknown unit"),
        ("5 rad", "has an unknown unit"),
        ("5 delta_degC", "has an unknown unit"),
        ("5 __class__", "has an unknown unit"),
        ("5 pm-99", "has an unknown unit"),
        ("5 m**9**9**9", "has an unknown unit"),
        ("5 m/m", "has an unknown unit"),
    ]
    for value, problem in cases:
        assert f"{problem}, but a temperature from -100 degC to 500 degC is wanted" in refusal(WARM, value)


def test_a_count_that_is_not_whole_is_refused():
    for value in ["4000.5", 4000.5, "1e-400"]:
        assert "is not whole, but a whole number from 1 to 10000000 is wanted" in refusal(MOLECULES, value)


def test_a_number_too_large_for_the_unit_of_the_setting_is_refused():
    assert "is too large" in refusal(Parameter("x", "nm", 1.0), "1e308 km")


words = st.sampled_from(
    ["degC", "°C", "K", "hPa", "km", "m", "s", "-2", "/", "^", "**", "*", " ", "25", "1e5", ".", ",", "nan",
     "inf", "%", "°", "deg", "per", "delta_degF", "dB", "_", "99", "--", "(", "pint", "µ", "²", "e", "E9",
     "lambda", "None", "\0"]
)  # fmt: skip
texts = st.text(max_size=30) | st.lists(words, max_size=6).map("".join)
quantities = st.builds("{}{}".format, finite, st.text(max_size=8) | st.lists(words, max_size=4).map("".join))


@settings(max_examples=1000)
@given(text=texts | quantities, unit=st.sampled_from(["1", "degC", "hPa", "K/km", "m s-2", "%", "hPa/ns"]))
@example(text="1 %/km", unit="1")
def test_any_text_is_a_finite_number_or_refused_in_one_sentence(text, unit):
    for parameter in (Parameter("x", unit, 1.0, -1e5, 1e5), Parameter("x", unit, 1, -(10**5), 10**5, kind="int")):
        try:
            value = parameter.parse(text)
        except SettingError as error:
            sentence = str(error)
            assert sentence.isprintable()
            assert sentence.startswith("x = ")
            assert sentence.endswith(".")
        else:
            assert -1e5 <= value <= 1e5


def test_pint_is_imported_only_for_a_unit_that_no_scene_declares():
    script = (
        "import sys\n"
        "from atmosbox.scene.settings import Parameter\n"
        "for text, unit in (('25 °C', 'K'), ('9.8m/s2', 'm s-2'), ('6.5 K/km', 'K km-1'), ('1013 mbar', 'hPa')):\n"
        "    Parameter('x', unit, 1.0).parse(text)\n"
        "assert not {'pint', 'numpy'} & set(sys.modules)\n"
        "Parameter('x', 'degC', 1.0).parse('77 degF')\n"
        "assert 'pint' in sys.modules\n"
    )
    root = Path(__file__).parents[1]
    subprocess.run([sys.executable, "-c", script], cwd=root, check=True, timeout=60)

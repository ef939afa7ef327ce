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
from atmosbox.scene.quantity import parse_quantity, parse_whole, phrase, typed

UNITS = [
    "1", "%", "kg kg-1", "g kg-1", "K", "degC", "Pa", "hPa", "kPa", "m", "km", "cm", "mm", "um", "nm", "s",
    "min", "h", "ms", "us", "ns", "ps", "fs", "m s-1", "m/s", "km h-1", "m s-2", "m/s2", "K m-1", "K km-1",
    "K/km", "J", "kg", "g", "kg mol-1", "g mol-1", "hPa/ns",
]  # fmt: skip

finite = st.floats(allow_nan=False, allow_infinity=False)
moderate = st.floats(-1e6, 1e6)


def refusal(value, unit="degC", **limits):
    with pytest.raises(SettingError) as caught:
        parse_quantity(value, unit, "temperature", **limits)
    sentence = str(caught.value)
    assert sentence.endswith(".")
    assert sentence.isprintable()
    return sentence


# Saying


def test_numbers_are_said_and_typed_with_their_unit():
    assert phrase(-100.0, "degC") == "-100 degC"
    assert phrase(10_000_000, "1") == "10000000"
    assert phrase(0.1 + 0.2, "") == "0.3"
    assert typed(6.5, "K km-1") == "6.5K/km"
    assert typed(70.0, "%") == "70%"
    assert typed(1.5, "m s-2") == "1.5m/s2"


@pytest.mark.parametrize("unit", UNITS)
def test_what_is_typed_is_read_again(unit):
    assert parse_quantity(typed(2.5, unit), unit, "x") == 2.5
    assert parse_quantity(phrase(2.5, unit), unit, "x") == 2.5


# Reading


@pytest.mark.parametrize(
    "text",
    ["25", "25.", "+25", "2.5e1", "25degC", "25 degC", "25C", "25 c", "25°C", "25 °C", "25º C", "25℃",
     "25 celsius", "25 Celsius", "25 deg C", "25 degrees Celsius", "25 degree_Celsius", "298.15 K", "298.15K",
     "298.15 kelvin", "298.15k", "77 degF", "77F", "77 °F", "77 fahrenheit", "536.67 rankine", " 25\tdegC ",
     "25\u00a0°C", 25, 25.0, np.float32(25), np.int64(25), Fraction(25)],
)  # fmt: skip
def test_every_spelling_of_25_degrees_is_25_degrees(text):
    assert parse_quantity(text, "degC", "temperature") == 25.0


@pytest.mark.parametrize(
    "text",
    ["1013.25", "1013.25 hPa", "1013.25hpa", "1013.25 mbar", "1013.25mb", "101325 Pa", "1.01325e5 pa",
     "101.325 kPa", "1 atm", "760 Torr", "101325 N/m2", "101325 J m^-3"],
)  # fmt: skip
def test_every_spelling_of_standard_pressure_is_1013_hpa(text):
    assert parse_quantity(text, "hPa", "pressure") == pytest.approx(1013.25, rel=1e-9)


@pytest.mark.parametrize(
    "text",
    ["9.8", "9.8 m/s2", "9.8 m s-2", "9.8m/s^2", "9.8 m/s**2", "9.8 m s**-2", "9.8 m s^-2", "9.8 m s⁻²",
     "9.8 m/s²", "9.8 m / s ^ 2", "9.8 m/s/s", "9.8 m·s-2", "9.8 m*s-2", "9.8 m per s2", "9.8 N/kg",
     "0.0098 km/s2"],
)  # fmt: skip
@pytest.mark.parametrize("unit", ["m s-2", "m/s2"])
def test_every_spelling_of_an_acceleration_is_that_acceleration(text, unit):
    assert parse_quantity(text, unit, "gravity") == 9.8


@pytest.mark.parametrize(
    "text",
    [
        "6.5",
        "6.5 K/km",
        "6.5 K km-1",
        "6.5 degC/km",
        "6.5 °C per km",
        "6.5C/km",
        "0.0065 K/m",
        "11.7 degF/km",
    ],
)
def test_a_lapse_rate_is_one_of_differences(text):
    assert parse_quantity(text, "K/km", "lapse_rate") == 6.5


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("5 km", "m", 5000.0),
        ("0.032 µm", "nm", 32.0),
        ("0.032 μm", "nm", 32.0),
        ("320 Å", "nm", 32.0),
        ("1 ft", "m", 0.3048),
        ("0.5 ns", "ps", 500.0),
        ("70 %", "1", 0.7),
        ("0.7", "%", 0.7),
        ("32 degF", "degC", 0.0),
        ("-40 degF", "degC", -40.0),
        ("0 degC", "K", 273.15),
        ("−5 °C", "degC", -5.0),
        ("1_000 hPa", "hPa", 1000.0),
        (".5", "1", 0.5),
    ],
)
def test_a_value_is_read_in_the_unit_of_the_setting(text, unit, value):
    assert parse_quantity(text, unit, "x") == value


def test_a_limit_can_be_typed_in_another_unit():
    assert parse_quantity("932 degF", "degC", "temperature", low=-100.0, high=500.0) == 500.0


# Refusing


def test_a_value_out_of_range_names_the_value_the_range_and_the_fix():
    assert refusal(-5, "K", low=1.0, high=2000.0) == (
        "temperature = -5 K is below the lowest allowed, 1 K to 2000 K: give --set temperature=25degC."
    )
    assert refusal("2000 K", low=-90.0, high=500.0, example="15degC") == (
        "temperature = 2000 K is above the highest allowed, -90 degC to 500 degC: give --set temperature=15degC."
    )
    assert refusal("-5", "1", low=0.0) == "temperature = -5 is below the lowest allowed, 0: give --set temperature=0."
    assert refusal("5 km", "m", high=9.0) == (
        "temperature = 5 km is above the highest allowed, 9 m: give --set temperature=9m."
    )


@pytest.mark.parametrize(
    ("value", "unit", "kind", "wanted", "fix"),
    [
        ("5 m", "degC", "a length", "a temperature in degC", "25degC"),
        ("5 hPa", "K", "a pressure", "a temperature in K", "25degC"),
        ("5 C", "hPa", "a temperature", "a pressure in hPa", "1000hPa"),
        ("5 K", "K/km", "a temperature", "a lapse rate in K/km", "1K/km"),
        ("5 degC/km", "degC", "a lapse rate", "a temperature in degC", "25degC"),
        ("5 K", "1", "a temperature", "a pure number", "1"),
        ("5 %", "m", "a pure number", "a length in m", "1m"),
        ("5 g/kg", "%", "a mixing ratio", "a percentage", "1%"),
        ("5 m/s", "m s-2", "a speed", "an acceleration in m s-2", "1m/s2"),
        ("5 knots", "m", "a speed", "a length in m", "1m"),
        ("5 V", "m", "a quantity of another kind", "a length in m", "1m"),
    ],
)
def test_a_wrong_dimension_is_named_and_the_right_one_given(value, unit, kind, wanted, fix):
    assert (
        refusal(value, unit)
        == f"temperature = {value} is {kind}, but {wanted} is wanted: give --set temperature={fix}."
    )


def test_the_fix_lies_in_the_range():
    assert "temperature=400K." in refusal("5 m", "K", low=400.0, high=500.0)
    assert "temperature=-10degC." in refusal("5 m", "degC", high=-10.0)
    assert "temperature=25degC." in refusal("5 m", "K", low=1.0)


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ("", 'temperature = "" is empty'),
        (" \n", 'temperature = " \\n" is empty'),
        (math.nan, "is not finite"),
        (-math.inf, "is not finite"),
        ("nan", "is not finite"),
        ("-Infinity", "is not finite"),
        ("inf degC", "is not finite"),
        ("NaN K", "is not finite"),
        (10**400, "about 1e400 is too large"),
        (-(10**4000), "about -1e4000 is too large"),
        ("1e400", "is too large"),
        ("1e400 K", "is too large"),
        ("1e99999999999999999999", "is out of reach"),
        (True, "is not a number"),
        (None, "is not a number"),
        ([25], "is not a number"),
        (Decimal(25), "is not a number"),
        (b"25", "is not a number"),
        (25 + 0j, "is not a number"),
        (np.array([25.0]), "is not a number"),
        ("warm", "is not a number"),
        ("degC", "is not a number"),
        ("٢٥", "is not a number"),
        ("\u202e25", "is not a number"),
        ("2" * 300, "is not a number"),
        ("25,5", "is written with a comma"),
        ("1,000 K", "is written with a comma"),
        ("25 deg", "has an unknown unit"),
        ("25°", "has an unknown unit"),
        ("25 blorp", "has an unknown unit"),
        ("25 degC warm", "has an unknown unit"),
        ("25 degC 300", "has an unknown unit"),
        ("2*25 K", "has an unknown unit"),
        ("2 5", "has an unknown unit"),
        ("25 1", "has an unknown unit"),
        ("10⁵ K", "has an unknown unit"),
        ("5 dB", "has an unknown unit"),
        ("5 dBm", "has an unknown unit"),
        ("5 rad", "has an unknown unit"),
        ("5 delta_degC", "has an unknown unit"),
        ("5 米", "has an unknown unit"),
        ("5 __class__", "has an unknown unit"),
        ("5 pm-99", "has an unknown unit"),
        ("5 A0", "has an unknown unit"),
        ("5 NAN", "has an unknown unit"),
        ("5 m/m", "has an unknown unit"),
    ],
)
def test_what_is_no_temperature_is_refused_with_the_reason(value, problem):
    with pytest.raises(UnitError) as caught:
        parse_quantity(value, "degC", "temperature", low=-100.0, high=500.0)
    assert problem in str(caught.value)
    assert str(caught.value).startswith("temperature")
    assert str(caught.value).endswith(
        ", but a temperature from -100 degC to 500 degC is wanted: give --set temperature=25degC."
    )


def test_a_value_too_large_for_the_unit_of_the_setting_is_refused():
    assert "is too large" in refusal("1e308 km", "nm")


# Whole numbers


@pytest.mark.parametrize("value", [4000, "4000", "4e3", "4E+3", 4000.0, "4000.0", "4_000", "400000%", np.int32(4000)])
def test_whole_numbers_may_be_spelled_as_numbers_are(value):
    whole = parse_whole(value, "1", "molecules", low=1, high=10_000_000)
    assert whole == 4000
    assert type(whole) is int


@pytest.mark.parametrize("value", [2**63 - 1, str(2**63 - 1), "9.223372036854775807e18"])
def test_whole_numbers_keep_all_their_digits(value):
    assert parse_whole(value, "1", "seed", low=0, high=2**63 - 1) == 2**63 - 1


def test_whole_numbers_may_have_a_unit():
    assert parse_whole("0.003 us", "ns", "duration") == 3
    with pytest.raises(UnitError, match=r"3.5 ps is not whole, but a whole number of ns from 1 ns to 9 ns is wanted"):
        parse_whole("3.5 ps", "ns", "duration", low=1, high=9)


@pytest.mark.parametrize(
    ("value", "problem"),
    [
        ("4000.5", "is not whole"),
        (4000.5, "is not whole"),
        ("1e-400", "is not whole"),
        ("4000 K", "is a temperature"),
        ("4,000", "is written with a comma"),
        ("0x10", "has an unknown unit"),
        ("10**7", "has an unknown unit"),
        (True, "is not a number"),
        (math.nan, "is not finite"),
        (10**400, "about 1e400 is too large"),
        ("1e400", "is too large"),
    ],
)
def test_what_is_no_whole_number_is_refused_with_the_reason(value, problem):
    with pytest.raises(UnitError) as caught:
        parse_whole(value, "1", "molecules", low=1, high=10_000_000, example="4000")
    assert problem in str(caught.value)
    assert str(caught.value).endswith(", but a whole number from 1 to 10000000 is wanted: give --set molecules=4000.")


@pytest.mark.parametrize(("value", "side"), [(0, "below the lowest"), ("-4e3", "below the lowest"), ("1e300", "above")])
def test_a_whole_number_out_of_range_is_refused(value, side):
    with pytest.raises(SettingError, match=f"is {side}.* allowed, 1 to 10000000: give --set molecules=1"):
        parse_whole(value, "1", "molecules", low=1, high=10_000_000)


# Whatever may come

words = st.sampled_from(
    ["degC", "°C", "K", "hPa", "km", "m", "s", "-2", "/", "^", "**", "*", " ", "25", "1e5", ".", ",", "nan",
     "inf", "%", "°", "deg", "per", "delta_degF", "dB", "_", "99", "--", "(", "pint", "µ", "²", "e", "E9",
     "lambda", "None", "\0"]
)  # fmt: skip
texts = st.text(max_size=30) | st.lists(words, max_size=6).map("".join)
quantities = st.builds("{}{}".format, finite, st.text(max_size=8) | st.lists(words, max_size=4).map("".join))


@settings(max_examples=1000)
@given(text=texts | quantities, unit=st.sampled_from(["1", "degC", "hPa", "K/km", "m s-2", "%", "hPa/ns"]))
@example(text="1e99999999999999999999", unit="1")
@example(text="1 pm-99", unit="hPa")
@example(text="1 %/km", unit="1")
def test_any_text_is_a_finite_number_or_refused_in_one_sentence(text, unit):
    for parse in (parse_quantity, parse_whole):
        try:
            value = parse(text, unit, "x", low=-1e5, high=1e5)
        except SettingError as error:
            sentence = str(error)
            assert sentence.isprintable()
            assert sentence.startswith("x = ")
            assert sentence.endswith(".")
        else:
            assert -1e5 <= value <= 1e5


@given(value=finite)
def test_bare_numbers_are_read_as_they_are(value):
    assert parse_quantity(value, "hPa", "x") == value
    assert parse_quantity(repr(value), "hPa", "x") == value
    assert parse_quantity(f"{value!r} hPa", "hPa", "x") == value


@given(value=st.integers())
def test_whole_numbers_are_read_as_they_are(value):
    assert parse_whole(value, "1", "x") == value
    assert parse_whole(str(value), "1", "x") == value


@given(
    value=moderate,
    pair=st.sampled_from([("degC", "K"), ("degF", "degC"), ("km", "nm"), ("atm", "hPa"), ("h", "ps")]),
)
def test_reading_in_another_unit_and_back_is_the_same_number(value, pair):
    ours, theirs = pair
    there = parse_quantity(f"{value!r} {ours}", theirs, "x")
    assert parse_quantity(f"{there!r} {theirs}", ours, "x") == pytest.approx(value, rel=1e-10, abs=1e-8)


def test_pint_is_imported_only_for_a_unit_that_is_not_known_by_heart():
    script = (
        "import sys\n"
        "from atmosbox.scene.conversion import to_si\nfrom atmosbox.scene.quantity import parse_quantity\n"
        "parse_quantity('25 °C', 'K', 'x'), parse_quantity('9.8 m/s^2', 'm s-2', 'x'), to_si(1.0, 'K/km')\n"
        "assert not {'pint', 'numpy', 'pydantic'} & set(sys.modules)\n"
        "parse_quantity('77 degF', 'degC', 'x')\n"
        "assert 'pint' in sys.modules\n"
    )
    root = Path(__file__).parents[1]
    subprocess.run([sys.executable, "-c", script], cwd=root, check=True, timeout=60)

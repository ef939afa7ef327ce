"""Conversion of units, checked against pint."""

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from atmosbox.scene.conversion import from_si, to_si

TABLE = {  # unit: itself and its SI unit in the words of pint
    "1": ("dimensionless", "dimensionless"), "%": ("percent", "dimensionless"),
    "kg kg-1": ("kg/kg", "dimensionless"), "g kg-1": ("g/kg", "dimensionless"), "K": ("kelvin", "kelvin"),
    "degC": ("degree_Celsius", "kelvin"), "Pa": ("pascal", "pascal"), "hPa": ("hectopascal", "pascal"),
    "kPa": ("kilopascal", "pascal"), "m": ("meter", "meter"), "km": ("kilometer", "meter"),
    "cm": ("centimeter", "meter"), "mm": ("millimeter", "meter"), "um": ("micrometer", "meter"),
    "nm": ("nanometer", "meter"), "s": ("second", "second"), "min": ("minute", "second"), "h": ("hour", "second"),
    "ms": ("millisecond", "second"), "us": ("microsecond", "second"), "ns": ("nanosecond", "second"),
    "ps": ("picosecond", "second"), "fs": ("femtosecond", "second"), "m s-1": ("m/s", "m/s"), "m/s": ("m/s", "m/s"),
    "km h-1": ("km/hour", "m/s"), "m s-2": ("m/s**2", "m/s**2"), "m/s2": ("m/s**2", "m/s**2"),
    "K m-1": ("K/m", "K/m"), "K km-1": ("K/km", "K/m"), "K/km": ("K/km", "K/m"), "J": ("joule", "joule"),
    "zJ": ("zeptojoule", "joule"), "J-1": ("1/joule", "1/joule"), "zJ-1": ("1/zeptojoule", "1/joule"),
    "s-1": ("1/second", "1/second"), "ns-1": ("1/nanosecond", "1/second"), "g m-3": ("g/m**3", "kg/m**3"),
    "kg": ("kilogram", "kilogram"), "g": ("gram", "kilogram"), "kg mol-1": ("kg/mol", "kg/mol"),
    "g mol-1": ("g/mol", "kg/mol"),
}  # fmt: skip
LOOKED_UP = ["degF", "mmHg", "ft", "knot", "degF/kft", "hPa/ns", "J/kg/K"]


@pytest.fixture(scope="module")
def registry():
    return pint.UnitRegistry()


def test_the_units_of_the_table_are_those_of_pint(registry):
    for unit, words in TABLE.items():
        for value in (0.0, 1.0, -40.0):
            expected = registry.Quantity(value, words[0]).to(words[1]).magnitude
            assert to_si(value, unit) == pytest.approx(expected, rel=1e-14, abs=1e-14)


@given(value=st.floats(-1e6, 1e6), unit=st.sampled_from([*TABLE, *LOOKED_UP]), difference=st.booleans())
def test_there_and_back_is_the_same_number(value, unit, difference):
    there = to_si(value, unit, difference=difference)
    assert from_si(there, unit, difference=difference) == pytest.approx(value, rel=1e-12, abs=1e-12 + 1e-15 * 3e2)

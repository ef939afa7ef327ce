import numpy as np
import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.conversion import known_unit
from atmosbox.scene.sounding.column import in_si
from atmosbox.scene.sounding.plausibility import LARGEST_GAP, ROUNDING, check_levels, check_plausible, widest_gap

PRESSURE = np.array([1000e2, 900e2, 800e2, 650e2, 500e2, 300e2, 100e2])
TEMPERATURE = np.array([298.0, 292.0, 286.0, 275.0, 262.0, 233.0, 210.0])
DEWPOINT = TEMPERATURE - 5.0


def place(level):
    return f"here, level {level}"


def refusal(pressure=PRESSURE, temperature=TEMPERATURE, dewpoint=DEWPOINT):
    with pytest.raises(SoundingError) as caught:
        check_levels(pressure, temperature, dewpoint, place)
    return str(caught.value)


def changed(column, level, value):
    column = column.copy()
    column[level] = value
    return column


def test_an_ascent_passes():
    check_levels(PRESSURE, TEMPERATURE, DEWPOINT, place)


def test_a_pressure_that_does_not_decrease_is_refused():
    assert "level 3: the pressure of 850 hPa is not below the 800 hPa" in refusal(changed(PRESSURE, 3, 850e2))
    assert "level 3: the pressure of 800 hPa is that of the level" in refusal(changed(PRESSURE, 3, 800e2))


def test_a_dewpoint_may_be_above_the_temperature_by_rounding_only():
    check_levels(PRESSURE, TEMPERATURE, changed(DEWPOINT, 2, 286.0 + ROUNDING), place)
    said = refusal(dewpoint=changed(DEWPOINT, 2, 286.06))
    assert said.startswith("here, level 2: the dewpoint of 12.91 degC is above the temperature of 12.85 degC")


def test_a_gap_is_refused_in_the_lower_and_middle_troposphere_only():
    wide = np.array([1000e2, 900e2, 750e2, 500e2, 280e2, 20e2, 1e2])
    check_levels(wide, TEMPERATURE, DEWPOINT, place)
    said = refusal(changed(wide, 3, 750e2 - LARGEST_GAP - 1e2))
    assert said.startswith("here, level 3: below the pressure of 499 hPa there is a gap of 251 hPa")


def test_the_mandatory_levels_alone_are_an_ascent():
    check_levels(np.array([1000e2, 850e2, 700e2, 500e2, 400e2, 300e2, 200e2]), TEMPERATURE, DEWPOINT, place)


def test_the_widest_gap_of_a_single_level_is_none():
    assert widest_gap(np.array([1000e2])) == (0.0, 0)


def test_a_wrong_unit_is_told_by_what_would_be_right():
    cases = [
        ("temperature", [25.0, 10.0], "K", "degC"),
        ("temperature", [298.0, 283.0], "degC", "K"),
        ("temperature", [95.0, 50.0], "degC", "degF"),
        ("dewpoint", [17.0, 5.0], "K", "degC"),
        ("pressure", [1000.0, 900.0], "Pa", "hPa"),
        ("pressure", [101325.0, 9e4], "hPa", "Pa"),
        ("pressure", [29.9, 27.0], "hPa", "inHg"),
        ("pressure", [101.3, 90.0], "hPa", "kPa"),
    ]
    for quantity, values, unit, looks in cases:
        with pytest.raises(SoundingError, match=f'looks like {looks}: name its unit, as in "{quantity} .{looks}."'):
            check_plausible(quantity, np.array(values), unit, place)
        check_plausible(quantity, np.array(values), looks, place)


def test_a_value_that_no_unit_makes_plausible_is_refused_with_the_limits():
    with pytest.raises(SoundingError, match=r"level 1: a pressure of -5 hPa does not .* \(0.001 to 1100 hPa\)"):
        check_plausible("pressure", np.array([1000.0, -5.0]), "hPa", place)
    with pytest.raises(
        SoundingError, match=r"level 0: a pressure of 300 hPa at the ground does not .* \(450 to 1100 hPa\)"
    ):
        check_plausible("pressure", np.array([300.0, 200.0]), "hPa", place)


def test_missing_values_are_no_reason_for_refusal():
    check_plausible("pressure", np.array([np.nan, 1000.0, np.nan]), "hPa", place)


def test_values_are_converted_and_missing_ones_stay_missing():
    np.testing.assert_allclose(in_si(np.array([32.0, np.nan]), known_unit("degF")), [273.15, np.nan])

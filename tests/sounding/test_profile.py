import pickle

import numpy as np
import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import Sounding

PRESSURE = [1000e2, 850e2, 700e2, 500e2, 300e2]
TEMPERATURE = [298.0, 290.0, 280.0, 263.0, 233.0]
DEWPOINT = [290.0, 284.0, 270.0, 250.0, 210.0]


def test_the_levels_are_kept_as_arrays_that_cannot_be_written_to():
    pressure = np.array(PRESSURE)
    sounding = Sounding(pressure, TEMPERATURE, DEWPOINT)
    pressure[0] = 0.0
    assert list(sounding.pressure) == PRESSURE
    assert sounding.temperature.dtype == np.float64
    with pytest.raises(ValueError, match="read-only"):
        sounding.dewpoint[0] = 0.0


def test_a_dewpoint_above_the_temperature_by_rounding_becomes_the_temperature():
    assert Sounding(PRESSURE, TEMPERATURE, [298.04, *DEWPOINT[1:]]).dewpoint[0] == 298.0


def test_a_sounding_shows_itself_in_a_line_and_knows_its_length():
    sounding = Sounding(PRESSURE, TEMPERATURE, DEWPOINT, name="Oslo")
    assert repr(sounding) == "<Sounding Oslo: 5 levels from 1000 hPa, 24.85 degC to 300 hPa, -40.15 degC>"
    assert len(sounding) == 5


def test_a_sounding_survives_the_way_to_another_process():
    twin = pickle.loads(pickle.dumps(Sounding(PRESSURE, TEMPERATURE, DEWPOINT, name="Oslo", source="here")))
    assert list(twin.dewpoint) == DEWPOINT
    assert (twin.name, twin.source) == ("Oslo", "here")


def test_what_is_no_ascent_is_refused():
    cases = [
        ((PRESSURE, TEMPERATURE[:4], DEWPOINT), "Oslo: there are 4 values of temperature, but 5 of pressure"),
        ((PRESSURE, TEMPERATURE, "moist"), "Oslo: the dewpoint is not a row of numbers"),
        ((PRESSURE, [TEMPERATURE], DEWPOINT), "Oslo: the temperature is not a row of numbers"),
        (([], [], []), "Oslo: the pressure is not a row of numbers"),
        ((PRESSURE, [np.nan, *TEMPERATURE[1:]], DEWPOINT), "Oslo, level 1: the temperature nan is not finite"),
        ((PRESSURE, TEMPERATURE, [*DEWPOINT[:4], -np.inf]), "Oslo, level 5: the dewpoint -inf is not finite"),
        ((PRESSURE, [25.0] * 5, DEWPOINT), "Oslo, level 1: a temperature of 25 K does not .* looks like degC"),
        ((PRESSURE[::-1], TEMPERATURE, DEWPOINT), "Oslo, level 2: the pressure of 500 hPa is not below"),
        ((PRESSURE, DEWPOINT, TEMPERATURE), "Oslo, level 1: the dewpoint of 24.85 degC is above the temperature"),
    ]
    for columns, sentence in cases:
        with pytest.raises(SoundingError, match=sentence):
            Sounding(*columns, name="Oslo")

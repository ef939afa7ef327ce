"""One setting: what it allows, how it is typed, what it makes of the words of a user."""

import pytest

from atmosbox.errors import SettingError, UnitError
from atmosbox.scene.parameter import Parameter

SWITCH = Parameter("rotation", "", True, None, None, None, "whether molecules rotate", "bool")
COUNT = Parameter("molecules", "1", 4000, 1, 10_000_000, None, "number of simulated molecules", "int")
HEIGHT = Parameter("height", "km", 2.0, 0.0, 12.0, None, "of the box", "float")
START = Parameter("start", "", "equilibrium", None, None, ("equilibrium", "bottom-heavy"), "the first frame", "str")


@pytest.mark.parametrize("word", ["on", "ON", "true", "True", "yes", " 1 ", 1, True])
def test_words_that_turn_a_switch_on(word):
    assert SWITCH.parse(word) is True


@pytest.mark.parametrize("word", ["off", "Off", "false", "no", "0", 0, False])
def test_words_that_turn_a_switch_off(word):
    assert SWITCH.parse(word) is False


@pytest.mark.parametrize("word", ["", "maybe", 2, 1.0, None, 10**400])
def test_other_words_do_not_turn_a_switch(word):
    with pytest.raises(SettingError, match=r"is neither on nor off: give --set rotation=on\.$"):
        SWITCH.parse(word)


def test_a_number_is_read_in_its_own_unit_and_kept_within_its_limits():
    assert HEIGHT.parse("500 m") == 0.5
    with pytest.raises(SettingError, match=r"0 km to 12 km: give --set height=2km\.$"):
        HEIGHT.parse("13 km")
    with pytest.raises(UnitError, match="is a pressure, but a length from 0 km to 12 km is wanted"):
        HEIGHT.parse("5 hPa")


def test_a_count_is_whole():
    assert COUNT.parse("4e3") == 4000
    assert type(COUNT.parse("4e3")) is int
    with pytest.raises(UnitError, match="is not whole"):
        COUNT.parse(4000.5)


def test_a_word_is_one_of_the_choices_however_it_is_spelled():
    assert START.parse("Bottom_Heavy") == "bottom-heavy"
    with pytest.raises(SettingError, match=r"give --set start=bottom-heavy\.$"):
        START.parse("botom-heavy")


@pytest.mark.parametrize(
    ("parameter", "words"),
    [
        (SWITCH, "on or off"),
        (COUNT, "1 to 10000000"),
        (HEIGHT, "0 km to 12 km"),
        (START, "equilibrium or bottom-heavy"),
    ],
)
def test_what_is_allowed_is_said_in_words(parameter, words):
    assert parameter.allowed == words


@pytest.mark.parametrize(("value", "words"), [(None, "on"), (True, "on"), (False, "off")])
def test_a_switch_is_typed_as_a_word(value, words):
    assert SWITCH.typed(value) == words


def test_a_word_with_a_blank_is_typed_in_quotes():
    assert START.typed("bottom heavy") == "'bottom heavy'"
    assert HEIGHT.typed() == "2km"

"""One setting: switches, words and names are understood however they are spelled, or refused with a fix."""

import pytest

from atmosbox.errors import Setting, SettingError, UnknownSettingError
from atmosbox.scene.settings import Parameter, by_name

SWITCH = Parameter("rotation", "", True, kind="bool")
START = Parameter("start", "", "equilibrium", choices=("equilibrium", "bottom-heavy"), kind="str")
COUNT = Parameter("molecules", "1", 4000, 1, kind="int")
HEIGHT = Parameter("box_height", "km", 2.0, 0.0, 12.0)
KNOWN = {parameter.name: parameter for parameter in (SWITCH, START, COUNT, HEIGHT)}


def test_a_switch_is_turned_by_words_and_by_numbers():
    for on, off in [("on", "off"), ("ON", "Off"), ("true", "False"), (" 1 ", "0"), (True, False)]:
        assert SWITCH.parse(on) is True
        assert SWITCH.parse(off) is False


def test_other_words_do_not_turn_a_switch():
    for word in ["", "maybe", 2, None, 10**400, [True]]:
        with pytest.raises(SettingError, match=r"is neither on nor off: give rotation=True\.$"):
            SWITCH.parse(word)


def test_a_word_is_one_of_the_choices_however_it_is_spelled():
    assert START.parse("Bottom_Heavy") == "bottom-heavy"
    with pytest.raises(SettingError, match=r"give start=\"bottom-heavy\"\.$"):
        START.parse("botom-heavy")
    with pytest.raises(SettingError, match="is not one of equilibrium, bottom-heavy"):
        START.parse(5)


def test_what_is_allowed_is_said_in_words():
    assert [p.allowed for p in KNOWN.values()] == [
        "on or off",
        "equilibrium or bottom-heavy",
        "at least 1",
        "0 km to 12 km",
    ]


def test_a_refusal_gives_the_nearest_value_that_is_allowed():
    for parameter, value, fix in [
        (HEIGHT, "13 km", "12km"),
        (HEIGHT, "-5", "0km"),
        (COUNT, 0, "1"),
        (Parameter("molecules", "1", 200, 1, 1_000_000, kind="int"), "1000000000", "1000000"),
        (HEIGHT, "1,5", "1.5km"),
        (HEIGHT, "1500,5 m", "1.5005km"),
        (HEIGHT, "1,500 m", "0.0015km"),
        (COUNT, "1,000", "1000"),
        (COUNT, "1,2,3", "123"),
        (HEIGHT, "13,5", "2km"),
    ]:
        with pytest.raises(SettingError, match=rf": give {parameter.name}=\"?{fix}\"?\.$"):
            parameter.parse(value)


def test_a_bare_temperature_that_can_only_be_in_kelvin_is_told_to_be_given_in_kelvin():
    warm = Parameter("temperature", "degC", 15.0, -80.0, 60.0)
    for value, kelvin in [("300", "300K"), (273.5, "273.5K"), ("300 degC", None), ("500", None)]:
        with pytest.raises(SettingError) as refused:
            warm.parse(value)
        told = [part.value for part in refused.value.remedy if isinstance(part, Setting)]
        assert told == ["60degC"] + [kelvin] * (kelvin is not None)
    assert str(refused.value).endswith('allowed, -80 degC to 60 degC: give temperature="60degC".')


def test_a_value_is_typed_as_the_shell_takes_it():
    assert [p.typed() for p in KNOWN.values()] == ["on", "equilibrium", "4000", "2km"]
    assert START.typed("bottom heavy") == "'bottom heavy'"


def test_a_name_may_be_spelled_with_a_dash():
    assert by_name({"box-height": 1, " rotation": 2}, KNOWN) == {"box_height": 1, "rotation": 2}
    with pytest.raises(SettingError, match="given twice"):
        by_name({"box-height": 1, "box_height": 2}, KNOWN)


def test_an_unknown_name_is_refused_with_the_nearest():
    for name, value, fix in [
        ("box_hight", "3 km", r"give box_height=\"3 km\"\.$"),
        ("Molecules", 5, r"give molecules=4000\.$"),
        ("zzz", 1, r"give one of rotation, start, molecules, box_height\.$"),
    ]:
        with pytest.raises(UnknownSettingError, match=fix):
            by_name({name: value}, KNOWN)

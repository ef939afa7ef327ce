"""Names and assignments as users spell them."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from atmosbox.errors import SettingError
from atmosbox.scene.spelling import assignments, nearest


def test_the_nearest_name_is_the_one_that_was_meant():
    cases = [
        ("temprature", "temperature"),
        ("Temperature", "temperature"),
        ("pressure-top", "pressure_top"),
        ("temp", "temperature"),
        ("molecule", "molecules"),
        ("pressure", "pressure_top"),
        ("x", None),
        ("", None),
        ("\0" * 10**5, None),
    ]
    for name, meant in cases:
        assert nearest(name, ["molecules", "temperature", "pressure_top", "seed"]) == meant


def test_an_assignment_is_a_name_and_a_value():
    assert assignments(["temperature=25degC", " pressure-top = 300 hPa ", "title='a = b'", 'start="bottom"']) == {
        "temperature": "25degC",
        "pressure_top": "300 hPa",
        "title": "a = b",
        "start": "bottom",
    }


def test_what_is_no_assignment_is_refused_with_its_text():
    cases = [
        (["temperature"], 'temperature has no "=" between name and value: give temperature="value".'),
        (["=5"], '=5 has no name: give name="value".'),
        (["a="], 'a= has no value: give a="value".'),
        (["a=''"], "a='' has no value: give a=\"value\"."),
        (["a-b=1", "a_b=2"], "a_b = 2 is given twice: give a_b once."),
    ]
    for items, sentence in cases:
        with pytest.raises(SettingError) as caught:
            assignments(items)
        assert str(caught.value) == sentence


@given(st.lists(st.text(max_size=20) | st.builds("{}={}".format, st.text(max_size=8), st.text(max_size=8)), max_size=3))
def test_any_text_is_an_assignment_or_refused_in_one_sentence(items):
    try:
        values = assignments(items)
    except SettingError as error:
        sentence = str(error)
        assert sentence.isprintable()
        assert sentence.endswith(".")
    else:
        assert len(values) == len(items)
        assert all(values.values())

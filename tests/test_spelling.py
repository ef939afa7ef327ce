"""The name that a user probably meant."""

import pytest

from atmosbox.scene.spelling import nearest


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("temprature", "temperature"),
        ("Temperature", "temperature"),
        ("pressure-top", "pressure_top"),
        ("temp", "temperature"),
        ("molecule", "molecules"),
        ("pressure", "pressure_top"),
        ("x", None),
        ("", None),
        ("\0" * 10**5, None),
    ],
)
def test_the_nearest_name_is_the_one_that_was_meant(name, meant):
    assert nearest(name, ["molecules", "temperature", "pressure_top", "seed"]) == meant

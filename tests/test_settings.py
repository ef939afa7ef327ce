"""Settings: a value that a user types is read as the intended number, or refused with what to type instead.

`REFUSED` is the table of refusals: a setting, a value, and what the sentence says.
"""

import copy
import json
import math
import pickle
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from atmosbox.errors import Setting, SettingError, UnknownSettingError
from atmosbox.scene.conversion import phrase, typed
from atmosbox.scene.settings import Parameter, SceneSettings, by_name, setting


class Settings(SceneSettings):
    molecules: int = setting(4000, "1", "number of simulated molecules", low=1, high=10_000_000)
    temperature: float = setting(15, "degC", "temperature at the start", low=-100.0, high=500.0)
    pressure_top: float = setting(300.0, "hPa", "pressure at which the lift ends", low=50.0, high=1000.0)
    lapse_rate: float = setting(6.5, "K/km", "of the environment", low=0.0)
    humidity: float = setting(70.0, "%", "relative humidity", low=0, high=100)
    duration: int = setting(5, "ns", "how long the run is")
    rotation: bool = setting(True, "", "whether molecules rotate")
    start: str = setting("equilibrium", "", "the first frame", choices=("equilibrium", "bottom-heavy"))
    title: str = setting("", "", "what stands above the figure")

    def check(self):
        if self.temperature > 400.0 and not self.rotation:
            raise SettingError("rotation", "off", "does not go with 400 degC", Setting("rotation", True))


KNOWN = {parameter.name: parameter for parameter in Settings.describe()}
HEIGHT = Parameter("height", "km", 2.0, 0.0, 12.0)
WARM = Parameter("temperature", "degC", 15.0, -80.0, 60.0)
UNITS = [
    "1", "%", "kg kg-1", "g kg-1", "K", "degC", "Pa", "hPa", "m", "km", "um", "nm", "s", "h", "ns", "ps", "m s-1",
    "km h-1", "m s-2", "m/s2", "K km-1", "K/km", "J", "kg", "g mol-1", "hPa/ns",
]  # fmt: skip
finite = st.floats(-1e300, 1e300)


def parse(value, unit):
    return Parameter("x", unit, 1.0).parse(value)


SPELLED = {
    ("degC", 25.0): [
        "25", "25.", "+25", "2.5e1", "25degC", "25 degC", "25C", "25 c", "25°C", "25 °C", "25º C", "25℃", "25 celsius",
        "25 deg C", "25 degrees Celsius", "25 degree_Celsius", "298.15 K", "298.15k", "298.15 kelvin", "77 degF", "77F",
        "77 fahrenheit", "536.67 rankine", " 25\tdegC ", "25\u00a0°C", 25, np.float32(25), np.int64(25), Fraction(25),
    ],
    ("hPa", 1013.25): [
        "1013.25", "1013.25hpa", "1013.25 mbar", "1013.25mb", "101325 Pa", "1.01325e5 pa", "101.325 kPa", "1 atm",
        "760 Torr", "101325 N/m2", "101325 J m^-3", "1_013.25 hPa",
    ],
    ("m s-2", 9.8): [
        "9.8", "9.8 m/s2", "9.8 m s-2", "9.8m/s^2", "9.8 m/s**2", "9.8 m s**-2", "9.8 m s⁻²", "9.8 m / s ^ 2",
        "9.8 m/s/s", "9.8 m·s-2", "9.8 m per s2", "9.8 N/kg", "0.0098 km/s2",
    ],
    ("K/km", 6.5): ["6.5 K/km", "6.5 K km-1", "6.5 degC/km", "6.5 °C per km", "0.0065 K/m", "11.7 degF/km"],
    ("nm", 32.0): ["0.032 µm", "320 Å"],
    ("m", 0.3048): ["1 ft"],
    ("1", 0.7): ["70 %", ".7"],
    ("%", 0.7): ["0.7"],
    ("g kg-1", 0.005): ["5 mg/kg"],
    ("degC", -40.0): ["-40 degF", "−40 °C"],
}  # fmt: skip


@pytest.mark.parametrize(("unit", "value"), SPELLED)
def test_every_usual_spelling_of_a_value_is_read(unit, value):
    for text in SPELLED[unit, value]:
        assert parse(text, unit) == pytest.approx(value, rel=1e-12, abs=0.0), text


def test_words_and_whole_numbers_are_read_however_they_are_spelled():
    for on, off in [("on", "off"), ("ON", "Off"), ("true", "False"), (" 1 ", "0"), (True, False)]:
        assert (KNOWN["rotation"].parse(on), KNOWN["rotation"].parse(off)) == (True, False)
    assert KNOWN["start"].parse("Bottom_Heavy") == "bottom-heavy"
    for value in ["4000", "4e3", "4E+3", 4000.0, "4_000", "400000%", np.int32(4000)]:
        assert type(found := KNOWN["molecules"].parse(value)) is int
        assert found == 4000
    assert by_name({"pressure-top": 1, " rotation": 2}, KNOWN) == {"pressure_top": 1, "rotation": 2}


@given(value=finite, unit=st.sampled_from(UNITS), whole=st.integers(-(2**63), 2**63))
def test_what_is_said_and_what_is_typed_is_read_again(value, unit, whole):
    rounded = float(f"{value:.12g}")
    assert parse(typed(value, unit), unit) == parse(phrase(value, unit), unit) == rounded
    assert " " not in typed(value, unit)
    assert parse(value, unit) == parse(repr(value), unit) == value
    count = Parameter("x", "1", 1, kind="int")
    assert count.parse(whole) == count.parse(str(whole)) == whole


NO_NUMBER = [True, [25], np.array([25.0]), "warm", "٢٥", "2" * 300]
NO_UNIT = ["25 deg", "25°", "25 blorp", "25 degC 300", "2*25 K", "10⁵ K", "5 dB", "5 rad", "5 delta_degC"]
NO_UNIT += ["5 __class__", "5 pm-99", "5 m**9**9**9", "5 m/m"]
REFUSED = [  # setting, value, what the sentence says
    ("temperature", -200, '-200 degC is below the allowed range, -100 degC to 500 degC: give temperature="-100degC".'),
    ("temperature", "2000 K", "2000 K is above the allowed range, -100 degC to 500 degC"),
    ("molecules", "2e7", "2e7 is above the allowed range, 1 to 10000000: give molecules=10000000."),
    ("seed", -1, "-1 is below the allowed range, 0 to 9223372036854775807: give seed=0."),
    ("molecules", "1,000", "give molecules=1000."),
    ("molecules", "1,2,3", "give molecules=123."),
    (HEIGHT, "1,5", 'give height="1.5km".'),
    (HEIGHT, "1,500 m", 'give height="0.0015km".'),
    (HEIGHT, "13,5", 'give height="2km".'),
    *(("molecules", value, "is not whole, but a whole number from 1 to 10000000") for value in ("4000.5", "1e-400")),
    (WARM, "300", 'give temperature="60degC"'),
    ("temperature", "5 m", "is a length, but a temperature from -100 degC to 500 degC is wanted"),
    ("pressure_top", "5 C", "is a temperature, but a pressure from 50 hPa to 1000 hPa"),
    ("lapse_rate", "5 K", "is a temperature, but a lapse rate"),
    ("temperature", "5 degC/km", "is a lapse rate, but a temperature"),
    ("molecules", "5 K", "is a temperature, but a whole number"),
    ("humidity", "5 g/kg", "is a mixing ratio, but a percentage"),
    (HEIGHT, "5 V", "is a quantity of another kind, but a length"),
    (HEIGHT, "5 %", "is a pure number, but a length"),
    ("temperature", "", "is empty"),
    *(("temperature", value, "is not finite") for value in (math.nan, "-Infinity", "inf degC")),
    *(("temperature", value, "is too large") for value in (10**400, "1e400 K", "1e99999999999999999999")),
    (Parameter("x", "nm", 1.0), "1e308 km", "is too large"),
    *(("temperature", value, "is not a number") for value in NO_NUMBER),
    ("temperature", "25,5", "is written with a comma"),
    *(("temperature", value, "has an unknown unit") for value in NO_UNIT),
    *(("rotation", value, "is neither on nor off: give rotation=True.") for value in ("", "maybe", 2, None, 10**400)),
    ("start", "botom-heavy", 'give start="bottom-heavy".'),
    ("start", 5, "is not one of equilibrium, bottom-heavy"),
    ("title", 5, "is not a text"),
]


@pytest.mark.parametrize(("parameter", "value", "said"), REFUSED, ids=lambda part: f"{part}"[:30])
def test_what_is_no_value_is_refused_with_the_range_and_a_value_that_is_allowed(parameter, value, said):
    parameter = KNOWN.get(parameter, parameter) if isinstance(parameter, str) else parameter
    with pytest.raises(SettingError) as refused:
        parameter.parse(value)
    sentence = str(refused.value)
    assert said in sentence
    assert sentence.startswith(parameter.name)
    assert sentence.isprintable()
    assert sentence.endswith(".")
    for part in refused.value.remedy:
        if isinstance(part, Setting) and part.value is not None:
            parameter.parse(part.value)


def test_a_bare_temperature_that_can_only_be_in_kelvin_is_told_to_be_given_in_kelvin():
    for value, kelvin in [("300", ["300K"]), (273.5, ["273.5K"]), ("300 degC", []), ("500", [])]:
        with pytest.raises(SettingError) as refused:
            WARM.parse(value)
        assert [part.value for part in refused.value.remedy if isinstance(part, Setting)] == ["60degC", *kelvin]


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
            assert -1e5 <= parameter.parse(text) <= 1e5
        except SettingError as error:
            sentence = str(error)
            assert sentence.isprintable()
            assert sentence.startswith("x = ")
            assert sentence.endswith(".")


# The settings of a scene


def test_what_a_user_sets_is_kept_in_the_documented_unit_and_is_there_in_si():
    asked = {"molecules": "4e3", "temperature": "298.15 K", "pressure-top": "50 kPa", "lapse_rate": "9.8 degC/km"}
    asked |= {"humidity": 0.5, "duration": "0.007 us", "rotation": "off", "start": "Bottom_Heavy", "title": " Lift "}
    found = Settings.from_user(asked | {"seed": str(2**63 - 1)})
    changed = {"temperature": 25.0, "pressure_top": 500.0, "lapse_rate": 9.8, "humidity": 0.5, "duration": 7}
    changed |= {"rotation": False, "start": "bottom-heavy", "title": "Lift", "seed": 2**63 - 1}
    assert found.changed() == changed
    si = {
        "molecules": 4000,
        "temperature": pytest.approx(298.15),
        "pressure_top": 50000.0,
        "lapse_rate": pytest.approx(0.0098),
    }
    si |= {"humidity": pytest.approx(0.005), "duration": pytest.approx(7e-9)}
    assert {name: vars(found.si)[name] for name in si} == si
    for twin in (pickle.loads(pickle.dumps(found)), copy.deepcopy(found), Settings(**json.loads(json.dumps(changed)))):
        assert (twin, hash(twin)) == (found, hash(found))
    with pytest.raises(AttributeError, match="cannot be changed"):
        found.temperature = 20.0


def test_there_is_no_way_round_the_checks():
    for make in (lambda asked: Settings(**asked), Settings.from_user, lambda asked: Settings.with_defaults(**asked)()):
        assert make({"temperature": "77 degF"}).si.temperature == 298.15
        for wrong, said in [
            ({"temperature": "5 m"}, "temperature = 5 m is a length"),
            (
                {"temprature": "25 degC"},
                'temprature = 25 degC is not a setting of this scene: give temperature="25 degC"',
            ),
            ({"temperature": 450.0, "rotation": False}, "rotation = off does not go with 400 degC"),
        ]:
            with pytest.raises(SettingError, match=said):
                make(wrong)


def test_an_unknown_name_is_refused_with_the_nearest_that_the_value_can_be_given_to():
    for name, value, fix in [
        ("pressure_tpo", "3 hPa", 'give pressure_top="3 hPa".'),
        ("Molecules", 5, "give molecules=4000."),
        ("zzz", 1, "give one of molecules, temperature"),
        ("rotatoin", "off", 'give rotation="off".'),
        ("duratoin", "9000 ns", "give duration="),
    ]:
        with pytest.raises(UnknownSettingError) as refused:
            Settings.from_user({name: value})
        assert fix in str(refused.value)
    with pytest.raises(SettingError, match="given twice"):
        by_name({"pressure-top": 1, "pressure_top": 2}, KNOWN)


@pytest.mark.parametrize(
    ("kind", "declared", "said"),
    [
        (float, 15.0, "must be declared with setting"),
        (list[float], setting(15.0, "degC", "t"), "must be an int, a float, a bool or a str"),
        (bool, setting(True, "1", "t"), "must have a unit if it is a number"),
        (float, setting(15.0, "blorp", "t"), "The setting t of .*Wrong "),
        (float, setting(600.0, "degC", "t", high=500.0), "The setting t of .*Wrong "),
    ],
)
def test_a_setting_that_is_declared_wrongly_is_refused_where_it_is_written(kind, declared, said):
    with pytest.raises(TypeError, match=said):
        type("Wrong", (SceneSettings,), {"__annotations__": {"t": kind}, "t": declared})

import copy
import importlib.util
import json
import math
import pickle
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from pydantic import Field, ValidationError

from atmosbox.errors import ConfigError, FileError, SettingError, UnitError, UnknownSettingError
from atmosbox.settings import (
    Headline,
    Parameter,
    SceneSettings,
    load_config,
    nearest,
    parse_set,
    setting,
)


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
            raise SettingError("rotation", "off", "does not go with 400 degC", "give --set rotation=on")


def refusal(error=SettingError, **values):
    with pytest.raises(error) as caught:
        Settings.from_user(values)
    assert type(caught.value) is error
    sentence = str(caught.value)
    assert sentence.isprintable()
    assert sentence.endswith(".")
    return sentence


# A scene's settings


def test_without_a_user_every_setting_has_its_default():
    settings = Settings.from_user({})
    assert settings == Settings()
    assert settings.molecules == 4000
    assert settings.temperature == 15.0
    assert type(settings.temperature) is float
    assert settings.seed == 1
    assert settings.changed() == {}


def test_what_a_user_sets_is_kept_in_the_documented_unit():
    settings = Settings.from_user(
        {
            "molecules": "4e3",
            "temperature": "298.15 K",
            "pressure-top": "50 kPa",
            "lapse_rate": "9.8 degC/km",
            "humidity": 0.5,
            "duration": "0.007 us",
            "rotation": "off",
            "start": "Bottom_Heavy",
            "title": " Lifting ",
            "seed": str(2**63 - 1),
        }
    )
    assert settings.changed() == {
        "temperature": 25.0,
        "pressure_top": 500.0,
        "lapse_rate": 9.8,
        "humidity": 0.5,
        "duration": 7,
        "rotation": False,
        "start": "bottom-heavy",
        "title": "Lifting",
        "seed": 2**63 - 1,
    }


def test_the_same_names_are_there_in_si_units():
    si = Settings().si
    assert vars(si) == {
        "molecules": 4000,
        "temperature": pytest.approx(288.15, abs=1e-12),
        "pressure_top": 30000.0,
        "lapse_rate": 0.0065,
        "humidity": 0.7,
        "duration": 5e-9,
        "rotation": True,
        "start": "equilibrium",
        "title": "",
        "seed": 1,
    }
    assert type(si.molecules) is int


def test_settings_go_to_json_and_back():
    settings = Settings(temperature="77 degF", seed=2**63 - 1, rotation="no")
    assert Settings.from_user(json.loads(json.dumps(settings.as_dict()))) == settings


def test_settings_survive_the_way_to_another_process():
    settings = Settings(temperature=25.0)
    assert pickle.loads(pickle.dumps(settings)) == settings
    assert copy.deepcopy(settings) == settings
    assert hash(settings) == hash(Settings(temperature=25.0))


def test_settings_cannot_be_changed():
    with pytest.raises(ValidationError):
        Settings().temperature = 20.0


def test_making_settings_checks_them_as_from_user_does():
    with pytest.raises(SettingError, match="is above the highest allowed"):
        Settings(temperature=1e4)


@pytest.mark.parametrize("word", ["on", "ON", "true", "True", "yes", " 1 ", 1, True])
def test_words_that_turn_a_switch_on(word):
    assert Settings(rotation=word).rotation is True


@pytest.mark.parametrize("word", ["off", "Off", "false", "no", "0", 0, False])
def test_words_that_turn_a_switch_off(word):
    assert Settings(rotation=word).rotation is False


@pytest.mark.parametrize("word", ["", "maybe", 2, 1.0, None, 10**400])
def test_other_words_do_not_turn_a_switch(word):
    assert refusal(rotation=word).endswith("is neither on nor off: give --set rotation=on.")


def test_a_value_out_of_range_is_refused_with_range_and_fix():
    assert refusal(temperature=-200) == (
        "temperature = -200 degC is below the lowest allowed, -100 degC to 500 degC: "
        "give --set temperature=15degC."
    )
    assert refusal(molecules="2e7") == (
        "molecules = 2e7 is above the highest allowed, 1 to 10000000: give --set molecules=4000."
    )
    assert refusal(seed=-1) == (
        "seed = -1 is below the lowest allowed, 0 to 9223372036854775807: give --set seed=1."
    )


def test_a_wrong_dimension_is_refused_with_the_right_one_and_a_fix():
    assert refusal(UnitError, temperature="5 m") == (
        "temperature = 5 m is a length, but a temperature from -100 degC to 500 degC is wanted: "
        "give --set temperature=15degC."
    )
    assert refusal(UnitError, molecules="4000 K") == (
        "molecules = 4000 K is a temperature, but a whole number from 1 to 10000000 is wanted: "
        "give --set molecules=4000."
    )


@pytest.mark.parametrize("name", ["molecules", "temperature", "pressure_top", "lapse_rate", "seed"])
@pytest.mark.parametrize("value", ["", "nan", math.nan, math.inf, "-inf", 10**400, "warm", None, True, [1]])
def test_no_number_is_made_of_what_is_none(name, value):
    assert f"give --set {name}=" in refusal(UnitError, **{name: value})


def test_a_choice_is_refused_with_the_choices_and_the_nearest():
    assert refusal(start="botom-heavy") == (
        "start = botom-heavy is not one of equilibrium, bottom-heavy: give --set start=bottom-heavy."
    )
    assert refusal(start="").endswith("give --set start=equilibrium.")
    assert refusal(start=5).startswith("start = 5 is not one of")


def test_a_text_must_be_a_text_and_not_empty_unless_its_default_is():
    class Named(SceneSettings):
        title: str = setting("a run", "", "what stands above the figure")

    with pytest.raises(SettingError, match=r'^title = " " is empty: give --set title=\'a run\'\.$'):
        Named(title=" ")
    assert Settings(title=" ").title == ""
    assert refusal(title=5).startswith("title = 5 is not a text")


def test_an_unknown_setting_is_refused_with_the_nearest():
    assert refusal(UnknownSettingError, temprature="25 degC") == (
        "temprature = 25 degC is not a setting of this scene: give --set temperature='25 degC'."
    )
    assert refusal(UnknownSettingError, Temperature=25).endswith("give --set temperature=15degC.")
    assert refusal(UnknownSettingError, zzz=1) == (
        "zzz = 1 is not a setting of this scene: give one of molecules, temperature, pressure_top, "
        "lapse_rate, humidity, duration, rotation, start, title, seed."
    )


def test_a_setting_given_twice_is_refused():
    assert refusal(**{"pressure-top": 200, "pressure_top": 300}) == (
        "pressure_top = 300 is given twice: give --set pressure_top once."
    )


def test_settings_that_do_not_fit_together_are_refused_by_the_scene():
    assert Settings(temperature=450.0).rotation
    assert refusal(temperature=450.0, rotation=False).startswith("rotation = off does not go with 400 degC")


# What a scene declares


def test_a_scene_describes_its_own_settings_and_then_the_seed():
    described = Settings.describe()
    assert [p.name for p in described] == [
        "molecules", "temperature", "pressure_top", "lapse_rate", "humidity", "duration", "rotation", "start",
        "title", "seed",
    ]  # fmt: skip
    assert described[1] == Parameter(
        "temperature", "degC", 15.0, -100.0, 500.0, None, "temperature at the start", "float"
    )
    assert {p.name: p.kind for p in described if p.kind != "float"} == {
        "molecules": "int",
        "duration": "int",
        "rotation": "bool",
        "start": "str",
        "title": "str",
        "seed": "int",
    }


def test_what_is_allowed_is_said_in_words():
    assert {p.name: p.allowed for p in Settings.describe()} == {
        "molecules": "1 to 10000000",
        "temperature": "-100 degC to 500 degC",
        "pressure_top": "50 hPa to 1000 hPa",
        "lapse_rate": "at least 0 K/km",
        "humidity": "0 % to 100 %",
        "duration": "any whole number (ns)",
        "rotation": "on or off",
        "start": "equilibrium or bottom-heavy",
        "title": "any text",
        "seed": "0 to 9223372036854775807",
    }


@pytest.mark.parametrize("parameter", Settings.describe(), ids=lambda parameter: parameter.name)
def test_the_default_as_it_is_typed_is_read_again(parameter):
    typed = parameter.typed()
    assert " " not in typed
    assert parameter.parse(typed.strip("'")) == parameter.default


def test_every_setting_is_in_the_json_schema():
    properties = Settings.model_json_schema()["properties"]
    assert properties["temperature"]["minimum"] == -100.0
    assert properties["temperature"]["unit"] == "degC"
    assert properties["start"]["enum"] == ["equilibrium", "bottom-heavy"]
    assert properties["seed"]["description"] == "seed of the random numbers"


def test_a_field_that_is_not_declared_as_a_setting_is_the_authors_mistake():
    with pytest.raises(TypeError, match="must be declared with setting"):

        class Bare(SceneSettings):
            temperature: float = 15.0

    with pytest.raises(TypeError, match="must be declared with setting"):

        class Plain(SceneSettings):
            temperature: float = Field(15.0, description="temperature")


def test_a_setting_of_another_type_is_the_authors_mistake():
    with pytest.raises(TypeError, match="must be an int, a float, a bool or a str"):

        class Listed(SceneSettings):
            temperatures: list[float] = setting(15.0, "degC", "temperatures")


@pytest.mark.parametrize(
    ("default", "unit"), [(15.0, ""), (15.0, "blorp"), (15.0, "m/s+"), (600.0, "degC"), ("x", "K")]
)
def test_a_default_that_is_not_allowed_is_the_authors_mistake(default, unit):
    with pytest.raises(TypeError, match=r"The setting temperature of .*Wrong "):

        class Wrong(SceneSettings):
            temperature: float = setting(default, unit, "temperature", high=500.0)


def test_a_unit_on_a_switch_is_the_authors_mistake():
    with pytest.raises(TypeError, match="must have a unit if it is a number"):

        class Wrong(SceneSettings):
            rotation: bool = setting(True, "1", "whether molecules rotate")


def test_a_scene_that_is_run_by_its_path_may_postpone_annotations(tmp_path):
    path = tmp_path / "my_scene.py"
    path.write_text(
        "from __future__ import annotations\n"
        "from atmosbox.settings import SceneSettings, setting\n"
        "class Settings(SceneSettings):\n"
        "    temperature: float = setting(15.0, 'degC', 'temperature', low=-100.0, high=500.0)\n"
    )
    spec = importlib.util.spec_from_file_location("my_scene", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.Settings(temperature="300 K").temperature == 26.85


def test_importing_the_settings_imports_nothing_heavy():
    script = (
        "import sys, atmosbox.settings\n"
        "assert not {'pint', 'numpy', 'scipy', 'numba', 'xarray', 'metpy'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", script], cwd=Path(__file__).parents[1], check=True, timeout=60)


# Names


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


# --set


def test_set_reads_name_and_value():
    assert parse_set(
        ["temperature=25degC", " pressure-top = 300 hPa ", "title='a = b'", 'start="bottom"']
    ) == {
        "temperature": "25degC",
        "pressure_top": "300 hPa",
        "title": "a = b",
        "start": "bottom",
    }
    assert parse_set([]) == {}


@pytest.mark.parametrize(
    ("items", "sentence"),
    [
        (
            ["temperature"],
            '--set temperature has no "=" between name and value: '
            "give --set temperature=value, such as --set temperature=25degC.",
        ),
        (["=5"], "--set =5 has no name: give --set name=value, such as --set temperature=25degC."),
        (["a="], "--set a= has no value: give --set a=value, such as --set temperature=25degC."),
        (["a=''"], "--set a='' has no value: give --set a=value, such as --set temperature=25degC."),
        (["a-b=1", "a_b=2"], "a_b = 2 is given twice: give --set a_b once."),
    ],
)
def test_a_malformed_set_is_refused_with_its_text(items, sentence):
    with pytest.raises(SettingError) as caught:
        parse_set(items)
    assert str(caught.value) == sentence


@given(
    st.lists(
        st.text(max_size=20) | st.builds("{}={}".format, st.text(max_size=8), st.text(max_size=8)), max_size=3
    )
)
def test_any_set_is_read_or_refused_in_one_sentence(items):
    try:
        values = parse_set(items)
        Settings.from_user(values)
    except SettingError as error:
        sentence = str(error)
        assert sentence.isprintable()
        assert sentence.endswith(".")


numbers = st.booleans() | st.integers() | st.floats()
others = st.none() | st.text() | st.binary() | st.lists(st.integers()) | st.dates()


@given(st.dictionaries(st.sampled_from(list(Settings.model_fields)), numbers | others, max_size=3))
def test_any_values_make_settings_or_are_refused_in_one_sentence(values):
    try:
        settings = Settings.from_user(values)
    except SettingError as error:
        sentence = str(error)
        assert sentence.isprintable()
        assert sentence.endswith(".")
    else:
        assert Settings.from_user(settings.as_dict()) == settings


# --config


def written(tmp_path, content):
    path = tmp_path / "lift.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def test_a_settings_file_names_a_scene_and_its_settings(tmp_path):
    path = written(
        tmp_path,
        'scene = "lifting-dry"\r\n\r\n[settings]\r\ntemperature = "25degC" # warm\r\nmolecules = 4_000\r\n'
        "pressure-top = 300.0\r\nrotation = false\r\n",
    )
    scene, settings = load_config(path)
    assert scene == "lifting-dry"
    assert settings == {"temperature": "25degC", "molecules": 4000, "pressure-top": 300.0, "rotation": False}
    assert Settings.from_user(settings).changed() == {"temperature": 25.0, "rotation": False}
    assert load_config(str(path)) == (scene, settings)


@pytest.mark.parametrize(
    ("content", "result"),
    [
        ("", (None, {})),
        ('\ufeffscene = " sky "', ("sky", {})),
        ("[settings]", (None, {})),
        ("settings.seed = 5", (None, {"seed": 5})),
    ],
)
def test_a_settings_file_may_leave_things_out(tmp_path, content, result):
    assert load_config(written(tmp_path, content)) == result


@pytest.mark.parametrize(
    ("content", "problem", "fix"),
    [
        ("[settings]\nt = 25degC", ", line 2 is not TOML (", 'such as temperature = "25degC"'),
        ("[settings]\nt = 1\nt = 2", ", line 3 is not TOML (", "write one name = value a line"),
        ("a = " + "[" * 5000, " is not TOML: ", "write one name = value a line"),
        ("a = " + "9" * 5000, " is not TOML: ", "write one name = value a line"),
        (b"a = 1\n# caf\xe9", ", line 2 is not UTF-8 text", "save the file as UTF-8"),
        ("scene = 1".encode("utf-16"), " is not a settings file", "saved as UTF-8"),
        (b"#" * 1_000_001, " is not a settings file", "at most 1 MB"),
        (b"\x89HDF\r\n\x1a\n", " is a netCDF file", "give it with --from"),
        ("\ntemperature = 25\n", ", line 2 has temperature outside the table [settings]", "below a line"),
        ("[setings]\nseed = 1", ", line 1 has setings outside the table [settings]", "name it settings"),
        ("[plot]\nsize = 1", ", line 1 has plot outside", "below a line [settings]"),
        ("scene = 5", ", line 1 has scene without a name", 'such as scene = "lifting-dry"'),
        ("scene = ''", ", line 1 has scene without a name", 'such as scene = "lifting-dry"'),
        ("settings = 5", ", line 1 has settings that is no table", "write a line [settings]"),
        ("[[settings]]", ", line 1 has settings that is no table", "write a line [settings]"),
        ("[settings]\n\na = [1]", ", line 3 has a as an array", "give one number"),
        ("[settings]\n'a b' = {c = 1}", ", line 2 has a b as a table", "give one number"),
        ("[settings.a]\nb = 1", ", line 1 has a as a table", "give one number"),
        ("[settings]\na = 2020-01-01", ", line 2 has a as a date or a time", "give one number"),
        ("[settings]\na = 07:32:00", ", line 2 has a as a date or a time", "give one number"),
        ("[settings]\na = nan", ", line 2 has a as no finite number", "give one number"),
        ("[settings]\na = -inf", ", line 2 has a as no finite number", "give one number"),
    ],
)  # fmt: skip
def test_a_settings_file_that_says_something_else_is_refused_with_its_line(tmp_path, content, problem, fix):
    path = written(tmp_path, content)
    with pytest.raises(ConfigError) as caught:
        load_config(path)
    sentence = str(caught.value)
    assert "lift.toml" in sentence
    assert problem in sentence
    assert fix in sentence
    assert sentence.isprintable()
    assert sentence.endswith(".")


@pytest.mark.parametrize(
    ("path", "reason"),
    [("missing.toml", "No such file"), (".", "directory|denied"), ("a\0b", "not a path"), ("", "No such")],
)
def test_a_file_that_cannot_be_read_is_refused_with_its_path(tmp_path, monkeypatch, path, reason):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(
        FileError, match=rf"cannot be read \(.*({reason}).*\): give the path of a settings file\.$"
    ):
        load_config(path)


toml = st.lists(
    st.sampled_from(
        ["scene", "settings", "[settings]", "[", "]", "\n", " = ", "=", ".", '"', "'", "'''", "a",
         "temperature", "25", "degC", "{", "}", ",", "nan", "1e5", "2020-01-01", "true", "#", "\\", "\\u",
         "é", "\r", "[[", "]]", "\ufeff"]
    )
).map(lambda parts: "".join(parts).encode())  # fmt: skip


@pytest.fixture(scope="module")
def any_file(tmp_path_factory):
    return tmp_path_factory.mktemp("any") / "any.toml"


@given(
    content=st.binary(max_size=60)
    | st.text(max_size=60).map(lambda text: text.encode("utf-8", "surrogatepass"))
    | toml
)
@example(content=b"\xef\xbb\xbf\xef\xbb\xbf")
def test_any_file_is_read_or_refused_in_one_sentence(any_file, content):
    any_file.write_bytes(content)
    try:
        scene, settings = load_config(any_file)
    except (ConfigError, FileError) as error:
        sentence = str(error)
        assert sentence.isprintable()
        assert sentence.endswith(".")
    else:
        assert scene is None or scene.strip()
        assert all(isinstance(value, bool | int | float | str) for value in settings.values())


# Headlines


def headline(value=10.0, standard_error=1.0, theory=12.0, tolerance=0.0):
    return Headline("z", value, standard_error, theory, tolerance, "why", "K", "degC", "temperature")


@pytest.mark.parametrize(
    ("numbers", "misfit", "agrees"),
    [
        ({}, -2.0, True),
        ({"theory": 14.0}, -4.0, True),
        ({"theory": 14.5}, -4.5, False),
        ({"theory": 14.5, "tolerance": 0.5}, -4.5, True),
        ({"theory": 5.5}, 4.5, False),
        ({"theory": 10.0, "standard_error": 0.0}, 0.0, True),
        ({"theory": None}, None, None),
        ({"theory": None, "value": math.nan}, None, None),
        ({"theory": 10.0, "standard_error": math.nan}, 0.0, False),
        ({"theory": 10.0, "standard_error": math.inf}, 0.0, False),
        ({"value": math.inf}, math.inf, False),
    ],
)
def test_a_headline_agrees_within_four_standard_errors_and_its_tolerance(numbers, misfit, agrees):
    assert headline(**numbers).misfit == misfit
    assert headline(**numbers).agrees is agrees


@pytest.mark.parametrize("numbers", [{"value": math.nan}, {"theory": math.nan}])
def test_a_headline_that_is_not_a_number_agrees_with_nothing(numbers):
    assert headline(**numbers).agrees is False

import copy
import importlib.util
import json
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from atmosbox.errors import Setting, SettingError, UnknownSettingError
from atmosbox.scene.settings import Parameter, SceneSettings, setting


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
    with pytest.raises(AttributeError, match="cannot be changed"):
        Settings().temperature = 20.0


def test_there_is_no_way_round_the_checks():
    cases = [
        lambda values: Settings(**values),
        Settings.from_user,
        lambda values: Settings.with_defaults(**values)(),
    ]
    for make in cases:
        assert make({"temperature": "77 degF"}).si.temperature == 298.15
        with pytest.raises(SettingError, match="temperature = 5 m is a length"):
            make({"temperature": "5 m"})


def test_a_value_out_of_range_is_refused_with_range_and_fix():
    assert refusal(temperature=-200) == (
        'temperature = -200 degC is below the lowest allowed, -100 degC to 500 degC: give temperature="-100degC".'
    )
    assert refusal(molecules="2e7") == (
        "molecules = 2e7 is above the highest allowed, 1 to 10000000: give molecules=10000000."
    )
    assert refusal(seed=-1) == ("seed = -1 is below the lowest allowed, 0 to 9223372036854775807: give seed=0.")


def test_a_text_must_be_a_text_and_not_empty_unless_its_default_is():
    class Named(SceneSettings):
        title: str = setting("a run", "", "what stands above the figure")

    with pytest.raises(SettingError, match=r'^title = " " is empty: give title="a run"\.$'):
        Named(title=" ")
    assert Settings(title=" ").title == ""
    assert refusal(title=5).startswith("title = 5 is not a text")


def test_an_unknown_setting_is_refused_with_the_nearest():
    assert refusal(UnknownSettingError, temprature="25 degC") == (
        'temprature = 25 degC is not a setting of this scene: give temperature="25 degC".'
    )
    with pytest.raises(UnknownSettingError, match="give temperature="):
        Settings.with_defaults(temprature=20.0)


def test_the_nearest_is_one_that_the_value_can_be_given_to():
    assert "rotation=" not in refusal(UnknownSettingError, rotatoin="2 ns")
    assert 'give rotation="off"' in refusal(UnknownSettingError, rotatoin="off")
    assert "give duration=" in refusal(UnknownSettingError, duratoin="9000 ns")


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


def test_the_default_as_it_is_typed_is_read_again():
    for parameter in Settings.describe():
        typed = parameter.typed()
        assert " " not in typed
        assert parameter.parse(typed.strip("'")) == parameter.default


def test_a_field_that_is_not_declared_as_a_setting_is_the_authors_mistake():
    with pytest.raises(TypeError, match="must be declared with setting"):

        class Bare(SceneSettings):
            temperature: float = 15.0


def test_a_setting_of_another_type_is_the_authors_mistake():
    with pytest.raises(TypeError, match="must be an int, a float, a bool or a str"):

        class Listed(SceneSettings):
            temperatures: list[float] = setting(15.0, "degC", "temperatures")


def test_a_default_that_is_not_allowed_is_the_authors_mistake():
    for default, unit in [(15.0, ""), (15.0, "blorp"), (15.0, "m/s+"), (600.0, "degC"), ("x", "K")]:
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
        "from atmosbox.scene.settings import SceneSettings, setting\n"
        "class Settings(SceneSettings):\n"
        "    temperature: float = setting(15.0, 'degC', 'temperature', low=-100.0, high=500.0)\n"
    )
    spec = importlib.util.spec_from_file_location("my_scene", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.Settings(temperature="300 K").temperature == 26.85


# Any input

numbers = st.booleans() | st.integers() | st.floats()
others = st.none() | st.text() | st.binary() | st.lists(st.integers()) | st.dates()


@given(
    st.dictionaries(
        st.sampled_from([parameter.name for parameter in Settings.describe()]), numbers | others, max_size=3
    )
)
def test_any_values_make_settings_or_are_refused_in_one_sentence(values):
    try:
        settings = Settings.from_user(values)
    except SettingError as error:
        sentence = str(error)
        assert sentence.isprintable()
        assert sentence.endswith(".")
    else:
        assert Settings.from_user(settings.as_dict()) == settings

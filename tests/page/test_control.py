"""The controls of a page, and what a scene offers a class beside them."""

import pytest

from atmosbox import scenarios
from atmosbox.errors import ConfigError
from atmosbox.page.controls import knob_controls, setting_controls
from atmosbox.page.lesson import lesson_of
from atmosbox.scene.knob import Knob
from atmosbox.scene.settings import SceneSettings, setting
from atmosbox.simulation.preparation import build, prepare


class Settings(SceneSettings):
    """Settings of every kind."""

    warmth: float = setting(25.0, "degC", "warmth of the walls", low=-270.0, high=2000.0)
    molecules: int = setting(200, "1", "number of molecules", low=1, high=1_000_000)
    free: float = setting(1.0, "m", "without limits")
    spin: bool = setting(True, "", "whether they spin")
    floor: str = setting("warm", "", "the floor", choices=("warm", "smooth"))
    file: str = setting("none", "", "a file of one's own")


def knob(**more):
    usual = {"name": "warmth", "help": "of the walls", "unit": "degC", "low": -200.0, "high": 500.0, "value": 25.0}
    return Knob(turn=lambda kelvin: None, **(usual | more))


def test_every_setting_has_a_control_and_a_knob_takes_the_place_of_its_own():
    made = knob_controls([knob()]) + setting_controls(Settings.describe(), Settings().as_dict(), ["warmth", "seed"])
    told = {control["name"]: control for control in made}
    assert list(told) == ["warmth", "molecules", "free", "spin", "floor"]
    assert [each["restarts"] for each in made] == [False, True, True, True, True]
    assert (told["warmth"]["low"], told["warmth"]["high"], told["warmth"]["unit"]) == (-200.0, 500.0, "degC")
    assert (told["molecules"]["high"], told["molecules"]["step"]) == (50_000, 1)
    assert told["free"]["low"] is None
    assert told["spin"]["kind"] == "switch"
    assert told["floor"]["choices"] == ["warm", "smooth"]


def test_every_preset_of_every_scene_builds_a_box_that_differs_from_the_scenes_own():
    seen = 0
    for name in scenarios.names():
        small = {"molecules": 200} if name != "elastic-collisions" else {"molecules": 20}
        for preset in lesson_of(scenarios.load(name)).presets:
            asked = prepare(name, {**small, **preset.values})
            build(asked)
            assert asked.settings.as_dict() != prepare(name, small).settings.as_dict(), preset
            seen += 1
    assert seen > 20


PREDICT = "[predict]\nask = 'x'\nwhy = 'y'\nchoices = ['a', 'b']\nright = 1\n"
TASK = "[task]\nask = 'x'\nhint = 'y'\nframes = 1\nreach = {{{}}}"


def test_a_file_that_makes_no_sense_is_refused_in_a_sentence(tmp_path):
    for text, said in [
        ("preset = 3", "preset 1 must have set, title"),
        ("[[preset]]\ntitle = 'x'", "preset 1 must have set, title"),
        ("[[tip]]\nask = 'x'", "tip is unknown"),
        (TASK.format("parcel_pressure = ['300 K', '1 hPa']"), "cannot be read"),
        (TASK.format("nonsense = ['300 K', '1 K']"), "nonsense of a task"),
        ("[predict]\nask = 'x'\nwhy = 'y'\nchoices = ['a', 'b']\nright = 3", "from 1 to 2"),
        (PREDICT + "draw = {air_temperature = ['0 degC', '3 hPa']}", "air_temperature of a prediction cannot be read"),
        (PREDICT + "draw = 3", "draw of predict must have a variable, and at most"),
        (PREDICT + "drawn = 3", "predict 1 must have ask, choices, right, why, may have draw, and nothing else"),
        ("= 3", "is not TOML"),
    ]:
        module = tmp_path / "mine.py"
        module.with_suffix(".live.toml").write_text(text, encoding="utf-8")
        with pytest.raises(ConfigError, match=said):
            lesson_of(type("Module", (), {"__file__": str(module)}))

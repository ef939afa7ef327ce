"""What a scene offers a class: presets, a pump, undo, challenges, gauges, a scale that adapts."""

import json
import struct

import numpy as np
import pytest

from atmosbox import scenarios
from atmosbox.errors import ConfigError, SettingError
from atmosbox.live import Session
from atmosbox.live.lesson import lesson_of
from atmosbox.simulation.preparation import build, prepare

FASTEST = 28  # index of the highest speed in a frame


def scene(tmp_path, text):
    """Return a user's own scene with such a file beside it."""
    module = tmp_path / "mine.py"
    module.with_suffix(".live.toml").write_text(text, encoding="utf-8")
    return type("Module", (), {"__file__": str(module)})


def highest(session):
    return struct.unpack_from("<f", session.frame(), FASTEST)[0]


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


def test_a_preset_takes_its_values_and_the_scenes_own_for_the_rest():
    session = Session(prepare("temperature", {"molecules": 50, "seed": 7}))
    number = [preset.title for preset in session.lesson.presets].index("At 11 km")
    session.obey({"type": "preset", "number": number})
    now = session.prepared.settings
    assert (now.temperature, now.pressure, now.molecules, now.seed) == (-56.5, 226.0, 200, 7)
    with pytest.raises(SettingError, match="is no set of settings"):
        session.obey({"type": "preset", "number": 99})


def test_the_pump_puts_more_molecules_into_the_same_volume():
    session = Session(prepare("temperature", {"molecules": 400}))
    before = session.setup.parcel.volume
    session.obey({"type": "pump", "factor": 1.5})
    assert session.setup.parcel.number == 600
    assert session.setup.parcel.volume == pytest.approx(before, rel=3e-3)  # excluded volume
    assert any("600 molecules in the same volume" in note["text"] for note in session.notes())
    with pytest.raises(SettingError, match="not offered by this scene"):
        Session(prepare("lifting-dry", {"molecules": 50})).obey({"type": "pump", "factor": 1.5})


def test_undo_goes_back_through_knobs_drags_and_new_boxes():
    moment = [0.0]
    session = Session(prepare("temperature", {"molecules": 50}), clock=lambda: moment[0])
    for value in (100.0, 150.0, 200.0):  # a slider that is moved is one change
        moment[0] += 0.2
        session.obey({"type": "set", "name": "temperature", "value": value})
    moment[0] += 5.0
    session.obey({"type": "set", "name": "temperature", "value": 300.0})
    session.obey({"type": "set", "name": "molecules", "value": 80})

    def stands():
        controls = {control.name: control.value for control in session.controls()}
        return controls["temperature"], controls["molecules"]

    found = [stands()]
    while session.state()["undo"]:
        session.obey({"type": "undo"})
        found.append(stands())
    assert found == [(300.0, 80), (300.0, 50), (200.0, 50), (25.0, 50)]
    kelvin = session.setup.parcel.wall_kT() * session.setup.scale.temperature
    np.testing.assert_allclose(kelvin, 298.15)
    session.obey({"type": "undo"})
    assert session.notes()[-1]["text"] == "There is nothing to take back."


def test_undo_of_the_first_turn_takes_the_heat_baths_away_again():
    session = Session(prepare("elastic-collisions", {"molecules": 20}))
    session.obey({"type": "set", "name": "speed", "value": 1.0})
    assert np.isfinite(session.setup.parcel.wall_kT()).sum() == 4
    session.obey({"type": "undo"})
    assert np.isnan(session.setup.parcel.wall_kT()).all()
    before = session.setup.parcel.energy()
    session.obey({"type": "step"})
    assert session.setup.parcel.energy() == pytest.approx(before, rel=1e-12)
    assert [change.words for change in session.changes] == ["speed as at the start"]
    # also if the box was restarted in between
    session.obey({"type": "set", "name": "speed", "value": 1.0})
    session.obey({"type": "set", "name": "molecules", "value": 30})
    for speed, molecules in ((1.0, 20), (0.5, 20)):
        session.obey({"type": "undo"})
        assert np.isnan(session.setup.parcel.wall_kT()).all()
        settings = session.prepared.settings
        assert (settings.speed, settings.molecules) == (speed, molecules)


def test_gauges_read_what_the_instruments_have_measured():
    session = Session(prepare("temperature", {"molecules": 800, "start_temperature": "25 degC"}))
    assert session.state()["gauges"] == []
    session.obey({"type": "play"})
    session.run(20.0)
    session.measured()
    told = {gauge["name"]: gauge["value"] for gauge in session.state()["gauges"]}
    # 800 molecules scatter by 8.6 K in one frame; 60 K are seven times that
    assert told["thermometer"] == pytest.approx(25.0, abs=60.0)
    assert told["barometer"] == pytest.approx(1000.0, rel=0.3)
    assert session.state()["walls"] == pytest.approx([298.15] * 6)


def test_the_scale_of_speeds_follows_walls_that_are_heated_and_the_graph_reaches_as_far():
    session = Session(prepare("temperature", {"molecules": 200}))
    first = highest(session)
    assert first == session.stage()["stage"]["speed"]["high"]
    session.obey({"type": "set", "name": "temperature", "value": 450.0})
    # three thermal speeds of air of 723 K are 1367 m/s
    assert highest(session) == 1500.0 > first
    session.obey({"type": "play"})
    session.run(20.0)
    edges = session.experiment.measured(0).speed_bnds.values
    assert edges[-1, 1] > 4.0 * np.sqrt(8.314462618 * 723.15 / 0.0289647)


def test_the_scale_of_speeds_of_unlike_discs_is_not_that_of_the_lightest_alone():
    session = Session(prepare("elastic-collisions", {}))
    speed = np.linalg.norm(session.setup.parcel.snapshot().velocity, axis=1) * session.setup.scale.velocity
    assert speed.max() == pytest.approx(0.5)
    assert highest(session) == 2.0
    session.obey({"type": "play"})
    session.run(20.0)
    speed = np.linalg.norm(session.setup.parcel.snapshot().velocity, axis=1) * session.setup.scale.velocity
    assert np.mean(speed > highest(session)) < 0.02


def test_axes_of_an_ascent_hold_its_way_before_it_begins():
    panels = Session(prepare("lifting-dry", {"molecules": 50})).stage()["stage"]["panels"]
    profile = next(panel for panel in panels if panel["title"] == "A rising parcel cools")
    assert min(profile["planned"]["y"]) == pytest.approx(300.0, abs=0.1)
    assert max(profile["planned"]["y"]) == pytest.approx(1000.0, abs=0.1)
    assert min(profile["planned"]["x"]) == pytest.approx(-68.9, abs=0.1)  # the dry adiabat at 300 hPa
    json.dumps(panels, allow_nan=False)
    still = Session(prepare("temperature", {"molecules": 50})).stage()["stage"]["panels"]
    assert all(panel["planned"] == {"x": [], "y": []} for panel in still)


def test_a_file_that_makes_no_sense_is_refused_in_a_sentence(tmp_path):
    for text, said in [
        ("preset = 3", "preset 1 must have set, title"),
        ("[[preset]]\ntitle = 'x'", "preset 1 must have set, title"),
        ("[[tip]]\nask = 'x'", "tip is unknown"),
        ("[[challenge]]\nask = 'x'\nhint = 'y'\nreach = {parcel_pressure = ['300 K', '1 hPa']}", "cannot be read"),
        ("[[challenge]]\nask = 'x'\nhint = 'y'\nreach = {nonsense = ['300 K', '1 K']}", "nonsense of a challenge"),
        ("= 3", "is not TOML"),
    ]:
        with pytest.raises(ConfigError, match=said):
            lesson_of(scene(tmp_path, text))

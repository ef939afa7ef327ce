"""A session without a socket: requests of the page, messages to it, and recordings."""

import json

import numpy as np
import pytest
import xarray as xr

from atmosbox import page, plot, scenarios
from atmosbox import theory as law
from atmosbox.errors import AtmosboxError, FileError, SettingError
from atmosbox.file.netcdf import read
from atmosbox.live import Session
from atmosbox.scene.exchange import MoistBox
from atmosbox.scene.instruments import Molecules
from atmosbox.simulation import runner
from atmosbox.simulation.preparation import prepare
from atmosbox.simulation.verification import LEDGER_LIMIT, verify

SMALL = {
    "atmosphere": {"molecules": 200, "duration": 20},
    "attraction": {"molecules": 100, "duration": "0.02 ns"},
    "condensation": {"molecules": 300, "duration": "2 ns"},
    "diffusion": {"molecules": 200, "duration": 1.0},
    "elastic-collisions": {"molecules": 20, "duration": "3 s"},
    "evaporation": {"molecules": 300, "pool": 60, "duration": "1 ns"},
    "nuclei": {"molecules": 500, "duration": "2 ns"},
    "lifting-dry": {"molecules": 100, "ascent": 40},
    "lifting-moist": {"molecules": 300, "ascent": 40},
    "lifting-sounding": {"molecules": 300, "ascent": 40},
    "mountains": {"molecules": 300, "travel": 40},
    "temperature": {"molecules": 100, "duration": "2 ns"},
    "temperature-large": {"molecules": 100, "duration": "2 ns"},
}


def session(scene="temperature", folder=None, **more):
    """Return a session of a small box."""
    settings = SMALL[scene] | more.pop("settings", {})
    engine = more.pop("engine", None)
    return Session(prepare(scene, settings, engine=engine), **({} if folder is None else {"folder": folder}), **more)


def play_to(box, frames):
    """Advance until a number of frames are complete."""
    for _ in range(10_000):
        if box.state()["frame"] >= frames:
            return
        box.obey({"type": "play"})
        box.run(min(0.5, 0.45 * box.setup.frame / box.experiment.rate))
    raise AssertionError(f"only {box.state()['frame']} frames after a long time")


def molecules(box):
    return box.setup.parcel.snapshot()


def series(messages):
    """Return the last value of every series that was sent."""
    found = {}
    for message in messages:
        if message["type"] == "series":
            found |= {name: values[-1] for name, values in message["values"].items() if values}
    return found


def test_the_small_boxes_are_those_of_all_scenes():
    assert set(SMALL) == set(scenarios.names())


@pytest.mark.parametrize("scene", SMALL)
def test_every_scene_plays_on_beyond_its_end_and_tells_its_graphs(scene):
    box = session(scene)
    told = {}
    frames = box.setup.frames if box.setup.ends else min(box.setup.frames, 60)
    play_to(box, frames)
    play_to(box, frames + 4)
    for message in box.measured():
        told |= dict.fromkeys(message.get("values", {}), message["type"])
    record = box.stage()
    needed = {variable for line in _lines(record) for variable in line if variable != "elapsed_time"}
    assert needed
    assert needed - set(told) <= {"parcel_temperature_se"}
    assert all(json.dumps(message, allow_nan=False) for message in box.measured())
    assert len(box.frame()) > 40
    assert box.state()["ledger"] < LEDGER_LIMIT


def _lines(record):
    for panel in record["stage"]["panels"]:
        for line in panel["lines"]:
            yield [line[end]["name"] for end in ("x", "y", "error", "minus") if line.get(end)]


def test_however_play_and_pause_cut_it_the_same_seed_does_the_same():
    one, other = session(), session()
    play_to(one, 40)
    rng = np.random.default_rng(1)
    while other.state()["frame"] < 39:
        other.obey({"type": str(rng.choice(["play", "pause", "step", "play"]))})
        other.run(float(rng.uniform(0.0, 0.3)))
    for box in (one, other):
        parcel = box.setup.parcel
        parcel.advance(80.0 * box.setup.frame)
    assert one.state()["frame"] >= 40
    for ours, theirs in zip(molecules(one)[1:], molecules(other)[1:], strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.parametrize("scene", ["temperature", "lifting-dry", "condensation"])
def test_a_recording_of_a_box_that_nobody_touched_is_the_run(tmp_path, scene):
    box = session(scene, tmp_path)
    box.obey({"type": "record", "file": "whole"})
    play_to(box, box.setup.frames)
    path = box.stop_recording()
    ours = xr.load_dataset(path)
    theirs = runner.run(scene, save_molecules=False, **SMALL[scene])
    assert path.name == "whole.nc"
    assert ours.sizes["elapsed_time"] == box.setup.frames
    xr.testing.assert_identical(ours.drop_attrs(), theirs.drop_attrs())
    assert ours.attrs["atmosbox_parameters"] == theirs.attrs["atmosbox_parameters"]
    assert ours.attrs["atmosbox_headlines"] == theirs.attrs["atmosbox_headlines"]
    assert "atmosbox live" in ours.attrs["history"]
    assert "atmosbox_changes" not in ours.attrs


def test_warmer_walls_warm_the_air_the_theory_and_the_file(tmp_path):
    box = session(folder=tmp_path)
    box.obey({"type": "record", "file": None})
    play_to(box, 100)
    box.measured()
    box.obey({"type": "set", "name": "temperature", "value": 200})
    play_to(box, 500)
    found = series(box.measured())
    assert found["air_temperature_theory"] == pytest.approx(473.15)
    assert found["wall_temperature[z_low]"] == pytest.approx(473.15)
    path = box.stop_recording()
    made = xr.load_dataset(path)
    late = made.air_temperature.values[200:]
    # 100 molecules scatter by sqrt(2 / 300) of T = 39 K; 300 looks, in 20 blocks, 4 errors: 1 false alarm in 1300
    blocks = late[: len(late) // 20 * 20].reshape(20, -1).mean(axis=1)
    assert abs(blocks.mean() - 473.15) < 4.0 * blocks.std(ddof=1) / np.sqrt(20)
    assert made.air_temperature_theory.values[50] == pytest.approx(298.15)
    assert made.air_pressure_theory.values[-1] / made.air_pressure_theory.values[50] == pytest.approx(473.15 / 298.15)
    (change,) = json.loads(made.attrs["atmosbox_changes"])
    assert (change["name"], change["value"], change["unit"], change["time_unit"]) == ("temperature", 200, "degC", "ns")
    assert 0.9 * made.elapsed_time.values[99] < change["elapsed_time"] < made.elapsed_time.values[101]
    assert "temperature = 200 degC" in made.attrs["history"]
    assert made.attrs["atmosbox_headlines"] == "[]"
    assert all(check.passed for check in verify(made))
    mean = float(np.average(made.speed, weights=made.speed_probability_density))
    expected = float(np.average(made.speed, weights=made.speed_probability_density_theory))
    assert mean == pytest.approx(expected, rel=0.03)  # averages begin after the change; 300 looks: 0.4 %


def test_a_recording_from_the_middle_counts_from_there_on(tmp_path):
    box = session("atmosphere", tmp_path)
    play_to(box, 60)
    box.run(0.01)
    box.obey({"type": "record", "file": "late.nc"})
    play_to(box, 130)
    made = xr.load_dataset(box.stop_recording())
    first = float(made.elapsed_time_bnds.values[0, 0])
    assert first >= 60 * box.setup.frame * box.setup.scale.time * (1.0 - 1e-12)
    assert made.sizes["elapsed_time"] >= 65
    assert made.air_pressure.values[0] < 3.0 * made.air_pressure.values[1:].max()
    assert "Recorded from" in made.attrs["comment"]
    assert all(check.passed for check in verify(made))


def test_a_stronger_gravity_is_in_the_file_and_its_books_balance(tmp_path):
    box = session("atmosphere", tmp_path)
    box.obey({"type": "record", "file": "heavy"})
    play_to(box, 30)
    box.obey({"type": "set", "name": "gravity", "value": "25 m s-2"})
    play_to(box, 120)
    made = xr.load_dataset(box.stop_recording())
    assert made.gravity.values[0] == pytest.approx(9.80665)
    assert made.gravity.values[-1] == pytest.approx(25.0)
    assert made.work_by_gravity.values[-1] > 0.0
    assert all(check.passed for check in verify(made))
    thinning = made.number_density_barometric.values
    apart = made.height.values[10] - made.height.values[5]
    by_gravity = np.exp(25.0 / 9.80665 * apart / box.setup.scale.length)
    assert thinning[5] / thinning[10] == pytest.approx(by_gravity, rel=1e-6)


def test_warmer_walls_let_saturation_follow():
    box = session("condensation")
    play_to(box, 3)
    before = series(box.measured())
    box.obey({"type": "set", "name": "temperature", "value": 25})
    play_to(box, 6)
    after = series(box.measured())
    start = MoistBox(300, 293.15, 1e5, 1.5)
    for found, kelvin in ((before, 293.15), (after, 298.15)):
        saturated = float(law.saturation_vapor_pressure(kelvin))
        expected = start.share_at(kelvin) * saturated
        assert found["water_vapor_partial_pressure_theory"] == pytest.approx(expected, rel=1e-6)
        assert found["water_vapor_partial_pressure_theory"] <= saturated
    assert after["condensation_rate_theory"] > before["condensation_rate_theory"]


def agrees(values, expected, frames):
    """Return whether the mean of the last frames is within 4 errors of 20 blocks: a false alarm once in 1 300."""
    blocks = np.array(values, float)[-frames:].reshape(20, -1).mean(axis=1)
    return abs(blocks.mean() - expected) < 4.0 * blocks.std(ddof=1) / 20**0.5


def whole(box):
    """Return all measurements since the last change, by name."""
    return next(message["values"] for message in box.measured() if message["type"] == "series")


@pytest.mark.parametrize("engine", ["exact", pytest.param("dsmc", marks=pytest.mark.validate)])
def test_the_walls_cool_the_air_over_a_pool_and_a_cover_slows_both_rates_alike(engine):
    large = {"molecules": 3000, "pool": 600, "duration": "20 ns"}
    box = session("evaporation", settings=large, engine=engine)
    play_to(box, 20)
    assert np.isnan(box.setup.parcel.wall_kT()).all(), "walls that nobody turned let no heat pass"
    began = box.setup.parcel.number + box.setup.parcel.liquid
    box.obey({"type": "set", "name": "temperature", "value": "10 degC"})
    play_to(box, 520)
    found, saturated = whole(box), float(law.saturation_vapor_pressure(283.15))
    assert agrees(found["gas_temperature"], 283.15, 400)
    assert agrees(found["liquid_temperature"], 283.15, 400)
    assert agrees(found["water_vapor_partial_pressure"], saturated, 400)
    assert found["water_vapor_partial_pressure_theory"][-1] == pytest.approx(saturated)
    rate = found["condensation_rate_theory"][-1]
    assert agrees(found["evaporation_rate"], rate, 400)

    box.obey({"type": "set", "name": "open_pool", "value": 25})
    play_to(box, 820)
    found = whole(box)
    assert found["condensation_rate_theory"][-1] == pytest.approx(0.25 * rate)
    assert agrees(found["evaporation_rate"], 0.25 * rate, 280)

    box.obey({"type": "set", "name": "open_pool", "value": 0})
    shut = box.setup.parcel.evaporated, box.setup.parcel.condensed
    box.obey({"type": "set", "name": "temperature", "value": "30 degC"})
    play_to(box, 1120)
    assert (box.setup.parcel.evaporated, box.setup.parcel.condensed) == shut
    assert agrees(whole(box)["liquid_temperature"], 303.15, 200), "heat passes the cover"
    assert box.setup.parcel.number + box.setup.parcel.liquid == began
    assert box.state()["ledger"] < LEDGER_LIMIT


def test_a_rim_brings_light_and_heavy_discs_to_the_energy_that_its_speed_means(tmp_path):
    box = session("elastic-collisions", folder=tmp_path, settings={"duration": "120 s"})
    box.obey({"type": "record"})
    play_to(box, 50)
    box.obey({"type": "set", "name": "speed", "value": 1.0})
    play_to(box, 1150)
    made = read(box.stop_recording())
    whole(box)
    assert box.state()["gauges"] == [], "of 10^20 degrees"
    assert (made.energy_change < 1e-12).all(), "beyond the heat of the rim none is made"
    before, after = made.kinetic_energy_light_theory.values[[0, -1]]
    assert after == pytest.approx(4.0 * before, rel=1e-9)
    for half in ("light", "heavy"):
        assert agrees(made[f"kinetic_energy_{half}"].values, after, 900)
    assert np.isfinite(made.momentum_residual.values[:50]).all()
    assert box.state()["ledger"] < LEDGER_LIMIT


def test_a_parcel_is_led_down_again_by_hand():
    box = session("lifting-dry", settings={"molecules": 300, "ascent": 200})
    play_to(box, 40)
    top = box.measured()[-1]["values"]
    assert not box.playing
    assert box.finished
    assert "altitude" in box.notes()[-1]["text"]
    box.run(1.0)
    assert box.state()["frame"] == 40
    box.obey({"type": "set", "name": "altitude", "value": 0})
    assert box.playing
    assert not box.finished
    play_to(box, 85)
    back = box.measured()[-1]["values"]
    assert top["parcel_height"][-1] == pytest.approx(box.setup.knobs[0].high * 1000.0)
    assert back["parcel_height"][-1] == pytest.approx(0.0, abs=1.0)
    assert back["environment_pressure"][-1] == pytest.approx(1e5)
    assert back["parcel_temperature"][-1] == pytest.approx(288.15, abs=12.0)  # finite-rate error: 150 K / 200
    assert len(back["parcel_pressure"]) == len(back["elapsed_time"]) >= 85
    assert box.state()["ledger"] < LEDGER_LIMIT


def test_a_rainy_parcel_that_is_led_by_hand_has_its_theory():
    box = session("mountains", settings={"molecules": 400, "travel": 40, "cloud_water": 0.1})
    play_to(box, 30)
    box.obey({"type": "set", "name": "way", "value": 5})
    play_to(box, 60)
    told = box.measured()[-1]["values"]
    assert box.setup.frames == 96
    assert np.isfinite(np.array(told["humidity_mixing_ratio_theory"], float)).all()


@pytest.mark.parametrize(
    ("name", "value", "is_so"),
    [
        ("molecules", 150, lambda box: box.setup.parcel.number == 150),
        ("start", "equal", lambda box: box.prepared.settings.start == "equal"),
        ("collisions", False, lambda box: str(box.prepared.engine) == "exact:collisions=off"),
        ("pressure", "500 hPa", lambda box: box.prepared.settings.pressure == 500.0),
    ],
)
def test_a_setting_lets_the_box_begin_anew(name, value, is_so):
    box = session()
    play_to(box, 20)
    box.obey({"type": "set", "name": name, "value": value})
    assert is_so(box)
    assert box.state()["frame"] == 0
    assert box.state()["time"] == 0.0
    assert box.playing
    play_to(box, 5)
    assert next(c.value for c in box.controls() if c.name == name) == (500.0 if name == "pressure" else value)
    if name == "collisions":
        assert box.setup.parcel.contacts == 0
        box.obey({"type": "set", "name": "collisions", "value": True})
        assert str(box.prepared.engine) == "exact"


def test_water_and_rotation_can_be_changed():
    wet, dry = session("condensation"), session("lifting-dry")
    wet.obey({"type": "set", "name": "humidity", "value": 300})
    dry.obey({"type": "set", "name": "rotation", "value": False})
    assert wet.prepared.settings.humidity == 300.0
    assert dry.setup.parcel.degrees_of_freedom == 3.0


def test_drops_cannot_do_without_collisions():
    box = session("condensation", settings={"drops": 1})
    assert "collisions" not in [control.name for control in box.controls()]


def test_a_reset_begins_with_what_the_sliders_say():
    box = session()
    box.obey({"type": "set", "name": "temperature", "value": 100})
    box.obey({"type": "reset", "seed": 5})
    assert box.prepared.settings.temperature == 100.0
    assert box.prepared.settings.seed == 5
    assert box.changes == []
    box.obey({"type": "reset", "seed": None})
    assert box.prepared.settings.seed == 5


def test_a_box_that_begins_anew_ends_the_recording(tmp_path):
    box = session(folder=tmp_path)
    box.obey({"type": "record", "file": "one"})
    play_to(box, 12)
    box.obey({"type": "reset", "seed": 2})
    made = xr.load_dataset(tmp_path / "one.nc")
    assert made.sizes["elapsed_time"] >= 12
    assert json.loads(made.attrs["atmosbox_parameters"])["settings"]["seed"] == 1
    assert box.recording is None
    assert not list(tmp_path.glob("*.part.nc"))


def test_what_is_not_possible_is_refused_in_words_and_changes_nothing(tmp_path):
    box = session(folder=tmp_path)
    before = box.setup
    cases = [
        ({"type": "set", "name": "temperature", "value": 1e9}, "-200 degC to 500 degC"),
        ({"type": "set", "name": "temperature", "value": float("nan")}, "not finite"),
        ({"type": "set", "name": "temperature", "value": {"a": [1]}}, "temperature"),
        ({"type": "set", "name": "molecules", "value": 0}, "molecules = 0"),
        ({"type": "set", "name": "molecules", "value": 10**400}, "molecules = about"),
        ({"type": "set", "name": "start", "value": "warm"}, "maxwell"),
        ({"type": "set", "name": "seed", "value": 3}, "cannot be changed here"),
        ({"type": "set"}, "cannot be changed here"),
        ({"type": "pace", "value": 1000}, "0.25 to 16"),
        ({"type": "pace"}, "0.25 to 16"),
        ({"type": "reset", "seed": -1}, "seed"),
        ({"type": "reset", "seed": "soon"}, "seed"),
        ({"type": "record", "file": "../out.nc"}, "not the name of a file"),
        ({"type": "record", "file": ".hidden"}, "not the name of a file"),
        ({"type": "record", "file": 7}, "not a name"),
        ({"type": "record", "file": "x" * 300}, "too long"),
        ({"type": ["play"]}, "cannot be asked for by this page"),
        ({}, "cannot be asked for by this page"),
    ]
    for message, words in cases:
        with pytest.raises(AtmosboxError) as refusal:
            box.obey(message)
        assert words in str(refusal.value)
        assert "--set" not in box.said(refusal.value)
        assert box.setup is before
        assert box.changes == []
        assert not list(tmp_path.iterdir())


def test_a_box_that_cannot_be_built_leaves_the_one_before():
    box = session(settings={"pressure": 100_000})
    before = box.setup
    with pytest.raises(SettingError):
        box.obey({"type": "set", "name": "molecules", "value": "many"})
    assert box.setup is before
    play_to(box, 3)


def test_recordings_never_replace_a_file_unless_told_to(tmp_path):
    box = session(folder=tmp_path)
    (tmp_path / "warm.nc").write_text("mine", encoding="utf-8")
    (tmp_path / "temperature-live.nc").write_text("mine", encoding="utf-8")
    with pytest.raises(FileError, match="exists already"):
        box.obey({"type": "record", "file": "warm"})
    box.obey({"type": "record", "file": None})
    assert box.recording == "temperature-live-2.nc"
    with pytest.raises(SettingError, match="stop that first"):
        box.obey({"type": "record", "file": "other"})
    box.obey({"type": "stop_record"})
    assert "no frame was complete" in box.notes()[-1]["text"]
    assert (tmp_path / "warm.nc").read_text(encoding="utf-8") == "mine"
    bold = session(folder=tmp_path, force=True)
    bold.obey({"type": "record", "file": "warm"})
    play_to(bold, 3)
    assert bold.stop_recording() == tmp_path / "warm.nc"
    assert xr.load_dataset(tmp_path / "warm.nc").sizes["elapsed_time"] >= 3


def test_a_recording_can_be_plotted_and_with_molecules_be_viewed(tmp_path):
    box = Session(prepare("temperature", SMALL["temperature"], save_molecules=True), folder=tmp_path)
    play_to(box, 10)
    box.obey({"type": "record", "file": "seen"})
    play_to(box, 20)
    box.obey({"type": "set", "name": "temperature", "value": 90})
    play_to(box, 40)
    path = box.stop_recording()
    made = read(path)
    assert made.molecule_position.shape == (made.sizes["elapsed_time"], 100, 3)
    assert plot.save(made, tmp_path / "seen.png", None, theme="notes").stat().st_size > 1000
    assert page.save([made], tmp_path / "seen.html").stat().st_size > 100_000
    assert not any(isinstance(each, Molecules) for each in box.experiment.gauges[0].instruments)


@pytest.mark.parametrize("scene", ["lifting-moist", "lifting-sounding"])
def test_a_recording_without_headlines_can_be_plotted(tmp_path, scene):
    box = session(scene, tmp_path)
    box.obey({"type": "record", "file": "led"})
    play_to(box, 20)
    box.obey({"type": "set", "name": "altitude", "value": 1})
    play_to(box, 40)
    made = read(box.stop_recording())
    assert made.attrs["atmosbox_headlines"] == "[]"
    assert plot.save(made, tmp_path / "led.png", None, theme="notes").stat().st_size > 1000


def test_a_slider_on_its_way_is_one_change():
    box = session()
    for value in range(26, 60):
        box.obey({"type": "set", "name": "temperature", "value": value})
    assert [change.value for change in box.changes] == [59.0]


def test_so_many_changes_that_no_file_could_tell_them_end_the_recording(tmp_path, monkeypatch):
    monkeypatch.setattr("atmosbox.live.hand.MOST_CHANGES", 30)
    box = session(folder=tmp_path)
    box.obey({"type": "record", "file": "restless"})
    for k in range(31):
        play_to(box, 2 * k + 1)
        box.obey({"type": "set", "name": "temperature", "value": k})
    assert box.recording is None
    made = xr.load_dataset(tmp_path / "restless.nc")
    assert len(json.loads(made.attrs["atmosbox_changes"])) == 31
    assert "11 changes more" in made.attrs["comment"]
    assert len(box.changes) == 30


def test_a_long_session_keeps_little(monkeypatch):
    monkeypatch.setattr("atmosbox.live.experiment._WINDOW", 40)
    monkeypatch.setattr("atmosbox.live.trace.MOST", 50)
    box = session()
    box.report._trace._most = 50
    for frames in range(10, 400, 10):
        play_to(box, frames)
        box.measured()
    assert len(box.experiment.gauges) <= 2
    assert all(gauge.frames <= 45 for gauge in box.experiment.gauges)
    whole = next(message for message in box.report.everything() if message["type"] == "series")
    assert 25 <= len(whole["time"]) <= 50
    assert whole["time"] == sorted(whole["time"])


def test_a_scene_of_ones_own_gets_its_sliders(tmp_path):
    scene = tmp_path / "my_scene.py"
    scene.write_text(
        '"""Mine."""\n'
        "import numpy as np\n"
        "from atmosbox.engine import Specular\n"
        "from atmosbox.scene.engines import EXACT\n"
        "from atmosbox.scene.instruments import Air\n"
        "from atmosbox.scene.knob import Knob\n"
        "from atmosbox.scene.panels import Line, Panel\n"
        "from atmosbox.scene.setup import Setup\n"
        "from atmosbox.scene.settings import SceneSettings, setting\n"
        "from atmosbox.scene.units import Scale\n"
        "class Settings(SceneSettings):\n"
        '    speed: float = setting(1.0, "1", "speed at the start", low=0.1, high=5.0)\n'
        "turned = []\n"
        "def build(settings, engine=EXACT):\n"
        "    parcel = engine.make([[1, 1, 1], [3, 1, 1]], [[settings.speed, 0, 0], [0, 0, 0]], length=(4, 2, 2))\n"
        '    knob = Knob("bell", "how loud", "1", 0.0, 1.0, 0.5, turned.append)\n'
        "    return Setup(parcel, Scale(1.0, 1.0, 1.0), 10.0, 10, (Air(),), knobs=(knob,))\n"
        "def theory(dataset, settings):\n"
        "    return {}\n"
        "def headlines(dataset, settings):\n"
        "    return ()\n"
        'panels = (Panel("line", "Warmth", (Line("elapsed_time", "air_temperature", "air"),)),)\n',
        encoding="utf-8",
    )
    box = Session(prepare(scene, {}), folder=tmp_path)
    assert [(c.name, c.restarts) for c in box.controls()] == [("bell", False), ("speed", True), ("collisions", True)]
    box.obey({"type": "set", "name": "bell", "value": 0.9})
    box.obey({"type": "set", "name": "speed", "value": 2.0})
    assert box.prepared.module.turned == [0.9]
    play_to(box, 15)
    assert series(box.measured())["air_temperature"] > 0.0

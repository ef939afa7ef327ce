"""The parts of a session: sliders, series, mailboxes, the names of recordings."""

import json

import numpy as np
import pytest
import xarray as xr

from atmosbox.errors import FileError
from atmosbox.live.audience import Audience, Mailbox
from atmosbox.live.control import controls
from atmosbox.live.server import allowed, loopback
from atmosbox.live.summary import Report
from atmosbox.live.tape import file_for
from atmosbox.live.trace import Trace
from atmosbox.scene.knob import Knob
from atmosbox.scene.panels import Line, Panel
from atmosbox.scene.settings import SceneSettings, setting


class Settings(SceneSettings):
    """Settings of every kind."""

    warmth: float = setting(25.0, "degC", "warmth of the walls", low=-270.0, high=2000.0)
    molecules: int = setting(200, "1", "number of molecules", low=1, high=1_000_000)
    thin: float = setting(1.0, "1", "how thin", low=0.0001, high=1000.0)
    free: float = setting(1.0, "m", "without limits")
    spin: bool = setting(True, "", "whether they spin")
    floor: str = setting("warm", "", "the floor", choices=("warm", "smooth"))
    file: str = setting("none", "", "a file of one's own")


def knob(**more):
    usual = {"name": "warmth", "help": "of the walls", "unit": "degC", "low": -200.0, "high": 500.0, "value": 25.0}
    return Knob(turn=lambda kelvin: None, **(usual | more))


def test_every_setting_has_a_slider_and_a_knob_takes_the_place_of_its_own():
    made = controls([knob()], Settings.describe(), Settings().as_dict(), collisions=None)
    told = {control.name: control.record() for control in made}
    assert list(told) == ["warmth", "molecules", "thin", "free", "spin", "floor"]
    assert [each["restarts"] for each in told.values()] == [False, True, True, True, True, True]
    assert (told["warmth"]["low"], told["warmth"]["high"], told["warmth"]["unit"]) == (-200.0, 500.0, "degC")
    assert told["molecules"]["scale"] == told["thin"]["scale"] == "log"
    assert told["molecules"]["high"] == 50_000
    assert told["molecules"]["step"] == 1
    assert told["free"]["low"] is None
    assert told["spin"]["kind"] == "switch"
    assert told["floor"]["choices"] == ["warm", "smooth"]


@pytest.mark.parametrize(
    ("low", "high", "value"), [(-200.0, 500.0, 25.0), (0.0, 30.0, 9.8), (0.0, 9.0758285, 9.0758285)]
)
def test_a_step_is_round_and_meets_where_the_knob_stands_if_it_can(low, high, value):
    (control,) = controls([knob(low=low, high=high, value=value)], [], {}, collisions=None)
    step = control.record()["step"]
    assert 20.0 <= (high - low) / step <= 5000.0
    if value != 9.0758285:
        assert (value - low) / step == pytest.approx(round((value - low) / step))


def test_a_knob_outside_its_range_is_refused():
    with pytest.raises(ValueError, match="stands at 900"):
        knob(value=900.0)


def test_a_series_that_grows_is_thinned_evenly_and_stays_in_step():
    trace = Trace(most=100)
    for first in range(0, 5000, 50):
        times = [float(t) for t in range(first, first + 50)]
        late = {"late": times} if first >= 2500 else {}
        trace.append(times, {"same": times, **late})
    told = trace.message(reset=True)
    assert 50 <= len(told["time"]) <= 100
    assert told["values"]["same"] == told["time"]
    assert len(set(np.diff(told["time"]))) == 1
    assert told["values"]["late"][0] is None
    assert told["values"]["late"][-1] == told["time"][-1]


def test_a_mailbox_keeps_what_must_not_be_missed_and_the_latest_of_the_rest():
    box = Mailbox(1)
    for k in range(1000):
        box.put(b"%d" % k)
        box.put(json.dumps({"type": "state", "k": k}))
    box.put('{"type": "series"}')
    assert box.take() == ['{"type": "series"}', '{"type": "state", "k": 999}', b"999"]
    assert box.take() == []


def test_a_new_stage_makes_old_news_void():
    box = Mailbox(1)
    for message in (
        b"old",
        '{"type": "series"}',
        '{"type": "arrays"}',
        '{"type": "stage"}',
        '{"type": "series", "n": 2}',
    ):
        box.put(message)
    assert box.take() == ['{"type": "stage"}', '{"type": "series", "n": 2}']


def test_a_mailbox_that_overflows_says_so_and_stays_small():
    box = Mailbox(1)
    for _ in range(10_000):
        box.put('{"type": "series"}')
    assert box.overrun
    assert len(box.take()) <= 201


def test_nobody_gets_letters_for_one_who_has_gone():
    audience = Audience()
    gone, here = audience.join(), audience.join()
    audience.leave(gone)
    audience.leave(gone)
    audience.put(gone.number, "private")
    audience.put(None, b"picture")
    assert gone.take() == []
    assert here.take() == [b"picture"]


def dataset(frames):
    times = np.arange(1.0, frames + 1.0)
    return xr.Dataset(
        {"a": ("elapsed_time", times**2), "b": ("elapsed_time", np.where(times > 2, np.nan, times)), "mean": ((), 3.0),
         "wall_temperature": (("elapsed_time", "wall"), np.tile([np.nan, 300.0], (frames, 1)))},
        {"elapsed_time": times, "wall": ["x_low", "x_high"], "bin": [1.0, 2.0]},
    ).assign(share=("bin", [0.25, 0.75]))  # fmt: skip


def test_a_report_tells_each_point_once_and_arrays_whole():
    line = Line("elapsed_time", "a", "a", error="b")
    bars = Line("bin", "share", "share")
    level = Line("elapsed_time", "mean", "mean")
    panels = (Panel("line", "A", (line, level)), Panel("histogram", "B", (bars,)))
    report = Report(panels, ["elapsed_time", "a", "b", "bin", "share", "mean", "missing"])
    series, arrays = report.messages(dataset(3))
    assert series["time"] == [1.0, 2.0, 3.0]
    assert series["values"] == {"a": [1.0, 4.0, 9.0], "b": [1.0, 2.0, None], "wall_temperature[x_high]": [300.0] * 3}
    assert arrays["values"] == {"bin": [1.0, 2.0], "share": [0.25, 0.75], "mean": [3.0]}
    series, arrays = report.messages(dataset(4))
    assert (series["reset"], series["time"], series["values"]["a"]) == (False, [4.0], [16.0])
    assert report.messages(dataset(4)) == [arrays]
    past, last = report.everything()
    assert (past["reset"], past["time"]) == (True, [1.0, 2.0, 3.0, 4.0])
    assert last == arrays


def test_a_scene_that_draws_one_series_against_another_is_told_whole():
    report = Report([Panel("profile", "A", (Line("a", "b", "a"),))], ["a", "b"])
    (told,) = report.messages(dataset(5000))
    assert told["type"] == "arrays"
    assert len(told["values"]["a"]) == len(told["values"]["elapsed_time"]) <= 1500
    assert told["values"]["a"][-1] == 5000.0**2


def test_a_recording_stays_in_its_folder(tmp_path):
    for name in ("a/b", "..", ".", "/", "a\\b", "~/a", "a\nb", "a\0b", " "):
        with pytest.raises(FileError, match="not the name of a file"):
            file_for(name, "temperature", tmp_path, force=True)


def test_a_free_name_is_found(tmp_path):
    first = file_for(None, "./my scene.py", tmp_path, force=False)
    first.touch()
    assert (first.name, file_for(None, "./my scene.py", tmp_path, force=False).name) == (
        "my scene-live.nc",
        "my scene-live-2.nc",
    )


def test_only_our_own_page_is_served():
    cases = [
        ("127.0.0.1:8642", None, True),
        ("localhost:8642", "http://localhost:8642", True),
        ("LOCALHOST:8642", "http://localhost:8642", True),
        ("[::1]:8642", "http://[::1]:8642", True),
        ("192.168.1.7:8642", "http://192.168.1.7:8642", True),
        ("mine:8642", "http://mine:8642", True),
        ("mine:8642", "http://mine:8643", False),
        ("localhost:8642", "http://127.0.0.1:8642", False),
        ("evil.example", None, False),
        ("localhost.evil.example", None, False),
        ("localhost@evil.example", None, False),
        ("127.0.0.1:8642", "null", False),
        ("", None, False),
        (None, None, False),
    ]
    for host, origin, ours in cases:
        assert allowed(host, origin, names=frozenset({"mine"})) is ours


def test_only_this_computer_is_loopback():
    assert [loopback(host) for host in ("127.0.0.1", "127.3.2.1", "::1", "localhost", "0.0.0.0", "::", "mine")] == [
        True, True, True, True, False, False, False,
    ]  # fmt: skip

"""The server: two browsers, browsers that disconnect, are slow or hostile, ports in use, Ctrl-C."""

import http.client
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time

import pytest
import xarray as xr
from typer.testing import CliRunner
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from atmosbox.cli import app
from atmosbox.errors import EngineError, SettingError
from atmosbox.live import Session
from atmosbox.live.server import PORT
from atmosbox.simulation.preparation import prepare

posix = pytest.mark.skipif(os.name == "nt", reason="signals of Windows are others")


def ask(site, path="/", **headers):
    """Return status, type and body of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", site.port, timeout=10)
    connection.putrequest("GET", path, skip_host="Host" in headers)
    for name, value in headers.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, answer.headers.get("Content-Type"), answer.read().decode()


def test_the_page_is_served_and_nothing_else(site):
    status, kind, body = ask(site)
    assert (status, kind) == (200, "text/html; charset=utf-8")
    assert body == "<!doctype html><title>box</title>"
    assert ask(site, "/etc/passwd")[0] == 404
    assert ask(site, "/../../x")[0] == 404


def test_another_site_gets_nothing(site):
    for host in ("evil.example", "evil.example:8642", "127.0.0.1.evil.example", "", "[oops"):
        assert ask(site, Host=host)[0] in (400, 403)
    for origin in ("http://evil.example", "null", "http://127.0.0.1:1"):
        assert ask(site, Origin=origin)[0] in (400, 403)


def test_only_who_has_the_token_may_look_and_steer(tmp_path, serve):
    session = Session(prepare("temperature", {"molecules": 100}), folder=tmp_path)
    with serve(session, token="open-sesame") as site:
        assert site.address.endswith(f":{site.port}/?token=open-sesame")
        for wrong in ("/", "/?token=", "/?token=open", "/?token=open-sesame&token=x", "/?Token=open-sesame", "/socket"):
            status, _, body = ask(site, wrong)
            assert status == 403
            assert "open-sesame" not in body
        assert ask(site, "/?token=open-sesame")[0] == 200
        with pytest.raises(InvalidStatus), site.visit():
            pass
        with connect(f"ws://127.0.0.1:{site.port}/socket?token=open-sesame", max_size=2**24) as socket:
            assert socket.recv()


def test_a_header_that_is_given_twice_is_refused_quietly(site, caplog):
    for name in ("Host", "Origin"):
        connection = http.client.HTTPConnection("127.0.0.1", site.port, timeout=10)
        connection.putrequest("GET", "/", skip_host=True)
        for header in ("Host", "Origin", name):
            connection.putheader(header, f"{'http://' * (header == 'Origin')}127.0.0.1:{site.port}")
        connection.endheaders()
        assert connection.getresponse().status == 400
    assert not caplog.records


def test_a_socket_opened_by_another_site_is_refused(site):
    with pytest.raises(InvalidStatus), site.visit(origin="http://evil.example"):
        pass
    with site.visit(origin=f"http://127.0.0.1:{site.port}") as page:
        assert page.hear("stage")["stage"]["scene"] == "temperature"


def test_a_page_is_told_all_there_is_and_pictures_come(site):
    with site.visit() as page:
        told = page.hear("stage")
        assert told["state"]["playing"] is False
        assert [control["name"] for control in told["controls"]][:2] == ["temperature", "molecules"]
        page.say({"type": "play"})
        first = struct.unpack("<Id", page.hear("picture")[:12])
        for _ in range(5):
            last = struct.unpack("<Id", page.hear("picture")[:12])
        assert last[0] > first[0]
        assert last[1] > first[1]
        values = page.hear("series")["values"]
        assert len(values["air_temperature"]) == len(values["air_temperature_theory"])
        assert page.hear("state", lambda state: state["rate"] > 0.0)["playing"] is True
        arrays = page.hear("arrays", lambda told: "speed_probability_density" in told["values"])["values"]
        assert len(arrays["speed"]) == len(arrays["speed_probability_density"])


def test_two_browsers_see_the_same_box_and_what_the_other_has_set(site):
    with site.visit() as one, site.visit() as other:
        one.hear("stage")
        other.hear("stage")
        one.say({"type": "set", "name": "temperature", "value": 80})
        for page in (one, other):
            controls = page.hear("controls")["controls"]
            assert controls[0]["value"] == 80.0
        other.say({"type": "pace", "value": 2})
        assert one.hear("state", lambda state: state["pace"] == 2.0)
        one.say({"type": "set", "name": "molecules", "value": 50})
        assert other.hear("stage")["stage"]["molecules"] == 50
        other.say({"type": "reset", "seed": 9})
        assert one.hear("stage", lambda told: told["state"]["seed"] == 9)
        one.say({"type": "set", "name": "temperature", "value": "warm"})
        assert "warm" in one.hear("note")["text"]


def test_a_browser_that_comes_back_gets_the_present_state_and_the_past(site):
    with site.visit() as page:
        page.hear("stage")
        page.say({"type": "set", "name": "temperature", "value": 90})
        page.say({"type": "play"})
        page.hear("series", lambda told: told["time"])
        page.say({"type": "pause"})
        paused = page.hear("state", lambda state: not state["playing"])
    with site.visit() as page:
        told = page.hear("stage")
        assert told["state"]["time"] >= paused["time"]
        assert told["controls"][0]["value"] == 90.0
        past = page.hear("series")
        assert past["reset"] is True
        assert len(past["time"]) == len(past["values"]["air_temperature"]) > 0
        assert page.hear("picture")


def test_the_box_rests_while_nobody_looks_but_not_while_it_is_recorded(site, tmp_path):
    with site.visit() as page:
        page.say({"type": "play"})
        page.hear("picture")
    time.sleep(0.3)
    rested = site.session.state()["time"]
    time.sleep(0.5)
    assert site.session.state()["time"] == rested
    with site.visit() as page:
        assert page.hear("stage")["state"]["playing"] is True
        page.say({"type": "record", "file": "alone"})
        page.hear("state", lambda state: state["recording"] == "alone.nc")
    before = site.session.state()["time"]
    time.sleep(0.8)
    assert site.session.state()["time"] > before
    site.__exit__()
    assert xr.load_dataset(tmp_path / "alone.nc").sizes["elapsed_time"] > 0
    assert "alone.nc" in site.left[-1]


def test_garbage_gets_a_note_and_nothing_breaks(site):
    with site.visit() as page:
        page.hear("stage")
        for garbage in (
            b"\x00\x01",
            "{",
            "null",
            '{"type": "set"}',
            '{"type": 1e999}',
            "[" * 20000,
            '{"type": "join"}',
        ):
            page.say(garbage)
            assert page.hear("note")["level"] == "error"
            page.say({"type": "step"})
            assert page.hear("picture")


def test_a_message_that_is_too_large_costs_only_its_own_line(site):
    with site.visit() as page, site.visit() as other:
        other.hear("stage")
        page.say('{"type": "' + "x" * 100_000 + '"}')
        other.say({"type": "play"})
        assert other.hear("picture")


def test_a_flood_of_requests_is_survived(site):
    with site.visit() as page:
        page.hear("stage")
        for value in range(3000):
            page.say({"type": "set", "name": "temperature", "value": value % 100})
        page.say({"type": "set", "name": "temperature", "value": 33})
        page.say({"type": "play"})
        assert page.hear("picture")
    assert len(site.session.changes) <= 3


def test_a_slow_browser_misses_pictures_and_holds_up_nobody(site):
    with site.visit() as slow, site.visit() as quick:
        slow.hear("stage")
        quick.say({"type": "play"})
        end = time.monotonic() + 2.0
        while time.monotonic() < end:
            quick.hear("picture")
        assert len(quick.pictures) > 15
        quick.say({"type": "pause"})
        quick.hear("state", lambda state: not state["playing"])
        assert slow.hear("state", lambda state: not state["playing"])


def test_a_port_in_use_is_refused_or_the_next_is_taken(tmp_path, serve):
    session = Session(prepare("elastic-collisions", {"molecules": 10}), folder=tmp_path)
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(SettingError, match=f"port = {port} is in use"), serve(session, port=port):
            pass
    with serve(session) as first, serve(Session(prepare("elastic-collisions", {"molecules": 10}))) as second:
        assert PORT <= first.port < second.port
    with pytest.raises(SettingError, match="no address of this computer"), serve(session, host="203.0.113.7"):
        pass


def test_an_engine_that_fails_ends_the_session_with_a_sentence(tmp_path, monkeypatch, serve):
    session = Session(prepare("elastic-collisions", {"molecules": 10}), folder=tmp_path)
    monkeypatch.setattr(session, "run", lambda *_: 1 / 0)
    served = serve(session)
    with served, served.visit() as page:
        page.say({"type": "play"})
        with pytest.raises(ConnectionClosed):
            page.hear("nothing more")
    assert isinstance(served.failure, EngineError)
    assert "ZeroDivisionError" in str(served.failure)


def test_an_engine_that_stalls_pauses_and_says_why(site, monkeypatch):
    from atmosbox.engine import StalledError

    def stall(*_):
        raise StalledError("the molecules have no room")

    with site.visit() as page:
        page.hear("stage")
        monkeypatch.setattr(site.session.experiment, "_advance", stall)
        page.say({"type": "play"})
        assert "no room" in page.hear("note")["text"]
        assert page.hear("state", lambda state: not state["playing"])
        monkeypatch.undo()
        page.say({"type": "reset", "seed": None})
        page.hear("stage")


@posix
@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.validate)]
)
def test_ctrl_c_saves_the_recording_and_says_so(tmp_path, number, status):
    words = ["live", "elastic-collisions", "--set", "molecules=10", "--no-browser", "--out", "mine.nc"]
    with subprocess.Popen(
        [sys.executable, "-m", "atmosbox", *words], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True, env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
    ) as program:  # fmt: skip
        address = program.stdout.readline().strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/\?token=[\w-]{22}", address)
        with connect(address.replace("http", "ws").replace("/?", "/socket?")) as page:
            page.send(json.dumps({"type": "record", "file": None}))
            page.send(json.dumps({"type": "play"}))
            while True:
                told = page.recv(timeout=30)
                if isinstance(told, str) and '"series"' in told and json.loads(told).get("time"):
                    break
            program.send_signal(number)
            said, errors = program.communicate(timeout=30)
    assert program.returncode == status
    assert said == ""
    assert "frames are in mine.nc" in errors
    assert "Traceback" not in errors
    made = xr.load_dataset(tmp_path / "mine.nc")
    assert made.sizes["elapsed_time"] > 1
    assert made.attrs["atmosbox_status"] == "complete"


def test_what_cannot_be_is_refused_before_anything_is_built(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for words, fault in [
        (["--port", "0"], "port = 0"),
        (["--port", "http"], "port = http"),
        (["--out", "x.png"], "writes netCDF"),
        (["--set", "molecules=0"], "molecules = 0"),
    ]:
        done = CliRunner().invoke(app, ["live", "temperature", "--no-browser", *words])
        assert done.exit_code == 2
        assert fault in done.output
    assert not list(tmp_path.iterdir())

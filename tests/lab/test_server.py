"""The page that Python serves: who gets it, plans for changed settings, refusals, Ctrl-C; and a class that uses it."""

import http.client
import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
from contextlib import contextmanager
from urllib.parse import urlencode

import pytest

from atmosbox.cli.request import Sought, gather, with_fewer_molecules
from atmosbox.errors import SettingError
from atmosbox.lab.page_file import AS_WRITTEN
from atmosbox.lab.server import PORT, Server
from atmosbox.simulation.preparation import build, prepare
from tests.lab.test_browser import Lab, advance, state_of

TOKEN = "open-sesame"


@contextmanager
def serving(scene, settings, **options):
    """Serve a scene in a thread."""
    with Server(prepare(scene, settings, engine="exact"), **options) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()


@pytest.fixture(scope="module")
def site():
    with serving("elastic-collisions", {"molecules": 10}, token=TOKEN) as server:
        yield server


def ask(server, path, headers=()):
    """Return status and body of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=60)
    names = [name for name, _ in headers]
    connection.putrequest("GET", path, skip_host="Host" in names)
    for name, value in headers:
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, answer.read().decode()


def plan(server, **settings):
    """Return the answer to a request for a plan: JSON, or the sentence of a refusal."""
    status, body = ask(server, "/plan?" + urlencode({"token": TOKEN, "settings": json.dumps(settings)}))
    return status, json.loads(body) if status == 200 else body


def test_only_our_own_page_is_served_and_only_to_who_has_the_token(site):
    here, whole = f"127.0.0.1:{site.server_address[1]}", f"/?token={TOKEN}"
    assert site.address == f"http://{here}{whole}"
    cases = [
        (whole, [], 200),
        (whole, [("Origin", f"http://{here}")], 200),
        *((wrong, [], 403) for wrong in ("/", "/?token=", "/?token=open", f"{whole}&token=x", f"/?Token={TOKEN}")),
        ("/plan", [], 403),
        (f"/../../etc/passwd?token={TOKEN}", [], 404),
        *((whole, [("Host", host)], 403) for host in ("evil.example", "127.0.0.1.evil.example", "", "[oops")),
        *((whole, [("Origin", origin)], 403) for origin in ("http://evil.example", "null", "http://127.0.0.1:1")),
        (whole, [("Host", here), ("Host", here)], 400),
        (whole, [("Origin", f"http://{here}")] * 2, 400),
        *((f"/plan?token={TOKEN}{rest}", [], 400) for rest in ("", "&settings=[]", "&settings=" + "[" * 9999)),
    ]  # fmt: skip
    for path, headers, status in cases:
        found, body = ask(site, path, headers)
        assert found == status, (path, headers)
        assert TOKEN not in body
    assert "connect-src 'self'" in ask(site, whole)[1]


def test_what_is_refused_is_said_in_a_sentence_for_the_page(site):
    cases = [
        ({"molecules": 0}, "molecules = 0 is below the allowed range"),
        ({"molecules": "many"}, "molecules = many"),
        ({"molecules": {"a": [1]}}, "molecules"),
        ({"warmth": 3}, "warmth = 3 is not a setting of this scene"),
        ({"seed": 1e400}, "seed"),
    ]
    for settings, said in cases:
        status, body = plan(site, **settings)
        assert (status, said in body) == (422, True), body
        assert "--set" not in body


def test_a_page_cannot_name_a_file_that_the_command_did_not_name():
    scene = prepare("lifting-sounding", {"molecules": 300, "ascent": 40}, engine="exact")
    with Server(scene) as server, pytest.raises(SettingError, match="null cannot be chosen in the page"):
        server.plan({"sounding": os.devnull})


def test_a_port_in_use_is_refused_or_the_next_is_taken(site):
    other = prepare("elastic-collisions", {"molecules": 10})
    with Server(other) as second:
        assert PORT <= site.server_address[1] < second.server_address[1]
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(SettingError, match=f"port = {port} is in use"):
            Server(other, port=port)


@pytest.mark.parametrize(
    ("scene", "values", "taken", "said"),
    [
        (
            "evaporation",
            [],
            {"molecules": 3000, "pool": 600},
            "molecules=3000 and pool=600, fewer than a run",
        ),
        ("lifting-moist", ["humidity=80"], {"humidity": "80", "molecules": 3000}, "begins with molecules=3000"),
        ("lifting-moist", ["molecules=500"], {"molecules": "500"}, ""),
        ("temperature", [], {}, ""),
    ],
)
def test_a_scene_of_many_molecules_begins_with_fewer_and_says_so(scene, values, taken, said, capsys):
    asked = with_fewer_molecules(gather(Sought(scene, values)))
    assert (asked.settings, asked.engine) == (taken, "exact")
    heard = capsys.readouterr().err
    assert said in heard if said else not heard


@pytest.mark.skipif(os.name == "nt", reason="signals of Windows are others")
@pytest.mark.parametrize(
    ("number", "status"), [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.nightly)]
)
def test_ctrl_c_ends_it(tmp_path, number, status):
    words = [sys.executable, "-m", "atmosbox", "live", "elastic-collisions", "--set", "molecules=10", "--no-browser"]
    with subprocess.Popen(
        words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)},
    ) as program:  # fmt: skip
        address = program.stdout.readline().strip()
        found = re.fullmatch(r"http://127\.0\.0\.1:(\d+)(/\?token=[\w-]{22})", address)
        connection = http.client.HTTPConnection("127.0.0.1", int(found[1]), timeout=60)
        connection.request("GET", found[2])
        assert connection.getresponse().status == 200
        program.send_signal(number)
        said, errors = program.communicate(timeout=30)
    assert (program.returncode, said) == (status, "")
    assert "Traceback" not in errors
    assert not list(tmp_path.iterdir())


def test_a_changed_setting_begins_the_run_that_python_begins_with_it(new_tab):
    settings = {"molecules": 40, "duration": 5.0}
    with serving("temperature", settings, token=TOKEN) as server:
        shown = Lab(new_tab(reduced_motion="reduce"), server.address)
        page = shown.page

        def runs_as_python_with(**changed):
            number = (settings | changed)["molecules"]
            shown.until(lambda: f"{number} molecules" in page.locator("#caption").text_content())
            setup = build(prepare("temperature", settings | changed))  # not while the server builds one, too
            shown.ask(type="frames", value=120)
            advance(setup, 120)
            assert setup.parcel.contacts > 5
            assert shown.digest() == state_of(setup.parcel)

        runs_as_python_with()
        page.locator("#controls summary").click()
        slider = page.locator("input[type=range][name=temperature]")
        slider.fill("90")
        slider.dispatch_event("change")
        page.get_by_role("spinbutton", name="number of molecules").fill("55")
        page.keyboard.press("Enter")
        runs_as_python_with(molecules=55, temperature=90)  # a knob stays where it was
        page.fill("#seed", "7")
        page.click("#reset")
        page.locator("select", has=page.locator("option[value=equal]")).select_option("equal")
        shown.until(lambda: page.locator("#time").inner_text() == "0 ns")
        runs_as_python_with(molecules=55, temperature=90, seed=7, start="equal")
        about, _ = shown.table()
        assert "molecules=55" in about[0]
        assert about[0].endswith("--seed 7")
        page.get_by_role("spinbutton", name="number of molecules").fill("0")
        page.keyboard.press("Enter")
        assert "number of molecules: type a number from 1 to" in shown.note()
        page.locator("#undo").click()
        shown.until(lambda: page.locator("#time").inner_text() == "0 ns")
        runs_as_python_with(molecules=55, temperature=90, seed=7)
        page.locator("#presets").select_option(label=AS_WRITTEN)
        runs_as_python_with()
        page.locator("#presets").select_option(label="At 11 km")
        shown.until(lambda: page.locator("#time").inner_text() == "0 ns")
        runs_as_python_with(temperature=-56.5, start_temperature=15, pressure=226)

    page.get_by_role("spinbutton", name="number of molecules").fill("60")
    page.keyboard.press("Enter")
    page.locator(".note", has_text="atmosbox has ended").wait_for()
    runs_as_python_with(temperature=-56.5, start_temperature=15, pressure=226)
    shown.faults.clear()  # the browser says that the connection was refused
    shown.close()

"""The page in Firefox, driven by its own protocol, Marionette: the same bits as in Python."""

import json
import shutil
import socket
import subprocess
import time

import pytest

from atmosbox.lab import save_lab
from atmosbox.lab.wasm_module import SCENES
from atmosbox.simulation.link import read_link
from atmosbox.simulation.preparation import prepare
from tests.lab.test_browser import SMALL
from tests.lab.test_link import TURNED, end_of, turn


class Firefox:
    """A Firefox without a window."""

    def __init__(self, path, folder):
        (folder / "user.js").write_text('user_pref("marionette.port", 0);\n', encoding="utf-8")
        words = [path, "--headless", "--marionette", "--no-remote", "--profile", str(folder), "about:blank"]
        self.process = subprocess.Popen(words, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port = folder / "MarionetteActivePort"
        for _ in range(600):
            if port.exists() and port.read_text():
                break
            time.sleep(0.1)
        self.socket = socket.create_connection(("127.0.0.1", int(port.read_text())), timeout=300)
        self.answers = self.socket.makefile("rb")
        self._read()
        self.say("WebDriver:NewSession", capabilities={})

    def _read(self):
        """Return a message: its length, a colon, and JSON."""
        size = b""
        while (character := self.answers.read(1)) != b":":
            size += character
        return json.loads(self.answers.read(int(size)))

    def say(self, command, **given):
        """Give a command, and return what comes back."""
        message = json.dumps([0, 1, command, given]).encode()
        self.socket.sendall(b"%d:%b" % (len(message), message))
        _, _, error, answer = self._read()
        assert error is None, error
        return answer

    def run(self, script, *given):
        """Run JavaScript in the page."""
        return self.say("WebDriver:ExecuteScript", script=script, args=given, sandbox=None)["value"]

    def wait(self, expression):
        """Return the value of an expression in the page as soon as it is true."""
        for _ in range(3000):
            if value := self.run(f"return {expression}"):
                return value
            time.sleep(0.1)
        raise AssertionError(f"{expression} never was true")

    def open(self, address):
        """Open a page; one with another link of the same page is opened again."""
        self.say("WebDriver:Navigate", url="about:blank")
        self.say("WebDriver:Navigate", url=address)
        self.run("window.faults = []; addEventListener('error', ({ message }) => window.faults.push(message));")
        self.wait("document.body.dataset.ready")
        self.ask(type="pause")

    def ask(self, **message):
        """Send a message to the engine."""
        self.run("document.dispatchEvent(new CustomEvent('ask', { detail: arguments[0] }))", message)

    def digest(self):
        """Return the SHA-256 of the state of the box."""
        self.run("delete document.body.dataset.digest")
        self.ask(type="digest")
        return self.wait("document.body.dataset.digest")

    def link(self):
        """Return the link of the run."""
        self.run("document.getElementById('link').click()")
        return self.wait("document.querySelector('dialog[open] #linked')?.value").split("\n")[1]

    def close(self):
        """End the browser."""
        self.say("Marionette:Quit", flags=["eForceQuit"])
        self.answers.close()
        self.socket.close()
        self.process.wait(60)


@pytest.fixture(scope="module")
def firefox(tmp_path_factory):
    """A Firefox for all tests; without one they are skipped."""
    path = next((found for name in ("firefox", "firefox-esr") if (found := shutil.which(name))), None)
    if path is None:
        pytest.skip("no Firefox: install firefox or firefox-esr (apt-get install firefox-esr)")
    opened = Firefox(path, tmp_path_factory.mktemp("profile"))
    yield opened
    opened.close()


@pytest.mark.nightly
@pytest.mark.parametrize("scene", ["temperature", "lifting-dry", "condensation", "convection", "attraction"])
def test_a_run_with_twenty_turns_is_the_same_to_the_last_bit_in_firefox_and_in_python(firefox, scene, tmp_path):
    prepared = prepare(scene, SCENES[scene] | SMALL[scene][0] | TURNED[scene][0], engine="exact")
    page = save_lab(prepared, tmp_path / "lab.html", others=False).as_uri()
    firefox.open(page)
    turn(firefox, scene)
    state, link = firefox.digest(), firefox.link()
    turns = read_link(link)[2]
    assert len(turns.turns) > 15
    assert end_of(link) == state
    firefox.open(page + link)
    firefox.ask(type="frames", value=turns.frames)
    assert firefox.digest() == state
    assert firefox.run("return window.faults") == []

"""Firefox without a network, controlled by its WebDriver BiDi: one page, and its answers."""

import contextlib
import json
import os
import re
import shutil
import signal
import subprocess

from websockets.sync.client import connect

__all__ = ["Firefox", "firefox_command"]

_QUIET = {
    "network.proxy.type": 1,  # to a port where nothing listens: no network
    "network.proxy.http": "127.0.0.1",
    "network.proxy.http_port": 9,
    "network.proxy.ssl": "127.0.0.1",
    "network.proxy.ssl_port": 9,
    "browser.shell.checkDefaultBrowser": False,
    "datareporting.policy.dataSubmissionEnabled": False,
    "app.update.enabled": False,
    "webgl.force-enabled": True,
    "ui.prefersReducedMotion": 1,
}


def firefox_command():
    """Return the command that starts Firefox on a screen; None if there is no screen.

    A headless Firefox has no WebGL on a machine without a graphics driver, so Xvfb is used if there is no screen.
    """
    firefox = os.environ.get("ATMOSBOX_FIREFOX") or shutil.which("firefox-esr") or shutil.which("firefox")
    screen = [] if os.environ.get("DISPLAY") else ["xvfb-run", "-a", "-s", "-screen 0 1280x800x24 +extension GLX"]
    return None if firefox is None or (screen and shutil.which(screen[0]) is None) else [*screen, firefox]


class Firefox:
    """One page in a Firefox of its own."""

    def __init__(self, folder):
        prefs = "\n".join(f"user_pref({json.dumps(name)}, {json.dumps(value)});" for name, value in _QUIET.items())
        (folder / "user.js").write_text(prefs, encoding="utf-8")
        command = [*firefox_command(), "--no-remote", "--profile", folder, "--remote-debugging-port", "0"]
        environment = os.environ | {"HOME": str(folder), "MOZ_REMOTE_SETTINGS_DEVTOOLS": "0"}
        self._process = subprocess.Popen(
            [str(part) for part in command],
            stderr=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            text=True,
            env=environment,
            start_new_session=True,
        )
        address = None
        for line in self._process.stderr:
            if found := re.search(r"WebDriver BiDi listening on (ws://\S+)", line):
                address = found.group(1)
                break
        if address is None:
            self._process.stderr.close()
            raise RuntimeError("Firefox has not started")
        self._open = contextlib.ExitStack()
        self._socket = self._open.enter_context(connect(f"{address}/session", max_size=None, proxy=None))
        self._asked = 0
        self._say("session.new", capabilities={})
        self.faults = []
        self._say("session.subscribe", events=["log.entryAdded"])
        self._context = self._say("browsingContext.getTree")["contexts"][0]["context"]

    def _say(self, method, **parameters):
        """Send a command, and return the answer to it."""
        self._asked += 1
        self._socket.send(json.dumps({"id": self._asked, "method": method, "params": parameters}))
        while True:
            heard = json.loads(self._socket.recv(timeout=120))
            if heard.get("method") == "log.entryAdded" and heard["params"]["level"] == "error":
                self.faults.append(heard["params"]["text"])
            if heard.get("id") == self._asked:
                if heard["type"] == "error":
                    raise RuntimeError(heard["message"])
                return heard["result"]

    def open(self, path):
        """Open a file."""
        self._say("browsingContext.navigate", context=self._context, url=path.as_uri(), wait="complete")

    def evaluate(self, expression):
        """Return the value of a piece of JavaScript, after its promise is settled."""
        answer = self._say(
            "script.evaluate", expression=expression, target={"context": self._context}, awaitPromise=True
        )
        if answer["type"] == "exception":
            raise RuntimeError(answer["exceptionDetails"]["text"])
        return answer["result"].get("value")

    def close(self):
        """Close Firefox."""
        self._open.close()
        os.killpg(self._process.pid, signal.SIGTERM)  # the screen, too
        self._process.wait(20)
        self._process.stderr.close()

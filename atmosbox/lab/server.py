"""The server of a page in which a scene runs: the page, and plans of boxes with other settings, for this computer only.

The engine runs in the page. Python only makes the plan of a box whose settings were changed, because it builds the box,
and evaluates its theory.
"""

from __future__ import annotations

import ipaddress
import json
import os
import secrets
import signal
import socketserver
import threading
from collections.abc import Callable, Mapping
from dataclasses import replace
from http.server import BaseHTTPRequestHandler
from typing import Any
from urllib.parse import parse_qs, urlsplit

from atmosbox.errors import AtmosboxError, Command, Given, Option, Setting, SettingError, on_command_line
from atmosbox.lab.page_file import lab_data, served_start
from atmosbox.lab.wasm_module import elsewhere
from atmosbox.page import lab_page
from atmosbox.page.lesson import lesson_of
from atmosbox.scene.spelling import field_name
from atmosbox.simulation.preparation import Prepared

HOST = "127.0.0.1"
PORT = 8642
"""The first port that is tried."""

_TRIES = 20
_ONE_AT_A_TIME = threading.Lock()  # a scene is watched while it builds its box, and must not see another's calls
_PATIENCE = 20.0  # s that a browser may take to send a request


def allowed(host: str | None, origin: str | None) -> bool:
    """Return whether a request with these headers Host and Origin comes from our own page.

    A page of another site can make the browser send requests to this computer; such a request has the other site in its
    header Origin. A domain name of another site can also be made to point to this computer; therefore only numeric
    addresses and localhost are accepted.

    >>> allowed("127.0.0.1:8642", "http://127.0.0.1:8642"), allowed("127.0.0.1:8642", "http://evil.example")
    (True, False)
    >>> allowed("evil.example:8642", "http://evil.example:8642")
    False
    """
    try:
        name = urlsplit(f"//{host}").hostname or ""
        named = name == "localhost" or bool(ipaddress.ip_address(name))
    except ValueError:
        named = False
    own = (f"http://{host}".casefold(), f"https://{host}".casefold())
    return named and (origin is None or origin.casefold() in own)


class Server(socketserver.ThreadingTCPServer):
    """A page and its plans, at a port of this computer: the given one, or the first free one from `PORT` on.

    The address must contain the ``token``, so that another account of the same computer cannot open the page; with None
    everybody on this computer is let in. A scene that cannot run in a page is refused, and a port that is in use.

    >>> from atmosbox.simulation.preparation import prepare
    >>> with Server(prepare("elastic-collisions", {"molecules": 10}), token="open-sesame") as server:
    ...     server.address.endswith(f":{server.server_address[1]}/?token=open-sesame")
    True
    """

    allow_reuse_address = os.name == "posix"  # elsewhere it would let two programs share a port
    daemon_threads = True

    def __init__(
        self, prepared: Prepared, *, port: int | None = None, token: str | None = None, language: str = "auto"
    ) -> None:
        self.written = prepared
        presets = [each.values for each in lesson_of(prepared.module).presets]
        self._texts = [text for values in (prepared.settings.as_dict(), *presets) for text in values.values()]
        self.token = token
        self.document = lab_page(*self._data(prepared), language=language, served=True)
        for number in range(PORT, PORT + _TRIES) if port is None else [port]:
            try:
                return super().__init__((HOST, number), _Answer)
            except OSError as error:
                problem = error
        if port is None:
            said = f"{PORT} to {PORT + _TRIES - 1}"
            raise SettingError("port", said, "are all in use", "end another program, or give a free ", Option("port"))
        remedy = "give another, or leave ", Option("port"), " out for a free one"
        raise SettingError("port", port, "is in use or not allowed", *remedy) from problem

    @property
    def address(self) -> str:
        """The address of the page."""
        return f"http://{HOST}:{self.server_address[1]}/{f'?token={self.token}' if self.token else ''}"

    def knows(self, said: list[str]) -> bool:
        """Return whether a request contains the token of the page."""
        return self.token is None or (len(said) == 1 and secrets.compare_digest(said[0].encode(), self.token.encode()))

    def plan(self, settings: Mapping[str, Any]) -> str:
        """Return the plan of a box with these settings, as JSON; refuse what cannot run in a page."""
        checked = type(self.written.settings)
        free = {told.name for told in checked.describe() if told.kind == "str" and not told.choices}
        for name, text in settings.items():  # a text may name a file, and reading it would tell what is in it
            if field_name(name) in free and text not in self._texts:
                raise SettingError(name, text, "cannot be chosen in the page", Command("live", (Setting(name, text),)))
        prepared = replace(self.written, settings=checked.from_user(settings))
        _, starts, module, stored = self._data(prepared)
        return json.dumps({"starts": starts, "module": module, "stored": stored})

    def _data(self, prepared: Prepared) -> tuple[Any, list[Any], str, str]:
        with _ONE_AT_A_TIME:
            start, module = served_start(prepared, self.written)
        return lab_data([start], module, prepared.scene, level=1)

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Leave a browser that has gone alone, and print nothing."""


def _in_page(given: Given) -> str:
    """Return how something is given in the page: a setting by its name there, all else on the command line."""
    return f"{given.name}={given.value}" if isinstance(given, Setting) else on_command_line(given)


class _Answer(BaseHTTPRequestHandler):
    """The answer to one request."""

    server: Server
    timeout = _PATIENCE

    def do_GET(self) -> None:
        """Send the page or a plan, or refuse the request."""
        if any(len(self.headers.get_all(name, [])) > 1 for name in ("Host", "Origin")):
            return self._send(400, "A request has one Host and one Origin.")
        if not allowed(self.headers["Host"], self.headers["Origin"]):
            return self._send(403, "This page is for this computer alone.")
        address = urlsplit(self.path)
        asked = parse_qs(address.query, keep_blank_values=True)
        if not self.server.knows(asked.get("token", [])):
            return self._send(403, "Take the whole address, with its token, from the terminal.")
        if address.path == "/":
            return self._send(200, self.server.document, "text/html")
        if address.path != "/plan":
            return self._send(404, "There is one page here, at /.")
        try:
            settings = {**json.loads(asked["settings"][0])}
        except (LookupError, TypeError, ValueError, RecursionError):
            return self._send(400, "A plan needs its settings as JSON.")
        try:
            return self._send(200, self.server.plan(settings), "application/json")
        except AtmosboxError as error:
            if any(isinstance(part, Option) and part.name == "engine" for part in error.remedy):
                error.remedy = elsewhere(self.server.written.scene)  # the page has one engine
            return self._send(422, error.said(_in_page))
        except Exception as error:
            return self._send(500, f"The box cannot be built ({type(error).__name__}: {error}).")

    def _send(self, status: int, text: str, kind: str = "text/plain") -> None:
        content = text.encode("utf-8")
        self.send_response_only(status)
        self.send_header("Content-Type", f"{kind}; charset=utf-8")
        self.send_header("Content-Length", str(len(content)))
        self.send_header("Cache-Control", "no-store")
        self.send_header("X-Frame-Options", "DENY")
        self.send_header("Referrer-Policy", "no-referrer")
        self.send_header("X-Content-Type-Options", "nosniff")
        self.end_headers()
        self.wfile.write(content)

    def log_message(self, *said: Any) -> None:
        """Print nothing."""


def ended(server: Server, opened: Callable[[], None]) -> int:
    """Serve a page until Ctrl-C or a request to end, and return that signal; call ``opened`` once it can be opened."""
    came: list[int] = []

    def end(number: int, frame: object) -> None:
        came.append(number)
        threading.Thread(target=server.shutdown).start()  # it waits until the server has ended

    before = {number: signal.signal(number, end) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        opened()
        server.serve_forever()
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    return came[0]

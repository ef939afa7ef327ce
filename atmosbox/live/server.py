"""The server of the local page: one port for the document and its socket, open to this computer only by default."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import http
import ipaddress
import json
import secrets
import signal
import socket
from collections.abc import Callable, Coroutine
from typing import Any
from urllib.parse import parse_qs, urlsplit

from websockets.asyncio.server import Server as SocketServer
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from atmosbox.errors import AtmosboxError, EngineError, Option, SettingError
from atmosbox.live.audience import Audience, Mailbox
from atmosbox.live.session import Session
from atmosbox.live.worker import GREET, JOIN, LEAVE, Worker

__all__ = ["PORT", "allowed", "loopback", "serve_session"]

PORT = 8642
"""The first port that is tried."""

_TRIES = 20
_LARGEST = 65_536
_PATIENCE = 1.0
_BUSY = (errno.EADDRINUSE, errno.EACCES)


def loopback(host: str) -> bool:
    """Return whether an address can be reached from this computer only.

    Examples
    --------
    >>> loopback("127.0.0.1"), loopback("localhost"), loopback("::1"), loopback("0.0.0.0")
    (True, True, True, False)
    """
    if host == "localhost":
        return True
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return False


def allowed(host: str | None, origin: str | None, *, names: frozenset[str] = frozenset()) -> bool:
    """Return whether a request comes from our own page.

    A page of another site can make the browser send requests to this computer; such a request has the other site in
    its header Origin. A domain name of another site can also be made to point to this computer; therefore only numeric
    addresses and the names of this computer are accepted.

    Parameters
    ----------
    host, origin
        The headers Host and Origin of the request.
    names
        The names of this computer, besides localhost and all numeric addresses.

    Examples
    --------
    >>> allowed("127.0.0.1:8642", "http://127.0.0.1:8642"), allowed("127.0.0.1:8642", "http://evil.example")
    (True, False)
    >>> allowed("evil.example:8642", "http://evil.example:8642")
    False
    """
    if host is None:
        return False
    try:
        name = urlsplit(f"//{host}").hostname or ""
        named = name == "localhost" or name in names or bool(ipaddress.ip_address(name))
    except ValueError:
        named = False
    if not named:
        return False
    return origin is None or origin.casefold() in (f"http://{host}".casefold(), f"https://{host}".casefold())


class _Service:
    """The open pages, and the thread in which the box runs."""

    def __init__(self, session: Session, document: str, names: frozenset[str], token: str | None) -> None:
        self._loop = asyncio.get_running_loop()
        self._audience = Audience()
        self._document = document.encode("utf-8")
        self._names = names
        self._token = token
        self.worker = Worker(session, self._publish)

    def _publish(self, page: int | None, message: str | bytes) -> None:
        with contextlib.suppress(RuntimeError):  # the event loop has ended
            self._loop.call_soon_threadsafe(self._audience.put, page, message)

    def request(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer a request with the document; return None if the request is for the socket."""
        headers = request.headers
        hosts, origins = headers.get_all("Host"), headers.get_all("Origin")
        if len(hosts) > 1 or len(origins) > 1:
            return connection.respond(http.HTTPStatus.BAD_REQUEST, "A request has one Host and one Origin.\n")
        host, origin = (found[0] if found else None for found in (hosts, origins))
        if not allowed(host, origin, names=self._names):
            return connection.respond(http.HTTPStatus.FORBIDDEN, "This page is for this computer alone.\n")
        path = urlsplit(request.path).path
        if not self._knows(request.path):
            said = "Only who knows the whole address may use this page: take it, with its token, from the terminal.\n"
            return connection.respond(http.HTTPStatus.FORBIDDEN, said)
        if path == "/socket":
            return None
        if path != "/":
            return connection.respond(http.HTTPStatus.NOT_FOUND, "There is one page here, at /.\n")
        answer = connection.respond(http.HTTPStatus.OK, "")
        answer.body = self._document
        for name, value in (
            ("Content-Type", "text/html; charset=utf-8"),
            ("Content-Length", str(len(self._document))),
            ("Cache-Control", "no-store"),
            ("X-Frame-Options", "DENY"),
            ("Referrer-Policy", "no-referrer"),
            ("X-Content-Type-Options", "nosniff"),
        ):
            with contextlib.suppress(KeyError):
                del answer.headers[name]
            answer.headers[name] = value
        return answer

    def _knows(self, address: str) -> bool:
        """Return whether the address of a request contains the token of the page."""
        if self._token is None:
            return True
        said = parse_qs(urlsplit(address).query).get("token", [""])
        return len(said) == 1 and secrets.compare_digest(said[0].encode(), self._token.encode())

    async def attend(self, connection: ServerConnection) -> None:
        """Serve one page until it disconnects."""
        box = self._audience.join()
        await asyncio.to_thread(self.worker.ask, box.number, JOIN)
        speaking = asyncio.create_task(self._speak(connection, box))
        try:
            async for message in connection:
                self._hear(box, message)
        except ConnectionClosed:
            pass
        finally:
            speaking.cancel()
            self._audience.leave(box)
            await asyncio.to_thread(self.worker.ask, box.number, LEAVE)

    async def _speak(self, connection: ServerConnection, box: Mailbox) -> None:
        with contextlib.suppress(ConnectionClosed):
            while True:
                await box.waiting.wait()
                if box.overrun:
                    box.overrun = False
                    box.take()
                    await asyncio.to_thread(self.worker.ask, box.number, GREET)
                    continue
                for message in box.take():
                    await connection.send(message)

    def _hear(self, box: Mailbox, message: str | bytes) -> None:
        """Pass on a message of a page, or answer that it cannot be understood."""
        try:
            asked = json.loads(message) if isinstance(message, str) else None
        except (ValueError, RecursionError):
            asked = None
        if not isinstance(asked, dict):
            return self._refuse(box, "What this page has said is no request: reload it.")
        if not self.worker.ask(box.number, asked):
            self._refuse(box, "The box is busy, and so many requests wait already that this one was left out.")
        return None

    def _refuse(self, box: Mailbox, text: str) -> None:
        box.put(json.dumps({"type": "note", "level": "error", "text": text}))


async def _listen(service: _Service, host: str, port: int | None) -> SocketServer:
    """Open the requested port, or the first free one."""
    ports = [PORT + k for k in range(_TRIES)] if port is None else [port]
    for number in ports:
        try:
            return await serve(
                service.attend,
                host,
                number,
                process_request=service.request,
                compression=None,
                max_size=_LARGEST,
                close_timeout=_PATIENCE,
                server_header=None,
            )
        except OSError as error:
            if isinstance(error, socket.gaierror) or error.errno == errno.EADDRNOTAVAIL:
                raise SettingError("host", host, "is no address of this computer", "give 127.0.0.1") from error
            if error.errno not in _BUSY and "address already in use" not in str(error):
                raise
    if port is None:
        said = f"{PORT} to {ports[-1]}"
        raise SettingError(
            "port", said, "are all in use", "end another program, or give ", Option("port"), " with a free one"
        )
    raise SettingError(
        "port", port, "is in use or not allowed", "give another, or leave ", Option("port"), " out for a free one"
    )


async def _signal() -> int:
    """Wait for Ctrl-C or a request to end, and return the signal."""
    loop = asyncio.get_running_loop()
    ended: asyncio.Future[int] = loop.create_future()

    def note(number: int) -> None:
        if not ended.done():
            ended.set_result(number)

    def end(number: int, frame: object) -> None:
        loop.call_soon_threadsafe(note, number)

    before = {number: signal.signal(number, end) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        return await ended
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


async def serve_session(
    session: Session,
    document: str,
    ending: Callable[[], Coroutine[Any, Any, int]] = _signal,
    *,
    host: str = "127.0.0.1",
    port: int | None = None,
    token: str | None = None,
    opened: Callable[[str, int], None],
) -> tuple[int, list[str]]:
    """Serve a session until `ending` returns, and save the recording.

    Parameters
    ----------
    session
        The session to serve.
    document
        The HTML of the page.
    ending
        Function that waits for the end, and returns the signal that ended the server; by default the end is Ctrl-C or
        a request to end.
    host, port
        Address and port; if no port is given, the first free one from `PORT` on.
    token
        Text that the address of the page must contain, ``?token=...``, so that another account of the same
        computer cannot control the box; with None everybody who can reach the port is let in.
    opened
        Function that is called with the address of the page and the port when the page can be opened.

    Returns
    -------
    (int, list of str)
        The signal that ended the server, and the remaining messages to print.

    Raises
    ------
    SettingError
        If the port is in use, or the host is not an address of this computer.
    EngineError
        If the engine cannot go on.
    """
    names = frozenset({host.casefold(), socket.gethostname().casefold()}) - {""}
    service = _Service(session, document, names, token)
    server = await _listen(service, host, port)
    ended = asyncio.create_task(ending())
    try:
        service.worker.start()
        number = int(next(iter(server.sockets)).getsockname()[1])
        own = {"": "127.0.0.1", "0.0.0.0": "127.0.0.1", "::": "::1"}.get(host, host)
        shown = f"[{own}]" if ":" in own else own
        opened(f"http://{shown}:{number}/{f'?token={token}' if token else ''}", number)
        while not ended.done() and service.worker.alive:
            await asyncio.wait([ended], timeout=0.5)
    finally:
        left = await asyncio.to_thread(service.worker.stop)
        server.close(close_connections=True)
        await server.wait_closed()
    failure = service.worker.failure
    if failure is not None:
        ended.cancel()
        if isinstance(failure, AtmosboxError):
            raise failure
        raise EngineError(f"The session has ended ({type(failure).__name__}: {failure}).") from failure
    return ended.result(), left

"""The server of a page, and simulated browsers."""

import asyncio
import json
import signal
import threading
import time
from contextlib import contextmanager

import pytest
from websockets.sync.client import connect

from atmosbox.live import Session
from atmosbox.live.server import serve_session
from atmosbox.simulation.preparation import prepare

PATIENCE = 20.0


class Visitor:
    """A simulated browser that draws nothing."""

    def __init__(self, socket):
        self.socket = socket
        self.pictures = []

    def say(self, message):
        self.socket.send(message if isinstance(message, str | bytes) else json.dumps(message))

    def hear(self, kind, is_so=lambda message: True):
        """Return the next message of a kind that meets a condition; pictures before it are kept."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            message = self.socket.recv(timeout=end - time.monotonic())
            if isinstance(message, bytes):
                self.pictures = [*self.pictures[-100:], message]
                if kind == "picture":
                    return message
                continue
            message = json.loads(message)
            if message["type"] == kind and is_so(message):
                return message
        raise AssertionError(f"no {kind} in {PATIENCE} s")


class Site:
    """A server that runs in a thread."""

    def __init__(self, session, document="<!doctype html><title>box</title>", **where):
        self.session = session
        self._document = document
        self.left = None
        self._where = where
        self._stop = threading.Event()
        self._ready = threading.Event()
        self.failure = None
        self._thread = threading.Thread(target=self._serve)

    def _serve(self):
        def opened(address, port):
            self.address, self.port = address, port
            self._ready.set()

        async def ending():
            await asyncio.to_thread(self._stop.wait)
            return int(signal.SIGINT)

        try:
            _, self.left = asyncio.run(
                serve_session(self.session, self._document, ending, opened=opened, **self._where)
            )
        except Exception as error:
            self.failure = error
        finally:
            self._ready.set()

    def __enter__(self):
        self._thread.start()
        self._ready.wait()
        if self.failure is not None:
            self._thread.join()
            raise self.failure
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()

    @contextmanager
    def visit(self, **options):
        with connect(f"ws://127.0.0.1:{self.port}/socket", max_size=2**24, close_timeout=1, **options) as socket:
            yield Visitor(socket)


@pytest.fixture
def site(tmp_path):
    """A site of a hundred molecules between warm walls."""
    session = Session(prepare("temperature", {"molecules": 100, "duration": "2 ns"}), folder=tmp_path)
    with Site(session) as served:
        yield served


@pytest.fixture
def serve():
    """A context manager that serves a session."""
    return Site

"""The thread in which the box runs: it takes the requests of the pages, and publishes messages to them."""

from __future__ import annotations

import json
import math
import queue
import threading
import time
from collections.abc import Callable
from typing import Any

from atmosbox.errors import AtmosboxError
from atmosbox.live.session import Session
from atmosbox.simulation.compilation import told

__all__ = ["GREET", "JOIN", "LEAVE", "Publish", "Worker"]

Publish = Callable[[int | None, str | bytes], None]
"""Function that is called with the number of a page, or None for all pages, and a message."""

JOIN, LEAVE, GREET = "join", "leave", "greet"
"""Requests of the server itself: a page has connected, has disconnected, or must get everything anew."""
PICTURES = 30.0
"""Number of pictures per second."""
_BUDGET = 0.75
_MEASURE_EVERY, _MEASURE_SHARE, _MEASURE_LATEST = 0.25, 0.1, 2.0
_STATE_EVERY = 0.5
_WAITING = 500
_BUILDING = ("reset", "preset", "pump", "undo")


class Worker:
    """Runs a session, 30 pictures a second.

    While no page is open the box is paused, unless it is being recorded.

    Parameters
    ----------
    session
        The session to run; from now on no other thread may use it.
    publish
        Function that takes the messages for the pages; called from this thread.

    Attributes
    ----------
    failure
        The exception that ended the thread; None if there was none.
    """

    def __init__(self, session: Session, publish: Publish) -> None:
        self._session = session
        self._publish = publish
        self._requests: queue.Queue[tuple[int, dict[str, Any] | str]] = queue.Queue(_WAITING)
        self._pages: set[int] = set()
        self._stopping = threading.Event()
        self._thread = threading.Thread(target=self._live, name="atmosbox live", daemon=True)
        self._last_state: dict[str, Any] = {}
        self._last_values: dict[str, Any] = {}
        self._rate = 0.0
        self.failure: BaseException | None = None

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def ask(self, page: int, message: dict[str, Any] | str) -> bool:
        """Queue a request, a dict of a page or a text of the server; return whether the queue had room for it."""
        try:
            self._requests.put((page, message), block=isinstance(message, str), timeout=5.0)
        except queue.Full:
            return False
        return True

    def stop(self) -> list[str]:
        """Stop the thread and save the recording; return the remaining messages."""
        self._stopping.set()
        self._thread.join()
        self._session.stop_recording()
        return [note["text"] for note in self._session.notes()]

    @property
    def alive(self) -> bool:
        """Whether the thread is running."""
        return self._thread.is_alive()

    # ------------------------------------------------------------------ in the thread

    def _live(self) -> None:
        try:
            self._work()
        except BaseException as error:
            self.failure = error

    def _work(self) -> None:
        session, now = self._session, time.perf_counter
        period = 1.0 / PICTURES
        due = measured = told = now()
        pause = _MEASURE_EVERY
        pictures: list[float] = []
        unmeasured = False
        while not self._stopping.is_set():
            touched = self._obey(max(0.0, due - now()))
            if now() < due and not touched:
                continue
            running = session.playing and bool(self._pages or session.recording)
            if running:
                session.run(period, _BUDGET * period)
            if running or touched:
                self._publish(None, session.frame())
                pictures = [t for t in pictures if t > now() - 2.0] + [now()]
            due = max(due + period, now())
            unmeasured = unmeasured or running or touched
            if unmeasured and now() - measured > pause:  # also once after the box has stopped
                unmeasured = False
                begun = now()
                for message in session.measured():
                    self._tell(None, message)
                measured = now()
                pause = min(max(_MEASURE_EVERY, (measured - begun) / _MEASURE_SHARE), _MEASURE_LATEST)
            for note in session.notes():
                self._tell(None, note)
                touched = True
            if touched or now() - told > _STATE_EVERY:
                self._rate = round((len(pictures) - 1) / (pictures[-1] - pictures[0]), 1) if len(pictures) > 2 else 0.0
                self._tell_state(None, running)
                told = now()

    def _obey(self, patience: float) -> bool:
        """Carry out the requests, after waiting at most `patience` [s]; return whether a page has sent one."""
        touched = False
        stage = self._session.picture
        while True:
            try:
                page, message = self._requests.get(timeout=patience) if patience else self._requests.get_nowait()
            except queue.Empty:
                break
            patience = 0.0
            if message == LEAVE:
                self._pages.discard(page)
            elif isinstance(message, str):
                self._pages.add(page)
                self._greet(page)
            else:
                touched = True
                self._do(page, message)
        if self._session.picture is not stage:
            for page in self._pages:
                self._greet(page)
        elif touched:
            self._tell_controls()
        return touched

    def _tell_controls(self) -> None:
        """Send the controls to all pages, if a value has changed."""
        found = self._session.controls()
        values = {control.name: control.value for control in found}
        if values != self._last_values:
            self._last_values = values
            self._tell(None, {"type": "controls", "controls": [control.record() for control in found]})

    def _do(self, page: int, message: dict[str, Any]) -> None:
        session = self._session
        waits = message.get("type") in _BUILDING or any(
            control.restarts for control in session.controls() if control.name == message.get("name")
        )
        if waits:
            self._say_busy("The box is being built.")
        try:
            with told(session.prepared, self._say_compiling):
                session.obey(message)
        except AtmosboxError as error:
            self._tell(page, {"type": "note", "level": "error", "text": session.said(error)})

    def _say_busy(self, words: str) -> None:
        """Tell all pages why they wait; the next state message removes this."""
        self._tell(None, {"type": "state", "busy": words})
        self._last_state = {}

    def _say_compiling(self, share: float, words: str) -> None:
        self._say_busy(f"The box is being built: {words}.")

    def _greet(self, page: int) -> None:
        """Send all present data to a page."""
        session = self._session
        stage = session.stage()
        stage["state"] |= {"rate": self._rate, "busy": None}
        self._tell(page, stage)
        for message in session.report.everything():
            self._tell(page, message)
        self._publish(page, session.frame())
        self._tell(page, self._state(session.playing))

    def _state(self, running: bool) -> dict[str, Any]:
        return {**self._session.state(), "rate": self._rate if running else 0.0, "busy": None}

    def _tell_state(self, page: int | None, running: bool) -> None:
        state = self._state(running)
        if state != self._last_state:
            self._tell(page, state)
            self._last_state = state

    def _tell(self, page: int | None, message: dict[str, Any]) -> None:
        self._publish(page, json.dumps(_finite(message), allow_nan=False))


def _finite(told: Any) -> Any:
    """Return a message as JSON can hold it: numbers that are not finite become null."""
    if isinstance(told, dict):
        return {name: _finite(value) for name, value in told.items()}
    if isinstance(told, list | tuple):
        return [_finite(value) for value in told]
    return None if isinstance(told, float) and not math.isfinite(told) else told

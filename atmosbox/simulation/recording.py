"""A run in progress: its box advances from frame to frame, and its instruments measure."""

from __future__ import annotations

import contextlib
import signal
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.scene.headline import Headline
from atmosbox.scene.instruments import Instrument, Molecules, Readings
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared, keeps_molecules
from atmosbox.simulation.verification import with_bias

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.engine import Snapshot


@contextlib.contextmanager
def uninterrupted() -> Iterator[None]:
    """Delay Ctrl-C, and a request to end, until this block is complete.

    >>> try:
    ...     with uninterrupted():
    ...         signal.raise_signal(signal.SIGINT)
    ...         print("complete")
    ... except KeyboardInterrupt:
    ...     print("stopped")
    complete
    stopped
    """
    came: list[int] = []
    known = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    numbers = known if threading.current_thread() is threading.main_thread() else []
    # None is a handler that was not set from Python, and could not be restored
    before = {number: handler for number in numbers if (handler := signal.getsignal(number)) is not None}
    try:
        for number in before:
            signal.signal(number, lambda which, frame: came.append(which))
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    for which in came:
        signal.raise_signal(which)


@dataclass
class Recording:
    """A run in progress: its box, its instruments, and the times of its frames."""

    prepared: Prepared
    setup: Setup
    attributes: dict[str, Any]
    times: list[float] = field(default_factory=lambda: [0.0])
    seconds: float = 0.0
    """Time that the run has taken."""
    busy: float = 0.0
    """Processor time of the engine in it."""
    sampled: int = 0
    turned: int = 0
    """Number of turns of knobs that were made, of those of the link."""
    instruments: tuple[Instrument, ...] = field(init=False)

    def __post_init__(self) -> None:
        extra = (Molecules(self.setup.right),) if keeps_molecules(self.prepared, self.setup) else ()
        self.instruments = (*self.setup.instruments, *extra)

    @property
    def frames(self) -> int:
        """Number of complete frames."""
        return len(self.times) - 1

    def advance(self, watch: Callable[[float], None]) -> None:
        """Advance to the end of the frame and measure; an interrupted frame continues with its next sample.

        An interrupt comes before all instruments or after all: what only some of them have seen could not be saved.
        """
        parcel = self.setup.parcel
        frame, began = self.frames, time.perf_counter()
        snapshot: Snapshot | None = None
        self._turn_knobs()
        for sample in range(self.sampled + 1, self.setup.samples + 1):
            busy = time.process_time()
            parcel.advance(max(self.setup.moment(frame, sample), parcel.time), watch)
            self.busy += time.process_time() - busy
            snapshot = parcel.snapshot()
            with uninterrupted():
                for instrument in self.instruments:
                    instrument.sample(parcel, snapshot)
                self.sampled += 1
        last = parcel.snapshot() if snapshot is None else snapshot
        with uninterrupted():
            for instrument in self.instruments:
                instrument.end_frame(parcel, last)
            self.times.append(parcel.time)
            self.sampled = 0
        self.seconds += time.perf_counter() - began

    def _turn_knobs(self) -> None:
        """Turn the knobs that the link of the run turns before this frame."""
        replay = self.prepared.replay
        if replay is None:
            return
        knobs = {knob.name: knob for knob in self.setup.knobs}
        with uninterrupted():
            while self.turned < len(replay.turns) and replay.turns[self.turned].frame <= self.frames:
                turn = replay.turns[self.turned]
                knobs[turn.name].reset() if turn.value is None else knobs[turn.name].set(turn.value)
                self.turned += 1

    def dataset(
        self, status: str, *, settle: int | None = None, judged: bool = True
    ) -> tuple[xr.Dataset, tuple[Headline, ...]]:
        """Return all that has been measured so far, with the values of the theory.

        Averages leave out `settle` frames; by default the number that the scene sets, after the last turn of a knob.
        The scene's headlines are computed if they are to be `judged`; there are none if a knob was turned.
        """
        from atmosbox.file.dataset import dataset, extended
        from atmosbox.file.variables import Variable

        setup, settings, module = self.setup, self.prepared.settings, self.prepared.module
        own = {
            name: Variable(name, tuple(dims.split()), unit, words)
            for name, (dims, unit, words) in getattr(module, "variables", {}).items()
        }
        in_unit = setup.scale.time / {"s": 1.0, "ns": 1e-9, "ps": 1e-12}[setup.time_unit]
        times = np.array(self.times) * in_unit
        readings = Readings()
        turns = () if self.prepared.replay is None else self.prepared.replay.turns[: self.turned]
        last = turns[-1].frame if turns else 0
        rest = min(last + setup.settle if settle is None else settle, max(self.frames - 2, 0))
        judged = judged and not turns
        for instrument in self.instruments:
            readings.update(instrument.readings(setup.scale, rest))
        binned = ("height", "speed", "energy", "distance")
        names = ("radius", "mode", *binned, *(f"{name}_bnds" for name in binned))
        coords = {name: readings.pop(name) for name in names if name in readings}
        coords["elapsed_time"] = times[1:]
        coords["elapsed_time_bnds"] = np.stack([times[:-1], times[1:]], axis=1)
        attributes = self.attributes | {"atmosbox_status": status}
        measured = dataset(readings, coords, attributes, time_unit=setup.time_unit, own=own)
        if self.frames < 2:
            return measured, ()
        try:
            expected = module.theory(measured, settings)
            if not isinstance(expected, dict):
                raise TypeError(f"theory returns a {type(expected).__name__}, and not a dict of arrays")
            full = extended(measured, expected, own=own)
            if not judged:
                return full, ()
            headlines = module.headlines(full, settings)
            if not isinstance(headlines, tuple) or not all(isinstance(each, Headline) for each in headlines):
                raise TypeError(f"headlines returns {headlines!r:.60}, and not a tuple of Headline")
            headlines = with_bias(headlines, self.prepared.parameters)
            return extended(full, {}, headlines), headlines
        except (ArithmeticError, LookupError, ValueError):
            if status == "complete" and self.prepared.replay is None:
                raise
            return measured, ()  # too short for its theory, but worth keeping

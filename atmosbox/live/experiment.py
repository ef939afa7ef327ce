"""One box with its instruments, advanced in small steps of time."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.engine import StalledError
from atmosbox.errors import EngineError
from atmosbox.scene.instruments import Instrument, Speeds
from atmosbox.simulation.preparation import Prepared, build
from atmosbox.simulation.recording import Recording

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.scene.panels import Panel

__all__ = ["Experiment"]

_CROSSINGS = 4.0
_WHOLE = 60.0
_PIECE = 0.01
_WINDOW = 6000


class Experiment:
    """A box with its instruments, from its start on.

    However its time is divided into steps, a box that is not changed does the same as in ``atmosbox run``. The graphs
    show the measurements of instruments that start anew after each change and, in a box without a planned end, from
    time to time; in an ascent they measure from its start to its end.

    Parameters
    ----------
    prepared
        The scene.
    clock
        Function that returns the time [s].

    Attributes
    ----------
    setup
        The box.
    panels
        The graphs of the scene.
    now
        Time of the box [reduced time].
    frame
        Number of complete frames.
    rate
        Time of the box that passes in a second at the usual pace [reduced time]: a molecule crosses the box about four
        times in a second, but the whole run lasts at least a minute; an ascent lasts exactly a minute.

    Raises
    ------
    AtmosboxError
        If the box cannot be built.

    Examples
    --------
    >>> import time
    >>> from atmosbox.simulation.preparation import prepare
    >>> discs = Experiment(prepare("elastic-collisions", {"molecules": 10}), time.perf_counter)
    >>> discs.pass_time(2.5 * discs.setup.frame, math.inf, tuple, lambda: True)
    >>> discs.frame, discs.between_frames
    (2, False)
    """

    def __init__(self, prepared: Prepared, clock: Callable[[], float]) -> None:
        self.prepared = prepared
        self.setup = build(prepared)
        try:
            self.setup.parcel.advance(0.0)
        except StalledError as error:
            raise EngineError(f"The box of {prepared.scene} cannot begin: {error}.") from error
        panels = prepared.module.panels
        self.panels: tuple[Panel, ...] = tuple(panels(prepared.settings) if callable(panels) else panels)
        self.now = 0.0
        self.frame = 0
        self.rate = self._usual_rate()
        self._look = 1
        self._clock = clock
        self._speed = math.nan
        self._stale = False
        self._warmest = float(np.nan_to_num(self.setup.parcel.wall_kT()).max())
        self._fresh = tuple(_copied(instrument) for instrument in self.setup.instruments)
        self.gauges = [self.recording()]

    def _usual_rate(self) -> float:
        setup, parcel = self.setup, self.setup.parcel
        whole = setup.duration / _WHOLE
        if setup.ends or not parcel.number:
            return whole
        kT = 2.0 * parcel.energy()[0] / (3.0 * parcel.number)
        speed = math.sqrt(8.0 / math.pi * float(np.nanmax([kT, *parcel.wall_kT()])) / float(np.mean(parcel.mass)))
        sides = parcel.length[[0, 2]] if parcel.planar else parcel.length
        side = float(np.exp(np.log(sides).mean()))
        return min(whole, _CROSSINGS * side / speed) if speed > 0.0 else whole

    # ------------------------------------------------------------------ instruments

    @property
    def between_frames(self) -> bool:
        """Whether a frame has just been completed, so that a recording can begin."""
        return self._look == 1 and self.now == self.frame * self.setup.frame

    def recording(self, attributes: dict[str, Any] | None = None) -> Recording:
        """Return instruments that begin to measure now, between two frames.

        Parameters
        ----------
        attributes
            The global attributes of the file, for a recording; None for the instruments of the graphs.
        """
        prepared = self.prepared
        about = {"atmosbox_parameters": json.dumps(prepared.parameters)} if attributes is None else attributes
        if attributes is None and not self.setup.ends:  # graphs need no molecules
            prepared = replace(prepared, save_molecules=False)
        fresh = tuple(self._fitting(instrument) for instrument in self._fresh)
        return Recording(prepared, self.setup, about, first=self.frame, instruments=fresh)

    def _fitting(self, instrument: Instrument) -> Instrument:
        """Return an instrument without samples; a histogram of speeds has the range that heated walls need."""
        warmest = np.nan_to_num(self.setup.parcel.wall_kT()).max()
        if isinstance(instrument, Speeds) and warmest > self._warmest > 0.0:
            return instrument.wider(math.sqrt(warmest / self._warmest))
        return _copied(instrument)

    def begin_averages_anew(self) -> None:
        """Begin the averages of the graphs anew at the next frame, because something has been changed."""
        self._stale = True

    def measured(self, changed: int) -> xr.Dataset | None:
        """Return the data of the graphs, averaged over the frames after frame `changed`; None if they are too few."""
        gauge = self.gauges[0]
        if gauge.frames < 2:
            return None
        since = 0 if self.setup.ends else changed
        found, _ = gauge.dataset("live", settle=max(since + self.setup.settle - gauge.first, 0), judged=False)
        return found

    # ------------------------------------------------------------------ time

    def pass_time(
        self,
        goal: float,
        budget: float,
        also: Callable[[], Sequence[Recording]],
        closed: Callable[[], bool],
    ) -> None:
        """Advance the box.

        Parameters
        ----------
        goal
            The time of the box at which to stop [reduced time].
        budget
            Computing time after which to return in any case [s].
        also
            Function that returns recordings of the box besides those of the graphs.
        closed
            Function that is called when a frame is complete; it returns whether to go on.

        Raises
        ------
        StalledError
            If the engine cannot go on.
        """
        begun = self._clock()
        while self.now < goal:
            due = self.setup.moment(self.frame, self._look)
            piece = (goal - self.now) / 8.0 if math.isnan(self._speed) else _PIECE * self._speed
            self._advance(min(goal, due, self.now + max(piece, 1e-6 * self.setup.frame)))
            if self.now >= due and self._measure(also()) and not closed():
                break
            if self._clock() - begun > budget:
                break

    def _advance(self, until: float) -> None:
        parcel = self.setup.parcel
        before = self._clock()
        parcel.advance(max(until, parcel.time))
        spent = self._clock() - before
        if spent > 0.0:
            speed = (until - self.now) / spent
            self._speed = speed if math.isnan(self._speed) else self._speed + 0.3 * (speed - self._speed)
        self.now = until

    def _measure(self, also: Sequence[Recording]) -> bool:
        """Let the instruments sample the box; return whether a frame is complete."""
        snapshot = self.setup.parcel.snapshot()
        watching = [*self.gauges, *(recording for recording in also if recording not in self.gauges)]
        for recording in watching:
            recording.sample(snapshot)
        self._look += 1
        if self._look <= self.setup.samples:
            return False
        for recording in watching:
            recording.end_frame(snapshot)
        self.frame += 1
        self._look = 1
        if not self.setup.ends:
            self._renew_gauges()
        self._stale = False
        return True

    def _renew_gauges(self) -> None:
        """Start new instruments when it is time; two sets overlap, so that one always has enough frames."""
        if self._stale:
            self.gauges = [self.recording()]
        elif len(self.gauges) == 1 and self.gauges[0].frames >= _WINDOW // 2:
            self.gauges.append(self.recording())
        elif self.gauges[0].frames >= _WINDOW:
            del self.gauges[0]


def _copied(instrument: Instrument) -> Instrument:
    """Return a copy of an instrument, for the same box but with samples of its own."""
    twin = copy.copy(instrument)
    for name, value in vars(instrument).items():
        if isinstance(value, list | dict | set | np.ndarray):
            setattr(twin, name, copy.deepcopy(value))
    return twin

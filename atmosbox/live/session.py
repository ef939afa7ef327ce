"""A box for a class: it runs, is changed by hand, measured and recorded. No socket is needed."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from atmosbox.engine import StalledError
from atmosbox.errors import AtmosboxError, Given, Setting, SettingError, on_command_line
from atmosbox.live import hand
from atmosbox.live.control import COLLISIONS, Control, in_words, number_between
from atmosbox.live.experiment import Experiment
from atmosbox.live.gauge import gauges_of, readings
from atmosbox.live.hand import Hand, begun_anew, with_collisions
from atmosbox.live.lesson import lesson_of
from atmosbox.live.picture import Picture
from atmosbox.live.recorder import Recorder, longest
from atmosbox.live.summary import Report, while_it_runs
from atmosbox.live.tape import Change
from atmosbox.scene.settings import Value
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared

__all__ = ["Session"]

SLOWEST, FASTEST = 0.25, 16.0
_STEP = 0.04
_DRAG = 1.5  # s; moves of one slider within this time count as one change
_MOST_PAST = 200
_PUMP = 4.0  # largest factor by which one stroke of the pump changes the number of molecules, up or down


@dataclass(frozen=True)
class _Past:
    """The state before a change, for undo: the value of a knob, or the settings and engine of the box.

    ``first`` says whether the knob had not been turned before in the box with the number ``box``.
    """

    knob: str | None
    value: Value
    settings: Mapping[str, Any]
    engine: str
    when: float
    first: bool = False
    box: int = 0


class Session:
    """A box with its instruments, advanced in small steps, that carries out the requests of the page.

    However its time is divided into steps, a box that is not changed does the same as in ``atmosbox run``.

    Parameters
    ----------
    prepared
        The scene.
    folder
        Folder of the recordings.
    out
        Name of the first recording, if one was given.
    force
        Whether recordings may replace files.
    command
        The command that the user typed, for the history of the file.
    clock
        Function that returns the time [s].

    Attributes
    ----------
    playing
        Whether the box runs.
    pace
        Factor by which the box runs faster than usual.
    finished
        Whether the box is paused at the end of its planned ascent.

    Raises
    ------
    AtmosboxError
        If the box cannot be built.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> session = Session(prepare("elastic-collisions", {"molecules": 10}))
    >>> session.obey({"type": "play"})
    >>> session.run(0.1)
    >>> session.state()["playing"], session.state()["time"] > 0.0
    (True, True)
    """

    def __init__(
        self,
        prepared: Prepared,
        *,
        folder: Path = Path(),
        out: str | None = None,
        force: bool = False,
        command: str = "",
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._clock = clock
        self.playing = False
        self.pace = 1.0
        self._notes: list[dict[str, str]] = []
        self._past: list[_Past] = []
        self._boxes = 0
        self._gauges: list[dict[str, Any]] = []
        self.lesson = lesson_of(prepared.module)
        self._recorder = Recorder(folder, out, force, command or f"atmosbox live {prepared.scene}", self.note)
        self._begin(prepared)

    # ------------------------------------------------------------------ a box

    def _begin(self, prepared: Prepared) -> None:
        """Build a box, which replaces the one before."""
        experiment = Experiment(prepared, self._clock)
        shown = tuple(panel for panel in map(while_it_runs, experiment.panels) if panel is not None)
        picture = Picture(prepared, experiment.setup, shown)
        self._recorder.stop("The box begins anew, and the recording ends.")
        self._boxes += 1
        self.experiment = experiment
        self.picture = picture
        self.report = Report(shown, picture.stage.variables)
        self.finished = False
        self._sequence = 0
        self._hand = Hand(experiment.setup)
        self._gauges = []

    @property
    def prepared(self) -> Prepared:
        """The scene, with the settings with which the box was started."""
        return self.experiment.prepared

    @property
    def setup(self) -> Setup:
        """The box."""
        return self.experiment.setup

    @property
    def changes(self) -> list[Change]:
        """The changes made with knobs, in order."""
        return self._hand.changes

    # ------------------------------------------------------------------ time

    def run(self, seconds: float, budget: float | None = None) -> None:
        """Advance the box, if it is playing.

        Parameters
        ----------
        seconds
            Time that passes for the class [s]; the time of the box follows from its rate and pace.
        budget
            Computing time after which to return in any case [s].
        """
        if self.playing:
            self._go_on(seconds, math.inf if budget is None else budget)

    def _go_on(self, seconds: float, budget: float) -> None:
        box = self.experiment
        try:
            box.pass_time(box.now + seconds * box.rate * self.pace, budget, self._recorder.watching, self._closed)
        except StalledError as error:
            self.playing = False
            self.note("error", f"The box cannot go on: {error}. Begin anew.")

    def _closed(self) -> bool:
        """Record a frame; pause at the end of an ascent, or when no more can be kept. Return whether to go on."""
        self._recorder.closed(self.experiment, self.changes)
        frame = self.experiment.frame
        if self.setup.ends and frame == self.setup.frames:
            self.finished = True
            self.playing = False
            names = [name for name in self._hand.names if name in ("altitude", "way")]
            lead = f"; move the parcel on with {names[0]}" if names else ""
            self.note("info", f"The parcel has reached the end of its path{lead}, or begin anew.")
            return False
        if self.setup.ends and frame >= longest(self.experiment):
            self.playing = False
            self.note("warning", f"This path is {frame} frames long, which is all that is kept: begin anew.")
            return False
        return True

    # ------------------------------------------------------------------ requests of the page

    def obey(self, message: Mapping[str, Any]) -> None:
        """Carry out a request of the page.

        Parameters
        ----------
        message
            Its ``type`` is play, pause, step, reset, pace, set, preset, pump, undo, record or stop_record.

        Raises
        ------
        AtmosboxError
            If the request is not possible; nothing has changed then.
        """
        kind = message.get("type")
        if kind == "play":
            self.playing, self.finished = True, False
        elif kind == "pause":
            self.playing = False
        elif kind == "step":
            self.playing = False
            self._go_on(_STEP, math.inf)
        elif kind == "reset":
            self._reset(message.get("seed"))
        elif kind == "pace":
            self.pace = number_between(message.get("value"), "pace", SLOWEST, FASTEST)
        elif kind == "set":
            self._set(message.get("name"), message.get("value"))
        elif kind == "preset":
            self._preset(message.get("number"))
        elif kind == "pump":
            self._pump(message.get("factor"))
        elif kind == "undo":
            self._undo()
        elif kind == "record":
            self._recorder.start(message.get("file"), self.experiment, self.changes)
        elif kind == "stop_record":
            self.stop_recording()
        else:
            known = "play, pause, step, reset, pace, set, preset, pump, undo, record or stop_record"
            raise SettingError("type", in_words(kind), "cannot be asked for by this page", f"give {known}")

    def said(self, error: AtmosboxError) -> str:
        """Return the sentence of an error in the words of the page: a setting has the name that stands beside it."""
        names = {control.name: control.parameter.help for control in self.controls()}

        def words(given: Given) -> str:
            if isinstance(given, Setting):
                return f"{names.get(given.name, given.name)} = {given.value}"
            return on_command_line(given)

        if isinstance(error, SettingError):
            error.name = names.get(error.name, error.name)
        return error.said(words)

    def _reset(self, seed: object) -> None:
        values: dict[str, Any] = self._hand.settings(self.prepared)
        if seed is not None:
            values["seed"] = seed
        self._anew(values, str(self.prepared.engine))

    def _anew(self, values: Mapping[str, Any], engine: str) -> None:
        """Restart the box with these settings, and remember the state before."""
        before = _Past(None, 0.0, self._hand.settings(self.prepared), str(self.prepared.engine), self._clock())
        self._begin(begun_anew(self.prepared, values, engine))
        self._remember(before)

    def _remember(self, before: _Past) -> None:
        self._past = [*self._past[1 - _MOST_PAST :], before]

    def _preset(self, number: object) -> None:
        """Restart the box with the settings of a preset, and the scene's defaults for the rest; the seed stays."""
        presets = self.lesson.presets
        if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(presets):
            raise SettingError("number", in_words(number), "is no set of settings", f"give 0 to {len(presets) - 1}")
        values = {"seed": self.prepared.settings.as_dict()["seed"], **presets[number].values}
        self._anew(values, str(self.prepared.engine))

    def _pump(self, factor: object) -> None:
        """Restart the box with more or fewer molecules in the same volume."""
        if not self.lesson.pump:
            raise SettingError("type", "pump", "is not offered by this scene", "change the number of molecules")
        by = number_between(factor, "factor", 1.0 / _PUMP, _PUMP)
        values = self._hand.settings(self.prepared)
        declared = {parameter.name: parameter for parameter in self.prepared.settings.describe()}
        for name in self.lesson.pump:
            new = float(values[name]) * by
            values[name] = round(new) if declared[name].kind == "int" else float(f"{new:.6g}")
        self._anew(values, str(self.prepared.engine))
        number = self.setup.parcel.number
        self.note(
            "info",
            f"The box begins anew with {number} molecules in the same volume: "
            "the engine cannot add any to a box that runs.",
        )

    def _undo(self) -> None:
        """Undo the last change."""
        if not self._past:
            self.note("info", "There is nothing to take back.")
            return
        last = self._past[-1]
        if last.knob is None:
            self._begin(begun_anew(self.prepared, last.settings, last.engine))
        else:
            control = next(each for each in self.controls() if each.name == last.knob)
            if last.first and last.box != self._boxes and self._hand.changes_more(control):
                self._begin(
                    begun_anew(
                        self.prepared,
                        self._hand.settings(self.prepared) | {control.name: last.value},
                        str(self.prepared.engine),
                    )
                )
            else:
                self._turn(control, last.value, back=last.first and last.box == self._boxes)
        self._past.pop()

    def _set(self, name: object, value: object) -> None:
        control = next((each for each in self.controls() if each.name == name), None)
        if control is None:
            known = ", ".join(each.name for each in self.controls())
            raise SettingError("name", in_words(name), "cannot be changed here", f"give one of {known}")
        wanted = control.parse(value)
        if not control.restarts:
            first = control.name not in self._hand.turned
            before = _Past(control.name, control.value, {}, "", self._clock(), first, self._boxes)
            self._turn(control, wanted)
            last = self._past[-1] if self._past else None
            if last is not None and last.knob == control.name and before.when - last.when < _DRAG:
                self._past[-1] = replace(last, when=before.when)  # a slider that is being moved
            else:
                self._remember(before)
            return
        values, engine = self._hand.settings(self.prepared), str(self.prepared.engine)
        if control.name == COLLISIONS:
            engine = with_collisions(self.prepared.engine, bool(wanted))
        else:
            values[control.name] = wanted
        self._anew(values, engine)

    def _turn(self, control: Control, value: Value, *, back: bool = False) -> None:
        """Turn a knob; with ``back``, restore the state before the knob was first turned."""
        if back:
            self._hand.leave(control, self.experiment)
        else:
            self._hand.turn(control, value, self.experiment)
        if self.finished:  # the box was paused only because its ascent had ended
            self.playing, self.finished = True, False
        if self._hand.overflows:
            self._recorder.stop(f"The recording tells of {hand.MOST_CHANGES} changes, the largest number possible.")
            del self.changes[0]

    def stop_recording(self) -> Path | None:
        """End the recording, if there is one, and return its file."""
        return self._recorder.stop()

    @property
    def recording(self) -> str | None:
        """Name of the file that is being recorded."""
        return self._recorder.name

    # ------------------------------------------------------------------ data for the page

    def controls(self) -> tuple[Control, ...]:
        """Return all controls with their present values."""
        return self._hand.controls(self.prepared, self.setup)

    def note(self, level: str, text: str) -> None:
        """Add a message for the page."""
        self._notes.append({"type": "note", "level": level, "text": text})

    def notes(self) -> list[dict[str, str]]:
        """Return the messages for the page, and forget them."""
        told, self._notes = self._notes, []
        return told

    def state(self) -> dict[str, Any]:
        """Return the state of the session, as data for the page."""
        return {
            "type": "state",
            "playing": self.playing,
            "pace": self.pace,
            "recording": self.recording,
            "time": self.picture.time(),
            "frame": self.experiment.frame,
            "seed": self.prepared.settings.seed,
            "finished": self.finished,
            "ledger": self.setup.parcel.ledger(),
            "molecules": self.setup.parcel.number,
            "walls": self.picture.walls(),
            "gauges": self._gauges,
            "undo": bool(self._past),
        }

    def stage(self) -> dict[str, Any]:
        """Return the data that a page gets first."""
        state = {name: value for name, value in self.state().items() if name != "type"}
        told = [control.record() for control in self.controls()]
        return {
            "type": "stage",
            "stage": self.picture.stage.record,
            "controls": told,
            "state": state,
            "lesson": self.lesson.record(),
        }

    def frame(self) -> bytes:
        """Return the present positions of everything that is drawn."""
        self._sequence += 1
        return self.picture.frame(self._sequence)

    def measured(self) -> list[dict[str, Any]]:
        """Return the measurements since the last call, as messages to the page."""
        found = self.experiment.measured(self.changes[-1].frame + 1 if self.changes else 0)
        if found is None:
            return []
        gauges = gauges_of(self.prepared.settings)
        self._gauges = readings(found, moving=self.setup.ends, gauges=gauges)
        return self.report.messages(found)

"""The record button: starts and stops recordings, and names their files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from atmosbox.errors import AtmosboxError, SettingError, on_command_line
from atmosbox.live.experiment import Experiment
from atmosbox.live.tape import Change, Tape, file_for
from atmosbox.scene.panels import to_json
from atmosbox.simulation.recording import Recording

__all__ = ["Recorder"]

_LONGEST = 30_000
_MOLECULE = 16.0  # bytes for each molecule in a frame
_MEMORY = 1e9


class Recorder:
    """Records a box into one file after another.

    Parameters
    ----------
    folder
        Folder of the files.
    out
        Name of the first file, if one was given.
    force
        Whether the files may replace others.
    command
        The command that the user typed, for the history of a file.
    note
        Function that is called with a level and a sentence for the page.

    Examples
    --------
    >>> recorder = Recorder(Path(), None, False, "atmosbox live temperature", print)
    >>> recorder.name is None, recorder.stop() is None
    (True, True)
    """

    def __init__(
        self, folder: Path, out: str | None, force: bool, command: str, note: Callable[[str, str], None]
    ) -> None:
        self._folder = folder
        self._out = out
        self._force = force
        self._command = command
        self._note = note
        self._wanted: Path | None = None
        self._tape: Tape | None = None

    @property
    def name(self) -> str | None:
        """Name of the file that is being recorded; None if there is none."""
        if self._wanted is not None:
            return self._wanted.name
        return None if self._tape is None else self._tape.path.name

    def watching(self) -> list[Recording]:
        """Return the instruments of the recording, in a list that is empty if nothing is being recorded."""
        return [] if self._tape is None else [self._tape.recording]

    def start(self, name: object, box: Experiment, changes: Sequence[Change]) -> None:
        """Record a box from now on, or from its next frame if one has begun.

        Parameters
        ----------
        name
            The name of the file that the page asks for; None or empty for a default name that is not in use.
        box, changes
            The box, and the list of all changes in it, which grows.

        Raises
        ------
        AtmosboxError
            If a recording is going on already, or the file is refused.
        """
        if self.name is not None:
            raise SettingError("record", self.name, "is recording already", "stop that first")
        if name is not None and not isinstance(name, str):
            raise SettingError("file", repr(name), "is not a name", "give the name of a file, such as warm.nc")
        name = None if name is None or not name.strip() else name
        if name is None and self._out is not None:
            name, self._out = self._out, None
        self._wanted = file_for(name, box.prepared.scene, self._folder, force=self._force)
        if box.between_frames:
            self._begin(box, changes)

    def _begin(self, box: Experiment, changes: Sequence[Change]) -> None:
        from atmosbox.file.provenance import global_attributes

        path, self._wanted = self._wanted, None
        if path is None:
            return
        prepared = box.prepared
        about = global_attributes(
            prepared.parameters,
            title=str(getattr(prepared.module, "title", prepared.scene)),
            command=self._command,
            comment=" ".join((prepared.module.__doc__ or "").split()),
            references=prepared.engine.engine.reference,
            panels=to_json(box.panels),
            status="partial",
        )
        if box.setup.ends:  # an ascent is recorded from its start on
            recording = box.gauges[0]
            recording.attributes = about
        else:
            recording = box.recording(about)
        try:
            self._tape = Tape(path, prepared, box.setup, recording, changes, panels=box.panels, force=self._force)
        except AtmosboxError as error:
            self._note("error", error.said(on_command_line))

    def closed(self, box: Experiment, changes: Sequence[Change]) -> None:
        """Handle the completion of a frame: begin, save or stop the recording."""
        if self._wanted is not None:
            self._begin(box, changes)
        elif self._tape is not None:
            try:
                self._tape.save()
            except AtmosboxError as error:
                self._note("error", f"The recording stops: {error.said(on_command_line)}")
                self._tape = None
            else:
                if self._tape.frames >= longest(box):
                    self.stop(f"The recording holds {self._tape.frames} frames, the largest number possible.")

    def stop(self, why: str | None = None) -> Path | None:
        """End the recording, if there is one, and return its file.

        Parameters
        ----------
        why
            The message to show if the recording is ended by the program and not by the user.
        """
        if why is not None and self.name is not None:
            self._note("warning", why)
        wanted, self._wanted = self._wanted, None
        tape, self._tape = self._tape, None
        if tape is None and wanted is None:
            return None
        try:
            path = None if tape is None else tape.finish()
        except AtmosboxError as error:
            self._note("error", error.said(on_command_line))
            return None
        if tape is None or path is None:
            self._note("warning", "Nothing was recorded: no frame was complete.")
            return None
        self._note("info", f"{tape.frames} frames are in {path}: type atmosbox plot {path} to see them.")
        return path


def longest(box: Experiment) -> int:
    """Return the largest number of frames of a box that are kept.

    Examples
    --------
    >>> import time
    >>> from atmosbox.simulation.preparation import prepare
    >>> longest(Experiment(prepare("elastic-collisions", {"molecules": 10}), time.perf_counter))
    30000
    """
    each = _MOLECULE * box.setup.parcel.present.size if box.prepared.save_molecules else 1.0
    return max(min(_LONGEST, int(_MEMORY / each)), box.setup.frames)

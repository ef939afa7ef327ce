"""A recording: a file as ``atmosbox run`` writes it, with the changes that were made by hand."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from atmosbox.errors import Command, FileError, Option, shown
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.output_path import check_writable, unused
from atmosbox.file.provenance import history_line
from atmosbox.live.summary import without_headlines
from atmosbox.scene.conversion import phrase, to_si
from atmosbox.scene.panels import Panel, to_json
from atmosbox.scene.settings import Value
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared
from atmosbox.simulation.recording import Recording

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Change", "Tape", "file_for"]

_SAID = 20


@dataclass(frozen=True)
class Change:
    """A knob that was turned while the box ran.

    Parameters
    ----------
    time
        Time of the box [reduced time].
    frame
        Number of frames that were complete.
    name, value, unit
        Name, new value and unit of the knob; the value is None if the state before its first turn was restored.
    """

    time: float
    frame: int
    name: str
    value: Value | None
    unit: str

    @property
    def words(self) -> str:
        """The change in words, as part of a sentence.

        Examples
        --------
        >>> Change(3.0, 2, "temperature", 60.0, "degC").words
        'temperature = 60 degC'
        >>> Change(9.0, 8, "temperature", None, "degC").words
        'temperature as at the start'
        """
        if self.value is None:
            return f"{self.name} as at the start"
        return f"{self.name} = {phrase(float(self.value), self.unit)}"


def file_for(name: str | None, scene: str, folder: Path, *, force: bool) -> Path:
    """Return the path of the file for a recording.

    Parameters
    ----------
    name
        The requested name of a file in the folder, without a path; None for a default name that is not in use.
    scene
        Name of the scene, for the default name.
    folder
        Folder of the recordings.
    force
        Whether a file may be replaced.

    Raises
    ------
    FileError
        If the name is not that of a file in the folder, or the file may not be written.

    Examples
    --------
    >>> file_for("warm", "temperature", Path(), force=True).name
    'warm.nc'
    >>> file_for("../warm.nc", "temperature", Path(), force=True)
    Traceback (most recent call last):
    atmosbox.errors.FileError: ../warm.nc is not the name of a file: give one without a folder, such as warm.nc.
    """
    if name is None:
        return check_writable(unused(folder / f"{Path(scene).stem}-live.nc"))
    plain = name.strip()
    if not plain or Path(plain).name != plain or plain.startswith(".") or not plain.isprintable() or "\\" in plain:
        stem = Path(plain).stem.lstrip(".")
        like = f"{stem if stem and stem.isprintable() else Path(scene).stem}.nc"
        what = shown(plain) if plain else "Nothing"
        raise FileError(f"{what} is not the name of a file: give one without a folder, such as {like}.")
    path = folder / (plain if plain.endswith(".nc") else f"{plain}.nc")
    if os.path.exists(path) and not force:
        again = Command("live", (scene, Option("force", True)))
        raise FileError(f"{path.name} exists already", "give another name, or start with ", again)
    return check_writable(path, force)


class Tape:
    """A recording of a running box, which becomes a file.

    Parameters
    ----------
    path
        The file, which `file_for` has checked.
    prepared, setup
        The scene and its box.
    recording
        The instruments whose readings go into the file.
    changes
        All changes in this box, in order; the list grows while the box runs.
    panels
        The graphs of the scene.
    force
        Whether the file may replace another.
    """

    def __init__(
        self,
        path: Path,
        prepared: Prepared,
        setup: Setup,
        recording: Recording,
        changes: Sequence[Change],
        *,
        panels: Sequence[Panel] = (),
        force: bool = False,
    ) -> None:
        self.path = path
        self.recording = recording
        self._prepared = prepared
        self._setup = setup
        self._changes = changes
        self._panels = panels
        self._checkpoint = Checkpoint(path, force=force).begin()

    @property
    def frames(self) -> int:
        """Number of frames in the recording."""
        return self.recording.frames

    def dataset(self, status: str) -> xr.Dataset:
        """Return what has been recorded so far.

        Averages begin when the box has settled after the last change. The headlines of a scene are about the whole,
        unchanged run, so only a recording that begins at the start and has no changes has headlines.
        """
        whole = not self.recording.first and not self._changes and self.frames <= self._setup.frames
        last = self._changes[-1].frame + 1 if self._changes else 0
        settle = max(last + self._setup.settle - self.recording.first, 0)
        found, _ = self.recording.dataset(status, settle=settle, judged=whole)
        if not whole:
            panels = [panel for panel in map(without_headlines, self._panels) if panel is not None]
            found.attrs["atmosbox_panels"] = to_json(panels)
        if self.recording.first:
            self._tell_beginning(found)
        if self._changes:
            self._tell_changes(found)
        return found

    def _tell_beginning(self, found: xr.Dataset) -> None:
        bounds = found.elapsed_time_bnds.values
        if len(bounds):
            word = f"Recorded from {bounds[0, 0]:.6g} {self._setup.time_unit} on. "
            found.attrs["comment"] = word + str(found.attrs.get("comment", ""))

    def _tell_changes(self, found: xr.Dataset) -> None:
        unit = self._setup.time_unit
        seconds = self._setup.scale.time / to_si(1.0, unit)
        told = [
            {"elapsed_time": each.time * seconds, "time_unit": unit, "name": each.name, "value": each.value,
             "unit": each.unit}
            for each in self._changes
        ]  # fmt: skip
        few = self._changes[:_SAID]
        words = "; ".join(f"at {each.time * seconds:.6g} {unit} {each.words}" for each in few)
        if len(few) < len(self._changes):
            words += f"; and {len(self._changes) - len(few)} changes more, in atmosbox_changes"
        found.attrs["atmosbox_changes"] = json.dumps(told)
        found.attrs["comment"] = f"Changed by hand while it ran: {words}. Averages begin after the last change. " + str(
            found.attrs.get("comment", "")
        )
        found.attrs["history"] += "\n" + history_line(f"atmosbox live, by hand: {words}")

    def save(self) -> None:
        """Write the recording so far to the disk, if it is time to."""
        try:
            self._checkpoint(lambda: self.dataset("partial"))
        except BaseException:
            self._checkpoint.release()
            raise

    def finish(self) -> Path | None:
        """Write the file, and return its path; if no frame is complete, write nothing and return None.

        Raises
        ------
        FileError
            If the file cannot be written.
        """
        if not self.frames:
            self._checkpoint.abandon()
            return None
        try:
            return self._checkpoint.finish(self.dataset("complete"))
        finally:
            self._checkpoint.release()

"""The states of many runs that are not finished: one file for each, in a folder beside the output file of all."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from atmosbox.errors import FileError
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.output_path import AnyPath, clear, part_path

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["RunStates", "StateCheckpoint"]


class StateCheckpoint(Checkpoint):
    """The state of one run among many; the finished run gets no file of its own.

    The result of the run is kept elsewhere, so on a full disk only the state is lost and the run goes on. The
    caller removes the state after it has kept the result, see `RunStates`.

    Parameters
    ----------
    path
        The path that a file of the run would have; its state is in ``NAME.part.nc``.
    """

    def __init__(self, path: AnyPath) -> None:
        super().__init__(path, force=True)

    def save(self, dataset: xr.Dataset) -> Path:
        """Write the run so far; if that fails, for example on a full disk, go on without."""
        with contextlib.suppress(FileError):
            super().save(dataset)
        return self.part

    def finish(self, dataset: xr.Dataset) -> Path:
        """Leave the state as it is, and unlock it."""
        self.release()
        return self.part


class RunStates:
    """The folder ``NAME.part.states`` beside a file, with the states of runs that are not finished.

    Parameters
    ----------
    path
        The output file; None if no states are kept.
    complete
        Point and member of the runs whose results are kept: their states, which a killed process may have left, are
        removed.

    Attributes
    ----------
    begun
        Number of runs that had left a state when this object was made.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as home:
    ...     states = RunStates(Path(home, "sweep.nc"))
    ...     place = states.place(3, 2)
    ...     part_path(place).touch()
    ...     begun = RunStates(Path(home, "sweep.nc")).begun
    ...     states.remove(3, 2)
    ...     states.close()
    ...     Path(place).name, begun, list(Path(home).iterdir())
    ('3-2.nc', 1, [])
    """

    def __init__(self, path: Path | None, complete: Iterable[tuple[int, int]] = ()) -> None:
        self._folder = None if path is None else part_path(path.absolute().with_suffix(".states"))
        for point, member in complete:
            self.remove(point, member)
        self.begun = 0 if self._folder is None else len(list(self._folder.glob("*.part.nc")))

    def place(self, point: int, member: int) -> str | None:
        """Return the path that `StateCheckpoint` takes for a run; None if no states are kept."""
        if self._folder is None:
            return None
        with contextlib.suppress(OSError):  # if the folder cannot be made, the runs keep no states
            self._folder.mkdir(exist_ok=True)
        return os.fspath(self._folder / f"{point}-{member}.nc")

    def remove(self, point: int, member: int) -> None:
        """Remove the state of a run whose result is kept, with its lock and temporary files."""
        if self._folder is None or not self._folder.exists():
            return
        path = self._folder / f"{point}-{member}.nc"
        part = part_path(path)
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)
            path.with_name(f".{path.name}.lock").unlink(missing_ok=True)
        clear(part, everything=True)

    def close(self, *, everything: bool = False) -> None:
        """Remove the folder, unless a state in it is still needed.

        Parameters
        ----------
        everything
            Whether no state is needed any more, because all runs are complete.
        """
        if self._folder is None or (any(self._folder.glob("*.part.nc")) and not everything):
            return
        with contextlib.suppress(OSError):
            for pattern in ("*.part.nc", ".*.nc.lock", ".*.nc.*.tmp"):
                for left in self._folder.glob(pattern):
                    left.unlink(missing_ok=True)
            self._folder.rmdir()

"""The file of a run that is not finished yet, so that a run that is killed leaves a file that opens.

While a run goes on, a `Checkpoint` writes its frames so far to ``NAME.part.nc``, the part. Each checkpoint replaces the
one before as a whole, as `atmosbox.file.netcdf.write` does; the finished run replaces the last.
"""

from __future__ import annotations

import contextlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from atmosbox.errors import FileError
from atmosbox.file.netcdf import fill, write_dataset
from atmosbox.file.output_lock import BusyError, OutputLock
from atmosbox.file.output_path import AnyPath, check_writable, clear, part_path, run_is_there, unused, write_failure

if TYPE_CHECKING:
    import xarray as xr

SHARE = 0.02  # largest share of a run's time that its checkpoints may take


class Checkpoint:
    """The file of a run that is not finished: call the checkpoint after every frame, and it writes when it is time to.

    It writes the whole dataset so far to `part`, at most once in `every_seconds`, and so seldom that writing is
    expected to take less than a fiftieth of the run's time. The part of an earlier run that was killed is replaced; it
    is `stale` until then.

    The finished run will be at `path`, where it may replace a file if `force`. If `numbered`, the run gets another
    name, NAME-2, if a run of this name is there, finished or not, or is under way; `begin` may still change it. `clock`
    returns the time [s].
    """

    def __init__(
        self,
        path: AnyPath,
        every_seconds: float = 2.0,
        *,
        force: bool = False,
        numbered: bool = False,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._force = force
        self._numbered = numbered
        self._busy: set[Path] = set()
        self._name(path)
        self._every = every_seconds
        self._clock = clock
        self._begun = self._written = clock()
        self._spent = self._last = 0.0
        self._lock: OutputLock | None = None

    def _name(self, wanted: AnyPath) -> None:
        """Set the path of the finished run and that of the run so far."""
        self.wanted = wanted
        free = unused(wanted, lambda path: path in self._busy or run_is_there(path)) if self._numbered else wanted
        self.path = check_writable(free, self._force)
        self.part = part_path(self.path)
        self.stale = check_writable(self.part, force=True).exists()

    def begin(self) -> Checkpoint:
        """Lock the file for this run alone, and remove the temporary files that a killed run has left.

        If the name is numbered and another run has taken it meanwhile, lock the file of the next name.
        """
        if self._lock is not None:
            return self
        while self._lock is None:
            with contextlib.suppress(*((BusyError,) if self._numbered else ())):
                self._lock = OutputLock(self.path)
            if self._numbered and (self._lock is None or run_is_there(self.path)):
                self.release()
                self._busy.add(self.path)
                self._name(self.wanted)
        for path in (self.path, self.part):
            clear(path, everything=True)
        return self

    @staticmethod
    def load_libraries() -> None:
        """Import all libraries that writing needs, before the run: Ctrl-C must not interrupt an import half-way."""
        import netCDF4
        import xarray as xr

        fill(netCDF4.Dataset("run.nc", "w", diskless=True), xr.Dataset({"x": ("y", [0.0])}))  # makes no file

    def release(self) -> None:
        """Unlock the file for other runs; the part, if there is one, stays."""
        lock, self._lock = self._lock, None
        if lock is not None:
            lock.release()

    def __call__(self, make_dataset: Callable[[], xr.Dataset]) -> bool:
        """Write the run so far if it is time to, and return whether it was written."""
        now = self._clock()
        expected = self._spent + 1.5 * self._last  # the file has grown since
        if now - self._written < self._every or expected > SHARE * (now - self._begun):
            return False
        self.save(make_dataset())
        self._written = self._clock()
        self._last = self._written - now
        self._spent += self._last
        return True

    def save(self, dataset: xr.Dataset) -> Path:
        """Write the run so far at once, for instance when the run is interrupted, and return the path of the part."""
        self.begin()
        write_dataset(self.part, dataset)
        return self.part

    def finish(self, dataset: xr.Dataset) -> Path:
        """Write the finished run under its own name, remove the part, and return the file.

        If a file of that name has appeared during the run, the finished run is kept as the part.
        """
        self.save(dataset)
        if self.path.exists() and not self._force:
            raise FileError(
                f"Another program has made {self.path} during the run; the complete run is in {self.part}: "
                "rename one of the two."
            )
        try:
            os.replace(self.part, self.path)
        except OSError as error:
            raise write_failure(error, self.path) from error
        self.release()
        return self.path

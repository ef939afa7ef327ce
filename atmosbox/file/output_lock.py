"""One writer for one file: a lock file beside it names the process that writes."""

from __future__ import annotations

import contextlib
import os
import socket
from pathlib import Path

from atmosbox.errors import FileError, Option
from atmosbox.file.provenance import moment

ELSEWHERE = ("give another place with ", Option("out"))
"""The remedy where a file cannot be written."""
ANOTHER_NAME = ("name another file with ", Option("out"))
"""The remedy where a file of this name is there, or is being written."""


class BusyError(FileError):
    """Another process is writing the file."""


class OutputLock:
    """The right to write one file: ``.NAME.lock`` beside it, which names the process and the computer of its owner.

    The system holds the lock as long as the process lives, so a process that was killed leaves a file but no lock.
    """

    def __init__(self, path: Path) -> None:
        self.path = path.with_name(f".{path.name}.lock")
        self._file: int | None = None
        while self._file is None:
            self._file = self._taken(path)

    def _taken(self, path: Path) -> int | None:
        """Open the lock file and take the lock; None if the lock file was removed meanwhile."""
        try:
            opened = os.open(self.path, os.O_RDWR | os.O_CREAT, 0o644)
        except OSError as error:
            raise FileError(f"{self.path} cannot be made ({error.strerror})", *ELSEWHERE) from error
        with contextlib.ExitStack() as unless_taken:
            unless_taken.callback(os.close, opened)
            if not hold(opened):
                whose = os.read(opened, 1000).decode("utf-8", "replace") or "another run"
                raise BusyError(f"{path} is being written by {whose}", "wait for it, or ", *ANOTHER_NAME)
            with contextlib.suppress(OSError):
                if os.path.samestat(os.fstat(opened), os.stat(self.path)):
                    os.ftruncate(opened, 0)
                    os.write(opened, f"process {os.getpid()} on {socket.gethostname()} since {moment()}".encode())
                    unless_taken.pop_all()
                    return opened
        return None

    def release(self) -> None:
        """Release the lock and remove its file."""
        opened, self._file = self._file, None
        if opened is not None:
            with contextlib.suppress(OSError):
                if os.path.samestat(os.fstat(opened), os.stat(self.path)):
                    self.path.unlink()
            os.close(opened)


def hold(opened: int) -> bool:
    """Lock the file, and return whether no other process has it; where the system has no locks, none has."""
    try:
        import fcntl

        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except (ImportError, OSError):
        pass
    return True

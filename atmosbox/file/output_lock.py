"""One writer for one file: a lock file beside it names the process that writes."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import time
from pathlib import Path
from typing import Any

from atmosbox.errors import FileError, Option
from atmosbox.file.provenance import moment

ELSEWHERE = ("give another place with ", Option("out"))
"""The remedy where a file cannot be written."""
ANOTHER_NAME = ("name another file with ", Option("out"))
"""The remedy where a file of this name is there, or is being written."""
ABANDONED = 3600.0
"""Seconds after which the lock of a process on another computer, which cannot be checked, counts as abandoned."""


class BusyError(FileError):
    """Another process is writing the file."""


def host() -> str:
    """Return the name of this computer."""
    return socket.gethostname() or "localhost"


def alive(pid: int) -> bool:
    """Return whether a process of this computer is running.

    Examples
    --------
    >>> alive(os.getpid()), alive(2**22 + 1)
    (True, False)
    """
    if os.name == "nt":
        return True  # on Windows, os.kill could end the process, so only the age of the lock tells
    try:
        os.kill(pid, 0)
    except PermissionError:
        return True
    except (OSError, OverflowError):
        return False
    return True


class OutputLock:
    """The right to write one file: ``.NAME.lock`` beside it, with the process and the computer of its owner.

    The system holds the lock as long as the process lives, so a process that was killed leaves a file but no lock.
    If the file system has no locks, or the owner is on another computer, the content of the file decides.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     lock = OutputLock(Path(folder, "run.nc"))
    ...     try:
    ...         OutputLock(Path(folder, "run.nc"))
    ...     except FileError as error:
    ...         print("is being written by process" in str(error))
    ...     lock.release()
    True
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
            held = hold(opened)
            owner = _owner(os.read(opened, 1000))
            if held is False or (owner and self._lives(owner, held is True, opened)):
                whose = f"process {owner['pid']} on {owner['host']} since {owner['since']}" if owner else "another run"
                again = f"; if that has ended, remove {self.path}"
                raise BusyError(f"{path} is being written by {whose}", "wait for it, or ", *ANOTHER_NAME, again)
            with contextlib.suppress(OSError):
                if os.path.samestat(os.fstat(opened), os.stat(self.path)):
                    os.ftruncate(opened, 0)
                    os.lseek(opened, 0, os.SEEK_SET)
                    os.write(opened, json.dumps({"pid": os.getpid(), "host": host(), "since": moment()}).encode())
                    unless_taken.pop_all()
                    return opened
        return None

    def _lives(self, owner: dict[str, Any], held: bool, opened: int) -> bool:
        """Return whether the owner that the file names may still be running."""
        if owner["host"] != host():
            return time.time() - os.fstat(opened).st_mtime < ABANDONED
        return not held and owner["pid"] != os.getpid() and alive(owner["pid"])

    def keep(self) -> None:
        """Renew the time of the lock file, so that other computers know that the owner still runs."""
        with contextlib.suppress(OSError):
            os.utime(self.path)

    def release(self) -> None:
        """Release the lock and remove its file."""
        opened, self._file = self._file, None
        if opened is not None:
            with contextlib.suppress(OSError):
                if os.path.samestat(os.fstat(opened), os.stat(self.path)):
                    self.path.unlink()
            os.close(opened)


def hold(opened: int) -> bool | None:
    """Try to lock the file; False if another process has the lock, None if the system has no locks."""
    try:
        import fcntl
    except ImportError:
        return None
    try:
        fcntl.flock(opened, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:
        return None
    return True


def _owner(content: bytes) -> dict[str, Any]:
    """Return the owner that a lock file names; empty if the file names none."""
    try:
        said = json.loads(content)
        return {"pid": int(said["pid"]), "host": str(said["host"]), "since": str(said["since"])}
    except (ValueError, TypeError, KeyError):
        return {}

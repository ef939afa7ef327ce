"""One writer for one file: a lock beside it, which says whose it is, and whether its owner is still there."""

from __future__ import annotations

import contextlib
import json
import os
import socket
import time
from pathlib import Path
from typing import Any

from atmosbox.errors import FileError
from atmosbox.file.provenance import moment

__all__ = ["OutputLock", "alive", "host"]

ABANDONED = 3600.0
"""Seconds after which the lock of another computer, which nothing here can ask after, counts as left behind."""


def host() -> str:
    """Return the name of this computer.

    Examples
    --------
    >>> bool(host())
    True
    """
    return socket.gethostname() or "localhost"


def alive(pid: int) -> bool:
    """Return whether a process of this computer is running.

    Examples
    --------
    >>> alive(os.getpid()), alive(2**22 + 1)
    (True, False)
    """
    if os.name == "nt":
        return True  # there, to ask after a process could end it; age alone tells
    try:
        os.kill(pid, 0)
    except PermissionError:
        return True
    except (OSError, OverflowError):
        return False
    return True


class OutputLock:
    """The right to write one file: ``.NAME.lock`` beside it, with the process and the computer of its owner.

    The system holds the lock for as long as the process lives, so that one that was killed leaves a file but no lock.
    Where the file system knows no locks, or the owner is another computer, what the file says decides.

    Parameters
    ----------
    path
        The file that is to be written.

    Raises
    ------
    FileError
        If another process writes it, or the lock cannot be made.

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
        """Open the lock and make it ours; None if it went while it was looked at."""
        try:
            opened = os.open(self.path, os.O_RDWR | os.O_CREAT, 0o644)
        except OSError as error:
            raise FileError(f"{self.path} cannot be made ({error.strerror}): give another place with --out.") from error
        try:
            held = _hold(opened)
            owner = _owner(os.read(opened, 1000))
            if held is False or (owner and self._lives(owner, held is True, opened)):
                whose = f"process {owner['pid']} on {owner['host']} since {owner['since']}" if owner else "another run"
                raise FileError(
                    f"{path} is being written by {whose}: wait for it, or name another file with --out; if it runs no "
                    f"more, remove {self.path}."
                )
            with contextlib.suppress(OSError):
                if os.path.samestat(os.fstat(opened), os.stat(self.path)):
                    os.ftruncate(opened, 0)
                    os.lseek(opened, 0, os.SEEK_SET)
                    os.write(opened, json.dumps({"pid": os.getpid(), "host": host(), "since": moment()}).encode())
                    taken, opened = opened, -1
                    return taken
            return None
        finally:
            if opened >= 0:
                os.close(opened)

    def _lives(self, owner: dict[str, Any], held: bool, opened: int) -> bool:
        """Return whether an owner that is named in the file may still be there."""
        if owner["host"] != host():
            return time.time() - os.fstat(opened).st_mtime < ABANDONED
        return not held and owner["pid"] != os.getpid() and alive(owner["pid"])

    def keep(self) -> None:
        """Tell other computers that the owner still lives."""
        with contextlib.suppress(OSError):
            os.utime(self.path)

    def release(self) -> None:
        """Give the right back, and leave nothing behind."""
        opened, self._file = self._file, None
        if opened is not None:
            with contextlib.suppress(OSError):
                if os.path.samestat(os.fstat(opened), os.stat(self.path)):
                    self.path.unlink()
            os.close(opened)


def _hold(opened: int) -> bool | None:
    """Ask the system for a lock; None where it knows none."""
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
    """Return who is named in a lock, nothing if it was never filled in."""
    try:
        said = json.loads(content)
        return {"pid": int(said["pid"]), "host": str(said["host"]), "since": str(said["since"])}
    except (ValueError, TypeError, KeyError):
        return {}

"""The journal of a sweep or a tradeoff: one line for each complete run, on the disk before the next run begins.

It is the file ``NAME.part.jsonl`` beside the output file of all runs together. Its first line holds the request. A
line that a crash has cut short is ignored, and its run is computed again.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from atmosbox.errors import FileError, Option, shown
from atmosbox.file.output_lock import ANOTHER_NAME, hold
from atmosbox.file.output_path import check_writable, part_path, write_failure

__all__ = ["Journal"]

FORMAT = 1

Record = dict[str, Any]
"""The results of a run that are kept, as JSON can hold them, with its ``point`` and ``member``."""


class Journal:
    """The saved runs of a sweep that is not finished; open it, append runs, and remove it when the sweep is written.

    Parameters
    ----------
    path
        The file that the finished sweep will have.
    request
        All that decides what the sweep computes: values by the names that messages use for them.
    history
        The line that this command adds to the history of the file.
    force
        Whether a journal of another request is thrown away.
    kind
        What all runs make together: a sweep, or a tradeoff.

    Attributes
    ----------
    path
        The file of the journal.
    records
        The saved records by point and member.
    history
        The history lines of all commands that took part.

    Raises
    ------
    FileError
        If there is a journal of another request, or another program is writing the journal.

    Examples
    --------
    A sweep that was killed continues from the runs it has saved:

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     asked = {"--members": 2}
    ...     with Journal(Path(folder, "sweep.nc"), asked, "monday") as journal:
    ...         journal.append({"point": 1, "member": 2, "status": "complete"})
    ...     with Journal(Path(folder, "sweep.nc"), asked, "tuesday") as journal:
    ...         list(journal.records), journal.history
    ([(1, 2)], ['monday', 'tuesday'])
    """

    def __init__(
        self, path: Path, request: Mapping[str, Any], history: str, *, force: bool = False, kind: str = "sweep"
    ) -> None:
        self._kind, self._head = kind, f"atmosbox_{kind}"  # the head marks the first line of a journal of this kind
        self.path = check_writable(self.place(path), force=True)
        self.records: dict[tuple[int, int], Record] = {}
        self.history = [history]
        try:
            mode = "r+b" if self.path.exists() else "x+b"
            self._file = open(self.path, mode, buffering=0)  # noqa: SIM115
        except OSError as error:
            raise write_failure(error, self.path) from error
        try:
            if hold(self._file.fileno()) is False:
                raise FileError(f"{self.path} is being written by another {kind}", "wait for it, or ", *ANOTHER_NAME)
            if not self._recalled(request, force):
                self._truncate(0)
                self._write({self._head: FORMAT, "request": dict(request), "history": history})
            elif self.history[-1] != history:
                self.history.append(history)
                self._write({"history": history})
        except BaseException:
            self._file.close()
            raise

    @staticmethod
    def place(path: Path) -> Path:
        """Return the path of the journal of a file."""
        return part_path(path.with_suffix(".jsonl"))

    def __enter__(self) -> Journal:
        """Return the journal, whose file is open."""
        return self

    def __exit__(self, *error: object) -> None:
        """Close the file."""
        self._file.close()

    def append(self, record: Record) -> None:
        """Save a run; when this returns, the run is on the disk.

        Raises
        ------
        DiskFullError
            If the disk is full; what was saved before is kept.
        FileError
            If the journal cannot be written for another reason.
        """
        self._write(record)
        self.records[record["point"], record["member"]] = record

    def remove(self) -> None:
        """Close and remove the journal: its sweep is finished."""
        self._file.close()
        self.path.unlink(missing_ok=True)

    def _recalled(self, request: Mapping[str, Any], force: bool) -> bool:
        """Read the saved records; return False if there are none, or if the journal may be thrown away."""
        content = self._file.read()
        lines = content.split(b"\n")
        whole = len(content) - len(lines.pop())
        try:
            entries = [json.loads(line) for line in lines]
            head, entries = (entries[0], entries[1:]) if entries else ({}, [])
            if content and (head.get(self._head) != FORMAT or not isinstance(head.get("request"), dict)):
                raise ValueError
            records = {(int(e["point"]), int(e["member"])): e for e in entries if "history" not in e}
            history = [str(head["history"])] if head else []
            history += [str(entry["history"]) for entry in entries if "history" in entry]
        except (ValueError, KeyError, TypeError, AttributeError):
            if force or not whole:
                return False
            raise FileError(
                f"{self.path} is in the way, and is no journal of a {self._kind}, or a damaged one",
                "move it, or add ",
                Option("force", True),
                " to throw it away",
            ) from None
        if not whole:
            return False
        asked = json.loads(json.dumps(dict(request)))
        if different := _difference(head["request"], asked):
            if force:
                return False
            raise FileError(
                f"{self.path} has {len(records)} runs of another {self._kind}, {different}",
                "type that one again to go on with it, add ",
                Option("force", True),
                " to throw it away, or ",
                *ANOTHER_NAME,
            )
        self.records, self.history = records, history
        self._truncate(whole)
        return True

    def _truncate(self, size: int) -> None:
        self._file.seek(size)
        self._file.truncate()

    def _write(self, entry: Mapping[str, Any]) -> None:
        """Write a line to the disk; if that fails, remove the part that was written."""
        size = self._file.tell()
        left = f"{json.dumps(entry)}\n".encode()
        try:
            while left:
                left = left[self._file.write(left) :]
            os.fsync(self._file.fileno())
        except OSError as error:
            with contextlib.suppress(OSError):
                self._truncate(size)
            raise write_failure(error, self.path) from error


def _difference(saved: Mapping[str, Any], asked: Mapping[str, Any]) -> str:
    """Return in words how the first differing part differs; empty if the two requests are equal."""
    for name in dict.fromkeys([*saved, *asked]):
        if saved.get(name) != asked.get(name):
            if name.startswith("content of"):
                return f"for which the {name} was another"
            before, now = (_said(each.get(name)) for each in (saved, asked))
            return f"with {name} {before} and not {now}"
    return ""


def _said(value: object) -> str:
    if value is None:
        return "not given"
    return shown(",".join(map(str, value)) if isinstance(value, list) else value)

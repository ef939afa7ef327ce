"""The one way to write a file: a path that cannot be written is refused early, and a file is written whole or not."""

from __future__ import annotations

import contextlib
import errno
import glob
import itertools
import os
import secrets
import shlex
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TypeAlias

from atmosbox.errors import DiskFullError, FileError, Option, SettingError, shown
from atmosbox.file.output_lock import ANOTHER_NAME, ELSEWHERE
from atmosbox.file.provenance import moment

AnyPath: TypeAlias = str | os.PathLike[str]

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
LONGEST_NAME = 200  # bytes; file systems allow 255, and the temporary name is longer than the file's own
SMALLEST_FILE = 65536  # bytes; netCDF builds a file in blocks of this size
LEFT_OVER = 3600.0  # seconds after which a temporary file counts as left by a killed program


def named(
    path: AnyPath, format: str | None, formats: tuple[str, ...], *, force: bool, what: str = "figure"
) -> tuple[Path, str]:
    """Return the output path and the format, from the suffix or from `format`; refuse a path that cannot be written.

    >>> str(named("parcel", "svg", ("png", "svg"), force=True)[0])
    'parcel.svg'
    """
    path = Path(path)
    suffix = path.suffix[1:].lower()
    kind = suffix if format is None else format.lower().lstrip(".")
    if kind not in formats:
        problem = "is unknown" if kind else "is not given"
        known = f"{', '.join(formats[:-1])} or {formats[-1]}"
        raise SettingError("format", kind or None, problem, "give a file name or ", Option("format"), f" of {known}")
    if suffix in formats and suffix != kind:
        raise SettingError("format", kind, f"does not go with the file name {path.name}", "leave one of the two out")
    if suffix != kind and path.name and not path.is_dir():
        path = path.with_name(f"{path.name}.{kind}")
    return check_writable(path, force, example=f"{what}.{kind}"), kind


def check_writable(path: AnyPath, force: bool = False, *, example: str = "run.nc") -> Path:
    """Refuse an output path that cannot be written, before the run begins; write nothing.

    Return the file to write: the path, or what it points to if it is a symbolic link. `example` is the file name that a
    message suggests.
    """
    if not os.fspath(path).strip():
        raise FileError("The name of the file is empty", "give one, such as ", Option("out", example))
    found = Path(os.path.realpath(path) if os.path.islink(path) else path)
    folder = found.parent
    if os.path.isdir(found):
        raise FileError(f"{found} is a folder", "give a file in it, such as ", Option("out", str(found / example)))
    if len(os.fsencode(found.name)) > LONGEST_NAME:
        raise FileError(f"The name {shown(found.name)} is too long", "give a shorter one with ", Option("out"))
    if not os.path.lexists(folder):
        words = shlex.quote(str(folder))
        raise FileError(f"The folder {words} does not exist: type mkdir -p {words} first.")
    if not os.path.isdir(folder):
        raise FileError(f"{folder} is a file, not a folder", *ELSEWHERE)
    if os.path.exists(found) and not os.path.isfile(found):
        raise FileError(f"{found} is a device, not a file", "give another name with ", Option("out"))
    if os.path.exists(found) and not force:
        raise FileError(f"{found} exists already", "add ", Option("force", True), " to replace it, or ", *ANOTHER_NAME)
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(f"Nothing may be written to the folder {folder}", *ELSEWHERE)
    if shutil.disk_usage(folder).free < SMALLEST_FILE:
        raise write_failure(OSError(errno.ENOSPC, ""), found)
    moment()
    return found


def part_path(path: AnyPath) -> Path:
    """Return the path of the part, NAME.part.nc: the file of a run that is not finished."""
    whole = Path(path)
    return whole.with_name(f"{whole.stem}.part{whole.suffix}")


def run_is_there(path: AnyPath) -> bool:
    """Return whether there is the file of a run, finished or not."""
    return os.path.lexists(path) or os.path.lexists(part_path(path))


def unused(path: AnyPath, taken: Callable[[Path], bool] = os.path.lexists) -> Path:
    """Return a path that is not in use: this one, or else NAME-2, NAME-3 and so on with the same suffix.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     Path(folder, "run.nc").touch()
    ...     unused(Path(folder, "run.nc")).name, unused(Path(folder, "other.nc")).name
    ('run-2.nc', 'other.nc')
    """
    first = Path(path)
    tried = (first if k == 1 else first.with_name(f"{first.stem}-{k}{first.suffix}") for k in itertools.count(1))
    return next(each for each in tried if not taken(each))


def whole_path(part: AnyPath) -> Path:
    """Return the path of the finished run's file, given the path of the part."""
    path = Path(part)
    return path.with_name(f"{path.stem.removesuffix('.part')}{path.suffix}")


def clear(path: Path, *, everything: bool = False) -> None:
    """Remove the temporary files of a file that were left by programs which were killed.

    Such a file is an hour old. With `everything`, remove all of them, because no other program can be writing the file.

    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     Path(folder, ".a.txt.1a2b3c4d.tmp").touch()
    ...     clear(Path(folder, "a.txt"), everything=True)
    ...     list(Path(folder).iterdir())
    []
    """
    with contextlib.suppress(OSError):
        for old in path.parent.glob(f".{glob.escape(path.name)}.*.tmp"):
            if everything or time.time() - old.stat().st_mtime > LEFT_OVER:
                old.unlink(missing_ok=True)


@contextlib.contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside a file; the temporary file replaces the file when the block ends without error.

    If the block fails or is interrupted, the temporary file is removed and the file stays as it was. A program that
    is killed leaves the temporary file, which the next program that writes the same file removes: see `clear`.
    """
    clear(path)
    temporary = path.with_name(f".{path.name}.{secrets.token_hex(4)}.tmp")
    try:
        yield temporary
        # without this, the file can have its final name and yet be empty after a power failure
        with temporary.open("r+b") as stream:
            os.fsync(stream.fileno())
        os.replace(temporary, path)
    except FileError:
        raise
    except OSError as error:
        raise write_failure(error, path) from error
    finally:
        temporary.unlink(missing_ok=True)


def write_whole(path: Path, content: bytes | memoryview) -> None:
    """Write a file, which `check_writable` or `named` has checked, whole or not at all.

    A file that was there before is kept if the disk is full.
    """
    with whole_file(path) as temporary:
        temporary.write_bytes(content)


def write_failure(error: OSError, path: Path) -> FileError:
    """Return the error to raise for what the system reported when a file was to be written."""
    if error.errno in FULL:
        kept = ", which stays as it was" if path.exists() else ""
        return DiskFullError(f"The disk has no room for {path}{kept}", "delete something, or ", *ELSEWHERE)
    return FileError(f"{path} could not be written ({error.strerror or error})", *ELSEWHERE)

"""The file that something is written to: it is there whole or not at all, and a failure is said in a sentence."""

from __future__ import annotations

import errno
import os
import uuid
from pathlib import Path

from atmosbox.errors import DiskFullError, FileError, SettingError

__all__ = ["named", "write_failure", "write_whole"]

NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def named(
    path: str | os.PathLike[str], format: str | None, formats: tuple[str, ...], *, force: bool, what: str = "figure"
) -> tuple[Path, str]:
    """Return the file and the format, from what is said of either; refuse a file that cannot be written.

    Parameters
    ----------
    path : str or path-like
        The file.
    format : str or None
        The format, where the suffix does not say it.
    formats : tuple of str
        The formats that there are.
    force : bool
        Whether a file of that name may be replaced.
    what : str
        What is in the file.

    Returns
    -------
    pathlib.Path
        The file, with a suffix.
    str
        The format.

    Raises
    ------
    FileError
        If the file exists, or its folder does not.
    SettingError
        If the format is unknown.

    Examples
    --------
    >>> str(named("parcel", "svg", ("png", "svg"), force=True)[0])
    'parcel.svg'
    """
    path = Path(path)
    suffix = path.suffix[1:].lower()
    kind = suffix if format is None else format.lower().lstrip(".")
    if kind not in formats:
        problem = "is unknown" if kind else "is not given"
        known = f"{', '.join(formats[:-1])} or {formats[-1]}"
        raise SettingError("format", kind or None, problem, f"give a file name or --format of {known}")
    if suffix in formats and suffix != kind:
        raise SettingError("format", kind, f"does not go with the file name {path.name}", "leave one of the two out")
    path = path if suffix == kind else path.with_name(f"{path.name}.{kind}")
    if path.is_dir():
        raise FileError(f"{path} is a folder: name the file of the {what}, {path / f'{what}.{kind}'} for instance.")
    if not path.parent.is_dir():
        raise FileError(f"The folder {path.parent} for the {what} does not exist: make it first, or name another one.")
    if path.exists() and not force:
        raise FileError(f"{path} exists already: add --force to replace it, or name another file.")
    return path, kind


def write_whole(path: Path, content: bytes) -> None:
    """Write a file beside its place and put it there when it is whole.

    Parameters
    ----------
    path : pathlib.Path
        The file, which `named` has let through.
    content : bytes
        What is in it.

    Raises
    ------
    DiskFullError
        If the disk is full.
    FileError
        If the file cannot be written for another reason.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_whole(Path(folder, "a.txt"), b"air")
    ...     Path(folder, "a.txt").read_text()
    'air'
    """
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        with part.open("xb") as stream:
            stream.write(content)
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        raise write_failure(error, path) from error


def write_failure(error: OSError, path: Path) -> FileError:
    """Return the refusal that a failure to write a file amounts to.

    Parameters
    ----------
    error
        What the system reported.
    path
        The file that was to be written.

    Examples
    --------
    >>> str(write_failure(OSError(errno.ENOSPC, ""), Path("no/run.nc")))
    'The disk has no room for no/run.nc: delete something, or give another --out.'
    """
    if error.errno in NO_ROOM:
        kept = ", which stays as it was" if path.exists() else ""
        return DiskFullError(f"The disk has no room for {path}{kept}: delete something, or give another --out.")
    return FileError(f"{path} could not be written ({error.strerror or error}): give another place with --out.")

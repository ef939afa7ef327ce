"""Reading a file of any format: open it, recognise the format by the content, read, check."""

from __future__ import annotations

import os
import re
from pathlib import Path

from atmosbox.errors import FileError, SoundingError, shown
from atmosbox.scene.sounding.formats import FORMATS, Text
from atmosbox.scene.sounding.netcdf import SIGNATURES, profile
from atmosbox.scene.sounding.profile import Sounding
from atmosbox.scene.sounding.table import Table, sounding_of

__all__ = ["LARGEST_FILE", "MOST_LINES", "read"]

LARGEST_FILE = 16 * 2**20
"""Largest size of a file that is opened; a sounding has some kilobytes [byte]."""

MOST_LINES = 100_000
"""Largest number of lines of a text that is read; a report every second makes some 6000."""

_FIX = "give a sounding as Wyoming, IGRA, BUFKIT or SHARPpy text, CSV or netCDF"
_BINARY = re.compile(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]")
_MARKS = {
    b"PK\x03\x04": "is a zip file or a workbook: save it as CSV",
    b"%PDF": "is a PDF: save the numbers as CSV",
    b"\x1f\x8b": "is packed: type gunzip first",
}


def read(path: str | os.PathLike[str]) -> Sounding:
    r"""Return the sounding in a file, from the ground up.

    The format is recognised by the content: a table of the University of Wyoming, as text, as its web page or as CSV; a
    file of IGRA, version 2, or of BUFKIT, of which the first sounding is read; SHARPpy's text; a table with named
    columns (CSV); netCDF with variables as users of MetPy name them.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Sounding
        The ascent. See :func:`atmosbox.scene.sounding.table.sounding_of` for the treatment of missing values.

    Raises
    ------
    FileError
        If the file is missing, unreadable, a folder, or larger than 16 MiB.
    SoundingError
        If it is empty or has more than 100 000 lines, is in no known format, lacks a column or a unit, or if its
        levels do not make an ascent.

    Examples
    --------
    >>> import tempfile
    >>> lines = ["p [hPa],T [degC],Td [degC]", "1000,25,17", "850,15,9", "700,5,-3", "500,-10,-25", "300,-40,-60"]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = Path(folder, "oslo.csv").write_text("\n".join(lines))
    ...     read(Path(folder, "oslo.csv"))
    <Sounding oslo: 5 levels from 1000 hPa, 25.00 degC to 300 hPa, -40.00 degC>
    """
    source = Path(path)
    file = shown(os.fspath(source), 200)
    content = _content(source, file)
    if content.startswith(SIGNATURES):
        table = profile(source, file, source.stem)
    else:
        table = _parsed(Text(re.split(r"\r\n|\r|\n", _decoded(content, file)), file, source.stem))
    return sounding_of(table)


def _content(source: Path, file: str) -> bytes:
    """Return the bytes of a file, or raise FileError."""
    if os.path.isdir(source):
        raise FileError(f"{file} is a folder: give a file in it.")
    if not os.path.exists(source):
        raise FileError(f"{file} does not exist: check the name and the folder.")
    if not os.path.isfile(source):
        raise FileError(f"{file} may not be read: give an ordinary file.")
    if (size := os.path.getsize(source)) > LARGEST_FILE:
        raise FileError(f"{file} has {size / 1e6:.0f} MB, far more than a sounding: {_FIX}.")
    try:
        content = source.read_bytes()
    except OSError as error:
        raise FileError(f"{file} may not be read ({error.strerror or error}): check what ls -l says of it.") from error
    if not content.strip():
        raise SoundingError(f"{file} is empty: {_FIX}.")
    return content


def _decoded(content: bytes, file: str) -> str:
    """Return the text of a file, in UTF-8 or else latin-1, or in UTF-16 if it begins with its mark."""
    for mark, problem in _MARKS.items():
        if content.startswith(mark):
            raise SoundingError(f"{file} {problem}.")
    wide = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    if not wide and _BINARY.search(content):
        raise SoundingError(f"{file} is not a text: {_FIX}.")
    try:
        return content.decode("utf-16" if wide else "utf-8-sig")
    except UnicodeDecodeError:
        if wide:
            raise SoundingError(f"{file} is not a text: {_FIX}.") from None
        return content.decode("latin-1")


def _parsed(text: Text) -> Table:
    """Return the columns of a text in any of the formats."""
    if len(text.lines) > MOST_LINES:
        raise SoundingError(f"{text.file} has {len(text.lines)} lines, far more than a sounding: {_FIX}.")
    for parse in FORMATS:
        if (table := parse(text)) is not None:
            return table
    first, line = next(((i, line) for i, line in enumerate(text.lines) if line.strip()), (0, ""))
    raise SoundingError(
        f"{text.place(first)}: {shown(line.strip())} begins no sounding that is known: name the columns, as in "
        "pressure [hPa],temperature [degC],dewpoint [degC]."
    )

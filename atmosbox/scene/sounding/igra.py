"""The Integrated Global Radiosonde Archive of NOAA, version 2: columns of fixed width below a header.

The layout is that of ``igra2-data-format.txt`` of the archive, doi:10.7289/V5X63K0Q. Pressure is in Pa, height in m,
temperature and dewpoint depression in tenths of a degree; -9999 means a missing value, -8888 one that failed a quality
check.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.sounding.tabulated import Table

__all__ = ["parse", "recognised"]

_HEADER = re.compile(
    r"#(?P<station>[A-Z]{2}[A-Z0-9]{9}) (?P<date>\d{4} \d\d \d\d) (?P<hour>[\d ]{2}) .{4} (?P<levels>[\d ]{4}).*"
)
_FIELDS = {"pressure": (9, 15), "height": (16, 21), "temperature": (22, 27), "depression": (34, 39)}
_MISSING = (-9999, -8888)
_SHORTEST = 39


def recognised(lines: Sequence[str]) -> bool:
    """Return whether a text begins with a header of IGRA.

    Examples
    --------
    >>> recognised(["#USM00072357 2014 09 10 00 2301    2 ncdc-gts ncdc-gts  352211   -974647"])
    True
    """
    return bool(lines) and _HEADER.fullmatch(lines[0].rstrip()) is not None


def parse(lines: Sequence[str], file: str, name: str) -> Table:
    """Return the first sounding of a station's file.

    Parameters
    ----------
    lines
        The lines of the file.
    file
        The name of the file in messages.
    name
        Not used: the header gives a better name.

    Raises
    ------
    SoundingError
        If a line cannot be understood, or there are fewer levels than the header says.

    Examples
    --------
    A level at the surface, 972 hPa, with 24.3 degC and a dewpoint 5.1 K below:

    >>> head = "#USM00072357 2014 09 10 00 2301    1 ncdc-gts ncdc-gts  352211   -974647"
    >>> row = "21  0000  97200B  345B  243B-9999    51   160    51 "
    >>> {quantity: float(column[0]) for quantity, column in parse([head, row], "oun.txt", "oun").values.items()}
    {'pressure': 972.0, 'height': 345.0, 'temperature': 24.3, 'dewpoint': 19.2}
    """
    header = _HEADER.fullmatch(lines[0].rstrip())
    if header is None:
        raise SoundingError(f"{file}, line 1: this is no header of IGRA version 2: save the file again.")
    if not header["levels"].strip().isdecimal():
        raise SoundingError(f"{file}, line 1: the header does not say how many levels there are: save the file again.")
    levels = int(header["levels"])
    rows: list[list[float]] = []
    for i in range(1, 1 + levels):
        where = f"{file}, line {i + 1}"
        line = lines[i].rstrip() if i < len(lines) else ""
        if not line or line.startswith("#"):
            raise SoundingError(f"{where}: the header announces {levels} levels, and {i - 1} are there: save it again.")
        rows.append([_number(line, quantity, where) for quantity in _FIELDS])
    pressure, height, temperature, depression = np.array(rows, dtype=np.float64).reshape(-1, len(_FIELDS)).T
    others = sum(line.startswith("#") for line in lines) - 1
    remarks = (f"The first of {others + 1} soundings in the file taken.",) if others else ()
    tenth = np.round(temperature - depression) / 10.0
    return Table(
        file,
        "IGRA version 2",
        f"{header['station']} {'-'.join(header['date'].split())} {header['hour'].strip()} UTC",
        {"pressure": pressure / 100.0, "height": height, "temperature": temperature / 10.0, "dewpoint": tenth},
        {"pressure": "hPa", "height": "m", "temperature": "degC", "dewpoint": "degC"},
        tuple(f"line {i + 2}" for i in range(levels)),
        f"{file}, line 1",
        remarks,
    )


def _number(line: str, quantity: str, where: str) -> float:
    """Return the integer in a field, NaN if it is missing."""
    start, end = _FIELDS[quantity]
    text = line[start:end].strip()
    if len(line) < _SHORTEST or not re.fullmatch(r"-?\d+", text):
        what = f"the {quantity} {shown(text)} is no whole number" if len(line) >= _SHORTEST else "the line is cut off"
        raise SoundingError(
            f"{where}: {what}, as IGRA version 2 has it in columns {start + 1} to {end}: save it again."
        )
    value = int(text)
    return float("nan") if value in _MISSING else float(value)

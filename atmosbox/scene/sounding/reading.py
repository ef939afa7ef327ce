"""From a file of any format to a sounding: recognise the format by the content; units, missing values, order."""

from __future__ import annotations

import os
import re
import warnings
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError, SoundingError, shown
from atmosbox.scene.sounding.column import QUANTITIES, Table, check_plausible, in_si, stated_columns, unit_of
from atmosbox.scene.sounding.formats import FORMATS, Text
from atmosbox.scene.sounding.profile import Sounding

if TYPE_CHECKING:
    import xarray as xr

SIGNATURES = (b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")
"""How a netCDF file begins."""
_MOST_VALUES = 1_000_000
_DAMAGED = "the netCDF file is damaged or not readable by xarray: save it again"


def profile(path: str | os.PathLike[str], file: str, name: str) -> Table:
    """Return the profile in a netCDF file; `file` is its name in messages, `name` that of the ascent without a title.

    Variables are found by their standard_name, or else by their own name; pressure may be a coordinate.
    """
    import xarray as xr

    from atmosbox.file.validity import has_endless_heap

    try:
        if has_endless_heap(path):
            raise SoundingError(f"{file}: {_DAMAGED}.")
        with (
            warnings.catch_warnings(action="ignore"),
            xr.open_dataset(path, engine="netcdf4", decode_times=False, decode_timedelta=False) as dataset,
        ):
            return _table(dataset, file, name)
    except SoundingError:
        raise
    except Exception as error:  # HDF5, netCDF and xarray each fail in their own ways on a damaged or odd file
        raise SoundingError(f"{file}: {_DAMAGED}.") from error


def _table(dataset: xr.Dataset, file: str, name: str) -> Table:
    """Return the columns of an open dataset."""
    variables = {str(key): variable for key, variable in dataset.variables.items()}
    keys = list(variables)
    named = stated_columns([f"{key} [{variables[key].attrs.get('units', '')}]" for key in keys], file)
    values, units, along = {}, {}, None
    for quantity, measure in QUANTITIES.items():
        standard = [key for key in keys if variables[key].attrs.get("standard_name") == measure.names[0]]
        if not standard and quantity not in named:
            fix = f'give one the standard_name "{measure.names[0]}", or give another file'
            raise SoundingError(f"{file}: no variable is the {quantity}: {fix}.")
        key = standard[0] if standard else keys[named[quantity][0]]
        variable, what = variables[key], f"{file}: the {quantity} in {shown(key)}"
        dims = tuple(dim for dim, size in variable.sizes.items() if size != 1)
        along = along or dims  # of the pressure, which comes first
        if len(dims) != 1 or dims != along or variable.size > _MOST_VALUES:
            sizes = shown(", ".join(f"{dim} = {size}" for dim, size in variable.sizes.items()) or "no dimension")
            fix = "select one profile with xarray's isel and save it"
            raise SoundingError(f"{what} is not one value for each level of the pressure, for it has {sizes}: {fix}.")
        try:
            values[quantity] = np.asarray(variable.values, dtype=np.float64).ravel()
        except (TypeError, ValueError):
            raise SoundingError(f"{what} holds no numbers: give another file.") from None
        units[quantity] = str(variable.attrs["units"]) if "units" in variable.attrs else None
    title = str(dataset.attrs.get("title", "")).strip()[:150] or name
    places = tuple(f"level {i + 1}" for i in range(values["pressure"].size))
    return Table(file, "netCDF", title, values, units, places, file)


LARGEST_FILE = 16 * 2**20
"""Largest size of a file that is opened; a sounding has some kilobytes [byte]."""

MOST_LINES = 100_000
"""Largest number of lines of a text that is read; a report every second makes some 6000."""

LONGEST_LINE = 10_000
"""Largest length of a line that is read."""

DRY_DEPRESSION = 30.0
"""Dewpoint depression of air above the highest level with a dewpoint, as weather services coded dry air [K]."""
_LOW_MARK = -999.0  # at or below it a number marks a missing value
_HIGH_MARKS = (999.0, 999.9, 999.99, 9999.0, 9999.9, 99999.0, 99999.9)  # of temperature and dewpoint
_FIX = "give a sounding as Wyoming, IGRA, BUFKIT or SHARPpy text, CSV or netCDF"
_BINARY = re.compile(rb"[\x00-\x08\x0e-\x1a\x1c-\x1f]")


Floats = NDArray[np.float64]


def read(path: str | os.PathLike[str]) -> Sounding:
    r"""Return the sounding in a file, from the ground up.

    The format is recognised by the content: a table of the University of Wyoming, as text, as its web page or as CSV; a
    file of IGRA, version 2, or of BUFKIT, of which the first sounding is read; SHARPpy's text; a table with named
    columns (CSV); netCDF with variables as users of MetPy name them.

    See :func:`sounding_of` for the treatment of missing values.

    Raises
    ------
    FileError
        If the file is missing, unreadable, a folder, or larger than 16 MiB.
    SoundingError
        If it has more than 100 000 lines or one of more than 10 000 characters, is in no known format, lacks a column
        or a unit, or if its levels do not make an ascent.

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
    if not source.is_file():
        raise FileError(f"{file} is not a file that can be read: check the name and the folder.")
    if (size := os.path.getsize(source)) > LARGEST_FILE:
        raise FileError(f"{file} has {size / 1e6:.0f} MB, far more than a sounding: {_FIX}.")
    try:
        return source.read_bytes()
    except OSError as error:
        raise FileError(f"{file} may not be read ({error.strerror or error}): check what ls -l says of it.") from error


def _decoded(content: bytes, file: str) -> str:
    """Return the text of a file, in UTF-8 or else latin-1, or in UTF-16 if it begins with its mark."""
    wide = content.startswith((b"\xff\xfe", b"\xfe\xff"))
    with suppress(UnicodeDecodeError):
        if wide or not _BINARY.search(content):
            return content.decode("utf-16" if wide else "utf-8-sig")
    if wide or _BINARY.search(content):
        raise SoundingError(f"{file} is not a text: {_FIX}.")
    return content.decode("latin-1")


def _parsed(text: Text) -> Table:
    """Return the columns of a text in any of the formats."""
    if len(text.lines) > MOST_LINES or max(map(len, text.lines)) > LONGEST_LINE:
        raise SoundingError(f"{text.file} has far more lines, or longer ones, than a sounding: {_FIX}.")
    for parse in FORMATS:
        if (table := parse(text)) is not None:
            return table
    first, line = next(((i, line) for i, line in enumerate(text.lines) if line.strip()), (0, ""))
    raise SoundingError(
        f"{text.place(first)}: {shown(line.strip())} does not begin a sounding of a known format: name the columns, "
        "as in pressure [hPa],temperature [degC],dewpoint [degC]."
    )


def sounding_of(table: Table) -> Sounding:
    """Return the sounding in the columns of a file, after every check.

    A level without pressure or temperature is left out, and so is a level without dewpoint below another that has one,
    as in MetPy. Above the highest dewpoint, where radiosondes cease to report it, the dewpoint is set 30 K below the
    temperature. Of a level that is given twice, one is left out. The remarks list all this.

    >>> import numpy as np
    >>> columns = {
    ...     "pressure": np.array([1000.0, 850.0, 700.0, 500.0, 300.0]),
    ...     "temperature": np.array([25.0, 15.0, 5.0, -10.0, -40.0]),
    ...     "dewpoint": np.array([17.0, 12.0, -3.0, -25.0, -9999.0]),
    ... }
    >>> units = {"pressure": "hPa", "temperature": "degC", "dewpoint": "degC"}
    >>> ascent = sounding_of(Table("a.csv", "CSV", "a", columns, units, tuple("12345"), "a.csv, line 1"))
    >>> float(ascent.dewpoint[-1]), ascent.remarks[0]
    (203.15, 'Above 500 hPa no dewpoint: taken 30 K below the temperature.')
    """
    columns = {quantity: _known(table, quantity) for quantity in QUANTITIES}
    whole = ~np.isnan(columns["pressure"]) & ~np.isnan(columns["temperature"])
    if not whole.any():
        raise SoundingError(f"{table.file}: no level has both pressure and temperature: give a sounding with values.")
    for quantity, column in columns.items():
        used = np.where(whole, column, np.nan)
        if not np.isnan(used).all():
            unit = str(table.units[quantity]).strip()
            check_plausible(quantity, used, unit, lambda level: f"{table.file}, {table.places[level]}")
    rows = np.stack([in_si(each, unit_of(q, table.units[q], table.head)) for q, each in columns.items()])
    places = np.array([f"{table.file}, {place}" for place in table.places])
    remarks = [*table.remarks]

    def keep(which: NDArray[np.bool_], left_out: str) -> None:
        nonlocal rows, places
        if count := int(np.count_nonzero(~which)):
            remarks.append(f"{count} level{'s' if count > 1 else ''} {left_out}.")
        rows, places = rows[:, which], places[which]

    keep(whole, "without pressure or temperature left out")
    if rows[0, 0] < rows[0, -1]:
        rows, places = rows[:, ::-1], places[::-1]
    moist = ~np.isnan(rows[2])
    if not moist.any():
        raise SoundingError(
            f"{table.file}: no level has pressure, temperature and dewpoint: give a sounding with all three."
        )
    above = np.arange(moist.size) > np.flatnonzero(moist)[-1]
    keep(moist | above, "without dewpoint, below a level that has one, left out")
    same = np.all((rows[:, 1:] == rows[:, :-1]) | np.isnan(rows[:, 1:] + rows[:, :-1]), axis=0)
    keep(~np.r_[False, same], "given twice, used once")
    pressure, temperature, dewpoint = rows
    dry = np.isnan(dewpoint)
    if dry.any():
        highest = pressure[~dry][-1] / 100
        remarks.append(f"Above {highest:.6g} hPa no dewpoint: taken {DRY_DEPRESSION:.0f} K below the temperature.")
    name = shown(" ".join(table.name.split())) or table.file
    dewpoint = np.where(dry, temperature - DRY_DEPRESSION, dewpoint)
    source = f"{table.file}, {table.kind}"
    return Sounding(pressure, temperature, dewpoint, name, source, tuple(remarks), tuple(map(str, places)))


def _known(table: Table, quantity: str) -> Floats:
    """Return a column with NaN in place of marks of missing values, after a check that it has a unit."""
    if quantity not in table.values:
        raise SoundingError(f"{table.head}: there is no {quantity}: name its column {quantity}.")
    unit_of(quantity, table.units.get(quantity), table.head)
    column = np.array(table.values[quantity], dtype=np.float64)
    missing = column <= _LOW_MARK
    if quantity != "pressure":
        missing |= np.isin(column, _HIGH_MARKS)
    return np.where(missing, np.nan, column)

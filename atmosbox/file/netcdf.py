"""Datasets to netCDF files and back.

A file appears under its name only when it is whole: it is built in memory, written beside its place under a
hidden name, flushed to the disk and then renamed.
"""

from __future__ import annotations

import contextlib
import errno
import glob
import os
import shlex
import shutil
import time
from pathlib import Path
from typing import TypeAlias

import netCDF4
import xarray as xr

from atmosbox.errors import FileError, shown
from atmosbox.file.output_path import write_failure
from atmosbox.file.provenance import FORMAT, moment
from atmosbox.version import __version__

__all__ = ["check_writable", "part_path", "read", "replace_file", "write"]

LONGEST_NAME = 200  # bytes; file systems allow 255, and the hidden name is longer than the file's own
SMALLEST_FILE = 65536  # bytes; netCDF builds a file in blocks of this size
LEFT_OVER = 3600.0  # seconds after which a hidden file can only be that of a run that was killed

AnyPath: TypeAlias = str | os.PathLike[str]


def check_writable(path: AnyPath, force: bool = False) -> Path:
    """Refuse a place where a file cannot be written, before a run is spent on it; write nothing.

    Parameters
    ----------
    path
        The file that is to be written.
    force
        Whether it may replace a file.

    Returns
    -------
    pathlib.Path
        The file to write: `path`, or what it points to if it is a symbolic link.

    Raises
    ------
    FileError
        If the folder is missing or may not be written to, if the name is too long or a folder's, or if there
        is a file already and `force` is not given.
    DiskFullError
        If not even a small file has room.
    SettingError
        If the variable SOURCE_DATE_EPOCH of the environment is set, but is not a number of seconds.

    Examples
    --------
    >>> check_writable("no/such/folder/run.nc")
    Traceback (most recent call last):
    atmosbox.errors.FileError: The folder no/such/folder does not exist: type mkdir -p no/such/folder first.
    """
    target = Path(os.path.realpath(path) if os.path.islink(path) else path)
    folder = target.parent
    if os.path.isdir(target):
        raise FileError(f"{target} is a folder: give a file in it, such as --out {target / 'run.nc'}.")
    if len(os.fsencode(target.name)) > LONGEST_NAME:
        raise FileError(f"The name {shown(target.name)} is too long: give a shorter one with --out.")
    if not os.path.lexists(folder):
        words = shlex.quote(str(folder))
        raise FileError(f"The folder {words} does not exist: type mkdir -p {words} first.")
    if not os.path.isdir(folder):
        raise FileError(f"{folder} is a file, not a folder: give another place with --out.")
    if os.path.exists(target) and not os.path.isfile(target):
        raise FileError(f"{target} is a device, not a file: give another name with --out.")
    if os.path.exists(target) and not force:
        raise FileError(f"{target} exists already: add --force to replace it, or name another file by --out.")
    if not os.access(folder, os.W_OK | os.X_OK):
        raise FileError(f"Nothing may be written to the folder {folder}: give another place with --out.")
    if shutil.disk_usage(folder).free < SMALLEST_FILE:
        raise write_failure(OSError(errno.ENOSPC, ""), target)
    moment()
    return target


def _image(dataset: xr.Dataset) -> memoryview:
    """Return the bytes of the netCDF file of a dataset.

    The file is built in memory, because HDF5 reports a full disk as a lack of permission or as nothing in
    particular, and keeps hold of the broken file.
    """
    if "atmosbox_parameters" not in dataset.attrs:
        raise KeyError("a dataset without the attribute atmosbox_parameters could not be read again")
    whole = dataset.copy()
    for variable in whole.variables.values():
        variable.encoding.setdefault("_FillValue", None)
    return whole.to_netcdf(engine="netcdf4", format="NETCDF4")


def replace_file(path: Path, dataset: xr.Dataset) -> None:
    """Put a dataset in the place of a file, whole or not at all.

    Parameters
    ----------
    path
        The file, which `check_writable` has let through.
    dataset
        What `write` takes.

    Raises
    ------
    DiskFullError
        If the disk is full; a file that was there before is kept.
    FileError
        If the file cannot be written for another reason.
    KeyError
        If the dataset lacks the attribute ``atmosbox_parameters``.

    Examples
    --------
    >>> import tempfile
    >>> from atmosbox.file.provenance import global_attributes
    >>> run = xr.Dataset(attrs=global_attributes({}, title="A box", command="a test"))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     replace_file(Path(folder, "run.nc"), run)
    ...     read(f"{folder}/run.nc").title
    'A box'
    """
    with contextlib.suppress(OSError):
        for old in path.parent.glob(f".{glob.escape(path.name)}.*.tmp"):
            if time.time() - old.stat().st_mtime > LEFT_OVER:
                old.unlink()
    hidden = path.with_name(f".{path.name}.{os.getpid()}.tmp")
    try:
        image = _image(dataset)
        with open(hidden, "wb") as file:
            file.write(image)
            file.flush()
            os.fsync(file.fileno())
        os.replace(hidden, path)
    except OSError as error:
        raise write_failure(error, path) from error
    finally:
        hidden.unlink(missing_ok=True)


def write(dataset: xr.Dataset, path: AnyPath, *, force: bool = False) -> Path:
    """Write a dataset to a netCDF file that is there whole or not at all.

    Parameters
    ----------
    dataset
        What `atmosbox.file.dataset.dataset` made, with the attributes of `atmosbox.file.provenance.global_attributes`.
    path
        The file.
    force
        Whether it may replace a file.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    FileError
        If the file cannot be written there, for one of the reasons of `check_writable`.
    DiskFullError
        If the disk is full; no part of the file is left behind.
    KeyError
        If the dataset lacks the attribute ``atmosbox_parameters``.

    Examples
    --------
    >>> import tempfile, xarray
    >>> from atmosbox.file.provenance import global_attributes
    >>> attributes = global_attributes({"scene": "temperature"}, title="A box", command="a test")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     read(write(xarray.Dataset(attrs=attributes), f"{folder}/run.nc")).title
    'A box'
    """
    target = check_writable(path, force)
    replace_file(target, dataset)
    return target


def part_path(path: AnyPath) -> Path:
    """Return where a run that is to be written to a file keeps what it has so far.

    Examples
    --------
    >>> str(part_path("run.nc"))
    'run.part.nc'
    """
    whole = Path(path)
    return whole.with_name(f"{whole.stem}.part{whole.suffix}")


def read(path: AnyPath) -> xr.Dataset:
    """Return the run in a file, in memory; the file is closed again.

    Parameters
    ----------
    path
        A file that atmosbox wrote.

    Returns
    -------
    xarray.Dataset
        The run.

    Raises
    ------
    FileError
        If the file is missing, empty, damaged, no netCDF, of another program or of a later atmosbox.

    Examples
    --------
    >>> read("no such file.nc")
    Traceback (most recent call last):
    atmosbox.errors.FileError: no such file.nc does not exist: check the name and the folder.
    """
    source = Path(path)
    fix = "give a file that atmosbox run has written"
    if os.path.isdir(source):
        raise FileError(f"{source} is a folder: {fix}.")
    if not os.path.exists(source):
        part = part_path(source)
        hint = f"a run that was stopped left {part}, give that" if os.path.exists(part) else ""
        raise FileError(f"{source} does not exist: {hint or 'check the name and the folder'}.")
    if not os.path.isfile(source) or not os.access(source, os.R_OK):
        raise FileError(f"{source} may not be read: check what ls -l says of it, or {fix}.")
    if source.stat().st_size == 0:
        raise FileError(f"{source} is empty: {fix}.")
    try:
        with netCDF4.Dataset(source) as file:
            attributes = {name: file.getncattr(name) for name in file.ncattrs()}
        if "atmosbox_parameters" not in attributes:
            raise FileError(f"{source} was written by another program: {fix}.")
        written = str(attributes.get("atmosbox_format", FORMAT))
        if written != str(FORMAT):
            raise FileError(
                f"{source} has the format {shown(written)}, but atmosbox {__version__} reads {FORMAT}: "
                "type pip install --upgrade atmosbox."
            )
        return xr.load_dataset(source, engine="netcdf4", decode_times=False)
    except FileError:
        raise
    except (OSError, RuntimeError, ValueError) as error:
        raise FileError(f"{source} is no netCDF file, or a damaged one: {fix}.") from error

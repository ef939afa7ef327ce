"""Write datasets to netCDF files, completely or not at all, and read them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError, shown
from atmosbox.file.output_path import AnyPath, check_writable, part_path, whole_file
from atmosbox.file.provenance import FORMAT
from atmosbox.file.validity import check_valid, has_endless_heap
from atmosbox.version import __version__

if TYPE_CHECKING:
    import netCDF4
    import xarray as xr

__all__ = ["STATE", "fill", "read", "read_state", "write", "write_dataset"]

STATE = "atmosbox_state"
"""The variable that holds the state from which a run can continue; readers of results do not need it."""


def write_dataset(path: Path, dataset: xr.Dataset) -> None:
    """Write a dataset to a netCDF file whole or not at all, as `atmosbox.file.output_path.write_whole` does.

    The file is not built in memory: netCDF-C (4.6.2 to 4.10.1) builds one there that no program can append to, since
    it does not record the order in which variables are created.
    """
    import netCDF4

    if "atmosbox_parameters" not in dataset.attrs:
        raise KeyError("a dataset without the attribute atmosbox_parameters could not be read again")
    with whole_file(path) as temporary:
        # HDF5 keeps a file open for which the disk has no room, and does not say why it failed; so the room is
        # taken before, by a write that does
        temporary.write_bytes(bytes(50_000 + 2_000 * len(dataset.variables) + dataset.nbytes))
        name = os.fsencode(temporary).decode("latin-1")  # the bytes of the name, whatever the language of the system
        try:
            fill(netCDF4.Dataset(name, "w", format="NETCDF4", encoding="latin-1"), dataset)
        except (OSError, RuntimeError, UnicodeError) as error:
            os.truncate(temporary, 0)  # the room comes back, even if HDF5 keeps the file open
            raise OSError(str(error)) from error


def fill(file: netCDF4.Dataset, dataset: xr.Dataset) -> None:
    """Write a dataset to an open netCDF file, and close it."""
    from xarray.backends import NetCDF4DataStore

    whole = dataset.copy()
    for variable in whole.variables.values():
        variable.encoding.setdefault("_FillValue", None)
    try:
        # not Dataset.to_netcdf, which first imports Dask, if that is installed, to look for its scheduler
        whole.dump_to_store(NetCDF4DataStore(file))  # type: ignore[no-untyped-call]
    finally:
        file.close()


def write(dataset: xr.Dataset, path: AnyPath, *, force: bool = False) -> Path:
    """Write a dataset to a netCDF file, completely or not at all; `force` lets it replace a file.

    Examples
    --------
    >>> import tempfile, xarray
    >>> from atmosbox.file.provenance import global_attributes
    >>> attributes = global_attributes({"scene": "temperature"}, title="A box", command="a test")
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     read(write(xarray.Dataset(attrs=attributes), f"{folder}/run.nc")).title
    'A box'
    """
    found = check_writable(path, force)
    write_dataset(found, dataset)
    return found


def read(path: AnyPath) -> xr.Dataset:
    """Load the run in a file into memory; the file is closed again.

    Raises
    ------
    FileError
        If the file is missing, empty, damaged, not netCDF, of another program, in another format than this atmosbox
        reads, or does not fit into memory.

    Examples
    --------
    >>> read("no such file.nc")
    Traceback (most recent call last):
    atmosbox.errors.FileError: no such file.nc does not exist: check the name and the folder.
    """
    source = Path(path)
    fix = "give a file that atmosbox has written"
    if os.path.isdir(source):
        raise FileError(f"{source} is a folder: {fix}.")
    if not os.path.exists(source):
        part = part_path(source)
        hint = f"a run that was stopped left {part}, give that" if os.path.exists(part) else ""
        hint = f"did you mean {source}.nc" if os.path.isfile(f"{source}.nc") else hint
        raise FileError(f"{source} does not exist: {hint or 'check the name and the folder'}.")
    if not os.path.isfile(source) or not os.access(source, os.R_OK):
        raise FileError(f"{source} may not be read: check what ls -l says of it, or {fix}.")
    if source.stat().st_size == 0:
        raise FileError(f"{source} is empty: {fix}.")

    import netCDF4
    import xarray as xr

    damaged = f"{source} is not a netCDF file, or is damaged: {fix}."
    try:
        if has_endless_heap(source):
            raise FileError(damaged)
        with netCDF4.Dataset(source) as file:
            attributes = {name: file.getncattr(name) for name in file.ncattrs()}
            if "atmosbox_parameters" not in attributes:
                raise FileError(f"{source} was written by another program: {fix}.")
            written = str(attributes.get("atmosbox_format", FORMAT))
            if written != str(FORMAT):
                problem = f"{source} has the format {shown(written)}, but atmosbox {__version__} reads {FORMAT}"
                raise FileError(f"{problem}: type pip install --upgrade atmosbox.")
            check_valid(file, source)
        found = xr.load_dataset(source, engine="netcdf4", decode_times=False, drop_variables=[STATE])
        return found.rename(rung="configuration") if "rung" in found.dims else found  # the name in earlier versions
    except FileError:
        raise
    except (OSError, RuntimeError, ValueError, TypeError, LookupError, AttributeError) as error:
        raise FileError(damaged) from error


def read_state(path: AnyPath) -> NDArray[np.uint8] | None:
    """Return the bytes of the saved state in a file that `read` can read; None if the file holds no state."""
    import netCDF4

    with netCDF4.Dataset(path) as file:
        return np.array(file.variables[STATE][:], np.uint8) if STATE in file.variables else None

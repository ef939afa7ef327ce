"""Profiles in netCDF files, as xarray and MetPy write them."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING

import numpy as np

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.sounding.column import QUANTITIES, Table, stated_columns

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["SIGNATURES", "profile"]

SIGNATURES = (b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")
"""How a netCDF file begins."""
_MOST_VALUES = 1_000_000
_DAMAGED = "the netCDF file is damaged or not readable by xarray: save it again"


def profile(path: str | os.PathLike[str], file: str, name: str) -> Table:
    """Return the profile in a netCDF file; `file` is its name in messages, `name` that of the ascent without a title.

    Variables are found by their standard_name, or else by their own name; pressure may be a coordinate.

    Raises
    ------
    SoundingError
        If the file is damaged, lacks a variable, or holds more than one profile.

    Examples
    --------
    >>> import tempfile
    >>> import xarray as xr
    >>> ascent = xr.Dataset({name: ("level", [280.0, 275.0], {"units": "K"}) for name in ("temperature", "dewpoint")})
    >>> ascent = ascent.assign_coords(level=("level", [1000.0, 850.0], {"units": "hPa"}))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = ascent.to_netcdf(f"{folder}/a.nc")
    ...     profile(f"{folder}/a.nc", "a.nc", "a").values["pressure"]
    array([1000.,  850.])
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

"""Profiles in netCDF files, as xarray and MetPy write them."""

from __future__ import annotations

import os
import warnings
from typing import TYPE_CHECKING

import numpy as np

from atmosbox.errors import SoundingError, shown
from atmosbox.scene.sounding.column import QUANTITIES, REQUIRED, stated_columns
from atmosbox.scene.sounding.tabulated import Table

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["parse", "recognised"]

_SIGNATURES = (b"\x89HDF\r\n\x1a\n", b"CDF\x01", b"CDF\x02", b"CDF\x05")
_MOST_VALUES = 1_000_000
_DAMAGED = "the netCDF file is damaged or not readable by xarray: save it again"


def recognised(head: bytes) -> bool:
    r"""Return whether a file that starts with these bytes is netCDF or HDF5.

    Parameters
    ----------
    head
        The first eight bytes.

    Examples
    --------
    >>> recognised(b"CDF\x02abcd")
    True
    """
    return head.startswith(_SIGNATURES)


def parse(path: str | os.PathLike[str], file: str, name: str) -> Table:
    """Return the profile in a netCDF file.

    Variables are found by their standard_name, or else by their own name; pressure may be a coordinate.

    Parameters
    ----------
    path
        The file.
    file
        The name of the file in messages.
    name
        The name of the ascent if the file has no title.

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
    ...     parse(f"{folder}/a.nc", "a.nc", "a").values["pressure"]
    array([1000.,  850.])
    """
    import xarray as xr

    from atmosbox.file.heap import has_endless_heap

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
    found = _found(variables, file)
    for quantity in REQUIRED:
        if quantity not in found:
            standard = QUANTITIES[quantity].names[0]
            raise SoundingError(
                f'{file}: no variable is the {quantity}: give one the standard_name "{standard}", or give another file.'
            )
    profiles = {quantity: _squeezed(variables[key]) for quantity, key in found.items()}
    pressure = profiles["pressure"]
    if "height" in profiles and profiles["height"].dims != pressure.dims:  # such as the height of a thermometer
        del profiles["height"]
    for quantity, variable in profiles.items():
        if variable.ndim != 1 or variable.size > _MOST_VALUES:
            sizes = ", ".join(f"{dim} = {size}" for dim, size in variables[found[quantity]].sizes.items())
            raise SoundingError(
                f"{file}: the {quantity} in {shown(found[quantity])} is not one profile, for it has "
                f"{shown(sizes) if sizes else 'no dimension'}: select one with xarray's isel and save it."
            )
        if variable.dims != pressure.dims:
            raise SoundingError(
                f"{file}: {shown(found[quantity])} runs along {shown(str(variable.dims[0]))}, but the pressure along "
                f"{shown(str(pressure.dims[0]))}: interpolate it to the levels of the pressure."
            )
    values = {}
    for quantity, variable in profiles.items():
        try:
            values[quantity] = np.asarray(variable.values, dtype=np.float64)
        except (TypeError, ValueError):
            raise SoundingError(f"{file}: {shown(found[quantity])} holds no numbers: give another file.") from None
        if (odd := np.flatnonzero(np.isinf(values[quantity]))).size:
            where = f"{file}, level {odd[0] + 1}"
            raise SoundingError(f"{where}: the {quantity} is not finite: correct it, or write NaN.")
    title = str(dataset.attrs.get("title", "")).strip()[:150] or name
    units = {quantity: _unit(variables[key]) for quantity, key in found.items() if quantity in values}
    places = tuple(f"level {i + 1}" for i in range(values["pressure"].size))
    return Table(file, "netCDF", title, values, units, places, file)


def _found(variables: dict[str, xr.Variable], file: str) -> dict[str, str]:
    """Return the variable of each quantity, found by standard_name, or else by its own name."""
    keys = list(variables)
    named = stated_columns([f"{key} [{variables[key].attrs.get('units', '')}]" for key in keys], file)
    found = {quantity: keys[i] for quantity, (i, _) in named.items()}
    for quantity, measure in QUANTITIES.items():
        known = measure.names if quantity == "height" else measure.names[:1]
        standard = [key for key in keys if variables[key].attrs.get("standard_name") in known]
        if standard:
            found[quantity] = standard[0]
    return found


def _squeezed(variable: xr.Variable) -> xr.Variable:
    """Return a variable without its dimensions of size one; its data are still in the file."""
    return variable.isel({dim: 0 for dim, size in variable.sizes.items() if size == 1})


def _unit(variable: xr.Variable) -> str | None:
    """Return the unit of a variable, None if it has none."""
    unit = variable.attrs.get("units")
    return None if unit is None else str(unit)

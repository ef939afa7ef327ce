"""How a variable of a file is declared: its attributes and how it is stored.

All values are in SI units. A *ledger* variable is part of the state (energies, counts, positions), so a value
that is not finite means that the run is broken. Any other variable may be NaN where there was nothing to measure, for
example in a layer that no molecule visited. The variables themselves are listed in :mod:`atmosbox.file.variables`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["SUFFIXES", "Variable", "derived"]

CHUNK_FRAMES = 100  # largest number of frames in a block of data that is compressed as one
CHUNK_VALUES = 1_000_000  # largest number of values in a block


@dataclass(frozen=True)
class Variable:
    """The declaration of one variable of a file.

    Parameters
    ----------
    name, dims
        Its name in the file and the names of its dimensions, none for a single number.
    units
        Its SI unit as UDUNITS writes it; empty for labels and flags, which have none.
    long_name
        What the variable is, in words.
    standard_name
        Its name in the CF standard name table, if the table has one and no other variable here uses it.
    cell_methods
        How a value represents its cell, for example ``elapsed_time: mean``.
    dtype
        numpy's code of the type in the file: ``f8``, ``f4``, ``i8``, ``i1``, or ``U`` for labels.
    ledger
        Whether the variable is part of the state of the run, so that all its values must be finite.
    difference
        Whether a temperature is a difference of two temperatures, and not a temperature on the scale.
    axis, positive
        CF's attributes of a vertical coordinate.
    coordinate
        Whether the variable is an auxiliary coordinate, such as the pressure of the parcel: other variables can be
        drawn against it.
    comment
        What else a reader must know.
    flags
        The meanings of the values 0, 1, 2, ... of a flag.

    Examples
    --------
    The file says that a pressure is the mean over its frame:

    >>> pressure = Variable("air_pressure", ("elapsed_time",), "Pa", "pressure", cell_methods="elapsed_time: mean")
    >>> pressure.attributes()["cell_methods"]
    'elapsed_time: mean'
    """

    name: str
    dims: tuple[str, ...]
    units: str
    long_name: str
    standard_name: str | None = None
    cell_methods: str | None = None
    dtype: str = "f8"
    ledger: bool = False
    difference: bool = False
    axis: str | None = None
    positive: str | None = None
    coordinate: bool = False
    comment: str | None = None
    flags: tuple[str, ...] = ()

    @property
    def units_metadata(self) -> str | None:
        """The CF attribute of a temperature: whether it is on the scale or a difference, as in every lapse rate."""
        parts = self.units.split()
        if not any(part.startswith("K") and not part[1:].strip("-0123456789") for part in parts):
            return None
        return f"temperature: {'difference' if self.difference or len(parts) > 1 else 'on_scale'}"

    def attributes(self) -> dict[str, Any]:
        """Return the netCDF attributes that are set."""
        known = {
            "standard_name": self.standard_name,
            "long_name": self.long_name,
            "units": self.units or None,
            "units_metadata": self.units_metadata,
            "cell_methods": self.cell_methods,
            "axis": self.axis,
            "positive": self.positive,
            "comment": self.comment,
            "flag_values": np.arange(len(self.flags), dtype=self.dtype) if self.flags else None,
            "flag_meanings": " ".join(self.flags) or None,
        }
        return {name: value for name, value in known.items() if value is not None}

    def encoding(self, shape: tuple[int, ...]) -> dict[str, Any]:
        """Return how xarray stores an array of this shape: its type, fill value, chunks and compression."""
        if self.dtype == "U":
            return {"dtype": "S1", "_FillValue": None}
        missing = np.array(np.nan, self.dtype)[()] if self.dtype[0] == "f" and not self.ledger else None
        stored: dict[str, Any] = {"dtype": self.dtype, "_FillValue": missing}
        if self.dims[:2] == ("elapsed_time", "molecule"):
            frames = max(1, min(CHUNK_FRAMES, shape[0]))
            components = math.prod(shape[2:])
            molecules = max(1, min(shape[1], CHUNK_VALUES // (frames * components)))
            chunks = (frames, molecules, *shape[2:])
            stored |= {"zlib": True, "complevel": 4, "shuffle": True, "chunksizes": chunks}
        return stored

    def holding(self, values: npt.ArrayLike) -> xr.Variable:
        """Return values as a variable of a dataset, with these attributes and this encoding."""
        import xarray as xr

        return xr.Variable(self.dims, values, self.attributes(), self.encoding(np.shape(values)))


SUFFIXES = ("_se", "_count", "_theory", "_tolerance")
"""Endings of the names of variables that are derived from another variable."""


def derived(parent: Variable, suffix: str) -> Variable:
    """Return the declaration of a variable's standard error, number of samples, closed-form answer or tolerance.

    Examples
    --------
    >>> pressure = Variable("air_pressure", ("elapsed_time",), "Pa", "pressure of the air on the walls")
    >>> derived(pressure, "_theory").long_name
    'closed-form answer for the pressure of the air on the walls'
    """
    name, words = parent.name + suffix, parent.long_name
    plain = replace(parent, name=name, cell_methods=None, ledger=False, comment=None, dtype="f8", coordinate=False)
    if suffix == "_theory":
        return replace(plain, long_name=f"closed-form answer for the {words}", standard_name=None)
    plain = replace(plain, positive=None, difference=True)
    if suffix == "_tolerance":
        return replace(plain, long_name=f"allowed deviation from theory of the {words}", standard_name=None)
    if suffix == "_count":
        words = f"number of samples of the {words}"
        return replace(plain, long_name=words, standard_name="number_of_observations", units="1")
    standard = parent.standard_name and f"{parent.standard_name} standard_error"
    return replace(plain, long_name=f"standard error of the {words}", standard_name=standard)

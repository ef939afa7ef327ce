"""How a variable of a file is declared, and what a file says and stores of it.

Values are SI throughout. A *ledger* variable is one of the state (energies, counts, positions), so a value
that is not finite means that the run is broken. Any other may be NaN where there was nothing to measure, as in a
layer that no molecule visited. The variables themselves stand in :mod:`atmosbox.file.variables`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

__all__ = ["SUFFIXES", "Variable", "derived"]

CHUNK_FRAMES = 100  # the frames of some molecules that are compressed as one block
CHUNK_VALUES = 1_000_000  # the most numbers in a block


@dataclass(frozen=True)
class Variable:
    """What a file says about one of its variables.

    Parameters
    ----------
    name, dims
        Its name in the file and the names of its dimensions, none for a single number.
    units
        Its SI unit as UDUNITS writes it; empty for labels and flags, which have none.
    long_name
        What it is, in words.
    standard_name
        Its name in the CF standard name table, if that has one and no other variable has it; none is invented.
    cell_methods
        How a value stands for its cell, for example ``elapsed_time: mean``.
    dtype
        numpy's code of the type in the file: ``f8``, ``f4``, ``i8``, ``i1``, or ``U`` for labels.
    ledger
        Whether the variable is of the state of the run, so that all its values must be finite.
    difference
        Whether a temperature is a difference of two, and not one on the scale of a thermometer.
    axis, positive
        CF's marks of a vertical coordinate.
    coordinate
        Whether it is an auxiliary coordinate: a place, such as the pressure at which the parcel is, along which the
        others can be drawn.
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
        """What CF asks of a temperature: whether it is on the scale or a difference, as every lapse rate is."""
        parts = self.units.split()
        if not any(part.startswith("K") and not part[1:].strip("-0123456789") for part in parts):
            return None
        return f"temperature: {'difference' if self.difference or len(parts) > 1 else 'on_scale'}"

    def attributes(self) -> dict[str, Any]:
        """Return the netCDF attributes, without those that are not set."""
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
        """Return how xarray shall store an array of this shape: its fill value, chunks and compression."""
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


SUFFIXES = ("_se", "_count", "_theory", "_tolerance")
"""What the name of a variable ends in that is derived from another."""


def derived(parent: Variable, suffix: str) -> Variable:
    """Return the companion of a variable: its standard error, count, answer or tolerance.

    Parameters
    ----------
    parent
        The variable that is measured.
    suffix
        One of `SUFFIXES`.

    Returns
    -------
    Variable
        The declaration of the companion.

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

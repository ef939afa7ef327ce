"""From the SI units of a file to the units of a graph."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.errors import FileError
from atmosbox.scene.conversion import known_unit, power_of_ten, spelled

__all__ = ["convert", "labelled", "of_difference", "power_of_ten", "spelled"]


def convert(
    value: ArrayLike, unit: str, shown: str, *, name: str = "value", difference: bool = False
) -> NDArray[np.float64]:
    """Convert a quantity from the units of the file to the units that are shown.

    Parameters
    ----------
    value : array_like
        The quantity, in ``unit``.
    unit : str
        The units in the file.
    shown : str
        The units to show; empty for those of the file.
    name : str
        Name of the quantity in an error message.
    difference : bool
        Whether the value is a difference or an error, to which no offset is added: a difference of 1 K is one of
        1 degC.

    Returns
    -------
    ndarray of float
        The quantity in ``shown``, in the shape of ``value``.

    Raises
    ------
    FileError
        If the units cannot be converted into each other.

    Examples
    --------
    Water freezes at 0 degC, and a difference of 10 K is one of 10 degC:

    >>> float(convert(273.15, "K", "degC")), float(convert(10.0, "K", "degC", difference=True))
    (0.0, 10.0)
    """
    numbers = np.asarray(value, dtype=np.float64)
    shown = shown or unit
    if shown == unit:
        return numbers
    there, here = known_unit(unit), known_unit(shown)
    if there is None or here is None or there.si != here.si:
        raise FileError(
            f"The file holds {name} in {unit!r}, which cannot be drawn in {shown!r}: "
            "run the scene again with this version of atmosbox."
        )
    offset = 0.0 if difference else there.offset - here.offset
    return (numbers * (there.up / there.down) + offset) * (here.down / here.up)


def of_difference(unit: str) -> str:
    """Return the unit of a difference of two quantities: the difference of two temperatures in degC is in kelvin.

    Parameters
    ----------
    unit : str
        The unit of the two quantities.

    Returns
    -------
    str
        The unit of their difference.

    Examples
    --------
    >>> of_difference("degC"), of_difference("hPa")
    ('K', 'hPa')
    """
    return "K" if unit == "degC" else unit


def labelled(label: str, unit: str, power: int = 0) -> str:
    """Return the label of an axis: the quantity and, unless it is a pure number, its unit in brackets.

    Parameters
    ----------
    label : str
        What the axis shows.
    unit : str
        Its unit, as files write it.
    power : int
        Exponent of the power of ten by which the numbers on the axis must be multiplied; 0 for none.

    Examples
    --------
    >>> labelled("speed", "m s-1"), labelled("molecules", "1"), labelled("molecules", "1", 6)
    ('speed (m/s)', 'molecules', 'molecules (10⁶)')
    """
    return label if unit == "1" and not power else f"{label} ({spelled(unit, power)})"

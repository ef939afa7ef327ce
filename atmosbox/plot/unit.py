"""From the SI units of a file to the units that a graph is read in."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.errors import FileError
from atmosbox.scene.conversion import known_unit

_SIGNS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_SPELLINGS = {"degC": "°C", "um": "µm", "us": "µs", "percent": "%"}


def convert(
    value: ArrayLike, unit: str, shown: str, *, name: str = "value", difference: bool = False
) -> NDArray[np.float64]:
    """Return a quantity in the units that it is shown in.

    Parameters
    ----------
    value : array_like
        The quantity, in ``unit``.
    unit : str
        The units in the file.
    shown : str
        The units to show; empty for those of the file.
    name : str
        What the quantity is called if it must be refused.
    difference : bool
        Whether the value is a difference or an error, which has no zero point: 1 K is 1 degC.

    Returns
    -------
    ndarray of float
        The quantity in ``shown``, in the shape of ``value``.

    Raises
    ------
    FileError
        If the one unit cannot be turned into the other.

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
    """Return the unit of a difference: that of two temperatures in degC is the kelvin.

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


def spelled(unit: str, power: int = 0) -> str:
    """Return a unit as it is printed, if need be with a power of ten.

    Parameters
    ----------
    unit : str
        The unit as files write it, "m s-1" for instance.
    power : int
        The power of ten that the numbers beside it are to be multiplied by.

    Returns
    -------
    str
        The unit with raised exponents.

    Examples
    --------
    >>> spelled("m s-1"), spelled("degC"), spelled("1", power=-15)
    ('m s⁻¹', '°C', '10⁻¹⁵')
    """
    words = [_SPELLINGS.get(word) or _raised(word) for word in unit.split()]
    if power:
        words = [power_of_ten(power), *(word for word in words if word != "1")]
    return " ".join(words)


def labelled(label: str, unit: str, power: int = 0) -> str:
    """Return what stands at an axis: what it shows and in which unit, which a bare number has not.

    Parameters
    ----------
    label : str
        What the axis shows.
    unit : str
        Its unit, as files write it.
    power : int
        The power of ten that the numbers beside it are to be multiplied by.

    Examples
    --------
    >>> labelled("speed", "m s-1"), labelled("molecules", "1"), labelled("molecules", "1", 6)
    ('speed (m s⁻¹)', 'molecules', 'molecules (10⁶)')
    """
    return label if unit == "1" and not power else f"{label} ({spelled(unit, power)})"


def power_of_ten(power: int) -> str:
    """Return a power of ten as it is printed.

    Parameters
    ----------
    power : int
        The exponent.

    Returns
    -------
    str
        The power, with a raised exponent.

    Examples
    --------
    >>> power_of_ten(25)
    '10²⁵'
    """
    return "10" + str(power).translate(_SIGNS)


def _raised(word: str) -> str:
    """Return one factor of a unit with its exponent, if it has one, raised."""
    base = word.rstrip("-0123456789")
    return base + word[len(base) :].translate(_SIGNS) if base else word

"""The box on the page: its sides, the laws of its walls, and the unit of length that is shown."""

from __future__ import annotations

import math
from dataclasses import dataclass

from atmosbox.file.molecules import Molecules

__all__ = ["Box", "length_text", "length_unit", "page_box"]

_UNITS = {"nm": 1e-9, "µm": 1e-6, "mm": 1e-3, "m": 1.0, "km": 1e3}
_WALLS = 6


@dataclass(frozen=True)
class Box:
    """The box at its start.

    Parameters
    ----------
    length : (axis,)
        Its three sides [m].
    walls : (wall,)
        The law of each wall: ``specular``, ``periodic``, ``heat_bath``, ``piston`` or ``pool``, in the order x low,
        x high, y low, y high, z low, z high.
    wall_temperature : (wall,)
        Temperature of each wall [K]; None for a wall without one.
    planar : bool
        Whether the molecules do not move along y.
    gravity : bool
        Whether there is gravity.
    reach : float, optional
        Greatest height of the ceiling during the run [m], if it is known.

    Examples
    --------
    >>> Box(length=(2e-8, 2e-8, 3e-8)).unit
    'nm'
    """

    length: tuple[float, float, float]
    walls: tuple[str, ...] = ("specular",) * _WALLS
    wall_temperature: tuple[float | None, ...] = (None,) * _WALLS
    planar: bool = False
    gravity: bool = False
    reach: float | None = None

    @property
    def unit(self) -> str:
        """The unit in which its sides are shown."""
        return length_unit(max(self.length))

    @property
    def metre(self) -> float:
        """One metre in the unit that is shown."""
        return 1.0 / _UNITS[self.unit]

    def as_record(self) -> dict[str, object]:
        """Return the box as data for the page, its lengths in the unit that is shown."""
        length = [side * self.metre for side in self.length]
        warm = [t if t is not None and math.isfinite(t) else None for t in self.wall_temperature]
        return {
            "unit": self.unit,
            "length": length,
            "reach": max(length[2], (self.reach or 0.0) * self.metre),
            "walls": list(self.walls),
            "wall_temperature": warm,
            "planar": self.planar,
            "gravity": self.gravity,
        }


def page_box(seen: Molecules) -> Box:
    """Return the box of a saved run.

    Parameters
    ----------
    seen : Molecules
        The molecules of the run and their box.

    Examples
    --------
    >>> import numpy as np
    >>> none = np.zeros((1, 0))
    >>> sides, unknown = np.array([[2e-8, 2e-8, 3e-8]]), np.full((1, 6), np.nan)
    >>> air = Molecules(False, none, none, none, none, none, None, sides, ("specular",) * 6, unknown, False, False)
    >>> page_box(air).length
    (2e-08, 2e-08, 3e-08)
    """
    x, y, z = (float(side) for side in seen.side[0])
    warm = tuple(float(value) if math.isfinite(value) else None for value in seen.wall_temperature[0])
    reach = None if seen.discs else float(seen.side[:, 2].max())
    return Box((x, y, z), seen.walls, warm, seen.planar, seen.gravity, reach)


def length_unit(length: float) -> str:
    """Return the unit in which a length is shown.

    Parameters
    ----------
    length : float
        The length [m].

    Returns
    -------
    str
        The largest of nm, µm, mm, m and km that is not longer than the length; nm for shorter lengths.

    Examples
    --------
    >>> length_unit(2.1e-8), length_unit(1.0), length_unit(25e3)
    ('nm', 'm', 'km')
    """
    known = [name for name, size in _UNITS.items() if length >= 0.999 * size]
    return known[-1] if known else "nm"


def length_text(length: float, figures: int = 2) -> str:
    """Return a length as text.

    Parameters
    ----------
    length : float
        The length [m].
    figures : int
        Number of significant digits.

    Returns
    -------
    str
        The number and its unit.

    Examples
    --------
    >>> length_text(6.93e-9), length_text(129.898, 3)
    ('6.9 nm', '130 m')
    """
    unit = length_unit(length)
    return f"{length / _UNITS[unit]:.{figures}g} {unit}"

"""The box on the stage: its sides, what its walls do, and the unit in which it is measured."""

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
        What each wall is: ``specular``, ``periodic``, ``heat_bath``, ``piston`` or ``pool``, in the order x low,
        x high, y low, y high, z low, z high.
    wall_temperature : (wall,)
        Their temperatures [K], None for a wall that has none.
    planar : bool
        Whether nothing moves along y.
    gravity : bool
        Whether molecules fall.
    reach : float, optional
        How high the ceiling will come [m], where that is known.

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
        """The unit in which its sides are read."""
        return length_unit(max(self.length))

    @property
    def metre(self) -> float:
        """One metre in that unit."""
        return 1.0 / _UNITS[self.unit]

    def as_record(self) -> dict[str, object]:
        """Return the box as data for the page, in its own unit."""
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
    """Return the unit in which a length is read.

    Parameters
    ----------
    length : float
        The length [m].

    Returns
    -------
    str
        The largest of nm, µm, mm, m and km of which it holds at least one; nm for what is smaller.

    Examples
    --------
    >>> length_unit(2.1e-8), length_unit(1.0), length_unit(25e3)
    ('nm', 'm', 'km')
    """
    known = [name for name, size in _UNITS.items() if length >= 0.999 * size]
    return known[-1] if known else "nm"


def length_text(length: float, figures: int = 2) -> str:
    """Return a length as it is read.

    Parameters
    ----------
    length : float
        The length [m].
    figures : int
        How many figures are written.

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

"""How large the box of a parcel is, and how its piston follows."""

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.units import Scale

__all__ = ["CLOSING", "FLATNESS", "size_of_parcel"]

FLATNESS = 0.4
"""Height of the box over its width: it ends nearly as high as it is wide, and a slow piston works with less noise."""
CLOSING = 20.0
"""Within how many mean free times the piston closes a gap of pressure."""


def size_of_parcel(
    scale: Scale, molecules: int, pressure: float, *, ideal: bool, flatness: float = FLATNESS
) -> tuple[float, NDArray[np.float64], float]:
    """Return density, sides that centres can reach, and (Z - 1) / n, in diameters, at a pressure [Pa] and kT = 1.

    Molecules of an ideal gas take no room, and Z is 1.
    """
    wanted = pressure / scale.pressure
    density = wanted
    sides, excess = np.ones(3), 0.0
    for _ in range(60):
        side = (molecules / density / flatness) ** (1.0 / 3.0)
        sides = side * np.array([1.0, 1.0, flatness])
        excess = float(law.gas_pressure(density, 1.0, 1.0)) - density
        excess *= 0.0 if ideal else law.contact_share(sides, 1.0, molecules)
        density *= wanted / (density + excess)
    return density, sides, excess / density**2

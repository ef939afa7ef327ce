"""When time can go no further, and the sentence that tells the user why."""

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.packing import packing_fraction
from atmosbox.engine.core.parcel import Parcel
from atmosbox.engine.core.walls import WALL_NAMES

_JAMMED, _JAMMED_PLANE = 0.63, 0.82  # random close packing, of spheres and of discs


def crushing_height(sides: NDArray[np.float64], diameter: NDArray[np.float64], *, planar: bool) -> float:
    """Return the lowest ceiling [length]: 0.6 of the box filled, 1.02 diameters, or 0.001 of the first height."""
    lowest = 1e-3 * float(sides[2])
    if diameter.size:
        filled = packing_fraction([float(sides[0]), float(sides[1]), 1.0], diameter, planar=planar)
        lowest = max(lowest, filled / 0.6, 1.02 * float(diameter.max()))
    return lowest


def is_jammed(parcel: Parcel, molecules: NDArray[np.void], mass: NDArray[np.float64], start_energy: float) -> bool:
    """Return whether the piston has heated the molecules a million times, as only a piston that crushes them can.

    Between jammed spheres the gaps shrink to zero while the speeds grow as the inverse of the gaps: events have no end.
    """
    m = molecules[: len(mass)]  # any drops come after them
    kinetic = 0.5 * float(np.sum(mass * (m["vx"] ** 2 + m["vy"] ** 2 + m["vz"] ** 2)))
    baths = [float(kT) for kT in parcel.wall_kT() if math.isfinite(kT)]
    usual = start_energy + 2.0 * float(mass.sum()) * parcel.piston_velocity**2
    return kinetic > 1e6 * (usual + 2.0 * parcel.number * max(baths, default=0.0))


def why_crowded(parcel: Parcel) -> str:
    """Return the sentence for a molecule of the liquid that finds no place in the gas."""
    filled = packing_fraction(list(parcel.length), parcel.diameter)
    return (
        f"a molecule that evaporates finds no place among the {parcel.number} others, which fill {filled:.3g} of the "
        "box: take fewer molecules, a smaller diameter, or a larger box"
    )


def why_crushed(parcel: Parcel) -> str:
    """Return the sentence for a piston that has come down too far."""
    return (
        f"the piston has come down to {parcel.ceiling:.6g} at t = {parcel.time:.6g}, where it would crush the "
        "molecules: stop it earlier, or let it move more slowly"
    )


def why_stalled(parcel: Parcel) -> str:
    """Return the sentence that says why very many events happen in no time, and what to change."""
    if parcel.piston_velocity < 0.0:
        return why_crushed(parcel)
    sides, widest = parcel.length, float(parcel.diameter.max(initial=0.0))
    tight = [axis for axis in range(3) if not parcel.periodic[axis] and not (parcel.planar and axis == 1)]
    tight = [axis for axis in tight if sides[axis] - widest < 1e-6 * widest]
    filled = packing_fraction(list(sides), parcel.diameter, planar=parcel.planar)
    kT = parcel.wall_kT()
    coldest = min((w for w in range(6) if math.isfinite(kT[w])), key=lambda w: kT[w], default=None)
    mean = 2.0 * parcel.energy()[0] / (3.0 * parcel.number)
    gravity = parcel.gravity
    if tight:
        axis = tight[0]
        cause = (
            f"length = {sides[axis]:.6g} along {'xyz'[axis]} leaves a diameter of {widest:.6g} no room to move: "
            "make the box longer, or the diameter smaller"
        )
    elif filled > (_JAMMED_PLANE if parcel.planar else _JAMMED):
        cause = (
            f"the {parcel.number} molecules fill {filled:.3g} of the box and are jammed: take fewer molecules, a "
            "smaller diameter, or a larger box"
        )
    elif coldest is not None and (kT[coldest] <= 1e-6 * mean or kT[coldest] < 1e-100 or gravity > 0.0):
        cause = (
            f"wall {WALL_NAMES[coldest]} at kT = {kT[coldest]:.3g} is too cold: "
            f"warm it{f', or reduce the gravity of {gravity:.3g}' if gravity else ''}"
        )
    elif gravity > 0.0:
        cause = f"molecules come to rest: reduce the gravity of {gravity:.3g}, or give them more energy"
    else:
        cause = (
            f"molecules are jammed somewhere, although they fill no more than {filled:.3g} of the box: take fewer "
            "molecules, or a smaller diameter"
        )
    return f"events pile up without end at t = {parcel.time:.6g}: {cause}"

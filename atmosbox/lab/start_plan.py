"""How a page draws and places molecules with any seed: the start that a scene declares, as the kernel takes it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import EqualSpeeds, Maxwell, Placed, Rotating, Scattered
from atmosbox.engine import Start as Declared
from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.lift import Gauges
from atmosbox.engine.core.walls import first_bath_kT
from atmosbox.engine.start.overlap import bins_of, spheres_of
from atmosbox.lab.kernels.starting import DRAWN, NUMBERED, Cleared, Start


def is_drawn(parcel: Any) -> bool:
    """Return whether a page can draw the start of a box for any seed.

    It cannot if the scene does not declare the start, or gives the places of the molecules.
    """
    modes, start = parcel.arrays().modes, parcel.start
    if start is None or not parcel.number or (modes.gravity and (modes.mixed or not modes.rows)):
        return False
    return not any(isinstance(p, Placed) or (isinstance(p, Rotating) and np.ndim(p.kT)) for p in start.parts)


def start_of(parcel: Any, layout: Any) -> Start:
    """Return the data of the kernel ``start`` of a box.

    Nothing is drawn in a box whose start a page cannot draw: the kernel needs the data only to be loaded.
    """
    arrays = parcel.arrays()
    declared = parcel.start if is_drawn(parcel) else Declared(parcel.number, ())
    given: dict[str, Any] = {part.draws: part for part in declared.parts}
    places, moving = given.get("position", Scattered()), given.get("velocity", Maxwell(0.0))
    turning = given.get("rotational_energy", Rotating(0.0))
    n, planar = parcel.number, bool(parcel.planar)
    mass, degrees = np.array(parcel.mass), np.array(parcel.rotation)
    sides = parcel.length
    spread = _spread(parcel, sides)
    sides[2] = sides[2] if places.top is None else places.top
    spheres = spheres_of(np.array(parcel.diameter), sides, parcel.periodic, planar)
    equal = isinstance(moving, EqualSpeeds)
    kT = np.broadcast_to(0.0 if equal else np.asarray(moving.kT, np.float64), (n,))
    exact = not equal and moving.exact and n > 1 and kT.mean() > 0.0
    centre = np.array(places.centre, np.float64).reshape(-1, 3)
    warmest = float(np.nanmax([0.0, *parcel.wall_kT()]))  # of the walls
    return Start(
        parts=np.array([DRAWN.index(part.draws) for part in declared.parts], np.int64),
        numbered=NUMBERED.index(places.numbered),
        scale_height=float(places.scale_height or 0.0),
        speed=float(moving.speed) if equal else 0.0,
        twice=(2.0 if planar else 3.0) * float(kT.sum()) if exact else 0.0,
        weight=float(mass.sum()),
        rotating=0.5 * float(turning.kT * degrees.sum()) if turning.exact else 0.0,
        warmth=float(turning.kT),
        condensed=float(parcel.condensed_energy),
        warm=math.sqrt(8.0 * warmest / arrays.substance.mass) if arrays.modes.phases else 0.0,
        spheres=spheres,
        bins=bins_of(spheres),
        factor=np.sqrt(kT / mass),
        mass=mass,
        degrees=degrees,
        spread=spread,
        at=_first_gauges(parcel),
        layout=layout if arrays.modes.gravity and arrays.modes.rows else 0,
        cleared=Cleared(centre, np.array(places.reach, np.float64), float(sides[0])) if arrays.modes.drops else 0,
        velocity=np.zeros((n, 3)),
        key=np.zeros(3 * n + 1),
        rank=np.zeros(n, np.int64),
        state=np.zeros(1, np.uint64),
    )


def _spread(parcel: Any, sides: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the spacing of molecules, and the fastest speed of walls and of a fall over it: see `natural_time`."""
    spacing = float(cbrt(math.prod(sides.tolist()) / max(parcel.number, 1)))
    fastest = [math.sqrt(kT / float(parcel.mass.mean())) for kT in first_bath_kT(parcel.arrays().gas.walls)]
    return np.array([spacing, max([*fastest, math.sqrt(parcel.gravity * spacing)])])


def _first_gauges(parcel: Any) -> Any:
    """Return the data of the gas that the law of the piston needs at the start, without energy; 0 without ascent."""
    if not parcel.arrays().modes.ascends:
        return 0
    dimensions, open_height = 2.0 if parcel.planar else 3.0, parcel.ceiling - float(parcel.diameter.mean())
    freedom, density = parcel.degrees_of_freedom, parcel.open_density
    return Gauges(0.0, parcel.number, freedom, dimensions, 0.0, 0.0, density, open_height)

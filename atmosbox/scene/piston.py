"""A parcel under a piston: the size of its box, how fast its piston follows, and moist air in it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.engine import Piston, Scattered, Specular, Start
from atmosbox.scene.moisture import WARM, moist_air
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import DRY_AIR

if TYPE_CHECKING:
    from atmosbox.engine import FollowPressure, Liquid, Parcel
    from atmosbox.scene.engines import EngineChoice

FLATNESS = 0.4
"""Height of the box over its width: the box rises to be nearly as high as it is wide, and a slow piston makes less
noise."""
CLOSING = 20.0
"""Time in which the piston of a parcel that rises closes a gap in pressure [mean free times]."""


def size_of_parcel(
    scale: Scale, molecules: int, pressure: float, *, ideal: bool, flatness: float = FLATNESS
) -> tuple[float, NDArray[np.float64], float]:
    """Return density, sides within reach of the centres, and (Z - 1) / n, in diameters, at a pressure [Pa] and kT = 1.

    Points at 1000 hPa and 0 degC have Loschmidt's number, 2.65e25 in a cubic metre; spheres push each other apart:

    >>> from atmosbox.theory.constants import BOLTZMANN, DRY_AIR
    >>> scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * 273.15)
    >>> points, _, excess = size_of_parcel(scale, 1000, 1e5, ideal=True)
    >>> f"{points / scale.length**3:.3g}", excess
    ('2.65e+25', 0.0)
    >>> size_of_parcel(scale, 1000, 1e5, ideal=False)[0] < points
    True
    """
    wanted = pressure / scale.pressure
    density = wanted
    sides, excess = np.ones(3), 0.0
    for _ in range(60):
        side = (molecules / density / flatness) ** (1.0 / 3.0)
        sides = side * np.array([1.0, 1.0, flatness])
        excess = float(law.gas_pressure(density, 1.0, 1.0)) - density
        excess *= 0.0 if ideal else law.contact_share(sides, 1.0, molecules)
        before = density
        density *= wanted / (density + excess)
        if density == before:
            break
    return rounded(density), rounded(sides), rounded(excess / density**2)


def free_time_of(density: float, *, ideal: bool) -> float:
    """Return the mean free time at kT = 1 in a gas of a density [1/diameter^3]; longer if molecules have no volume."""
    time = float(law.mean_free_time(density, 1.0, 1.0, 1.0))
    return rounded(time * (float(law.contact_value(law.packing_fraction(density, 1.0))) if ideal else 1.0))


def parcel_facts(scale: Scale, sides: NDArray[np.float64]) -> dict[str, str]:
    """Return the lines of the model card about the box of a parcel and its molecules."""
    return {
        "box": " x ".join(f"{side * scale.length * 1e9:.1f}" for side in sides + 1.0) + " nm at the start, real size",
        "real molecules per simulated one": "1",
        "exaggeration": f"molecules {scale.length / DRY_AIR.diameter:.1f} times as wide as those of air",
    }


def moist_parcel(
    engine: EngineChoice, molecules: int, vapour: int, sides: NDArray[np.float64], *, driver: FollowPressure,
    liquid: Liquid, seed: int,
) -> Parcel:  # fmt: skip
    """Return moist air at kT = 1 under a piston, with its liquid; ``sides`` are those within reach of the centres."""
    return engine.begin(
        Start(molecules, (*WARM, Scattered())), length=tuple(sides + 1.0), walls=(Specular(),) * 5 + (Piston(),),
        seed=seed, driver=driver, liquid=liquid, **moist_air(molecules, vapour)._asdict(),
    )  # fmt: skip

"""A parcel of moist air under its piston, ready to start."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import FollowPressure, Mist
from atmosbox.scene.ascent.drawn_parcels import draw, drift, least_cloud, planned_cloud
from atmosbox.scene.ascent.way import RAIN, MoistAscent
from atmosbox.scene.engines import EngineChoice
from atmosbox.scene.instruments import Air, Environment, MoistLift, Water
from atmosbox.scene.knob import altitude, way
from atmosbox.scene.moisture import water
from atmosbox.scene.piston import CLOSING, moist_parcel, parcel_facts
from atmosbox.scene.setup import Setup
from atmosbox.scene.units import rounded

Array = NDArray[np.float64]
Profile = Callable[[float], float]


def rise(
    ascent: MoistAscent, engine: EngineChoice, *, height: Profile, around: Profile, frames: int, samples: int, seed: int
) -> Setup:
    """Return a parcel of moist air at the start of its ascent.

    Vapour in excess of saturation condenses in the first moments.
    """
    scale, n = ascent.scale, ascent.molecules
    _, sides, excess = ascent.box(ideal=engine.ideal)
    mean_free_time = ascent.mean_free_time(ideal=engine.ideal)
    duration = ascent.length * mean_free_time
    shares, outside = ascent.planned[0], np.array(ascent.route)
    times, pressures = list(shares * duration), list(rounded(outside / scale.pressure))
    driver = FollowPressure(times, pressures, mean_free_time=mean_free_time, relaxation=CLOSING, excess=excess)
    rain, area = RAIN / mean_free_time if ascent.rains else 0.0, ascent.area * float(sides[0] * sides[1])
    mist = Mist(water(scale), kT=1.0, nuclei=ascent.nuclei, rain=rain, keeps=ascent.keeps, area=area)
    parcel = moist_parcel(engine, n, ascent.vapour, sides, driver=driver, liquid=mist, seed=seed)
    lasted = duration * scale.time
    environment = Environment(
        height=lambda time: height(min(time / lasted, 1.0)),
        pressure=lambda time: math.exp(np.interp(time / lasted, shares, np.log(outside))),
        temperature=lambda time: around(min(time / lasted, 1.0)),
    )

    def curve(pressure: Array) -> Array:
        return ascent.path(pressure, np.arange(1, pressure.size + 1) / (frames * samples)).temperature

    def scatter(pressure: Array) -> Array:
        return np.asarray(draw(ascent, pressure, frames, samples, ideal=engine.ideal).warmth.std(axis=0))

    planned = planned_cloud(ascent, ideal=engine.ideal)
    known = planned.temperature * drift(planned)
    base, rainy = ascent.base, {}
    if ascent.rains:
        rainy["rain"] = f"compared with theory if the cloud holds {1000.0 * least_cloud(ascent):.1f} g/kg or more"
    climbs = bool(np.all(np.diff([height(float(share)) for share in np.linspace(0.0, 1.0, 101)]) > 0.0))
    instruments = Air(), Water(rains=ascent.rains), MoistLift(driver, environment, curve, scatter)
    return Setup(
        parcel, scale, duration, frames, instruments, samples=samples, ends=True,
        knobs=(altitude(parcel, driver, height) if climbs else way(parcel, driver),),
        facts={
            **parcel_facts(scale, sides),
            "water": f"{1000.0 * ascent.total_water:.1f} g/kg: {ascent.vapour} molecules",
            "lifting condensation level": f"{base / 100.0:.1f} hPa" if base > ascent.top_pressure else "not reached",
            "ascent" if climbs else "crossing": f"in {duration * scale.time * 1e9:.3g} ns",
            **rainy,
            "known errors": f"shift theory by {known.min():+.2g} to {known.max():+.2g} K from the adiabat",
        },
    )  # fmt: skip

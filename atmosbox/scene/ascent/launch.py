"""A parcel of moist air under its piston, ready to start."""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import FollowPressure, Mist
from atmosbox.scene.ascent.finite_size import drift, least_cloud
from atmosbox.scene.ascent.fluctuation import along_frames, temperature_covariance
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
    ascent: MoistAscent,
    engine: EngineChoice,
    *,
    height: Profile,
    around: Profile,
    frames: int,
    samples: int,
    seed: int,
) -> Setup:
    """Return a parcel of moist air at the start of its ascent.

    Vapour in excess of saturation condenses in the first moments.

    Parameters
    ----------
    ascent
        The ascent.
    engine
        The engine with its options.
    height, around
        Height of the parcel [m] and temperature of the environment [K], as functions of the share of the time, 0 to 1.
    frames, samples
        Number of frames of the whole ascent, and number of samples of the parcel in each frame.
    seed
        Seed of all random numbers.
    """
    scale, n = ascent.scale, ascent.molecules
    _, sides, excess = ascent.box(ideal=engine.ideal)
    mean_free_time = ascent.mean_free_time(ideal=engine.ideal)
    duration = ascent.length * mean_free_time
    shares, outside = np.linspace(0.0, 1.0, len(ascent.route)), np.array(ascent.route)
    driver = FollowPressure(
        list(shares * duration),
        list(rounded(outside / scale.pressure)),
        mean_free_time=mean_free_time,
        relaxation=CLOSING,
        excess=excess,
    )
    mist = Mist(
        water(scale),
        kT=1.0,
        nuclei=ascent.nuclei,
        rain=RAIN / mean_free_time if ascent.rains else 0.0,
        keeps=ascent.keeps,
        area=ascent.area * float(sides[0] * sides[1]),
    )
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
        cloud = along_frames(ascent, pressure, frames, samples, ideal=engine.ideal)
        return np.sqrt(np.diag(temperature_covariance(cloud, samples)))

    known = drift(ascent, ideal=engine.ideal)
    base = ascent.base
    return Setup(
        parcel,
        scale,
        duration,
        frames,
        (Air(), Water(rains=ascent.rains), MoistLift(driver, environment, curve, scatter)),
        samples=samples,
        facts={
            **parcel_facts(scale, sides),
            "water": f"{1000.0 * ascent.total_water:.1f} g/kg: {ascent.vapour} molecules",
            "lifting condensation level": f"{base / 100.0:.1f} hPa" if base > ascent.top_pressure else "not reached",
            "ascent": f"in {duration * scale.time * 1e9:.3g} ns",
            **(
                {"rain": f"compared with theory if the cloud holds {1000.0 * least_cloud(ascent):.1f} g/kg or more"}
                if ascent.rains
                else {}
            ),
            "known errors": f"theory is {known.warmer.min():+.2g} to {known.warmer.max():+.2g} K from the adiabat",
        },
        knobs=(altitude(parcel, driver, height) if _climbs(height) else way(parcel, driver),),
        ends=True,
    )


def _climbs(height: Profile) -> bool:
    """Return whether the height increases all the time."""
    return bool(np.all(np.diff([height(float(share)) for share in np.linspace(0.0, 1.0, 101)]) > 0.0))

"""Air that crosses mountains arrives warm and dry: the foehn.

A parcel crosses a mountain two kilometres high, a valley at one kilometre and a second mountain three kilometres high,
and sinks to the plain. On the way up its vapour condenses and releases heat; part of the water rains out. On the way
down the rest of the cloud evaporates. From there the parcel warms by ten degrees per kilometre, over more kilometres
than it had cooled at that rate. Without rain it would arrive as warm as it left.

Prescribed: the curve e_s(T), the path, and the law of the rain. What emerges is where clouds begin and end, how much
rain falls, and how warm the parcel arrives.

Modelled: molecules of air and water (hard spheres if there are up to 5,000; with more, chance decides which collide);
droplets too fine to draw, of one temperature, carried along by the air; rain, which falls out of the cloud with its
heat. Left out: ice, the curvature of droplets and what is dissolved in them; the wind, mixing with the environment,
heat from the ground and from the sun. Exaggerated: eight kilometres up and down within nanoseconds.
"""

import functools
import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.scene import EngineChoice, Headline, Line, Panel, SceneSettings, Series, Setup, setting
from atmosbox.scene.ascent.display import THEORY, atmosphere_panel, lifted_theory
from atmosbox.scene.ascent.drawn_parcels import comparable, draw
from atmosbox.scene.ascent.launch import rise
from atmosbox.scene.ascent.way import MoistAscent, refuse_supersaturation
from atmosbox.scene.engines import EXACT, suited_engine, used
from atmosbox.scene.panels import over_time

if TYPE_CHECKING:
    import xarray as xr

title = "What happens to moist air that crosses mountains?"
level = "first year"
minutes = 10
FRAMES = 96
SAMPLES = 8
BLOCK = 6


series = (Series("exact", "travel", (150, 300)), Series("dsmc", "travel", (150, 300, 600, 1200)))
"""Runs worth comparing: a fast journey ends too warm, and few molecules scatter."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(30_000, "1", "number of molecules in the parcel", low=200, high=1_000_000)
    temperature: float = setting(25.0, "degC", "temperature of parcel and air in the plain", low=-40.0, high=45.0)
    dewpoint: float = setting(17.0, "degC", "dewpoint of the parcel in the plain", low=-80.0, high=45.0)
    pressure: float = setting(1000.0, "hPa", "pressure in the plain", low=500.0, high=1100.0)
    first: float = setting(2.0, "km", "height of the first mountain", low=0.0, high=6.0)
    valley: float = setting(1.0, "km", "height of the valley between", low=0.0, high=6.0)
    second: float = setting(3.0, "km", "height of the second mountain", low=0.1, high=6.0)
    lapse_rate: float = setting(6.5, "K km-1", "lapse rate of the environment", low=-5.0, high=20.0)
    rain: bool = setting(True, "", "whether it rains")
    cloud_water: float = setting(1.0, "g kg-1", "liquid that the cloud holds before it rains", low=0.0, high=20.0)
    travel: float = setting(600.0, "1", "duration of the crossing, in mean free times at its start", low=20.0, high=1e6)
    area: float = setting(12.0, "1", "area of all droplets, divided by that of the floor", low=0.1, high=100.0)
    diameter: float = setting(1.3, "nm", "diameter of a molecule; that of air is 0.37 nm", low=0.1, high=1.6)

    def check(self) -> None:
        """Refuse a valley above its mountains, and a dewpoint above the temperature."""
        lower = min(self.first, self.second)
        if self.valley > lower:
            raise self.refusal("valley", f"is higher than the lower mountain, {lower:g} km", at_most=lower)
        refuse_supersaturation(self.dewpoint, self.temperature)


def _height(settings: Settings, share: float) -> float:
    """Return the height of the ground [m] at a share of the way: smooth slopes between the five places."""
    si = settings.si
    places = np.array([0.0, si.first, si.valley, si.second, 0.0])
    ends = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(places)))])
    ends /= ends[-1]
    k = min(int(np.searchsorted(ends, share, side="right")) - 1, 3)
    part = min((share - ends[k]) / max(ends[k + 1] - ends[k], 1e-12), 1.0)
    return float(places[k] + (places[k + 1] - places[k]) * 0.5 * (1.0 - math.cos(math.pi * part)))


@functools.lru_cache(maxsize=8)
def _ascent(settings: Settings) -> MoistAscent:
    """Return the journey according to theory."""
    heights = [_height(settings, share) for share in np.linspace(0.0, 1.0, 400)]
    return MoistAscent.over_ground(settings, settings.travel, heights)


usual_engine = suited_engine


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the moist parcel in the plain with its piston."""
    si = settings.si

    def around(share: float) -> float:
        return float(law.environment_temperature(_height(settings, share), si.temperature, si.lapse_rate))

    way, height = _ascent(settings), functools.partial(_height, settings)
    return rise(way, engine, height=height, around=around, frames=FRAMES, samples=SAMPLES, seed=settings.seed)


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the water along the way, and the temperature if nothing condensed."""
    return lifted_theory(dataset, _ascent(settings), FRAMES)


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the temperature with which the parcel arrives, and its rain."""
    ascent = _ascent(settings)
    pressure = dataset.parcel_pressure.values
    if len(pressure) < FRAMES:
        return ()
    path, late = ascent.planned[1], slice(-BLOCK, None)
    drawn = draw(ascent, dataset.environment_pressure.values, FRAMES, SAMPLES, ideal=used(dataset).ideal)
    arrival = float(path.temperature[-1])
    warmer = arrival * drawn.warmth[:, late].mean(axis=1)
    value = arrival + float((dataset.parcel_temperature - dataset.adiabat_temperature).values[late].mean())
    answer = arrival + float(warmer.mean()) if comparable(ascent) else None
    label, error = "temperature in the plain beyond", float(warmer.std())
    found = [Headline("arrival_temperature", value, error, answer, 0.0, THEORY, "K", "degC", label)]
    if "rain_mixing_ratio" in dataset:
        unit, lost = ascent.total_water / max(ascent.vapour, 1), drawn.rain[:, -1]
        value, error = float(dataset.rain_mixing_ratio[-1]), unit * max(float(lost.std()), 1.0)
        answer = float(path.rain[-1]) + unit * float(lost.mean()) if comparable(ascent) else None
        reason = "the liquid of so few molecules scatters, and what exceeds the limit rains out"
        found.append(
            Headline("rain", value, error, answer, 0.0, reason, "kg kg-1", "g kg-1", "rain per kilogram of dry air")
        )
    return tuple(found)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of the way, and of temperature and water along it."""
    time, rains, start = "elapsed_time", settings.rain, settings.temperature
    rain = Line(time, "rain_mixing_ratio", "rain"), Line(time, "rain_mixing_ratio_theory", "rain, theory", "theory")
    adiabat = Line(time, "adiabat_temperature", "theory", "theory")
    around = Line(time, "environment_temperature", "environment", "environment")
    warm = over_time(
        "It arrives warmer than it started" if rains else "It arrives as warm as it started",
        {"parcel_temperature": "parcel"}, "temperature", "degC", more=(adiabat, around),
        headline="arrival_temperature", start=start, guides=(("y", start, ""),),
        note="The ascents take nanoseconds in the box, and hours in the Alps.",
    )  # fmt: skip
    water = over_time(
        "Rain has taken part of its water" if rains else "Vapour and cloud",
        {"humidity_mixing_ratio": "vapour", "cloud_liquid_water_mixing_ratio": "cloud"}, "mixing ratio", "g kg-1",
        theory="vapour, theory", more=rain if rains else (), headline="rain" if rains else "",
    )  # fmt: skip
    picture = atmosphere_panel("Over two mountains", way="path of the parcel, from plain to plain")
    return replace(picture, start=(start, settings.pressure)), warm, water

"""A parcel of moist air rises past its cloud base.

Below its cloud base the parcel cools along the dry adiabat, by ten degrees per kilometre. Above the lifting
condensation level more molecules condense than evaporate, and each that condenses releases its binding energy: there
the parcel cools along the moist adiabat, at first half as fast.

Prescribed: the curve e_s(T), by the volatility of the liquid, its binding energy and two heat capacities; and the
pressure at each moment. What emerges is the cloud base, where the parcel becomes saturated as the receding piston cools
it, and both lapse rates.

Modelled: molecules of air and water that rotate (hard spheres if there are up to 5,000; with more, chance decides which
collide); droplets too fine to draw, of one temperature, carried along by the air; the latent heat, which follows from
the binding energy and the heat capacities; a hydrostatic environment of constant lapse rate. The ascent is reversible:
the droplets stay in the parcel. With rain=on the cloud keeps a gram per kilogram, and the rest falls out: this is
nearly pseudo-adiabatic. Left out: ice, the curvature of droplets and what is dissolved in them; gravity inside the
parcel; mixing with the environment. Exaggerated: some kilometres are climbed within nanoseconds, in a few hundred
collisions of each molecule; the molecules are larger than those of air; the droplets have far more area than so little
water could have. Only one molecule in fifty is water, and even below the cloud base RH / (1 - RH) molecules are
clustered on average.
"""

import functools
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.scene import EngineChoice, Headline, Panel, SceneSettings, Series, Setup, setting
from atmosbox.scene.ascent.display import lifted_headlines, lifted_panels, lifted_theory
from atmosbox.scene.ascent.launch import rise
from atmosbox.scene.ascent.way import MoistAscent, refuse_descent, refuse_supersaturation
from atmosbox.scene.engines import EXACT, suited_engine, used

if TYPE_CHECKING:
    import xarray as xr

title = "Where does a cloud begin?"
level = "second year"
minutes = 20
FRAMES = 60
SAMPLES = 10


series = (
    Series("exact", "ascent", (100, 400)),
    Series("exact", "molecules", (3000, 10_000), {"ascent": 400}),
    Series("dsmc", "ascent", (100, 200, 400, 1000, 3000)),
)
"""Runs worth comparing: a fast ascent deviates from its adiabat, and few molecules scatter."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(30_000, "1", "number of molecules in the parcel", low=200, high=1_000_000)
    temperature: float = setting(25.0, "degC", "temperature of parcel and air at the ground", low=-60.0, high=45.0)
    dewpoint: float = setting(17.0, "degC", "dewpoint of the parcel at the ground", low=-100.0, high=45.0)
    pressure: float = setting(1000.0, "hPa", "pressure at the ground", low=300.0, high=1100.0)
    top_pressure: float = setting(300.0, "hPa", "pressure at which the ascent ends", low=100.0, high=1000.0)
    lapse_rate: float = setting(6.5, "K km-1", "lapse rate of the environment", low=-5.0, high=20.0)
    rain: bool = setting(False, "", "whether it rains")
    cloud_water: float = setting(1.0, "g kg-1", "liquid that the cloud holds before it rains", low=0.0, high=20.0)
    ascent: float = setting(1000.0, "1", "duration of the ascent, in mean free times at its start", low=20.0, high=1e6)
    area: float = setting(12.0, "1", "area of all droplets, divided by that of the floor", low=0.1, high=100.0)
    diameter: float = setting(1.3, "nm", "diameter of a molecule; that of air is 0.37 nm", low=0.1, high=1.6)

    def check(self) -> None:
        """Refuse an ascent that does not go up, and a dewpoint above the temperature."""
        refuse_descent(self.top_pressure, self.pressure)
        refuse_supersaturation(self.dewpoint, self.temperature)


def _top(settings: Settings) -> float:
    """Return the height to which the parcel rises [m]."""
    si = settings.si
    return float(law.height_of_pressure(si.top_pressure, si.temperature, si.pressure, si.lapse_rate))


@functools.lru_cache(maxsize=8)
def _ascent(settings: Settings) -> MoistAscent:
    """Return the ascent according to theory."""
    return MoistAscent.over_ground(settings, settings.ascent, np.linspace(0.0, _top(settings), 400))


usual_engine = suited_engine


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the moist parcel at the ground with its piston."""
    si, top = settings.si, _top(settings)

    def height(share: float) -> float:
        return top * share

    def around(share: float) -> float:
        return float(law.environment_temperature(height(share), si.temperature, si.lapse_rate))

    way = _ascent(settings)
    return rise(way, engine, height=height, around=around, frames=FRAMES, samples=SAMPLES, seed=settings.seed)


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the adiabat without condensation, and the water along the moist adiabat."""
    return lifted_theory(dataset, _ascent(settings), FRAMES)


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the cloud base and the temperatures along the ascent."""
    return lifted_headlines(dataset, _ascent(settings), FRAMES, SAMPLES, ideal=used(dataset).ideal)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of the parcel on its ascent, and of temperature and water against pressure."""
    return lifted_panels(_ascent(settings), "adiabat with rain" if settings.rain else "moist adiabat")

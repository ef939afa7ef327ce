"""A parcel of air rises through a sounding, and may become buoyant.

Air from the ground is lifted through a sounding: measured by a balloon or, by default, analytic. As long as the parcel
is denser than the environment, it must be pushed. From the level of free convection up to the equilibrium level it is
lighter, and would rise by itself. The area between the curves of their density temperatures is the energy that
buoyancy can give a kilogram of air.

Modelled: molecules of air and water (hard spheres if there are up to 5,000; with more, chance decides which collide);
droplets too fine to draw, of one temperature, carried along by the air; the environment of the sounding, hydrostatic;
buoyancy from density temperatures. The ascent is reversible: the droplets stay in the parcel, and their weight counts;
with rain=on the cloud keeps a gram per kilogram. Left out: ice, the curvature of droplets; mixing with the environment,
which weakens every real cloud; the parcel's own motion: it is lifted at a steady rate, whatever its buoyancy.
Exaggerated: fourteen kilometres are climbed within nanoseconds.
"""

import functools
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.scene import EngineChoice, Headline, Line, Panel, SceneSettings, Series, Setup, setting
from atmosbox.scene import sounding as air
from atmosbox.scene.ascent.convection import convection_headlines
from atmosbox.scene.ascent.display import atmosphere_panel, lifted_headlines, lifted_theory
from atmosbox.scene.ascent.launch import rise
from atmosbox.scene.ascent.way import MoistAscent, refuse_descent
from atmosbox.scene.engines import EXACT, suited_engine, used
from atmosbox.scene.panels import over_height

if TYPE_CHECKING:
    import xarray as xr

title = "Will there be a thunderstorm?"
level = "second year"
minutes = 20
FRAMES = 80
SAMPLES = 8
BUILT_IN = "weisman-klemp"


series = (
    Series("exact", "ascent", (200, 400)),
    Series("exact", "molecules", (5000,), {"ascent": 400}),
    Series("dsmc", "ascent", (200, 400, 1400)),
)
"""Runs worth comparing: a fast ascent ends too warm, and few molecules scatter."""


class Settings(SceneSettings):
    """What a user may set."""

    sounding: str = setting(BUILT_IN, "", "file of a sounding, or weisman-klemp for the analytic one")
    molecules: int = setting(30_000, "1", "number of molecules in the parcel", low=200, high=1_000_000)
    top_pressure: float = setting(150.0, "hPa", "pressure at which the ascent ends", low=50.0, high=900.0)
    rain: bool = setting(False, "", "whether it rains")
    cloud_water: float = setting(1.0, "g kg-1", "liquid that the cloud holds before it rains", low=0.0, high=20.0)
    ascent: float = setting(1400.0, "1", "duration of the ascent, in mean free times at its start", low=20.0, high=1e6)
    area: float = setting(12.0, "1", "area of all droplets, divided by that of the floor", low=0.1, high=100.0)
    diameter: float = setting(1.3, "nm", "diameter of a molecule; that of air is 0.37 nm", low=0.1, high=1.6)

    def check(self) -> None:
        """Refuse a sounding that cannot be read, and an ascent that does not go up."""
        ground = float(_read(self.sounding).pressure[0])
        refuse_descent(self.top_pressure, ground / 100.0, "the lowest level of the sounding")


@functools.lru_cache(maxsize=8)
def _read(name: str) -> air.Sounding:
    """Return the sounding of this name, or from this file."""
    return air.weisman_klemp() if name == BUILT_IN else air.read(name)


@functools.lru_cache(maxsize=8)
def _height(name: str) -> np.ndarray:
    """Return the heights of the levels of a sounding above the lowest [m]."""
    return np.asarray(air.hydrostatic_height(_read(name)))


@functools.lru_cache(maxsize=8)
def _indices(name: str) -> air.Indices:
    """Return MetPy's levels and energies of a sounding."""
    return air.indices(_read(name))


def _between(settings: Settings, levels: np.ndarray, pressure: np.ndarray) -> np.ndarray:
    """Interpolate values at the sounding's levels linearly in the logarithm of the pressure."""
    found: np.ndarray = np.interp(-np.log(pressure), -np.log(_read(settings.sounding).pressure), levels)
    return found


def _around(settings: Settings, pressure: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return temperature, dewpoint and virtual temperature of the environment at pressures [Pa], in K."""
    found = _read(settings.sounding)
    temperature = _between(settings, found.temperature, pressure)
    dewpoint = _between(settings, found.dewpoint, pressure)
    ratio = law.mixing_ratio(law.saturation_vapor_pressure(dewpoint), pressure)
    return temperature, dewpoint, np.asarray(law.virtual_temperature(temperature, ratio))


@functools.lru_cache(maxsize=8)
def _ascent(settings: Settings) -> MoistAscent:
    """Return the ascent according to theory; it ends at the top of the sounding at the latest."""
    found = _read(settings.sounding)
    ground, warmth, dewpoint = (float(each[0]) for each in (found.pressure, found.temperature, found.dewpoint))
    route = np.geomspace(ground, max(settings.si.top_pressure, float(found.pressure[-1])), 400)
    return MoistAscent.of(settings, settings.ascent, route, warmth, ground, dewpoint)


usual_engine = suited_engine


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the parcel at the ground with its piston."""
    ascent = _ascent(settings)
    route = np.array(ascent.route)
    shares = np.linspace(0.0, 1.0, len(route))
    heights = _between(settings, _height(settings.sounding), route)
    temperatures = _around(settings, route)[0]

    def height(share: float) -> float:
        return float(np.interp(share, shares, heights))

    def around(share: float) -> float:
        return float(np.interp(share, shares, temperatures))

    setup = rise(ascent, engine, height=height, around=around, frames=FRAMES, samples=SAMPLES, seed=settings.seed)
    found = _read(settings.sounding)
    facts = {"sounding": f"{found.name}: {len(found)} levels"}
    facts |= {f"remark {number}": remark for number, remark in enumerate([*found.remarks, *found.doubts], 1)}
    return replace(setup, facts=facts | dict(setup.facts) | {"verdict": _verdict(settings)}, doubts=found.doubts)


def _convection(settings: Settings, *, weight: bool = True) -> law.Convection:
    """Return energies and levels of theory's parcel, with the weight of its droplets or without it."""
    ascent = _ascent(settings)
    path = ascent.planned[1]
    route = np.array(ascent.route)
    parcel = law.density_temperature(path.temperature, path.vapor, path.liquid if weight else 0.0)
    return law.cape_cin(route, _around(settings, route)[2], parcel, ascent.base)


def _verdict(settings: Settings) -> str:
    """Return whether this air is stable."""
    convection = _convection(settings)
    if convection.lfc is None:
        return "stable"
    return "conditionally unstable" if convection.cin < -1.0 else "unstable"


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the water of the adiabat, the environment, and the buoyancy."""
    pressure = dataset.parcel_pressure.values
    _, dewpoint, virtual = _around(settings, dataset.environment_pressure.values)
    at_parcel = _around(settings, pressure)[2]
    warmth, vapour = dataset.parcel_temperature.values, dataset.humidity_mixing_ratio.values
    parcel = law.density_temperature(warmth, vapour, dataset.cloud_liquid_water_mixing_ratio.values)
    return lifted_theory(dataset, _ascent(settings), FRAMES) | {
        "environment_dew_point_temperature": dewpoint,
        "environment_virtual_temperature": virtual,
        "parcel_virtual_temperature": np.asarray(law.virtual_temperature(warmth, vapour)),
        "parcel_density_temperature": np.asarray(parcel),
        "parcel_buoyancy": np.asarray(law.parcel_buoyancy(parcel, at_parcel)),
    }


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the levels and the energies of the simulated parcel, and MetPy's numbers of the sounding."""
    ascent, ideal = _ascent(settings), used(dataset).ideal
    found = lifted_headlines(dataset, ascent, FRAMES, SAMPLES, ideal=ideal)
    if dataset.sizes["elapsed_time"] < FRAMES:
        return found
    energies = convection_headlines(
        dataset, ascent, FRAMES, SAMPLES, lambda pressure: _around(settings, pressure)[2], ideal=ideal
    )
    return (*found, *energies, *_metpy(settings))


def _metpy(settings: Settings) -> tuple[Headline, ...]:
    """Return MetPy's numbers of the sounding, and those of the pseudo-adiabat with our constants."""
    ascent, metpy = _ascent(settings), _indices(settings.sounding)
    found = _read(settings.sounding)
    levels = np.unique(np.append(found.pressure, np.geomspace(found.pressure[0], found.pressure[-1], 400)))[::-1]
    water = float(law.mixing_ratio(ascent.vapour_pressure, ascent.pressure))
    path = law.parcel_path(levels, ascent.pressure, ascent.temperature, water, 0.0)
    base = float(law.lcl(ascent.pressure, ascent.temperature, found.dewpoint[0])[0])
    parcel = law.virtual_temperature(path.temperature, path.vapor)
    ours = law.cape_cin(levels, _around(settings, levels)[2], parcel, base)
    reason = "MetPy leaves out the heat capacity of the vapour, and uses no virtual temperature for its EL"
    rows = [
        ("metpy_lcl", metpy.lcl.pressure, base, "Pa", "hPa", "condensation level"),
        ("metpy_cape", metpy.cape, ours.cape, "J kg-1", "J kg-1", "CAPE of the pseudo-adiabat"),
    ]
    if metpy.el is not None and ours.el is not None:
        rows.append(("metpy_el", metpy.el.pressure, ours.el, "Pa", "hPa", "equilibrium level"))
    return tuple(Headline(n, v, 0.0, t, 0.0, reason, u, s, label, program="MetPy") for n, v, t, u, s, label in rows)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of the skew-T, of the buoyancy, and of the parcel on its ascent."""
    convection, ascent = _convection(settings), _ascent(settings)
    ground, rises = ascent.pressure / 100.0, convection.lfc is not None
    reached = max(ascent.top_pressure, 0.92 * (convection.el or 0.0)) / 100.0
    around = "environment_pressure"
    curves = (
        Line("parcel_temperature", "parcel_pressure", "parcel", error="parcel_temperature_se"),
        Line("adiabat_temperature", "parcel_pressure", "adiabat", "theory"),
        Line("environment_temperature", around, "environment", "environment"),
        Line("environment_dew_point_temperature", around, "dewpoint", "environment"),
    )
    numbers, marks = ("cape", "cin") if rises else (), ("cloud_base", "lfc", "el")
    skewt = Panel(
        "skewt", f"This air is {_verdict(settings)}", curves, "temperature", "pressure", headlines=numbers, marks=marks
    )
    title = "Higher up it would rise by itself" if rises else "It would never rise by itself"
    lines, axis = (Line("parcel_buoyancy", "parcel_pressure", "parcel"),), {"guides": (("x", 0.0, ""),), "areas": True}
    energy = over_height(title, lines, "buoyancy", "", pressure=True, y_limits=(ground, reached), **axis)
    picture = atmosphere_panel("The parcel and its cloud" if convection.el else "The parcel on its way")
    return skewt, energy, replace(picture, start=(ascent.temperature - 273.15, ground))

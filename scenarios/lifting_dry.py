"""A parcel of dry air rises and cools.

Thousands of molecules fly in a box whose ceiling is a piston. The piston recedes so that the pressure in the box
follows that of the environment of a rising parcel. Only one thing cools the air: molecules that hit the receding
ceiling come back more slowly. Prescribed are the pressure at each moment and the two rotational degrees of freedom of a
molecule; the dry adiabat, T ~ p^(2/7), emerges.

Modelled: hard spheres with two rotational degrees of freedom, which exchange energy at every contact; smooth walls; a
hydrostatic environment of constant lapse rate. Left out: gravity inside the parcel (it would change its temperature by
less than a billionth), water, mixing and exchange of heat with the environment. Exaggerated: the molecules are larger
than those of air, so that they meet often, and the parcel rises nine kilometres within nanoseconds. Because the ascent
is not infinitely slow, the parcel is too warm at 300 hPa (the finite-rate error): by about 155 K divided by the
duration of the ascent in mean free times, which is 0.1 K in the default run.
"""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import FollowPressure, Maxwell, Piston, Rotating, Scattered, Specular, Start
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.ascent.display import atmosphere_panel
from atmosbox.scene.ascent.way import refuse_descent
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.instruments import Air, Environment, Lift
from atmosbox.scene.knob import altitude
from atmosbox.scene.panels import Line, Panel, over_height
from atmosbox.scene.piston import CLOSING, free_time_of, parcel_facts, size_of_parcel
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

title = "How cold does rising air become?"
level = "first year"
minutes = 15
FRAMES = 40
_THEORY = "theory is the adiabat, plus the warming by the finite speed, minus the cooling by the volume of the spheres"
# their errors go as the power -1 of the duration of the ascent
_SLOW = dict.fromkeys(("temperature_at_700_hpa", "temperature_at_300_hpa", "parcel_temperature"), -1.0)
series = (
    Series("exact", "ascent", (50, 100, 200, 400, 800, 1600), order=_SLOW),
    Series("exact", "molecules", (250, 1000, 4000), {"ascent": 400}),
    Series("stepped", "delta", (1.6, 0.8, 0.4, 0.2, 0.1), {"ascent": 400}, {"temperature_at_700_hpa": 1.0}),
    Series("dsmc", "ascent", (100, 200, 400, 800, 1600), order=_SLOW),
    Series("dsmc", "molecules", (4000, 16000, 64000), {"ascent": 400}),
    Series("dsmc", "dt", (2, 1, 0.5), {"ascent": 400}),
)
"""Runs worth comparing: the finite-rate error decreases as one over the length of the ascent."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(4000, "1", "number of molecules in the parcel", low=50, high=1_000_000)
    temperature: float = setting(
        15.0, "degC", "temperature of the parcel and of the air at the ground", low=-80.0, high=60.0
    )
    pressure: float = setting(1000.0, "hPa", "pressure at the ground", low=200.0, high=1100.0)
    top_pressure: float = setting(300.0, "hPa", "pressure at which the ascent ends", low=50.0, high=1000.0)
    lapse_rate: float = setting(6.5, "K km-1", "lapse rate of the environment", low=-5.0, high=20.0)
    rotation: bool = setting(True, "", "whether molecules rotate; without it gamma is 5/3")
    ascent: float = setting(1600.0, "1", "duration of the ascent, in mean free times at its start", low=5.0, high=1e6)
    diameter: float = setting(1.0, "nm", "diameter of a molecule; that of air is 0.37 nm", low=0.1, high=1.6)

    def check(self) -> None:
        """Refuse an ascent that does not go up."""
        refuse_descent(self.top_pressure, self.pressure)


def _start(settings: Settings, *, ideal: bool = False) -> tuple[Scale, float, np.ndarray, float]:
    """Return the scale; at the start, in diameters, the density n, the sides that centres can reach, and (Z - 1) / n.

    Z is the pressure over n k T.
    """
    si = settings.si
    scale = Scale(si.diameter, DRY_AIR.molecule_mass, BOLTZMANN * si.temperature)
    return scale, *size_of_parcel(scale, settings.molecules, si.pressure, ideal=ideal)


def _ascent(settings: Settings) -> law.Ascent:
    """Return the ascent, with its finite-rate error."""
    freedom = 5 if settings.rotation else 3
    _, density, sides, _ = _start(settings)
    # the time in which a molecule at the thermal speed, which is 1, flies that far, in mean free times
    height = float(sides[2]) / float(law.mean_free_time(density, 1.0, 1.0, 1.0))
    return law.Ascent(tuple(_route(settings).tolist()), settings.ascent, height, freedom)


def _top(settings: Settings) -> float:
    """Return the height to which the parcel rises [m]."""
    si = settings.si
    return float(law.height_of_pressure(si.top_pressure, si.temperature, si.pressure, si.lapse_rate))


def _route(settings: Settings) -> np.ndarray:
    """Return the pressure of the environment at equal intervals of time, from the ground to the top [Pa]."""
    si = settings.si
    height = _top(settings) * np.linspace(0.0, 1.0, 400)
    return law.environment_pressure(height, si.temperature, si.pressure, si.lapse_rate)


def _environment(settings: Settings, duration: float) -> Environment:
    """Return the environment of a parcel that climbs at constant speed for ``duration`` [s]."""
    si, top = settings.si, _top(settings)
    freedom = 5 if settings.rotation else 3

    def height(time: float) -> float:
        return top * min(time / duration, 1.0)

    return Environment(
        height=height,
        pressure=lambda time: float(law.environment_pressure(height(time), si.temperature, si.pressure, si.lapse_rate)),
        temperature=lambda time: float(law.environment_temperature(height(time), si.temperature, si.lapse_rate)),
        adiabat=lambda pressure: float(law.dry_adiabat_temperature(pressure, si.temperature, si.pressure, freedom)),
    )


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the parcel at the ground with its piston."""
    n = settings.molecules
    scale, density, sides, excess = _start(settings, ideal=engine.ideal)
    mean_free_time = free_time_of(density, ideal=engine.ideal)
    length = tuple(sides + 1.0)  # in diameters: no centre comes nearer to a wall than a radius
    duration = settings.ascent * mean_free_time
    environment = _environment(settings, duration * scale.time)
    # the driver moves the piston so that the pressure in the box follows these pressures
    pressures = rounded(_route(settings) / scale.pressure)
    times = np.linspace(0.0, duration, len(pressures))
    driver = FollowPressure(
        list(times), list(pressures), mean_free_time=mean_free_time, relaxation=CLOSING, excess=excess
    )
    parcel = engine.begin(
        Start(n, (Rotating(1.0, exact=True), Scattered(), Maxwell(1.0, exact=True))),
        length=length,
        walls=(Specular(),) * 5 + (Piston(),),
        rotation=2.0 if settings.rotation else 0.0,
        seed=settings.seed,
        driver=driver,
    )
    ascent, crowding = _ascent(settings), excess * density

    def scatter(outside: np.ndarray) -> np.ndarray:
        """Return the standard error at each frame, as a share of the temperature, from the pressures so far [Pa]."""
        way = replace(ascent, route=(settings.si.pressure, *outside), length=settings.ascent * len(outside) / FRAMES)
        return way.scatter(n, crowding)[1:]

    top = settings.si.top_pressure
    warmth = environment.adiabat(top) * ascent.finite_speed(top)
    measured = Air(), Lift(driver, environment, scatter)
    facts = {
        **parcel_facts(scale, sides),
        "gamma": "7/5" if settings.rotation else "5/3",
        "ascent": f"{environment.height(math.inf) / 1000.0:.1f} km in {duration * scale.time * 1e9:.3g} ns",
        "finite speed": f"warms the parcel by {warmth:.2g} K at the top",
    }
    knobs = (altitude(parcel, driver, lambda share: environment.height(share * duration * scale.time)),)
    return Setup(parcel, scale, duration, FRAMES, measured, facts=facts, knobs=knobs, ends=True)


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the adiabat of dry air, which is also that of the parcel if its molecules rotate."""
    si = settings.si
    air = law.dry_adiabat_temperature(dataset.parcel_pressure.values, si.temperature, si.pressure, 5)
    return {"dry_air_adiabat_temperature": np.asarray(air)}


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the temperatures along the ascent and the lapse rate; theory is the adiabat with its finite-rate error."""
    si = settings.si
    pressure = dataset.parcel_pressure.values
    order = np.argsort(pressure)
    # the difference from the adiabat changes little with pressure, so it can be interpolated
    warmer = (dataset.parcel_temperature.values - dataset.adiabat_temperature.values)[order]
    error = dataset.parcel_temperature_se.values[order]
    freedom, density = 5 if settings.rotation else 3, _start(settings)[1]
    ascent, spheres = _ascent(settings), 0.0 if used(dataset).ideal else 1.0

    def at(level: float) -> tuple[float, float, float]:
        """Return the temperature measured at a pressure of the parcel [Pa], its error, and that of theory [K]."""
        adiabat = float(law.dry_adiabat_temperature(level, si.temperature, si.pressure, freedom))
        known = adiabat * (ascent.finite_speed(level) - spheres * ascent.room(level, density))
        found, chance = (float(np.interp(level, pressure[order], each)) for each in (warmer, error))
        return adiabat + found, chance, adiabat + known

    # levels [hPa] that the pressure [Pa] has reached, to within a percent
    reached = [level for level in _levels(settings) if pressure.min() <= 101.0 * level]
    found = [
        Headline(
            f"temperature_at_{p:.0f}_hpa", *at(100.0 * p), 0.0, _THEORY, "K", "degC", f"temperature at {p:.0f} hPa"
        )
        for p in reached
    ]
    if dataset.parcel_height.values[-1] >= 1000.0:
        first = float(law.environment_pressure(1000.0, si.temperature, si.pressure, si.lapse_rate))
        measured, chance, expected = at(first)
        lapse, answer = (si.temperature - measured) / 1000.0, (si.temperature - expected) / 1000.0
        label, sizes = "lapse rate of the first kilometre", (lapse, chance / 1000.0, answer, 0.0)
        found.append(Headline("lapse_rate_of_the_first_kilometre", *sizes, _THEORY, "K m-1", "K km-1", label))
    return tuple(found)


def _levels(settings: Settings) -> list[float]:
    """Return the levels that are reported [hPa]: 700 hPa during the ascent, and the top."""
    return [p for p in dict.fromkeys((700.0, settings.top_pressure)) if settings.top_pressure <= p < settings.pressure]


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of the parcel on its ascent, and of its temperature against height."""
    adiabat = "dry adiabat" if settings.rotation else "adiabat, γ = 5/3"
    height = "parcel_height"
    lines = (
        Line("parcel_temperature", height, "parcel", error="parcel_temperature_se"),
        Line("adiabat_temperature", height, adiabat, "theory"),
        Line("environment_temperature", height, "environment", "environment"),
        Line("dry_air_adiabat_temperature", height, "dry air, γ = 7/5", "reference"),
    )
    picture = atmosphere_panel("The parcel expands", tuple(f"temperature_at_{p:.0f}_hpa" for p in _levels(settings)))
    title = "It cools along the dry adiabat" if settings.rotation else "It cools"
    shown, start = lines[:3] if settings.rotation else lines, (settings.temperature, 0.0)
    return (
        replace(picture, start=(settings.temperature, settings.pressure)),
        over_height(title, shown, "temperature", "degC", "lapse_rate_of_the_first_kilometre", start=start),
    )

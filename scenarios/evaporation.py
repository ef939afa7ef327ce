"""Evaporation cools the water that remains.

Dry air lies over a pool of water, at constant pressure and without heat from outside. Only molecules that happen to
have far more energy than the mean leave the pool, and the rest becomes colder: first the pool, then the air above it.
The more vapour there is, the more of it returns to the pool; when as many molecules come back as leave, the air is
saturated.

Prescribed: the curve e_s(T), by the volatility of the liquid, its binding energy and two heat capacities. The air has
no influence on it. In the end as many molecules come back as leave, because no molecule is lost. The run tests the
vapour pressure and the temperature at which this happens, and the energy of the molecules that leave. It also shows
that the pool cools first and the air follows, and how much the numbers of so few molecules fluctuate.

Modelled: molecules of air and water, with the diameter and density of air, under a piston that keeps the pressure; a
pool on the floor. With up to 5,000 molecules these are hard spheres; with more, chance decides which of them collide.
Every molecule of vapour that hits the pool sticks; molecules of air exchange heat with it; molecules of water leave it
at a rate that depends on its energy. Left out: ice, gravity, currents within the pool, which has one temperature and no
volume; forces between molecules of vapour. At this size no layer of moist air builds up over the pool, and no wind is
needed to remove it.
"""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import FollowPressure, Pool
from atmosbox.errors import Setting
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT, suited_engine, used
from atmosbox.scene.exchange.pool import AirOverPool, energy_of_those_that_leave, temperature_of_those_that_left
from atmosbox.scene.headline import CHANCE_ALONE
from atmosbox.scene.instruments import Air, Leaving, Water
from atmosbox.scene.knob import open_pool, warmed_walls
from atmosbox.scene.moisture import water
from atmosbox.scene.panels import Line, Panel, over_time
from atmosbox.scene.piston import moist_parcel, parcel_facts
from atmosbox.scene.statistics import block_average
from atmosbox.scene.units import rounded
from atmosbox.theory.constants import BOLTZMANN

if TYPE_CHECKING:
    import xarray as xr

title = "Why does evaporation cool?"
level = "school"
minutes = 10
FRAMES = 400
BLOCKS = 20
PARTS = 36
"""Number of equal parts of the logarithmic axis of time in which curves are averaged."""
HOTTEST = 647.0
"""Temperature above which there is no saturation; a pool of one molecule may have it for a moment [K]."""
FEW = 100
"""Number of molecules that come or go below which the errors are those of random events, and not from blocks."""


series = (Series("exact", "duration", (10, 20)), Series("dsmc", "duration", (10, 20, 40)))
"""Runs worth comparing: the longer the pool is watched in equilibrium, the less its means scatter."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(15_000, "1", "number of molecules of air and vapour at the start", low=200, high=1_000_000)
    pool: int = setting(3000, "1", "number of molecules in the pool at the start", low=1, high=1_000_000)
    temperature: float = setting(
        30.0, "degC", "temperature of the air and of the pool at the start", low=-60.0, high=95.0
    )
    humidity: float = setting(20.0, "percent", "relative humidity at the start", low=0.0, high=1000.0)
    pressure: float = setting(1000.0, "hPa", "pressure of the air, kept constant", low=1.0, high=20_000.0)
    duration: float = setting(20.0, "ns", "how long to watch", low=0.01, high=1e4)
    diameter: float = setting(0.37, "nm", "diameter of a molecule; that of air is 0.37 nm", low=0.1, high=1.0)

    def check(self) -> None:
        """Refuse water that boils, so much vapour that no air is left, and molecules too wide for a gas."""
        saturated = float(law.saturation_vapor_pressure(self.si.temperature))
        if saturated >= self.si.pressure:
            coldest = float(law.dewpoint(self.si.pressure)) - 273.15
            problem = f"makes water boil at {self.pressure:g} hPa, which drives the piston out without end"
            if coldest < -60.0:
                least = Setting("pressure", f"{math.ceil(saturated / 100.0)}hPa")
                raise self.refusal("temperature", problem, least, " or more")
            raise self.refusal("temperature", problem, at_most=math.floor(coldest))
        most = self.si.pressure / saturated
        if self.si.humidity > 0.95 * most:
            place = f"{self.pressure:g} hPa and {self.temperature:g} degC"
            problem = f"is so much vapour that hardly any air is left at {place}"
            raise self.refusal("humidity", problem, at_most=math.floor(95.0 * most))
        filled = math.pi / 6.0 * self.si.diameter**3 * self.si.pressure / (BOLTZMANN * self.si.temperature)
        if filled > 0.1:
            widest = self.diameter * (0.1 / filled) ** (1.0 / 3.0)
            problem = f"makes the gas at {self.pressure:g} hPa too dense for vapour to saturate at e_s"
            raise self.refusal("diameter", problem, at_most=math.floor(100.0 * widest) / 100.0)


def _start(settings: Settings, *, ideal: bool) -> AirOverPool:
    """Return the air over the pool at the start, according to theory."""
    si = settings.si
    vapour_pressure = si.humidity * float(law.saturation_vapor_pressure(si.temperature))
    start = si.temperature, si.pressure, vapour_pressure
    return AirOverPool(settings.molecules, settings.pool, si.diameter, *start, ideal)


usual_engine = suited_engine


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the air over its pool."""
    si = settings.si
    start = _start(settings, ideal=engine.ideal)
    scale, n = start.scale, settings.molecules
    substance = water(scale)
    outside, closing = rounded(si.pressure / scale.pressure), start.closing / start.free_time
    driver = FollowPressure([0.0], [outside], mean_free_time=start.free_time, relaxation=closing, excess=start.excess)
    pool = Pool(substance, number=settings.pool, kT=1.0)
    parcel = moist_parcel(engine, n, start.vapour, start.sides, driver=driver, liquid=pool, seed=settings.seed)
    boils = float(law.dewpoint(si.pressure)) - 273.15
    help, high = "temperature of the side walls, insulated at first", min(60.0, boils - 5.0)
    kT = scale.reduced_temperature
    walls = warmed_walls(parcel, settings, "temperature", help, range(4), kT, low=-20.0, high=high)
    duration = si.duration / scale.time
    end, rest = start.end, start.rest
    left = float(end.liquid)
    humidity = 100.0 * float(end.vapor_pressure / law.saturation_vapor_pressure(end.temperature))
    facts = {
        **parcel_facts(scale, start.sides),
        **({"exaggeration": "none"} if settings.diameter == 0.37 else {}),
        "vapour at the start": f"{start.vapour} molecules",
        "at the end, by the balance of enthalpy": f"{float(end.temperature) - 273.15:.2f} degC, "
        + (f"{float(end.vapor):.0f} molecules of vapour, " if left > 0.0 else "")
        + (f"{left:.0f} in the pool" if left > 0.0 else f"the pool dry and {humidity:.0f} % of humidity"),
        "the same, with the fluctuations of so few molecules": f"{rest.temperature - 273.15:.2f} degC",
        "wet-bulb temperature": _wet_bulb(settings),
        "time until vapour hits the pool": f"{start.exchange * scale.time * 1e9:.2g} ns",
        "cooling because the piston lags": f"up to {start.loss(duration):.1g} K",
    }
    knobs = (walls, open_pool(parcel))
    settle, measured = min(_settled(start, settings), FRAMES - 1), (Air(), Water(), Leaving(substance.binding_energy))
    return Setup(parcel, scale, duration, FRAMES, measured, samples=3, settle=settle, facts=facts, knobs=knobs)


def _wet_bulb(settings: Settings) -> str:
    """Return the wet-bulb temperature of the air at the start, or why there is none."""
    if settings.humidity > 100.0:
        return "none: the air is supersaturated"
    si = settings.si
    dewpoint = float(law.dewpoint(si.humidity * law.saturation_vapor_pressure(si.temperature)))
    bulb = float(law.wet_bulb_temperature(si.pressure, si.temperature, min(dewpoint, si.temperature)))
    return f"{bulb - 273.15:.2f} degC"


def _settled(start: AirOverPool, settings: Settings) -> int:
    """Return the number of frames until equilibrium."""
    frame: float = settings.si.duration / start.scale.time / FRAMES
    return math.ceil(min(start.settling / frame, float(FRAMES)))


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the final state, saturation over the pool at present, and the energies of molecules that leave and stay.

    The final state is that between walls that let no heat pass, or, once the walls have a temperature, that between
    walls of this temperature.
    """
    start = _start(settings, ideal=used(dataset).ideal)
    rest = start.rest
    walls = dataset.wall_temperature.values[:, 0]
    kelvin = np.where(np.isfinite(walls), walls, rest.temperature)
    vapour = np.array([rest.vapor_pressure if math.isnan(wall) else start.vapour_pressure_at(wall) for wall in walls])
    share = dataset.pool_open_share.values if "pool_open_share" in dataset else 1.0
    bounds = dataset.energy_bnds.values
    edges = np.append(bounds[:, 0], bounds[-1, 1])
    warm = temperature_of_those_that_left(dataset)
    known = math.isfinite(warm) and warm > 0.0
    nothing = np.full(len(bounds), math.nan)
    liquid = dataset.liquid_temperature.values
    saturation = law.saturation_vapor_pressure(np.clip(np.nan_to_num(liquid), 0.0, HOTTEST))
    return {
        "gas_temperature_theory": kelvin,
        "liquid_saturation_vapor_pressure": np.where(np.isfinite(liquid), saturation, math.nan),
        "water_vapor_partial_pressure_theory": vapour,
        "condensation_rate_theory": share * start.rate(vapour, kelvin),
        "leaving_energy_probability_density_theory": law.leaving_energy_density(edges, warm) if known else nothing,
        "staying_energy_probability_density": law.staying_energy_density(edges, warm) if known else nothing,
    }


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return temperatures, vapour pressure and both rates in equilibrium, and the energy of molecules that leave."""
    start = _start(settings, ideal=used(dataset).ideal)
    late = dataset.isel(elapsed_time=slice(_settled(start, settings), None))
    if late.sizes["elapsed_time"] < 2 * BLOCKS:
        return ()
    rest, until = start.rest, settings.si.duration / start.scale.time
    walk = start.walk(until)
    steep = start.latent / rest.temperature
    lasted = settings.si.duration * late.sizes["elapsed_time"] / FRAMES
    memory = start.memory / settings.si.duration * FRAMES
    rate = start.rate(rest.vapor_pressure, rest.temperature)
    met = rate * lasted

    def headline(
        name: str, expected: float, heated: float, chance: float, unit: str, shown: str, label: str
    ) -> Headline:
        # heated: its change per kelvin; chance: its error if only few molecules came and went
        found = block_average(late[name].values, BLOCKS, memory)
        error = max(float(found.standard_error), chance if met < FEW else 0.0)
        value, error = float(found.mean), math.hypot(error, walk * heated)
        return Headline(f"mean_{name}", value, error, expected, 0.0, CHANCE_ALONE, unit, shown, label)

    scatter = math.sqrt(2.0 * rest.variance * start.exchange * start.scale.time / lasted)
    scatter *= settings.si.pressure / (start.air + rest.vapor)
    wet = bool(np.isfinite(late.liquid_temperature.values).all())
    found = [headline("gas_temperature", rest.temperature, 1.0, 0.0, "K", "degC", "temperature of the air")]
    if wet:
        found += [headline("liquid_temperature", rest.temperature, 1.0, 0.0, "K", "degC", "temperature of the pool")]
    e, heated = rest.vapor_pressure, steep * rest.vapor_pressure
    found += [headline("water_vapor_partial_pressure", e, heated, scatter, "Pa", "hPa", "vapour pressure")]
    if found[-1].value > 0.0:
        found.append(_saturation(late, found[-1], start, scatter if met < FEW else 0.0, memory))
    for name in ("condensation", "evaporation"):
        alone = math.sqrt(met) / lasted
        found.append(headline(f"{name}_rate", rate, steep * rate, alone, "s-1", "ns-1", name))
    return (*found, *energy_of_those_that_leave(dataset, start, FEW))


def _saturation(late: "xr.Dataset", vapour: Headline, start: AirOverPool, chance: float, memory: float) -> Headline:
    """Return vapour pressure over saturation at the temperature of the pool, or of the air if the pool is dry.

    Both are averaged first: the mean of their quotient would be another number, because their fluctuations are
    correlated.
    """
    rest = start.rest
    steep = start.latent / rest.temperature
    wet = bool(np.isfinite(late.liquid_temperature.values).all())
    warm = (late.liquid_temperature if wet else late.gas_temperature).values
    share = vapour.value / float(law.saturation_vapor_pressure(warm.mean()))
    expected = rest.vapor_pressure / float(law.saturation_vapor_pressure(rest.temperature))
    together = late.water_vapor_partial_pressure.values / vapour.value - steep * warm
    error = share * max(float(block_average(together, BLOCKS, memory).standard_error), chance / vapour.value)
    label = "vapour pressure / saturation"
    return Headline("final_humidity", share, error, expected, 0.0, CHANCE_ALONE, "1", "percent", label)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of temperatures and vapour pressure against time, and of the energies."""
    leave = "leaving_energy_probability_density"
    log: dict[str, Any] = {"log": True, "parts": PARTS, "theory": "theory"}
    cools = over_time(
        "The pool cools, and then the air",
        {"gas_temperature": "air", "liquid_temperature": "pool"}, "temperature", "degC",
        headline="mean_liquid_temperature", start=settings.temperature, **log,
    )  # fmt: skip
    wet = over_time(
        "The air becomes saturated",
        {"water_vapor_partial_pressure": "vapour", "liquid_saturation_vapor_pressure": "saturation at the pool"},
        "vapour pressure", "hPa", headline="final_humidity", **log,
    )  # fmt: skip
    energies = (
        Line("energy", leave, "leave", error=f"{leave}_se"),
        Line("energy", f"{leave}_theory", "theory", "theory"),
        Line("energy", "staying_energy_probability_density", "stay", "environment"),
    )
    axes = "energy of a molecule", "probability density", "zJ", "zJ-1"
    title, numbers = "Only molecules of high energy leave", ("energy_of_those_that_leave",)
    return cools, wet, Panel("histogram", title, energies, *axes, headlines=numbers)

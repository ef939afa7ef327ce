"""Clouds form where more molecules of water condense than evaporate.

Moist air of real density is between walls of one temperature, with more vapour than saturated air has. Two things are
counted: the molecules of vapour that meet liquid and stay, and those that leave it. The first rate falls while vapour
is used up, the second depends on the liquid alone; when the two are equal, the air is saturated, and the relative
humidity is 100 %.

Prescribed: the curve e_s(T), by the volatility of the liquid, its binding energy and two heat capacities. The air has
no influence on it. In a closed box the two rates become equal because no molecule is lost. The run tests the vapour
pressure at which this happens: it must be e_s(T). It also shows how long this takes, and how much the numbers of so few
molecules fluctuate.

Modelled: hard molecules of air and water at real density; droplets too fine to draw, of one temperature and a
given area; every molecule of vapour that meets a droplet sticks to it. Left out: ice, the curvature of droplets and
what is dissolved in them, so that no supersaturation is needed to start; forces between molecules of vapour;
gravity.
"""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import Drops, HeatBath, Liquid, Mist, RandomNumbers, Scattered, Start
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.exchange.moist_box import MoistBox, refuse_vapour_alone
from atmosbox.scene.instruments import Air, DropSizes, Water
from atmosbox.scene.knob import wall_temperature
from atmosbox.scene.moisture import WARM, moist_air, nuclei_heat_capacity, water
from atmosbox.scene.panels import Panel, over_time
from atmosbox.scene.statistics import BlockAverage, block_average

if TYPE_CHECKING:
    import xarray as xr

title = "When is air saturated?"
level = "first year"
minutes = 15
FRAMES = 240
SETTLE = 40
PARTS = 12
"""Number of equal parts of the logarithmic axis of time in which its curves are averaged."""
BLOCKS = 20
MEMORIES = 4.0
"""Number of correlation times after which the start no longer matters."""
FEW = 400
"""Number of condensed molecules below which blocks alone do not give the error."""
MOLECULE = 0.52
"""Radius of the sphere that a molecule fills in liquid water, over the diameter of one of air: 0.193 nm to 0.37 nm."""
CORE = 20.0
"""Mass of the nucleus of a drop, in molecules of air."""


series = (
    Series("exact", "molecules", (1000, 3000, 10_000)),
    Series("exact", "duration", (20, 40), {"molecules": 3000}),
    Series("dsmc", "molecules", (10_000, 30_000)),
)
"""Runs worth comparing: the result is the same with any way of hitting the droplets; scatter and cost differ."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(10_000, "1", "number of molecules of air and vapour", low=50, high=1_000_000)
    temperature: float = setting(20.0, "degC", "temperature of the walls", low=-60.0, high=95.0)
    pressure: float = setting(1000.0, "hPa", "pressure of air and vapour at the start", low=1.0, high=50_000.0)
    humidity: float = setting(150.0, "percent", "relative humidity at the start", low=0.0, high=1000.0)
    area: float = setting(2.0, "1", "area of the mist, divided by that of a face of the box", low=0.01, high=100.0)
    drops: int = setting(0, "1", "number of nuclei of drops that can be seen; 0 for a mist", low=0, high=50)
    drop_size: float = setting(6.0, "1", "width of the drops, divided by that of real ones", low=1.0, high=20.0)
    duration: float = setting(40.0, "ns", "how long to watch", low=0.01, high=1e5)

    def check(self) -> None:
        """Refuse so much vapour that no air is left."""
        refuse_vapour_alone(self)


def _liquid(settings: Settings, start: MoistBox, place: np.ndarray | tuple[()] = ()) -> Liquid:
    """Return a mist, or drops around nuclei at these places."""
    heat = nuclei_heat_capacity(settings.molecules)
    if not settings.drops:
        return Mist(water(start.scale), kT=1.0, nuclei=heat, area=settings.area * start.side * start.side)
    ball = settings.drop_size * MOLECULE
    position = tuple((float(x), float(y), float(z)) for x, y, z in place)
    kind: dict[str, Any] = {"nucleus": ball, "nucleus_mass": CORE, "molecule_radius": ball}
    return Drops(water(start.scale), kT=1.0, nuclei=heat, position=position, **kind)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the moist air between its walls."""
    n, drops = settings.molecules, settings.drops
    start = MoistBox.of(settings, ideal=engine.ideal)
    scale, length = start.scale, (start.side + 1.0,) * 3
    gas = moist_air(n, start.vapour)
    box: dict[str, Any] = {"length": length, "walls": (HeatBath(1.0),) * 6, "seed": settings.seed, **gas._asdict()}
    if drops:  # their nuclei are placed before the molecules
        rng = RandomNumbers(settings.seed)
        drawn = Start(n, WARM).draw(rng, **gas._asdict())
        wide = np.concatenate([np.full(drops, 2.0 * settings.drop_size * MOLECULE), np.ones(n)])
        place = engine.scatter(length, wide, rng)
        box |= {"rotational_energy": drawn.rotational_energy, "liquid": _liquid(settings, start, place[:drops])}
        parcel = engine.make(place[drops:], drawn.velocity, **box)
    else:
        parcel = engine.begin(Start(n, (*WARM, Scattered())), liquid=_liquid(settings, start), **box)
    memory = start.memory(_faces(settings, start))
    duration, measured = settings.si.duration / scale.time, (Air(), Water(), *((DropSizes(),) if drops else ()))
    facts = {
        "box": f"a cube of {length[0] * scale.length * 1e9:.1f} nm, real size",
        "real molecules per simulated one": "1",
        "exaggeration": f"none in the gas; the drops are {settings.drop_size:g} times as wide as real ones"
        if drops
        else "none in the gas; the droplets have far more area than so little water could have",
        "vapour at the start": f"{start.vapour} molecules; {start.full:.0f} saturate the air",
        "time to condense": f"{memory * 1e9:.2g} ns",
        "noise of the hygrometer": f"{100.0 / math.sqrt(start.full):.2g} % from one reading to the next",
    }
    knobs = (wall_temperature(parcel, scale, settings, low=-20.0, high=60.0),)
    return Setup(parcel, scale, duration, FRAMES, measured, samples=4, settle=SETTLE, facts=facts, knobs=knobs)


def _faces(settings: Settings, start: MoistBox) -> float:
    """Return the area of the liquid over that of a face of the box; of drops, the final area if none of them merge."""
    if not settings.drops:
        return settings.area
    held = max(start.vapour - start.full, 0.0) / settings.drops
    reach = settings.drop_size * MOLECULE * (1.0 + held) ** (1.0 / 3.0) + 0.5
    return float(settings.drops * 4.0 * math.pi * (reach / start.side) ** 2)


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return saturation at the temperature of the walls, and the rate at which its vapour hits the liquid."""
    start = MoistBox.of(settings, ideal=used(dataset).ideal)
    walls = dataset.wall_temperature.values[:, 0]
    warmths, which = np.unique(walls, return_inverse=True)
    share = np.array([start.share_at(float(warmth)) for warmth in warmths])[which]
    flux = np.array([start.flux_at(float(warmth)) for warmth in warmths])[which]
    area = dataset.drop_area.values if settings.drops else np.full(walls.size, settings.area * start.face)
    if settings.drops:
        held, drops = dataset.liquid_molecule_count.values, dataset.drop_count.values
        share = share * start.over_drops(held, drops, settings.drop_size * MOLECULE)
        flux = flux * (held + 1.0) / (held + drops)  # an empty drop has no molecule to lose
    return {
        "water_vapor_partial_pressure_theory": share * np.asarray(law.saturation_vapor_pressure(walls)),
        "relative_humidity_theory": share,
        "condensation_rate_theory": flux * area,
        "air_temperature_theory": walls,
    }


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return humidity, vapour pressure and both rates, averaged after equilibrium.

    The humidity refers to the temperature of the walls. With the temperature of the air in each sample it would come
    out too large: the temperature of so few molecules scatters, and 1 / e_s is convex.
    """
    start = MoistBox.of(settings, ideal=used(dataset).ideal)
    faces = _faces(settings, start)
    memory = start.memory(faces)
    # the excess of vapour at the start must have condensed
    gone = math.ceil(MEMORIES * memory / settings.si.duration * FRAMES) if settings.si.humidity > 1.0 else 0
    late = dataset.isel(elapsed_time=slice(max(SETTLE, gone), None))
    if late.sizes["elapsed_time"] < 2 * BLOCKS:
        return ()
    vapour = late.water_vapor_partial_pressure
    lasted = settings.si.duration * late.sizes["elapsed_time"] / FRAMES
    share = start.share_at(start.temperature)
    # if only few molecules came and went, blocks tell little of the error: use a Poisson number with this memory
    few = start.flux_at(start.temperature) * faces * start.face * lasted < FEW
    alone = math.sqrt(2.0 * memory / lasted * share / start.full) if few else 0.0
    humid, wet = late.relative_humidity_theory, late.water_vapor_partial_pressure_theory
    both = late.condensation_rate_theory
    rows = (
        ("relative_humidity", vapour / start.saturated, "1", "percent", "relative humidity", humid),
        (vapour.name, vapour, "Pa", "hPa", "vapour pressure", wet),
        ("condensation_rate", late.condensation_rate, "s-1", "ns-1", "condensation", both),
        ("evaporation_rate", late.evaporation_rate, "s-1", "ns-1", "evaporation", both),
    )
    found = []
    for name, measured, unit, shown, label, expected in rows:
        mean = block_average(measured.values, BLOCKS, memory / settings.si.duration * FRAMES)
        theory = float(expected.mean())
        error = np.maximum(mean.standard_error, alone * theory / share if share else 0.0)
        found.append(Headline.of_mean(f"mean_{name}", label, BlockAverage(mean.mean, error), theory, unit, shown))
    return tuple(found)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of vapour pressure and both rates against time, and of the drops if there are any."""
    grown = over_time("The drops grow and merge", {"largest_drop_radius": "the largest drop"}, "radius", "nm", log=True)
    begun = settings.si.humidity * float(law.saturation_vapor_pressure(settings.si.temperature)) / 100.0
    vapour = over_time(
        "The air becomes saturated", {"water_vapor_partial_pressure": "vapour"}, "vapour pressure", "hPa",
        log=True, parts=PARTS, headline="mean_water_vapor_partial_pressure", theory="saturation",
        start=begun, note="Then the vapour pressure fluctuates by chance.", y_limits=(0.0,),
    )  # fmt: skip
    rates = over_time(
        "In the end as many evaporate as condense",
        {"condensation_rate": "condensation", "evaporation_rate": "evaporation"}, "molecules per time", "ns-1",
        log=True, parts=PARTS, theory="theory", y_limits=(0.0,),
        note="Condensing warms the liquid, so evaporation is fast, too." if settings.humidity > 100.0 else "",
    )  # fmt: skip
    return (vapour, rates, grown) if settings.drops else (vapour, rates)

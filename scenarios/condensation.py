"""Clouds form where more vapour meets water than leaves it.

Moist air of real density between walls of one temperature, with more vapour in it than it can hold. Two
things are counted: the molecules of vapour that meet liquid and stay, and those that leave it. The first rate
falls while vapour is used up, the second does not care, and where they meet the air is saturated: the vapour
pressure is then e_s(T), the relative humidity 100 %. No rule says so.

Modelled: hard molecules of air and water at real density; droplets too fine to draw, of one temperature and a
given area, that every molecule of vapour sticks to which meets them; a binding energy and two heat capacities,
from which e_s(T) follows. Left out: ice, the curvature of droplets and what is dissolved in them, so that no
supersaturation is needed to start; forces between molecules of vapour; gravity.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine.liquid import Drops, Liquid, Mist
from atmosbox.engine.start import random_positions
from atmosbox.engine.walls import HeatBath
from atmosbox.engines import EXACT, EngineChoice, used
from atmosbox.errors import SettingError
from atmosbox.headline import Headline
from atmosbox.instruments import Air, DropSizes, Water
from atmosbox.moisture import moist_air, vapour_molecules, water
from atmosbox.panels import Line, Panel
from atmosbox.scene import Setup
from atmosbox.settings import SceneSettings, setting
from atmosbox.statistics import block_average
from atmosbox.units import BOLTZMANN, DRY_AIR, Scale

if TYPE_CHECKING:
    import xarray as xr

title = "Condensation"
FRAMES = 240
SETTLE = 40
PARTS = 24
"""Into how many equal parts of the logarithmic axis of time its curves are averaged."""
BLOCKS = 20
MEMORIES = 4.0
"""After how many memories a surplus is forgotten."""
FEW = 400
"""How many molecules must have condensed for an error to be read from blocks alone."""
NUCLEI = 100.0
"""Heat capacity of the nuclei, in k, that droplets form on; at most half a percent of that of the air."""


MOLECULE = 0.52
"""Radius of the ball that a molecule fills in liquid water, over the diameter of one of air: 0.193 nm to 0.37 nm."""
CORE = 20.0
"""Mass of the nucleus of a drop, in molecules of air."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(10_000, "1", "number of molecules of air and vapour", low=50, high=1_000_000)
    temperature: float = setting(20.0, "degC", "temperature of the walls", low=-60.0, high=95.0)
    pressure: float = setting(1000.0, "hPa", "pressure of air and vapour at the start", low=1.0, high=50_000.0)
    humidity: float = setting(150.0, "percent", "relative humidity at the start", low=0.0, high=1000.0)
    area: float = setting(2.0, "1", "area of the mist, in faces of the box", low=0.01, high=100.0)
    drops: int = setting(0, "1", "number of nuclei of drops that can be seen; 0 for a mist", low=0, high=50)
    drop_size: float = setting(8.0, "1", "how many times wider the drops are than real ones", low=1.0, high=20.0)
    duration: float = setting(40.0, "ns", "how long to watch", low=0.01, high=1e5)

    def check(self) -> None:
        """Refuse vapour that leaves no room for air."""
        most = self.si.pressure / float(law.saturation_vapor_pressure(self.si.temperature))
        if self.si.humidity > most:
            raise SettingError(
                "humidity",
                f"{self.humidity:g} %",
                f"is more vapour than there is gas at {self.pressure:g} hPa and {self.temperature:g} degC",
                f"give --set humidity={math.floor(100.0 * most)}percent or less",
            )


def _start(settings: Settings, *, ideal: bool) -> tuple[Scale, float, float, float]:
    """Return the scale, the density [1/diameter^3], the side that centres can reach [diameters], and Z."""
    si = settings.si
    scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * si.temperature)
    wanted = si.pressure / scale.pressure
    density, factor = wanted, 1.0
    for _ in range(100):
        factor = 1.0 if ideal else float(law.compressibility_factor(law.packing_fraction(density, 1.0)))
        density = math.sqrt(density * wanted / factor)
    return scale, density, (settings.molecules / density) ** (1.0 / 3.0), factor


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the moist air between its walls."""
    si = settings.si
    n = settings.molecules
    rng = np.random.default_rng(settings.seed)
    scale, _, side, _ = _start(settings, ideal=engine.ideal)
    length = (side + 1.0,) * 3
    saturated = float(law.saturation_vapor_pressure(si.temperature))
    vapour = vapour_molecules(n, si.humidity * saturated, si.pressure)
    gas = moist_air(n, vapour, rng)
    drops = settings.drops
    ball = settings.drop_size * MOLECULE
    wide = np.concatenate([np.full(drops, 2.0 * ball), np.ones(n)])
    place = random_positions(length, wide, rng)
    heat = min(NUCLEI, 0.005 * 3.5 * n)
    liquid: Liquid = Mist(water(scale), kT=1.0, nuclei=heat, area=settings.area * side**2)
    if drops:
        nuclei = tuple((float(x), float(y), float(z)) for x, y, z in place[:drops])
        liquid = Drops(
            water(scale),
            kT=1.0,
            nuclei=heat,
            position=nuclei,
            nucleus=ball,
            nucleus_mass=CORE,
            molecule_radius=ball,
        )
    parcel = engine.make(
        place[drops:],
        gas.velocity,
        length=length,
        walls=(HeatBath(1.0),) * 6,
        mass=gas.mass,
        rotation=gas.rotation,
        rotational_energy=gas.rotational_energy,
        seed=settings.seed,
        liquid=liquid,
    )
    full = n * saturated / si.pressure
    return Setup(
        parcel,
        scale,
        si.duration / scale.time,
        FRAMES,
        (Air(), Water(), DropSizes()) if drops else (Air(), Water()),
        samples=4,
        settle=SETTLE,
        facts={
            "box": f"a cube of {length[0] * scale.length * 1e9:.1f} nm, real size",
            "weight of a molecule": "1: every molecule stands for itself",
            "exaggeration": f"none in the gas; the drops are {settings.drop_size:g} times as wide as real ones"
            if drops
            else "none in the gas; the droplets have far more area than so little water could",
            "vapour at the start": f"{vapour} molecules; {full:.0f} saturate the air",
            "time to condense": f"{_memory(settings, ideal=engine.ideal) * 1e9:.2g} ns",
            "noise of the hygrometer": f"{100.0 / math.sqrt(full):.2g} % at every look",
        },
    )


def _faces(settings: Settings, *, ideal: bool) -> float:
    """Return the area of the liquid in faces of the box; of drops, that which they have in the end if none merge."""
    if not settings.drops:
        return settings.area
    _, _, side, _ = _start(settings, ideal=ideal)
    saturated = float(law.saturation_vapor_pressure(settings.si.temperature))
    waters = vapour_molecules(settings.molecules, settings.si.humidity * saturated, settings.si.pressure)
    held = max(waters - settings.molecules * saturated / settings.si.pressure, 0.0) / settings.drops
    reach = settings.drop_size * MOLECULE * (1.0 + held) ** (1.0 / 3.0) + 0.5
    faces: float = settings.drops * 4.0 * math.pi * (reach / side) ** 2
    return faces


def _memory(settings: Settings, *, ideal: bool) -> float:
    r"""Return how long the number of molecules of vapour remembers a chance surplus [s].

    A surplus must find liquid, :math:`4V/A\bar c`, but its latent heat must leave the droplets with the air that hits
    them, and the air with the walls: until then the liquid is too warm to keep it. A hit takes 3 kT along. With the
    share x of the vapour and :math:`\ell = L/kT`,

    .. math:: \frac{4 V}{A \bar c_v} + \frac{x \ell^2}{3} \frac{4 V}{\bar c_a} \left[\frac1A + \frac1{A_w}\right].
    """
    si = settings.si
    scale, _, side, _ = _start(settings, ideal=ideal)
    share = float(law.saturation_vapor_pressure(si.temperature)) / si.pressure
    latent = law.BINDING_TEMPERATURE / si.temperature - (law.LIQUID_HEAT_CAPACITY - law.VAPOR_HEAT_CAPACITY)
    find, cool = (4.0 * side / float(law.mean_speed(1.0, mass)) for mass in (law.WATER_MASS_RATIO, 1.0))
    faces = _faces(settings, ideal=ideal)
    held = share * latent**2 / 3.0 * cool * (1.0 / faces + 1.0 / 6.0)
    return float((find / faces + held) * scale.time)


def _short(lengths: float) -> float:
    r"""Return by what to multiply errors that are read from blocks of so many memories, which know of each other.

    Of a memory that fades as :math:`e^{-t/\tau}` a block of length L shows the share
    :math:`1 - (1 - e^{-L/\tau}) \tau/L` of the variance of the mean.
    """
    return 1.0 / math.sqrt(1.0 + math.expm1(-lengths) / lengths)


def _expected(settings: Settings, *, ideal: bool) -> tuple[float, float, float]:
    """Return the mean vapour pressure [Pa], its share of saturation, and the rate of exchange at saturation [1/s]."""
    si = settings.si
    scale, _, side, factor = _start(settings, ideal=ideal)
    saturated = float(law.saturation_vapor_pressure(si.temperature))
    water_molecules = vapour_molecules(settings.molecules, si.humidity * saturated, si.pressure)
    room = (side * scale.length) ** 3 / factor
    full = saturated * room / (BOLTZMANN * si.temperature)
    share = law.isothermal_vapor_number(water_molecules, si.temperature, room).mean / full
    flux = float(law.hertz_knudsen_flux(si.temperature))
    return share * saturated, share, share * flux * _faces(settings, ideal=ideal) * (side * scale.length) ** 2


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return saturation, and the rate at which its vapour meets the liquid."""
    frames = np.ones(dataset.sizes["elapsed_time"])
    pressure, share, rate = _expected(settings, ideal=used(dataset).ideal)
    flux = share * float(law.hertz_knudsen_flux(settings.si.temperature))
    return {
        "water_vapor_partial_pressure_theory": pressure * frames,
        "relative_humidity_theory": share * frames,
        "condensation_rate_theory": rate * frames if not settings.drops else flux * dataset.drop_area.values,
        "air_temperature_theory": settings.si.temperature * frames,
    }


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return humidity, vapour pressure and both rates, once they have met.

    The humidity is that at the temperature of the walls. Over that of the air at each look it would come out too large:
    so few molecules scatter in temperature, and one over e_s is convex.
    """
    ideal = used(dataset).ideal
    memory = _memory(settings, ideal=ideal)
    # what is too much at the start must have condensed
    gone = math.ceil(MEMORIES * memory / settings.si.duration * FRAMES) if settings.si.humidity > 1.0 else 0
    late = dataset.isel(elapsed_time=slice(max(SETTLE, gone), None))
    if late.sizes["elapsed_time"] < 2 * BLOCKS:
        return ()
    nothing = "none: the model has no other error than chance"
    vapour = late.water_vapor_partial_pressure
    saturation = float(law.saturation_vapor_pressure(settings.si.temperature))
    lasted = settings.si.duration * late.sizes["elapsed_time"] / FRAMES
    short = _short(lasted / BLOCKS / memory)
    _, share, rate = _expected(settings, ideal=ideal)
    # if only few came and went, blocks tell little of the error: that of a Poisson number with this memory
    few = rate * lasted < FEW
    full = settings.molecules * saturation / settings.si.pressure
    alone = math.sqrt(2.0 * memory / lasted * share / full) if few else 0.0
    rows = (
        ("relative_humidity", vapour / saturation, "1", "percent", "relative humidity", late.relative_humidity_theory),
        (vapour.name, vapour, "Pa", "hPa", "vapour pressure", late.water_vapor_partial_pressure_theory),
        ("condensation_rate", late.condensation_rate, "s-1", "ns-1", "condensation", late.condensation_rate_theory),
        ("evaporation_rate", late.evaporation_rate, "s-1", "ns-1", "evaporation", late.condensation_rate_theory),
    )
    found = []
    for name, measured, unit, shown, label, expected in rows:
        mean = block_average(measured.values, BLOCKS)
        error = max(short * float(mean.standard_error), alone * float(expected.mean()) / share if share else 0.0)
        found.append(
            Headline(
                f"mean_{name}",
                float(mean.mean),
                error,
                float(expected.mean()),
                0.0,
                nothing,
                unit,
                shown,
                label,
            )
        )
    return tuple(found)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return vapour pressure, the two rates and the water against time."""
    time = "elapsed_time"
    grown = Panel(
        "line",
        "The drops grow and merge",
        (Line(time, "largest_drop_radius", "the largest drop"),),
        x_label="time",
        y_label="radius",
        y_unit="nm",
        x_scale="log",
    )
    return (
        Panel(
            "line",
            "Vapour is used up until it just saturates",
            (
                Line(time, "water_vapor_partial_pressure", "vapour"),
                Line(time, "water_vapor_partial_pressure_theory", "saturation", "theory"),
            ),
            x_label="time",
            y_label="vapour pressure",
            y_unit="hPa",
            x_scale="log",
            averages=PARTS,
            headlines=("mean_water_vapor_partial_pressure",),
        ),
        Panel(
            "line",
            "It ends where two rates meet",
            (
                Line(time, "condensation_rate", "condensation"),
                Line(time, "evaporation_rate", "evaporation"),
                Line(time, "condensation_rate_theory", "theory", "theory"),
            ),
            x_label="time",
            y_label="molecules per time",
            y_unit="ns-1",
            x_scale="log",
            averages=PARTS,
            headlines=("mean_condensation_rate",),
        ),
        Panel(
            "line",
            "Where the water is",
            (
                Line(time, "vapor_molecule_count", "vapour"),
                Line(time, "liquid_molecule_count", "droplets"),
            ),
            x_label="time",
            y_label="molecules",
            x_scale="log",
            averages=PARTS,
            headlines=("mean_relative_humidity",),
        ),
        *((grown,) if settings.drops else ()),
    )

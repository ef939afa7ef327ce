"""Temperature measures the motion of molecules.

Molecules of air at their real density fly in a cube some twenty nanometres wide, whose six walls are warm. The
molecules start cold. One that hits a wall leaves it with a random speed that corresponds to the temperature of the
wall. So the gas becomes as warm as the walls within a fraction of a nanosecond. The speeds then follow Maxwell's law,
and the impacts on the walls add up to the pressure n k T Z, where Z is a little more than 1 because molecules have a
size.

Modelled: hard spheres of the mass and the diameter of air, which leave the walls with random velocities. Left out:
gravity (over twenty nanometres its effect is too small to be seen), rotation (it does not change how fast molecules
fly), and the different molecules of air. A thermometer of so few molecules scatters: by sqrt(2 / 3N) of the
temperature, 17 K for two hundred.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import EqualSpeeds, HeatBath, Maxwell, Scattered, Start
from atmosbox.scene import Air, EngineChoice, Headline, Scale, SceneSettings, Series, Setup, Speeds, setting
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.knob import wall_temperature
from atmosbox.scene.panels import Line, Panel, over_time
from atmosbox.scene.statistics import overlapping_average
from atmosbox.scene.units import rounded
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

title = "What is temperature?"
level = "school"
minutes = 10
FRAMES = 1000
SETTLE = 50
"""Number of frames left out of the means: until the gas is as warm as the walls."""
WARMEST = 500.0
"""Temperature to which the walls can be warmed while the box runs [degC]."""

_LATE = {"collision_rate": 2.0}  # its error grows with this power of the step
series = (
    Series("exact", "duration", (5, 20, 80, 320)),
    Series("stepped", "delta", (0.8, 0.4, 0.2, 0.1, 0.05), {"duration": 20}, _LATE),
    Series("dsmc", "duration", (5, 20, 80, 320)),
    Series("stepped:applet", "delta", (0.8, 0.4, 0.2), {"duration": 5}, _LATE),
)
"""Runs to be compared by `atmosbox tradeoff`: steps miss collisions, in proportion to the square of their length."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(200, "1", "number of molecules", low=1, high=1_000_000)
    temperature: float = setting(25.0, "degC", "temperature of the walls", low=-270.0, high=2000.0)
    start_temperature: float = setting(
        -150.0, "degC", "temperature at which the molecules start", low=-273.0, high=2000.0
    )
    pressure: float = setting(
        1000.0, "hPa", "pressure of the air once it is as warm as the walls", low=0.01, high=100_000.0
    )
    start: str = setting(
        "maxwell", "", "speeds at the start: all different, or all equal", choices=("maxwell", "equal")
    )
    duration: float = setting(20.0, "ns", "how long to watch", low=0.01, high=1e5)


def _gas(settings: Settings, *, ideal: bool) -> tuple[Scale, law.WalledGas]:
    """Return the units of the engine in SI, and theory of the gas, as warm as the walls; on `dsmc` it is ideal."""
    scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * settings.si.temperature)
    return scale, law.walled_gas(settings.si.pressure / scale.pressure, settings.molecules, ideal=ideal)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the box: cold molecules at random places between warm walls, and the instruments."""
    si, n = settings.si, settings.molecules
    scale, gas = _gas(settings, ideal=engine.ideal)
    length = (rounded(gas.side) + 1.0,) * 3  # in diameters: no centre comes nearer to a wall than a radius
    cold = scale.reduced_temperature(si.start_temperature)
    speeds = Maxwell(cold) if settings.start == "maxwell" else EqualSpeeds(math.sqrt(3.0 * cold))
    start = Start(n, (speeds, Scattered()))
    parcel = engine.begin(start, length=length, walls=(HeatBath(1.0),) * 6, seed=settings.seed)
    knob = wall_temperature(parcel, scale, settings, low=-200.0, high=WARMEST)
    # bins of one width, up to a speed that hardly any molecule exceeds where the walls are warmest
    bins = math.ceil(36 * math.sqrt((knob.high + 273.15) / si.temperature))
    shares = Speeds(np.linspace(0.0, 0.125 * bins, bins + 1))
    facts = {
        "box": f"a cube of {length[0] * scale.length * 1e9:.1f} nm, real size",
        "real molecules per simulated one": "1",
        "exaggeration": "none: mass, diameter, density and speeds are those of air",
        "degrees of freedom": "3: the molecules do not rotate",
        "mean free path": f"{float(law.mean_free_path(gas.density, 1.0)) * scale.length * 1e9:.3g} nm",
        "noise of the thermometer": f"{float(law.temperature_noise(n, 3, si.temperature)):.2g} K "
        "from one reading to the next",
    }
    duration = si.duration / scale.time
    return Setup(parcel, scale, duration, FRAMES, (Air(), shares), settle=SETTLE, facts=facts, knobs=(knob,))


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return n k T Z, the noise of a small thermometer, and Maxwell's curves, at the start and as warm as the walls."""
    scale, gas = _gas(settings, ideal=used(dataset).ideal)
    walls = dataset.wall_temperature.values[:, 0]
    kT, cold = BOLTZMANN * float(walls[-1]), BOLTZMANN * settings.si.start_temperature
    return {
        "air_temperature_theory": walls,
        "air_temperature_noise": np.asarray(law.temperature_noise(settings.molecules, 3, walls)),
        "air_pressure_theory": gas.density * gas.factor * scale.pressure * walls / scale.temperature,
        "speed_probability_density_theory": law.maxwell_speed_density(dataset.speed, kT, DRY_AIR.molecule_mass),
        "speed_probability_density_start": law.maxwell_speed_density(dataset.speed, cold, DRY_AIR.molecule_mass),
    }


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return temperature, pressure, mean speed and collision rate."""
    si = settings.si
    scale, gas = _gas(settings, ideal=used(dataset).ideal)
    warm = dataset.isel(elapsed_time=slice(SETTLE, None))
    if warm.sizes["elapsed_time"] < 41:
        return ()  # too few for error bars
    # the length of a frame [s], and collisions of a molecule per second: a collision counts for both molecules
    frame = float(warm.elapsed_time[-1] - warm.elapsed_time[0]) * 1e-9 / (warm.sizes["elapsed_time"] - 1)
    met = np.diff(warm.collision_count.values) * 2.0 / settings.molecules / frame
    measured = warm.air_temperature.values, warm.air_pressure.values, warm.mean_molecular_speed.values, met
    # `memory`: the time over which the gas correlates, in frames
    mean = [overlapping_average(each, memory=gas.memory * scale.time / si.duration * FRAMES) for each in measured]
    pressure, rate = gas.density * gas.factor * scale.pressure, gas.collision_rate / scale.time
    speed = float(law.mean_speed(BOLTZMANN * si.temperature, DRY_AIR.molecule_mass))
    return (
        Headline.of_mean("mean_temperature", "temperature", mean[0], si.temperature, "K", "degC"),
        Headline.of_mean("mean_pressure", "pressure", mean[1], pressure, "Pa", "hPa"),
        Headline.of_mean("mean_speed", "mean speed", mean[2], speed, "m s-1"),
        Headline.of_mean("collision_rate", "collisions of a molecule", mean[3], rate, "s-1", "ns-1"),
    )


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of temperature and pressure against time, and of the speeds."""
    time, walls, noise = "elapsed_time", "air_temperature_theory", "air_temperature_noise"
    density = "speed_probability_density"
    temperature = over_time(
        "Molecules reach the temperature of the walls",
        {"air_temperature": "molecules"}, "temperature", "degC",
        more=(Line(time, walls, "walls ± expected scatter", "theory", error=noise),),
        log=True, parts=60, headline="mean_temperature", start=settings.start_temperature,
    )  # fmt: skip
    pressure = over_time(
        "Impacts on the walls make the pressure", {"air_pressure": "six walls"}, "pressure", "hPa",
        theory="n k T, molecules of finite size", log=True, parts=60, headline="mean_pressure",
    )  # fmt: skip
    measured = Line("speed", density, "molecules", error=f"{density}_se")
    lines: tuple[Line, ...] = (measured, Line("speed", f"{density}_theory", "Maxwell", "theory"))
    if settings.start == "maxwell":
        lines += (Line("speed", f"{density}_start", "Maxwell at the start", "reference"),)
    title = "In warm air molecules fly faster"
    speeds = Panel("histogram", title, lines, "speed", "probability density", headlines=("mean_speed",))
    return temperature, pressure, speeds

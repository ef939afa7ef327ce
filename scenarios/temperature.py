"""What temperature is: the motion of molecules.

Molecules of real air at real density, in a cube some nanometres wide whose six walls are kept warm. They
start cold; the walls send every molecule that hits them back at their own temperature, and within a
fraction of a nanosecond the gas is as warm as they. The speeds are then those of Maxwell, and their impacts
on the walls add up to the pressure n k T Z.

Modelled: hard spheres of the mass and the diameter of air, fully accommodating walls. Left out: gravity
(over twenty nanometres it does nothing), rotation (it does not change how fast molecules fly), and that
air is a mixture. A thermometer of so few molecules scatters: by sqrt(2 / 3N) of the temperature, 17 K for
two hundred.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import HeatBath, RandomNumbers, equal_speeds, maxwell_velocities
from atmosbox.scene import (
    Air,
    EngineChoice,
    Headline,
    Line,
    Panel,
    Scale,
    SceneSettings,
    Series,
    Setup,
    Speeds,
    setting,
)
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.knob import wall_temperature
from atmosbox.scene.panels import over_time
from atmosbox.scene.rounding import rounded
from atmosbox.scene.statistics import overlapping_average
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

title = "Temperature"
level = "school"
minutes = 10
FRAMES = 1000
SETTLE = 50

_LATE = {"collision_rate": 2.0}
ladder = (
    Series("exact", "duration", (5, 20, 80, 320)),
    Series("stepped", "delta", (0.8, 0.4, 0.2, 0.1, 0.05), {"duration": 20}, _LATE),
    Series("dsmc", "duration", (5, 20, 80, 320)),
    Series("stepped:applet", "delta", (0.8, 0.4, 0.2), {"duration": 5}, _LATE),
)
"""Runs worth comparing: steps miss collisions, in proportion to the square of their length."""


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


def _start(settings: Settings, *, ideal: bool) -> tuple[Scale, float, float, float]:
    """Return the scale, the density [1/diameter^3], the side within reach of the centres [diameters], and Z.

    Near a wall a molecule has fewer partners, and so Z - 1 is a little smaller than in open space. Molecules of
    an ideal gas have no volume, and Z is 1.
    """
    si = settings.si
    scale = Scale(DRY_AIR.diameter, DRY_AIR.molecule_mass, BOLTZMANN * si.temperature)
    wanted = si.pressure / scale.pressure
    density, factor = wanted, 1.0
    for _ in range(200):
        before = density, factor
        density *= math.sqrt(wanted / (density * factor))
        possible = min(density, 0.9)
        side = (settings.molecules / possible) ** (1.0 / 3.0)
        excess = float(law.compressibility_factor(law.packing_fraction(possible, 1.0))) - 1.0
        factor = 1.0 + (0.0 if ideal else excess * _contacts(possible, side, settings.molecules))
        if (density, factor) == before:
            break
    return scale, density, rounded((settings.molecules / density) ** (1.0 / 3.0)), factor


def _contacts(density: float, side: float, molecules: int) -> float:
    """Return the share of the contacts in open space that molecules have in a cube with walls.

    To lowest order in the packing fraction phi, by the surface tension of spheres at a hard wall, three molecules and a
    wall that exclude each other lower Z - 1 in a cube of side L by 27/4 phi sigma / L; that a partner, too, has N - 1
    partners raises it by 3 phi / N. Measured from the collisions of 200 molecules, in 12 runs each: 1.24 +- 0.08 % less
    at 500 bar and 2.85 +- 0.07 % at 1000 bar, where both together are 1.23 % and 2.76 %.
    """
    filled = float(law.packing_fraction(density, 1.0))
    return law.contact_share((side,) * 3, 1.0, molecules) * (1.0 - filled * (6.75 / side - 3.0 / molecules))


def _memory(density: float, side: float) -> float:
    r"""Return the correlation time of the energy of the gas between its walls [reduced time].

    A surplus leaves with the molecules that hit a wall, :math:`2kT` each of the :math:`\tfrac32 kT` that a molecule
    has, and must first be conducted to the walls: :math:`L / 2\bar c + L^2 / 3 \pi^2 D`, with the diffusivity :math:`D
    = 0.678 / \tfrac32 n \sigma^2` of a thin gas (Chapman and Enskog), which is the least value.
    """
    diffusivity = 0.678 / (1.5 * density)
    return side / (2.0 * float(law.mean_speed(1.0, 1.0))) + side**2 / (3.0 * math.pi**2 * diffusivity)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the cold gas between warm walls."""
    si = settings.si
    n = settings.molecules
    rng = RandomNumbers(settings.seed)
    scale, density, side, _ = _start(settings, ideal=engine.ideal)
    length = (side + 1.0,) * 3
    cold = scale.reduced_temperature(si.start_temperature)
    velocity = (
        maxwell_velocities(cold, np.ones(n), rng)
        if settings.start == "maxwell"
        else equal_speeds(math.sqrt(3.0 * cold), n, rng)
    )
    parcel = engine.make(
        engine.scatter(length, np.ones(n), rng),
        velocity,
        length=length,
        walls=(HeatBath(1.0),) * 6,
        seed=settings.seed,
    )
    fastest = 4.5
    free_path = float(law.mean_free_path(density, 1.0))
    return Setup(
        parcel,
        scale,
        si.duration / scale.time,
        FRAMES,
        (Air(), Speeds(np.linspace(0.0, fastest, 37))),
        settle=SETTLE,
        facts={
            "box": f"a cube of {length[0] * scale.length * 1e9:.1f} nm, real size",
            "real molecules per simulated one": "1",
            "exaggeration": "none: mass, diameter, density and speeds are those of air",
            "gamma": "5/3: the molecules do not rotate",
            "mean free path": f"{free_path * scale.length * 1e9:.3g} nm",
            "noise of the thermometer": f"{float(law.temperature_noise(n, 3, si.temperature)):.2g} K in each sample",
        },
        knobs=(wall_temperature(parcel, scale, settings, low=-200.0, high=500.0),),
    )


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return Maxwell's curve, n k T Z and the noise of a small thermometer, at the temperature of the walls."""
    scale, density, _, factor = _start(settings, ideal=used(dataset).ideal)
    walls = dataset.wall_temperature.values[:, 0]
    pressure = density * factor * scale.pressure
    return {
        "air_temperature_theory": walls,
        "air_temperature_noise": np.asarray(law.temperature_noise(settings.molecules, 3, walls)),
        "air_pressure_theory": pressure * walls / scale.temperature,
        "speed_probability_density_theory": law.maxwell_speed_density(
            dataset.speed.values, BOLTZMANN * float(walls[-1]), DRY_AIR.molecule_mass
        ),
    }


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return temperature, pressure, mean speed and collision rate."""
    si = settings.si
    ideal = used(dataset).ideal
    scale, density, side, factor = _start(settings, ideal=ideal)
    warm = dataset.isel(elapsed_time=slice(SETTLE, None))
    if warm.sizes["elapsed_time"] < 41:
        return ()
    memory = _memory(density, side) * scale.time / si.duration * FRAMES
    temperature = overlapping_average(warm.air_temperature.values, memory=memory)
    pressure = overlapping_average(warm.air_pressure.values, memory=memory)
    speed = overlapping_average(warm.mean_molecular_speed.values, memory=memory)
    lasted = float(warm.elapsed_time[-1] - warm.elapsed_time[0]) * 1e-9
    met = np.diff(warm.collision_count.values) * 2.0 / settings.molecules
    per_second = overlapping_average(met * (len(met) / lasted), memory=memory)
    expected = float(law.collision_rate(density, 1.0, 1.0, 1.0)) / scale.time
    if ideal:  # pairs chosen at random: no excluded volume, and any other molecule may be the partner
        crowded = float(law.contact_value(law.packing_fraction(density, 1.0)))
        expected *= (1.0 - 1.0 / settings.molecules) / crowded
    else:
        expected *= _contacts(density, side, settings.molecules)
    mean_speed = float(law.mean_speed(BOLTZMANN * si.temperature, DRY_AIR.molecule_mass))
    return (
        Headline.of_mean("mean_temperature", "temperature", temperature, si.temperature, "K", "degC"),
        Headline.of_mean("mean_pressure", "pressure", pressure, density * factor * scale.pressure, "Pa", "hPa"),
        Headline.of_mean("mean_speed", "mean speed", speed, mean_speed, "m s-1"),
        Headline.of_mean("collision_rate", "collisions of a molecule", per_second, expected, "s-1", "ns-1"),
    )


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of temperature and pressure against time, and of the speeds."""
    warming = settings.start_temperature <= settings.temperature
    scatter = "air_temperature_noise"
    walls = Line("elapsed_time", "air_temperature_theory", "walls ± expected scatter", "theory", error=scatter)
    return (
        over_time(
            "Cold molecules between warm walls" if warming else "Hot molecules between cooler walls",
            {"air_temperature": "molecules"},
            "temperature",
            "degC",
            more=(walls,),
            log=True,
            parts=60,
            headline="mean_temperature",
        ),
        over_time(
            "Their impacts are the pressure",
            {"air_pressure": "six walls"},
            "pressure",
            "hPa",
            theory="n k T Z",
            log=True,
            parts=60,
            headline="mean_pressure",
        ),
        Panel(
            "histogram",
            "Speeds follow Maxwell's law",
            (
                Line("speed", "speed_probability_density", "molecules", error="speed_probability_density_se"),
                Line("speed", "speed_probability_density_theory", "Maxwell", "theory"),
            ),
            x_label="speed",
            y_label="probability density",
            headlines=("mean_speed",),
        ),
    )

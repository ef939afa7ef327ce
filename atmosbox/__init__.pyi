"""What an editor knows of `atmosbox`: made by tools/stub.py from the scenes, not to be edited by hand."""

import os
from typing import Any, Literal, overload

from atmosbox.interface import compare as compare
from atmosbox.interface import open as open
from atmosbox.interface import plot as plot
from atmosbox.interface import scenes as scenes
from atmosbox.interface import show as show
from atmosbox.interface import sweep as sweep
from atmosbox.interface.run_dataset import RunDataset, Show
from atmosbox.version import __version__ as __version__

__all__ = ["__version__", "compare", "open", "plot", "run", "scenes", "show", "sweep"]

@overload
def run(
    scene: Literal["temperature"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 200,
    temperature: float | str = 25.0,
    start_temperature: float | str = -150.0,
    pressure: float | str = 1000.0,
    start: Literal["maxwell", "equal"] = "maxwell",
    duration: float | str = 20.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Temperature measures the motion of molecules.

    molecules: number of molecules; 1 to 1000000
    temperature [degC]: temperature of the walls; -270 degC to 2000 degC
    start_temperature [degC]: temperature at which the molecules start; -273 degC to 2000 degC
    pressure [hPa]: pressure of the air once it is as warm as the walls; 0.01 hPa to 100000 hPa
    start: speeds at the start: all different, or all equal; maxwell or equal
    duration [ns]: how long to watch; 0.01 ns to 100000 ns
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["temperature-large"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 800,
    temperature: float | str = 25.0,
    start_temperature: float | str = -150.0,
    pressure: float | str = 1000.0,
    start: Literal["maxwell", "equal"] = "maxwell",
    duration: float | str = 20.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Temperature, with four times as many molecules.

    molecules: number of molecules; 1 to 1000000
    temperature [degC]: temperature of the walls; -270 degC to 2000 degC
    start_temperature [degC]: temperature at which the molecules start; -273 degC to 2000 degC
    pressure [hPa]: pressure of the air once it is as warm as the walls; 0.01 hPa to 100000 hPa
    start: speeds at the start: all different, or all equal; maxwell or equal
    duration [ns]: how long to watch; 0.01 ns to 100000 ns
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["elastic-collisions"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 60,
    mass_ratio: float | str = 20.0,
    filling: float | str = 15.0,
    side: float | str = 1.0,
    speed: float | str = 0.5,
    duration: float | str = 60.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Discs of different mass collide in a plane and share their energy.

    molecules: number of discs; 2 to 5000
    mass_ratio: largest possible ratio of two masses; 1 to 1000000
    filling [%]: share of the table that the discs cover; 0.01 % to 70 %
    side [m]: side of the table; 0.01 m to 100 m
    speed [m s-1]: speed of every disc at the start; 0.001 m s-1 to 1000 m s-1
    duration [s]: how long to watch; 0.1 s to 1000000 s
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["diffusion"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 12000,
    length: float | str = 150.0,
    mass_ratio: float | str = 1.0,
    temperature: float | str = 15.0,
    pressure: float | str = 1000.0,
    diameter: float | str = 1.3,
    duration: float | str = 3.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Two gases mix, because their molecules move at random.

    molecules: number of molecules of both gases together; 100 to 1000000
    length [nm]: length of the box; 10 nm to 10000 nm
    mass_ratio: mass of a molecule on the right, divided by that of one on the left; 0.01 to 100
    temperature [degC]: temperature of both gases; -200 degC to 1000 degC
    pressure [hPa]: pressure that both would have if molecules were points; 1 hPa to 20000 hPa
    diameter [nm]: diameter of a molecule; that of air is 0.37 nm; 0.1 nm to 3 nm
    duration: how long to watch, in mixing times; 0.5 to 50
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["atmosphere"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 10000,
    temperature: float | str = 288.15,
    surface_pressure: float | str = 1013.25,
    gravity: float | str = 9.80665,
    height: float | str = 25.0,
    knudsen: float | str = 0.3,
    floor: Literal["heat-bath", "isolated"] = "heat-bath",
    start: Literal["uniform", "equilibrium", "bottom"] = "uniform",
    rotation: bool = False,
    plane: bool = False,
    duration: float | str = 400.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Why the air does not fly away, and why it thins with height.

    molecules: number of molecules; 50 to 1000000
    temperature [K]: temperature of the floor, and of the air at the start; 10 K to 2000 K
    surface_pressure [hPa]: pressure at the floor; 1 hPa to 100000 hPa
    gravity [m s-2]: acceleration of gravity; 0.1 m s-2 to 100 m s-2
    height [km]: height of the ceiling; 0.1 km to 1000 km
    knudsen: mean free path at the floor in scale heights; 0.02 to 10
    floor: kind of floor: heat bath, or smooth so that no heat passes; heat-bath or isolated
    start: where the molecules start: spread evenly, in the profile of equilibrium, or near the floor; uniform or equilibrium or bottom
    rotation: whether molecules rotate, as those of air do; on or off
    plane: whether the air is a plane of discs; on or off
    duration: how long to watch, in units of H/√(kT/m), with the scale height H: 29 s in air at 15 °C; 1 to 100000
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["lifting-dry"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 4000,
    temperature: float | str = 15.0,
    pressure: float | str = 1000.0,
    top_pressure: float | str = 300.0,
    lapse_rate: float | str = 6.5,
    rotation: bool = True,
    ascent: float | str = 1600.0,
    diameter: float | str = 1.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""A parcel of dry air rises and cools.

    molecules: number of molecules in the parcel; 50 to 1000000
    temperature [degC]: temperature of the parcel and of the air at the ground; -80 degC to 60 degC
    pressure [hPa]: pressure at the ground; 200 hPa to 1100 hPa
    top_pressure [hPa]: pressure at which the ascent ends; 50 hPa to 1000 hPa
    lapse_rate [K km-1]: lapse rate of the environment; -5 K km-1 to 20 K km-1
    rotation: whether molecules rotate; without it gamma is 5/3; on or off
    ascent: duration of the ascent, in mean free times at its start; 5 to 1000000
    diameter [nm]: diameter of a molecule; that of air is 0.37 nm; 0.1 nm to 1.6 nm
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["convection"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    case: Literal["rolls", "inversion", "sea-breeze", "stable"] = "rolls",
    molecules: int | str = 7300,
    floor_temperature: float | str = 270.0,
    ceiling_temperature: float | str = -245.0,
    gravity: float | str = 9.80665,
    height: float | str = 13.5,
    width: float | str = 2.0,
    surface_pressure: float | str = 1013.25,
    packing: float | str = 0.2,
    sides: Literal["smooth", "periodic", "warm-and-cold"] = "smooth",
    start: Literal["at-rest", "mixed"] = "at-rest",
    tracers: Literal["floor", "chimney"] = "floor",
    rotation: bool = False,
    duration: float | str = 1000.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Why warm air rises: between a hot floor and a cold ceiling air begins to turn over.

    case: which box to run; it sets the other defaults; rolls or inversion or sea-breeze or stable
    molecules: number of molecules; 50 to 1000000
    floor_temperature [degC]: temperature of the floor, or of the left side; -270 degC to 2000 degC
    ceiling_temperature [degC]: temperature of the ceiling, or of the right side; -270 degC to 2000 degC
    gravity [m s-2]: acceleration of gravity; 0 m s-2 to 1000 m s-2
    height [km]: height of the ceiling; 0.1 km to 100 km
    width: width of the box, divided by its height; 0.5 to 10
    surface_pressure [hPa]: pressure at the floor of the air at rest; 1 hPa to 100000 hPa
    packing: share of the plane that discs cover; 0.01 to 0.5
    sides: the sides: smooth, periodic, or heat baths with smooth floor and ceiling; smooth or periodic or warm-and-cold
    start: the air at the start: at rest between floor and ceiling, or mixed, of one density and temperature; at-rest or mixed
    tracers: which molecules are marked half-way through the run: those near the floor, or above a chimney in its middle; floor or chimney
    rotation: whether spheres rotate, as molecules of air do; on the engine dsmc; on or off
    duration [s]: how long to watch; 1 s to 1000000 s
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["evaporation"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 15000,
    pool: int | str = 3000,
    temperature: float | str = 30.0,
    humidity: float | str = 20.0,
    pressure: float | str = 1000.0,
    duration: float | str = 20.0,
    diameter: float | str = 0.37,
    seed: int | str = 1,
) -> RunDataset:
    r"""Evaporation cools the water that remains.

    molecules: number of molecules of air and vapour at the start; 200 to 1000000
    pool: number of molecules in the pool at the start; 1 to 1000000
    temperature [degC]: temperature of the air and of the pool at the start; -60 degC to 95 degC
    humidity [percent]: relative humidity at the start; 0 percent to 1000 percent
    pressure [hPa]: pressure of the air, kept constant; 1 hPa to 20000 hPa
    duration [ns]: how long to watch; 0.01 ns to 10000 ns
    diameter [nm]: diameter of a molecule; that of air is 0.37 nm; 0.1 nm to 1 nm
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["condensation"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 10000,
    temperature: float | str = 20.0,
    pressure: float | str = 1000.0,
    humidity: float | str = 150.0,
    area: float | str = 2.0,
    drops: int | str = 0,
    drop_size: float | str = 6.0,
    duration: float | str = 40.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Clouds form where more molecules of water condense than evaporate.

    molecules: number of molecules of air and vapour; 50 to 1000000
    temperature [degC]: temperature of the walls; -60 degC to 95 degC
    pressure [hPa]: pressure of air and vapour at the start; 1 hPa to 50000 hPa
    humidity [percent]: relative humidity at the start; 0 percent to 1000 percent
    area: area of the mist, divided by that of a face of the box; 0.01 to 100
    drops: number of nuclei of drops that can be seen; 0 for a mist; 0 to 50
    drop_size: width of the drops, divided by that of real ones; 1 to 20
    duration [ns]: how long to watch; 0.01 ns to 100000 ns
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["nuclei"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 3000,
    temperature: float | str = 20.0,
    pressure: float | str = 100.0,
    humidity: float | str = 250.0,
    salted: int | str = 1,
    pure: int | str = 3,
    salt: int | str = 25,
    water: int | str = 60,
    tension: float | str = 1.0,
    drop_size: float | str = 4.0,
    duration: float | str = 150.0,
    seed: int | str = 1,
) -> RunDataset:
    r"""Why clouds need dust: small drops of pure water evaporate even in supersaturated air.

    molecules: number of molecules of air and vapour; 50 to 1000000
    temperature [degC]: temperature of the walls and of the drops; -30 degC to 95 degC
    pressure [hPa]: pressure of air and vapour at the start; 1 hPa to 5000 hPa
    humidity [percent]: relative humidity at the start; 0 percent to 1000 percent
    salted: number of drops with a grain of salt in them; 0 to 20
    pure: number of drops of pure water; 0 to 20
    salt: pairs of ions in each grain of salt; 1 to 1000
    water: molecules of water in each drop at the start; 0 to 5000
    tension: surface tension, divided by that of water; 0 to 2
    drop_size: width of the drops, divided by that of real ones; 1 to 10
    duration [ns]: how long to watch; 0.1 ns to 100000 ns
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["lifting-moist"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 30000,
    temperature: float | str = 25.0,
    dewpoint: float | str = 17.0,
    pressure: float | str = 1000.0,
    top_pressure: float | str = 300.0,
    lapse_rate: float | str = 6.5,
    rain: bool = False,
    cloud_water: float | str = 1.0,
    ascent: float | str = 1000.0,
    area: float | str = 12.0,
    diameter: float | str = 1.3,
    seed: int | str = 1,
) -> RunDataset:
    r"""A parcel of moist air rises past its cloud base.

    molecules: number of molecules in the parcel; 200 to 1000000
    temperature [degC]: temperature of parcel and air at the ground; -60 degC to 45 degC
    dewpoint [degC]: dewpoint of the parcel at the ground; -100 degC to 45 degC
    pressure [hPa]: pressure at the ground; 300 hPa to 1100 hPa
    top_pressure [hPa]: pressure at which the ascent ends; 100 hPa to 1000 hPa
    lapse_rate [K km-1]: lapse rate of the environment; -5 K km-1 to 20 K km-1
    rain: whether it rains; on or off
    cloud_water [g kg-1]: liquid that the cloud holds before it rains; 0 g kg-1 to 20 g kg-1
    ascent: duration of the ascent, in mean free times at its start; 20 to 1000000
    area: area of all droplets, divided by that of the floor; 0.1 to 100
    diameter [nm]: diameter of a molecule; that of air is 0.37 nm; 0.1 nm to 1.6 nm
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["lifting-sounding"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    sounding: str = "weisman-klemp",
    molecules: int | str = 30000,
    top_pressure: float | str = 150.0,
    rain: bool = False,
    cloud_water: float | str = 1.0,
    ascent: float | str = 1400.0,
    area: float | str = 12.0,
    diameter: float | str = 1.3,
    seed: int | str = 1,
) -> RunDataset:
    r"""A parcel of air rises through a sounding, and may become buoyant.

    sounding: file of a sounding, or weisman-klemp for the analytic one; any text
    molecules: number of molecules in the parcel; 200 to 1000000
    top_pressure [hPa]: pressure at which the ascent ends; 50 hPa to 900 hPa
    rain: whether it rains; on or off
    cloud_water [g kg-1]: liquid that the cloud holds before it rains; 0 g kg-1 to 20 g kg-1
    ascent: duration of the ascent, in mean free times at its start; 20 to 1000000
    area: area of all droplets, divided by that of the floor; 0.1 to 100
    diameter [nm]: diameter of a molecule; that of air is 0.37 nm; 0.1 nm to 1.6 nm
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["mountains"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 30000,
    temperature: float | str = 25.0,
    dewpoint: float | str = 17.0,
    pressure: float | str = 1000.0,
    first: float | str = 2.0,
    valley: float | str = 1.0,
    second: float | str = 3.0,
    lapse_rate: float | str = 6.5,
    rain: bool = True,
    cloud_water: float | str = 1.0,
    travel: float | str = 600.0,
    area: float | str = 12.0,
    diameter: float | str = 1.3,
    seed: int | str = 1,
) -> RunDataset:
    r"""Air that crosses mountains arrives warm and dry: the foehn.

    molecules: number of molecules in the parcel; 200 to 1000000
    temperature [degC]: temperature of parcel and air in the plain; -40 degC to 45 degC
    dewpoint [degC]: dewpoint of the parcel in the plain; -80 degC to 45 degC
    pressure [hPa]: pressure in the plain; 500 hPa to 1100 hPa
    first [km]: height of the first mountain; 0 km to 6 km
    valley [km]: height of the valley between; 0 km to 6 km
    second [km]: height of the second mountain; 0.1 km to 6 km
    lapse_rate [K km-1]: lapse rate of the environment; -5 K km-1 to 20 K km-1
    rain: whether it rains; on or off
    cloud_water [g kg-1]: liquid that the cloud holds before it rains; 0 g kg-1 to 20 g kg-1
    travel: duration of the crossing, in mean free times at its start; 20 to 1000000
    area: area of all droplets, divided by that of the floor; 0.1 to 100
    diameter [nm]: diameter of a molecule; that of air is 0.37 nm; 0.1 nm to 1.6 nm
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: Literal["attraction"],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    molecules: int | str = 800,
    temperature: float | str = 105.0,
    density: float | str = 0.26,
    attraction: float | str = 1.0,
    start: Literal["vapour", "slab", "drop", "pool"] = "vapour",
    bath: Literal["random", "walls", "none"] = "random",
    air: float | str = 0.0,
    substance: Literal["argon", "nitrogen", "methane"] = "argon",
    heating: float | str = 0.0,
    duration: float | str = 1.6,
    seed: int | str = 1,
) -> RunDataset:
    r"""Attraction between molecules is enough to form a liquid.

    molecules: number of molecules that attract each other; 50 to 20000
    temperature [K]: temperature of the thermostat and at the start; 10 K to 20000 K
    density: density of these molecules / critical density; 0.0001 to 2.3
    attraction: strength of the attraction; at 0 nothing condenses; 0 to 1
    start: state at the start; vapour or slab or drop or pool
    bath: what keeps the temperature constant; random or walls or none
    air: density of molecules without attraction / critical density; 0 to 1
    substance: substance that sets the size and attraction of the molecules; argon or nitrogen or methane
    heating [K ns-1]: how fast the thermostat becomes warmer; 0 for a constant temperature; 0 K ns-1 to 1000 K ns-1
    duration [ns]: how long to watch; 0.0001 ns to 10000 ns
    seed: seed of the random numbers; 0 to 9223372036854775807
    """

@overload
def run(
    scene: str | os.PathLike[str],
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    **settings: Any,
) -> RunDataset:
    """Run a scene of your own, or any by its name; `atmosbox.scenes(scene)` shows its settings."""

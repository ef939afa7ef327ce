"""Why warm air rises: between a hot floor and a cold ceiling air begins to turn over.

Thousands of hard discs fly in a box with gravity, in a plane as on a screen. The floor is hot, the ceiling cold.
At first the air is at rest and conducts heat. Where it is a little warmer than its neighbours it is lighter. After some
minutes it rises in plumes, spreads below the ceiling, cools, and sinks beside them: the air turns in rolls. This is not
prescribed: there is no parcel and no prescribed ascent in this box.

Air that rises expands and cools, by the adiabatic lapse rate. It is still warmer than its new environment only if the
temperature there falls faster with height. Even then viscosity and conduction must be weak enough. Once the air turns
over, the core cools less with height than it did at rest: it is mixed.

With ``case`` the same box shows an inversion (the floor is colder than the ceiling: smoke from a chimney stays low), a
sea breeze (one side is warm, the other cold: wind from the first moment on), or stable air (spheres of an ideal gas,
with the same difference of temperature and more gravity: the air stays at rest).

Modelled: hard discs in a plane with exact collisions; or with ``--engine dsmc`` an ideal gas of spheres, which may
rotate, in a box one cell deep. Floor and ceiling are heat baths, the sides smooth or periodic. Left out: water,
radiation, the rotation of the earth. Exaggerated: the difference of the temperatures, 515 K in 13.5 km. The box is only
about a hundred molecules high; its air is so viscous that a far smaller difference would not move it.
"""

import functools
import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import HeatBath, Maxwell, Periodic, Placed, RandomNumbers, Rotating, Scattered, Specular, Start
from atmosbox.errors import Option
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.headline import CHANCE_ALONE
from atmosbox.scene.instruments import Air, Flow, Layers
from atmosbox.scene.knob import gravity, wall_temperature
from atmosbox.scene.panels import Line, Panel, over_height, over_time
from atmosbox.scene.statistics import BlockAverage, growth_per_step, overlapping_average
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

title = "Why does warm air rise?"
level = "first year"
minutes = 15
FRAMES = 120
SETTLE = 80
"""Number of frames left out of the means: until the air turns over steadily."""
LEAST = 40
"""Least number of frames for a headline."""
BLOCKS = 5
"""Number of blocks from which the errors of lapse rate and heat are read: each is longer than the slowest fluctuation.

Over 60 seeds of stable air the values scatter by .96 and .80 of these errors; with 20 blocks, by 1.48 and .69.
"""
HEIGHTS = 6.0
"""Greatest height of the box, in scale heights at the mean of the temperatures of floor and ceiling."""
LEAST_GRAVITY = 1.0
"""Least gravity to which the knob can be turned [m s-2]: without any, other kernels would be needed."""
LOWEST = 4.0, 1.5
"""Least height of the box, in diameters of discs and in mean free paths of spheres."""
CROWD = 14.0
"""Mean number of discs in a cell of the fields; there are at most 16 rows of cells."""
CELL = 1.0
"""Side of a cell of dsmc, in mean free paths at the mean density."""
IN_CELL = 8.0
"""Number of spheres in a cube of a mean free path."""
LINEAR = 0.3
"""Share of its largest speed up to which a roll grows as theory says, but slower by the square of the share."""

CASES: dict[str, dict[str, Any]] = {
    "rolls": {},
    "inversion": {"floor_temperature": -60.0, "ceiling_temperature": 90.0, "tracers": "chimney"},
    "sea-breeze": {
        "floor_temperature": 127.0,
        "ceiling_temperature": -101.0,
        "sides": "warm-and-cold",
        "molecules": 3300,
    },
    "stable": {"gravity": 33.0, "molecules": 30_000},
}
"""The cases by name, with the settings that have other defaults there."""

TITLES = {"inversion": "Cold air lies below warm air", "stable": "The air stays at rest"}
"""Titles of the temperature in cases in which the air does not turn over."""

series = (
    Series("exact", "duration", (300, 600, 1200), {"molecules": 2000}),
    Series("stepped", "delta", (0.4, 0.2, 0.1), {"molecules": 2000, "duration": 300}),
    Series("dsmc", "molecules", (5000, 20_000, 50_000)),
)
"""Runs worth comparing: more molecules make a higher box, in which air turns over more easily."""

not_measured = "where fewer molecules make another flow, not a less accurate one"
"""Why there is no measured accuracy."""


class Settings(SceneSettings):
    """What a user may set."""

    case: str = setting("rolls", "", "which box to run; it sets the other defaults", choices=tuple(CASES))
    molecules: int = setting(7300, "1", "number of molecules", low=50, high=1_000_000)
    floor_temperature: float = setting(
        270.0, "degC", "temperature of the floor, or of the left side", low=-270.0, high=2000.0
    )
    ceiling_temperature: float = setting(
        -245.0, "degC", "temperature of the ceiling, or of the right side", low=-270.0, high=2000.0
    )
    gravity: float = setting(9.80665, "m s-2", "acceleration of gravity", low=0.0, high=1000.0)
    height: float = setting(13.5, "km", "height of the ceiling", low=0.1, high=100.0)
    width: float = setting(2.0, "1", "width of the box, divided by its height", low=0.5, high=10.0)
    surface_pressure: float = setting(1013.25, "hPa", "pressure at the floor of the air at rest", low=1.0, high=1e5)
    packing: float = setting(0.2, "1", "share of the plane that discs cover", low=0.01, high=0.5)
    sides: str = setting(
        "smooth",
        "",
        "the sides: smooth, periodic, or heat baths with smooth floor and ceiling",
        choices=("smooth", "periodic", "warm-and-cold"),
    )
    start: str = setting(
        "at-rest",
        "",
        "the air at the start: at rest between floor and ceiling, or mixed, of one density and temperature",
        choices=("at-rest", "mixed"),
    )
    tracers: str = setting(
        "floor",
        "",
        "which molecules are marked half-way through the run: those near the floor, or above a chimney in its middle",
        choices=("floor", "chimney"),
    )
    rotation: bool = setting(False, "", "whether spheres rotate, as molecules of air do; on the engine dsmc")
    duration: float = setting(1000.0, "s", "how long to watch", low=1.0, high=1e6)

    def __init__(self, /, **values: Any) -> None:
        """Take the defaults of the case for what the user does not set."""
        declared = {parameter.name: parameter for parameter in self.describe()}["case"]
        super().__init__(**(CASES[str(declared.parse(values.get("case", declared.default)))] | values))

    @property
    def most_gravity(self) -> float:
        """The gravity under which the box is `HEIGHTS` scale heights high [m s-2]."""
        si = self.si
        light = 0.5 * BOLTZMANN * (si.floor_temperature + si.ceiling_temperature) / DRY_AIR.molecule_mass / si.height
        return float(math.floor(100.0 * HEIGHTS * light) / 100.0)

    def check(self) -> None:
        """Refuse gravity so strong that hardly any air would be left near the ceiling."""
        most = self.most_gravity
        if self.gravity > most:
            problem = f"is so large that the box is more than {HEIGHTS:g} scale heights high"
            raise self.refusal("gravity", problem, ", or a lower height", at_most=most)


class Box:
    """The box in reduced units: mass in masses of a molecule, energy in kT at the mean temperature of the two walls.

    The unit of length is the diameter of a disc or, of the spheres of dsmc, their mean free path. A plane of discs
    stands for a slab one unit thick.
    """

    def __init__(self, settings: Settings, engine: EngineChoice = EXACT) -> None:
        si = settings.si
        # a thin gas of spheres instead of discs
        self.thin = engine.name == "dsmc"
        n, aspect = settings.molecules, settings.width
        density = IN_CELL if self.thin else 4.0 / math.pi * settings.packing
        self.height = rounded(math.sqrt(n / (density * aspect)))
        least = LOWEST[self.thin]
        if self.height < least:
            enough = math.ceil(least**2 * density * aspect)
            problem = f"are too few for a box {aspect:g} times as wide as high"
            raise settings.refusal("molecules", problem, at_least=enough)
        self.width = rounded(self.height * aspect)
        self.density = n / (self.height * self.width)
        # the diameter of spheres whose mean free path is 1
        across = rounded((math.sqrt(2.0) * math.pi * self.density) ** -0.5) if self.thin else 1.0
        # the cells of dsmc raise its conductivity and viscosity: by how much is known only for the usual cells
        self.usual = not {"cell", "occupancy"} & set(engine.options)
        cell = float(engine.options.get("cell", CELL)) if self.thin else 0.0
        self.gas = law.Gas((5 if settings.rotation else 3) if self.thin else 2, across, cell)
        energy = 0.5 * BOLTZMANN * (si.floor_temperature + si.ceiling_temperature)
        scale = Scale(si.height / self.height, DRY_AIR.molecule_mass, energy)
        self.floor, self.ceiling = (
            rounded(scale.reduced_temperature(kelvin)) for kelvin in (si.floor_temperature, si.ceiling_temperature)
        )
        self.gravity = rounded(si.gravity / scale.acceleration)
        self.beside = settings.sides == "warm-and-cold"
        self.walls = (0, 1) if self.beside else (4, 5)
        # wave numbers of rolls: half waves across the box, or whole waves where it is periodic
        self.waves = np.arange(1, 7) * (2 if settings.sides == "periodic" else 1) * math.pi / self.width
        try:
            pressure = float(self.rest().pressure[0])
        except ValueError as error:
            raise settings.refusal("packing", f"is too much: {error}", "give less, or a warmer ceiling") from error
        self.scale = Scale(scale.length, scale.mass, energy, si.surface_pressure / (pressure * scale.pressure))
        # the cells in which temperature and wind are measured
        self.rows = int(min(max(round(math.sqrt(n / (CROWD * aspect))), 4), 16))
        self.columns = int(min(max(round(aspect * self.rows), 4), 64))

    def rest(self, kT: tuple[float, float] | None = None, gravity: float | None = None) -> Any:
        """Return the air at rest."""
        floor, ceiling = (self.floor, self.ceiling) if kT is None else kT
        if self.beside:
            floor = ceiling = 0.5 * (floor + ceiling)
        return _rest(self.gas, self.height, floor, ceiling, self.gravity if gravity is None else gravity, self.density)

    def growth(self, kT: tuple[float, float], gravity: float) -> np.ndarray:
        """Return the growth rates of rolls; NaN where no theory is known, for discs and between warm and cold sides."""
        if not self.thin or self.beside:
            return np.full(len(self.waves), math.nan)
        return np.array(_growth(self.gas, self.height, *kT, gravity, self.density, tuple(self.waves)))

    def now(self, dataset: "xr.Dataset") -> tuple[tuple[float, float], float]:
        """Return temperatures of the walls and gravity at the end of a run, which may have been changed by hand."""
        kelvin = dataset.wall_temperature.values[-1]
        kT = tuple(float(kelvin[wall]) / self.scale.temperature for wall in self.walls)
        pull = float(dataset.gravity.values[-1]) / self.scale.acceleration if "gravity" in dataset else self.gravity
        return (kT[0], kT[1]), pull


_rest = functools.lru_cache(maxsize=32)(law.rest_state)


@functools.lru_cache(maxsize=32)
def _growth(
    gas: law.Gas, height: float, floor: float, ceiling: float, pull: float, density: float, waves: tuple[float, ...]
) -> tuple[float, ...]:
    """Return the growth rates of rolls of these wave numbers."""
    return tuple(law.growth_rates(gas, height, floor, ceiling, pull, density, waves).tolist())


def usual_engine(settings: Settings) -> str:
    """Return the engine on which the box runs unless the user names another.

    For stable air it is dsmc, because only of an ideal gas theory tells that it stays at rest.
    """
    return "dsmc" if settings.case == "stable" else "exact"


def _layered(box: Box, settings: Settings, rng: RandomNumbers) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and temperatures of molecules, each layer as dense and as warm as the start requires."""
    n = settings.molecules
    turn = settings.sides == "periodic"
    edge = 0.5 * box.gas.diameter
    rest = box.rest()
    even = settings.start == "mixed"
    density = np.ones_like(rest.density) if even else rest.density
    # the share of the molecules below each height
    below = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]))])
    below /= below[-1]
    if box.thin:
        share = rng.random((n, 3))
        x, y, up = share[:, 0], share[:, 1], share[:, 2]
        x = x if turn else edge / box.width + x * (1.0 - 2.0 * edge / box.width)
        place = np.stack([x * box.width, y, np.interp(up, below, rest.height)], axis=1)
    else:
        # discs stand in rows: the rows are farther apart where the air is thinner; within a row the distance is that
        # of the densest air
        wide = box.width - (0.0 if turn else 1.0)
        columns = max(int(wide * math.sqrt(float(density.max()))) + (0 if turn else 1), 1)
        rows = -(-n // columns)
        # n of all places, at random: the others stay free
        sites = np.sort(np.argsort(rng.random(rows * columns), kind="stable")[:n])
        row, column = np.divmod(sites, columns)
        x = column * wide / columns if turn else 0.5 + column * wide / max(columns - 1, 1)
        place = np.stack([x, np.ones(n), np.interp((row + 0.5) / rows, below, rest.height)], axis=1)
    inner = (place[:, 2] / box.height) * (box.height - 2.0 * edge) + edge
    place[:, 2] = inner
    kT = np.ones(n) if even else np.interp(inner, rest.height, rest.temperature)
    return rounded(place), rounded(kT)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the box at its start."""
    box = Box(settings, engine)
    if settings.rotation and not box.thin:
        raise settings.refusal("rotation", "is not for the discs of a plane", Option("engine", "dsmc"))
    n, scale = settings.molecules, box.scale
    planar = not box.thin
    rng: RandomNumbers | None = None
    places: Scattered | Placed = Scattered()
    kT: float | np.ndarray = 1.0
    if settings.start == "at-rest" or box.thin:
        rng = RandomNumbers(settings.seed)
        position, kT = _layered(box, settings, rng)
        places = Placed(position)
    spins = (Rotating(kT),) if settings.rotation else ()
    if box.thin and box.usual:
        engine = replace(engine, options={**engine.options, "cell": CELL})
    warm, cold = HeatBath(box.floor), HeatBath(box.ceiling)
    side, slab = (Periodic() if settings.sides == "periodic" else Specular()), (Specular() if planar else Periodic())
    ends = (Specular(), Specular()) if box.beside else (warm, cold)
    parcel = engine.begin(
        Start(n, (places, Maxwell(kT, exact=True), *spins)),
        rng=rng,
        length=(box.width, 2.0 if planar else 1.0, box.height),
        walls=(*((warm, cold) if box.beside else (side, side)), slab, slab, *ends),
        diameter=np.full(n, box.gas.diameter),
        gravity=box.gravity,
        planar=planar,
        layers=box.rows,
        rotation=2.0 if settings.rotation else 0.0,
        seed=settings.seed,
    )
    rest = box.rest()
    path = 1.0 if box.thin else float(box.gas.free_path(box.density))
    steep = (settings.si.floor_temperature - settings.si.ceiling_temperature) / settings.height
    lapse = float(law.adiabatic_lapse_rate(box.gas, box.density, box.gravity)) * scale.temperature / scale.length
    fastest = float(np.max(box.growth((box.floor, box.ceiling), box.gravity)))
    # the time in which conduction removes a difference of temperature in a box of this height
    spread = float(box.gas.conductivity(box.density, 1.0)) / (box.density * (0.5 * box.gas.freedom + 1.0))
    memory = box.height**2 / (math.pi**2 * spread)
    kind = "spheres of an ideal gas" if box.thin else f"discs {scale.length:.0f} m wide"
    depth = f"{'' if box.thin else 'a plane that stands for '}a slab {scale.length:.0f} m thick"
    onset = (
        "none: theory of the onset is for an ideal gas, on the engine dsmc"
        if math.isnan(fastest)
        else f"rolls grow by a factor e in {scale.time / fastest:.0f} s"
        if fastest > 0.0
        else "the air stays at rest"
    )
    flow = Flow(box.rows, box.columns, FRAMES // 2, chimney=settings.tracers == "chimney")
    facts = {
        "box": f"{depth}, {settings.width * settings.height:.3g} km wide, {settings.height:g} km high",
        "real molecules per simulated one": f"{scale.weight:.2g}",
        "exaggeration": f"{kind}; the box is {box.height / path:.0f} mean free paths high; in real air it would "
        f"be 10^11; temperature falls by {steep:.3g} K/km on average",
        "adiabat": f"{1000.0 * lapse:.3g} K/km at the mean density",
        "gamma": {2: "2: discs in a plane", 3: "5/3: they do not rotate", 5: "7/5"}[box.gas.freedom],
        "Rayleigh number": f"{law.rayleigh_number(rest):.3g}" if not box.beside else "none: the sides are heated",
        "Knudsen number": f"{path / box.height:.2g}, the mean free path divided by the height",
        "onset by linear theory": onset,
        "time": f"{settings.duration:g} s, of which the first {settings.duration * SETTLE / FRAMES:.0f} are left "
        "out of the means",
    }
    warmths = (
        wall_temperature(parcel, scale, settings, low=-250.0, high=500.0, name=name, wall=wall)
        for name, wall in zip(("floor_temperature", "ceiling_temperature"), box.walls, strict=True)
    )
    knobs = *warmths, *gravity(parcel, scale, settings, low=LEAST_GRAVITY, high=settings.most_gravity)
    duration, measured = settings.si.duration / scale.time, (Air("floor"), flow, Layers(box.rows, memory, flow=flow))
    return Setup(
        parcel, scale, duration, FRAMES, measured,
        samples=4, settle=SETTLE, time_unit="s", facts=facts, knobs=knobs,
    )  # fmt: skip


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the air at rest, the adiabat through the middle of the height, and the growth of weak rolls."""
    box = Box(settings, used(dataset))
    kT, pull = box.now(dataset)
    rest = box.rest(kT, pull)
    metre, kelvin = box.scale.length, box.scale.temperature
    height = dataset.height.values
    found = {"layer_temperature_conduction": np.interp(height, rest.height * metre, rest.temperature) * kelvin}
    if "layer_temperature" in dataset:
        density = dataset.number_density.values / box.scale.number_density
        # the adiabat: its lapse rate, summed from layer to layer, through the temperature measured half-way up
        steps = np.array(law.adiabatic_lapse_rate(box.gas, density, pull)) * kelvin / metre
        fallen = np.concatenate([[0.0], np.cumsum(0.5 * (steps[1:] + steps[:-1]) * np.diff(height))])
        middle = 0.5 * settings.si.height
        warm = np.interp(middle, height, dataset.layer_temperature.values)
        found["layer_temperature_adiabatic"] = warm + np.interp(middle, height, fallen) - fallen
    rates, last = box.growth(kT, pull), _linear(dataset, settings)
    # growth by linear theory, backwards and a little forwards from the last frame in which it holds
    found["roll_speed_theory"] = np.full(dataset.sizes["elapsed_time"], math.nan)
    if last is not None and np.max(rates) > 0.0:
        since = dataset.elapsed_time.values - dataset.elapsed_time.values[last]
        shown = np.arange(len(since)) <= last + last // 3
        grown = float(dataset.roll_speed.values[last]) * np.exp(np.max(rates) / box.scale.time * since[shown])
        found["roll_speed_theory"][shown] = grown
    return found


def _noise(dataset: "xr.Dataset", molecules: int) -> float:
    """Return the standard deviation of the amplitude of a roll in air at rest, the root of kT / mN [m/s]."""
    warm = float(np.mean(dataset.air_temperature.values))
    return math.sqrt(BOLTZMANN * warm / (DRY_AIR.molecule_mass * molecules))


def _linear(dataset: "xr.Dataset", settings: Settings) -> int | None:
    """Return the frame up to which rolls grow as linear theory says, if they do."""
    speed = dataset.roll_speed.values
    reached = speed > LINEAR * np.nanmax(speed)
    if settings.start != "at-rest" or settings.sides == "warm-and-cold" or not reached.any():
        return None
    last = int(np.argmax(reached))
    # rolls have grown if they are six times as strong as noise in all modes together
    least = 6.0 * math.sqrt(dataset.sizes["mode"]) * _noise(dataset, settings.molecules)
    return last if last >= 6 and np.nanmax(speed) > least else None


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return weight, lapse rate, heat and wind of the air, the share of marked molecules aloft, and growth of rolls."""
    box = Box(settings, used(dataset))
    late = dataset.isel(elapsed_time=slice(SETTLE, None))
    if late.sizes["elapsed_time"] < LEAST:
        return ()
    kT, pull = box.now(dataset)
    rest = box.rest(kT, pull)
    # in unstable air that does not turn over, buoyancy amplifies the noise of rolls: only stable air has a theory here
    still = box.thin and not box.beside and law.rayleigh_number(rest) <= 0.0
    found = [_weight(late, dataset, box)]
    if box.beside:
        found += _breeze(late)
    else:
        found += _core(late, box, rest, still=still)
    wind = overlapping_average(np.sign(late.wind_speed.values) * late.wind_speed.values**2)
    if still:
        found.append(Headline.of_mean("mean_square_wind", "mean square of the wind, less noise", wind, 0.0, "m2 s-2"))
    elif float(wind.mean) > 2.0 * float(wind.standard_error):  # less may be chance
        root = np.sqrt(wind.mean)
        speed = BlockAverage(root, 0.5 * wind.standard_error / root)
        found.append(Headline.of_mean("mean_wind_speed", "speed of the wind", speed, None, "m s-1"))
    share, error = (float(dataset[f"tracer_share_aloft{end}"].values[-1]) for end in ("", "_se"))
    if math.isfinite(share):
        label = "marked molecules in the upper half"
        found.append(Headline("share_from_the_floor", share, error, None, 0.0, CHANCE_ALONE, "1", "percent", label))
    last = _linear(dataset, settings)
    if last is not None and not still and box.thin:
        found += _grown(dataset, box, box.growth(kT, pull), last, settings.molecules)
    return tuple(found)


def _weight(late: "xr.Dataset", dataset: "xr.Dataset", box: Box) -> Headline:
    """Return the force on the floor minus that on the ceiling, the weight of the air."""
    force = late.wall_pressure.values
    lasted = float(np.diff(dataset.elapsed_time_bnds.values[[-late.sizes["elapsed_time"], -1], [0, 1]])[0])
    pull = box.now(dataset)[1]
    per_area = box.density * box.height
    # the share of the width that centres reach: all of it between periodic sides, which have no pressure (NaN)
    inner = 1.0 - (0.0 if bool(np.isnan(force[0, 0])) else box.gas.diameter) / box.width
    # the momentum at either end of the time is a matter of chance, with the variance N m kT
    warm = float(np.mean(late.air_temperature.values)) / box.scale.temperature
    chance = math.sqrt(2.0 * per_area * warm / box.width) / (lasted / box.scale.time)
    weight = float(np.mean(force[:, 4] - force[:, 5]))
    return Headline(
        "weight_of_the_air", weight, chance * box.scale.pressure, pull * per_area / inner * box.scale.pressure,
        0.0, CHANCE_ALONE, "Pa", "hPa", "pressure on the floor minus that on the ceiling",
    )  # fmt: skip


def _core(late: "xr.Dataset", box: Box, rest: law.RestState, *, still: bool) -> tuple[Headline, ...]:
    """Return the lapse rate of the core, and the Nusselt number, which is 1 in air at rest.

    No theory of the lapse rate of air at rest is good enough: below the cold ceiling mean free paths are so long that
    Fourier's law does not hold.
    """
    steep = overlapping_average(late.core_lapse_rate.values, BLOCKS)
    lapse = Headline.of_mean("mean_core_lapse_rate", "lapse rate of the core", steep, None, "K m-1", "K/km")
    if not rest.heat:
        return (lapse,)
    heat = np.diff(late.heat_from_wall.values, axis=0) / np.diff(late.elapsed_time.values)[:, None]
    unit = rest.heat * box.width * box.scale.total_energy / box.scale.time
    passed = overlapping_average(0.5 * (heat[:, 4] - heat[:, 5]) / unit, BLOCKS)
    label, known = "heat / heat conducted at rest (Nusselt number)", 1.0 if still and box.usual else None
    return lapse, Headline.of_mean("nusselt_number", label, passed, known, "1")


def _breeze(late: "xr.Dataset") -> tuple[Headline, Headline]:
    """Return the wind from the cold to the warm side in the lower half, and back in the upper half."""
    left, right = late.wall_temperature.values[-1, :2]
    wind = late.horizontal_wind.values * (1.0 if right > left else -1.0)  # to the warm side
    _, columns, rows = wind.shape
    middle = wind[:, columns // 4 : columns - columns // 4].mean(axis=1)
    onshore = overlapping_average(middle[:, : rows // 2].mean(axis=1))
    back = overlapping_average(-middle[:, rows // 2 :].mean(axis=1))
    return (
        Headline.of_mean("onshore_wind", "wind to the warm side, lower half", onshore, None, "m s-1"),
        Headline.of_mean("return_wind", "wind to the cold side, upper half", back, None, "m s-1"),
    )


def _grown(dataset: "xr.Dataset", box: Box, rates: np.ndarray, last: int, molecules: int) -> tuple[Headline, ...]:
    """Return the growth rate of the strongest roll while it is weak, beside that of linear theory."""
    strongest = int(np.argmax(np.abs(dataset.roll_amplitude.values[last])))
    step = float(dataset.elapsed_time.values[1] - dataset.elapsed_time.values[0])
    # the rate at which viscosity alone damps the roll, per frame
    square = float(box.waves[strongest]) ** 2 + (math.pi / box.height) ** 2
    decay = float(box.gas.viscosity(box.density, 1.0)) / box.density * square / box.scale.time * step
    weak = dataset.roll_amplitude.values[: last + 1, strongest]
    found = growth_per_step(weak, _noise(dataset, molecules), decay)
    if not math.isfinite(found.mean):
        return ()
    rate = float(rates[strongest]) / box.scale.time
    label = f"growth of the roll with {int(dataset.mode.values[strongest])} half waves"
    mean, known = BlockAverage(found.mean / step, found.standard_error / step), rate if box.usual else None
    off, reason = LINEAR**2 * abs(rate), "rolls that have grown are slower"
    return (Headline.of_mean("growth_rate", label, mean, known, "s-1", tolerance=off, reason=reason),)


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return the panels of temperature (or wind) against height, and of the rolls against time."""
    measured = Line("layer_temperature", "height", "molecules", error="layer_temperature_se")
    rest = Line("layer_temperature_conduction", "height", "conducted, at rest", "theory")
    adiabat = Line("layer_temperature_adiabatic", "height", "adiabat", "reference")
    title = TITLES.get(settings.case, "Mixed air comes nearer to the adiabat")
    note = "" if settings.case in TITLES else "A small box needs such large differences."
    profile = over_height(title, (measured, rest, adiabat), "temperature", "degC", "mean_core_lapse_rate", note=note)
    if settings.sides == "warm-and-cold":
        title, wind = "Wind to the warm side below, back above", "wind to the right"
        line = Line("layer_wind", "height", "wind", error="layer_wind_se")
        profile = over_height(title, (line,), wind, "m s-1", "onshore_wind", "return_wind")
    rolls = over_time(
        "The wind" if settings.case in TITLES else "How fast the rolls turn",
        {"roll_speed": "rolls"}, "speed of the rolls", theory="linear theory", x_unit="min", y_limits=(0.0,),
    )  # fmt: skip
    return profile, rolls

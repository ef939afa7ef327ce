"""Why the air does not fly away, and why it thins with height.

Ten thousand molecules fly in a tall column with real gravity. At the start they are as dense at 20 km as at the floor.
They fall, and within ten minutes density and pressure decrease with height by the barometric law: by a factor e every
8.4 km. The means leave out the first half hour. Each molecule falls freely between collisions, and yet the air collects
neither on the floor nor under the ceiling. The molecules hit the floor, and the force on the floor minus that on the
ceiling is the weight of the air.

The temperature becomes the same at all heights, because the air is left alone. A molecule that rises loses speed, but
only fast ones get there: fewer arrive, with the same mean energy. A real atmosphere is heated from below: it turns
over, and therefore cools with height. Left alone, without sun and radiation, it would become isothermal like this one
in some 100,000 years. The figure shows both temperatures. The scene ``convection`` heats the air from below.

Modelled: molecules in uniform gravity on exact parabolas, periodic sides, a floor that is a heat bath or smooth, a
smooth ceiling; with ``rotation`` molecules that rotate, which changes no profile at rest. With up to 5,000 molecules
these are hard spheres; with more, chance decides which of them collide, as often as spheres would. Left out: water,
wind, sunshine. With 10,000 molecules each stands for 10^33 real ones and is 70 metres wide, so that its mean free path
is a given share of the scale height (the Knudsen number). Theory is the barometric law, corrected for such wide
molecules: hard ones exclude volume, and no centre comes nearer to floor or ceiling than the radius of a molecule, so
that a part of the lowest and of the highest layer is empty. With ``plane`` the air consists of discs in a plane, which
stands for a slab one scale height thick.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import HeatBath, Maxwell, Periodic, Rotating, Scattered, Specular, Start
from atmosbox.errors import Setting
from atmosbox.scene import EngineChoice, Headline, SceneSettings, Series, Setup, setting
from atmosbox.scene.engines import EXACT, suited, used
from atmosbox.scene.headline import CHANCE_ALONE
from atmosbox.scene.instruments import Air, Layers
from atmosbox.scene.knob import gravity, wall_temperature
from atmosbox.scene.panels import Line, Panel, over_height
from atmosbox.scene.statistics import average_beside
from atmosbox.scene.units import Scale, rounded
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

title = "Why does the air thin with height, but not fall down?"
level = "first year"
minutes = 10
FRAMES = 240
SETTLE = 40
"""Least number of frames left out of the means; after a start out of equilibrium more, see `Column.settling`."""
LEAST = 40
"""Least number of settled frames for a headline."""
LAYERS = 25
FILLED = 3.0
"""Height in scale heights that a uniform start fills with molecules."""
JUMP = 0.563
"""Jump of temperature at a wall, 2.127 mean free paths (Sone 2007), over that of a gas without collisions."""

_PLANE = {"molecules": 3000, "plane": True, "knudsen": 0.05}
series = (
    Series("exact", "duration", (50, 100, 200, 400), {"molecules": 3000}),
    Series("stepped", "delta", (1.6, 0.8, 0.4, 0.2), {"molecules": 3000, "duration": 50}),
    Series("dsmc", "duration", (50, 100, 200, 400), {"molecules": 3000}),
    Series("dsmc", "molecules", (3000, 10_000, 30_000)),
    Series("exact", "duration", (50, 100), _PLANE),
    Series("stepped:applet-atmosphere", "delta", (8, 4, 2), _PLANE | {"duration": 50}),
)
"""Runs worth comparing: a column at rest is hardly sensitive to errors, except to a fall that creates energy."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(10_000, "1", "number of molecules", low=50, high=1_000_000)
    temperature: float = setting(
        288.15, "K", "temperature of the floor, and of the air at the start", low=10.0, high=2000.0
    )
    surface_pressure: float = setting(1013.25, "hPa", "pressure at the floor", low=1.0, high=1e5)
    gravity: float = setting(9.80665, "m s-2", "acceleration of gravity", low=0.1, high=100.0)
    height: float = setting(25.0, "km", "height of the ceiling", low=0.1, high=1000.0)
    knudsen: float = setting(0.3, "1", "mean free path at the floor in scale heights", low=0.02, high=10.0)
    floor: str = setting(
        "heat-bath", "", "kind of floor: heat bath, or smooth so that no heat passes", choices=("heat-bath", "isolated")
    )
    start: str = setting(
        "uniform",
        "",
        "where the molecules start: spread evenly, in the profile of equilibrium, or near the floor",
        choices=("uniform", "equilibrium", "bottom"),
    )
    rotation: bool = setting(False, "", "whether molecules rotate, as those of air do")
    plane: bool = setting(False, "", "whether the air is a plane of discs")
    duration: float = setting(
        400.0,
        "1",
        "how long to watch, in units of H/√(kT/m), with the scale height H: 29 s in air at 15 °C",
        low=1.0,
        high=1e5,
    )

    @property
    def freedom(self) -> int:
        """Degrees of freedom of a molecule."""
        return (2 if self.plane else 3) + (2 if self.rotation else 0)

    def check(self) -> None:
        """Refuse discs that rotate."""
        if self.plane and self.rotation:
            raise self.refusal("rotation", "is not for the discs of a plane", Setting("rotation", False))


class Column:
    """The column in reduced units: length in scale heights, energy in kT, mass in masses of a molecule.

    A column in the plane represents a slab of unit thickness, so that molecules per area are numerically molecules per
    volume. With an engine whose molecules have no volume, it has no excess pressure.
    """

    def __init__(self, settings: Settings, engine: EngineChoice = EXACT) -> None:
        si = settings.si
        self.energy = BOLTZMANN * si.temperature
        self.scale_height = self.energy / (DRY_AIR.molecule_mass * si.gravity)
        self.height = si.height / self.scale_height
        self.dimensions = 2 if settings.plane else 3
        self.freedom = settings.freedom
        n = settings.molecules
        held = -math.expm1(-min(self.height, 700.0))
        self.per_area = float(n)
        density = n / held
        if settings.plane:
            # mean free path of a thin gas of discs: Gass, D. M. (1971), J. Chem. Phys. 54, 1898
            self.diameter = 1.0 / (2.0 * math.sqrt(2.0) * density * settings.knudsen)
        else:
            self.diameter = math.sqrt(1.0 / (math.sqrt(2.0) * math.pi * density * settings.knudsen))
        self.diameter = rounded(self.diameter)
        self.room = 0.0 if engine.ideal else self.diameter
        # the floor carries the weight of the air and the pressure of the ceiling, which is small
        floor = self.per_area * (1.0 + math.exp(-min(self.height, 700.0)) / held)
        weight = si.surface_pressure / (self.energy * floor / self.scale_height**3)
        self.scale = Scale(self.scale_height, DRY_AIR.molecule_mass, self.energy, weight)
        self.bottom = 0.5 * self.diameter
        self.top = self.height - self.bottom

    @property
    def memory(self) -> float:
        r"""Time in which a surplus of energy in the column decays through the floor [reduced time].

        A column with a surplus :math:`c\,\Delta T` per molecule must conduct it to the floor, and the molecules that
        hit the floor must carry it away, :math:`(d + 1) k / 2` each,

        .. math:: \tau = \frac{0.563\,c N}{(d + 1) k J / 2} + \frac{c N}{\kappa} \int s(z)^2 dz

        for the flux :math:`J = n_0 \sqrt{kT / 2 \pi m}`, the share s(z) above z, and the conductivity of a
        thin gas by Chapman and Enskog, :math:`1.025\,(75/64)\,(k/\sigma^2) \sqrt{kT / \pi m}`, of discs
        :math:`1.029 \cdot 2\,(k/\sigma) \sqrt{kT / \pi m}` (Gass 1971, doi:10.1063/1.1675116).
        Half of the molecules at the floor come from the floor and have its temperature: so the gas there is nearer to
        the temperature of the floor than the molecules that hit it. The jump of the temperature is that along 2.127
        mean free paths (Sone 2007), 0.563 of the jump from the hits alone; this value is used for discs, too.
        """
        a, d, turns = min(self.height, 700.0), self.dimensions, self.freedom - self.dimensions
        held = -math.expm1(-a)
        capacity = 0.5 * self.freedom + 1.0 - a * a * math.exp(-a) / held**2
        leaves = JUMP * capacity * held / ((d + 1.0 + turns) / 2.0 / math.sqrt(2.0 * math.pi))
        spheres = 1.025 * 75.0 / 64.0 / self.diameter**2 * (1.25 if turns else 1.0)
        thin = spheres if d == 3 else 1.029 * 2.0 / self.diameter
        above = 0.5 - 2.0 * math.exp(-a) + (a + 1.5) * math.exp(-2.0 * a)
        conducted = capacity * self.per_area * above / held**2 / (thin / math.sqrt(math.pi))
        return float(leaves + conducted)

    def settling(self, settings: Settings) -> float:
        r"""Return the time in which the column relaxes after a start out of equilibrium [reduced time].

        The surplus of energy must leave through the floor, or, if the floor is isolated, spread to all heights:
        measured for Knudsen numbers of 0.02 to 5, that takes some 4 Kn times H/√(kT/m), with the scale height H.
        Of a surplus of a third of the energy less than a tenth of the scatter of a single sample is left after
        :math:`(2 + \tfrac12 \ln N)\,\tau`.
        """
        memory = self.memory + (4.0 * settings.knudsen if settings.floor == "isolated" else 0.0)
        return memory * (2.0 + 0.5 * math.log(settings.molecules))

    def density(self, edges: np.ndarray, kT: float, diameter: float, gravity: float = 1.0) -> np.ndarray:
        """Return the mean number density of layers in equilibrium [1/scale height^3]."""
        column = self.per_area, self.bottom, self.top, kT, 1.0, gravity, diameter
        return np.asarray(law.hydrostatic_layers(edges, *column, dimensions=self.dimensions))

    def equilibrium_kT(self, dataset: "xr.Dataset", settings: Settings) -> float:
        """Return the temperature of equilibrium: that of the floor, or the one that follows from the energy."""
        if settings.floor == "heat-bath":
            return float(dataset.wall_temperature.values[-1, 4]) / self.scale.temperature
        stores = dataset.kinetic_energy, dataset.rotational_energy, dataset.potential_energy
        energy = float(sum(store.values[0] for store in stores))
        each = energy / self.scale.total_energy / settings.molecules
        column = self.per_area, self.bottom, self.top, self.room
        rotation = self.freedom - self.dimensions
        return law.column_temperature(each, *column, dimensions=self.dimensions, rotation=rotation)

    def textbook_pressure(self, height: np.ndarray, kT: float, gravity: float = 1.0) -> np.ndarray:
        r"""Return the pressure of the textbook, :math:`p_0 e^{-m g z / kT}` [kT/scale height^3].

        Its :math:`p_0` is that of the same number of points between floor and ceiling.
        """
        floor = self.per_area / self.height * kT * float(law.column_floor_ratio(self.height, kT, 1.0, gravity))
        return np.asarray(law.barometric_pressure(height, floor, kT, 1.0, gravity))

    def mean_height(self, kT: float) -> float:
        """Return the mean height of the centres in equilibrium [scale height]."""
        column = self.per_area, self.bottom, self.top, kT, 1.0, 1.0, self.room
        return law.hydrostatic_mean_height(*column, dimensions=self.dimensions)

    def scale_height_of(self, mean: float) -> float:
        """Return the scale height of the closed column of points whose centres have this mean height [scale height]."""
        return law.column_scale_height(mean - self.bottom, self.top - self.bottom)

    def on_the_floor(self, kT: float) -> float:
        r"""Return the share of the molecules by which the layer on the floor holds more than locally uniform gas [1].

        A molecule at a wall has neighbours on one side only, which push it to the wall. Each area holds
        :math:`(9 / \pi) \phi^2 / (1 + 2 \phi) \sigma^2` spheres more at the packing fraction :math:`\phi`, by scaled
        particle theory; each length :math:`(2 / 3) n^2 \sigma^3` discs, to first order in their density n.
        """
        n = float(self.density(np.array([self.bottom, self.bottom + 1e-3]), kT, self.room)[0])
        if self.dimensions == 2:
            return 2.0 / 3.0 * n**2 * self.room**3 / self.per_area
        packing = math.pi / 6.0 * n * self.room**3
        return 0.25 * math.pi * n**2 * self.room**4 / (1.0 + 2.0 * packing) / self.per_area

    def pressure(self, density: np.ndarray, kT: float) -> np.ndarray:
        """Return the pressure of a gas of the column's molecules [kT/scale height^3]."""
        pressure = law.gas_pressure_discs if self.dimensions == 2 else law.gas_pressure
        return np.asarray(pressure(density, kT, self.room))


def _settled(column: Column, settings: Settings) -> int:
    """Return the number of frames until equilibrium."""
    if settings.start == "equilibrium":
        return SETTLE
    return min(max(math.ceil(column.settling(settings) / settings.duration * FRAMES), SETTLE), FRAMES - 1)


def usual_engine(settings: Settings) -> str:
    """Return the engine on which the column runs unless the user names another: exact for discs and few molecules."""
    return "exact" if settings.plane else suited(settings.molecules)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the column at its start."""
    column = Column(settings, engine)
    n = settings.molecules
    plane = settings.plane
    length = (1.0, 2.0 * column.diameter if plane else 1.0, column.height)
    if settings.start == "equilibrium":
        places = Scattered(scale_height=1.0)
    else:
        places = Scattered(top=min(FILLED if settings.start == "uniform" else 0.1, column.height))
    spins = (Rotating(1.0),) if settings.rotation else ()
    parcel = engine.begin(
        Start(n, (places, Maxwell(1.0, exact=True), *spins)),
        length=length,
        walls=(Periodic(),) * 4 + (HeatBath(1.0) if settings.floor == "heat-bath" else Specular(), Specular()),
        diameter=column.diameter,
        gravity=1.0,
        planar=plane,
        rotation=2.0 if settings.rotation else 0.0,
        layers=LAYERS,
        seed=settings.seed,
    )
    scale = column.scale
    settled = _settled(column, settings)
    box = f"{scale.length / 1000.0:.2f} km wide, periodic, {settings.height:g} km high"
    width = f"{'discs' if plane else 'molecules'} {column.diameter * scale.length:.{1 if plane else 0}f} m wide"
    turning = "7/5" if settings.rotation else "5/3: the molecules do not rotate"
    facts = {
        "box": f"a plane {box}; it stands for a slab {scale.length / 1000.0:.2f} km thick" if plane else box,
        "real molecules per simulated one": f"{scale.weight:.2g}",
        "exaggeration": f"{width}, which may overlap" if engine.ideal else width,
        "gamma": "2: the discs move in a plane and do not rotate" if plane else turning,
        "scale height": f"{scale.length / 1000.0:.2f} km",
        "Knudsen number": f"{settings.knudsen:g}, mean free path at the floor in scale heights",
        "time": f"{settings.duration * scale.time / 60.0:.0f} minutes, of which the first "
        f"{settled * settings.duration / FRAMES * scale.time / 60.0:.0f} are left out of the means",
        "noise": f"the thermometer of a layer of {n // LAYERS} molecules scatters from one reading to the "
        f"next by {settings.temperature * math.sqrt(2.0 * LAYERS / (column.dimensions * n)):.0f} K",
    }
    # colder discs in strong gravity would be too many in the lowest cells of a page
    warm = wall_temperature(parcel, scale, settings, low=200.0 if plane else 100.0, high=600.0)
    pull = gravity(parcel, scale, settings, low=1.0, high=20.0)
    knobs, measured = (
        (warm, *pull) if settings.floor == "heat-bath" else (),
        (Air("floor"), Layers(LAYERS, column.memory)),
    )
    return Setup(
        parcel, scale, settings.duration, FRAMES, measured,
        samples=8, settle=settled, time_unit="s", facts=facts, knobs=knobs,
    )  # fmt: skip


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the barometric law, and the same with walls and excluded volume."""
    column = Column(settings, used(dataset))
    scale = column.scale
    kT = column.equilibrium_kT(dataset, settings)
    edges = np.append(dataset.height_bnds.values[:, 0], dataset.height_bnds.values[-1, 1]) / scale.length
    thick = np.diff(edges)
    # no centre comes nearer to floor or ceiling than its radius: a part of the lowest and the highest layer is empty
    reached = np.maximum(np.minimum(edges[1:], column.top) - np.maximum(edges[:-1], column.bottom), 0.0) / thick
    pull = float(dataset.gravity.values[-1]) / scale.acceleration if "gravity" in dataset else 1.0
    density = column.density(edges, kT, column.room, pull)
    within = np.divide(density, reached, out=np.zeros_like(density), where=reached > 0.0)
    pressure = column.pressure(within, kT) * reached
    light = column.textbook_pressure(0.5 * (edges[1:] + edges[:-1]), kT, pull)
    return {
        "number_density_theory": density * scale.number_density,
        "air_density_theory": density * scale.mass_density,
        "layer_pressure_theory": pressure * scale.pressure,
        "layer_temperature_theory": np.full(len(thick), kT * scale.temperature),
        "layer_temperature_standard": np.asarray(law.isa_temperature(np.minimum(dataset.height.values, 80_000.0))),
        "number_density_barometric": light / kT * scale.number_density,
        "layer_pressure_barometric": light * scale.pressure,
    }


def _energy(late: "xr.Dataset") -> np.ndarray:
    """Return the energy of the column in each frame [J]."""
    stores = late.kinetic_energy, late.rotational_energy, late.potential_energy
    return np.asarray(sum(store.values for store in stores))


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return pressure, temperature and scale height of the air."""
    column = Column(settings, used(dataset))
    settled = _settled(column, settings)
    late = dataset.isel(elapsed_time=slice(settled, None))
    if late.sizes["elapsed_time"] < LEAST:
        return ()
    kT = column.equilibrium_kT(dataset, settings)
    force = late.wall_pressure.values
    weight = force[:, 4] - force[:, 5]
    expected = column.per_area * column.scale.pressure
    # floor minus ceiling differ from the weight by the change of momentum, whose variance is N m kT at either end
    lasted = float(np.diff(dataset.elapsed_time_bnds.values[[settled, -1], [0, 1]])[0]) / column.scale.time
    chance = math.sqrt(2.0 * column.per_area * kT) / lasted
    label = "surface pressure minus pressure at the top"
    of_weight = float(weight.mean()), chance * column.scale.pressure, expected, 0.0, CHANCE_ALONE
    weight_headline = Headline("weight_of_the_air", *of_weight, "Pa", "hPa", label)
    energy = _energy(late)
    memory = column.memory * FRAMES / settings.duration
    temperature = average_beside(late.air_temperature.values, energy, memory)
    # the floor carries the weight and what presses on the ceiling
    above = average_beside(force[:, 5], energy, memory)
    thin = column.density(np.array([column.top - 1e-3, column.top]), kT, column.room)
    ceiling = float(column.pressure(thin, kT)[0]) * column.scale.pressure
    fallen = column.on_the_floor(kT)
    length, mean = column.scale.length, column.mean_height(kT)
    mean, ceiling = mean - fallen * (mean - column.bottom), ceiling * (1.0 - fallen)
    per_metre = settings.molecules * column.scale.weight * DRY_AIR.molecule_mass * settings.gravity
    climbed = average_beside(late.potential_energy.values / per_metre / length, energy, memory)
    high, error = float(climbed.mean), float(climbed.standard_error)
    found, near = column.scale_height_of(high), column.scale_height_of(high + 1e-4)
    # the layer on the floor is as thick as a molecule, in which gravity changes it a little
    unknown = fallen * column.room
    reason = "hard molecules crowd on the floor"
    steep = (column.scale_height_of(mean + 1e-4) - column.scale_height_of(mean)) / 1e-4
    expands, answer = (near - found) / 1e-4, column.scale_height_of(mean) * length
    of_scale = found * length, expands * error * length, answer, steep * unknown * mean * length, reason
    scale_height = Headline("scale_height", *of_scale, "m", "km", "scale height")
    # a column that is far lower than a scale height is too even to tell it
    told = scale_height.standard_error <= 0.1 * answer
    pressed = math.hypot(weight_headline.standard_error, float(above.standard_error))
    of_floor = float(force[:, 4].mean()), pressed, expected + ceiling, unknown * ceiling, reason
    warm, few = kT * column.scale.temperature, 2.0 / (column.dimensions * settings.molecules) * settings.temperature
    label, finite = "temperature of the column", "the number of molecules is finite"
    of_height = high * length, error * length, mean * length, unknown * mean * length, reason
    return (
        Headline("mean_surface_pressure", *of_floor, "Pa", "hPa", "surface pressure"),
        weight_headline,
        Headline.of_mean("mean_temperature", label, temperature, warm, "K", tolerance=few, reason=finite),
        *([scale_height] if told else []),
        Headline("mean_height", *of_height, "m", "km", "mean height of the molecules"),
    )


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return pressure and temperature against height."""

    def measured(name: str, theory: str) -> tuple[Line, Line]:
        molecules = Line(name, "height", "molecules", error=f"{name}_se")
        return molecules, Line(f"{name}_theory", "height", theory, "theory")

    real = Line("layer_temperature_standard", "height", "standard atmosphere", "environment")
    scale = 1e-3 * BOLTZMANN * settings.si.temperature / (DRY_AIR.molecule_mass * settings.si.gravity)
    held = -math.expm1(-settings.height / scale)  # the share of an endless column that is below the ceiling
    below = ((share, -scale * math.log1p(-share * held)) for share in (0.5, 0.75, 0.9))
    guides = tuple(("y", height, f"{100.0 * share:.0f} % below {height:.1f} km") for share, height in below)
    thins = measured("layer_pressure", "barometric law")
    warm = measured("layer_temperature", "isothermal")
    numbers, title = ("scale_height", "mean_surface_pressure"), "At rest it is as warm above as below"
    note = "Marked: how much of the air in the box is below."
    return (
        over_height("The air thins with height", thins, "pressure", "hPa", *numbers, guides=guides, note=note),
        over_height(title, (*warm, real), "temperature", "K", "mean_temperature"),
    )

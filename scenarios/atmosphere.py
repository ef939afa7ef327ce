"""Why the air does not fly away, and why it thins with height.

Three thousand molecules in a tall column with real gravity. At the start they are as dense at 20 km as at the
floor. They fall, and within some minutes density and pressure decrease with height by the barometric law, by a factor
e every 8.4 km; the means leave these minutes out. Each molecule falls freely between collisions, and yet the column
neither lies down on the floor nor leaves. The molecules hit the floor, and the force on the floor minus that on the
ceiling is the weight of the air.

The temperature comes out the same at all heights, because nothing stirs or heats the air. A
molecule that rises loses speed, but only fast ones get high, and both effects cancel. A real atmosphere is heated
from below and stirred, and therefore cools with height; left alone for long enough it would become isothermal like
this one. The figure shows both.

Modelled: hard spheres in uniform gravity, exact parabolas, periodic sides, a floor that is a heat bath or
smooth, a smooth ceiling. Left out: rotation (it changes no profile at rest), water, wind, sunshine. Each
molecule stands for some 10^34 real ones and is a hundred metres wide or more, so that it meets others within a
stated share of the scale height (the Knudsen number). Beside the textbook's barometric law stands what it becomes for
molecules so wide: they exclude volume from each other, and no centre comes nearer to floor or ceiling than its radius,
so that a part of the lowest and of the highest layer is empty. With ``plane`` the air is discs in a plane, and a slab
one scale height thick stands for the third dimension.
"""

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import HeatBath, Periodic, RandomNumbers, Specular, maxwell_velocities
from atmosbox.scene import (
    Air,
    EngineChoice,
    Headline,
    Layers,
    Line,
    Panel,
    Scale,
    SceneSettings,
    Series,
    Setup,
    setting,
)
from atmosbox.scene.engines import EXACT, used
from atmosbox.scene.knob import gravity, wall_temperature
from atmosbox.scene.rounding import rounded
from atmosbox.scene.statistics import average_beside
from atmosbox.theory.constants import BOLTZMANN, DRY_AIR

if TYPE_CHECKING:
    import xarray as xr

title = "A column of atmosphere"
FRAMES = 240
SETTLE = 40
"""Frames left out of the means at least; after a start out of equilibrium more, see `Column.settling`."""
LEAST = 40
"""Fewer settled frames than that give no headline."""
LAYERS = 25
FILLED = 3.0
"""How many scale heights of the column hold molecules at a uniform start."""
JUMP = 0.563
"""Jump of temperature at a wall, 2.127 mean free paths (Sone 2007), over that of a gas whose molecules never meet."""

ladder = (
    Series("exact", "duration", (50, 100, 200, 400)),
    Series("stepped", "delta", (1.6, 0.8, 0.4, 0.2), {"duration": 50}),
    Series("dsmc", "duration", (50, 100, 200, 400)),
    Series("dsmc", "molecules", (3000, 10000, 30000), {"duration": 100}),
    Series("exact", "duration", (50, 100), {"plane": True, "knudsen": 0.05}),
    Series("classic", "delta", (8, 4, 2), {"plane": True, "knudsen": 0.05, "duration": 50}),
)
"""What is worth comparing: a column at rest is hardly sensitive to errors, except to a fall that makes energy."""


class Settings(SceneSettings):
    """What a user may set."""

    molecules: int = setting(3000, "1", "number of molecules", low=50, high=1_000_000)
    temperature: float = setting(
        288.15, "K", "temperature of the floor, and of the air at the start", low=10.0, high=2000.0
    )
    surface_pressure: float = setting(1013.25, "hPa", "pressure at the floor", low=1.0, high=1e5)
    gravity: float = setting(9.80665, "m s-2", "acceleration of gravity", low=0.1, high=100.0)
    height: float = setting(25.0, "km", "height of the ceiling", low=0.1, high=1000.0)
    knudsen: float = setting(0.3, "1", "mean free path at the floor in scale heights", low=0.02, high=10.0)
    floor: str = setting(
        "heat-bath",
        "",
        "what the floor is: warm, or smooth so that no heat passes",
        choices=("heat-bath", "isolated"),
    )
    start: str = setting(
        "uniform",
        "",
        "where the molecules start: spread evenly, in the profile of equilibrium, or near the floor",
        choices=("uniform", "equilibrium", "bottom"),
    )
    plane: bool = setting(False, "", "whether the air is a plane of discs")
    duration: float = setting(
        400.0, "1", "how long to watch, in times that sound takes to climb a scale height", low=1.0, high=1e5
    )


class Column:
    """The column in reduced units: length in scale heights, energy in kT, mass of a molecule.

    A column in the plane stands for a slab of unit thickness, so that molecules per area are as many per volume.
    With an engine whose molecules have no volume, it has no excess pressure.
    """

    def __init__(self, settings: Settings, engine: EngineChoice = EXACT) -> None:
        si = settings.si
        self.energy = BOLTZMANN * si.temperature
        self.scale_height = self.energy / (DRY_AIR.molecule_mass * si.gravity)
        self.height = si.height / self.scale_height
        self.width = 1.0
        self.dimensions = 2 if settings.plane else 3
        n = settings.molecules
        held = -math.expm1(-min(self.height, 700.0))
        self.per_area = n / self.width ** (self.dimensions - 1)
        density = n / (self.width ** (self.dimensions - 1) * held)
        if settings.plane:
            # mean free path of a thin gas of discs: Gass, D. M. (1971), J. Chem. Phys. 54, 1898
            self.diameter = 1.0 / (2.0 * math.sqrt(2.0) * density * settings.knudsen)
        else:
            self.diameter = math.sqrt(1.0 / (math.sqrt(2.0) * math.pi * density * settings.knudsen))
        self.diameter = rounded(self.diameter)
        self.room = 0.0 if engine.ideal else self.diameter
        # the floor carries what lies above it; what the ceiling pushes back is small
        floor = self.per_area * (1.0 + math.exp(-min(self.height, 700.0)) / held)
        weight = si.surface_pressure / (self.energy * floor / self.scale_height**3)
        self.scale = Scale(self.scale_height, DRY_AIR.molecule_mass, self.energy, weight)
        self.bottom = 0.5 * self.diameter
        self.top = self.height - self.bottom

    @property
    def memory(self) -> float:
        r"""How long a surplus of energy stays in the column until it has left by the floor [reduced time].

        A column of a surplus :math:`c\,\Delta T` per molecule must conduct it to the floor, and the molecules that hit
        the floor must take it along, :math:`(d + 1) k / 2` each,

        .. math:: \tau = \frac{0.563\,c N}{(d + 1) k J / 2} + \frac{c N}{\kappa} \int s(z)^2 dz

        for the flux :math:`J = n_0 \sqrt{kT / 2 \pi m}`, the share s(z) above z, and the conductivity of a
        thin gas by Chapman and Enskog, :math:`1.025\,(75/64)\,(k/\sigma^2) \sqrt{kT / \pi m}`, of discs
        :math:`1.029 \cdot 2\,(k/\sigma) \sqrt{kT / \pi m}` (Gass 1971, doi:10.1063/1.1675116).
        Half of the molecules at the floor come from it and are as warm: so the gas there is nearer to the temperature
        of the floor than the molecules that hit it. Its jump is that along 2.127 mean free paths (Sone 2007), 0.563 of
        what the hits alone would make it, and taken for discs, too.
        """
        a, d = min(self.height, 700.0), self.dimensions
        held = -math.expm1(-a)
        capacity = 0.5 * d + 1.0 - a * a * math.exp(-a) / held**2
        leaves = JUMP * capacity * held / ((d + 1.0) / 2.0 / math.sqrt(2.0 * math.pi))
        thin = 1.025 * 75.0 / 64.0 / self.diameter**2 if d == 3 else 1.029 * 2.0 / self.diameter
        above = 0.5 - 2.0 * math.exp(-a) + (a + 1.5) * math.exp(-2.0 * a)
        conducted = capacity * self.per_area * above / held**2 / (thin / math.sqrt(math.pi))
        total: float = leaves + conducted
        return total

    def settling(self, settings: Settings) -> float:
        r"""Return how long after an uneven start the column has forgotten it [reduced time].

        The surplus of energy must leave by the floor, or, if that is isolated, find its way to all heights: measured
        for Knudsen numbers of 0.02 to 5, that takes some 4 Kn times as long as sound needs for a scale height. Of a
        surplus of a third of the energy less than a tenth of the scatter of a single sample is left after
        :math:`(2 + \tfrac12 \ln N)\,\tau`.
        """
        memory = self.memory + (4.0 * settings.knudsen if settings.floor == "isolated" else 0.0)
        return memory * (2.0 + 0.5 * math.log(settings.molecules))

    def density(self, edges: np.ndarray, kT: float, diameter: float, gravity: float = 1.0) -> np.ndarray:
        """Return the mean number density of layers in equilibrium [1/scale height^3]."""
        column = self.per_area, self.bottom, self.top, kT, 1.0, gravity, diameter
        return np.asarray(law.hydrostatic_layers(edges, *column, dimensions=self.dimensions))

    def equilibrium_kT(self, dataset: "xr.Dataset", settings: Settings) -> float:
        """Return the temperature of equilibrium: that of the floor, or the one that the energy allows."""
        if settings.floor == "heat-bath":
            return float(dataset.wall_temperature.values[-1, 4]) / self.scale.temperature
        energy = float(dataset.kinetic_energy.values[0] + dataset.potential_energy.values[0])
        each = energy / self.scale.total_energy / settings.molecules
        column = self.per_area, self.bottom, self.top, self.room
        return law.column_temperature(each, *column, dimensions=self.dimensions)

    def textbook_pressure(self, height: np.ndarray, kT: float, gravity: float = 1.0) -> np.ndarray:
        r"""Return the pressure of the textbook, :math:`p_0 e^{-m g z / kT}` [kT/scale height^3].

        Its :math:`p_0` is that of as many points between floor and ceiling.
        """
        floor = self.per_area / self.height * kT * float(law.column_floor_ratio(self.height, kT, 1.0, gravity))
        return np.asarray(law.barometric_pressure(height, floor, kT, 1.0, gravity))

    def mean_height(self, kT: float) -> float:
        """Return the mean height of the centres in equilibrium [scale height]."""
        column = self.per_area, self.bottom, self.top, kT, 1.0, 1.0, self.room
        return law.hydrostatic_mean_height(*column, dimensions=self.dimensions)

    def pressure(self, density: np.ndarray, kT: float) -> np.ndarray:
        """Return the pressure of a gas of these molecules [kT/scale height^3]."""
        pressure = law.gas_pressure_discs if self.dimensions == 2 else law.gas_pressure
        return np.asarray(pressure(density, kT, self.room))


def _settled(column: Column, settings: Settings) -> int:
    """Return how many frames pass until equilibrium."""
    if settings.start == "equilibrium":
        return SETTLE
    return min(max(math.ceil(column.settling(settings) / settings.duration * FRAMES), SETTLE), FRAMES - 1)


def build(settings: Settings, engine: EngineChoice = EXACT) -> Setup:
    """Return the column."""
    column = Column(settings, engine)
    n = settings.molecules
    plane = settings.plane
    rng = RandomNumbers(settings.seed)
    length = (column.width, 2.0 * column.diameter if plane else column.width, column.height)
    diameter = np.full(n, column.diameter)
    sides = (True, True, False)
    if settings.start == "equilibrium":
        position = engine.scatter(length, diameter, rng, periodic=sides, planar=plane, scale_height=1.0)
    else:
        filled = min(FILLED if settings.start == "uniform" else 0.1, column.height)
        position = engine.scatter(length, diameter, rng, periodic=sides, planar=plane, top=filled)
    parcel = engine.make(
        position,
        maxwell_velocities(1.0, np.ones(n), rng, planar=plane, exact=True),
        length=length,
        walls=(Periodic(),) * 4 + (HeatBath(1.0) if settings.floor == "heat-bath" else Specular(), Specular()),
        diameter=column.diameter,
        gravity=1.0,
        planar=plane,
        layers=LAYERS,
        seed=settings.seed,
    )
    scale = column.scale
    settled = _settled(column, settings)
    km = column.width * scale.length / 1000.0
    box = f"{km:.2f} km wide, periodic, {settings.height:g} km high"
    width = f"{'discs' if plane else 'molecules'} {column.diameter * scale.length:.{1 if plane else 0}f} m wide"
    return Setup(
        parcel,
        scale,
        settings.duration,
        FRAMES,
        (Air("floor"), Layers(LAYERS, column.memory)),
        samples=8,
        settle=settled,
        time_unit="s",
        facts={
            "box": f"a plane {box}, for a slab {scale.length / 1000.0:.2f} km thick" if plane else box,
            "weight of a molecule": f"{scale.weight:.2g} real molecules",
            "exaggeration": f"{width}, without excluded volume" if engine.ideal else width,
            "gamma": "2: the discs move in a plane and do not rotate" if plane else "5/3: the molecules do not rotate",
            "scale height": f"{scale.length / 1000.0:.2f} km",
            "Knudsen number": f"{settings.knudsen:g}, mean free path at the floor in scale heights",
            "time": f"{settings.duration * scale.time / 60.0:.0f} minutes, of which the first "
            f"{settled * settings.duration / FRAMES * scale.time / 60.0:.0f} are left out of the means",
            "noise": f"the thermometer of a layer of {n // LAYERS} molecules scatters by "
            f"{settings.temperature * math.sqrt(2.0 * LAYERS / (column.dimensions * n)):.0f} K in each sample",
        },
        knobs=(
            wall_temperature(parcel, scale, settings, low=100.0, high=600.0),
            gravity(parcel, scale, settings, low=0.0, high=30.0),
        )
        if settings.floor == "heat-bath"
        else (),
    )


def theory(dataset: "xr.Dataset", settings: Settings) -> dict[str, np.ndarray]:
    """Return the textbook's barometric law, and what it becomes between walls and with molecules of some size."""
    column = Column(settings, used(dataset))
    scale = column.scale
    kT = column.equilibrium_kT(dataset, settings)
    edges = np.append(dataset.height_bnds.values[:, 0], dataset.height_bnds.values[-1, 1]) / scale.length
    thick = np.diff(edges)
    # no centre comes nearer to floor or ceiling than its radius: of the lowest and the highest layer a part is empty
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


def headlines(dataset: "xr.Dataset", settings: Settings) -> tuple[Headline, ...]:
    """Return the weight of the air, its temperature, and how fast it thins."""
    column = Column(settings, used(dataset))
    settled = _settled(column, settings)
    late = dataset.isel(elapsed_time=slice(settled, None))
    if late.sizes["elapsed_time"] < LEAST:
        return ()
    kT = column.equilibrium_kT(dataset, settings)
    force = late.wall_pressure.values
    weight = force[:, 4] - force[:, 5]
    expected = column.per_area * column.scale.pressure
    # what floor minus ceiling give beyond the weight is the change of momentum: its variance is N m kT at either end
    lasted = float(np.diff(dataset.elapsed_time_bnds.values[[settled, -1], [0, 1]])[0]) / column.scale.time
    chance = math.sqrt(2.0 * column.per_area * kT / column.width ** (column.dimensions - 1)) / lasted
    energy = late.kinetic_energy.values + late.potential_energy.values
    memory = column.memory * FRAMES / settings.duration
    temperature = average_beside(late.air_temperature.values, energy, memory)
    height = column.mean_height(kT) * column.scale.length
    per_metre = settings.molecules * column.scale.weight * DRY_AIR.molecule_mass * settings.gravity
    climbed = average_beside(late.potential_energy.values / per_metre, energy, memory)
    return (
        Headline(
            "weight_of_the_air",
            float(weight.mean()),
            chance * column.scale.pressure,
            expected,
            0.0,
            "none: the model has no other error than chance",
            "Pa",
            "hPa",
            "weight of the air, floor minus ceiling",
        ),
        Headline(
            "mean_temperature",
            float(temperature.mean),
            float(temperature.standard_error),
            kT * column.scale.temperature,
            2.0 / (column.dimensions * settings.molecules) * settings.temperature,
            "a finite number of molecules",
            "K",
            "K",
            "temperature of the column",
        ),
        Headline(
            "mean_height",
            float(climbed.mean),
            float(climbed.standard_error),
            height,
            0.001 * height,
            "the theory takes the gas to be locally uniform",
            "m",
            "km",
            "mean height of the molecules",
        ),
    )


def panels(settings: Settings) -> tuple[Panel, ...]:
    """Return density, pressure and temperature against height."""

    def against_height(
        title: str, name: str, theory: str, other: Line, label: str, unit: str, scale: str, headline: str
    ) -> Panel:
        measured = Line(name, "height", "molecules", error=f"{name}_se")
        lines = measured, Line(f"{name}_theory", "height", theory, "theory"), other
        return Panel(
            "profile",
            title,
            lines,
            x_label=label,
            x_unit=unit,
            x_scale=scale,
            y_label="height",
            y_unit="km",
            headlines=(headline,),
        )

    smooth, barometric = "with walls and size", "barometric law"
    thin = Line("number_density_barometric", "height", barometric, "reference")
    light = Line("layer_pressure_barometric", "height", barometric, "reference")
    stirred = Line("layer_temperature_standard", "height", "standard atmosphere, stirred", "environment")
    return (
        against_height(
            "Density falls with height", "number_density", smooth, thin, "number density", "", "log", "mean_height"
        ),
        against_height(
            "Pressure falls with height", "layer_pressure", smooth, light, "pressure", "hPa", "log", "weight_of_the_air"
        ),
        against_height(
            "At rest it is isothermal", "layer_temperature", "isothermal", stirred, "temperature", "K", "linear",
            "mean_temperature",
        ),
    )  # fmt: skip

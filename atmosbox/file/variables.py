"""Every variable that a run can put into its file, declared once, and how a variable is declared and stored.

All values are in SI units. A *ledger* variable is part of the state (energies, counts, positions), so a value
that is not finite means that the run is broken. Any other variable may be NaN where there was nothing to measure, for
example in a layer that no molecule visited.

A name that ends in ``_se``, ``_count``, ``_theory`` or ``_tolerance`` needs no entry of its own: `variable` derives it
from its parent, as the standard error, the number of samples, the answer of theory or the known error of the model.

Only one variable has a given CF standard name, so that a program that looks for ``air_temperature`` by that name
finds one variable: the value measured in the whole box. Variables of a part of the box, of its environment or of
theory have only a ``long_name`` that says so.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import xarray as xr

CHUNK_FRAMES = 100  # largest number of frames in a block of data that is compressed as one
CHUNK_VALUES = 1_000_000  # largest number of values in a block


@dataclass(frozen=True)
class Variable:
    """The declaration of one variable of a file.

    Parameters
    ----------
    name, dims, long_name
        Its name in the file, the names of its dimensions, and what it is in words.
    units
        Its SI unit as UDUNITS writes it; empty for labels and flags, which have none.
    standard_name
        Its name in the CF standard name table, if the table has one and no other variable here uses it.
    cell_methods
        How a value represents its cell, for example ``elapsed_time: mean``.
    dtype
        numpy's code of the type in the file: ``f8``, ``f4``, ``i8``, ``i1``, or ``U`` for labels.
    ledger
        Whether the variable is part of the state of the run, so that all its values must be finite.
    difference
        Whether a temperature is a difference of two temperatures, and not a temperature on the scale.
    axis, positive
        CF's attributes of a vertical coordinate.
    coordinate
        Whether the variable is an auxiliary coordinate, such as the pressure of the parcel: other variables can be
        drawn against it.
    comment, flags
        What else a reader must know; the meanings of the values 0, 1, 2, ... of a flag.

    The file says that a pressure is the mean over its frame:

    >>> pressure = Variable("air_pressure", ("elapsed_time",), "Pa", "pressure", cell_methods="elapsed_time: mean")
    >>> pressure.attributes()["cell_methods"]
    'elapsed_time: mean'
    """

    name: str
    dims: tuple[str, ...]
    units: str
    long_name: str
    standard_name: str | None = None
    cell_methods: str | None = None
    dtype: str = "f8"
    ledger: bool = False
    difference: bool = False
    axis: str | None = None
    positive: str | None = None
    coordinate: bool = False
    comment: str | None = None
    flags: tuple[str, ...] = ()

    @property
    def units_metadata(self) -> str | None:
        """The CF attribute of a temperature: whether it is on the scale or a difference, as in every lapse rate."""
        parts = self.units.split()
        if not any(part.startswith("K") and not part[1:].strip("-0123456789") for part in parts):
            return None
        return f"temperature: {'difference' if self.difference or len(parts) > 1 else 'on_scale'}"

    def attributes(self) -> dict[str, Any]:
        """Return the netCDF attributes that are set."""
        known = {
            "standard_name": self.standard_name,
            "long_name": self.long_name,
            "units": self.units or None,
            "units_metadata": self.units_metadata,
            "cell_methods": self.cell_methods,
            "axis": self.axis,
            "positive": self.positive,
            "comment": self.comment,
            "flag_values": np.arange(len(self.flags), dtype=self.dtype) if self.flags else None,
            "flag_meanings": " ".join(self.flags) or None,
        }
        return {name: value for name, value in known.items() if value is not None}

    def encoding(self, shape: tuple[int, ...]) -> dict[str, Any]:
        """Return how xarray stores an array of this shape: its type, fill value, chunks and compression."""
        if self.dtype == "U":
            return {"dtype": "S1", "_FillValue": None}
        missing = np.array(np.nan, self.dtype)[()] if self.dtype[0] == "f" and not self.ledger else None
        stored: dict[str, Any] = {"dtype": self.dtype, "_FillValue": missing}
        if self.dims[:2] == ("elapsed_time", "molecule"):
            frames = max(1, min(CHUNK_FRAMES, shape[0]))
            components = math.prod(shape[2:])
            molecules = max(1, min(shape[1], CHUNK_VALUES // (frames * components)))
            chunks = (frames, molecules, *shape[2:])
            stored |= {"zlib": True, "complevel": 4, "shuffle": True, "chunksizes": chunks}
        return stored

    def holding(self, values: npt.ArrayLike) -> xr.Variable:
        """Return values as a variable of a dataset, with these attributes and this encoding."""
        import xarray as xr

        return xr.Variable(self.dims, values, self.attributes(), self.encoding(np.shape(values)))


SUFFIXES = ("_se", "_count", "_theory", "_tolerance")
"""Endings of the names of variables that are derived from another variable."""


def derived(parent: Variable, suffix: str) -> Variable:
    """Return the declaration of a variable's standard error, number of samples, answer of theory or tolerance.

    >>> pressure = Variable("air_pressure", ("elapsed_time",), "Pa", "pressure of the air on the walls")
    >>> derived(pressure, "_theory").long_name
    'answer of theory for the pressure of the air on the walls'
    """
    name, words = parent.name + suffix, parent.long_name
    plain = replace(parent, name=name, cell_methods=None, ledger=False, comment=None, dtype="f8", coordinate=False)
    if suffix == "_theory":
        return replace(plain, long_name=f"answer of theory for the {words}", standard_name=None)
    plain = replace(plain, positive=None, difference=True)
    if suffix == "_tolerance":
        return replace(plain, long_name=f"known error of the model for the {words}", standard_name=None)
    if suffix == "_count":
        words = f"number of samples of the {words}"
        return replace(plain, long_name=words, standard_name="number_of_observations", units="1")
    standard = parent.standard_name and f"{parent.standard_name} standard_error"
    return replace(plain, long_name=f"standard error of the {words}", standard_name=standard)


_TABLE = """
# Coordinates
elapsed_time | s | time: ledger | time since the start of the run
height | m | height: ledger axis=Z positive=up standard | height of the middle of the layer
speed | m s-1 | speed: ledger | speed of a molecule, middle of the bin
energy | J | energy: ledger | energy of a water molecule, counted from one at rest in the liquid, middle of the bin
distance | m | distance: ledger | distance from the left wall, middle of the bin
radius | m | radius: ledger | radius of a drop
mode | 1 | mode: ledger | number of half waves across the box
wall | | wall: dtype=U | wall of the box
axis | | axis: dtype=U | direction in space, z upwards
molecule | 1 | molecule: dtype=i8 | number of the molecule
# Every run, frame by frame
air_temperature | K | time: mean standard | temperature of the air in the box
air_pressure | Pa | time: mean standard | pressure of the air on the walls
mean_molecular_speed | m s-1 | time: mean | mean speed of the molecules
kinetic_energy | J | time: point ledger | kinetic energy of the molecules
rotational_energy | J | time: point ledger | rotational energy of the molecules
potential_energy | J | time: point ledger | potential energy of the molecules, from gravity and attraction
numerical_heat | J | time: point ledger | energy added by the error of an approximate engine
ledger_residual | 1 | time: point ledger | residual of the energy budget, as a share of the largest energy in it
collision_count | 1 | time: point sum dtype=i8 | number of collisions between molecules
wall_hit_count | 1 | time: point sum dtype=i8 | number of hits of molecules on walls
work_by_piston | J | time: point sum ledger | work done on the molecules by the piston
work_by_gravity | J | time: point sum ledger | energy given to the molecules by changes of gravity
gravity | m s-2 | time: point | acceleration of gravity, if it was changed during the run
pool_open_share | 1 | time: point | share of the pool that is open, if it was changed during the run
heat_from_wall | J | time wall: point sum ledger | heat given to the molecules by the wall
wall_pressure | Pa | time wall: mean | pressure of the air on the wall
air_temperature_noise | K | time: difference | expected scatter of the temperature of so few molecules
wall_temperature | K | time wall: point | temperature of the wall
# Molecules that attract each other
largest_drop_molecule_count | 1 | time: point dtype=i8 | number of molecules in the largest drop
well_count | 1 | time: point dtype=i8 | number of pairs of molecules near enough to attract each other
attraction_energy | J | time: point ledger | potential energy of all molecules from attraction
molecular_energy | J | time: point ledger | kinetic and potential energy of all molecules
heat_from_bath | J | time: point sum ledger | heat given to the molecules by the thermostat
work_by_attraction | J | time: point sum ledger | energy given to the molecules by changes of the attraction
virial_pressure | Pa | time: mean | pressure from the motion of molecules and the forces between them
normal_pressure | Pa | time: mean | pressure perpendicular to the surface of the liquid
surface_tension | N m-1 | time: mean | surface tension of the liquid
liquid_number_density | m-3 | time: mean | number of molecules in a cubic metre of liquid
vapor_number_density | m-3 | time: mean | number of molecules in a cubic metre of vapour
liquid_well_energy | J | time: mean | energy of attraction per molecule in the liquid
vapor_well_energy | J | time: mean | energy of attraction per molecule in the vapour
# A parcel that is lifted
parcel_temperature | K | time: point | temperature of the parcel
parcel_potential_temperature | K | time: point standard=air_potential_temperature | potential \
temperature of the parcel, reduced to 1000 hPa
parcel_pressure | Pa | time: ledger coordinate positive=down | pressure of the parcel
parcel_height | m | time: ledger coordinate positive=up | height of the parcel above the ground
environment_temperature | K | time | temperature of the environment
environment_dew_point_temperature | K | time: standard=dew_point_temperature | dewpoint of the environment
environment_virtual_temperature | K | time | virtual temperature of the environment
parcel_virtual_temperature | K | time: standard=virtual_temperature | virtual temperature of the parcel, without \
the weight of its droplets
parcel_density_temperature | K | time | temperature of dry air as dense as the parcel with its droplets
parcel_buoyancy | m s-2 | time | buoyancy of the parcel, with the weight of its droplets
environment_pressure | Pa | time | pressure of the environment
adiabat_temperature | K | time | temperature of the adiabat at the pressure of the parcel
dry_air_adiabat_temperature | K | time | temperature of the adiabat of dry air at the pressure of the parcel
parcel_volume | m3 | time: point ledger | volume of the parcel
piston_height | m | time: point ledger | distance of the piston from the floor of the box
piston_velocity | m s-1 | time: point ledger | velocity of the piston, positive outwards
# Water
water_vapor_partial_pressure | Pa | time: mean standard=water_vapor_partial_pressure_in_air | vapour pressure
saturation_vapor_pressure | Pa | time: mean | saturation vapour pressure at the temperature of the air, over water
relative_humidity | 1 | time: mean standard | relative humidity
humidity_mixing_ratio | kg kg-1 | time: mean standard | mass of vapour per mass of dry air
cloud_liquid_water_mixing_ratio | kg kg-1 | time: mean standard | mass of liquid water per mass of dry air
largest_haze_mixing_ratio | kg kg-1 | time: mean | mixing ratio of liquid water above which haze counts as cloud
rain_mixing_ratio | kg kg-1 | time: mean | mass of water that has rained out so far per mass of dry air
liquid_temperature | K | time: mean | temperature of the liquid water
drop_area | m2 | time: mean | total area at which molecules hit drops
condensation_rate | s-1 | time: mean | number of molecules that condense per time
evaporation_rate | s-1 | time: mean | number of molecules that evaporate per time
vapor_molecule_count | 1 | time: point dtype=i8 | number of molecules of vapour
liquid_molecule_count | 1 | time: point dtype=i8 | number of molecules in the liquid
rained_molecule_count | 1 | time: point dtype=i8 | number of molecules that have left as rain
drop_count | 1 | time: point dtype=i8 | number of drops
largest_drop_radius | m | time: point | radius of the largest drop
# Drops with and without salt
salted_drop_radius | m | time: point | mean radius of the drops with salt in them
pure_drop_radius | m | time: point | mean radius of the drops of pure water
saturation_ratio | 1 | time: mean | vapour pressure divided by that of saturation at the drops' temperature
drop_molecule_count | 1 | time drop: point dtype=i8 | number of molecules of water in the drop
salted_drop_humidity | 1 | radius | relative humidity over a drop with salt in it, by the law of Koehler
pure_drop_humidity | 1 | radius | relative humidity over a drop of pure water, by the law of Kelvin
condensed_energy | J | time: point ledger | energy of liquid and rain, and the binding energy of the vapour
gas_temperature | K | time: mean | temperature of air and vapour from their energy, rotation included
liquid_saturation_vapor_pressure | Pa | time: mean | saturation vapour pressure at the temperature of the liquid
# Molecules that leave the liquid and those that stay, by energy
leaving_energy_probability_density | J-1 | energy: mean | share of the molecules that evaporate per unit of energy
staying_energy_probability_density | J-1 | energy: mean | share of the molecules in the liquid per unit of energy
# A column of air, layer by layer
number_density | m-3 | height: mean | number of molecules in a cubic metre of the layer
air_density | kg m-3 | height: mean standard | density of the layer
layer_temperature | K | height: mean | temperature of the layer
layer_pressure | Pa | height: mean | pressure of the layer
number_density_barometric | m-3 | height: mean | number density by the barometric law
layer_pressure_barometric | Pa | height: mean | pressure by the barometric law
layer_temperature_standard | K | height: mean | temperature of the standard atmosphere
# Air that turns over
cell_temperature | K | time distance height: mean | temperature of the air in a cell
cell_number_density | m-3 | time distance height: mean | number of molecules in a cubic metre of a cell
cell_pressure | Pa | time distance height: mean | pressure of the air in a cell, from density, temperature and \
equation of state
horizontal_wind | m s-1 | time distance height: mean | wind from left to right
upward_wind | m s-1 | time distance height: mean standard=upward_air_velocity | upward wind
wind_speed | m s-1 | time: mean | speed of the wind without thermal noise: root of the mean square of the \
measured wind minus that of noise; where, by chance, this difference is negative, minus the root of its size
roll_speed | m s-1 | time: mean | root of the sum of the squared amplitudes of all rolls, without noise
core_lapse_rate | K m-1 | time: mean difference | lapse rate between three and seven tenths of the height
roll_amplitude | m s-1 | time mode: mean | amplitude of the upward wind of rolls
tracer_share_aloft | 1 | time: point | share of the molecules tagged near the floor that are in the upper half
layer_wind | m s-1 | height: mean | wind from left to right, in the middle half of the width
layer_temperature_conduction | K | height: mean | temperature of air at rest that conducts heat
layer_temperature_adiabatic | K | height: mean | temperature of the adiabat through the middle of the height
# Speeds, bin by bin
speed_probability_density | s m-1 | speed: mean | share of molecules per unit of speed
speed_probability_density_start | s m-1 | speed: mean | that of Maxwell's law for the temperature at the start
# Two gases that mix
mixing_amplitude | 1 | time: point | amplitude of the longest wave in the difference between the two gases, \
divided by that at the start
mixing_entropy | 1 | time: point | entropy of mixing per molecule, divided by that of fully mixed gases
left_gas_share_early | 1 | distance: mean | share of the gas from the left, after a tenth of the mixing time
left_gas_share_middle | 1 | distance: mean | share of the gas from the left, after half the mixing time
left_gas_share_late | 1 | distance: mean | share of the gas from the left, after twice the mixing time
gas | | molecule: dtype=i1 flags=left,right | which of two gases the molecule belongs to
# Discs that collide in a plane
kinetic_energy_light | J | time: point ledger | mean kinetic energy of a disc of the lighter half
kinetic_energy_heavy | J | time: point ledger | mean kinetic energy of a disc of the heavier half
running_energy_light | J | time: point ledger | kinetic energy of a disc of the lighter half, mean since the start
running_energy_heavy | J | time: point ledger | kinetic energy of a disc of the heavier half, mean since the start
energy_change | 1 | time: point ledger | relative change of the kinetic energy since the start, apart from heat
momentum_residual | 1 | time: point | residual of the momentum budget of discs and walls, as a share of the \
largest momentum possible
momentum | kg m s-1 | time axis: point ledger | total momentum of the discs
box_length | m | axis: ledger | length of the box along the axis
disc_position | m | time molecule axis: point ledger | position of the middle of the disc
disc_velocity | m s-1 | time molecule axis: point ledger | velocity of the disc
disc_mass | kg | molecule: ledger | mass of the disc
disc_diameter | m | molecule: ledger | diameter of the disc
# Molecules, on request; a molecule that condensed has no position
molecule_position | m | time molecule axis: point dtype=f4 | position of the molecule
molecule_velocity | m s-1 | time molecule axis: point dtype=f4 | velocity of the molecule
molecule_speed | m s-1 | time molecule: point dtype=f4 | speed of the molecule
molecule_neighbour_count | 1 | time molecule: point dtype=i1 | number of molecules near enough to attract the molecule
species | | molecule: dtype=i1 flags=dry_air,water | species of the molecule
molecule_mass | kg | molecule: ledger | mass of the molecule
molecule_diameter | m | molecule: ledger | diameter with which the molecule collides
# The box around the molecules, and the drops in it; a drop that has merged into another has no position
box_side | m | time axis: point ledger | length of the box along the axis at this time
wall_law | | wall: dtype=i1 flags=specular,periodic,heat_bath,piston,pool | what the wall does to a molecule \
that hits it
drop_position | m | time drop axis: point | position of the middle of the drop
drop_radius | m | time drop: point | radius of the drop
"""
"""A row is a name, its SI unit, its dimensions with the options of its declaration, and what it is in words.

``mean`` and ``point`` say how a value represents its cell, ``sum`` that it counts from the start of the run, and
``standard`` the name in the CF standard name table, if it is another than that of the variable.
"""

_NOT_CELLS = {"wall", "mode", "axis", "molecule", "drop"}
"""Dimensions along which a value does not stand for an interval."""


def _declared(row: str) -> Variable:
    """Return the variable that a row of the table declares."""
    name, units, stored, words = (part.strip() for part in row.split("|"))
    along, _, options = stored.replace("time", "elapsed_time", 1).partition(":")
    dims = tuple(along.split())
    common: dict[str, Any] = {}
    for option, _, value in (each.partition("=") for each in options.split()):
        if option in ("mean", "point"):
            cells = [dim for dim in dims if dim not in _NOT_CELLS]
            common["cell_methods"] = ": ".join([*cells, option])
        elif option == "sum":
            common["comment"] = "Summed since the start of the run."
        elif option == "flags":
            common["flags"] = tuple(value.split(","))
        elif option == "standard":
            common["standard_name"] = value or name
        else:
            common[option] = value or True
    return Variable(name, dims, units, words, **common)


VARIABLES: dict[str, Variable] = {
    made.name: made for made in map(_declared, (row for row in _TABLE.splitlines() if " | " in row))
}
"""Every variable of a file by its name."""


def variable(name: str, own: Mapping[str, Variable] = MappingProxyType({})) -> Variable:
    """Return the declaration of a variable, or of its standard error, number of samples, theory or tolerance.

    The error of a temperature is a difference of temperatures, so 1 K is not -272.15 degC:

    >>> error = variable("air_temperature_se")
    >>> error.standard_name, error.units_metadata
    ('air_temperature standard_error', 'temperature: difference')
    """
    found = known(name, own)
    if found is None:
        fix = f"declare it in the scene, variables = {{'{name}': (dimensions, unit, words)}}"
        raise KeyError(f"{name} is not a variable of atmosbox: {fix}")
    return found


def known(name: str, own: Mapping[str, Variable] = MappingProxyType({})) -> Variable | None:
    """Return the declaration of a variable as `variable` does; None if nothing of that name is declared."""
    declared = {**own, **VARIABLES}
    if name in declared:
        return declared[name]
    for suffix in SUFFIXES:
        parent = declared.get(name.removesuffix(suffix))
        if parent is not None and name.endswith(suffix):
            return derived(parent, suffix)
    return None

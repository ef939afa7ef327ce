"""The answers: what the textbook says, to lay beside what the box measures.

Every function is a closed form, or the solution of one equation, with its source. None of it is used to move
a molecule. Where an argument is called ``kT`` or ``diameter`` any consistent set of units will do, reduced or
SI; where it is called ``temperature`` or ``pressure`` of the air, the units are K and Pa.

=================== =====================================================================================
file                what it answers
=================== =====================================================================================
equation_of_state   how much harder do spheres press than points
entropy             what their crowding does to the free energy and to the adiabat
disc                the same in two dimensions
disc_collision      how often discs meet, and how far they fly between
collision           how often do molecules meet, and how far do they fly between
speed               how fast are they
wall                what hits a wall and what leaves it; the heat between two walls in a very thin gas
noise               how much does an honest measurement scatter
barometric          how does a gas thin out with height
column_temperature  how warm a column comes to rest that no heat enters
hydrostatic         the same for spheres and discs that take up room
lifting             what becomes of a parcel that is lifted, squeezed or held at its temperature
ascent              what its haste, and the room of its molecules, add to that
environment         the air around it: lapse rates, pressures and heights
standard_atmosphere the same of the International Standard Atmosphere
saturation          how much water vapour air can hold
humidity            how much it does hold, and how light that makes it
moist_lifting       where a lifted parcel forms its cloud, and what cloud and rain make of its way
rain                the same if the cloud rains at a finite rate
moist_adiabat       the adiabats of saturated air, and its entropy
cloud_base          where the cloud base of a measured ascent is
evaporation         where evaporation and condensation end
liquid              how fast molecules leave a liquid, large or small
vapor_number        how the number of those outside it scatters
leaving             which molecules of a liquid have the energy to leave it
isobaric            the same at constant pressure, and how warm it is then
buoyancy            whether a parcel rises by itself, and with what energy
=================== =====================================================================================
"""

from atmosbox.theory.barometric import (
    barometric_density,
    barometric_pressure,
    column_floor_ratio,
    column_heat_capacity,
    column_mean_height,
    column_top_ratio,
    column_weight,
    scale_height,
)
from atmosbox.theory.buoyancy import Convection, cape_cin, cape_standard_error, parcel_buoyancy
from atmosbox.theory.cloud_base import CloudBase, fitted_cloud_base
from atmosbox.theory.collision import (
    collision_rate,
    collision_rate_between,
    contact_share,
    contact_value_between,
    mean_free_path,
    mean_free_time,
)
from atmosbox.theory.column_temperature import column_temperature
from atmosbox.theory.disc import (
    FREEZING_PACKING_FRACTION_DISCS,
    compressibility_factor_discs,
    contact_value_discs,
    gas_pressure_discs,
    inverse_compressibility_discs,
    packing_fraction_discs,
)
from atmosbox.theory.disc_collision import collision_rate_discs, mean_free_path_discs
from atmosbox.theory.entropy import (
    excess_chemical_potential,
    excess_chemical_potential_discs,
    excess_free_energy,
    excess_free_energy_discs,
    hard_sphere_isentrope,
)
from atmosbox.theory.environment import (
    DRY_AIR_GAS_CONSTANT,
    environment_pressure,
    environment_temperature,
    height_of_pressure,
    hypsometric_thickness,
)
from atmosbox.theory.equation_of_state import (
    FREEZING_PACKING_FRACTION,
    compressibility_factor,
    contact_value,
    gas_pressure,
    inverse_compressibility,
    packing_fraction,
)
from atmosbox.theory.escape_energy import LEAVING_FREEDOM, leaving_energy_density, staying_energy_density
from atmosbox.theory.evaporation import (
    EvaporationEquilibrium,
    condensation_equilibrium,
    evaporation_equilibrium,
    wet_bulb_temperature,
)
from atmosbox.theory.finite_rate import DISSIPATION, FINITE_SPEED, Ascent
from atmosbox.theory.humidity import (
    WATER_MASS_RATIO,
    dewpoint_from_relative_humidity,
    mixing_ratio,
    relative_humidity_from_dewpoint,
    saturation_mixing_ratio,
    vapor_pressure,
    virtual_temperature,
)
from atmosbox.theory.hydrostatic import hydrostatic_column, hydrostatic_layers
from atmosbox.theory.isobaric import IsobaricWater, isobaric_water
from atmosbox.theory.lifting import (
    adiabatic_index,
    adiabatic_temperature,
    dry_adiabat_temperature,
    dry_lapse_rate,
    isothermal_work,
    piston_pressure_ratio,
)
from atmosbox.theory.liquid_rate import hertz_knudsen_flux, microcanonical_flux
from atmosbox.theory.maxwell import (
    constant_energy_kurtosis,
    constant_energy_speed_factor,
    maxwell_speed_cumulative,
    maxwell_speed_density,
    mean_speed,
    most_probable_speed,
    root_mean_square_speed,
)
from atmosbox.theory.moist_adiabat import moist_entropy, moist_lapse_rate, pseudoadiabat, reversible_adiabat
from atmosbox.theory.moist_lifting import ParcelPath, lcl, moist_air_poisson_exponent, parcel_path
from atmosbox.theory.noise import (
    collision_rate_noise,
    compressibility_noise,
    count_noise,
    heat_noise,
    temperature_noise,
    wall_pressure_noise,
)
from atmosbox.theory.rain import raining_path
from atmosbox.theory.saturation import (
    BINDING_TEMPERATURE,
    LIQUID_HEAT_CAPACITY,
    VAPOR_HEAT_CAPACITY,
    dewpoint,
    saturation_vapor_pressure,
    water_latent_heat_vaporization,
)
from atmosbox.theory.standard_atmosphere import isa_height, isa_pressure, isa_temperature
from atmosbox.theory.vapor_number import VaporNumber, isolated_vapor_number, isothermal_vapor_number
from atmosbox.theory.wall_law import (
    FreeMolecularSlab,
    emission_energy,
    emission_energy_variance,
    emission_normal_speed,
    free_molecular_slab,
    wall_flux,
)

__all__ = [
    "BINDING_TEMPERATURE",
    "DISSIPATION",
    "DRY_AIR_GAS_CONSTANT",
    "FINITE_SPEED",
    "FREEZING_PACKING_FRACTION",
    "FREEZING_PACKING_FRACTION_DISCS",
    "LEAVING_FREEDOM",
    "LIQUID_HEAT_CAPACITY",
    "VAPOR_HEAT_CAPACITY",
    "WATER_MASS_RATIO",
    "Ascent",
    "CloudBase",
    "Convection",
    "EvaporationEquilibrium",
    "FreeMolecularSlab",
    "IsobaricWater",
    "ParcelPath",
    "VaporNumber",
    "adiabatic_index",
    "adiabatic_temperature",
    "barometric_density",
    "barometric_pressure",
    "cape_cin",
    "cape_standard_error",
    "collision_rate",
    "collision_rate_between",
    "collision_rate_discs",
    "collision_rate_noise",
    "column_floor_ratio",
    "column_heat_capacity",
    "column_mean_height",
    "column_temperature",
    "column_top_ratio",
    "column_weight",
    "compressibility_factor",
    "compressibility_factor_discs",
    "compressibility_noise",
    "condensation_equilibrium",
    "constant_energy_kurtosis",
    "constant_energy_speed_factor",
    "contact_share",
    "contact_value",
    "contact_value_between",
    "contact_value_discs",
    "count_noise",
    "dewpoint",
    "dewpoint_from_relative_humidity",
    "dry_adiabat_temperature",
    "dry_lapse_rate",
    "emission_energy",
    "emission_energy_variance",
    "emission_normal_speed",
    "environment_pressure",
    "environment_temperature",
    "evaporation_equilibrium",
    "excess_chemical_potential",
    "excess_chemical_potential_discs",
    "excess_free_energy",
    "excess_free_energy_discs",
    "fitted_cloud_base",
    "free_molecular_slab",
    "gas_pressure",
    "gas_pressure_discs",
    "hard_sphere_isentrope",
    "heat_noise",
    "height_of_pressure",
    "hertz_knudsen_flux",
    "hydrostatic_column",
    "hydrostatic_layers",
    "hypsometric_thickness",
    "inverse_compressibility",
    "inverse_compressibility_discs",
    "isa_height",
    "isa_pressure",
    "isa_temperature",
    "isobaric_water",
    "isolated_vapor_number",
    "isothermal_vapor_number",
    "isothermal_work",
    "lcl",
    "leaving_energy_density",
    "maxwell_speed_cumulative",
    "maxwell_speed_density",
    "mean_free_path",
    "mean_free_path_discs",
    "mean_free_time",
    "mean_speed",
    "microcanonical_flux",
    "mixing_ratio",
    "moist_air_poisson_exponent",
    "moist_entropy",
    "moist_lapse_rate",
    "most_probable_speed",
    "packing_fraction",
    "packing_fraction_discs",
    "parcel_buoyancy",
    "parcel_path",
    "piston_pressure_ratio",
    "pseudoadiabat",
    "raining_path",
    "relative_humidity_from_dewpoint",
    "reversible_adiabat",
    "root_mean_square_speed",
    "saturation_mixing_ratio",
    "saturation_vapor_pressure",
    "scale_height",
    "staying_energy_density",
    "temperature_noise",
    "vapor_pressure",
    "virtual_temperature",
    "wall_flux",
    "wall_pressure_noise",
    "water_latent_heat_vaporization",
    "wet_bulb_temperature",
]

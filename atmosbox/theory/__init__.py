"""Theory: what the textbook says, to compare with what the box measures.

Every function is a closed form, or the solution of one equation, with its source. None of them is used to move a
molecule. Where an argument is called ``kT`` or ``diameter`` any consistent set of units will do, reduced or SI; where
it is called ``temperature`` or ``pressure`` of the air, the units are K and Pa.

=================== =====================================================================================
file                what it computes
=================== =====================================================================================
equation_of_state   by how much the pressure of hard spheres exceeds that of points
entropy             the effect of excluded volume on the free energy and on the adiabat
coexistence         the critical point, and the slope of ln p, from measured liquids and vapours
simple_fluid        argon, nitrogen and methane, and the square well that represents each
well_gas            pressure and energy of a gas whose molecules attract each other
disc                equation of state and collision rate of discs in two dimensions
collision           how often molecules collide, and how far they fly in between
maxwell             the speeds of molecules, and how much the temperature of a few of them scatters
diffusion           how two gases mix, how fast, and the entropy of mixing
unlike_gases        diffusion of unlike molecules, with the heat that they carry
wall_law            the energy of molecules that leave a wall; the heat between two walls in a very thin gas
barometric          how the density of a gas decreases with height
column_temperature  the temperature of an isolated column in equilibrium
hydrostatic         a column of spheres or discs with excluded volume
heated_below        air between a warm floor and a cold ceiling: at rest, the adiabat, the onset of motion
walled_gas          a gas in a cube with walls: its density at a pressure, how often its molecules collide
lifting             a parcel that is lifted, or compressed without heat
finite_rate         the finite-rate error of an ascent, and the effect of excluded volume on it
environment         the environment of a parcel: lapse rates, pressures and heights
standard_atmosphere temperature and pressure of the International Standard Atmosphere
saturation          vapour pressure at saturation, latent heat, dewpoint
iapws               the saturation vapour pressure of measured water, to compare with
humidity            how much water vapour is in the air, and how light that makes the air
moist_lifting       the cloud base of a lifted parcel, and its temperature with cloud and rain
rain                a lifted parcel whose cloud rains at a finite rate
cloud_base          the cloud base of a measured ascent
koehler             the vapour pressure over a drop, from its curvature and from the salt in it
evaporation         the equilibrium in which evaporation and condensation end
liquid_rate         the rate and energy of molecules that leave a liquid, large or small
vapor_number        fluctuations of the number of molecules of vapour at constant volume
isobaric            the same at constant pressure, and the temperature
buoyancy            whether a parcel rises by itself, and with what energy
=================== =====================================================================================
"""

from atmosbox.theory.barometric import (
    barometric_density,
    barometric_pressure,
    column_floor_ratio,
    column_mean_height,
    column_scale_height,
)
from atmosbox.theory.buoyancy import Convection, cape_cin, parcel_buoyancy
from atmosbox.theory.cloud_base import CloudBase, measured_cloud_base
from atmosbox.theory.coexistence import CriticalPoint, critical_point, slope_of_pressure
from atmosbox.theory.collision import (
    collision_rate,
    collision_rate_between,
    contact_share,
    contact_value_between,
    mean_free_path,
    mean_free_time,
)
from atmosbox.theory.column_temperature import column_temperature
from atmosbox.theory.diffusion import (
    diffusivity_error,
    mixed_share,
    mixed_share_scatter,
    mixing_decay_rate,
    mixing_entropy,
    mutual_diffusivity,
)
from atmosbox.theory.disc import (
    FREEZING_PACKING_FRACTION_DISCS,
    collision_rate_discs,
    compressibility_factor_discs,
    contact_value_discs,
    gas_pressure_discs,
    inverse_compressibility_discs,
    packing_fraction_discs,
)
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
)
from atmosbox.theory.equation_of_state import (
    FREEZING_PACKING_FRACTION,
    compressibility_factor,
    contact_value,
    gas_pressure,
    inverse_compressibility,
    packing_fraction,
)
from atmosbox.theory.evaporation import (
    EvaporationEquilibrium,
    evaporation_equilibrium,
    wet_bulb_temperature,
)
from atmosbox.theory.finite_rate import DISSIPATION, Ascent
from atmosbox.theory.heated_below import Gas, RestState, adiabatic_lapse_rate, growth_rates, rayleigh_number, rest_state
from atmosbox.theory.humidity import (
    WATER_MASS_RATIO,
    density_temperature,
    mixing_ratio,
    saturation_mixing_ratio,
    vapor_pressure,
    virtual_temperature,
)
from atmosbox.theory.hydrostatic import hydrostatic_layers, hydrostatic_mean_height
from atmosbox.theory.iapws import saturation_vapor_pressure_iapws
from atmosbox.theory.isobaric import IsobaricWater, isobaric_water
from atmosbox.theory.koehler import (
    SALT_VOLUME,
    WATER_VOLUME,
    CriticalDrop,
    critical_drop,
    drop_radius,
    humidity_over_drop,
    kelvin_radius,
    water_surface_tension,
)
from atmosbox.theory.lifting import (
    adiabatic_index,
    dry_adiabat_temperature,
    dry_lapse_rate,
)
from atmosbox.theory.liquid_rate import (
    LEAVING_FREEDOM,
    hertz_knudsen_flux,
    leaving_energy_density,
    microcanonical_flux,
    staying_energy_density,
)
from atmosbox.theory.maxwell import (
    maxwell_speed_cumulative,
    maxwell_speed_density,
    mean_speed,
    temperature_noise,
)
from atmosbox.theory.moist_lifting import ParcelPath, lcl, moist_air_poisson_exponent, parcel_path
from atmosbox.theory.rain import raining_path
from atmosbox.theory.saturation import (
    BINDING_TEMPERATURE,
    LIQUID_HEAT_CAPACITY,
    VAPOR_HEAT_CAPACITY,
    dewpoint,
    saturation_vapor_pressure,
)
from atmosbox.theory.simple_fluid import (
    SIMPLE_FLUIDS,
    WELL_CRITICAL_DENSITY,
    WELL_CRITICAL_TEMPERATURE,
    SimpleFluid,
    well_vapor_pressure,
)
from atmosbox.theory.standard_atmosphere import isa_pressure, isa_temperature
from atmosbox.theory.unlike_gases import diffusivity_factor, mixing_wave
from atmosbox.theory.vapor_number import VaporNumber, isolated_vapor_number, isothermal_vapor_number
from atmosbox.theory.wall_law import (
    FreeMolecularSlab,
    emission_energy,
    emission_normal_speed,
    free_molecular_slab,
)
from atmosbox.theory.walled_gas import WalledGas, walled_gas
from atmosbox.theory.well_gas import (
    square_well_compressibility,
    square_well_second_virial,
    square_well_third_virial,
)

__all__ = [
    "BINDING_TEMPERATURE",
    "DISSIPATION",
    "DRY_AIR_GAS_CONSTANT",
    "FREEZING_PACKING_FRACTION",
    "FREEZING_PACKING_FRACTION_DISCS",
    "LEAVING_FREEDOM",
    "LIQUID_HEAT_CAPACITY",
    "SALT_VOLUME",
    "SIMPLE_FLUIDS",
    "VAPOR_HEAT_CAPACITY",
    "WATER_MASS_RATIO",
    "WATER_VOLUME",
    "WELL_CRITICAL_DENSITY",
    "WELL_CRITICAL_TEMPERATURE",
    "Ascent",
    "CloudBase",
    "Convection",
    "CriticalDrop",
    "CriticalPoint",
    "EvaporationEquilibrium",
    "FreeMolecularSlab",
    "Gas",
    "IsobaricWater",
    "ParcelPath",
    "RestState",
    "SimpleFluid",
    "VaporNumber",
    "WalledGas",
    "adiabatic_index",
    "adiabatic_lapse_rate",
    "barometric_density",
    "barometric_pressure",
    "cape_cin",
    "collision_rate",
    "collision_rate_between",
    "collision_rate_discs",
    "column_floor_ratio",
    "column_mean_height",
    "column_scale_height",
    "column_temperature",
    "compressibility_factor",
    "compressibility_factor_discs",
    "contact_share",
    "contact_value",
    "contact_value_between",
    "contact_value_discs",
    "critical_drop",
    "critical_point",
    "density_temperature",
    "dewpoint",
    "diffusivity_error",
    "diffusivity_factor",
    "drop_radius",
    "dry_adiabat_temperature",
    "dry_lapse_rate",
    "emission_energy",
    "emission_normal_speed",
    "environment_pressure",
    "environment_temperature",
    "evaporation_equilibrium",
    "excess_chemical_potential",
    "excess_chemical_potential_discs",
    "excess_free_energy",
    "excess_free_energy_discs",
    "free_molecular_slab",
    "gas_pressure",
    "gas_pressure_discs",
    "growth_rates",
    "hard_sphere_isentrope",
    "height_of_pressure",
    "hertz_knudsen_flux",
    "humidity_over_drop",
    "hydrostatic_layers",
    "hydrostatic_mean_height",
    "inverse_compressibility",
    "inverse_compressibility_discs",
    "isa_pressure",
    "isa_temperature",
    "isobaric_water",
    "isolated_vapor_number",
    "isothermal_vapor_number",
    "kelvin_radius",
    "lcl",
    "leaving_energy_density",
    "maxwell_speed_cumulative",
    "maxwell_speed_density",
    "mean_free_path",
    "mean_free_time",
    "mean_speed",
    "measured_cloud_base",
    "microcanonical_flux",
    "mixed_share",
    "mixed_share_scatter",
    "mixing_decay_rate",
    "mixing_entropy",
    "mixing_ratio",
    "mixing_wave",
    "moist_air_poisson_exponent",
    "mutual_diffusivity",
    "packing_fraction",
    "packing_fraction_discs",
    "parcel_buoyancy",
    "parcel_path",
    "raining_path",
    "rayleigh_number",
    "rest_state",
    "saturation_mixing_ratio",
    "saturation_vapor_pressure",
    "saturation_vapor_pressure_iapws",
    "slope_of_pressure",
    "square_well_compressibility",
    "square_well_second_virial",
    "square_well_third_virial",
    "staying_energy_density",
    "temperature_noise",
    "vapor_pressure",
    "virtual_temperature",
    "walled_gas",
    "water_surface_tension",
    "well_vapor_pressure",
    "wet_bulb_temperature",
]

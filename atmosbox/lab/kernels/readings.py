"""The variables that a page measures, by instrument: their places in ``Gauges.reading`` are in this order.

Each variable is declared in `atmosbox.file.variables`; from its unit there follows its factor to SI units. The kernels
compute it in reduced units, and mixing ratios by number of molecules.
"""

from enum import IntEnum

from atmosbox.scene.instruments import Air, Clusters, Discs, Flow, Leaving, Lift, Mixing, MoistLift, Nuclei, Water

MEASURED: dict[type, tuple[str, ...]] = {
    Air: ("elapsed_time", "air_temperature", "air_pressure", "collision_count"),
    Discs: ("running_energy_light", "running_energy_heavy"),
    Mixing: ("mixing_amplitude", "mixing_entropy"),
    Flow: ("wind_speed", "roll_speed"),
    Water: (
        "water_vapor_partial_pressure", "saturation_vapor_pressure", "relative_humidity", "gas_temperature",
        "liquid_temperature", "condensation_rate", "evaporation_rate", "humidity_mixing_ratio",
        "cloud_liquid_water_mixing_ratio", "vapor_molecule_count", "liquid_molecule_count", "rained_molecule_count",
    ),
    Leaving: ("pool_open_share", "liquid_saturation_vapor_pressure", "temperature_of_those_that_left"),
    Lift: ("parcel_temperature", "parcel_pressure", "moment"),
    MoistLift: (
        "parcel_temperature", "parcel_pressure", "adiabat_temperature", "moment", "rain_mixing_ratio",
        "parcel_buoyancy",
    ),
    Nuclei: ("saturation_ratio", "salted_drop_radius", "pure_drop_radius"),
    Clusters: (
        "kinetic_energy", "largest_drop_molecule_count", "vapor_molecule_count", "drop_count", "attraction_energy",
        "molecular_energy", "heat_from_bath", "work_by_attraction", "virial_pressure", "well_count",
        "air_temperature_theory", "virial_pressure_theory",
    ),
}  # fmt: skip
"""The variables of each instrument; a scene has only some of those of `MoistLift`, `Nuclei` and `Clusters`."""

_NAMES = [name for names in MEASURED.values() for name in names]
# the temperatures of the other five walls follow the last reading
_NAMES += ["gravity", "ledger_residual", "molecules_in_gas", "wall_temperature"]
Reading = IntEnum("Reading", [name.upper() for name in dict.fromkeys(_NAMES)], start=0)  # type: ignore[misc]
"""Indices of ``Gauges.reading``: the names of the variables, in capital letters."""
TIME, ENERGY = 6, 7
"""Indices of ``Gauges.before``."""

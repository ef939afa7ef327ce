"""Every variable that a run can put into its file, declared once.

A variable's name, dimensions, unit and CF names are in `VARIABLES` and nowhere else. A name that ends in
``_se``, ``_count``, ``_theory`` or ``_tolerance`` needs no entry of its own: `variable` derives it from its
parent, as the standard error, the number of samples, the closed-form answer or the allowed deviation. The parts of a
declaration are explained in :mod:`atmosbox.file.declaration`.

Only one variable has a given CF standard name, so that a program that looks for ``air_temperature`` by that name
finds one variable: the value measured in the whole box. Variables of a part of the box, of its environment or of
theory have only a ``long_name`` that says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from atmosbox.file.declaration import SUFFIXES, Variable, derived

__all__ = ["VARIABLES", "known", "variable"]

_TIME, _MOLECULE, _PATH = ("elapsed_time",), ("molecule",), ("elapsed_time", "molecule", "axis")
_MEAN, _POINT = "elapsed_time: mean", "elapsed_time: point"
_SUM = "Summed since the start of the run."


def _declared(dims: tuple[str, ...], *rows: tuple[str, ...], **common: Any) -> dict[str, Variable]:
    """Return variables of the same dimensions; each row is a name, a unit, a long name and maybe a CF standard name."""
    return {
        name: Variable(name, dims, unit, words, standard[0] if standard else None, **common)
        for name, unit, words, *standard in rows
    }


VARIABLES: dict[str, Variable] = {
    # Coordinates
    **_declared(_TIME, ("elapsed_time", "s", "time since the start of the run"), ledger=True),
    **_declared(("height",), ("height", "m", "height of the middle of the layer", "height"),
                axis="Z", positive="up", ledger=True),
    **_declared(("speed",), ("speed", "m s-1", "speed of a molecule, middle of the bin"), ledger=True),
    **_declared(("energy",), ("energy", "J", "energy of a molecule of water above that of one at rest in the liquid, "
                 "middle of the bin"), ledger=True),
    **_declared(("distance",), ("distance", "m", "distance from the left wall, middle of the bin"), ledger=True),
    **_declared(("radius",), ("radius", "m", "radius of a drop"), ledger=True),
    **_declared(("mode",), ("mode", "1", "number of half waves across the box"), ledger=True),
    **_declared(("wall",), ("wall", "", "wall of the box"), dtype="U"),
    **_declared(("axis",), ("axis", "", "direction in space, z upwards"), dtype="U"),
    **_declared(_MOLECULE, ("molecule", "1", "number of the molecule"), dtype="i8"),
    # Every run, frame by frame
    **_declared(
        _TIME,
        ("air_temperature", "K", "temperature of the air in the box", "air_temperature"),
        ("air_pressure", "Pa", "pressure of the air on the walls", "air_pressure"),
        ("mean_molecular_speed", "m s-1", "mean speed of the molecules"),
        cell_methods=_MEAN,
    ),
    **_declared(
        _TIME,
        ("kinetic_energy", "J", "kinetic energy of the molecules"),
        ("rotational_energy", "J", "rotational energy of the molecules"),
        ("potential_energy", "J", "potential energy of the molecules, in gravity and by attraction"),
        ("numerical_heat", "J", "energy that the scheme of an approximate engine has made by itself"),
        ("ledger_residual", "1", "residual of the energy budget, as a share of the energy in the box or exchanged"),
        cell_methods=_POINT, ledger=True,
    ),
    **_declared(
        _TIME,
        ("collision_count", "1", "number of collisions between molecules"),
        ("wall_hit_count", "1", "number of hits of molecules on walls"),
        cell_methods=_POINT, comment=_SUM, dtype="i8",
    ),
    **_declared(_TIME, ("work_by_piston", "J", "work done on the molecules by the piston"),
                ("work_by_gravity", "J", "energy given to the molecules by changes of gravity"),
                cell_methods=_POINT, comment=_SUM, ledger=True),
    **_declared(_TIME, ("gravity", "m s-2", "acceleration of gravity, if it was changed during the run"),
                ("pool_open_share", "1", "share of the pool that is open, if it was changed during the run"),
                cell_methods=_POINT),
    **_declared((*_TIME, "wall"), ("heat_from_wall", "J", "heat given to the molecules by the wall"),
                cell_methods=_POINT, comment=_SUM, ledger=True),
    **_declared((*_TIME, "wall"), ("wall_pressure", "Pa", "pressure of the air on the wall"),
                cell_methods=_MEAN),
    **_declared(_TIME, ("air_temperature_noise", "K", "expected scatter of a thermometer of so few molecules"),
                difference=True),
    **_declared((*_TIME, "wall"), ("wall_temperature", "K", "temperature of the wall"), cell_methods=_POINT),
    # Molecules that attract each other
    **_declared(
        _TIME,
        ("largest_drop_molecule_count", "1", "number of molecules in the largest drop"),
        ("well_count", "1", "number of pairs of molecules that attract each other"),
        cell_methods=_POINT, dtype="i8",
    ),
    **_declared(_TIME, ("attraction_energy", "J", "potential energy of all pairs that attract each other"),
                ("molecular_energy", "J", "kinetic and potential energy of all molecules"),
                cell_methods=_POINT, ledger=True),
    **_declared(_TIME, ("heat_from_bath", "J", "heat given to the molecules by the thermostat"),
                ("work_by_attraction", "J", "energy given to the molecules by changes of the attraction"),
                cell_methods=_POINT, comment=_SUM, ledger=True),
    **_declared(
        _TIME,
        ("virial_pressure", "Pa", "pressure by the motion of molecules and the forces between them"),
        ("normal_pressure", "Pa", "pressure across the surface of the liquid"),
        ("surface_tension", "N m-1", "surface tension of the liquid"),
        ("liquid_number_density", "m-3", "number of molecules in a cubic metre of liquid"),
        ("vapor_number_density", "m-3", "number of molecules in a cubic metre of vapour"),
        ("liquid_well_energy", "J", "energy of attraction of a molecule of the liquid"),
        ("vapor_well_energy", "J", "energy of attraction of a molecule of the vapour"),
        cell_methods=_MEAN,
    ),
    # A parcel that is lifted
    **_declared(
        _TIME,
        ("parcel_temperature", "K", "temperature of the parcel"),
        ("parcel_potential_temperature", "K", "potential temperature of the parcel, reduced to 1000 hPa",
         "air_potential_temperature"),
        cell_methods=_POINT,
    ),
    **_declared(_TIME, ("parcel_pressure", "Pa", "pressure of the parcel"), positive="down", ledger=True,
                coordinate=True),
    **_declared(_TIME, ("parcel_height", "m", "height of the parcel above the ground"), positive="up", ledger=True,
                coordinate=True),
    **_declared(
        _TIME,
        ("environment_temperature", "K", "temperature of the environment"),
        ("environment_dew_point_temperature", "K", "dewpoint of the environment", "dew_point_temperature"),
        ("environment_virtual_temperature", "K", "virtual temperature of the environment"),
        ("parcel_virtual_temperature", "K", "virtual temperature of the parcel, without the weight of its droplets",
         "virtual_temperature"),
        ("parcel_density_temperature", "K", "temperature of dry air as dense as the parcel with its droplets"),
        ("parcel_buoyancy", "m s-2", "buoyancy of the parcel, with the weight of its droplets"),
        ("environment_pressure", "Pa", "pressure of the environment"),
        ("adiabat_temperature", "K", "temperature of the adiabat at this pressure"),
        ("dry_air_adiabat_temperature", "K", "temperature of the adiabat of dry air at this pressure"),
    ),
    **_declared(
        _TIME,
        ("parcel_volume", "m3", "volume of the parcel"),
        ("piston_height", "m", "distance of the piston from the floor of the box"),
        ("piston_velocity", "m s-1", "velocity of the piston, positive outwards"),
        cell_methods=_POINT, ledger=True,
    ),
    # Water
    **_declared(
        _TIME,
        ("water_vapor_partial_pressure", "Pa", "vapour pressure", "water_vapor_partial_pressure_in_air"),
        ("saturation_vapor_pressure", "Pa", "saturation vapour pressure at the temperature of the air, over water"),
        ("relative_humidity", "1", "relative humidity", "relative_humidity"),
        ("humidity_mixing_ratio", "kg kg-1", "mass of vapour per mass of dry air", "humidity_mixing_ratio"),
        ("cloud_liquid_water_mixing_ratio", "kg kg-1", "mass of liquid water per mass of dry air",
         "cloud_liquid_water_mixing_ratio"),
        ("largest_haze_mixing_ratio", "kg kg-1", "mass of liquid water per mass of dry air, above which it is a cloud"),
        ("rain_mixing_ratio", "kg kg-1", "mass of water that has rained out so far per mass of dry air"),
        ("liquid_temperature", "K", "temperature of the liquid water"),
        ("drop_area", "m2", "total area at which molecules hit drops"),
        ("condensation_rate", "s-1", "number of molecules that condense per time"),
        ("evaporation_rate", "s-1", "number of molecules that evaporate per time"),
        cell_methods=_MEAN,
    ),
    **_declared(
        _TIME,
        ("vapor_molecule_count", "1", "number of molecules of vapour"),
        ("liquid_molecule_count", "1", "number of molecules in the liquid"),
        ("rained_molecule_count", "1", "number of molecules that have left as rain"),
        ("drop_count", "1", "number of drops"),
        cell_methods=_POINT, dtype="i8",
    ),
    **_declared(_TIME, ("largest_drop_radius", "m", "radius of the largest drop"), cell_methods=_POINT),
    # Drops with and without salt
    **_declared(_TIME, ("salted_drop_radius", "m", "mean radius of the drops with salt in them"),
                ("pure_drop_radius", "m", "mean radius of the drops of pure water"), cell_methods=_POINT),
    **_declared(_TIME, ("saturation_ratio", "1", "vapour pressure over that of saturation at the drops' temperature"),
                cell_methods=_MEAN),
    **_declared((*_TIME, "drop"), ("drop_molecule_count", "1", "number of molecules of water in the drop"),
                cell_methods=_POINT, dtype="i8"),
    **_declared(
        ("radius",),
        ("salted_drop_humidity", "1", "relative humidity over a drop with salt in it, by the law of Koehler"),
        ("pure_drop_humidity", "1", "relative humidity over a drop of pure water, by the law of Kelvin"),
    ),
    **_declared(
        _TIME,
        ("condensed_energy", "J", "energy of liquid and rain, and the binding energy of the vapour"),
        cell_methods=_POINT, ledger=True,
    ),
    **_declared(
        _TIME,
        ("gas_temperature", "K", "temperature of air and vapour by all their energy, rotation included"),
        ("liquid_saturation_vapor_pressure", "Pa", "saturation vapour pressure at the temperature of the liquid"),
        cell_methods=_MEAN,
    ),
    # Molecules that leave the liquid and those that stay, by energy
    **_declared(
        ("energy",),
        ("leaving_energy_probability_density", "J-1", "share of the molecules that evaporate per unit of energy"),
        ("staying_energy_probability_density", "J-1", "share of the molecules in the liquid per unit of energy"),
        cell_methods="energy: mean",
    ),
    # A column of air, layer by layer
    **_declared(
        ("height",),
        ("number_density", "m-3", "number of molecules in a cubic metre of the layer"),
        ("air_density", "kg m-3", "density of the layer", "air_density"),
        ("layer_temperature", "K", "temperature of the layer"),
        ("layer_pressure", "Pa", "pressure of the layer"),
        cell_methods="height: mean",
    ),
    **_declared(
        ("height",),
        ("number_density_barometric", "m-3", "number density by the barometric law"),
        ("layer_pressure_barometric", "Pa", "pressure by the barometric law"),
        ("layer_temperature_standard", "K", "temperature of the standard atmosphere"),
        cell_methods="height: mean",
    ),
    # Air that turns over
    **_declared(
        ("elapsed_time", "distance", "height"),
        ("cell_temperature", "K", "temperature of the air in a cell"),
        ("cell_number_density", "m-3", "number of molecules in a cubic metre of a cell"),
        ("cell_pressure", "Pa", "pressure of the air in a cell, by density, temperature and equation of state"),
        ("horizontal_wind", "m s-1", "wind away from the left wall"),
        ("upward_wind", "m s-1", "upward wind", "upward_air_velocity"),
        cell_methods="elapsed_time: distance: height: mean",
    ),
    **_declared(
        _TIME,
        ("wind_speed", "m s-1", "root mean square of the wind minus its thermal noise; negative where noise is larger"),
        ("roll_speed", "m s-1", "root mean square of the amplitudes of all rolls minus their noise"),
        cell_methods=_MEAN,
    ),
    **_declared(_TIME, ("core_lapse_rate", "K m-1", "lapse rate between three and seven tenths of the height"),
                cell_methods=_MEAN, difference=True),
    **_declared((*_TIME, "mode"), ("roll_amplitude", "m s-1", "amplitude of the upward wind of rolls"),
                cell_methods=_MEAN),
    **_declared(_TIME, ("tracer_share_aloft", "1", "share of the molecules from the floor that is in the upper half"),
                cell_methods=_POINT),
    **_declared(
        ("height",),
        ("layer_wind", "m s-1", "wind away from the left wall, in the middle half of the width"),
        ("layer_temperature_conduction", "K", "temperature of air at rest that conducts heat"),
        ("layer_temperature_adiabatic", "K", "temperature of the adiabat through the middle of the height"),
        cell_methods="height: mean",
    ),
    # Speeds, bin by bin
    **_declared(("speed",), ("speed_probability_density", "s m-1", "share of molecules per unit of speed"),
                cell_methods="speed: mean"),
    # Two gases that mix
    **_declared(
        _TIME,
        ("mixing_amplitude", "1", "longest wave of the left-right difference of two gases, over that at the start"),
        ("mixing_entropy", "1", "entropy of mixing per molecule, over that of gases that are mixed"),
        cell_methods=_POINT,
    ),
    **_declared(
        ("distance",),
        ("left_gas_share_early", "1", "share of the gas from the left, after a tenth of the mixing time"),
        ("left_gas_share_middle", "1", "share of the gas from the left, after half the mixing time"),
        ("left_gas_share_late", "1", "share of the gas from the left, after twice the mixing time"),
        cell_methods="distance: mean",
    ),
    **_declared(_MOLECULE, ("gas", "", "which of two gases the molecule belongs to"),
                dtype="i1", flags=("left", "right")),
    # Discs that collide in a plane
    **_declared(
        _TIME,
        ("kinetic_energy_light", "J", "mean kinetic energy of a disc of the light half"),
        ("kinetic_energy_heavy", "J", "mean kinetic energy of a disc of the heavy half"),
        ("running_energy_light", "J", "mean kinetic energy of a light disc since the start"),
        ("running_energy_heavy", "J", "mean kinetic energy of a heavy disc since the start"),
        ("energy_change", "1", "change of the kinetic energy since the start, as a share of it"),
        cell_methods=_POINT, ledger=True,
    ),
    **_declared(
        _TIME,  # NaN where walls were warmed by hand
        ("momentum_residual", "1", "missing momentum, neither in the discs nor taken by walls, as a share"),
        cell_methods=_POINT,
    ),
    **_declared((*_TIME, "axis"), ("momentum", "kg m s-1", "total momentum of the discs"),
                cell_methods=_POINT, ledger=True),
    **_declared(("axis",), ("box_length", "m", "length of the box"), ledger=True),
    **_declared(
        _PATH,
        ("disc_position", "m", "position of the middle of the disc"),
        ("disc_velocity", "m s-1", "velocity of the disc"),
        cell_methods=_POINT, ledger=True,
    ),
    **_declared(_MOLECULE, ("disc_mass", "kg", "mass of the disc"), ledger=True),
    **_declared(_MOLECULE, ("disc_diameter", "m", "diameter of the disc"), ledger=True),
    # Molecules, on request; a molecule that condensed has no position
    **_declared(_PATH, ("molecule_position", "m", "position of the molecule"),
                ("molecule_velocity", "m s-1", "velocity of the molecule"), cell_methods=_POINT, dtype="f4"),
    **_declared(_PATH[:2], ("molecule_speed", "m s-1", "speed of the molecule"),
                cell_methods=_POINT, dtype="f4"),
    **_declared(_PATH[:2], ("molecule_neighbour_count", "1", "number of molecules that attract the molecule"),
                cell_methods=_POINT, dtype="i1"),
    **_declared(_MOLECULE, ("species", "", "species of the molecule"),
                dtype="i1", flags=("dry_air", "water")),
    **_declared(_MOLECULE, ("molecule_mass", "kg", "mass of the molecule"), ledger=True),
    **_declared(_MOLECULE, ("molecule_diameter", "m", "diameter with which the molecule collides"), ledger=True),
    # The box around the molecules, and the drops in it; a drop that has merged into another has no position
    **_declared((*_TIME, "axis"), ("box_side", "m", "length of the box at this time"),
                cell_methods=_POINT, ledger=True),
    **_declared(("wall",), ("wall_law", "", "what the wall does to a molecule that hits it"),
                dtype="i1", flags=("specular", "periodic", "heat_bath", "piston", "pool")),
    **_declared((*_TIME, "drop", "axis"), ("drop_position", "m", "position of the middle of the drop"),
                cell_methods=_POINT),
    **_declared((*_TIME, "drop"), ("drop_radius", "m", "radius of the drop"), cell_methods=_POINT),
}  # fmt: skip
"""Every variable of a file by its name."""


def variable(name: str, own: Mapping[str, Variable] = MappingProxyType({})) -> Variable:
    """Return the declaration of a variable, or of its standard error, number of samples, theory or tolerance.

    Parameters
    ----------
    name
        A name in `VARIABLES`, or one with ``_se``, ``_count``, ``_theory`` or ``_tolerance`` behind it.
    own
        The variables that a scene declares, by name.

    Returns
    -------
    Variable
        The declaration.

    Raises
    ------
    KeyError
        If nothing of that name is declared.

    Examples
    --------
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

"""Every variable that a run can put into its file, declared once.

A variable's name, dimensions, unit and CF names stand in `VARIABLES` and nowhere else. A name that ends in
``_se``, ``_count``, ``_theory`` or ``_tolerance`` needs no entry of its own: `variable` derives it from its
parent, as the standard error, the number of samples, the closed-form answer or the deviation allowed.

Values are SI throughout. A *ledger* variable keeps the books (energies, counts, positions), so a value that
is not finite means that the run is broken. Any other may be NaN where there was nothing to measure, as in a
layer that no molecule visited.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

__all__ = ["SUFFIXES", "VARIABLES", "Variable", "derived", "variable"]

CHUNK_FRAMES = 100  # the frames of some molecules that are compressed as one block
CHUNK_VALUES = 1_000_000  # the most numbers in a block


@dataclass(frozen=True)
class Variable:
    """What a file says about one of its variables.

    Parameters
    ----------
    name, dims
        Its name in the file and the names of its dimensions, none for a single number.
    units
        Its SI unit as UDUNITS writes it; empty for labels and flags, which have none.
    long_name
        What it is, in words.
    standard_name
        Its name in the CF standard name table, if that has one; none is invented.
    cell_methods
        How a value stands for its cell, for example ``elapsed_time: mean``.
    dtype
        numpy's code of the type in the file: ``f8``, ``f4``, ``i8``, ``i1``, or ``U`` for labels.
    ledger
        Whether the variable keeps books, so that all its values must be finite.
    difference
        Whether a temperature is a difference of two, and not one on the scale of a thermometer.
    axis, positive
        CF's marks of a vertical coordinate.
    comment
        What else a reader must know.
    flags
        The meanings of the values 0, 1, 2, ... of a flag.

    Examples
    --------
    The file says that a pressure is the mean over its frame:

    >>> VARIABLES["air_pressure"].attributes()["cell_methods"]
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
    comment: str | None = None
    flags: tuple[str, ...] = ()

    @property
    def units_metadata(self) -> str | None:
        """CF's word on a temperature: on the scale, or a difference, as every lapse rate is."""
        parts = self.units.split()
        if not any(part.startswith("K") and not part[1:].strip("-0123456789") for part in parts):
            return None
        return f"temperature: {'difference' if self.difference or len(parts) > 1 else 'on_scale'}"

    def attributes(self) -> dict[str, Any]:
        """Return the netCDF attributes, without those that are not set."""
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
        """Return how xarray shall store an array of this shape: its fill value, chunks and compression."""
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


_TIME, _MOLECULE, _PATH = ("elapsed_time",), ("molecule",), ("elapsed_time", "molecule", "axis")
_MEAN, _POINT = "elapsed_time: mean", "elapsed_time: point"
_SUM = "Summed since the start of the run."


def _declared(dims: tuple[str, ...], *rows: tuple[str, ...], **common: Any) -> dict[str, Variable]:
    """Return variables of the same dimensions, each row a name, a unit, the words and a CF standard name."""
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
    **_declared(("wall",), ("wall", "", "wall of the box"), dtype="U"),
    **_declared(("axis",), ("axis", "", "direction in space, z upwards"), dtype="U"),
    **_declared(_MOLECULE, ("molecule", "1", "number of the molecule"), dtype="i8"),
    # Every run, frame by frame
    **_declared(
        _TIME,
        ("air_temperature", "K", "temperature of the air in the box", "air_temperature"),
        ("air_pressure", "Pa", "pressure of the air on the walls", "air_pressure"),
        cell_methods=_MEAN,
    ),
    **_declared(
        _TIME,
        ("kinetic_energy", "J", "kinetic energy of the molecules"),
        ("rotational_energy", "J", "rotational energy of the molecules"),
        ("potential_energy", "J", "potential energy of the molecules in gravity"),
        ("ledger_residual", "1", "energy missing from the ledger, as a share of the energy"),
        cell_methods=_POINT, ledger=True,
    ),
    **_declared(
        _TIME,
        ("collision_count", "1", "number of collisions between molecules"),
        ("wall_hit_count", "1", "number of hits of molecules on walls"),
        cell_methods=_POINT, comment=_SUM, dtype="i8",
    ),
    **_declared(_TIME, ("work_by_piston", "J", "work done on the molecules by the piston"),
                cell_methods=_POINT, comment=_SUM, ledger=True),
    **_declared((*_TIME, "wall"), ("heat_from_wall", "J", "heat given to the molecules by the wall"),
                cell_methods=_POINT, comment=_SUM, ledger=True),
    **_declared((*_TIME, "wall"), ("wall_pressure", "Pa", "pressure of the air on the wall", "air_pressure"),
                cell_methods=_MEAN),
    **_declared(_TIME, ("air_temperature_noise", "K", "expected scatter of a thermometer of so few molecules"),
                difference=True),
    **_declared((*_TIME, "wall"), ("wall_temperature", "K", "temperature of the wall"), cell_methods=_POINT),
    # A parcel that is lifted
    **_declared(
        _TIME,
        ("parcel_temperature", "K", "temperature of the parcel", "air_temperature"),
        ("parcel_pressure", "Pa", "pressure of the parcel", "air_pressure"),
        ("parcel_potential_temperature", "K", "potential temperature of the parcel, reduced to 1000 hPa",
         "air_potential_temperature"),
        cell_methods=_POINT,
    ),
    **_declared(_TIME, ("parcel_height", "m", "height of the parcel above the ground", "height"),
                positive="up"),
    **_declared(
        _TIME,
        ("environment_temperature", "K", "temperature of the air around the parcel", "air_temperature"),
        ("environment_pressure", "Pa", "pressure of the air around the parcel", "air_pressure"),
        ("adiabat_temperature", "K", "temperature of the adiabat at this pressure", "air_temperature"),
        ("dry_air_adiabat_temperature", "K", "temperature of the adiabat of dry air at this pressure",
         "air_temperature"),
    ),
    **_declared(
        _TIME,
        ("parcel_volume", "m3", "volume of the parcel"),
        ("piston_height", "m", "distance of the piston from the floor of the box"),
        ("piston_velocity", "m s-1", "velocity of the piston, positive outwards"),
        cell_methods=_POINT, ledger=True,
    ),
    # A column of air, layer by layer
    **_declared(
        ("height",),
        ("number_density", "m-3", "number of molecules in a cubic metre of the layer"),
        ("air_density", "kg m-3", "density of the layer", "air_density"),
        ("layer_temperature", "K", "temperature of the layer", "air_temperature"),
        ("layer_pressure", "Pa", "pressure of the layer", "air_pressure"),
        cell_methods="height: mean",
    ),
    **_declared(
        ("height",),
        ("number_density_barometric", "m-3", "number density by the barometric law"),
        ("layer_pressure_barometric", "Pa", "pressure by the barometric law", "air_pressure"),
        ("layer_temperature_standard", "K", "temperature of the standard atmosphere", "air_temperature"),
        cell_methods="height: mean",
    ),
    # Speeds, bin by bin
    **_declared(("speed",), ("speed_probability_density", "s m-1", "share of molecules per unit of speed"),
                cell_methods="speed: mean"),
    # Discs that collide in a plane
    **_declared(
        _TIME,
        ("kinetic_energy_light", "J", "mean kinetic energy of a disc of the light half"),
        ("kinetic_energy_heavy", "J", "mean kinetic energy of a disc of the heavy half"),
        ("running_energy_light", "J", "mean kinetic energy of a light disc since the start"),
        ("running_energy_heavy", "J", "mean kinetic energy of a heavy disc since the start"),
        ("energy_change", "1", "change of the kinetic energy since the start, as a share of it"),
        ("momentum_residual", "1", "momentum that neither the discs have nor the walls took, as a share"),
        cell_methods=_POINT, ledger=True,
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
    # Molecules, on request; one that condensed has no position
    **_declared(_PATH, ("molecule_position", "m", "position of the molecule"),
                cell_methods=_POINT, dtype="f4"),
    **_declared(_PATH[:2], ("molecule_speed", "m s-1", "speed of the molecule"),
                cell_methods=_POINT, dtype="f4"),
    **_declared(_MOLECULE, ("species", "", "species of the molecule"),
                dtype="i1", flags=("dry_air", "water")),
}  # fmt: skip
"""Every variable of a file by its name."""

SUFFIXES = ("_se", "_count", "_theory", "_tolerance")
"""What the name of a variable ends in that is derived from another."""


def derived(parent: Variable, suffix: str) -> Variable:
    """Return the companion of a variable: its standard error, count, answer or tolerance.

    Parameters
    ----------
    parent
        The variable that is measured.
    suffix
        One of `SUFFIXES`.

    Returns
    -------
    Variable
        The declaration of the companion.

    Examples
    --------
    >>> derived(VARIABLES["air_pressure"], "_theory").long_name
    'closed-form answer for the pressure of the air on the walls'
    """
    name, words = parent.name + suffix, parent.long_name
    plain = replace(parent, name=name, cell_methods=None, ledger=False, comment=None, dtype="f8")
    if suffix == "_theory":
        return replace(plain, long_name=f"closed-form answer for the {words}")
    plain = replace(plain, positive=None, difference=True)
    if suffix == "_tolerance":
        return replace(plain, long_name=f"allowed deviation from theory of the {words}", standard_name=None)
    if suffix == "_count":
        words = f"number of samples of the {words}"
        return replace(plain, long_name=words, standard_name="number_of_observations", units="1")
    standard = parent.standard_name and f"{parent.standard_name} standard_error"
    return replace(plain, long_name=f"standard error of the {words}", standard_name=standard)


def variable(name: str) -> Variable:
    """Return what is declared under a name, also under that of a standard error or of an answer.

    Parameters
    ----------
    name
        A name in `VARIABLES`, or one with ``_se``, ``_count``, ``_theory`` or ``_tolerance`` behind it.

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
    if name in VARIABLES:
        return VARIABLES[name]
    for suffix in SUFFIXES:
        parent = VARIABLES.get(name.removesuffix(suffix))
        if parent is not None and name.endswith(suffix):
            return derived(parent, suffix)
    raise KeyError(f"{name!r} is not declared in atmosbox.diagnostics.VARIABLES")

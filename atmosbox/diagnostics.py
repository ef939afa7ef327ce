"""Every variable that a run can put into its file, declared once, and the dataset made of them.

A variable's name, dimensions, unit and CF names stand in `VARIABLES` and nowhere else. A name that ends in
``_se``, ``_count``, ``_theory`` or ``_tolerance`` needs no entry of its own: `variable` derives it from its
parent, as the standard error, the number of samples, the closed-form answer or the deviation allowed.

Values are SI throughout. A *ledger* variable keeps the books (energies, counts, positions), so a value that
is not finite means that the run is broken. Any other may be NaN where there was nothing to measure, as in a
layer that no molecule visited.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
import xarray as xr

from atmosbox.errors import EngineError

__all__ = ["VARIABLES", "Variable", "dataset", "headline_variables", "variable"]

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


class _Headline(Protocol):
    """One of the few numbers that a run is about, as a scene states it; None where it states nothing."""

    @property
    def name(self) -> str: ...
    @property
    def value(self) -> float | None: ...
    @property
    def standard_error(self) -> float | None: ...
    @property
    def theory(self) -> float | None: ...
    @property
    def tolerance(self) -> float | None: ...
    @property
    def unit(self) -> str: ...
    @property
    def display_unit(self) -> str: ...
    @property
    def label(self) -> str: ...
    @property
    def reason(self) -> str | None: ...


_TIME, _MOLECULE, _PATH = ("elapsed_time",), ("molecule",), ("elapsed_time", "molecule", "axis")
_MEAN, _POINT = "elapsed_time: mean", "elapsed_time: point"
_SUM = "Summed since the start of the run."
_LABELS = {"wall": ("x_low", "x_high", "y_low", "y_high", "z_low", "z_high"), "axis": ("x", "y", "z")}


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

_SUFFIXES = ("_se", "_count", "_theory", "_tolerance")


def _derived(parent: Variable, suffix: str) -> Variable:
    """Return the companion of a variable: its standard error, count, answer or tolerance."""
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
    for suffix in _SUFFIXES:
        parent = VARIABLES.get(name.removesuffix(suffix))
        if parent is not None and name.endswith(suffix):
            return _derived(parent, suffix)
    raise KeyError(f"{name!r} is not declared in atmosbox.diagnostics.VARIABLES")


def headline_variables(headline: _Headline) -> dict[str, xr.Variable]:
    """Return the variables that hold one headline: its value, error, answer and tolerance.

    Parameters
    ----------
    headline
        The headline in SI units. A value of None becomes NaN, another None no variable.

    Returns
    -------
    dict
        Variables without dimensions by their names; the attribute ``display_units`` keeps the unit in which
        a table shows them.

    Examples
    --------
    >>> from atmosbox.settings import Headline
    >>> warm = Headline("final", 300.0, 0.5, None, 0.0, "", "K", "degC", "temperature at the end")
    >>> held = headline_variables(warm)
    >>> {name: float(number) for name, number in held.items()}, held["final"].attrs["display_units"]
    ({'final': 300.0, 'final_se': 0.5, 'final_tolerance': 0.0}, 'degC')
    """
    parent = Variable(headline.name, (), headline.unit, headline.label, comment=headline.reason or None)
    stated = {
        parent: math.nan if headline.value is None else headline.value,
        _derived(parent, "_se"): headline.standard_error,
        _derived(parent, "_theory"): headline.theory,
        _derived(parent, "_tolerance"): headline.tolerance,
    }
    held = {
        entry.name: xr.Variable((), float(number), entry.attributes(), entry.encoding(()))
        for entry, number in stated.items()
        if number is not None
    }
    held[parent.name].attrs["display_units"] = headline.display_unit
    return held


def _array(declared: Variable, values: npt.ArrayLike) -> npt.NDArray[Any]:
    """Return the values in their declared type, refused where they break the books."""
    array = np.asarray(values)
    if array.ndim != len(declared.dims):
        raise ValueError(f"{declared.name} has the shape {array.shape}, but the dimensions {declared.dims}")
    if declared.dtype == "U":
        return array.astype(str)
    if (declared.ledger or declared.dtype[0] == "i") and not np.isfinite(array).all():
        place = [int(index) for index in np.argwhere(~np.isfinite(array))[0]]
        raise EngineError(f"{declared.name} is not finite at {place}: the books of the run do not close any more.")
    return array.astype(declared.dtype)


def _coordinate(name: str, values: npt.ArrayLike, time_unit: str) -> xr.Variable:
    """Return a coordinate or its bounds."""
    if name.endswith("_bnds"):
        parent = VARIABLES[name.removesuffix("_bnds")]
        declared = replace(parent, name=name, dims=(*parent.dims, "bounds"))
        return xr.Variable(declared.dims, _array(declared, values), {}, declared.encoding(()))
    declared = VARIABLES[name]
    if declared.dims != (name,):
        raise KeyError(f"{name!r} is no coordinate")
    array = _array(declared, values)
    if declared.dtype != "U" and (np.diff(array) <= 0).any():
        raise ValueError(f"the coordinate {name} does not rise from each value to the next")
    attrs = declared.attributes() | ({"units": time_unit} if name == "elapsed_time" else {})
    return xr.Variable(declared.dims, array, attrs, declared.encoding(array.shape))


def dataset(
    frames: Mapping[str, npt.ArrayLike],
    coords: Mapping[str, npt.ArrayLike],
    attrs: Mapping[str, Any],
    headlines: Iterable[_Headline] = (),
    time_unit: str = "ns",
) -> xr.Dataset:
    """Put the numbers of a run into one dataset that carries all that CF asks for.

    Parameters
    ----------
    frames
        Arrays by the name of their variable, in SI, with the dimensions that `variable` declares.
    coords
        Arrays by the name of their coordinate: ``elapsed_time`` in `time_unit`, the others in SI, and the
        bounds of their cells as ``elapsed_time_bnds``, ``height_bnds``, ``speed_bnds`` with the shape (n, 2).
        The labels of six walls and three axes need not be given.
    attrs
        The global attributes.
    headlines
        The numbers that the run is about.
    time_unit
        The unit of ``elapsed_time``: s, ns or ps.

    Returns
    -------
    xarray.Dataset
        Coordinates, variables and headlines; ``atmosbox_headlines`` lists the names of the headlines.

    Raises
    ------
    KeyError
        If a name is not declared, or a dimension lacks its coordinate.
    ValueError
        If a shape is not the declared one, a coordinate does not rise, or a headline bears a variable's name.
    EngineError
        If a value of a ledger variable or a count is not finite.

    Examples
    --------
    >>> run = dataset(
    ...     {"air_temperature": [300.0, 301.0]}, {"elapsed_time": [0.5, 1.0]}, {"title": "A box of air"}
    ... )
    >>> run.air_temperature.sel(elapsed_time=1.0).item(), run.elapsed_time.units
    (301.0, 'ns')
    """
    if time_unit not in ("s", "ns", "ps"):
        raise ValueError(f"elapsed_time cannot be in {time_unit!r}, only in s, ns or ps")
    held: dict[str, xr.Variable] = {}
    for name, values in frames.items():
        declared = variable(name)
        array = _array(declared, values)
        held[name] = xr.Variable(declared.dims, array, declared.attributes(), declared.encoding(array.shape))
    sizes = {dim: size for entry in held.values() for dim, size in entry.sizes.items()}
    given = {dim: names for dim, names in _LABELS.items() if sizes.get(dim) == len(names)} | dict(coords)
    axes = {name: _coordinate(name, values, time_unit) for name, values in given.items()}
    for dim in sizes:
        if dim not in axes and dim != "molecule":
            raise KeyError(f"the dimension {dim!r} has no coordinate")
    for name in axes:
        if f"{name}_bnds" in axes:
            axes[name].attrs["bounds"] = f"{name}_bnds"
    names = []
    for headline in headlines:
        names.append(headline.name)
        for name, entry in headline_variables(headline).items():
            if name in held or name in axes:
                raise ValueError(f"the headline {name} has the name of a variable")
            held[name] = entry
    for name, entry in held.items():
        companions = [name + suffix for suffix in _SUFFIXES if name + suffix in held]
        if companions:
            entry.attrs["ancillary_variables"] = " ".join(companions)
    bounds = {name: entry for name, entry in axes.items() if name.endswith("_bnds")}
    only = {name: entry for name, entry in axes.items() if name not in bounds}
    return xr.Dataset(bounds | held, only, {**attrs, "atmosbox_headlines": json.dumps(names)})

"""Which engine lets time pass, and with which options: declared once, checked once.

An engine is asked for by its name, and where it has options by their values behind a colon, as in
``stepped:delta=0.02,motion=euler``. The same words stand on the command line, in a settings file and in
the output.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from atmosbox.errors import SettingError, UnknownSettingError
from atmosbox.parameter import Parameter, Value
from atmosbox.spelling import nearest

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

    from atmosbox.engine.parcel import Parcel

__all__ = ["ENGINES", "EXACT", "Engine", "EngineChoice", "choose", "names", "used"]


@dataclass(frozen=True)
class Engine:
    """An engine as it is declared.

    Parameters
    ----------
    name
        Its name.
    summary
        What it does, in one line.
    parcel
        What returns the class of its parcels; nothing of the engine is loaded before.
    parameters
        Its options.
    ideal
        Whether its molecules take no room from each other: the pressure is n kT, without Z.
    reference
        What its method is described in, if anywhere but here.
    moist
        What returns the class of its parcels with liquid water in them, if it has one.
    """

    name: str
    summary: str
    parcel: Callable[[], type[Parcel]]
    parameters: tuple[Parameter, ...] = ()
    ideal: bool = False
    reference: str = ""
    moist: Callable[[], type[Parcel]] | None = None


def _exact() -> type[Parcel]:
    from atmosbox.engine.parcelset import ParcelSet

    return ParcelSet


def _moist_exact() -> type[Parcel]:
    from atmosbox.engine.moist_parcelset import MoistParcelSet

    return MoistParcelSet


def _stepped() -> type[Parcel]:
    from atmosbox.engine.stepped_parcel import SteppedParcel

    return SteppedParcel


def _dsmc() -> type[Parcel]:
    from atmosbox.engine.dsmc_parcel import DsmcParcel

    return DsmcParcel


def _moist_dsmc() -> type[Parcel]:
    from atmosbox.engine.moist_dsmc_parcel import MoistDsmcParcel

    return MoistDsmcParcel


def _classic() -> type[Parcel]:
    from atmosbox.engine.classic import ClassicParcel

    return ClassicParcel


def _number(name: str, default: float, low: float, high: float, help: str) -> Parameter:
    return Parameter(name, "1", default, low, high, None, help, "float")


def _word(name: str, choices: tuple[str, ...], help: str) -> Parameter:
    return Parameter(name, "", choices[0], None, None, choices, help, "str")


def _count(name: str, default: int, high: int, help: str) -> Parameter:
    return Parameter(name, "1", default, 1, high, None, help, "int")


def _switch(name: str, default: bool, help: str) -> Parameter:
    return Parameter(name, "", default, None, None, None, help, "bool")


_DELTA = "time step, as the share of its diameter that a molecule moves in it at thermal speed"

ENGINES: Mapping[str, Engine] = MappingProxyType(
    {
        engine.name: engine
        for engine in (
            Engine(
                "exact",
                "every contact and every wall hit at its exact time, in order",
                _exact,
                reference="https://doi.org/10.1007/s40571-014-0021-8 (event-driven hard spheres)",
                moist=_moist_exact,
            ),
            Engine(
                "stepped",
                "equal steps: all molecules move, then those that overlap and approach collide",
                _stepped,
                (
                    _number("delta", 0.05, 1e-6, 1e3, _DELTA),
                    _word("motion", ("parabola", "euler", "semi-implicit"), "how molecules fall"),
                    _word(
                        "smooth_walls",
                        ("mirror", "fold", "flip", "clamp", "rewind"),
                        "what smooth walls do with a molecule that has gone through them",
                    ),
                    _switch("approaching", True, "whether only pairs that approach collide"),
                    _count("threads", 1, 256, "on how many threads; the result is the same for any number"),
                ),
            ),
            Engine(
                "dsmc",
                "equal steps: in each cell molecules collide with whom chance chooses; for a hundred thousand and more",
                _dsmc,
                (
                    _number("dt", 0.2, 1e-4, 10.0, "time step in mean free times"),
                    _number("occupancy", 10.0, 1.0, 1e4, "mean number of molecules in a cell"),
                    _number("cell", 0.5, 1e-3, 1e3, "side of a cell in mean free paths, in place of an occupancy"),
                    _count("threads", 1, 256, "on how many threads; the result is the same for any number"),
                ),
                ideal=True,
                reference="https://doi.org/10.1063/1.869674 (cells and steps of direct simulation Monte Carlo)",
                moist=_moist_dsmc,
            ),
            Engine(
                "classic",
                "steps, as teaching applets take them: overlapping pairs swap velocities",
                _classic,
                (
                    _number("delta", 0.1, 1e-6, 1e3, _DELTA),
                    _word("scheme", ("spheres", "lookahead", "strips"), "which scheme, if not what suits the box"),
                    _switch("closing_only", True, "whether pairs that are already parting are let go"),
                ),
            ),
        )
    }
)
"""The engines by name, the one that is right to rounding first."""


@dataclass(frozen=True)
class EngineChoice:
    """An engine with its options.

    Parameters
    ----------
    engine
        The engine.
    options
        The options that were given, by name; the engine has its own defaults for the rest.

    Examples
    --------
    >>> str(choose("exact"))
    'exact'
    """

    engine: Engine
    options: Mapping[str, Value] = field(default_factory=dict)

    def __str__(self) -> str:
        """Return the words that ask for it."""
        options = ",".join(f"{name}={_typed(value)}" for name, value in self.options.items())
        return self.engine.name + (f":{options}" if options else "")

    @property
    def name(self) -> str:
        """The name of the engine."""
        return self.engine.name

    @property
    def ideal(self) -> bool:
        """Whether the molecules of the engine take no room from each other."""
        return self.engine.ideal

    def make(self, position: ArrayLike, velocity: ArrayLike, **box: Any) -> Parcel:
        """Return a parcel of this engine: what a scene calls in place of `atmosbox.engine.ParcelSet`.

        Raises
        ------
        RefusedError
            If the engine cannot do what the box asks for.
        SettingError
            If there is a ``liquid`` in the box, and the engine knows none.
        """
        parcel: Callable[..., Parcel] = self.engine.parcel()
        if "liquid" in box:
            if self.engine.moist is None:
                able = " or ".join(f"--engine {engine.name}" for engine in ENGINES.values() if engine.moist is not None)
                raise SettingError("engine", str(self), "knows no liquid water", f"give {able}")
            parcel = self.engine.moist()
        return parcel(position, velocity, **self.options, **box)


def names() -> tuple[str, ...]:
    """Return the names of the engines.

    Examples
    --------
    >>> names()[0]
    'exact'
    """
    return tuple(ENGINES)


def choose(text: str | EngineChoice) -> EngineChoice:
    """Return the engine that a text asks for.

    Parameters
    ----------
    text
        A name, or a name and options: ``stepped:delta=0.02``.

    Raises
    ------
    SettingError
        If there is no such engine or option, or the value of one is not allowed.

    Examples
    --------
    >>> choose("exakt")
    Traceback (most recent call last):
        ...
    atmosbox.errors.SettingError: engine = exakt is not one of exact, stepped, dsmc, classic: give --engine exact.
    """
    if isinstance(text, EngineChoice):
        return text
    name, colon, rest = str(text).strip().partition(":")
    if name not in ENGINES:
        near = nearest(name, ENGINES) or next(iter(ENGINES))
        raise SettingError("engine", name, f"is not one of {', '.join(ENGINES)}", f"give --engine {near}")
    engine = ENGINES[name]
    if colon and not rest.strip():
        raise SettingError("engine", text, "ends in a colon without options", f"give --engine {name}")
    parameters = {parameter.name: parameter for parameter in engine.parameters}
    options: dict[str, Value] = {}
    for piece in rest.split(",") if rest else ():
        key, equals, value = piece.partition("=")
        key = key.strip().replace("-", "_")
        if key not in parameters:
            raise UnknownSettingError(key or piece, value, f"is no option of the engine {name}", _fix(engine, key))
        if not equals:
            raise SettingError(key, "", "has no value", _fix(engine, key))
        if key in options:
            raise SettingError(key, value, "is given twice", _fix(engine, key))
        try:
            options[key] = parameters[key].parse(value.strip())
        except SettingError as error:
            fix = error.fix.replace("--set ", f"--engine {name}:")
            raise type(error)(error.setting, error.value, error.problem, fix) from None
    return EngineChoice(engine, options)


def used(dataset: xr.Dataset) -> EngineChoice:
    """Return the engine that made a dataset.

    Raises
    ------
    SettingError
        If this version has no such engine.
    """
    made = json.loads(dataset.attrs.get("atmosbox_parameters", "{}"))
    return choose(str(made.get("engine", "exact")))


EXACT = EngineChoice(ENGINES["exact"])
"""The engine that every scene runs on unless another is asked for."""


def _typed(value: Value) -> str:
    """Return a value as it is typed."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def _fix(engine: Engine, key: str) -> str:
    """Return what to type in place of an option that does not exist."""
    known = {parameter.name: parameter for parameter in engine.parameters}
    if not known:
        return f"give --engine {engine.name}, which has no options"
    near = known[nearest(key, known) or next(iter(known))]
    return f"give --engine {engine.name}:{near.name}={near.typed()}"

"""The engines and their options, as declared, and the one that a user or a scene chooses, checked once.

An engine is chosen by its name, and its options by their values after a colon, as in
``stepped:delta=0.02,motion=euler``. The command line, a settings file and the output all use this form.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib import import_module
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from atmosbox.errors import Option, SettingError, either, on_command_line
from atmosbox.scene.settings import Parameter, Value, by_name
from atmosbox.scene.spelling import assignments, nearest

if TYPE_CHECKING:
    import numpy as np
    import xarray as xr
    from numpy.typing import ArrayLike, NDArray

    from atmosbox.engine import Parcel, Start
    from atmosbox.engine.core.random import Source

__all__ = ["ENGINES", "EXACT", "FEW", "Engine", "EngineChoice", "choose", "names", "suited", "suited_engine", "used"]


@dataclass(frozen=True)
class Engine:
    """The declaration of an engine.

    Parameters
    ----------
    name, summary
        Its name, and what it does, in one line.
    parcel
        The class of its parcels, whose file is imported when the first box is made.
    parameters, presets
        Its options, and names that stand for several options at once.
    ideal
        Whether the pressure is n kT, without Z: its molecules have no excluded volume.
    reference
        Publication of its method.
    moist, drops, attracting
        The same of parcels with a liquid in them, with drops that have a size of their own, and of molecules that
        attract each other; empty if there are none.
    """

    name: str
    summary: str
    parcel: str
    parameters: tuple[Parameter, ...] = ()
    ideal: bool = False
    reference: str = ""
    moist: str = ""
    drops: str = ""
    attracting: str = ""
    presets: Mapping[str, Mapping[str, Value]] = field(default_factory=dict)


def _option(name: str, default: Value, help: str, low: float | None = None, high: float | None = None) -> Parameter:
    kind = type(default).__name__
    return Parameter(name, "" if kind == "bool" else "1", default, low, high, None, help, kind)


def _word(name: str, choices: tuple[str, ...], help: str) -> Parameter:
    return Parameter(name, "", choices[0], None, None, choices, help, "str")


_COLLISIONS = _option("collisions", True, "whether molecules collide with each other, or with walls alone")
_DELTA = "time step, as the share of its diameter that a molecule moves in it at thermal speed"
_RULES = "pairwise", "index-order", "look-ahead", "every-overlap"
_SMOOTH = "mirror", "fold", "flip", "clamp", "undo"
_ALL = (
    Engine(
        "exact",
        "every contact and every wall hit at its exact time, in order",
        "ParcelSet",
        (_COLLISIONS,),
        reference="https://doi.org/10.1007/s40571-014-0021-8 (event-driven hard spheres)",
        moist="MoistParcelSet",
        drops="DropParcelSet",
        attracting="AttractingParcelSet",
    ),
    Engine(
        "stepped",
        "equal steps, as in applets: all molecules move, then those that overlap and approach collide",
        "SteppedParcel",
        (
            _option("delta", 0.05, _DELTA, 1e-6, 1e3),
            _word("rule", _RULES, "which pairs collide, and how they are found"),
            _word("motion", ("parabola", "euler"), "how molecules fall"),
            _word("smooth_walls", _SMOOTH, "what smooth walls do with a molecule that has gone through them"),
            _COLLISIONS,
        ),
        presets={
            "applet": {"rule": "index-order", "motion": "euler", "smooth_walls": "fold"},
            "applet-discs": {"rule": "look-ahead", "motion": "euler", "smooth_walls": "clamp"},
            "applet-atmosphere": {"rule": "pairwise", "motion": "parabola", "smooth_walls": "undo"},
        },
    ),
    Engine(
        "dsmc",
        "equal steps: in each cell partners of collisions are drawn at random; for many molecules of a thin gas",
        "DsmcParcel",
        (
            _option("dt", 0.2, "time step in mean free times", 1e-4, 10.0),
            _option("occupancy", 10.0, "mean number of molecules in a cell", 1.0, 1e4),
            _option("cell", 0.5, "side of a cell in mean free paths, in place of an occupancy", 1e-3, 1e3),
            _COLLISIONS,
            _option("threads", 1, "on how many threads; the result is the same for any number", 1, 256),
        ),
        ideal=True,
        reference="https://doi.org/10.1063/1.869674 (cells and steps of direct simulation Monte Carlo)",
        moist="MoistDsmcParcel",
    ),
)
_FILES: Mapping[str, Callable[[], Any]] = {
    "ParcelSet": lambda: import_module("atmosbox.engine.exact.parcelset"),
    "MoistParcelSet": lambda: import_module("atmosbox.engine.liquid.moist_parcelset"),
    "DropParcelSet": lambda: import_module("atmosbox.engine.liquid.drop_parcelset"),
    "AttractingParcelSet": lambda: import_module("atmosbox.engine.wells.attracting_parcelset"),
    "SteppedParcel": lambda: import_module("atmosbox.engine.stepped.stepped_parcel"),
    "DsmcParcel": lambda: import_module("atmosbox.engine.dsmc.dsmc_parcel"),
    "MoistDsmcParcel": lambda: import_module("atmosbox.engine.dsmc.moist_dsmc_parcel"),
}
"""The files of the classes of parcels."""
ENGINES: Mapping[str, Engine] = MappingProxyType({engine.name: engine for engine in _ALL})
"""The engines by name; the first is exact up to rounding."""


FEW = 5000
"""Largest number of molecules with which a scene of thin gas runs on the exact engine: see `suited`."""


@dataclass(frozen=True)
class EngineChoice:
    """An engine with its options.

    Parameters
    ----------
    engine, options
        The engine, and the options that were given, by name; it has its own defaults for the rest.
    described
        Whether its boxes are only described: checked, but never advanced, so that nothing is compiled.

    Examples
    --------
    >>> str(choose("exact"))
    'exact'
    """

    engine: Engine
    options: Mapping[str, Value] = field(default_factory=dict)
    described: bool = False

    def __str__(self) -> str:
        """Return the text that chooses this engine."""
        known = {parameter.name: parameter for parameter in self.engine.parameters}
        words: list[str] = []
        preset: Mapping[str, Value] = {}
        for name, options in self.engine.presets.items():
            if options.items() <= self.options.items():
                words, preset = [name], options
        words += [f"{name}={known[name].typed(value)}" for name, value in self.options.items() if name not in preset]
        return self.engine.name + (f":{','.join(words)}" if words else "")

    @property
    def name(self) -> str:
        """The name of the engine."""
        return self.engine.name

    @property
    def ideal(self) -> bool:
        """Whether the pressure is n kT, without Z: the molecules of the engine have no excluded volume."""
        return self.engine.ideal or self.options.get("collisions") is False

    def scatter(self, length: Sequence[float], diameter: ArrayLike, rng: Source, **options: Any) -> NDArray[np.float64]:
        """Return random centres in a box that `make` is to make; see `atmosbox.engine.random_positions`."""
        from atmosbox.engine import random_positions

        return random_positions(length, diameter, rng, apart=not self.described, **options)

    def make(self, position: ArrayLike, velocity: ArrayLike, **box: Any) -> Parcel:
        """Return a parcel of this engine; a scene calls this in place of `atmosbox.engine.ParcelSet`.

        Raises
        ------
        RefusedError
            If the engine cannot do what the box requires.
        SettingError
            If the box has a ``liquid`` or a ``well`` about its molecules, and the engine has no class for it.
        """
        from atmosbox.engine import Drops

        kind = self.engine.parcel
        if "liquid" in box:
            if not self.engine.moist:
                able = either("engine", [engine.name for engine in ENGINES.values() if engine.moist])
                raise SettingError("engine", str(self), "cannot simulate liquid water", *able)
            kind = self.engine.drops if isinstance(box["liquid"], Drops) else self.engine.moist
            if not kind:
                problem = "has no drops with a size of their own"
                raise SettingError("engine", self.name, problem, Option("engine", "exact"), ", or a mist")
        if "well" in box:
            kind = self.engine.attracting
            if not kind:
                raise SettingError("engine", str(self), "cannot simulate attraction", Option("engine", "exact"))
        if self.described:
            from atmosbox.scene.described_parcel import DescribedParcel

            return DescribedParcel(position, velocity, **box)
        parcel: Parcel = getattr(_FILES[kind](), kind)(position, velocity, **self.options, **box)
        return parcel

    def begin(self, start: Start, *, rng: Source | None = None, **box: Any) -> Parcel:
        """Return a parcel of this engine whose molecules start as declared.

        If more than the start depends on the seed, ``rng`` are random numbers of which some have been drawn; otherwise
        they are those of the seed of the box.

        Examples
        --------
        >>> from atmosbox.engine import Maxwell, Scattered, Start
        >>> EXACT.begin(Start(20, (Scattered(), Maxwell(1.0))), length=(5, 5, 5), seed=1).number
        20
        """
        from atmosbox.engine import Periodic, RandomNumbers

        walls = [isinstance(wall, Periodic) for wall in box.get("walls", ())]
        x, y, z = (*walls, *[False] * 6)[:6:2]
        drawn = start.draw(
            RandomNumbers(box.get("seed", 0)) if rng is None else rng,
            periodic=(x, y, z),
            apart=not self.described,
            **{name: box[name] for name in ("length", "diameter", "mass", "rotation", "planar") if name in box},
        )
        if drawn.rotational_energy is not None:
            box["rotational_energy"] = drawn.rotational_energy
        parcel = self.make(drawn.position, drawn.velocity, **box)
        parcel.start = start if rng is None else None
        return parcel


def names() -> tuple[str, ...]:
    """Return the names of the engines.

    Examples
    --------
    >>> names()[0]
    'exact'
    """
    return tuple(ENGINES)


def choose(text: str | EngineChoice) -> EngineChoice:
    """Return the engine that a text names.

    Parameters
    ----------
    text
        A name, or a name and options: ``stepped:delta=0.02``. A preset is a name for several options, which those
        after it may change: ``stepped:applet,delta=0.1``.

    Raises
    ------
    SettingError
        If there is no such engine or option, or the value of one is not allowed.

    Examples
    --------
    >>> choose("exakt")
    Traceback (most recent call last):
        ...
    atmosbox.errors.SettingError: engine = exakt is not one of exact, stepped, dsmc: give engine="exact".
    """
    if isinstance(text, EngineChoice):
        return text
    name, colon, rest = str(text).strip().partition(":")
    if name not in ENGINES:
        near = "stepped:applet" if name == "classic" else nearest(name, ENGINES) or next(iter(ENGINES))
        raise SettingError("engine", name, f"is not one of {', '.join(ENGINES)}", Option("engine", near))
    engine = ENGINES[name]
    if colon and not rest.strip():
        raise SettingError("engine", text, "ends in a colon without options", Option("engine", name))
    parameters = {parameter.name: parameter for parameter in engine.parameters}
    words = [word.strip() for word in rest.split(",")] if rest else []
    options = {option: value for word in words for option, value in engine.presets.get(word, {}).items()}
    try:
        typed = assignments(word for word in words if word not in engine.presets)
        given = by_name(typed, parameters, f"an option of the engine {name}")
        options |= {option: parameters[option].parse(value) for option, value in given.items()}
        return EngineChoice(engine, options)
    except SettingError as error:
        error.instead_of_settings(lambda part: Option("engine", f"{name}:{on_command_line(part)[6:]}"))
        raise


def suited(molecules: int) -> str:
    """Return the engine that suits a thin gas of ``molecules``: the exact one for few, dsmc for more than `FEW`.

    The excluded volume, which dsmc leaves out, is less than the statistical error in a thin gas. As dsmc takes a
    quarter of the time or less, it can have more molecules, which scatter less. Few molecules are watched one by one,
    and should collide where they are seen to touch.

    Examples
    --------
    >>> suited(800), suited(30_000)
    ('exact', 'dsmc')
    """
    return "exact" if molecules <= FEW else "dsmc"


def suited_engine(settings: Any) -> str:
    """Return `suited` for settings with a number of molecules: the ``usual_engine`` of scenes of thin gas."""
    return suited(settings.molecules)


def used(dataset: xr.Dataset) -> EngineChoice:
    """Return the engine that made a dataset; of one that was in steps in an earlier version, only what still exists.

    Raises
    ------
    SettingError
        If there never was such an engine.
    """
    made = str(json.loads(dataset.attrs.get("atmosbox_parameters", "{}")).get("engine", "exact"))
    try:
        return choose(made)
    except SettingError:
        if made.partition(":")[0] not in ("classic", "stepped"):
            raise
        return choose("stepped:collisions=off" if "collisions=off" in made else "stepped")


EXACT = EngineChoice(ENGINES["exact"])
"""The engine of a scene that names no other, unless the user asks for another."""

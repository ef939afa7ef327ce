"""The grid of a sweep: its points, its members, and the seed of each."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from atmosbox import scenarios
from atmosbox.errors import Option, Setting, SettingError
from atmosbox.scene.settings import Parameter, Value, by_name
from atmosbox.simulation.preparation import Prepared, prepare
from atmosbox.simulation.restart import described
from atmosbox.sweep.axis import Axis, parse_vary
from atmosbox.sweep.member import Task

__all__ = ["MOST_RUNS", "Plan", "member_seed", "plan"]

MOST_RUNS = 100_000
"""Greatest number of runs of one sweep."""
_MEMBERS = Parameter("members", "1", 8, 1, 1_000_000, kind="int", given_as=Option)


def member_seed(seed: int, point: int, member: int) -> int:
    """Return the seed of one member at one point of a sweep.

    It depends only on these three numbers: ``numpy.random.SeedSequence(seed, spawn_key=(point, member))`` gives 64
    bits, the upper 53 of which are the seed. Every program can represent an integer of 53 bits.

    Parameters
    ----------
    seed
        The seed of the sweep.
    point, member
        Numbers of the point and of the member, counted from 1.

    Examples
    --------
    >>> member_seed(1, 1, 1), member_seed(1, 1, 2)
    (5212123061052596, 6512128350003616)
    """
    state = np.random.SeedSequence(seed, spawn_key=(point, member)).generate_state(1, np.uint64)
    return int(state[0]) >> 11


@dataclass(frozen=True)
class Plan:
    """A sweep that is checked and ready to run.

    Parameters
    ----------
    scene
        The name of the scene, or the path of its file.
    axes
        The settings that vary.
    settings
        The settings that were given for all runs, in their documented units.
    members
        Number of runs at each point.
    seed
        The seed of the sweep.
    engine, accuracy
        The engine with its options and the accuracy, as they were asked for.
    prepared
        The scene at each point.

    Examples
    --------
    >>> grid = plan("temperature", ["temperature=0degC:40degC:3", "molecules=100,200"], members=4)
    >>> grid.shape, grid.runs, grid.values(2)
    ((3, 2), 24, {'temperature': 0.0, 'molecules': 200})
    """

    scene: str
    axes: tuple[Axis, ...]
    settings: Mapping[str, Value]
    members: int
    seed: int
    engine: str | None
    accuracy: str | None
    prepared: list[Prepared] = field(default_factory=list)

    @property
    def title(self) -> str:
        """The title of the scene."""
        return str(getattr(self.prepared[0].module, "title", self.scene))

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each setting that varies."""
        return tuple(len(axis.values) for axis in self.axes)

    @property
    def points(self) -> int:
        """Number of points of the grid."""
        return math.prod(self.shape)

    @property
    def runs(self) -> int:
        """Number of runs."""
        return self.points * self.members

    @property
    def engines(self) -> tuple[str, ...]:
        """The engine with its options at each point."""
        return tuple(str(each.engine) for each in self.prepared)

    @property
    def defaults(self) -> dict[str, Value]:
        """All settings that do not vary, in their documented units."""
        found = {**self.prepared[0].settings.as_dict(), "seed": self.seed}
        return {name: value for name, value in found.items() if name not in (axis.name for axis in self.axes)}

    def values(self, point: int) -> dict[str, Value]:
        """Return the values of the varied settings at a point; points count from 1."""
        place = np.unravel_index(point - 1, self.shape)
        return {axis.name: axis.values[int(k)] for axis, k in zip(self.axes, place, strict=True)}

    def typed(self, point: int) -> tuple[str, ...]:
        """Return the values of the varied settings at a point, as they are typed."""
        return tuple(
            axis.parameter.typed(value) for axis, value in zip(self.axes, self.values(point).values(), strict=True)
        )

    def named(self, point: int) -> str:
        """Return a point as text.

        Examples
        --------
        >>> plan("temperature", ["temperature=0degC,25degC"]).named(2)
        'temperature=25degC'
        """
        return ", ".join(f"{axis.name}={text}" for axis, text in zip(self.axes, self.typed(point), strict=True))

    def tasks(self, folder: Path) -> list[Task]:
        """Return the runs in the order in which they begin: the first member of every point, then the second."""
        own = self.scene not in scenarios.names()
        scene = os.path.abspath(self.scene) if own else self.scene
        return [
            Task(
                point,
                member,
                scene,
                {**self.settings, **self.values(point), "seed": member_seed(self.seed, point, member)},
                self.engine,
                self.accuracy,
                str(folder.absolute() / f"{point}-{member}.nc"),
            )
            for member in range(1, self.members + 1)
            for point in range(1, self.points + 1)
        ]

    def request(self) -> dict[str, Any]:
        """Return all that determines the runs, by names for messages, in types that JSON can hold."""
        types = {p.name: p for p in scenarios.load(self.scene).Settings.describe()}
        words = described(self.prepared[0])
        del words["settings"]
        words |= {"scene": self.scene, "engine": self.engines, "accuracy": self.accuracy, "seed": self.seed}
        words |= {f"setting {name}": types[name].typed(value) for name, value in self.settings.items()}
        words["vary"] = [f"{axis.name}={','.join(map(axis.parameter.typed, axis.values))}" for axis in self.axes]
        values = [*self.settings.values(), *(value for axis in self.axes for value in axis.values)]
        files = sorted(value for value in values if isinstance(value, str) and os.path.isfile(value))
        return words | {f"content of {name}": hashlib.sha256(Path(name).read_bytes()).hexdigest() for name in files}


def plan(
    scene: str | os.PathLike[str],
    vary: Iterable[str],
    *,
    settings: Mapping[str, Any] | None = None,
    members: int | str = 1,
    seed: int | str | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
) -> Plan:
    """Check a sweep and return its plan; nothing is computed yet.

    Parameters
    ----------
    scene
        A name that `atmosbox.scenarios.names` lists, or the path of a file of your own.
    vary
        The texts after each ``--vary``, see `parse_vary`.
    settings
        Settings for all runs.
    members
        Number of runs at each point.
    seed
        The seed of the sweep; by default that of the settings.
    engine, accuracy
        As for `atmosbox.simulation.preparation.prepare`.

    Returns
    -------
    Plan
        The plan, which `sweep` runs.

    Raises
    ------
    AtmosboxError
        If the scene is unknown, or a setting is refused at any point.

    Examples
    --------
    >>> plan("temperature", ["temperature=0degC:40degC:5"], settings={"temperature": 3})
    Traceback (most recent call last):
    atmosbox.errors.SettingError: temperature = 3.0 is varied, too: leave out temperature or vary={"temperature": ...}.
    """
    text = os.fspath(scene)
    text = text.replace("_", "-") if text.replace("_", "-") in scenarios.names() else text
    declared = scenarios.load(text).Settings
    types = {p.name: p for p in declared.describe()}
    given = by_name(settings or {}, types)
    axes = parse_vary(vary, declared)
    if not axes:
        example = Option("vary", {"molecules": "100,200"})
        raise SettingError("vary", None, "is not given", Option("vary", {"name": "a:b:n"}), ", such as ", example)
    fixed = {name: types[name].parse(value) for name, value in given.items()}
    own = fixed.pop("seed", types["seed"].default)
    chosen = int(types["seed"].parse(own if seed is None else seed))
    several = int(_MEMBERS.parse(members))
    for name in fixed.keys() & {axis.name for axis in axes}:
        fix = ("leave out ", Setting(name), " or ", Option("vary", {name: None}))
        raise SettingError(name, fixed[name], "is varied, too", *fix)
    made = Plan(text, axes, fixed, several, chosen, engine, accuracy)
    if made.runs > MOST_RUNS:
        raise SettingError("sweep", None, f"has {made.runs} runs, more than {MOST_RUNS}", "vary fewer values")
    for point in range(1, made.points + 1):
        try:
            made.prepared.append(prepare(text, {**fixed, **made.values(point)}, engine=engine, accuracy=accuracy))
        except SettingError as error:
            error.problem += f" (at {made.named(point)})"
            raise
    return made

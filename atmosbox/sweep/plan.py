"""The grid of a sweep: its points, its members, and the seed of each."""

from __future__ import annotations

import functools
import hashlib
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from atmosbox import scenarios
from atmosbox.errors import SettingError, UnknownSettingError
from atmosbox.scene.parameter import Value
from atmosbox.simulation.preparation import Prepared, prepare
from atmosbox.sweep.axis import Axis, parse_vary
from atmosbox.version import __version__

__all__ = ["MOST_RUNS", "Plan", "Task", "member_seed", "plan"]

MOST_RUNS = 100_000
"""Greatest number of runs of one sweep."""


class Task(NamedTuple):
    """One run of a sweep, as it is sent to the process that computes it.

    ``point`` and ``member`` count from 1; the last of the varied settings varies fastest from point to point. ``state``
    is the file in which the run saves its state; None if it saves none.
    """

    point: int
    member: int
    scene: str
    settings: dict[str, Value]
    engine: str | None
    accuracy: str | None
    state: str | None = None


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
    title
        The title of the scene.
    axes
        The settings that vary.
    settings
        The settings that were given for all runs, in their documented units.
    defaults
        All settings that do not vary, in their documented units.
    members
        Number of runs at each point.
    seed
        The seed of the sweep.
    engine, accuracy
        The engine with its options, None if the accuracy decides it or the points have different engines; and the
        accuracy that was asked for.
    engines
        The engine with its options at each point; empty where the settings are refused.
    refused
        The reason why there is no run at a point, by the number of the point.

    Examples
    --------
    >>> grid = plan("temperature", ["temperature=0degC:40degC:3", "molecules=100,200"], members=4)
    >>> grid.shape, grid.runs, grid.values(2)
    ((3, 2), 24, {'temperature': 0.0, 'molecules': 200})
    """

    scene: str
    title: str
    axes: tuple[Axis, ...]
    settings: Mapping[str, Value]
    defaults: Mapping[str, Value]
    members: int
    seed: int
    engine: str | None
    accuracy: str | None
    engines: tuple[str, ...]
    refused: Mapping[int, str] = field(default_factory=dict)

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

    def values(self, point: int) -> dict[str, Value]:
        """Return the values of the varied settings at a point; points count from 1."""
        place = np.unravel_index(point - 1, self.shape)
        return {axis.name: axis.values[int(k)] for axis, k in zip(self.axes, place, strict=True)}

    def typed(self, point: int) -> tuple[str, ...]:
        """Return the values of the varied settings at a point, as they are typed."""
        place = np.unravel_index(point - 1, self.shape)
        return tuple(axis.typed(int(k)) for axis, k in zip(self.axes, place, strict=True))

    def named(self, point: int) -> str:
        """Return a point as text.

        Examples
        --------
        >>> plan("temperature", ["temperature=0degC,25degC"]).named(2)
        'temperature=25degC'
        """
        return ", ".join(f"{axis.name}={text}" for axis, text in zip(self.axes, self.typed(point), strict=True))

    def tasks(self) -> list[Task]:
        """Return the runs in the order in which they begin: the first member of every point, then the second."""
        scene = os.path.abspath(self.scene) if self.source is not None else self.scene
        return [
            Task(
                point,
                member,
                scene,
                {**self.settings, **self.values(point), "seed": member_seed(self.seed, point, member)},
                self.engine,
                self.accuracy,
            )
            for member in range(1, self.members + 1)
            for point in range(1, self.points + 1)
            if point not in self.refused
        ]

    @functools.cached_property
    def source(self) -> Path | None:
        """The file of a scene that is given by its path; None for a scene that comes with atmosbox."""
        return None if self.scene in scenarios.names() else Path(self.scene)

    def request(self) -> dict[str, Any]:
        """Return all that determines the results of the sweep, by names for messages, in types that JSON can hold."""
        words: dict[str, Any] = {"version of atmosbox": __version__, "scene": self.scene}
        words |= {f"--vary {axis.name}": [axis.typed(k) for k in range(len(axis.values))] for axis in self.axes}
        words["order of --vary"] = [axis.name for axis in self.axes]
        types = {p.name: p for p in scenarios.load(self.scene).Settings.describe()}
        words |= {f"--set {name}": types[name].typed(value) for name, value in self.settings.items()}
        words |= {"--engine": self.engine, "--accuracy": self.accuracy}
        words |= {"--members": self.members, "--seed": self.seed}
        values = [*self.settings.values(), *(value for axis in self.axes for value in axis.values)]
        files = {value for value in values if isinstance(value, str)}
        if self.source is not None:
            files.add(str(self.source))
        return words | {f"content of {name}": _digest(name) for name in sorted(files) if os.path.isfile(name)}


def _digest(path: str) -> str:
    """Return a digest of the content of a file."""
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()


def plan(
    scene: str | os.PathLike[str],
    vary: Iterable[str],
    *,
    settings: Mapping[str, Any] | None = None,
    members: int = 1,
    seed: int | None = None,
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
        The plan, which `sweep` runs. It includes points whose settings are refused, with the reason.

    Raises
    ------
    AtmosboxError
        If the scene is unknown, a setting is refused, or no point can run.

    Examples
    --------
    >>> plan("temperature", ["temperature=0degC:40degC:5"], settings={"temperature": 3})
    Traceback (most recent call last):
    atmosbox.errors.SettingError: --set temperature is varied, too: leave out --set temperature or --vary temperature.
    """
    text = os.fspath(scene)
    types = {p.name: p for p in scenarios.load(scene).Settings.describe()}
    given = {name.strip().replace("-", "_"): value for name, value in (settings or {}).items()}
    vary = list(vary)
    _check_known(text, types, vary, given)
    axes = parse_vary(vary, types)
    if not axes:
        raise SettingError("--vary", None, "is not given", "give --vary name=a:b:n, such as --vary molecules=100,200")
    fixed = {name: types[name].parse(value) for name, value in given.items()}
    own = fixed.pop("seed", types["seed"].default)
    chosen = int(types["seed"].parse(own if seed is None else seed))
    runs = math.prod(len(axis.values) for axis in axes) * members
    if members < 1:
        raise SettingError("members", members, "is fewer than one run at each point", "give --members 8")
    if runs > MOST_RUNS:
        raise SettingError("sweep", None, f"has {runs} runs, more than {MOST_RUNS}", "vary fewer values")
    for name in fixed:
        if name in (axis.name for axis in axes):
            fix = f"leave out --set {name} or --vary {name}"
            raise SettingError(f"--set {name}", None, "is varied, too", fix)
    draft = Plan(text, text, axes, fixed, {}, members, chosen, engine, accuracy, ())
    prepared, refused = _prepared(draft)
    first = next(iter(prepared.values()))
    kept = {name: value for name, value in first.settings.as_dict().items() if name not in (a.name for a in axes)}
    return Plan(
        first.scene,
        getattr(first.module, "title", first.scene),
        axes,
        fixed,
        kept | {"seed": chosen},
        members,
        chosen,
        str(first.engine) if accuracy is None and len({str(each.engine) for each in prepared.values()}) == 1 else None,
        accuracy,
        tuple(str(prepared[k].engine) if k in prepared else "" for k in range(1, draft.points + 1)),
        refused,
    )


def _check_known(scene: str, types: Mapping[str, Any], vary: Sequence[str], given: Mapping[str, Any]) -> None:
    """Refuse a setting that the scene does not have; the error names the most similar one that it has."""
    settings = scenarios.load(scene).Settings
    for name, value in given.items():
        if name not in types:
            settings.from_user({name: value})
    for item in vary:
        name, equals, text = (part.strip() for part in item.partition("="))
        if equals and name and name.replace("-", "_") not in types:
            try:
                settings.from_user({name: text})
            except UnknownSettingError as error:
                error.fix = error.fix.replace("--set ", "--vary ")
                raise


def _prepared(draft: Plan) -> tuple[dict[int, Prepared], dict[int, str]]:
    """Return the prepared scene at each point, and the reason at each point whose settings are refused."""
    prepared: dict[int, Prepared] = {}
    refused: dict[int, str] = {}
    first: SettingError | None = None
    for point in range(1, draft.points + 1):
        settings = {**draft.settings, **draft.values(point)}
        try:
            prepared[point] = prepare(draft.scene, settings, engine=draft.engine, accuracy=draft.accuracy)
        except SettingError as error:
            refused[point] = str(error)
            first = first or error
    if first is not None and not prepared:
        raise first
    return prepared, refused

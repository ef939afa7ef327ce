"""What a sweep runs: the settings that vary, the points of their grid, its members, and the seed of each."""

import hashlib
import itertools
import math
import os
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from atmosbox import scenarios
from atmosbox.errors import Option, Setting, SettingError, UnitError, UnknownSettingError
from atmosbox.scene.conversion import from_si, to_si
from atmosbox.scene.settings import Parameter, SceneSettings, Value, by_name
from atmosbox.scene.spelling import field_name
from atmosbox.simulation.preparation import Prepared, prepare
from atmosbox.simulation.restart import described

MOST_RUNS = 100_000
"""Greatest number of runs of one sweep."""
_MEMBERS = Parameter("members", "1", 8, 1, 1_000_000, kind="int", given_as=Option)


def parse_vary(items: Iterable[str], settings: type[SceneSettings]) -> dict[str, tuple[Value, ...]]:
    """Return the settings that vary, from the texts after each ``--vary``.

    A text is ``name=a:b:n`` for n values from a to b with equal differences, ``name=a:b:nlog`` for n values with equal
    ratios, or ``name=x,y,z`` for these values, in ascending order. Numbers may have units as after ``--set``.

    Examples
    --------
    >>> from atmosbox import scenarios
    >>> parse_vary(["molecules=100:10000:3log", "start=equal,maxwell"], scenarios.load("temperature").Settings)
    {'molecules': (100, 1000, 10000), 'start': ('equal', 'maxwell')}
    """
    parameters = {p.name: p for p in settings.describe()}
    made: dict[str, tuple[Value, ...]] = {}
    for item in items:
        name, _, text = (part.strip() for part in item.partition("="))
        name = field_name(name)
        if not (name and text):
            raise SettingError("vary", item, "has no name or no values", Option("vary", {name or "name": "a:b:n"}))
        if name == "seed":
            raise SettingError("seed", text, "is what the members vary already", Option("members", 8), " instead")
        if name in made:
            raise SettingError(name, text, "is varied twice", Option("vary", {name: None}), " once")
        try:
            by_name({name: text}, parameters)  # raises the error that names the most similar setting
            made[name] = _values(text, parameters[name])
        except UnknownSettingError as error:
            error.instead_of_settings(lambda part: Option("vary", {part.name: str(part.value)}))
            raise
        except SettingError as error:
            error.remedy = (_instead(parameters[name]),)
            raise
    return made


def _instead(parameter: Parameter) -> Option:
    """Return what to give instead."""
    words = ("on", "off") if parameter.kind == "bool" else parameter.choices or (str(parameter.default),)
    return Option("vary", {parameter.name: "a:b:n" if parameter.kind in ("int", "float") else ",".join(words)})


def _values(text: str, parameter: Parameter) -> tuple[Value, ...]:
    """Return the values in a text after "="; numbers in ascending order."""
    numeric = parameter.kind in ("int", "float")
    if numeric and ":" in text:
        return _row(text, parameter)
    values = [parameter.parse(part.strip()) for part in text.split(",")]
    if len(set(values)) < len(values):
        raise SettingError(parameter.name, text, "names a value twice")
    return tuple(sorted(values, key=float) if numeric else values)


def _row(text: str, parameter: Parameter) -> tuple[Value, ...]:
    """Return n values from a to b for the text a:b:n or a:b:nlog."""
    *ends, last = (part.strip() for part in text.split(":"))
    count = last.removesuffix("log").rstrip()
    if len(ends) != 2 or not count.isdecimal() or not 2 <= int(count[:7]) <= MOST_RUNS:
        raise UnitError(parameter.name, text, f"is neither a:b:n, with n from 2 to {MOST_RUNS}, a:b:nlog nor x,y,z")
    n = int(count)
    low, high = sorted(float(parameter.parse(end)) for end in ends)
    if not last.endswith("log"):
        inner = np.linspace(low, high, n)[1:-1].tolist()
    elif (start := to_si(low, parameter.unit)) > 0.0:
        inner = np.geomspace(start, to_si(high, parameter.unit), n)[1:-1].tolist()
        inner = [from_si(value, parameter.unit) for value in inner]
    else:
        raise SettingError(parameter.name, text, "begins at or below zero, and equal ratios need values above zero")
    values = [low, *(float(f"{value:.12g}") for value in inner), high]
    values = [round(value) for value in values] if parameter.kind == "int" else values
    if len(set(values)) < n:
        raise SettingError(parameter.name, text, f"has only {len(set(values))} different values, not {n}")
    return tuple(values)


def member_seed(seed: int, point: int, member: int) -> int:
    """Return the seed of one member at one point of a sweep, both counted from 1.

    It depends only on these three numbers: ``numpy.random.SeedSequence(seed, spawn_key=(point, member))`` gives 64
    bits, the upper 53 of which are the seed. Every program can represent an integer of 53 bits.

    Examples
    --------
    >>> member_seed(1, 1, 1), member_seed(1, 1, 2)
    (5212123061052596, 6512128350003616)
    """
    state = np.random.SeedSequence(seed, spawn_key=(point, member)).generate_state(1, np.uint64)
    return int(state[0]) >> 11


class Task(NamedTuple):
    """One run of a sweep, as it is sent to the process that computes it.

    ``point`` and ``member`` count from 1; ``path`` is the file that the run writes, ``asked`` the arguments of
    `prepare`.
    """

    point: int
    member: int
    path: str
    asked: dict[str, Any]


class Plan(NamedTuple):
    """A sweep that is checked and ready to run.

    Parameters
    ----------
    scene
        The name of the scene, or the path of its file.
    vary
        The values of the settings that vary.
    settings
        The settings that were given for all runs, in their documented units.
    members
        Number of runs at each point.
    seed
        The seed of the sweep.
    engine, accuracy
        The engine with its options and the accuracy, as they were asked for.
    prepared
        The scene at each point; the last of the varied settings varies fastest from point to point.

    Examples
    --------
    >>> grid = plan("temperature", ["temperature=0degC:40degC:3", "molecules=100,200"], members=4)
    >>> grid.runs, grid.values(2)
    (24, {'temperature': 0.0, 'molecules': 200})
    """

    scene: str
    vary: Mapping[str, tuple[Value, ...]]
    settings: Mapping[str, Value]
    members: int
    seed: int
    engine: str | None
    accuracy: str | None
    prepared: tuple[Prepared, ...]

    @property
    def title(self) -> str:
        """The title of the scene."""
        return str(getattr(self.prepared[0].module, "title", self.scene))

    @property
    def parameters(self) -> dict[str, Parameter]:
        """The settings of the scene as they were declared."""
        return {p.name: p for p in self.prepared[0].settings.describe()}

    @property
    def runs(self) -> int:
        """Number of runs."""
        return len(self.prepared) * self.members

    @property
    def defaults(self) -> dict[str, Value]:
        """All settings that do not vary, in their documented units."""
        found = {**self.prepared[0].settings.as_dict(), "seed": self.seed}
        return {name: value for name, value in found.items() if name not in self.vary}

    def values(self, point: int) -> dict[str, Value]:
        """Return the values of the varied settings at a point; points count from 1."""
        settings = self.prepared[point - 1].settings.as_dict()
        return {name: settings[name] for name in self.vary}

    def typed(self, point: int) -> list[str]:
        """Return the values of the varied settings at a point, as they are typed.

        Examples
        --------
        >>> plan("temperature", ["temperature=0degC,25degC"]).typed(2)
        ['25degC']
        """
        return [self.parameters[name].typed(value) for name, value in self.values(point).items()]

    def tasks(self, folder: Path) -> list[Task]:
        """Return the runs in the order in which they begin: the first member of every point, then the second."""
        scene = self.scene if self.scene in scenarios.names() else os.path.abspath(self.scene)
        made = []
        for member, point in itertools.product(range(1, self.members + 1), range(1, len(self.prepared) + 1)):
            settings = {**self.settings, **self.values(point), "seed": member_seed(self.seed, point, member)}
            asked = {"scene": scene, "settings": settings, "engine": self.engine, "accuracy": self.accuracy}
            made.append(Task(point, member, str(folder.absolute() / f"{point}-{member}.nc"), asked))
        return made

    def request(self) -> dict[str, Any]:
        """Return all that determines the runs, by names for messages, in types that JSON can hold."""
        made = described(self.prepared[0])
        made |= {"scene": self.scene, "engine": [str(each.engine) for each in self.prepared], "accuracy": self.accuracy}
        made["vary"] = {name: list(values) for name, values in self.vary.items()}
        del made["settings"]
        made |= {f"setting {name}": value for name, value in self.defaults.items()}
        values = itertools.chain(self.defaults.values(), *self.vary.values())
        files = sorted(value for value in values if isinstance(value, str) and os.path.isfile(value))
        return made | {f"content of {name}": hashlib.sha256(Path(name).read_bytes()).hexdigest() for name in files}


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
    settings, engine, accuracy
        Those of all runs, as for `atmosbox.simulation.preparation.prepare`.
    members
        Number of runs at each point.
    seed
        The seed of the sweep; by default that of the settings.

    Examples
    --------
    >>> plan("temperature", ["temperature=0degC:40degC:5"], settings={"temperature": 3})
    Traceback (most recent call last):
    atmosbox.errors.SettingError: temperature = 3.0 is varied, too: leave out temperature or vary={"temperature": ...}.
    """
    declared = scenarios.load(scene).Settings
    types = {p.name: p for p in declared.describe()}
    varied = parse_vary(vary, declared)
    if not varied:
        example = Option("vary", {"molecules": "100,200"})
        raise SettingError("vary", None, "is not given", Option("vary", {"name": "a:b:n"}), ", such as ", example)
    fixed = {name: types[name].parse(value) for name, value in by_name(settings or {}, types).items()}
    for name in fixed.keys() & varied.keys():
        fix = ("leave out ", Setting(name), " or ", Option("vary", {name: None}))
        raise SettingError(name, fixed[name], "is varied, too", *fix)
    own = fixed.pop("seed", types["seed"].default)
    chosen = int(types["seed"].parse(own if seed is None else seed))
    several = int(_MEMBERS.parse(members))
    runs = several * math.prod(map(len, varied.values()))
    if runs > MOST_RUNS:
        raise SettingError("sweep", None, f"has {runs} runs, more than {MOST_RUNS}", "vary fewer values")
    prepared = []
    for values in itertools.product(*varied.values()):
        here = dict(zip(varied, values, strict=True))
        try:
            prepared.append(prepare(scene, {**fixed, **here}, engine=engine, accuracy=accuracy))
        except SettingError as error:
            error.problem += f" (at {', '.join(f'{name}={value}' for name, value in here.items())})"
            raise
    return Plan(prepared[0].scene, varied, fixed, several, chosen, engine, accuracy, tuple(prepared))

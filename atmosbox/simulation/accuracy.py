"""How accurate a run will be: a table of measured errors, and the cheapest run that is accurate enough.

Every scene that can be compared with theory was run on several engines and with several settings, with many seeds each.
The table that comes with atmosbox, ``accuracy.json``, holds for each of these runs the error of every headline and the
cost, as a ratio to the scene's default run. ``python benchmarks/accuracy.py`` measures it again.
"""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from atmosbox.errors import Option, SettingError
from atmosbox.scene.target import FIX, TARGETS, Target, parse


class ExpectedError(NamedTuple):
    """The measured error of a headline: in K if ``unit`` is K, else as a share of the theory.

    ``bias`` is the mean difference from theory and ``bias_se`` its standard error, ``noise`` the standard deviation of
    a single run, and ``theory`` the value of the theory [SI].
    """

    unit: str
    bias: float
    bias_se: float
    noise: float
    theory: float

    @property
    def total(self) -> float:
        """Root mean square error to expect of a single run, with the standard error of the bias in full."""
        return math.hypot(self.bias, self.bias_se, self.noise)

    def size(self, theory: float | None) -> float:
        """Return the factor from this error to that of a headline [SI], for the value of the theory in a run."""
        return 1.0 if self.unit == "K" else abs(theory or 0.0)

    def excess(self, target: Target) -> float:
        """Return the error as a multiple of what a target allows; 0 if the target sets no limit."""
        if self.unit != "K":
            return self.total / target.share
        relative = self.total / abs(self.theory) / target.share if target.absolute else 0.0
        return max(self.total / target.kelvin, relative)


@dataclass(frozen=True)
class Measured:
    """A run of a scene, made ``members`` times with different seeds, whose errors were measured.

    ``settings`` are those that differ from the scene's defaults, ``cost`` is the processor time of the engine as a
    multiple of that in the scene's default run, and ``errors`` are those of the headlines, by name.
    """

    engine: str
    settings: Mapping[str, Any]
    cost: float
    members: int
    errors: Mapping[str, ExpectedError]

    @property
    def label(self) -> str:
        """The engine and the settings of this run, in words."""
        return ", ".join([self.engine, *(said(name, value) for name, value in self.settings.items())])

    def excess(self, target: Target) -> float:
        """Return the largest error as a multiple of what a target allows."""
        return max((error.excess(target) for error in self.errors.values()), default=math.inf)


@dataclass(frozen=True)
class Table:
    """The measurements of one scene: the runs, and the labels of their headlines by name.

    ``varies`` are the settings that trade accuracy for time; any other setting makes a different experiment. ``how``
    tells how they were measured: the version, the budget [s], the command, and the time of the default run [s].
    """

    varies: tuple[str, ...]
    labels: Mapping[str, str]
    ways: tuple[Measured, ...]
    how: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Table:
        """Return the table from its entry in the file."""
        about, ways = entry["headlines"], []
        for way in entry["ways"]:
            errors = {
                name: ExpectedError(about[name]["unit"], bias, bias_se, noise, about[name]["theory"])
                for name, (bias, bias_se, noise) in way["errors"].items()
            }
            ways.append(Measured(way["engine"], way["settings"], way["cost"], way["members"], errors))
        labels = {name: one["label"] for name, one in about.items()}
        return cls(tuple(entry["varies"]), labels, tuple(ways), entry["measured"])

    def same_experiment(self, settings: Mapping[str, Any]) -> tuple[Measured, ...]:
        """Return the measured runs of the experiment that a user has set, as far as the table distinguishes it.

        Another switch or word makes another experiment; among different numbers, those runs count that agree in most of
        them.
        """
        apart = {name: value for way in self.ways for name, value in way.settings.items() if name not in self.varies}
        other = {name for name, value in apart.items() if isinstance(value, bool | str)}

        def misses(way: Measured, names: set[str]) -> int:
            return sum(way.settings.get(name) != settings.get(name) for name in names)

        same = [way for way in self.ways if not misses(way, other)]
        fewest = min((misses(way, set(apart)) for way in same), default=0)
        return tuple(way for way in same if misses(way, set(apart)) == fewest)


@functools.cache
def load() -> Mapping[str, Table]:
    """Return the measured table that comes with atmosbox, by scene."""
    held = json.loads(Path(__file__).with_name("accuracy.json").read_text(encoding="utf-8"))
    return MappingProxyType({scene: Table.of(entry) for scene, entry in held["scenes"].items()})


def said(name: str, value: bool | int | float | str) -> str:
    """Return a setting as it is typed.

    Examples
    --------
    >>> said("ascent", 400.0), said("plane", True)
    ('ascent=400', 'plane=on')
    """
    if isinstance(value, bool):
        return f"{name}={'on' if value else 'off'}"
    return f"{name}={value:.12g}" if isinstance(value, float) else f"{name}={value}"


@dataclass(frozen=True)
class Expectation:
    """The errors that are expected of a run: those of the measured run ``way``.

    ``sets`` are the chosen values of the settings that trade accuracy for time, ``target`` is the accuracy that the
    user asked for, None if the engine was given; ``met`` is False if nothing that was measured is within it; and
    ``differs`` names the settings in which this run differs from the measured one.
    """

    way: Measured
    labels: Mapping[str, str]
    sets: Mapping[str, Any] = field(default_factory=dict)
    target: Target | None = None
    met: bool = True
    differs: tuple[str, ...] = ()

    def at(self, changed: Mapping[str, Any]) -> Expectation:
        """Return the expectation for a run whose settings differ from the defaults in `changed`."""
        names = sorted((changed.keys() | self.way.settings.keys()) - {"seed"})
        differs = (name for name in names if changed.get(name) != self.way.settings.get(name))
        return replace(self, differs=tuple(differs))

    def as_dict(self) -> dict[str, Any]:
        """Return the expectation as values that JSON can hold."""
        way, errors = self.way, {}
        for name, error in way.errors.items():
            errors[name] = {**error._asdict(), "total": error.total, "label": self.labels[name]}
        wish = None if self.target is None else self.target.text
        made: dict[str, Any] = {"wish": wish, "met": self.met, "engine": way.engine, "settings": dict(way.settings)}
        made |= {"cost": way.cost, "members": way.members}
        return {**made, "differs": list(self.differs), "errors": errors}


def choose(
    scene: str,
    target: str,
    settings: Mapping[str, Any] = MappingProxyType({}),
    why: str = "whose errors were not measured",
) -> Expectation:
    """Return the cheapest measured run of a scene whose expected error is within a target.

    If no run reaches a target with a name, it is the most accurate run; a target given as a number is then refused, and
    so is a scene that was not measured. `settings` are the values that the user has set and that differ from the
    scene's defaults; `why` is why a scene is in no table, as the end of a sentence.

    Examples
    --------
    >>> choose("temperature", "reference").met
    True
    """
    allowed, tables = parse(target), load()

    def refused(problem: str, *fix: Option | str) -> SettingError:
        return SettingError("accuracy", allowed.text, problem, *fix)

    if scene not in tables:
        raise refused(f"is not for {scene}, {why}", f"leave it out, or take one of {', '.join(tables)}")
    table = tables[scene]
    # a run that ends before it reaches a headline satisfies no target
    ways = [way for way in table.same_experiment(settings) if way.errors.keys() >= table.labels.keys()]
    if not ways:
        raise refused(f"is not for {scene} with these settings, at which nothing was measured", "leave it out")
    good = [way for way in ways if way.excess(allowed) <= 1.0]
    best = min(ways, key=lambda way: way.excess(allowed))
    if good and not allowed.best:
        if not any(way.excess(allowed) for way in ways):
            raise refused(f"says nothing of {scene}, which has no temperature", *FIX)
        best = min(good, key=lambda way: way.cost)
    elif allowed.text not in TARGETS:
        reached = best.excess(allowed) * (100.0 * allowed.share if allowed.absolute else allowed.kelvin)
        digits = 1 - math.floor(math.log10(reached))
        enough = math.ceil(reached * 10.0**digits) / 10.0**digits  # never less than the best run reaches
        unit = "%" if allowed.absolute else "K"
        raise refused(
            f"is less than the error of every measured run of {scene}: the most accurate, {best.label}, has "
            f"{reached:.2g} {unit} at {cost(best.cost)}",
            Option("accuracy", f"{enough:.6g}{unit}"), ", or reference"
        )  # fmt: skip
    sets = {name: value for name, value in best.settings.items() if name in table.varies}
    return Expectation(best, table.labels, sets, allowed, met=bool(good) or allowed.best)


def expect(scene: str, engine: str, changed: Mapping[str, Any]) -> Expectation | None:
    """Return the errors expected of an engine at changed settings; None if that run was not measured."""
    table = load().get(scene, Table((), {}, ()))
    same = (Expectation(way, table.labels).at(changed) for way in table.ways if way.engine == engine)
    return next((found for found in same if not found.differs), None)


def cost(ratio: float) -> str:
    """Return a cost in words.

    Examples
    --------
    >>> cost(0.0123), cost(1.0)
    ('0.012 times the cost of the default run', 'the cost of the default run')
    """
    return f"{'' if ratio == 1.0 else f'{ratio:.2g} times '}the cost of the default run"

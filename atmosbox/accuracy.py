"""How accurate a run will be: a table of measured errors, and the cheapest way of running that meets a wish.

Every scene that has something to compare was run through engines and settings with many seeds; the table that comes
with atmosbox, ``accuracy.json``, holds for each of these ways the error of every headline and what a run costs,
as a ratio to the run that the scene makes by default. ``python benchmarks/accuracy.py`` measures it anew.
"""

from __future__ import annotations

import functools
import json
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from atmosbox.errors import SettingError
from atmosbox.spelling import nearest, plain

__all__ = ["TARGETS", "Expectation", "ExpectedError", "Measured", "Table", "Wish", "choose", "expect", "load", "parse"]


class Wish(NamedTuple):
    """How large the expected error of a single run may be.

    Parameters
    ----------
    text
        As a user types it.
    kelvin
        The largest error of a temperature [K]; ``inf`` where there is no limit.
    share
        The largest error of everything else, as a share of the theory; ``inf`` where there is no limit.
    absolute
        Whether `share` holds for temperatures, too, as a share of the absolute temperature.
    best
        Whether the most accurate run is wanted, in units of the two limits, and not the cheapest within them.
    """

    text: str
    kelvin: float = math.inf
    share: float = math.inf
    absolute: bool = False
    best: bool = False

    @property
    def limits(self) -> str:
        """The limits in words."""
        limits = [f"{100.0 * self.share:g} %"] if math.isfinite(self.share) else []
        return " and ".join([*limits, f"{self.kelvin:g} K"] if math.isfinite(self.kelvin) else limits)


TARGETS: Mapping[str, Wish] = MappingProxyType(
    {
        wish.text: wish
        for wish in (
            Wish("sketch", 3.0, 0.05),  # a quick look: on a figure it lies beside the theory
            Wish("lecture", 0.5, 0.01),  # numbers that may be written on a blackboard
            Wish("reference", 0.5, 0.01, best=True),  # whatever it costs, of all that was measured
        )
    }
)
"""The wishes that have a name, the same for all scenes."""

_NUMBER = re.compile(r"([0-9]+\.?[0-9]*(?:e[+-]?[0-9]{1,3})?|\.[0-9]+(?:e[+-]?[0-9]{1,3})?)\s*(\S*)", re.IGNORECASE)
_FIX = "give --accuracy lecture, or an error such as 0.5K or 2%"


class ExpectedError(NamedTuple):
    """The measured error of a headline: in K if ``unit`` is K, else as a share of the theory.

    ``bias`` is the mean misfit to theory and ``bias_se`` its standard error, ``noise`` the standard deviation of a
    single run, and ``theory`` what theory said [SI].
    """

    unit: str
    bias: float
    bias_se: float
    noise: float
    theory: float

    @property
    def total(self) -> float:
        """Root mean square error to expect of a single run.

        What is not known of the bias counts in full.

        Examples
        --------
        >>> ExpectedError("K", 0.3, 0.0, 0.4, 288.0).total
        0.5
        """
        return math.hypot(self.bias, self.bias_se, self.noise)

    def size(self, theory: float | None) -> float:
        """Return one unit of the error in that of a headline [SI], for what theory says in a run."""
        return 1.0 if self.unit == "K" else abs(theory or 0.0)

    def excess(self, wish: Wish) -> float:
        """Return the error as a multiple of what a wish allows; 0 where it has no limit."""
        if self.unit != "K":
            return self.total / wish.share
        relative = self.total / abs(self.theory) / wish.share if wish.absolute else 0.0
        return max(self.total / wish.kelvin, relative)


@dataclass(frozen=True)
class Measured:
    """A way of running a scene whose errors were measured.

    Parameters
    ----------
    engine
        The engine with its options.
    settings
        What differs from the scene's defaults.
    cost
        Processor time of the engine, as a multiple of that in the scene's default run.
    members
        How many runs were made.
    errors
        The error of each headline, by name.
    """

    engine: str
    settings: Mapping[str, Any]
    cost: float
    members: int
    errors: Mapping[str, ExpectedError]

    @property
    def label(self) -> str:
        """The words that ask for this run, but for the scene."""
        return ", ".join([self.engine, *(said(name, value) for name, value in self.settings.items())])

    def excess(self, wish: Wish) -> float:
        """Return the largest error as a multiple of what a wish allows."""
        return max((error.excess(wish) for error in self.errors.values()), default=math.inf)


@dataclass(frozen=True)
class Table:
    """What was measured of a scene.

    Parameters
    ----------
    varies
        The settings that trade accuracy for time; every other makes a different experiment.
    labels
        What a table calls the headlines, by name.
    ways
        The ways of running it.
    how
        How it was measured: the version, the budget [s], the command.
    """

    varies: tuple[str, ...]
    labels: Mapping[str, str]
    ways: tuple[Measured, ...]
    how: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Table:
        """Return the table that an entry of the file is."""
        about = entry["headlines"]
        return cls(
            tuple(entry["varies"]),
            {name: one["label"] for name, one in about.items()},
            tuple(
                Measured(
                    way["engine"],
                    way["settings"],
                    way["cost"],
                    way["members"],
                    {
                        name: ExpectedError(about[name]["unit"], bias, bias_se, noise, about[name]["theory"])
                        for name, (bias, bias_se, noise) in way["errors"].items()
                    },
                )
                for way in entry["ways"]
            ),
            entry["measured"],
        )

    def same_experiment(self, settings: Mapping[str, Any]) -> tuple[Measured, ...]:
        """Return the ways of running the experiment that a user has set, in so far as any of them tells it apart.

        A switch or a word makes another experiment; of numbers, those count that come nearest to the user's.
        """
        apart = {name: value for way in self.ways for name, value in way.settings.items() if name not in self.varies}
        other = {name for name, value in apart.items() if isinstance(value, bool | str)}

        def misses(way: Measured, names: set[str]) -> int:
            return sum(way.settings.get(name) != settings.get(name) for name in names)

        same = [way for way in self.ways if not misses(way, other)]
        fewest = min((misses(way, set(apart)) for way in same), default=0)
        return tuple(way for way in same if misses(way, set(apart)) == fewest)


@dataclass(frozen=True)
class Expectation:
    """What is known beforehand of a run's errors.

    Parameters
    ----------
    way
        The run that was measured.
    sets
        The settings that trade accuracy for time, as they were picked.
    labels
        What a table calls the headlines, by name.
    wish
        What the user wished; None where the engine was given by hand.
    met
        Whether the expected errors are within the wish.
    differs
        The settings in which this run differs from those that were measured.
    """

    way: Measured
    labels: Mapping[str, str]
    sets: Mapping[str, Any] = field(default_factory=dict)
    wish: Wish | None = None
    met: bool = True
    differs: tuple[str, ...] = ()

    def at(self, changed: Mapping[str, Any]) -> Expectation:
        """Return the same for a run whose settings differ from the defaults in `changed`."""
        names = sorted((changed.keys() | self.way.settings.keys()) - {"seed"})
        differs = (name for name in names if changed.get(name) != self.way.settings.get(name))
        return replace(self, differs=tuple(differs))

    def as_dict(self) -> dict[str, Any]:
        """Return it as JSON can hold it."""
        errors = {
            name: {**error._asdict(), "total": error.total, "label": self.labels[name]}
            for name, error in self.way.errors.items()
        }
        return {
            "wish": None if self.wish is None else self.wish.text,
            "met": self.met,
            "engine": self.way.engine,
            "settings": dict(self.way.settings),
            "cost": self.way.cost,
            "members": self.way.members,
            "differs": list(self.differs),
            "errors": errors,
        }


@functools.cache
def load() -> Mapping[str, Table]:
    """Return the measured table that comes with atmosbox, by scene.

    Examples
    --------
    >>> "temperature" in load()
    True
    """
    held = json.loads(Path(__file__).with_suffix(".json").read_text(encoding="utf-8"))
    return MappingProxyType({scene: Table.of(entry) for scene, entry in held["scenes"].items()})


def parse(text: object) -> Wish:
    """Return the wish that a text stands for.

    Parameters
    ----------
    text
        The name of a target, or the largest error of temperatures, ``0.5K``, or of everything as a share, ``2%``.

    Raises
    ------
    SettingError
        If it is neither.

    Examples
    --------
    >>> parse("lecture").limits, parse("0.5 K").kelvin, parse("2%").share
    ('1 % and 0.5 K', 0.5, 0.02)
    """
    if not isinstance(text, str):
        raise SettingError("accuracy", text, "is not a text", _FIX)
    word = text.strip()
    if plain(word) in TARGETS:
        return TARGETS[plain(word)]
    found = _NUMBER.fullmatch(word.replace(",", ".")) if len(word) < 100 else None
    if found is None:
        near = nearest(word, TARGETS)
        problem = f"is neither one of {', '.join(TARGETS)} nor an error"
        raise SettingError("accuracy", text, problem, f"give --accuracy {near}" if near else _FIX)
    size, unit = float(found[1]), found[2]

    def refusal(problem: str, *units: str) -> SettingError:
        fix = " or ".join(f"--accuracy {size:g}{one}" for one in units) if 0.0 < size <= 100.0 else ""
        return SettingError("accuracy", text, problem, f"give {fix}" if fix else _FIX)

    if unit.casefold() in ("degc", "°c", "c", "degf", "°f", "f"):
        raise refusal("is a temperature and not the error of one", "K")
    if unit not in ("K", "k", "%"):
        raise refusal(f"has {'an unknown unit' if unit else 'no unit'}", "K", "%")
    if not 0.0 < size <= (100.0 if unit == "%" else 1000.0):
        raise refusal("is not an error above 0 and of at most " + ("100 %" if unit == "%" else "1000 K"))
    if "," in word:
        raise refusal("is written with a comma", unit)
    name = f"{found[1]}{unit.upper()}"
    return Wish(name, share=size / 100.0, absolute=True) if unit == "%" else Wish(name, kelvin=size)


def choose(
    scene: str,
    wish: str | Wish,
    settings: Mapping[str, Any] | None = None,
    tables: Mapping[str, Table] | None = None,
) -> Expectation:
    """Return the cheapest way of running a scene whose expected error meets a wish.

    Parameters
    ----------
    scene
        The name of a scene.
    wish
        The largest error.
    settings
        What the user has set, by name, in so far as it differs from the scene's defaults.
    tables
        What was measured, by scene; what comes with atmosbox if None.

    Returns
    -------
    Expectation
        The way that was picked. Where none meets a target that has a name it is the most accurate one, and not met.

    Raises
    ------
    SettingError
        If the scene was not measured, or no way of running it is within a number; the sentence says which is best.

    Examples
    --------
    >>> choose("temperature", "reference").met
    True
    """
    wish = wish if isinstance(wish, Wish) else parse(wish)
    tables = load() if tables is None else tables
    if scene not in tables:
        fix = f"leave it out, or take one of {', '.join(tables)}"
        raise SettingError("accuracy", wish.text, f"is not for {scene}, whose errors were not measured", fix)
    table = tables[scene]
    # a run that ends before it comes to a headline meets no wish
    ways = tuple(way for way in table.same_experiment(settings or {}) if way.errors.keys() >= table.labels.keys())
    if not ways:
        problem = f"is not for {scene} with these settings, at which nothing was measured"
        raise SettingError("accuracy", wish.text, problem, "leave it out")
    worst = {id(way): way.excess(wish) for way in ways}
    good = [way for way in ways if worst[id(way)] <= 1.0]

    def picked(way: Measured, met: bool) -> Expectation:
        sets = {name: value for name, value in way.settings.items() if name in table.varies}
        return Expectation(way, table.labels, sets, wish, met)

    if good and not wish.best:
        if not any(worst.values()):
            raise SettingError("accuracy", wish.text, f"says nothing of {scene}, which has no temperature", _FIX)
        return picked(min(good, key=lambda way: way.cost), True)
    best = min(ways, key=lambda way: worst[id(way)])
    if wish.text in TARGETS:
        return picked(best, wish.best)
    reached = worst[id(best)] * (100.0 * wish.share if wish.absolute else wish.kelvin)
    digits = 1 - math.floor(math.log10(reached))
    enough = math.ceil(reached * 10.0**digits) / 10.0**digits  # never less than what is reached
    unit = "%" if wish.absolute else "K"
    raise SettingError(
        "accuracy", wish.text,
        f"is more than any measured run of {scene} reaches: the best, {best.label}, comes to "
        f"{reached:.2g} {unit} at {cost(best.cost)}",
        f"give --accuracy {enough:.6g}{unit}, or reference",
    )  # fmt: skip


def expect(
    scene: str,
    engine: str,
    changed: Mapping[str, Any],
    tables: Mapping[str, Table] | None = None,
) -> Expectation | None:
    """Return what is known of an engine at some settings; None where it was not measured.

    Parameters
    ----------
    scene
        The name of a scene.
    engine
        The engine with its options.
    changed
        What differs from the scene's defaults.
    tables
        What was measured, by scene; what comes with atmosbox if None.
    """
    tables = load() if tables is None else tables
    table = tables.get(scene, Table((), {}, ()))
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


def said(name: str, value: bool | int | float | str) -> str:
    """Return a setting in words.

    Examples
    --------
    >>> said("ascent", 400.0), said("plane", True)
    ('ascent=400', 'plane=on')
    """
    if isinstance(value, bool):
        return f"{name}={'on' if value else 'off'}"
    return f"{name}={value:.12g}" if isinstance(value, float) else f"{name}={value}"

"""The cheapest run of a scene that is accurate enough, and the errors that are expected of a run."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from atmosbox.errors import Option, SettingError
from atmosbox.scene.target import FIX, TARGETS, Target, parse
from atmosbox.simulation.accuracy.measured import Measured, Table, load

__all__ = ["Expectation", "choose", "cost", "expect"]


@dataclass(frozen=True)
class Expectation:
    """The errors that are expected of a run.

    Parameters
    ----------
    way
        The run that was measured.
    sets
        The chosen values of the settings that trade accuracy for time.
    labels
        Labels of the headlines in a table, by name.
    target
        The accuracy that the user asked for; None if the engine was given explicitly.
    met
        Whether the expected errors are within the target.
    differs
        The settings in which this run differs from the one that was measured.
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
        errors = {
            name: {**error._asdict(), "total": error.total, "label": self.labels[name]}
            for name, error in self.way.errors.items()
        }
        return {
            "wish": None if self.target is None else self.target.text,
            "met": self.met,
            "engine": self.way.engine,
            "settings": dict(self.way.settings),
            "cost": self.way.cost,
            "members": self.way.members,
            "differs": list(self.differs),
            "errors": errors,
        }


def choose(
    scene: str,
    target: str | Target,
    settings: Mapping[str, Any] | None = None,
    tables: Mapping[str, Table] | None = None,
    why: str = "whose errors were not measured",
) -> Expectation:
    """Return the cheapest measured run of a scene whose expected error is within a target.

    Parameters
    ----------
    scene
        The name of a scene.
    target
        The largest error.
    settings
        The values that the user has set and that differ from the scene's defaults, by name.
    tables
        The measured tables, by scene; None for those that come with atmosbox.
    why
        Why a scene is in no table, as the end of a sentence.

    Returns
    -------
    Expectation
        The chosen run. If no run reaches a target with a name, it is the most accurate run, and ``met`` is False.

    Raises
    ------
    SettingError
        If the scene was not measured, or no run is within a target given as a number; the sentence names the best run.

    Examples
    --------
    >>> choose("temperature", "reference").met
    True
    """
    target = target if isinstance(target, Target) else parse(target)
    tables = load() if tables is None else tables
    if scene not in tables:
        fix = f"leave it out, or take one of {', '.join(tables)}"
        raise SettingError("accuracy", target.text, f"is not for {scene}, {why}", fix)
    table = tables[scene]
    # a run that ends before it reaches a headline satisfies no target
    ways = tuple(way for way in table.same_experiment(settings or {}) if way.errors.keys() >= table.labels.keys())
    if not ways:
        problem = f"is not for {scene} with these settings, at which nothing was measured"
        raise SettingError("accuracy", target.text, problem, "leave it out")
    worst = {id(way): way.excess(target) for way in ways}
    good = [way for way in ways if worst[id(way)] <= 1.0]

    def picked(way: Measured, met: bool) -> Expectation:
        sets = {name: value for name, value in way.settings.items() if name in table.varies}
        return Expectation(way, table.labels, sets, target, met)

    if good and not target.best:
        if not any(worst.values()):
            raise SettingError("accuracy", target.text, f"says nothing of {scene}, which has no temperature", *FIX)
        return picked(min(good, key=lambda way: way.cost), True)
    best = min(ways, key=lambda way: worst[id(way)])
    if target.text in TARGETS:
        return picked(best, target.best)
    reached = worst[id(best)] * (100.0 * target.share if target.absolute else target.kelvin)
    digits = 1 - math.floor(math.log10(reached))
    enough = math.ceil(reached * 10.0**digits) / 10.0**digits  # never less than the best run reaches
    unit = "%" if target.absolute else "K"
    raise SettingError(
        "accuracy", target.text,
        f"is more than any measured run of {scene} reaches: the best, {best.label}, comes to "
        f"{reached:.2g} {unit} at {cost(best.cost)}",
        Option("accuracy", f"{enough:.6g}{unit}"), ", or reference"
    )  # fmt: skip


def expect(
    scene: str,
    engine: str,
    changed: Mapping[str, Any],
    tables: Mapping[str, Table] | None = None,
) -> Expectation | None:
    """Return the errors expected of an engine at some settings; None if that run was not measured.

    Parameters
    ----------
    scene
        The name of a scene.
    engine
        The engine with its options.
    changed
        The values that differ from the scene's defaults.
    tables
        The measured tables, by scene; None for those that come with atmosbox.
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

"""The cheapest way of running a scene that meets a wish, and what is known of a run beforehand."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from atmosbox.errors import SettingError
from atmosbox.scene.wish import FIX, TARGETS, Wish, parse
from atmosbox.simulation.accuracy.measured import Measured, Table, load

__all__ = ["Expectation", "choose", "cost", "expect"]


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
        What the user wished; None where the engine was given explicitly.
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
            raise SettingError("accuracy", wish.text, f"says nothing of {scene}, which has no temperature", FIX)
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

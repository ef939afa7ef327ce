"""The table of measurements: every measured run of a scene, with its cost and the errors of its headlines."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from atmosbox.scene.target import Target

__all__ = ["FILE", "ExpectedError", "Measured", "Table", "load", "said"]

FILE = Path(__file__).with_name("accuracy.json")
"""The table that comes with atmosbox."""


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
        """Root mean square error to expect of a single run.

        The standard error of the bias is included in full.

        Examples
        --------
        >>> ExpectedError("K", 0.3, 0.0, 0.4, 288.0).total
        0.5
        """
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
    """A run of a scene whose errors were measured.

    Parameters
    ----------
    engine
        The engine with its options.
    settings
        The values that differ from the scene's defaults.
    cost
        Processor time of the engine, as a multiple of that in the scene's default run.
    members
        Number of runs, each with its own seed.
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
        """The engine and the settings of this run, in words."""
        return ", ".join([self.engine, *(said(name, value) for name, value in self.settings.items())])

    def excess(self, target: Target) -> float:
        """Return the largest error as a multiple of what a target allows."""
        return max((error.excess(target) for error in self.errors.values()), default=math.inf)


@dataclass(frozen=True)
class Table:
    """The measurements of one scene.

    Parameters
    ----------
    varies
        The settings that trade accuracy for time; any other setting makes a different experiment.
    labels
        Labels of the headlines in a table, by name.
    ways
        The measured runs.
    how
        How they were measured: the version, the budget [s], the command, and the processor time of the default run [s].
    """

    varies: tuple[str, ...]
    labels: Mapping[str, str]
    ways: tuple[Measured, ...]
    how: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of(cls, entry: Mapping[str, Any]) -> Table:
        """Return the table from its entry in the file."""
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
    """Return the measured table that comes with atmosbox, by scene.

    Examples
    --------
    >>> "temperature" in load()
    True
    """
    held = json.loads(FILE.read_text(encoding="utf-8"))
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

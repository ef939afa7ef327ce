"""A run of a sheet: what is typed for it, what is known of it beforehand, and what it has found."""

from __future__ import annotations

import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from atmosbox.errors import ConfigError, PhysicsError, shown
from atmosbox.scene.conversion import from_si
from atmosbox.scene.headline import Headline
from atmosbox.sheet.sums import Measured, SetNumber
from atmosbox.sheet.text import Change
from atmosbox.simulation import runner

__all__ = ["Trial", "execute", "trials"]

_LETTERS = "ABCD"


@dataclass(frozen=True)
class Trial:
    """A run of a sheet, made or yet to be made.

    Parameters
    ----------
    letter
        What the sheet calls it.
    title
        What is special about it.
    prepared
        The scene with its settings.
    outcome
        What it has found; None before it was made.
    """

    letter: str
    title: str
    prepared: runner.Prepared
    outcome: runner.Outcome | None = None

    @property
    def file(self) -> str:
        """The file that it writes.

        Examples
        --------
        >>> Trial("B", "", runner.prepare("lifting-dry", {})).file
        'lifting-dry-B.nc'
        """
        stem = self.prepared.scene.replace("\\", "/").rpartition("/")[2].removesuffix(".py")
        return f"{stem}-{self.letter}.nc"

    @property
    def command(self) -> str:
        """What to type for it.

        Examples
        --------
        >>> Trial("A", "", runner.prepare("lifting-dry", {"ascent": 50})).command
        'atmosbox run lifting-dry --seed 1 --set ascent=50 --out lifting-dry-A.nc'
        """
        settings, engine = self.prepared.settings, self.prepared.unusual_engine
        known = {p.name: p for p in settings.describe()}
        words = ["atmosbox run", shlex.quote(self.prepared.scene), f"--seed {settings.seed}"]
        words += [f"--set {name}={known[name].typed(v)}" for name, v in settings.changed().items() if name != "seed"]
        words += [f"--engine {shlex.quote(engine)}"] if engine else []
        return " ".join([*words, f"--out {shlex.quote(self.file)}"])

    @property
    def plot_command(self) -> str:
        """What to type for its figure.

        Examples
        --------
        >>> Trial("A", "", runner.prepare("lifting-dry", {})).plot_command
        'atmosbox plot lifting-dry-A.nc'
        """
        return f"atmosbox plot {shlex.quote(self.file)}"

    @property
    def page(self) -> str:
        """The page in which it runs, for a sheet that is done without Python.

        Examples
        --------
        >>> Trial("B", "", runner.prepare("lifting-dry", {})).page
        'lifting-dry-B.html'
        """
        return f"{self.file.removesuffix('.nc')}.html"

    @property
    def headlines(self) -> Mapping[str, Headline]:
        """The numbers that it has found, by name."""
        return {} if self.outcome is None else {each.name: each for each in self.outcome.headlines}

    def fact(self, name: str) -> Any:
        """Return a number that it has found, a setting, or a variable of its file.

        Parameters
        ----------
        name
            Looked for among the headlines, then the settings, then the variables.

        Raises
        ------
        ConfigError
            If nothing has this name, or only a run that was not made.

        Examples
        --------
        >>> Trial("A", "", runner.prepare("lifting-dry", {})).fact("top_pressure")
        300.0
        """
        if name in self.headlines:
            return self._measured[name]
        if name in (settings := self.prepared.settings.as_dict()):
            return SetNumber(settings[name]) if isinstance(settings[name], float) else settings[name]
        if self.outcome is None:
            raise ConfigError(f"{shown(name)} is asked for before run {self.letter} was made: use a setting there")
        if name in self.outcome.dataset.variables:
            return self.outcome.dataset[name].values
        raise ConfigError(f"run {self.letter} does not report {shown(name)}: name a headline, a setting or a variable")

    @cached_property
    def _measured(self) -> dict[str, Measured]:
        """The headlines in their units; one number each, so that a sum knows what it has in common with itself."""
        found = {}
        for name, each in self.headlines.items():
            unit, theory = each.display_unit, each.theory
            error = from_si(each.standard_error, unit, difference=True)
            found[name] = Measured(from_si(each.value, unit), error, None if theory is None else from_si(theory, unit))
        return found


def trials(first: runner.Prepared, changes: Sequence[Change]) -> tuple[Trial, ...]:
    """Return the runs of a sheet: as it comes, and with one thing changed.

    Parameters
    ----------
    first
        The scene with the settings of all.
    changes
        What the others change, with its sums worked out.

    Raises
    ------
    SettingError
        If a changed value is not allowed.
    ConfigError
        If a change changes nothing.

    Examples
    --------
    >>> fast = Change(title="ten times as fast", set={"ascent": 160})
    >>> found = trials(runner.prepare("lifting-dry", {}), [fast])
    >>> [(each.letter, each.fact("ascent")) for each in found]
    [('A', 1600.0), ('B', 160.0)]
    """
    found = [Trial(_LETTERS[0], "as it comes" if not first.settings.changed().keys() - {"seed"} else "as set", first)]
    for letter, change in zip(_LETTERS[1:], changes, strict=False):
        settings = type(first.settings).from_user({**first.settings.as_dict(), **change.set})
        if settings == first.settings:
            same = ", ".join(f"{name}={value}" for name, value in change.set.items())
            raise ConfigError(f"Run {letter} of this sheet sets {same}, and so does run A: set run A otherwise.")
        found.append(Trial(letter, change.title, replace(first, settings=settings)))
    return tuple(found)


def execute(asked: Sequence[Trial], progress: Callable[[float, str], None] | None = None) -> tuple[Trial, ...]:
    """Make the runs of a sheet.

    Parameters
    ----------
    asked
        The runs.
    progress
        Called with the share that is done and a word on what goes on.

    Raises
    ------
    PhysicsError
        If the energy of a run is not accounted for.
    EngineError
        If the engine cannot go on.

    Examples
    --------
    >>> (made,) = execute(trials(runner.prepare("elastic-collisions", {"duration": "2 s"}), []))
    >>> made.fact("largest_energy_change").theory
    0.0
    """
    made = []
    for number, trial in enumerate(asked):

        def show(share: float, word: str, before: int = number) -> None:
            if progress is not None:
                progress((before + share) / len(asked), word)

        outcome = runner.execute(trial.prepared, progress=show, command=trial.command)
        if not outcome.ledger <= runner.LEDGER_LIMIT:
            raise PhysicsError(
                f"The energy ledger of run {trial.letter} is off by {outcome.ledger:.0e}, "
                f"more than {runner.LEDGER_LIMIT:.0e}: no sheet is made of it."
            )
        made.append(replace(trial, outcome=outcome))
    return tuple(made)

"""A run of a sheet: the command for it, its settings, and its results."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from atmosbox.errors import Command, ConfigError, Option, Setting, on_command_line, shown
from atmosbox.scene.conversion import from_si
from atmosbox.scene.headline import Headline
from atmosbox.sheet.sums import Measured, SetNumber
from atmosbox.simulation import runner
from atmosbox.simulation.verification import check_ledger

_LETTERS = "ABCD"


@dataclass(frozen=True)
class Trial:
    """A run of a sheet: its letter, what differs in it, the scene with its settings, and its results.

    The ``outcome`` is None before the run was made.
    """

    letter: str
    title: str
    prepared: runner.Prepared
    outcome: runner.Outcome | None = None

    @property
    def file(self) -> str:
        """Name of the file that it writes."""
        stem = self.prepared.scene.replace("\\", "/").rpartition("/")[2].removesuffix(".py")
        return f"{stem}-{self.letter}.nc"

    @property
    def command(self) -> str:
        """The command that makes it.

        >>> Trial("A", "", runner.prepare("lifting-dry", {"ascent": 50})).command
        'atmosbox run lifting-dry --seed 1 --set ascent=50 --out lifting-dry-A.nc'
        """
        settings, engine = self.prepared.settings, self.prepared.unusual_engine
        known = {p.name: p for p in settings.describe()}
        changed = [Setting(name, known[name].typed(v)) for name, v in settings.changed().items() if name != "seed"]
        last = [*([Option("engine", engine)] if engine else []), Option("out", self.file)]
        return on_command_line(Command("run", (self.prepared.scene, Option("seed", settings.seed), *changed, *last)))

    @property
    def plot_command(self) -> str:
        """The command that draws its figure."""
        return on_command_line(Command("plot", (self.file,)))

    @property
    def page(self) -> str:
        """Name of the page in which it runs, for a sheet that is done without Python."""
        return f"{self.file.removesuffix('.nc')}.html"

    @property
    def headlines(self) -> Mapping[str, Headline]:
        """Its headline numbers by name; empty before the run was made."""
        return {} if self.outcome is None else {each.name: each for each in self.outcome.headlines}

    def fact(self, name: str) -> Any:
        """Return a headline number, a setting, or a variable of the run by its name, searched in this order.

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
        """The headlines in their units; one object each, so that the error of a number minus itself is zero."""
        found = {}
        for name, each in self.headlines.items():
            unit, theory = each.display_unit, each.theory
            error = from_si(each.standard_error, unit, difference=True)
            found[name] = Measured(from_si(each.value, unit), error, None if theory is None else from_si(theory, unit))
        return found


def trials(first: runner.Prepared, changes: Sequence[dict[str, Any]]) -> tuple[Trial, ...]:
    """Return the runs of a sheet: the first without a change, and one for each change.

    A change has a ``title`` and the settings to ``set``, which make its run differ in one respect from the first.

    >>> fast = {"title": "ten times as fast", "set": {"ascent": 160}}
    >>> found = trials(runner.prepare("lifting-dry", {}), [fast])
    >>> [(each.letter, each.fact("ascent")) for each in found]
    [('A', 1600.0), ('B', 160.0)]
    """
    default = not first.settings.changed().keys() - {"seed"}
    found = [Trial(_LETTERS[0], "with the default settings" if default else "with these settings", first)]
    for letter, change in zip(_LETTERS[1:], changes, strict=False):
        settings = type(first.settings).from_user({**first.settings.as_dict(), **change["set"]})
        if settings == first.settings:
            same = ", ".join(f"{name}={value}" for name, value in change["set"].items())
            raise ConfigError(f"Run {letter} of this sheet sets {same}, and so does run A: set run A otherwise.")
        found.append(Trial(letter, change["title"], replace(first, settings=settings)))
    return tuple(found)


def execute(asked: Sequence[Trial], progress: Callable[[float, str], None] | None = None) -> tuple[Trial, ...]:
    """Make the runs of a sheet, and return them with their results.

    >>> (made,) = execute(trials(runner.prepare("elastic-collisions", {"duration": "2 s"}), []))
    >>> made.fact("largest_energy_change").theory
    0.0
    """
    made: list[Trial] = []

    def show(share: float, word: str) -> None:
        if progress is not None:
            progress((len(made) + share) / len(asked), word)

    for trial in asked:
        outcome = runner.execute(trial.prepared, progress=show, command=trial.command)
        check_ledger(outcome.ledger, f"run {trial.letter}", "no sheet is made of it")
        made.append(replace(trial, outcome=outcome))
    return tuple(made)

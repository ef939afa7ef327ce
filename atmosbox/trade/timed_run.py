"""One way of running a scene, the errors and the cost of a run, and the order of runs in a budget of time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np

from atmosbox.errors import AtmosboxError
from atmosbox.scene import engines
from atmosbox.scene.setup import Series
from atmosbox.simulation import runner
from atmosbox.simulation.compilation import compile_kernels

if TYPE_CHECKING:
    from atmosbox.simulation.runner import Outcome

PROFILES = {
    "number_density": "number_density_theory",
    "layer_temperature": "layer_temperature_theory",
    "speed_probability_density": "speed_probability_density_theory",
    "parcel_temperature": "adiabat_temperature",
}
"""Curves with the variable of their theory; the error is the root mean square of the difference along the curve."""

_TEMPERATURES = ("K", "degC")


@dataclass(frozen=True)
class Way:
    """One way of running a scene.

    Parameters
    ----------
    engine
        The engine with its options.
    settings
        The settings that differ from the scene's defaults.
    series, value
        Index of its series in the scene, and its value of the setting or option that varies in the series.
    """

    engine: str
    settings: Mapping[str, Any]
    series: int = 0
    value: float = 0.0

    @property
    def label(self) -> str:
        """The engine and the settings as text, without the scene.

        Examples
        --------
        >>> Way("exact", {"ascent": 400}).label
        'exact, ascent=400'
        """
        return ", ".join([self.engine, *(f"{name}={value}" for name, value in self.settings.items())])

    @property
    def kernels(self) -> str:
        """Text that tells what is compiled: the engine, and the settings that are not numbers."""
        words = sorted(f"{name}={value}" for name, value in self.settings.items() if isinstance(value, bool | str))
        return " ".join([self.engine.partition(":")[0], *words])


def ways_of(series: Sequence[Series], settings: Mapping[str, Any]) -> tuple[Way, ...]:
    """Return the ways of running a scene that some series name.

    The user's settings count for all series; a series overrides them by its own settings and its varied setting.

    Raises
    ------
    SettingError
        If an engine or one of its options is refused.

    Examples
    --------
    >>> [way.label for way in ways_of([Series("exact", "ascent", (100, 200))], {"molecules": 500})]
    ['exact, molecules=500, ascent=100', 'exact, molecules=500, ascent=200']
    """
    found = []
    for place, row in enumerate(series):
        options = {parameter.name for parameter in engines.choose(row.engine).engine.parameters}
        for value in row.values:
            engine, own = row.engine, {**row.settings}
            if row.vary in options:
                engine += f"{',' if ':' in engine else ':'}{row.vary}={value:g}"
            else:
                own[row.vary] = value
            found.append(Way(str(engines.choose(engine)), {**settings, **own}, place, float(value)))
    return tuple(found)


class Quantity(NamedTuple):
    """The errors of one run in a number, or in a curve with one value for each point.

    ``unit`` is K for temperatures; for all other quantities it is 1, because the error is a share of the theory.
    ``theory`` is its value [SI], for a curve the mean of its absolute value. ``error`` and ``noise`` are the
    differences from theory and their standard errors.
    """

    label: str
    unit: str
    theory: float
    error: list[float]
    noise: list[float]


class Trial(NamedTuple):
    """The errors, by the name of the quantity, and the cost of one run.

    ``made`` is the energy that the scheme made, as a share; ``collisions`` are per molecule and unit of elapsed time.
    """

    quantities: dict[str, Quantity]
    wall_seconds: float
    engine_seconds: float
    ledger: float
    made: float
    escaped: int
    collisions: float


def compile_way(scene: str, way: Way) -> None:
    """Compile what a way of running needs, so that compilation does not count in the time of a run."""
    compile_kernels(runner.prepare(scene, way.settings, engine=way.engine))


def run(scene: str, way: Way, seed: int, progress: Callable[[float, str], None] | None = None) -> Trial:
    """Run a scene once in one way with a seed, and return the errors and the cost."""
    prepared = runner.prepare(scene, {**way.settings, "seed": seed}, engine=way.engine)
    done = runner.execute(prepared, progress=progress)
    bounds = done.dataset.elapsed_time_bnds.values
    lasted = float(bounds[-1, 1] - bounds[0, 0])
    rate = done.collisions / max(getattr(prepared.settings, "molecules", 1), 1) / lasted if lasted > 0.0 else math.nan
    cost = float(done.seconds), float(done.engine_seconds), float(done.ledger), float(done.made), int(done.escaped)
    return Trial(_quantities(done), *cost, rate)


def _quantities(outcome: Outcome) -> dict[str, Quantity]:
    """Return the errors of a run in its headlines and its curves."""
    quantities: dict[str, Quantity] = {}

    def add(name: str, label: str, unit: str, theory: float, misfit: Any, error: Any) -> None:
        absolute = unit in _TEMPERATURES
        if size := 1.0 if absolute else abs(theory):
            errors = (np.atleast_1d(each / size).tolist() for each in (misfit, error))
            quantities[name] = Quantity(label, "K" if absolute else "1", float(theory), *errors)

    for each in outcome.headlines:
        # a headline without a statistical error does not depend on the run: for instance theory against a library
        if each.theory is not None and each.misfit is not None and each.standard_error != 0.0:
            add(each.name, each.label, each.unit, each.theory, each.misfit, each.standard_error)
    for name, beside in PROFILES.items():
        if {name, beside, f"{name}_se"} <= set(outcome.dataset):
            value, theory, error = (outcome.dataset[part] for part in (name, beside, f"{name}_se"))
            # the difference is divided by the mean of the curve, because a curve may fall to zero
            label, mean = f"profile of {name.replace('_', ' ')}", float(np.mean(np.abs(theory.values)))
            add(name, label, value.attrs.get("units", ""), mean, value.values - theory.values, error.values)
    return quantities


MOST_RUNS = 64
FIRST_SHARE = 0.25
"""A first run that would take more than this share of the budget waits until all other ways have run once."""
TELLING = 0.02
"""Share of a run after which the time of the rest can be estimated."""

Progress = Callable[[float, str], None]
Result = TypeVar("Result")


class _TooLong(Exception):
    """A run takes more time than is allowed."""


def repeat(
    budget: float,
    results: Sequence[list[Result]],
    run: Callable[[int, Progress], Result],
    tell: Callable[[float, int], None] = lambda share, k: None,
    ended: Callable[[], None] = lambda: None,
    clock: Callable[[], float] = time.perf_counter,
) -> list[str]:
    """Run all ways of doing something as often as a budget of time [s] allows, those with the fewest runs first.

    A run that takes too long is stopped. As long as there is no result at all, a run may take the whole budget,
    whatever was spent on others. ``run`` gets the number of a way and a function that takes the share that is done and
    the word "running"; its result is added to the ``results`` of the way. ``tell`` gets the share of the budget that is
    spent and the number of the present way. Returned is, for each way, why it has no result or why its runs failed.
    """
    began = clock()
    seconds = [0.0] * len(results)  # the time of a run, as far as it is known
    failed = [""] * len(results)

    def left() -> float:
        return budget - (clock() - began) if any(results) else budget

    def attempt(k: int, allowed: float) -> None:
        start = clock()
        begun: list[float] = []  # the time and the share at the end of preparation, when the run itself began

        def watch(share: float, word: str) -> None:
            now = clock()
            if word == "running" and not begun:
                begun[:] = now, share
            needed = now - start
            if begun and share > begun[1] and (share - begun[1] > TELLING or needed > allowed):
                needed += (now - begun[0]) * (1.0 - share) / (share - begun[1])
            # an estimate may be wrong by a half; the time that has passed is certain
            if now - start > allowed or needed > 1.5 * allowed:
                seconds[k] = needed
                raise _TooLong
            tell(min((now - began) / budget, 1.0), k)

        try:
            results[k].append(run(k, watch))
        except _TooLong:
            return
        except AtmosboxError as error:
            failed[k] = str(error)
            return
        seconds[k] = clock() - start
        ended()

    while fit := [
        k for k in range(len(results))
        if not failed[k] and len(results[k]) < MOST_RUNS and 1.1 * seconds[k] < left()
    ]:  # fmt: skip
        k = min(fit, key=lambda k: (len(results[k]), seconds[k]))
        attempt(k, left() if seconds[k] else min(FIRST_SHARE * budget, left()))
    for k, done in enumerate(results):
        if not done and not failed[k]:
            long = f"one run takes about {max(seconds[k], 1.0):.0f} s"
            failed[k] = f"left out: {long if seconds[k] else 'the budget was spent before it began'}"
    return failed

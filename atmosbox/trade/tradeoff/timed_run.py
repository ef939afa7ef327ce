"""The errors and the cost of one run."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.simulation import runner
from atmosbox.simulation.continuation import execute_from
from atmosbox.trade.tradeoff.rung import Rung

if TYPE_CHECKING:
    from atmosbox.simulation.runner import Outcome

__all__ = ["PROFILES", "Quantity", "Trial", "run", "warm_up"]

PROFILES = {
    "number_density": "number_density_theory",
    "layer_temperature": "layer_temperature_theory",
    "speed_probability_density": "speed_probability_density_theory",
    "parcel_temperature": "adiabat_temperature",
}
"""Curves with the variable of their theory; their error is the root mean square of the misfit along the curve."""

_TEMPERATURES = ("K", "degC")


class Quantity(NamedTuple):
    """A number, or a curve, whose error is measured.

    ``unit`` is K for temperatures; for all other quantities it is 1, because the error is a share of the theory.
    ``theory`` is the value of theory in the first run [SI], for a curve the mean of its absolute value.
    """

    name: str
    label: str
    unit: str
    theory: float


class Trial(NamedTuple):
    """The errors and the cost of one run.

    ``error`` and ``noise : (value,)`` hold, for each quantity, misfits to theory and their standard errors: one value
    for a number, one for each point of a curve. ``collisions`` are per molecule and unit of the elapsed time.
    """

    quantities: Mapping[str, Quantity]
    error: Mapping[str, NDArray[np.float64]]
    noise: Mapping[str, NDArray[np.float64]]
    wall_seconds: float
    engine_seconds: float
    ledger: float
    made: float
    escaped: int
    collisions: float


def warm_up(scene: str, rung: Rung) -> None:
    """Compile what a rung needs, so that compilation does not count in the time of a trial."""
    prepared = runner.prepare(scene, rung.settings, engine=rung.engine)
    runner.build(prepared).parcel.advance(0.0)


def run(scene: str, rung: Rung, seed: int, progress: Callable[[float, str], None], state: str | None = None) -> Trial:
    """Run a rung with a seed and return its errors and its cost.

    Parameters
    ----------
    scene, rung, seed
        The run.
    progress
        Called with the share that is done and a short text on the present step.
    state
        Path of the saved state of the run, from which it continues if there is one; see
        `atmosbox.simulation.continuation.execute_from`.

    Raises
    ------
    AtmosboxError
        If the engine refuses the scene, or cannot go on.
    """
    prepared = runner.prepare(scene, {**rung.settings, "seed": seed}, engine=rung.engine)
    return _trial(execute_from(prepared, state, progress), prepared.settings)


def _trial(outcome: Outcome, settings: Any) -> Trial:
    quantities: dict[str, Quantity] = {}
    error: dict[str, NDArray[np.float64]] = {}
    noise: dict[str, NDArray[np.float64]] = {}
    for headline in outcome.headlines:
        # a headline without a statistical error does not depend on the run: for instance theory against a library
        if headline.theory is None or headline.misfit is None or headline.standard_error == 0.0:
            continue
        absolute = headline.unit in _TEMPERATURES
        if not absolute and headline.theory == 0.0:
            continue
        size = 1.0 if absolute else abs(headline.theory)
        quantities[headline.name] = Quantity(headline.name, headline.label, "K" if absolute else "1", headline.theory)
        error[headline.name] = np.array([headline.misfit / size])
        noise[headline.name] = np.array([headline.standard_error / size])
    dataset = outcome.dataset
    for name, beside in PROFILES.items():
        if name not in dataset or beside not in dataset or f"{name}_se" not in dataset:
            continue
        theory = dataset[beside].values
        absolute = dataset[name].attrs.get("units") in _TEMPERATURES
        # the misfit is divided by the mean of the curve, because a curve may fall to zero
        mean = float(np.mean(np.abs(theory)))
        size = 1.0 if absolute else mean
        label = f"profile of {name.replace('_', ' ')}"
        quantities[name] = Quantity(name, label, "K" if absolute else "1", mean)
        error[name] = (dataset[name].values - theory) / size
        noise[name] = dataset[f"{name}_se"].values / size
    lasted = float(dataset.elapsed_time_bnds.values[-1, 1] - dataset.elapsed_time_bnds.values[0, 0])
    per_molecule = outcome.collisions / max(getattr(settings, "molecules", 1), 1)
    return Trial(
        quantities, error, noise, outcome.seconds, outcome.engine_seconds, outcome.ledger, outcome.made,
        outcome.escaped, per_molecule / lasted if lasted > 0.0 else math.nan,
    )  # fmt: skip

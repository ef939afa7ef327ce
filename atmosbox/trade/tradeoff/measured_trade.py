"""The measurement of a trade: all ways of running a scene, each as often as a budget of time allows."""

from __future__ import annotations

import json
import math
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox import scenarios
from atmosbox.errors import AtmosboxError, Option, SettingError
from atmosbox.file.provenance import global_attributes
from atmosbox.scene import engines
from atmosbox.trade.tradeoff import timed_run
from atmosbox.trade.tradeoff.budgeted_runs import BudgetedRuns, Progress
from atmosbox.trade.tradeoff.kept_runs import KeptRuns
from atmosbox.trade.tradeoff.rung import Rung, rungs
from atmosbox.trade.tradeoff.timed_run import Quantity, Trial
from atmosbox.trade.tradeoff.warm_engine import compile_within, kind
from atmosbox.version import __version__

__all__ = ["measure"]


def measure(
    scene: str,
    *,
    settings: Mapping[str, Any] | None = None,
    budget: float = 60.0,
    seed: int = 1,
    ladder: Sequence[Rung] | None = None,
    progress: Progress | None = None,
    command: str = "",
    out: Path | None = None,
    force: bool = False,
    note: Callable[[str], None] | None = None,
) -> xr.Dataset:
    """Run a scene with several engines and settings, and return errors and costs.

    Every rung runs once and is then repeated with other seeds while the budget lasts, those with the fewest runs first;
    the time of compiling the engines counts, too. The bias is the mean misfit to theory. Its standard error and the
    noise of a single run come from the scatter of the seeds or, for fewer than four runs, from the runs' own standard
    errors.

    If a file is named, every run is saved when it ends, and its state is saved while it runs. The same call then
    continues where a killed one has stopped, with the rest of its budget.

    Parameters
    ----------
    scene
        Name of a scene that declares which ways of running it are compared.
    settings
        Settings for all runs.
    budget
        Duration of the measurement, including compilation [s].
    seed
        The first seed.
    ladder
        The ways of running to compare; by default those that the scene declares.
    progress
        Called with the share that is done and a short text on the present step.
    command
        The command that the user typed, for the history in the file.
    out
        The file that will be written from the result. The runs are saved beside it; when it is written,
        `KeptRuns.remove` removes them.
    force
        Whether saved runs of another tradeoff are deleted.
    note
        Called with a remark on the runs that are taken from an earlier call.

    Returns
    -------
    xarray.Dataset
        Variables along ``rung`` and ``quantity``; their long names describe them.

    Raises
    ------
    SettingError
        If the scene declares nothing to compare, or the budget is not allowed or too small for any run.
    FileError
        If saved runs beside the file belong to another tradeoff.
    """
    module = scenarios.load(scene)
    row = getattr(module, "ladder", ())
    if ladder is None and not row:
        raise SettingError("scene", scene, "declares nothing to compare", "give its module a ladder of Series")
    if not (math.isfinite(budget) and 1.0 <= budget <= 1e6):
        raise SettingError("budget", f"{budget:g} s", "is not between 1 s and 1000000 s", Option("budget", "60s"))
    module.Settings.from_user(settings or {})
    ways = tuple(ladder) if ladder is not None else rungs(row, settings or {})
    tell = progress or (lambda share, word: None)
    first = _first_alike(ways, module.Settings)
    own = sorted(set(first))
    compiled: set[str] = set()

    def compile_way(k: int, seconds: float) -> bool:
        way = ways[own[k]]
        if (what := kind(way)) not in compiled:
            tell(0.0, f"trying the engine {engines.choose(way.engine).name}")
            if not compile_within(scene, way, seconds):
                return False
            compiled.add(what)
        return True

    words = command or f"atmosbox tradeoff {scene}"
    kept = KeptRuns(out, _request(scene, settings or {}, budget, seed, ways), words, force=force)
    known = kept.trials(len(own))
    if (before := sum(map(len, known))) and note is not None:
        note(f"{before} runs are saved, and {kept.spent:.0f} s of the budget are spent: going on with the rest")

    def run_way(k: int, done: int, watch: Progress) -> Trial:
        try:
            return timed_run.run(scene, ways[own[k]], seed + done, watch, kept.place(k, done))
        except Exception:  # after any failure, a later attempt begins anew
            kept.drop(k, done)
            raise

    status = "complete"
    with warnings.catch_warnings(), closing(kept):
        warnings.simplefilter("ignore")  # coarse steps are what is measured here
        labels = [ways[k].label for k in own]
        runs = BudgetedRuns(budget, labels, compile_way, run_way, tell, keep=kept.keep, results=known, spent=kept.spent)
        try:
            runs.run()
        except KeyboardInterrupt:
            if not any(runs.results):
                raise
            status = "interrupted"
    trials = [runs.results[own.index(k)] for k in first]
    refused = [runs.left_out[own.index(k)] for k in first]
    if not any(trials):
        if out is not None:
            KeptRuns.remove(out)  # otherwise a longer budget would be refused as another tradeoff
        why = next((reason for reason in refused if reason), "no run fits into it")
        raise SettingError(
            "budget", f"{budget:g} s", f"leaves nothing measured ({why})", "give a longer ", Option("budget")
        )
    tell(1.0, "done")
    title = f"Speed against accuracy: {getattr(module, 'title', scene)}"
    found = _dataset(scene, ways, trials, refused, budget, title, words, row, status)
    if kept.history:
        found.attrs["history"] = "\n".join(kept.history)
    return found


def _request(scene: str, settings: Mapping[str, Any], budget: float, seed: int, ways: Sequence[Rung]) -> dict[str, Any]:
    """Return all that determines the measurement, by names for messages."""
    words: dict[str, Any] = {"version of atmosbox": __version__, "scene": scene, "budget": budget, "seed": seed}
    words |= {f"setting {name}": str(value) for name, value in settings.items()}
    return words | {"the ways of running it": [way.label for way in ways]}


def _first_alike(ways: Sequence[Rung], settings: Any) -> list[int]:
    """Return for each way of running the index of the first that is equal: two series may have a run in common."""
    found: dict[str, int] = {}
    first = []
    for k, way in enumerate(ways):
        try:
            changed = settings.from_user(dict(way.settings)).changed()
        except AtmosboxError:  # the error will be reported when this way is run
            changed = dict(way.settings)
        first.append(found.setdefault(json.dumps([way.engine, changed], sort_keys=True, default=str), k))
    return first


def _dataset(
    scene: str,
    ways: Sequence[Rung],
    trials: Sequence[Sequence[Trial]],
    refused: Sequence[str],
    budget: float,
    title: str,
    command: str,
    row: Sequence[Any],
    status: str,
) -> xr.Dataset:
    """Return all trials as one dataset."""
    quantities: dict[str, Quantity] = {}
    for done in trials:
        for one in done:
            quantities |= {name: q for name, q in one.quantities.items() if name not in quantities}
    names = list(quantities)
    shape = (len(ways), len(names))
    bias, bias_se, noise = (np.full(shape, np.nan) for _ in range(3))
    for k, done in enumerate(trials):
        for q, name in enumerate(names):
            members = [one for one in done if name in one.error]
            if members and len(members) == len(done):  # a quantity that some runs lack has no unbiased mean
                bias[k, q], bias_se[k, q], noise[k, q] = _summary(
                    np.array([one.error[name] for one in members]), np.array([one.noise[name] for one in members])
                )

    def median(pick: Callable[[Trial], float]) -> NDArray[np.float64]:
        return np.array([np.median([pick(one) for one in done]) if done else np.nan for done in trials])

    def worst(pick: Callable[[Trial], float]) -> NDArray[np.float64]:
        return np.array([max(abs(pick(one)) for one in done) if done else np.nan for done in trials])

    cpu = median(lambda one: one.engine_seconds)
    reference = _reference(ways, trials)
    rate = np.array([np.mean([one.collisions for one in done]) if done else np.nan for done in trials])
    missed = np.full(len(ways), np.nan)
    if reference is not None:
        for k, way in enumerate(ways):
            if trials[k] and way.settings.get("plane") == ways[reference].settings.get("plane"):
                missed[k] = 1.0 - rate[k] / rate[reference]
    data = {
        "bias": (("rung", "quantity"), bias, {"long_name": "mean error of a run against theory"}),
        "bias_se": (("rung", "quantity"), bias_se, {"long_name": "standard error of bias"}),
        "noise": (("rung", "quantity"), noise, {"long_name": "standard deviation of a single run"}),
        "wall_seconds": ("rung", median(lambda one: one.wall_seconds), _of("wall-clock time of a run", "s")),
        "engine_seconds": ("rung", cpu, _of("processor time that the engine takes in a run", "s")),
        "cost": (
            "rung",
            cpu / (cpu[reference] if reference is not None else np.nan),
            _of("processor time of the engine as a multiple of that in the reference", "1"),
        ),
        "members": ("rung", np.array([len(done) for done in trials]), _of("number of runs", "1")),
        "energy_drift": (
            "rung",
            worst(lambda one: one.made),
            _of("largest energy that the scheme itself has made, as a share", "1"),
        ),
        "ledger": ("rung", worst(lambda one: one.ledger), _of("largest residual of the energy ledger", "1")),
        "missed": ("rung", missed, _of("share of the collisions of the reference that are missing", "1")),
        "escaped": ("rung", worst(lambda one: one.escaped), _of("most molecules outside the box", "1")),
        "left_out": ("rung", list(refused), {"long_name": "why there is no run, or no more"}),
        "series": ("rung", np.array([way.series for way in ways]), _of("number of the series", "1")),
        "value": ("rung", np.array([way.value for way in ways]), _of("what varies within the series", "1")),
        "engine": ("rung", [way.engine for way in ways], {"long_name": "engine and its options"}),
        "settings": ("rung", [json.dumps(dict(way.settings)) for way in ways], {"long_name": "settings, as JSON"}),
    }
    parameters = {
        "scene": scene,
        "tradeoff": {"budget": budget, "reference": reference},
        "series": [
            {"engine": s.engine, "vary": s.vary, "order": dict(s.order), "settings": dict(s.settings)} for s in row
        ],
    }
    return xr.Dataset(
        data,
        coords={
            "rung": ("rung", [way.label for way in ways], {"long_name": "engine and settings"}),
            "quantity": ("quantity", names, {"long_name": "what is measured"}),
            "label": ("quantity", [q.label for q in quantities.values()], {"long_name": "name in a table"}),
            "unit": (
                "quantity",
                [q.unit for q in quantities.values()],
                {"long_name": "unit of bias and noise: K, or 1 for a share of the theory"},
            ),
            "theory": (
                "quantity",
                [q.theory for q in quantities.values()],
                {"long_name": "value of theory, in SI units; for a curve the mean of its absolute value"},
            ),
        },
        attrs=global_attributes(parameters, title=title, command=command, status=status),
    )


def _of(long_name: str, units: str) -> dict[str, str]:
    return {"long_name": long_name, "units": units}


def _reference(ways: Sequence[Rung], trials: Sequence[Sequence[Trial]]) -> int | None:
    """Return the index of the reference: the last way in the exact engine's first series; None if none has run."""
    exact = [k for k, way in enumerate(ways) if trials[k] and way.engine == str(engines.EXACT)]
    if not exact:
        return None
    first = ways[exact[0]].series
    return [k for k in exact if ways[k].series == first][-1]


def _summary(error: NDArray[np.float64], own: NDArray[np.float64]) -> tuple[float, float, float]:
    """Return bias, its standard error, and the noise of one run, of ``error : (member, value)``.

    For a curve, the bias is the root mean square of the mean error, less the part that chance alone would add.
    """
    keep = np.isfinite(error).all(axis=0) & np.isfinite(own).all(axis=0)
    if not keep.any():
        return math.nan, math.nan, math.nan
    error, own = error[:, keep], own[:, keep]
    members = len(error)
    variance = error.var(axis=0, ddof=1) if members >= 4 else np.mean(own**2, axis=0)
    mean = error.mean(axis=0)
    noise = math.sqrt(float(variance.mean()))
    se = noise / math.sqrt(members)
    if mean.size == 1:
        return float(mean[0]), se, noise
    square = float(np.mean(mean**2))
    return math.sqrt(max(square - se**2, 0.0)), se / math.sqrt(mean.size), noise

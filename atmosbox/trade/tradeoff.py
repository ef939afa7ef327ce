"""Speed against accuracy: a scene on all engines and settings, each as often as a budget of time allows."""

import contextlib
import json
import math
import os
import platform
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from atmosbox import scenarios
from atmosbox.engine.core.kernel_cache import source_digest
from atmosbox.errors import AtmosboxError, FileError, Option, SettingError
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.netcdf import read
from atmosbox.file.output_lock import ANOTHER_NAME
from atmosbox.file.provenance import global_attributes, parameters
from atmosbox.scene import engines
from atmosbox.simulation.recording import uninterrupted
from atmosbox.trade import timed_run
from atmosbox.trade.timed_run import Progress, Quantity, Trial, Way, ways_of
from atmosbox.version import __version__

__all__ = ["Way", "measure", "ways_of"]


def measure(
    scene: str,
    *,
    settings: Mapping[str, Any] | None = None,
    budget: float = 40.0,
    seed: int = 1,
    ways: Sequence[Way] | None = None,
    progress: Progress | None = None,
    command: str = "",
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    note: Callable[[str], None] | None = None,
) -> xr.Dataset:
    """Run a scene with several engines and settings, and return errors and costs.

    Every way runs once and is then repeated with other seeds while the budget lasts, those with the fewest runs first.
    The bias is the mean difference from theory. Its standard error and the noise of a single run come from the scatter
    of the seeds or, for fewer than four runs, from the runs' own standard errors.

    If a file is named, the runs so far are saved in its part, NAME.part.nc. The same call then goes on where a killed
    one has stopped, with the runs that are there and the rest of its budget.

    Parameters
    ----------
    scene
        Name of a scene that declares which ways of running it are compared.
    settings
        Settings for all runs.
    budget
        Duration of the measurement [s]; the time in which engines are compiled does not count.
    seed
        The first seed.
    ways
        The ways of running to compare; by default those that the scene declares.
    progress
        Called with the share that is done and a short text on the present step.
    command
        The command that the user typed, for the history in the file.
    out
        The netCDF file to write; by default nothing is written.
    force
        Whether the file, and the saved runs of another tradeoff, may be replaced.
    note
        Called with a remark on the runs that are taken from an earlier call.

    Returns
    -------
    xarray.Dataset
        Variables along ``configuration``, an engine and its settings, and ``quantity``; their long names describe them.

    Raises
    ------
    SettingError
        If the scene declares nothing to compare, or the budget is not allowed or too small for any run.
    FileError
        If the file cannot be written, or the saved runs belong to another tradeoff.

    Examples
    --------
    >>> measure("lifting-dry", budget=0.0)
    Traceback (most recent call last):
    ...
    atmosbox.errors.SettingError: budget = 0 s is not between 1 s and 1000000 s: give budget="40s".
    """
    module = scenarios.load(scene)
    series = getattr(module, "series", ())
    if not (math.isfinite(budget) and 1.0 <= budget <= 1e6):
        raise SettingError("budget", f"{budget:g} s", "is not between 1 s and 1000000 s", Option("budget", "40s"))
    module.Settings.from_user(settings or {})
    ways = tuple(ways_of(series, settings or {}) if ways is None else ways)
    if not ways:
        raise SettingError("scene", scene, "declares nothing to compare", "give its module the tuple series, of Series")
    first = _first_alike(ways, module.Settings)
    own = sorted(set(first))
    tell = progress or (lambda share, word: None)
    words = command or f"atmosbox tradeoff {scene}"
    title = f"Speed against accuracy: {getattr(module, 'title', scene)}"
    request = {
        # costs that were measured on another computer or with other sources of the engine cannot be compared
        **{"version": __version__, "seed": seed, "sources": source_digest(), "computer": platform.node()},
        **{f"setting {name}": str(value) for name, value in (settings or {}).items()},
        "ways": [way.label for way in ways],
    }
    told = [{"engine": s.engine, "vary": s.vary, "order": dict(s.order), "settings": dict(s.settings)} for s in series]
    about: dict[str, Any] = {"scene": scene, "request": request, "series": told}
    results: list[list[Trial]] = [[] for _ in own]
    earlier = ""
    checkpoint = None if out is None else Checkpoint(out, force=force)

    def dataset(status: str, left_out: Sequence[str] = ()) -> xr.Dataset:
        trials = [results[own.index(k)] for k in first]
        why = [left_out[own.index(k)] if left_out else "" for k in first]
        made = _dataset(ways, trials, why)
        tradeoff = {"budget": budget, "reference": _reference(ways, trials)}
        made.attrs = global_attributes(about | {"tradeoff": tradeoff}, title=title, command=words, status=status)
        made.attrs["history"] = earlier + made.attrs["history"]
        return made

    def save() -> None:
        if checkpoint is not None:
            checkpoint(lambda: dataset("partial"))

    def label(share: float, k: int) -> None:
        tell(share, ways[own[k]].label)

    def run(k: int, watch: Progress) -> Trial:
        return timed_run.run(scene, ways[own[k]], seed + len(results[k]), watch)

    status = "complete"
    try:
        if checkpoint is not None and checkpoint.begin().stale and not force:
            saved = _saved(checkpoint.part, request)
            results = [_trials(saved.runs.values[k]) for k in own]
            earlier = f"{saved.attrs['history']}\n"
        spent = sum(trial.wall_seconds for done in results for trial in done)
        if spent and note is not None:
            note(f"{sum(map(len, results))} runs are saved, which took {spent:.0f} s: going on with the rest")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # coarse steps are what is measured here
            for way in {way.kernels: way for way in ways}.values():
                tell(0.0, f"compiling the engine {engines.choose(way.engine).name}")
                with contextlib.suppress(AtmosboxError):  # the run itself tells what is wrong
                    timed_run.compile_way(scene, way)
            try:
                left_out = timed_run.repeat(max(budget - spent, 0.0), results, run, label, save)
            except KeyboardInterrupt:
                if not any(results):
                    raise
                status, left_out = "interrupted", []
        if not any(results):
            why = next((reason for reason in left_out if reason), "no run fits into it")
            problem = f"leaves nothing measured ({why})"
            raise SettingError("budget", f"{budget:g} s", problem, "give a longer ", Option("budget"))
        found = dataset(status, left_out)
        if checkpoint is not None:
            with uninterrupted():
                checkpoint.finish(found.drop_vars("runs"))
    finally:
        if checkpoint is not None:
            checkpoint.release()
    tell(1.0, "done")
    return found


def _saved(part: Path, asked: Mapping[str, Any]) -> xr.Dataset:
    """Return what a killed call has saved; refuse the runs of another request."""
    saved = read(part)
    before = parameters(saved).get("request", {})
    different = [name for name in {**asked, **before} if asked.get(name) != before.get(name)]
    if different:
        problem = f"{part} has the runs of another tradeoff ({', '.join(different)})"
        raise FileError(problem, *ANOTHER_NAME, ", or add ", Option("force", True), " to replace them")
    return saved


def _trials(text: str) -> list[Trial]:
    """Return runs from the text that a file holds."""
    runs = json.loads(text)
    return [Trial({name: Quantity(*each) for name, each in parts.items()}, *rest) for parts, *rest in runs]


def _first_alike(ways: Sequence[Way], settings: Any) -> list[int]:
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


def _reference(ways: Sequence[Way], trials: Sequence[Sequence[Trial]]) -> int | None:
    """Return the index of the reference: the last way in the exact engine's first series; None if none has run."""
    exact = [k for k, way in enumerate(ways) if trials[k] and way.engine == str(engines.EXACT)]
    return max((k for k in exact if ways[k].series == ways[exact[0]].series), default=None)


def _dataset(ways: Sequence[Way], trials: Sequence[Sequence[Trial]], left_out: Sequence[str]) -> xr.Dataset:
    """Return all runs as one dataset, without global attributes."""
    quantities: dict[str, Quantity] = {}
    for trial in (one for done in trials for one in done):
        for name, quantity in trial.quantities.items():
            quantities.setdefault(name, quantity)  # the first run gives label, unit and theory
    names, about = list(quantities), list(quantities.values())
    parts = np.full((3, len(ways), len(names)), np.nan)
    for k, done in enumerate(trials):
        for q, name in enumerate(names):
            found = [one.quantities[name] for one in done if name in one.quantities]
            if found and len(found) == len(done):  # a quantity that some runs lack has no unbiased mean
                errors, noises = (np.array([getattr(one, part) for one in found]) for part in ("error", "noise"))
                parts[:, k, q] = _summary(errors, noises)

    def each(reduce: Callable[[list[float]], Any], name: str) -> NDArray[np.float64]:
        return np.array([reduce([abs(getattr(one, name)) for one in done]) if done else np.nan for done in trials])

    cpu, rate = each(np.median, "engine_seconds"), each(np.mean, "collisions")
    reference = _reference(ways, trials)
    cost, missed = np.full((2, len(ways)), np.nan)
    if reference is not None:
        alike = [way.settings.get("plane") == ways[reference].settings.get("plane") for way in ways]
        cost, missed = cpu / cpu[reference], np.where(alike, 1.0 - rate / rate[reference], np.nan)
    along: dict[str, tuple[Any, str, str]] = {
        "wall_seconds": (each(np.median, "wall_seconds"), "wall-clock time of a run", "s"),
        "engine_seconds": (cpu, "processor time that the engine takes in a run", "s"),
        "cost": (cost, "processor time of the engine as a multiple of that in the reference", "1"),
        "members": ([len(done) for done in trials], "number of runs", "1"),
        "energy_drift": (each(max, "made"), "largest error of the engine in the energy, as a share", "1"),
        "ledger": (each(max, "ledger"), "largest residual of the energy budget", "1"),
        "missed": (missed, "share of the collisions of the reference that are missing", "1"),
        "escaped": (each(max, "escaped"), "most molecules outside the box", "1"),
        "left_out": (list(left_out), "why there is no run, or no more", ""),
        "series": ([way.series for way in ways], "number of the series", "1"),
        "value": ([way.value for way in ways], "what varies within the series", "1"),
        "engine": ([way.engine for way in ways], "engine and its options", ""),
        "settings": ([json.dumps(dict(way.settings)) for way in ways], "settings, as JSON", ""),
        "runs": ([json.dumps(done) for done in trials], "the runs so far, as JSON", ""),
    }
    data: dict[str, Any] = {
        name: ("configuration", values, {"long_name": text} | ({"units": unit} if unit else {}))
        for name, (values, text, unit) in along.items()
    }
    texts = "mean error of a run against theory", "standard error of bias", "standard deviation of a single run"
    for name, values, text in zip(("bias", "bias_se", "noise"), parts, texts, strict=True):
        data[name] = (("configuration", "quantity"), values, {"long_name": text})
    theory = "value of theory, in SI units; for a curve the mean of its absolute value"
    of_quantities: dict[str, tuple[Sequence[Any], str]] = {
        "quantity": (names, "what is measured"),
        "label": ([q.label for q in about], "name in a table"),
        "unit": ([q.unit for q in about], "unit of bias and noise: K, or 1 for a share of the theory"),
        "theory": ([q.theory for q in about], theory),
    }
    labels = [way.label for way in ways]
    coords: dict[str, Any] = {"configuration": ("configuration", labels, {"long_name": "engine and settings"})}
    coords |= {name: ("quantity", each, {"long_name": text}) for name, (each, text) in of_quantities.items()}
    return xr.Dataset(data, coords=coords)


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

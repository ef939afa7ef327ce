"""All extremes on all engines, and the outcomes."""

from __future__ import annotations

import threading
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from atmosbox.engine import RefusedError, StalledError
from atmosbox.errors import SettingError
from atmosbox.trade.extremes.extreme import EXTREMES, Extreme
from atmosbox.trade.extremes.guarded_run import Candidate, GuardedRun, UnlawfulError
from atmosbox.trade.extremes.verdict import Verdict, compared, judged, stored, wrong

__all__ = ["Finding", "assess", "examine"]

LIMIT, LONG_LIMIT = 30.0, 600.0
"""Processor time after which an extreme, and a long one, counts as a hang [s]."""
PATIENCE = 900.0
"""Additional time to wait for an engine that does not respond at all [s]."""


@dataclass(frozen=True)
class Finding:
    """The outcome of one extreme on one engine, and the time that it took [s]."""

    engine: str
    extreme: Extreme
    verdict: Verdict
    seconds: float


def assess(
    engines: Sequence[Candidate],
    names: Sequence[str] | None = None,
    progress: Callable[[float, str], None] | None = None,
    *,
    long: bool = False,
) -> Iterator[Finding]:
    """Run extremes on engines, one after the other, and compare the outcomes with the stored ones.

    Parameters
    ----------
    engines
        The engines, as `atmosbox.scene.engines.choose` returns them.
    names
        The names of the extremes; all by default.
    progress
        Called with the share that is done, 0 to 1, and the name of the present extreme and engine.
    long
        Whether "all" includes the long extremes.

    Yields
    ------
    Finding
        One for each extreme and engine; all engines of one extreme come before the next extreme.

    Raises
    ------
    KeyError
        If a name is not that of an extreme.

    Examples
    --------
    >>> from atmosbox.scene.engines import EXACT
    >>> [found.verdict.told for found in assess([EXACT], ["cradle"])]
    ['largest error of a position or a velocity: 0, expected 0 ± 1e-12']
    """
    chosen = [EXTREMES[name] for name in names] if names is not None else list(EXTREMES.values())
    chosen = [each for each in chosen if long or names is not None or not each.long]
    total = len(chosen) * len(engines)
    for k, (each, engine) in enumerate((each, engine) for each in chosen for engine in engines):
        if progress is not None:
            progress(k / total, f"{each.name} on {engine.name}")
        yield examine(each, engine, stored().get(each.name, {}).get(str(engine)))
    if progress is not None:
        progress(1.0, "done")


def examine(
    each: Extreme,
    engine: Candidate,
    before: Verdict | None = None,
    *,
    limit: float | None = None,
    patience: float = PATIENCE,
) -> Finding:
    """Run one extreme on one engine.

    Parameters
    ----------
    each
        The extreme.
    engine
        The engine.
    before
        The stored outcome for comparison, if there is one.
    limit
        Processor time after which the run counts as a hang [s].
    patience
        Additional time to wait for an engine that does not even call its watch function [s]: it may be compiling, or
        the processor may have other work.

    Returns
    -------
    Finding
        The outcome. An engine that does not return continues in its thread and is ignored.
    """
    limit = (LONG_LIMIT if each.long else LIMIT) if limit is None else limit
    run = GuardedRun(engine, limit)
    verdicts: list[Verdict] = []
    began = time.monotonic()
    worker = threading.Thread(target=lambda: verdicts.append(_verdict(each, run)), daemon=True, name=each.name)
    # Warnings of an engine are expected in extreme cases. They are ignored from here, for all threads: a worker that is
    # left behind would restore them in the middle of another run.
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        worker.start()
        try:
            worker.join(limit + patience)
        finally:
            run.stopped.set()
        if worker.is_alive():
            worker.join(1.0)
    verdict = verdicts[0] if verdicts else wrong(f"hangs: it has not come back after {limit + patience:g} s")
    return Finding(engine.name, each, compared(verdict, before), time.monotonic() - began)


def _verdict(each: Extreme, run: GuardedRun) -> Verdict:
    """Return the outcome; every exception becomes one."""
    try:
        return judged(each.probe(run))
    except (RefusedError, StalledError, SettingError) as refusal:
        return Verdict("refused", " ".join(str(refusal).split()))
    except UnlawfulError as fault:
        return wrong(str(fault))
    except Exception as bug:
        return wrong(f"{type(bug).__name__}: {bug}")

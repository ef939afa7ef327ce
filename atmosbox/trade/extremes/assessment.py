"""All extremes on all engines: what came out of each."""

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
PATIENCE = 900.0


@dataclass(frozen=True)
class Finding:
    """What one engine made of one extreme, and how long it took [s]."""

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
    """Put engines through extremes, one after the other, and compare with the stored outcomes.

    Parameters
    ----------
    engines
        What `atmosbox.scene.engines.choose` returns.
    names
        The names of the extremes; all by default.
    progress
        Called with the fraction done, 0 to 1, and what is under way.
    long
        Whether the long ones are among all.

    Yields
    ------
    Finding
        One for each extreme and engine, extreme by extreme.

    Raises
    ------
    KeyError
        If there is no extreme of a name.

    Examples
    --------
    >>> from atmosbox.scene.engines import EXACT
    >>> [found.verdict.told for found in assess([EXACT], ["count-of-pi"])]
    ['hits of walls and contacts: 3141, expected 3141 ± 0']
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
    """Put one engine through one extreme.

    Parameters
    ----------
    each
        The extreme.
    engine
        The engine.
    before
        The stored outcome, with which to compare.
    limit
        For how long it may run before it counts as a hang, of the processor's time [s].
    patience
        How much longer to wait for an engine that does not even call its watch; it may be compiling, or the
        processor may have other work [s].

    Returns
    -------
    Finding
        What came out. An engine that does not come back is left behind in its thread.
    """
    limit = (LONG_LIMIT if each.long else LIMIT) if limit is None else limit
    run = GuardedRun(engine, limit)
    verdicts: list[Verdict] = []
    began = time.monotonic()
    worker = threading.Thread(target=lambda: verdicts.append(_verdict(each, run)), daemon=True, name=each.name)
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
    """Return what came out, whatever is raised."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # an engine may well warn of what it is asked to do here
            return judged(each.probe(run))
    except (RefusedError, StalledError, SettingError) as refusal:
        return Verdict("refused", " ".join(str(refusal).split()))
    except UnlawfulError as fault:
        return wrong(str(fault))
    except Exception as bug:
        return wrong(f"{type(bug).__name__}: {bug}")

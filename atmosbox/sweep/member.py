"""One run of a sweep, and its record."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

from atmosbox import scenarios
from atmosbox.errors import AtmosboxError
from atmosbox.simulation import runner
from atmosbox.simulation.continuation import execute_from
from atmosbox.sweep.plan import Task

__all__ = ["COMPLETE", "FAILED", "Progress", "Record", "failure", "run"]

COMPLETE, FAILED = "complete", "failed"

Record = dict[str, Any]
"""The record of a run, in types that JSON can hold."""

Progress = Callable[[float, str], None]

_KEPT = ("name", "value", "standard_error", "theory", "tolerance", "reason", "unit", "display_unit", "label")


def run(task: Task, progress: Progress | None = None) -> Record:
    """Run one member of a sweep, from the saved state of an earlier call if there is one; a failure raises no error.

    Parameters
    ----------
    task
        The run.
    progress
        Called with the share that is done and a short text on the present step.

    Returns
    -------
    dict
        ``point``, ``member``, ``seed`` and ``status``; for a complete run also its ``ledger``, ``headlines`` and
        ``warnings``, for a failed one the ``reason``.

    Raises
    ------
    runner.Interrupted
        After Ctrl-C.

    Examples
    --------
    >>> box = Task(1, 1, "elastic-collisions", {"duration": 5.0, "seed": 3}, None, None)
    >>> made = run(box)
    >>> made["status"], made["ledger"] < 1e-10, made["headlines"][0]["name"]
    ('complete', True, 'energy_of_light_discs')
    """
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            prepared = runner.prepare(task.scene, task.settings, engine=task.engine, accuracy=task.accuracy)
            outcome = execute_from(prepared, task.state, progress)
    except AtmosboxError as error:
        return failure(task, str(error))
    except MemoryError:
        return failure(task, "The computer has not enough memory for it.")
    except Exception as error:
        where = scenarios.place(error)
        what = "This is a bug in atmosbox" if where is None else f"{where} cannot be run"
        return failure(task, f"{what} ({type(error).__name__}: {error}).")
    if not outcome.headlines:
        return failure(task, "The run was too short for any of its headlines to be measured.")
    return {
        **_about(task, COMPLETE),
        "ledger": outcome.ledger,
        "headlines": [{name: getattr(each, name) for name in _KEPT} for each in outcome.headlines],
        "warnings": sorted({str(each.message) for each in caught}),
    }


def failure(task: Task, reason: str) -> Record:
    """Return the record of a run that failed.

    Examples
    --------
    >>> failure(Task(2, 1, "temperature", {"seed": 3}, None, None), "It stalled.")["reason"]
    'It stalled.'
    """
    return {**_about(task, FAILED), "reason": " ".join(reason.split())}


def _about(task: Task, status: str) -> Record:
    return {"point": task.point, "member": task.member, "seed": task.settings["seed"], "status": status}

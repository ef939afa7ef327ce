"""Run a scenario: advance, measure, report."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from atmosbox.engine import StalledError
from atmosbox.errors import EngineError
from atmosbox.scene.headline import Headline
from atmosbox.scene.panels import to_json
from atmosbox.simulation.compilation import told
from atmosbox.simulation.preparation import Card, Prepared, build, card, prepare
from atmosbox.simulation.recording import Recording, uninterrupted
from atmosbox.simulation.verification import LEDGER_LIMIT, Check, headlines_of, verify

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.file.checkpoint import Checkpoint

__all__ = [
    "LEDGER_LIMIT",
    "Card",
    "Check",
    "Interrupted",
    "Outcome",
    "Prepared",
    "build",
    "card",
    "execute",
    "headlines_of",
    "prepare",
    "run",
    "verify",
]

_BREATH = 0.1

Progress = Callable[[float, str], None]


class Outcome(NamedTuple):
    """What a run came to."""

    dataset: xr.Dataset
    headlines: tuple[Headline, ...]
    seconds: float
    collisions: int
    ledger: float
    engine_seconds: float
    """Processor time of the engine alone, without instruments and files."""
    made: float
    """Energy that the engine's scheme itself has made, in that of the motion; zero for an engine that keeps it."""
    escaped: int
    """Number of molecules outside the box or at no finite place: zero, or the engine is wrong."""


class Interrupted(KeyboardInterrupt):
    """A run was stopped by Ctrl-C; ``outcome`` holds the frames that are complete, None if there is none."""

    def __init__(self, outcome: Outcome | None, exit_code: int = 130) -> None:
        super().__init__("the run was interrupted")
        self.outcome = outcome
        self.exit_code = exit_code


def execute(
    prepared: Prepared,
    *,
    checkpoint: Checkpoint | None = None,
    progress: Progress | None = None,
    command: str = "",
) -> Outcome:
    """Run a prepared scenario.

    Parameters
    ----------
    prepared
        From `prepare`.
    checkpoint
        Keeps what is complete on disk while the run goes on, and writes the finished file.
    progress
        Called with the share that is done and a word on what is being done.
    command
        What the user typed, for the file's history.

    Returns
    -------
    Outcome
        The dataset, its headlines, and what it cost.

    Raises
    ------
    Interrupted
        After Ctrl-C, with the frames that are complete.
    EngineError
        If the engine cannot go on.

    Examples
    --------
    >>> outcome = execute(prepare("elastic-collisions", {"duration": "2 s"}))
    >>> outcome.ledger < LEDGER_LIMIT
    True
    """
    if checkpoint is None:
        return _execute(prepared, None, progress, command)
    checkpoint.begin()
    try:
        return _execute(prepared, checkpoint, progress, command)
    finally:
        checkpoint.release()


def _execute(prepared: Prepared, checkpoint: Checkpoint | None, progress: Progress | None, command: str) -> Outcome:
    """Run a prepared scenario, whose file nobody else writes."""
    from atmosbox.file.provenance import global_attributes

    tell = progress or (lambda share, word: None)
    with told(prepared, tell):
        setup = build(prepared)
        setup.parcel.advance(0.0)
    panels = prepared.module.panels
    attributes = global_attributes(
        prepared.parameters,
        title=getattr(prepared.module, "title", prepared.scene),
        command=command or f"atmosbox run {prepared.scene}",
        comment=" ".join((prepared.module.__doc__ or "").split()),
        references=prepared.engine.engine.reference,
        panels=to_json(panels(prepared.settings) if callable(panels) else panels),
        status="partial",
    )
    recording = Recording(prepared, setup, attributes)
    last = spent = 0.0

    def watch(now: float) -> None:
        nonlocal last
        if time.perf_counter() - last > _BREATH:
            last = time.perf_counter()
            tell(min(now / setup.duration, 1.0), "running")

    def outcome(status: str) -> Outcome:
        dataset, headlines = recording.dataset(status)
        parcel = setup.parcel
        made = parcel.numerical_heat / (sum(parcel.energy()[:2]) or 1.0)
        return Outcome(
            dataset, headlines, spent, parcel.contacts, parcel.ledger(), recording.busy, made, parcel.escaped()
        )  # fmt: skip

    try:
        while recording.frames < setup.frames:
            began = time.perf_counter()
            recording.advance(watch)
            spent += time.perf_counter() - began
            watch(setup.parcel.time)
            if checkpoint is not None and recording.frames < setup.frames:
                checkpoint(lambda: recording.dataset("partial")[0])
        tell(1.0, "done")
        done = outcome("complete")
    except StalledError as error:
        raise EngineError(f"The run of {prepared.scene} cannot go on: {error}.") from error
    except KeyboardInterrupt as stop:
        partial = outcome("interrupted") if recording.frames else None
        if partial is not None and checkpoint is not None:
            with uninterrupted():
                checkpoint.save(partial.dataset)
        raise Interrupted(partial, getattr(stop, "exit_code", 130)) from None
    if checkpoint is not None:
        with uninterrupted():
            checkpoint.finish(done.dataset)
    return done


def run(
    scene: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Progress | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool = False,
    **settings: Any,
) -> xr.Dataset:
    """Run a scenario and return what it measured.

    Parameters
    ----------
    scene
        A name that `atmosbox.scenarios.names` lists, or the path of a file of your own.
    out
        Where to write the netCDF file; nothing is written without it.
    force
        Whether a file of that name may be replaced.
    progress
        Called with the share that is done and a word on what is being done.
    engine
        The engine, with its options: ``stepped:delta=0.02``; ``exact`` if nothing is said.
    accuracy
        How accurate the run shall be: ``"sketch"``, ``"lecture"``, ``"reference"``, or the largest error, as ``"0.5K"``
        or ``"2%"``. Picks the engine, and the settings that are not given.
    save_molecules
        Whether places and speeds of all molecules are kept in every frame.
    **settings
        Values by name, numbers in the documented unit or texts with a unit.

    Returns
    -------
    xarray.Dataset
        Everything measured, with theory beside it, in SI units.

    Raises
    ------
    AtmosboxError
        If the scene or a setting is refused, the file cannot be written, or the engine cannot go on.

    Examples
    --------
    >>> box = run("elastic-collisions", duration="2 s", seed=3)
    >>> bool(abs(box.energy_change).max() < 1e-12)
    True
    """
    from atmosbox.file.checkpoint import Checkpoint

    prepared = prepare(scene, settings, engine=engine, accuracy=accuracy, save_molecules=save_molecules)
    checkpoint = None
    if out is not None:
        checkpoint = Checkpoint(out, force=force)
    given = {name: text for name, text in (("engine", engine), ("accuracy", accuracy)) if text is not None} | settings
    words = ", ".join([repr(str(scene)), *(f"{name}={value!r}" for name, value in given.items())])
    return execute(prepared, checkpoint=checkpoint, progress=progress, command=f"atmosbox.run({words})").dataset

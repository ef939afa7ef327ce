"""Run a scenario: advance, measure, report."""

from __future__ import annotations

import contextlib
import os
import time
import warnings
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from atmosbox.engine import RefusedError, StalledError
from atmosbox.errors import EngineError, FileError, Option, SoundingError
from atmosbox.scene.headline import Headline
from atmosbox.scene.panels import to_json
from atmosbox.scene.setup import Setup
from atmosbox.simulation.compilation import told
from atmosbox.simulation.link import check_nothing_changes, read_link
from atmosbox.simulation.preparation import Prepared, agreed, build, card, prepare, replayed
from atmosbox.simulation.recording import Recording, uninterrupted
from atmosbox.simulation.restart import Restart, check_alike, from_file, put_back, with_state
from atmosbox.simulation.verification import LEDGER_LIMIT, headlines_of, verify

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.file.checkpoint import Checkpoint

__all__ = ["LEDGER_LIMIT", "Prepared", "card", "check_nothing_changes", "headlines_of", "prepare", "replayed", "verify"]

_BREATH = 0.1

Progress = Callable[[float, str], None]


class Outcome(NamedTuple):
    """The result of a run, and its cost."""

    dataset: xr.Dataset
    headlines: tuple[Headline, ...]
    seconds: float
    collisions: int
    ledger: float
    engine_seconds: float
    """Processor time of the engine alone, without instruments and files."""
    made: float
    """Energy that the engine's scheme has produced, over the energy of motion; zero for an engine that conserves it."""
    escaped: int
    """Number of molecules outside the box or without a finite position: zero, or the engine is wrong."""


class Interrupted(KeyboardInterrupt):
    """A run was stopped by Ctrl-C; ``outcome`` holds the complete frames, None if there is none."""

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
    restart: Restart | None = None,
    strict: bool = False,
) -> Outcome:
    """Run a prepared scenario.

    Parameters
    ----------
    prepared
        From `prepare`.
    checkpoint
        Stores on disk what is complete while the run goes on, and writes the finished file.
    progress
        Called with the completed share and a word on the present activity.
    command
        What the user typed, for the file's history.
    restart
        The state from which the run continues, from `atmosbox.simulation.restart.read_state`; None for a new run.
    strict
        Whether a doubtful sounding is refused, and not only reported in a warning.

    Returns
    -------
    Outcome
        The dataset, its headlines, and its cost.

    Raises
    ------
    Interrupted
        After Ctrl-C, with the complete frames.
    EngineError
        If the engine cannot continue.
    FileError
        If another run writes the file, or the state belongs to another run.

    Examples
    --------
    >>> outcome = execute(prepare("elastic-collisions", {"duration": "2 s"}))
    >>> outcome.ledger < LEDGER_LIMIT
    True
    """
    tell = progress or (lambda share, word: None)
    if restart is not None:
        check_alike(restart, prepared)
    with contextlib.ExitStack() as stack:
        if checkpoint is not None:
            with uninterrupted():
                checkpoint.load_libraries()
            stack.callback(checkpoint.begin().release)
        with told(tell):
            setup = build(prepared)
            setup.parcel.advance(0.0)
        for sentence in setup.doubts:
            if strict:
                raise SoundingError(sentence[:-1], "correct it, or leave ", Option("strict"), " out")
            if restart is None:
                warnings.warn(sentence, stacklevel=2)
        if prepared.replay is not None:
            prepared.replay.check(setup)
        frames = prepared.frames(setup)
        recording = Recording(prepared, setup, _attributes(prepared, setup, command, restart))
        if restart is not None:
            put_back(restart, recording)
            if recording.frames >= frames:
                raise FileError(f"{restart.source} is finished", from_file(restart.source), " to run it again")
        return _recorded(recording, frames, checkpoint, tell)


def _recorded(recording: Recording, frames: int, checkpoint: Checkpoint | None, tell: Progress) -> Outcome:
    """Record all frames of a run, or those before it is stopped, and save them."""
    parcel, last = recording.setup.parcel, 0.0

    def watch(now: float) -> None:
        nonlocal last
        if time.perf_counter() - last > _BREATH:
            last = time.perf_counter()
            tell(min(now / (frames * recording.setup.frame), 1.0), "running")

    def outcome(status: str) -> Outcome:
        dataset, headlines = recording.dataset(status)
        made = parcel.numerical_heat / (sum(parcel.energy()[:2]) or 1.0)
        cost = (recording.seconds, parcel.contacts, parcel.ledger(), recording.busy)
        return Outcome(dataset, headlines, *cost, made, parcel.escaped())

    try:
        while recording.frames < frames:
            recording.advance(watch)
            watch(parcel.time)
            if checkpoint is not None and recording.frames < frames:
                checkpoint(lambda: with_state(recording.dataset("partial")[0], recording))
        tell(1.0, "done")
        done = outcome("complete")
    except (StalledError, RefusedError) as error:
        raise EngineError(f"The run of {recording.prepared.scene} cannot go on: {error}.") from error
    except KeyboardInterrupt as stop:
        partial = outcome("interrupted") if recording.frames else None
        if partial is not None and checkpoint is not None:
            with uninterrupted():
                checkpoint.save(with_state(partial.dataset, recording))
        raise Interrupted(partial, getattr(stop, "exit_code", 130)) from None
    if checkpoint is not None:
        with uninterrupted():
            checkpoint.finish(done.dataset)
    return done


def _attributes(prepared: Prepared, setup: Setup, command: str, restart: Restart | None) -> dict[str, Any]:
    """Return the global attributes of the file; a resumed run keeps those of its beginning."""
    from atmosbox.file.provenance import global_attributes

    if restart is not None:
        return {name: value for name, value in restart.attributes.items() if name != "atmosbox_headlines"}
    panels = prepared.module.panels
    made = global_attributes(
        prepared.parameters,
        title=getattr(prepared.module, "title", prepared.scene),
        command=command or f"atmosbox run {prepared.scene}",
        comment=" ".join([*(prepared.module.__doc__ or "").split(), *(f"Doubtful: {each}" for each in setup.doubts)]),
        references=prepared.engine.engine.reference,
        panels=to_json(panels(prepared.settings) if callable(panels) else panels),
        status="partial",
    )
    return made if prepared.replay is None else made | prepared.replay.attributes(setup, made)


def prepared_again(restart: Restart, scene: str | os.PathLike[str] | None = None) -> Prepared:
    """Return the scenario of a run that is to continue, prepared as it was when the run began.

    Parameters
    ----------
    restart
        From `atmosbox.simulation.restart.read_state`.
    scene
        The path of the scene, if it is one of your own: a file alone never makes atmosbox run a program.

    Raises
    ------
    FileError
        If the file belongs to another scene, or to one of your own whose path is not given.
    """
    made = restart.about["settings"]
    typed = agreed(scene, str(made["scene"]), str(restart.source), "resume")
    engine, kept = str(made["engine"]), made["save_molecules"]
    prepared = prepare(typed, made["settings"], engine=engine, save_molecules=kept)
    again = read_link(made["replay"])[2] if "replay" in made else None
    return replace(prepared, expectation=None, stated=made.get("accuracy"), replay=again)

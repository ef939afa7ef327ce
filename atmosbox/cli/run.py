"""What ``atmosbox run`` does: run a scene, save it, and say what came out."""

from __future__ import annotations

import contextlib
import shlex
import signal
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Never

import typer

from atmosbox.cli.expectation import expectation_json, expectation_lines
from atmosbox.cli.progress import progress
from atmosbox.cli.report import next_command, outcome_json, outcome_lines, setting_lines
from atmosbox.cli.request import Request, is_path
from atmosbox.cli.table import table
from atmosbox.cli.terminal import INTERRUPTED, say, say_json, tell, width
from atmosbox.errors import AtmosboxError, FileError, PhysicsError

if TYPE_CHECKING:
    from atmosbox.file.checkpoint import Checkpoint
    from atmosbox.simulation.runner import Interrupted, Prepared

TERMINATED = 143  # what a shell reports of a program that was asked to end
FIGURES = (".png", ".svg", ".pdf")


def default_path(scene: str) -> Path:
    """Return the file of a run that was given no name.

    Examples
    --------
    >>> str(default_path("lifting_dry")), str(default_path("./my_scene.py"))
    ('lifting-dry.nc', 'my_scene.nc')
    """
    return Path(f"{Path(scene).stem}.nc" if is_path(scene) else f"{scene.replace('_', '-')}.nc")


def checked_path(out: str | None, scene: str) -> Path:
    """Return the file of a run, or refuse a name that is that of a figure."""
    path = default_path(scene) if out is None else Path(out)
    if path.suffix.lower() in FIGURES:
        data = shlex.quote(str(path.with_suffix(".nc")))
        figure = shlex.quote(str(path))
        raise FileError(
            f"{path} is the name of a figure, and run writes netCDF: "
            f"give --out {data}, then type atmosbox plot {data} --out {figure}."
        )
    return path


def run(
    request: Request,
    *,
    words: Sequence[str],
    out: str | None = None,
    force: bool = False,
    quiet: bool = False,
    verbose: bool = False,
    as_json: bool = False,
    dry_run: bool = False,
) -> None:
    """Run a scene as it was asked for, and say what came out.

    Parameters
    ----------
    request
        The scene and its settings.
    words
        What was typed, for the history of the file.
    out, force
        The file, and whether it may replace another.
    quiet, verbose, as_json, dry_run
        The options of these names.

    Raises
    ------
    AtmosboxError
        If something is refused or fails.
    typer.Exit
        With the status of an interruption, if the run was stopped.
    """
    from atmosbox.file.checkpoint import Checkpoint
    from atmosbox.simulation import runner

    scene, settings, engine, molecules, accuracy = request.gather()
    with _own_prints_to_stderr():
        prepared = runner.prepare(scene, settings, engine=engine, accuracy=accuracy, save_molecules=molecules)
    path = checked_path(out, prepared.scene)
    checkpoint = Checkpoint(path, force=force)
    if dry_run or verbose:
        _describe(prepared, path, quiet=quiet, as_json=as_json, dry_run=dry_run)
    if dry_run:
        return
    if checkpoint.stale and not quiet:
        tell(f"note: {checkpoint.part} is left from a run that was stopped, and will be replaced")
    command = shlex.join(words).encode("utf-8", "backslashreplace").decode("utf-8")
    before = _stamp(checkpoint.part)
    with _terminable() as asked_to_end:
        try:
            with _own_prints_to_stderr(), progress(prepared.scene, quiet=quiet) as show:
                outcome = runner.execute(prepared, checkpoint=checkpoint, progress=show, command=command)
        except runner.Interrupted as stop:
            _say_interrupted(stop, prepared, checkpoint, quiet=quiet, as_json=as_json)
            raise typer.Exit(TERMINATED if asked_to_end() else INTERRUPTED) from stop
        except (KeyboardInterrupt, AtmosboxError):
            if _stamp(checkpoint.part) not in (None, before):
                tell(f"note: the frames that were complete are kept in {checkpoint.part}")
            raise
    limit = runner.LEDGER_LIMIT
    if as_json:
        made = outcome_json(outcome, scene=prepared.scene, path=path, limit=limit)
        expected = expectation_json(prepared.expectation, outcome.headlines)
        about = {"settings": prepared.settings.as_dict(), "engine": str(prepared.engine), "accuracy": expected}
        say_json({**made, **about})
    else:
        about_errors = expectation_lines(prepared.expectation, outcome.headlines, str(prepared.engine), width())
        lines = outcome_lines(outcome, path=path, limit=limit, width=width(), expected=about_errors)
        say(str(path) if quiet else "\n".join(lines))
    if not outcome.ledger <= limit:
        raise PhysicsError(
            f"The energy ledger of this run is off by {outcome.ledger:.0e}, more than {limit:.0e}: "
            f"type {next_command('check', path)} to see what else is."
        )


def _describe(prepared: Prepared, path: Path, *, quiet: bool, as_json: bool, dry_run: bool) -> None:
    """Say what is about to be run, as the result of a dry run, else on stderr."""
    from atmosbox.simulation import runner

    with _own_prints_to_stderr():
        card = runner.card(prepared)
    settings = prepared.settings.as_dict()
    engine = f"{prepared.engine}: {prepared.engine.engine.summary}"
    if dry_run and as_json:
        facts = {"dry_run": True, "scene": card.scene, "title": card.title, "file": str(path)}
        expected = expectation_json(prepared.expectation)
        facts |= {"engine": str(prepared.engine), "accuracy": expected}
        say_json({**facts, "settings": settings, "facts": dict(card.facts)})
    elif dry_run and quiet:
        say(str(path))
    else:
        expected_lines = expectation_lines(prepared.expectation, (), str(prepared.engine), width())
        lines = [
            f"{card.scene}: {card.title}",
            "",
            *setting_lines(settings, card.parameters, width()),
            "",
            *table(["", ""], [("engine", engine), *card.facts], width()),
            *(["", *expected_lines] if expected_lines else []),
            "",
            f"file: {path}" + (" (not written: this is a dry run)" if dry_run else ""),
        ]
        (say if dry_run else tell)("\n".join(lines))


def _say_interrupted(
    stop: Interrupted, prepared: Prepared, checkpoint: Checkpoint, *, quiet: bool, as_json: bool
) -> None:
    """Say what is left of a run that was stopped, and how to look at it."""
    from atmosbox.simulation import runner

    if stop.outcome is None:
        tell("stopped before the first frame was complete: nothing is kept")
        return
    part = checkpoint.part
    frames = int(stop.outcome.dataset.sizes.get("elapsed_time", 0))
    tell(f"stopped: {frames} complete frames are kept in {part}; to see them: {next_command('plot', part)}")
    if as_json:
        made = outcome_json(stop.outcome, scene=prepared.scene, path=part, limit=runner.LEDGER_LIMIT)
        say_json({**made, "settings": prepared.settings.as_dict()})
    elif quiet:
        say(str(part))


def _own_prints_to_stderr() -> contextlib.AbstractContextManager[object]:
    """Keep what a scene of one's own prints out of the result."""
    return contextlib.redirect_stdout(sys.stderr)


def _stamp(path: Path) -> int | None:
    """Return when a file was last written; None if there is none."""
    return path.stat().st_mtime_ns if path.exists() else None


class _Terminated(KeyboardInterrupt):
    """Another program asked this one to end."""

    exit_code = TERMINATED


@contextlib.contextmanager
def _terminable() -> Iterator[Callable[[], bool]]:
    """Treat a request to end (SIGTERM) as Ctrl-C is treated; what is yielded tells whether there was one."""
    asked = False

    def stop(number: int, frame: object) -> Never:
        nonlocal asked
        asked = True
        raise _Terminated

    main = threading.current_thread() is threading.main_thread()
    ours = main and signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
    if ours:
        signal.signal(signal.SIGTERM, stop)
    try:
        yield lambda: asked
    finally:
        if ours:
            signal.signal(signal.SIGTERM, signal.SIG_DFL)

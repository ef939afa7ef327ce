"""The command ``run``: run a scene, save the run, and print its results."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from atmosbox.cli.application import command, typed
from atmosbox.cli.option import DryRun, Result, Sought, for_scene, netcdf_name, switch, text
from atmosbox.cli.request import checked, gather
from atmosbox.cli.terminal import prints_to_stderr, tell, width
from atmosbox.errors import AtmosboxError, FileError
from atmosbox.text.progress import progress
from atmosbox.text.table import table

if TYPE_CHECKING:
    from atmosbox.simulation.runner import Interrupted, Outcome, Prepared


@command(
    "atmosbox run lifting-dry",
    "atmosbox run lifting-dry temperature=25degC molecules=2000 --seed 7 --out warm.nc",
    "atmosbox run --from warm.nc temperature=5degC --out cold.nc",
    "atmosbox run --config lift.toml --dry-run",
    "atmosbox run temperature --accuracy sketch",
    "atmosbox run --resume lifting-dry.part.nc",
    'atmosbox run --replay "https://example.org/temperature-lab.html#atmosbox=..."',
    out="The netCDF file.  [default: SCENE.nc in this folder, or SCENE-2.nc if that is there]",
    quiet="Print only the path of the file.",
)
def run(
    ctx: typer.Context,
    sought: Sought,
    to: Result,
    save_molecules: Annotated[
        bool | None,
        typer.Option(
            "--save-molecules/--no-save-molecules",
            help="Save position and velocity of every molecule, in every frame.  "
            "[default: if they take less than 10 MB]",
            show_default=False,
        ),
    ] = None,
    replay: Annotated[
        str | None,
        text("LINK", "Repeat a run of the lab page, with every move of its sliders: give its link in quotes."),
    ] = None,
    resume: Annotated[
        str | None, text("FILE", "Go on with a run that was stopped or killed, from its NAME.part.nc.")
    ] = None,
    strict: Annotated[bool, switch("--strict", "Refuse a doubtful sounding instead of giving a warning.")] = False,
    dry_run: DryRun = False,
) -> None:
    """Run a scene and compare the results with theory.

    If a setting is given more than once, --seed overrides --set, --set overrides --config, and --config overrides
    --from. Ctrl-C stops a run and keeps the complete frames in NAME.part.nc. From there --resume goes on, bit for bit
    as if the run had never been stopped; this works after a crash, too.
    """
    from atmosbox.file.checkpoint import Checkpoint
    from atmosbox.file.output_path import run_is_there, unused, whole_path
    from atmosbox.simulation import runner
    from atmosbox.simulation.expected_time import expected_time, in_words
    from atmosbox.simulation.restart import read_state
    from atmosbox.simulation.verification import check_ledger
    from atmosbox.text.report import next_command

    restart = None
    with prints_to_stderr():
        if resume is not None:
            given = {**sought.changes(), "--replay": replay, "--save-molecules": save_molecules}
            runner.check_nothing_changes("a run that goes on", given)
            restart = read_state(resume)
            prepared = runner.prepared_again(restart, sought.scene)
        elif replay is not None:
            runner.check_nothing_changes("a run that is replayed", sought.changes())
            prepared = runner.replayed(replay, sought.scene, save_molecules=save_molecules)
        else:
            prepared = checked(gather(sought, save_molecules))
    default = for_scene(prepared.scene) if resume is None else whole_path(resume)
    path = netcdf_name(default if to.out is None else Path(to.out))
    numbered = to.out is None and resume is None and not to.force
    if dry_run:
        return _describe(prepared, unused(path, run_is_there) if numbered else path, to)
    checkpoint = Checkpoint(path, force=to.force, numbered=numbered)
    part = checkpoint.part
    if checkpoint.stale and not to.quiet and (resume is None or Path(resume).resolve() != part.resolve()):
        tell(f"note: {part} is left from a run that was stopped, and will be replaced")
    try:
        hint = None if restart is not None or replay is not None else expected_time(prepared)
        words = "" if hint is None else in_words(hint)
        with prints_to_stderr(), progress(prepared.scene, quiet=to.quiet, expected=words) as show:
            outcome = runner.execute(
                prepared, checkpoint=checkpoint, progress=show, command=typed(ctx), restart=restart, strict=strict
            )
    except runner.Interrupted as stop:
        if numbered:
            to.say_number(path, checkpoint.path)
        _say_interrupted(stop, prepared, checkpoint.part, to)
        raise typer.Exit(stop.exit_code) from stop
    except (KeyboardInterrupt, AtmosboxError):
        if checkpoint.part.exists() and not checkpoint.stale:
            tell(f"note: the frames that were complete are kept in {checkpoint.part}")
        raise
    if numbered:
        to.say_number(path, checkpoint.path)
    _say_outcome(outcome, prepared, checkpoint.path, to)
    look = next_command("check", checkpoint.path)
    check_ledger(outcome.ledger, "this run", f"type {look} to see what else is")


def _say_outcome(outcome: Outcome, prepared: Prepared, path: Path, to: Result) -> None:
    """Print the results of a complete run."""
    from atmosbox.cli.expectation import expectation_json, expectation_lines
    from atmosbox.text.report import outcome_json, outcome_lines

    record = outcome_json(outcome, prepared, path)
    record |= {"engine": str(prepared.engine), "accuracy": expectation_json(prepared.expectation, outcome.headlines)}
    expected = expectation_lines(prepared.expectation, outcome.headlines, prepared.unusual_engine, width())
    lines = outcome_lines(outcome, path, width(), expected)
    if prepared.save_molecules is None and not {"molecule_position", "disc_position"} & set(outcome.dataset):
        lines.insert(-2, "molecules: not kept, because they take more than 10 MB; --save-molecules keeps them for view")
    to.say(path, record, lines)


def _describe(prepared: Prepared, path: Path, to: Result) -> None:
    """Print what would run."""
    from atmosbox.cli.expectation import expectation_json, expectation_lines
    from atmosbox.simulation import runner
    from atmosbox.simulation.expected_time import expected_time, in_words
    from atmosbox.text.report import setting_lines

    with prints_to_stderr():
        card = runner.card(prepared)
    settings, hint = prepared.settings.as_dict(), expected_time(prepared)
    expected = expectation_lines(prepared.expectation, (), prepared.unusual_engine, width())
    facts = [("engine", f"{prepared.engine}: {prepared.engine.engine.summary}"), *card.facts]
    lines = [
        f"{card.scene}: {card.title}",
        "",
        *setting_lines(settings, card.parameters, width()),
        "",
        *table(["", ""], [*facts, *([] if hint is None else [("a run takes", in_words(hint))])], width()),
        *(["", *expected] if expected else []),
        "",
        f"file: {path} (not written: this is a dry run)",
    ]
    record: dict[str, Any] = {"dry_run": True, "scene": card.scene, "title": card.title, "file": str(path)}
    record |= {"engine": str(prepared.engine), "accuracy": expectation_json(prepared.expectation)}
    record |= {"expected_seconds": hint, "settings": settings, "facts": dict(card.facts)}
    to.say(path, record, lines)


def _say_interrupted(stop: Interrupted, prepared: Prepared, part: Path, to: Result) -> None:
    """Print what has been saved of a run that was stopped, and how to look at it."""
    from atmosbox.text.report import next_command, outcome_json

    if stop.outcome is None:
        return tell("stopped before the first frame was complete: nothing is kept")
    from atmosbox.plot.run_figure import panels_of

    kept = f"stopped: {stop.outcome.dataset.sizes.get('elapsed_time', 0)} complete frames are kept in {part}"
    with contextlib.suppress(FileError):  # of too few frames there is no figure
        panels_of(stop.outcome.dataset)
        kept += f"; to see them: {next_command('plot', part)}"
    tell(kept)
    tell(f"to go on: {next_command('run --resume', part)}")
    if to.as_json or to.quiet:
        to.say(part, outcome_json(stop.outcome, prepared, part), ())

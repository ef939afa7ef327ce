"""The command ``run``: run a scene, save the run, and print its results."""

from __future__ import annotations

import contextlib
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from atmosbox.cli import option
from atmosbox.cli.application import command, typed
from atmosbox.cli.option import for_scene, netcdf_name, say_number
from atmosbox.cli.request import checked, gather
from atmosbox.cli.terminal import prints_to_stderr, say, say_json, tell, width
from atmosbox.errors import AtmosboxError, FileError, PhysicsError
from atmosbox.text.progress import progress
from atmosbox.text.table import table

if TYPE_CHECKING:
    from atmosbox.file.checkpoint import Checkpoint
    from atmosbox.simulation.runner import Interrupted, Outcome, Prepared


@command(
    "atmosbox run lifting-dry",
    "atmosbox run lifting-dry temperature=25degC molecules=2000 --seed 7 --out warm.nc",
    "atmosbox run --from warm.nc temperature=5degC --out cold.nc",
    "atmosbox run --config lift.toml --dry-run",
    "atmosbox run temperature --accuracy sketch",
    "atmosbox run --resume lifting-dry.part.nc",
    'atmosbox run --replay "https://example.org/temperature-lab.html#atmosbox=..."',
)
def run(
    ctx: typer.Context,
    scene: Annotated[str | None, option.SceneName] = None,
    values: option.Values = None,
    config: option.Config = None,
    source: option.Source = None,
    seed: option.Seed = None,
    engine: option.Engine = None,
    accuracy: option.Accuracy = None,
    out: Annotated[
        str | None,
        option.out_option("The netCDF file.  [default: SCENE.nc in this folder, or SCENE-2.nc if that is there]"),
    ] = None,
    force: option.Force = False,
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
        typer.Option(
            metavar="LINK", help="Repeat a run of the lab page, with every turn of its knobs: give its link in quotes."
        ),
    ] = None,
    resume: Annotated[
        str | None,
        typer.Option(metavar="FILE", help="Go on with a run that was stopped or killed, from its NAME.part.nc."),
    ] = None,
    strict: Annotated[
        bool, typer.Option("--strict", help="Refuse a doubtful sounding instead of giving a warning.")
    ] = False,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Show what would run, compute nothing and write nothing.")
    ] = False,
    as_json: option.Json = False,
    quiet: Annotated[bool, option.quiet_option("Print only the path of the file.")] = False,
    verbose: option.Verbose = False,
) -> None:
    """Run a scene and compare the results with theory.

    If a setting is given more than once, --seed counts before --set, --set before --config, and --config before --from.
    Ctrl-C stops a run and keeps the complete frames in NAME.part.nc. From there --resume goes on, bit for bit as if the
    run had never been stopped; this works after a crash, too.
    """
    from atmosbox.file.checkpoint import Checkpoint
    from atmosbox.file.output_path import run_is_there, unused, whole_path
    from atmosbox.simulation import runner
    from atmosbox.simulation.expected_time import expected_time
    from atmosbox.simulation.restart import read_state

    restart = None
    given: dict[str, object] = {"--set": values, "--config": config, "--from": source, "--seed": seed}
    given |= {"--engine": engine, "--accuracy": accuracy}
    if resume is not None:
        given |= {"--replay": replay, "--save-molecules": save_molecules}
        runner.check_nothing_changes("a run that goes on", given)
        restart = read_state(resume)
        with prints_to_stderr():
            prepared = runner.prepared_again(restart, scene)
    elif replay is not None:
        runner.check_nothing_changes("a run that is replayed", given)
        with prints_to_stderr():
            prepared = runner.replayed(replay, scene, save_molecules=save_molecules)
    else:
        prepared = checked(gather(scene, values or (), config, source, seed, save_molecules, engine, accuracy))
    default = for_scene(prepared.scene) if resume is None else whole_path(resume)
    path = netcdf_name(default if out is None else Path(out))
    numbered = out is None and resume is None and not force
    if dry_run:
        path = unused(path, run_is_there) if numbered else path
        _describe(prepared, path, quiet=quiet, as_json=as_json, dry_run=True)
        return
    checkpoint = Checkpoint(path, force=force, numbered=numbered)
    if verbose:
        _describe(prepared, checkpoint.path, quiet=quiet, as_json=as_json, dry_run=False)
    if checkpoint.stale and not quiet and (resume is None or Path(resume).resolve() != checkpoint.part.resolve()):
        tell(f"note: {checkpoint.part} is left from a run that was stopped, and will be replaced")
    try:
        hint = None if restart is not None or replay is not None else expected_time(prepared)
        words = "" if hint is None else str(hint)
        with prints_to_stderr(), progress(prepared.scene, quiet=quiet, expected=words) as show:
            outcome = runner.execute(
                prepared,
                checkpoint=checkpoint,
                progress=show,
                command=typed(ctx),
                restart=restart,
                strict=strict,
            )
    except runner.Interrupted as stop:
        if numbered and not quiet:
            say_number(path, checkpoint.path)
        _say_interrupted(stop, prepared, checkpoint, quiet=quiet, as_json=as_json)
        raise typer.Exit(stop.exit_code) from stop
    except (KeyboardInterrupt, AtmosboxError):
        if checkpoint.part.exists() and not checkpoint.stale:
            tell(f"note: the frames that were complete are kept in {checkpoint.part}")
        raise
    if numbered and not quiet:
        say_number(path, checkpoint.path)
    _say_outcome(outcome, prepared, checkpoint.path, quiet=quiet, as_json=as_json)
    if not outcome.ledger <= runner.LEDGER_LIMIT:
        from atmosbox.text.report import next_command

        raise PhysicsError(
            f"The energy budget of this run is off by {outcome.ledger:.0e}, more than {runner.LEDGER_LIMIT:.0e}: "
            f"type {next_command('check', checkpoint.path)} to see what else is."
        )


def _say_outcome(outcome: Outcome, prepared: Prepared, path: Path, *, quiet: bool, as_json: bool) -> None:
    """Print the results of a complete run."""
    from atmosbox.cli.expectation import expectation_json, expectation_lines
    from atmosbox.simulation.runner import LEDGER_LIMIT
    from atmosbox.text.report import outcome_json, outcome_lines

    if as_json:
        made = outcome_json(outcome, scene=prepared.scene, path=path, limit=LEDGER_LIMIT)
        expected = expectation_json(prepared.expectation, outcome.headlines)
        about = {"settings": prepared.settings.as_dict(), "engine": str(prepared.engine), "accuracy": expected}
        say_json({**made, **about})
    elif quiet:
        say(str(path))
    else:
        expected_lines = expectation_lines(prepared.expectation, outcome.headlines, prepared.unusual_engine, width())
        lines = outcome_lines(outcome, path=path, limit=LEDGER_LIMIT, width=width(), expected=expected_lines)
        if prepared.save_molecules is None and not {"molecule_position", "disc_position"} & set(outcome.dataset):
            lines.insert(-2, "molecules: not kept, for they take more than 10 MB; --save-molecules keeps them for view")
        say("\n".join(lines))


def _describe(prepared: Prepared, path: Path, *, quiet: bool, as_json: bool, dry_run: bool) -> None:
    """Print what is going to run: on stdout for a dry run, otherwise on stderr."""
    from atmosbox.cli.expectation import expectation_json, expectation_lines
    from atmosbox.simulation import runner
    from atmosbox.simulation.expected_time import expected_time
    from atmosbox.text.report import setting_lines

    with prints_to_stderr():
        card = runner.card(prepared)
    settings = prepared.settings.as_dict()
    engine = f"{prepared.engine}: {prepared.engine.engine.summary}"
    hint = expected_time(prepared)
    if dry_run and as_json:
        facts = {"dry_run": True, "scene": card.scene, "title": card.title, "file": str(path)}
        expected = expectation_json(prepared.expectation)
        facts |= {"engine": str(prepared.engine), "accuracy": expected}
        facts["expected_seconds"] = None if hint is None else hint.seconds
        say_json({**facts, "settings": settings, "facts": dict(card.facts)})
    elif dry_run and quiet:
        say(str(path))
    else:
        expected_lines = expectation_lines(prepared.expectation, (), prepared.unusual_engine, width())
        times = [] if hint is None else [("a run takes", str(hint))]
        lines = [
            f"{card.scene}: {card.title}",
            "",
            *setting_lines(settings, card.parameters, width()),
            "",
            *table(["", ""], [("engine", engine), *card.facts, *times], width()),
            *(["", *expected_lines] if expected_lines else []),
            "",
            f"file: {path}" + (" (not written: this is a dry run)" if dry_run else ""),
        ]
        (say if dry_run else tell)("\n".join(lines))


def _say_interrupted(
    stop: Interrupted, prepared: Prepared, checkpoint: Checkpoint, *, quiet: bool, as_json: bool
) -> None:
    """Print what has been saved of a run that was stopped, and how to look at it."""
    from atmosbox.simulation.runner import LEDGER_LIMIT
    from atmosbox.text.report import next_command, outcome_json

    if stop.outcome is None:
        tell("stopped before the first frame was complete: nothing is kept")
        return
    part = checkpoint.part
    frames = int(stop.outcome.dataset.sizes.get("elapsed_time", 0))
    from atmosbox.plot.run_figure import panels_of

    kept = f"stopped: {frames} complete frames are kept in {part}"
    with contextlib.suppress(FileError):  # of too few frames there is no figure
        panels_of(stop.outcome.dataset)
        kept += f"; to see them: {next_command('plot', part)}"
    tell(kept)
    tell(f"to go on: {next_command('run --resume', part)}")
    if as_json:
        made = outcome_json(stop.outcome, scene=prepared.scene, path=part, limit=LEDGER_LIMIT)
        say_json({**made, "settings": prepared.settings.as_dict()})
    elif quiet:
        say(str(part))

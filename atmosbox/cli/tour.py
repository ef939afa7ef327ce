"""The command ``tour``: a tour of the program in ten minutes, each step with its command."""

from __future__ import annotations

import shlex
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, NamedTuple

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Verbose
from atmosbox.cli.terminal import say, tell
from atmosbox.errors import AtmosboxError, FileError, SettingError

FOLDER = "atmosbox-tour"


class Step(NamedTuple):
    """A step of the tour: its title, what it shows, and its commands without the name of the program."""

    title: str
    words: str
    commands: tuple[str, ...]


STEPS = (
    Step(
        "What there is",
        "Each scene is an experiment with molecules, and a page of meteorology that must come out of it.",
        ("list",),
    ),
    Step(
        "One scene",
        "What it models, what it leaves out, and what you may set, with units and ranges.",
        ("info temperature",),
    ),
    Step(
        "Predict, then run",
        "200 molecules of air at -150 degC come between walls of 25 degC. How warm will they be, how exactly "
        "can one say? Every number has its error bar and the textbook's value beside it.",
        ("run temperature --set duration=6ns --save-molecules -o mild.nc",),
    ),
    Step(
        "Draw it",
        "Open mild.png. Cold molecules become as warm as the walls; their impacts are the pressure.",
        ("plot mild.nc",),
    ),
    Step(
        "Watch it",
        "Open mild.html in a browser: molecules and graphs on one clock. Space plays, a click follows a molecule.",
        ("view mild.nc",),
    ),
    Step(
        "Change one thing",
        "The walls are at 300 degC now, and the box so much larger that the pressure is the same. What stays, what "
        "changes?",
        (
            "run temperature --set duration=6ns --set temperature=300degC -o hot.nc",
            "compare mild.nc hot.nc",
        ),
    ),
    Step(
        "Air that rises",
        "Nothing cools these 800 molecules but the ceiling that recedes. The dry adiabat comes out; so fast an ascent "
        "arrives a little too warm, and the table says by how much it may.",
        ("run lifting-dry --set molecules=800 --set ascent=200 -o lift.nc", "plot lift.nc"),
    ),
    Step(
        "A cloud",
        "The same with 12000 molecules of moist air: below the cloud base they cool as dry air does, above it more "
        "slowly.",
        ("run lifting-moist --set molecules=12000 --set ascent=150 -o cloud.nc", "plot cloud.nc"),
    ),
    Step(
        "Can it be trusted?",
        "The energy budget must be closed, no molecule may be lost, and what is reported must agree with theory.",
        ("check lift.nc",),
    ),
    Step(
        "The same run again",
        "Settings, seed and version stand in the file, so that anyone can repeat it. The differences are zero.",
        ("run --from lift.nc -o again.nc --quiet", "compare lift.nc again.nc"),
    ),
    Step(
        "How it depends on a setting",
        "Slower ascents come nearer to the adiabat: four runs, and one table.",
        ("sweep lifting-dry --set molecules=400 --vary ascent=25,50,100,200 -o sweep",),
    ),
    Step(
        "A worksheet",
        "Goal, predictions, the command to type, a table to fill: lifting-dry-sheet.md is for students, and --answers "
        "fills it in for you.",
        ("sheet lifting-dry --set molecules=800 --set ascent=200 -o lifting-dry-sheet.md",),
    ),
)
LAST = """\
What is left needs your hands: atmosbox live temperature lets a class change a box while it runs, and in Python it
is import atmosbox as ab; run = ab.run("lifting-dry"); ab.plot(run)."""


@command("atmosbox tour", "atmosbox tour --yes")
def tour(
    yes: Annotated[bool, typer.Option("--yes", "-y", help="Go through without waiting for Enter.")] = False,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="FOLDER", help=f"Where the files go.  [default: {FOLDER}]"),
    ] = None,
    verbose: Verbose = False,
) -> None:
    """Go through the program in ten minutes, on a few hundred molecules, each step with its command.

    Enter goes on; Ctrl-C leaves, and what has been made stays. The files are in a separate folder.
    """
    if not yes and not sys.stdin.isatty():
        raise SettingError("tour", None, "waits for Enter, and there is no terminal", "give --yes")
    folder = _folder(Path(out) if out is not None else None)
    try:
        for number, step in enumerate(STEPS, 1):
            _show(step, number)
            for command in step.commands:
                _run(command, folder, wait=not yes)
        say(f"\n{LAST}\n")
    finally:
        if any(folder.iterdir()):
            tell(f"the files of the tour are in {folder}")
        else:
            folder.rmdir()


def _folder(wanted: Path | None) -> Path:
    """Make and return a new folder for the files: the one that was asked for, or the first default name not in use."""
    tried = [wanted] if wanted is not None else [Path(FOLDER + end) for end in ("", *(f"-{k}" for k in range(2, 1000)))]
    folder = next((each for each in tried if each is not None and not each.exists()), None)
    if folder is None:
        raise FileError(f"The folder {tried[0]} is there already: give --out another one.")
    try:
        folder.mkdir(parents=True)
    except OSError as error:
        raise FileError(f"The folder {folder} cannot be made: {error.strerror}.") from error
    return folder


def _show(step: Step, number: int) -> None:
    """Print the explanation of a step, in lines that fit the terminal."""
    import textwrap

    columns = min(shutil.get_terminal_size().columns, 100)
    say("\n" + f"── {number} of {len(STEPS)} ── {step.title} ".ljust(columns, "─"))
    say(textwrap.fill(step.words, columns))


def _run(command: str, folder: Path, *, wait: bool) -> None:
    """Print a command, wait for Enter, and run the command as if it had been typed."""
    say(f"\n$ atmosbox {command}")
    sys.stdout.flush()
    if wait:
        try:
            input("  [Enter] ")
        except EOFError as error:  # Ctrl-D
            raise KeyboardInterrupt from error
    status = _status([sys.executable, "-m", "atmosbox", *shlex.split(command)], folder)
    if status in (130, 143, -2, -15):
        raise KeyboardInterrupt
    if status:
        raise AtmosboxError(
            f"The tour cannot go on, for atmosbox {command} has failed: mend what it says, and begin anew."
        )


def _status(words: Sequence[str], folder: Path) -> int:
    """Run a command and return its exit status; after Ctrl-C, wait until the command has cleaned up."""
    with subprocess.Popen(words, cwd=folder) as running:
        try:
            return running.wait()
        except KeyboardInterrupt:
            running.wait()
            raise
        except BaseException:  # SIGTERM reaches only this process
            running.terminate()
            running.wait()
            raise

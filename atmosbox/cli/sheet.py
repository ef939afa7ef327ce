"""What ``atmosbox sheet`` does: make a worksheet of a scene, for students or with the answers."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Sequence
from pathlib import Path

from atmosbox.cli.progress import progress
from atmosbox.cli.request import Request
from atmosbox.cli.run import default_path
from atmosbox.cli.terminal import say, tell


def default_sheet(scene: str, *, answers: bool, format: str | None) -> Path:
    """Return the file of a sheet that was given no name.

    Examples
    --------
    >>> str(default_sheet("lifting_dry", answers=False, format=None))
    'lifting-dry-sheet.pdf'
    >>> str(default_sheet("./my_scene.py", answers=True, format="md"))
    'my_scene-answers.md'
    """
    return Path(f"{default_path(scene).stem}-{'answers' if answers else 'sheet'}.{format or 'pdf'}")


def sheet(
    scene: str,
    *,
    values: Sequence[str],
    seed: str | None,
    engine: str | None,
    answers: bool,
    paper: str,
    format: str | None,
    out: str | None,
    force: bool,
    quiet: bool,
) -> None:
    """Make a worksheet and say where it is.

    Parameters
    ----------
    scene
        The name of the scene, or the path of its file.
    values, seed, engine
        What stood behind each ``--set``, behind ``--seed`` and behind ``--engine``.
    answers, paper, format, out, force, quiet
        The options of these names.

    Raises
    ------
    AtmosboxError
        If something is refused or fails.
    KeyboardInterrupt
        If a run was stopped; then no sheet is written.
    """
    from atmosbox import sheet as sheets

    asked = Request(scene, values, seed=seed, engine=engine).gather()
    path = default_sheet(scene, answers=answers, format=format) if out is None else Path(out)
    path = sheets.check(path, format, paper=paper, force=force)
    # what a scene of one's own prints is no result
    with contextlib.redirect_stdout(sys.stderr), progress(scene, quiet=quiet) as show:
        made = sheets.worksheet(asked.scene, asked.settings, engine=asked.engine, answers=answers, progress=show)
    if not quiet:
        for sentence in made.disagreements:
            tell(f"warning: {sentence}")
    say(str(sheets.save(made, path, paper=paper, force=force)))

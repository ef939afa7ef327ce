"""The command ``sheet``: a worksheet of a scene, for students or with the answers."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Engine, Output, SceneName, Seed, Sought, ValuesOfAll, for_scene, switch
from atmosbox.cli.request import gather
from atmosbox.cli.terminal import prints_to_stderr, say, tell
from atmosbox.text.progress import progress

if TYPE_CHECKING:
    from atmosbox.sheet.worksheet import Worksheet


@command(
    "atmosbox sheet lifting-dry",
    "atmosbox sheet lifting-dry --seed 7 --answers",
    "atmosbox sheet temperature --set temperature=20degC --paper letter --out class.pdf",
    "atmosbox sheet temperature --lab",
    "atmosbox sheet temperature --language de",
    "atmosbox sheet ./my_scene.py --format html",
    out="The sheet.  [default: SCENE-sheet.pdf, or SCENE-answers.pdf, in this folder]",
    quiet="Show no progress and no remarks.",
)
def sheet(
    scene: Annotated[str, SceneName],
    to: Output,
    answers: Annotated[bool, switch("--answers", "Make the runs, fill in the table, answer the questions.")] = False,
    lab: Annotated[
        bool, switch("--lab", "Use a page for each run instead of commands, and write these pages beside the sheet.")
    ] = False,
    values: ValuesOfAll = None,
    seed: Seed = None,
    engine: Engine = None,
    language: Annotated[Literal["en", "de"], typer.Option(help="The language of the sheet.")] = "en",
    paper: Annotated[Literal["a4", "letter"], typer.Option(help="The size of the pages.")] = "a4",
    format: Annotated[
        Literal["pdf", "html", "md"] | None,
        typer.Option(help="The format, where the name of the file does not say it."),
    ] = None,
) -> None:
    """Make a worksheet to hand out: predict, run, measure, ask why.

    The text of a sheet is in a file beside its scene, SCENE.sheet.toml. For a scene of your own without such a file,
    the sheet is made from what a run reports.
    """
    from atmosbox import sheet as sheets

    asked = gather(Sought(scene, values, seed=seed, engine=engine))
    if lab:
        asked = asked.for_a_page()
    ending = "" if language == "en" else f"-{language}"
    default = for_scene(scene, f"-{'answers' if answers else 'sheet'}{ending}.{format or 'pdf'}")
    path = sheets.check(to.path(default), format, paper=paper, force=to.force)
    with prints_to_stderr(), progress(scene, quiet=to.quiet) as show:
        made = sheets.worksheet(
            asked.scene, asked.settings, engine=asked.engine, answers=answers, lab=lab, language=language, progress=show
        )
        pages = _pages(made, path.parent, to.force) if lab else []
    if not to.quiet:
        for sentence in made.disagreements:
            tell(f"warning: {sentence}")
    say(str(sheets.save(made, path, paper=paper, force=to.force)))
    for page in pages:
        say(str(page))


def _pages(made: Worksheet, folder: Path, force: bool) -> list[Path]:
    """Write the page of each run beside the sheet, unless it is there; all paths are checked before one is written."""
    from atmosbox.file.output_path import check_writable, write_whole
    from atmosbox.lab.page_file import lab_text

    pages = {folder / run.page: lab_text(run.prepared, others=False).encode("utf-8") for run in made.runs}
    # the page of the same run is the same file each time, so a second sheet uses the one that is there
    missing = {path: page for path, page in pages.items() if not path.is_file() or path.read_bytes() != page}
    for path in missing:
        check_writable(path, force)
    for path, page in missing.items():
        write_whole(path, page)
    return list(pages)

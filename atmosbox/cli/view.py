"""The command ``view``: the molecules of a run on a page."""

from typing import Annotated

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Language, Output, PageTheme, beside
from atmosbox.cli.terminal import say
from atmosbox.errors import SettingError
from atmosbox.text.progress import progress

MOST = 2


@command(
    "atmosbox view temperature.nc",
    "atmosbox view cold.nc warm.nc --out compared.html --theme dark",
    "atmosbox view temperature.nc --language es --force",
    out="The page.  [default: beside FILE, named after it]",
    quiet="Print only the path of the page.",
)
def view(
    files: Annotated[
        list[str], typer.Argument(metavar="FILE [FILE]", help="One run or two that kept their molecules.")
    ],
    to: Output,
    theme: PageTheme = "auto",
    language: Language = "auto",
) -> None:
    """Write a page that plays a run: the molecules in three dimensions, and the graphs.

    The page is one HTML file, which opens in a browser without a network. Two runs stand side by side, with one clock.
    """
    if len(files) > MOST:
        raise SettingError("FILE", None, f"is given {len(files)} times", "give one run, or two to compare")
    with progress("view", quiet=to.quiet) as show:
        show(0.0, "reading the molecules")
        from atmosbox.file.netcdf import read
        from atmosbox.file.output_path import check_writable

        path = check_writable(to.path(beside(files, "html")), to.force)
        runs = [read(file) for file in files]
        show(0.4, "writing the page")
        from atmosbox.page import save

        written = save(runs, path, theme=theme, language=language, force=to.force)
    say(str(written))

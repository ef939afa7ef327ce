"""The page of a run in a notebook: the molecules in their box, in three dimensions, below the cell."""

from __future__ import annotations

import html
import os
import webbrowser
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from atmosbox.interface.notebook import in_notebook

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["InlinePage", "show"]


class InlinePage:
    """A page that a notebook shows in a frame of its own; it needs no network.

    Attributes
    ----------
    text : str
        The complete HTML of the page.
    height : int
        Height of the frame in pixels.
    """

    def __init__(self, text: str, height: int) -> None:
        self.text = text
        self.height = height

    def __repr__(self) -> str:
        """Return a line that says how large the page is and how to save it."""
        return f'page of {len(self.text) / 1e6:.1f} MB; page.save("page.html") keeps it'

    def _repr_html_(self) -> str:
        """Return the frame that shows the page."""
        return (
            f'<iframe srcdoc="{html.escape(self.text)}" title="The molecules of the run in their box, and its graphs"'
            f' style="width:100%;height:{self.height}px;border:0" allow="fullscreen" loading="lazy"></iframe>'
        )

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> Path:
        """Write the page to a file, which a browser can open from the disk.

        Parameters
        ----------
        path
            The file; it should end in ``.html``.
        force
            Whether a file of that name may be replaced.

        Raises
        ------
        FileError
            If the file exists or cannot be written.
        """
        from atmosbox.file.output_path import check_writable, write_whole

        target = check_writable(path, force, example="page.html")
        write_whole(target, self.text.encode("utf-8"))
        return target


def show(
    *runs: xr.Dataset | str | os.PathLike[str],
    height: int = 720,
    theme: Literal["auto", "light", "dark"] = "auto",
    language: Literal["auto", "en", "de", "es"] = "auto",
) -> InlinePage:
    """Show the molecules of a run in three dimensions, with its graphs on the same clock.

    In a notebook the page is shown below the cell; elsewhere it opens in the browser.

    Parameters
    ----------
    *runs
        One run, or two to be shown side by side with one clock: datasets or paths of files, made with
        ``save_molecules=True``.
    height
        Height of the page in a notebook, in pixels.
    theme
        Colours of the page; ``"auto"`` takes those that the reader's computer prefers.
    language
        Language of the page; ``"auto"`` takes the first language of the reader's browser that the page has.

    Returns
    -------
    InlinePage
        The page; its ``save`` writes it to a file to hand out.

    Raises
    ------
    FileError
        If a run holds no molecules.
    SettingError
        If there is no run or more than two, or the theme or the language is unknown.

    Examples
    --------
    >>> import atmosbox as ab
    >>> ab.show(ab.run("temperature", molecules=50, duration="5 ns", save_molecules=False))
    Traceback (most recent call last):
    atmosbox.errors.FileError: The run holds no molecules: type atmosbox.run("temperature", save_molecules=True).
    """
    from atmosbox.errors import SettingError
    from atmosbox.interface.drawing import opened
    from atmosbox.page.page_file import page_text

    if not 1 <= len(runs) <= 2:
        raise SettingError("runs", None, f"are {len(runs)}", "give one run, or two to stand side by side")
    page = InlinePage(page_text([opened(run) for run in runs], theme=theme, language=language), height)
    if not in_notebook():
        _open(page)
    return page


def _open(page: InlinePage) -> None:
    """Open a page in the browser, from a file that stays until the computer's temporary files are cleared."""
    import tempfile

    folder = Path(tempfile.mkdtemp(prefix="atmosbox-page-"))
    webbrowser.open(page.save(folder / "page.html").as_uri())

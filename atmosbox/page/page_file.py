"""The page of a run as a file, which appears only when it is complete."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from atmosbox.errors import SettingError
from atmosbox.file.output_path import check_writable, write_whole
from atmosbox.page.document import LANGUAGES, THEMES, view_page
from atmosbox.page.frame import pack

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["check_choice", "page_text", "save"]


def save(
    runs: Sequence[xr.Dataset],
    path: str | os.PathLike[str],
    *,
    theme: str = "auto",
    language: str = "auto",
    force: bool = False,
) -> Path:
    """Write the page that shows a run, or two side by side.

    Parameters
    ----------
    runs : sequence of xarray.Dataset
        One run or two, with their molecules, as `atmosbox.file.netcdf.read` returns them.
    path : str or path-like
        The file; it should end in ``.html``.
    theme : {"auto", "light", "dark"}
        The colours of the page.
    language : {"auto", "en", "de", "es"}
        Language of the page; ``auto`` takes the first language of the reader's browser that the page has.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    FileError
        If a run holds no molecules, or the file cannot be written.
    SettingError
        If the theme or the language is unknown.

    Notes
    -----
    The page contains neither a date nor a random number: the same runs give the same bytes.

    Examples
    --------
    >>> import xarray as xr
    >>> save([xr.Dataset()], "page.html", theme="pink")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: theme = pink is unknown: give auto, light or dark.
    """
    check_choice("theme", theme, THEMES)
    check_choice("language", language, LANGUAGES)
    target = check_writable(path, force, example="page.html")
    write_whole(target, page_text(runs, theme=theme, language=language).encode("utf-8"))
    return target


def page_text(runs: Sequence[xr.Dataset], *, theme: str = "auto", language: str = "auto") -> str:
    """Return the HTML of the page that `save` writes.

    Raises
    ------
    FileError
        If a run holds no molecules.
    SettingError
        If the theme or the language is unknown.
    """
    from atmosbox.page.saved_run import pages

    check_choice("theme", theme, THEMES)
    check_choice("language", language, LANGUAGES)
    told = pages(runs)
    records, frames = [page.record for page in told], [pack(page.frames) for page in told]
    return view_page(records, frames, theme=theme, language=language)


def check_choice(name: str, value: str, known: Sequence[str]) -> None:
    """Refuse a theme or a language that does not exist.

    Raises
    ------
    SettingError
        If the value is not one of the known ones.
    """
    if value not in known:
        raise SettingError(name, value, "is unknown", f"give {', '.join(known[:-1])} or {known[-1]}")

"""What ``atmosbox view`` does: from files of runs to a page."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from atmosbox.cli.progress import progress
from atmosbox.cli.terminal import say
from atmosbox.errors import SettingError

__all__ = ["view"]

MOST = 2


def view(files: Sequence[str], out: str | None, *, theme: str, force: bool) -> None:
    """Write the page of a run or of two, and say where it is.

    Parameters
    ----------
    files
        The files of the runs.
    out
        The page; None for one beside the first file, by its name.
    theme
        The colours: ``auto``, ``light`` or ``dark``.
    force
        Whether a page of that name may be replaced.

    Raises
    ------
    SettingError
        If there are more than two files.
    FileError
        If a file is no run, holds no molecules, or the page cannot be written.

    Examples
    --------
    >>> view(["a.nc", "b.nc", "c.nc"], None, theme="auto", force=False)
    Traceback (most recent call last):
    atmosbox.errors.SettingError: FILE is given 3 times: give one run, or two to compare.
    """
    if len(files) > MOST:
        raise SettingError("FILE", None, f"is given {len(files)} times", "give one run, or two to compare")
    with progress("view", quiet=False) as show:
        show(0.0, "reading the molecules")
        from atmosbox.file.netcdf import read
        from atmosbox.file.output_path import check_writable

        path = Path(out) if out is not None else _beside(files)
        check_writable(path, force)
        runs = [read(file) for file in files]
        show(0.4, "writing the page")
        from atmosbox.page import save

        written = save(runs, path, theme=theme, force=force)
    say(str(written))


def _beside(files: Sequence[str]) -> Path:
    """Return the page beside the first file, named after all of them."""
    first = Path(files[0])
    rest = "".join(f"-and-{Path(file).stem}" for file in files[1:])
    return first.with_name(f"{first.stem}{rest}.html")

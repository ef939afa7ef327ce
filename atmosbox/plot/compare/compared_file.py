"""The figure of several runs as a file."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from pathlib import Path

import xarray as xr
from matplotlib.figure import Figure

from atmosbox.errors import SettingError
from atmosbox.file.output_path import named, write_whole
from atmosbox.plot import FORMATS
from atmosbox.plot.compare.change import Naming
from atmosbox.plot.comparison import MOST, figure
from atmosbox.plot.figure_file import render
from atmosbox.plot.theme import find

__all__ = ["save"]

_SPELLED = {"degC": "°C", "percent": "%", "um": "µm"}


def save(
    datasets: Sequence[xr.Dataset],
    names: Naming,
    path: str | os.PathLike[str],
    format: str | None = None,
    *,
    theme: str = "notes",
    force: bool = False,
) -> Path:
    """Draw several runs into one figure.

    Parameters
    ----------
    datasets : sequence of xarray.Dataset
        The runs, two to six.
    names : Naming
        The labels of the runs, and the settings that differ.
    path : str or path-like
        The file; its suffix gives the format unless ``format`` does.
    format : {"png", "svg", "pdf"}, optional
        The format, by default that of the suffix.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    FileError
        If the file exists, cannot be written, or the runs have no graph in common.
    SettingError
        If there are fewer than two or more than six runs, or the format or the theme is unknown.

    Examples
    --------
    >>> save([], Naming((), (), (), same=False), "both.png")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: FILE is given 0 times: give two to six runs.
    """
    if not 2 <= len(datasets) <= MOST:
        raise SettingError("FILE", None, f"is given {len(datasets)} times", "give two to six runs")
    path, kind = named(path, format, FORMATS, force=force)
    find(theme)
    drawing, title = drawn(datasets, names, theme)
    parameters = "; ".join(str(dataset.attrs.get("atmosbox_parameters", "")) for dataset in datasets)
    write_whole(path, render(drawing, kind, theme, title=title, parameters=parameters))
    return path


def drawn(datasets: Sequence[xr.Dataset], names: Naming, theme: str) -> tuple[Figure, str]:
    """Return the figure of several runs, and its title."""
    scenes = dict.fromkeys(str(dataset.attrs.get("title", "")) for dataset in datasets)
    title = spoken(f"{' and '.join(scenes)}: {names.title}")
    return figure(datasets, [spoken(label) for label in names.labels], title, theme), title


def spoken(text: str) -> str:
    """Return a text in which units are spelled as they are printed.

    Examples
    --------
    >>> spoken("temperature 5 degC / 25 degC")
    'temperature 5 °C / 25 °C'
    """
    return re.sub(r"(?<=\d )\w+", lambda word: _SPELLED.get(word[0], word[0]), text)

"""A figure as a file: the same run gives the same bytes, and a file appears only when it is complete."""

import io
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from atmosbox.file.output_path import AnyPath, named, write_whole
from atmosbox.plot import sweep_figure, tradeoff_figure
from atmosbox.plot.run_figure import figure, figure_with_box
from atmosbox.plot.theme import find, style

FORMATS = ("png", "svg", "pdf")


def save(
    dataset: xr.Dataset,
    path: AnyPath,
    format: str | None = None,
    *,
    theme: str = "notes",
    force: bool = False,
    with_box: bool = False,
) -> Path:
    """Draw the figure of a run into a file.

    The file contains neither a date nor a random number, so that the same run gives the same bytes. A PNG has 300 dots
    per inch; a PDF embeds its fonts, so that its text can be searched.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run, as `figure` takes it.
    path : str or path-like
        The file. Its suffix gives the format; if ``format`` is given, a missing suffix is added.
    format : {"png", "svg", "pdf"}, optional
        The format, by default that of the suffix.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen.
    force : bool
        Whether a file of that name may be replaced.
    with_box : bool
        Whether the molecules are drawn above the panels, as `figure_with_box` does.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    FileError
        If the file exists, its folder does not, it cannot be written, or the run has nothing to draw.
    SettingError
        If the format or the theme is unknown.

    Examples
    --------
    >>> import xarray as xr
    >>> save(xr.Dataset(), "parcel.gif")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: format = gif is unknown: give a file name or format of png, svg or pdf.
    """
    title, drawing = str(dataset.attrs.get("title", "atmosbox")), partial(drawn, dataset, theme, with_box=with_box)
    return write(drawing, [dataset], title, path, format, theme=theme, force=force)


def write(
    draw: Callable[[], Figure], runs: Sequence[xr.Dataset], title: str, path: AnyPath, format: str | None, *,
    theme: str, force: bool,
) -> Path:  # fmt: skip
    """Write a figure of some runs into a file, as `save` does; it is drawn once it is known that it can be written."""
    path, kind = named(path, format, FORMATS, force=force)
    parameters = "; ".join(str(dataset.attrs.get("atmosbox_parameters", "")) for dataset in runs)
    write_whole(path, render(draw(), kind, theme, title=title, parameters=parameters))
    return path


def drawn(dataset: xr.Dataset, theme: str, *, with_box: bool = False) -> Figure:
    """Return the figure of a run, with its box if ``with_box`` is true, or that of a measured trade or a sweep."""
    if with_box:
        return figure_with_box(dataset, theme)
    if "configuration" in dataset.dims:
        return tradeoff_figure.figure(dataset, theme)
    return sweep_figure.figure(dataset, theme) if sweep_figure.is_sweep(dataset) else figure(dataset, theme)


def render(drawing: Figure, kind: str, theme: str, *, title: str, parameters: str, dpi: int = 300) -> bytes:
    """Return the bytes of a figure in a format and a theme, with title and parameters as metadata."""
    told: dict[str, dict[str, Any]] = {
        "png": {"Software": "atmosbox", "Description": parameters},
        "svg": {"Creator": "atmosbox", "Description": parameters, "Date": None},
        "pdf": {"Creator": "atmosbox", "Keywords": parameters, "CreationDate": None},
    }
    stream = io.BytesIO()
    with style(find(theme)):
        drawing.savefig(stream, format=kind, dpi=dpi, metadata={"Title": title, **told[kind]})
    return stream.getvalue()

"""A figure as a file: the same run gives the same bytes, and a file appears only when it is whole."""

from __future__ import annotations

import errno
import io
import os
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any

from matplotlib.figure import Figure

from atmosbox.errors import DiskFullError, FileError, SettingError
from atmosbox.plot import sweep, tradeoff
from atmosbox.plot.layout import figure
from atmosbox.plot.theme import find, style

if TYPE_CHECKING:
    import xarray as xr

FORMATS = ("png", "svg", "pdf")


def save(
    dataset: xr.Dataset,
    path: str | os.PathLike[str],
    format: str | None = None,
    *,
    theme: str = "notes",
    force: bool = False,
) -> Path:
    """Draw the figure of a run into a file.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run, as `figure` takes it.
    path : str or path-like
        The file. Its suffix says the format; where ``format`` says it, a suffix that is missing is added.
    format : {"png", "svg", "pdf"}, optional
        The format.
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
        If the file exists, its folder does not, it cannot be written, or the run has nothing to draw.
    SettingError
        If the format or the theme is unknown.

    Notes
    -----
    Neither the date nor chance enters the file: SVG's names are derived from a fixed salt, and PDF and SVG
    carry no date. PNG has 300 dots per inch; PDF embeds its type, so that its text can be searched.

    Examples
    --------
    >>> import xarray as xr
    >>> save(xr.Dataset(), "parcel.gif")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: format = gif is unknown: give a file name or --format of png, svg or pdf.
    """
    path, kind = named(path, format, FORMATS, force=force)
    find(theme)
    drawing = _drawn(dataset, theme)
    title = str(dataset.attrs.get("title", "atmosbox"))
    parameters = str(dataset.attrs.get("atmosbox_parameters", ""))
    write_whole(path, render(drawing, kind, theme, title=title, parameters=parameters))
    return path


def _drawn(dataset: xr.Dataset, theme: str) -> Figure:
    """Return the figure of a run, or of a measurement of many."""
    if "rung" in dataset.dims:
        return tradeoff.figure(dataset, theme)
    return sweep.figure(dataset, theme) if sweep.is_sweep(dataset) else figure(dataset, theme)


def named(
    path: str | os.PathLike[str], format: str | None, formats: tuple[str, ...], *, force: bool, what: str = "figure"
) -> tuple[Path, str]:
    """Return the file and the format, from what is said of either; refuse a file that cannot be written.

    Parameters
    ----------
    path : str or path-like
        The file.
    format : str or None
        The format, where the suffix does not say it.
    formats : tuple of str
        The formats that there are.
    force : bool
        Whether a file of that name may be replaced.
    what : str
        What is in the file.

    Returns
    -------
    pathlib.Path
        The file, with a suffix.
    str
        The format.

    Raises
    ------
    FileError
        If the file exists, or its folder does not.
    SettingError
        If the format is unknown.

    Examples
    --------
    >>> str(named("parcel", "svg", FORMATS, force=True)[0])
    'parcel.svg'
    """
    path = Path(path)
    suffix = path.suffix[1:].lower()
    kind = suffix if format is None else format.lower().lstrip(".")
    if kind not in formats:
        problem = "is unknown" if kind else "is not given"
        known = f"{', '.join(formats[:-1])} or {formats[-1]}"
        raise SettingError("format", kind or None, problem, f"give a file name or --format of {known}")
    if suffix in formats and suffix != kind:
        raise SettingError("format", kind, f"does not go with the file name {path.name}", "leave one of the two out")
    path = path if suffix == kind else path.with_name(f"{path.name}.{kind}")
    if path.is_dir():
        raise FileError(f"{path} is a folder: name the file of the {what}, {path / f'{what}.{kind}'} for instance.")
    if not path.parent.is_dir():
        raise FileError(f"The folder {path.parent} for the {what} does not exist: make it first, or name another one.")
    if path.exists() and not force:
        raise FileError(f"{path} exists already: add --force to replace it, or name another file.")
    return path, kind


def render(drawing: Figure, kind: str, theme: str, *, title: str, parameters: str) -> bytes:
    """Return the bytes of a figure.

    Parameters
    ----------
    drawing : matplotlib.figure.Figure
        The figure.
    kind : {"png", "svg", "pdf"}
        The format.
    theme : {"notes", "slides"}
        The theme it was drawn in.
    title, parameters : str
        What the file says of itself.

    Examples
    --------
    >>> render(Figure(), "png", "notes", title="Nothing", parameters="{}")[1:4]
    b'PNG'
    """
    metadata: dict[str, dict[str, Any]] = {
        "png": {"Title": title, "Software": "atmosbox", "Description": parameters},
        "svg": {"Title": title, "Creator": "atmosbox", "Description": parameters, "Date": None},
        "pdf": {"Title": title, "Creator": "atmosbox", "Keywords": parameters, "CreationDate": None},
    }
    stream = io.BytesIO()
    with style(find(theme)):
        drawing.savefig(stream, format=kind, dpi=300, metadata=metadata[kind])
    return stream.getvalue()


def write_whole(path: Path, content: bytes) -> None:
    """Write a file beside its place and put it there when it is whole.

    Parameters
    ----------
    path : pathlib.Path
        The file, which `named` has let through.
    content : bytes
        What is in it.

    Raises
    ------
    DiskFullError
        If the disk is full.
    FileError
        If the file cannot be written for another reason.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     write_whole(Path(folder, "a.txt"), b"air")
    ...     Path(folder, "a.txt").read_text()
    'air'
    """
    part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
    try:
        with part.open("xb") as stream:
            stream.write(content)
        os.replace(part, path)
    except OSError as error:
        part.unlink(missing_ok=True)
        if error.errno == errno.ENOSPC:
            raise DiskFullError(f"The disk is full, and {path} was not written: make room and try again.") from error
        raise FileError(f"{path} cannot be written ({error.strerror}): name a file in another folder.") from error

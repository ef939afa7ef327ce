"""A film as a file: it appears only when it is complete, and the same run gives the same GIF."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError
from atmosbox.file.molecules import molecules
from atmosbox.file.output_path import named, whole_file, write_whole
from atmosbox.film.encoder import Picture, encode_gif, encode_mp4, movie_program
from atmosbox.film.film_sheet import Sheet
from atmosbox.film.pace import Pace, pace
from atmosbox.plot.layout import panels_of
from atmosbox.plot.theme import Theme, find, style

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["FORMATS", "save"]

FORMATS = ("gif", "mp4")
_SIZES = {"gif": {"notes": (800, 450), "slides": (960, 540)}, "mp4": {"notes": (1280, 720), "slides": (1280, 720)}}
_WIDE = {"notes": 7.2, "slides": 40.0 / 3.0}  # inch
_SMOOTH = 0.1  # if molecules move less than this from frame to frame, in sides of the box, their motion looks smooth
_CHOSEN_FROM = 6  # greatest number of pictures from which the colours of a GIF are chosen


def save(
    dataset: xr.Dataset,
    path: str | os.PathLike[str],
    format: str | None = None,
    *,
    theme: str = "notes",
    fps: float | None = None,
    seconds: float | None = None,
    graphs: bool = False,
    force: bool = False,
    progress: Callable[[float], None] | None = None,
) -> tuple[Path, Pace]:
    """Film a run into a file.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run; it must hold its molecules unless ``graphs`` is true.
    path : str or path-like
        The file. Its suffix gives the format; if ``format`` is given, a missing suffix is added.
    format : {"gif", "mp4"}, optional
        The format, by default that of the suffix; MP4 needs the extra ``movie``.
    theme : {"notes", "slides"}
        Small type for a page, or large type for a screen.
    fps, seconds : float, optional
        Pictures a second, and duration of the film; see `pace` for the defaults.
    graphs : bool
        Whether only the graphs are filmed, without the molecules.
    force : bool
        Whether a file of that name may be replaced.
    progress : callable, optional
        Called after each picture with the share that is done, from 0 to 1.

    Returns
    -------
    pathlib.Path
        The file that was written.
    Pace
        The frames of the run that the film shows, and the pictures a second.

    Raises
    ------
    FileError
        If the file exists, cannot be written, or the run has nothing to film.
    SettingError
        If format or theme is unknown, pace or duration is not allowed, or an MP4 needs the extra ``movie``, which is
        not installed.

    Examples
    --------
    >>> import xarray as xr
    >>> save(xr.Dataset(), "parcel.avi")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: format = avi is unknown: give a file name or --format of gif or mp4.
    """
    path, kind = named(path, format, FORMATS, force=force, what="film")
    look = sized(find(theme), kind)
    if kind == "mp4":
        movie_program()
    count = dataset.sizes.get("elapsed_time", 0)
    if count == 0:
        raise FileError("The file has no frame to film: the run was stopped before its first one; run it again.")
    held = None if graphs else molecules(dataset, otherwise=", or film its graphs alone with --graphs")
    smooth = held is not None and held.step < _SMOOTH
    chosen = pace(count, fps=fps, seconds=seconds, smooth=smooth, along=None if smooth else _along(dataset))
    with style(look):
        sheet = Sheet(dataset, look, held, chosen.frames)
        samples: dict[int, Picture] = {}

        def pictures() -> Iterator[Picture]:
            for done, frame in enumerate(map(int, chosen.frames), 1):
                yield samples[frame] if frame in samples else sheet.picture(frame)
                if progress is not None:
                    progress(done / chosen.frames.size)

        if kind == "gif":
            some = np.linspace(0, chosen.frames.size - 1, min(_CHOSEN_FROM, chosen.frames.size)).round().astype(int)
            wanted = chosen.frames[some].tolist()
            samples |= {frame: sheet.picture(frame) for frame in wanted}
            write_whole(path, encode_gif(pictures(), [samples[frame] for frame in wanted], chosen.fps))
        else:
            with whole_file(path) as temporary:
                encode_mp4(pictures(), temporary, chosen.fps)
    return path, chosen


def sized(theme: Theme, kind: str) -> Theme:
    """Return a theme with the size of the pictures of a film.

    Examples
    --------
    >>> look = sized(find("notes"), "gif")
    >>> [round(look.dots_per_inch * side) for side in look.wide]
    [800, 450]
    """
    wide, high = _SIZES[kind][theme.name]
    dots = wide / _WIDE[theme.name]
    return replace(theme, wide=(wide / dots, high / dots), dots_per_inch=dots, grows=False)


def _along(dataset: xr.Dataset) -> NDArray[np.float64] | None:
    """Return the logarithm of time if the first graph over time has a logarithmic axis; else None.

    A film with even steps in it shows the early changes.
    """
    over_time = [panel for panel in panels_of(dataset) if panel.kind == "line"]
    time = dataset["elapsed_time"].values.astype(np.float64)
    if not over_time or over_time[0].x_scale != "log" or time[0] <= 0.0:
        return None
    return np.log(time)

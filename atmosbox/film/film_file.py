"""A film as a file: it appears only when it is complete, and the same run gives the same GIF."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from atmosbox.errors import FileError, Option, SettingError
from atmosbox.file.molecules import molecules
from atmosbox.file.output_path import named, whole_file
from atmosbox.film.film_sheet import Pace, Sheet, pace
from atmosbox.plot.run_figure import panels_of
from atmosbox.plot.theme import Theme, find, style

if TYPE_CHECKING:
    import xarray as xr

FORMATS = ("gif", "mp4")
_SIZES = {"gif": {"notes": (800, 450), "slides": (960, 540)}, "mp4": {"notes": (1280, 720), "slides": (1280, 720)}}
_SMOOTH = 0.1  # if molecules move less than this from frame to frame, in sides of the box, their motion looks smooth
_MP4 = [
    "-f", "mp4", "-crf", "20", "-preset", "medium", "-movflags", "+faststart", "-fflags", "+bitexact",
    "-flags:v", "+bitexact",
]  # fmt: skip
"""Options of ffmpeg: quality (18 looks like the original), playing while it loads, the same bytes each time."""


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
        Pictures a second, and duration of the film; see `film_sheet.pace` for the defaults.
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
        If format or theme is unknown, pace or duration is not allowed, or the extra ``movie`` is not installed.

    Examples
    --------
    >>> import xarray as xr
    >>> save(xr.Dataset(), "parcel.avi")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: format = avi is unknown: give a file name or format of gif or mp4.
    """
    path, kind = named(path, format, FORMATS, force=force, what="film")
    look = sized(find(theme), kind)
    if kind == "mp4":
        _check_movie_program()
    count = dataset.sizes.get("elapsed_time", 0)
    if count == 0:
        raise FileError("The file has no frame to film: the run was stopped before its first one; run it again.")
    held = None if graphs else molecules(dataset, ", or film its graphs alone with ", Option("graphs", True))
    smooth = held is not None and held.step < _SMOOTH
    chosen = pace(count, fps=fps, seconds=seconds, smooth=smooth, along=None if smooth else _along(dataset))
    with style(look), whole_file(path) as temporary:
        sheet = Sheet(dataset, look, held, chosen.frames)

        def pictures() -> Iterator[Image.Image]:
            for done, frame in enumerate(map(int, chosen.frames), 1):
                yield Image.fromarray(sheet.picture(frame))
                if progress is not None:
                    progress(done / chosen.frames.size)

        if kind == "gif":
            each, lasts = pictures(), max(2, round(100.0 / chosen.fps)) * 10
            with temporary.open("wb") as stream:
                next(each).save(stream, format="GIF", save_all=True, append_images=each, duration=lasts, loop=0)
        else:
            _write_mp4(pictures(), temporary, chosen)
    return path, chosen


def _check_movie_program() -> None:
    """Refuse MP4 if the extra ``movie``, which brings ffmpeg, is not installed."""
    try:
        import imageio_ffmpeg

        imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError) as error:
        problem, fix = "needs a program that is not installed", "type pip install 'atmosbox[movie]', or give "
        raise SettingError("format", "mp4", problem, fix, Option("format", "gif")) from error


def _write_mp4(pictures: Iterator[Image.Image], path: Path, chosen: Pace) -> None:
    """Write an MP4 that browsers and presentations play; refuse one that lacks pictures, because the disk is full."""
    import imageio_ffmpeg

    first = next(pictures)
    writer: Any = imageio_ffmpeg.write_frames(
        str(path), first.size, fps=chosen.fps, codec="libx264", quality=None, macro_block_size=2, output_params=_MP4
    )
    try:
        writer.send(None)
        for picture in itertools.chain([first], pictures):
            writer.send(picture.tobytes())
        writer.close()
        held, _ = imageio_ffmpeg.count_frames_and_secs(str(path))
    except (OSError, RuntimeError):
        held = 0
    finally:
        writer.close()
    if held != chosen.frames.size:
        raise FileError(f"{path.name} could not be written whole: make room on the disk, or name another place.")


def sized(theme: Theme, kind: str) -> Theme:
    """Return a theme with the size of the pictures of a film."""
    wide, high = _SIZES[kind][theme.name]
    dots = wide / theme.wide[0]
    return replace(theme, wide=(wide / dots, high / dots), dots_per_inch=dots, grows=False)


def _along(dataset: xr.Dataset) -> NDArray[np.float64] | None:
    """Return the logarithm of time if the first graph over time has a logarithmic axis; else None."""
    scale = next((panel.x_scale for panel in panels_of(dataset) if panel.kind == "line"), "linear")
    time = dataset["elapsed_time"].values.astype(np.float64)
    return np.log(time) if scale == "log" and time[0] > 0.0 else None

"""From a series of pictures to a GIF or an MP4."""

from __future__ import annotations

import io
from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from atmosbox.errors import FileError, SettingError

__all__ = ["encode_gif", "encode_mp4", "movie_program"]

_COLOURS = 128  # number of colours of a GIF; fewer are enough for smooth text, but not for the colour bar
_STEP = 8  # step between the coarse colours, for each of which the nearest colour of the GIF is tabulated
_QUALITY = 20  # constant rate factor of an MP4: a lower one gives a better and larger film; 18 looks like the original

Picture = NDArray[np.uint8]


def encode_gif(pictures: Iterable[Picture], samples: Iterable[Picture], fps: float) -> bytes:
    """Return a GIF that repeats without end.

    Parameters
    ----------
    pictures : iterable of ndarray
        The pictures, (height, width, 3).
    samples : iterable of ndarray
        Some of the pictures, from which the common colours of all pictures are chosen.
    fps : float
        Pictures a second; the time of a picture is rounded to hundredths of a second, as a GIF requires.

    Returns
    -------
    bytes
        The file.

    Examples
    --------
    >>> grey = [np.full((4, 6, 3), value, np.uint8) for value in (0, 99, 255)]
    >>> film = Image.open(io.BytesIO(encode_gif(grey, grey, 10.0)))
    >>> film.n_frames, film.size, film.info["duration"]
    (3, (6, 4), 100)
    """
    palette, nearest = _shared_colours(np.concatenate(list(samples)))

    def reduced() -> Iterator[Image.Image]:
        for picture in pictures:
            image = Image.fromarray(nearest[_coarse(picture)])
            image.putpalette(palette)
            yield image

    each = reduced()
    stream = io.BytesIO()
    lasts = max(2, round(100.0 / fps)) * 10
    next(each).save(
        stream, format="GIF", save_all=True, append_images=each, duration=lasts, loop=0, optimize=False, disposal=1
    )
    return stream.getvalue()


def _shared_colours(picture: Picture) -> tuple[bytes, NDArray[np.uint8]]:
    """Return a palette of the colours of a picture, and for each coarse colour the index of the nearest of them.

    White is in the palette, and nearly white pixels become white: a background that is not quite white looks dirty.
    """
    chosen = Image.fromarray(picture & np.uint8(256 - _STEP)).quantize(_COLOURS, method=Image.Quantize.MEDIANCUT)
    palette = np.array(chosen.getpalette(), np.int64).reshape(-1, 3) + _STEP // 2
    levels = np.arange(0, 256, _STEP) + _STEP // 2
    coarse = np.stack(np.meshgrid(levels, levels, levels, indexing="ij"), axis=-1).reshape(-1, 3)
    apart = (palette**2).sum(axis=1) - 2 * coarse @ palette.T  # squared distances, less a common term
    nearest = apart.argmin(axis=1).astype(np.uint8)
    palette[nearest[-1]] = 255
    return palette.astype(np.uint8).tobytes(), nearest


def _coarse(picture: Picture) -> NDArray[np.int64]:
    """Return the index of the coarse colour of each pixel in the list of all coarse colours."""
    parts = (picture // _STEP).astype(np.int64)
    levels = 256 // _STEP
    place: NDArray[np.int64] = (parts[:, :, 0] * levels + parts[:, :, 1]) * levels + parts[:, :, 2]
    return place


def movie_program() -> str:
    """Return the path of the program that makes MP4 files.

    Raises
    ------
    SettingError
        If the extra ``movie`` is not installed.

    Examples
    --------
    >>> Path(movie_program()).name[:6]
    'ffmpeg'
    """
    try:
        import imageio_ffmpeg

        program: str = imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError) as error:
        fix = "type pip install 'atmosbox[movie]', or give --format gif"
        raise SettingError("format", "mp4", "needs a program that is not installed", fix) from error
    return program


def encode_mp4(pictures: Iterable[Picture], path: Path, fps: float) -> None:
    """Write an MP4 that browsers and presentations play: H.264 with one colour value for each 2 x 2 pixels.

    Parameters
    ----------
    pictures : iterable of ndarray
        The pictures, (height, width, 3), of an even height and width.
    path : pathlib.Path
        The file, which is replaced if it exists.
    fps : float
        Pictures a second.

    Raises
    ------
    SettingError
        If the extra ``movie`` is not installed.
    FileError
        If the program that makes the file fails, or the file lacks pictures.

    Examples
    --------
    >>> import tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     encode_mp4([np.zeros((64, 64, 3), np.uint8)] * 2, Path(folder, "black.mp4"), 10.0)
    ...     Path(folder, "black.mp4").read_bytes()[4:8]
    b'ftyp'
    """
    movie_program()
    import imageio_ffmpeg

    each = iter(pictures)
    first, written = next(each), 1
    height, width = first.shape[:2]
    writer = imageio_ffmpeg.write_frames(
        str(path),
        (width, height),
        fps=fps,
        codec="libx264",
        pix_fmt_out="yuv420p",
        macro_block_size=2,
        quality=None,
        ffmpeg_log_level="error",
        output_params=["-crf", str(_QUALITY), "-preset", "medium", "-movflags", "+faststart", "-f", "mp4",
                       "-fflags", "+bitexact", "-flags:v", "+bitexact"],
    )  # fmt: skip
    try:
        writer.send(None)
        writer.send(np.ascontiguousarray(first))
        for picture in each:
            writer.send(np.ascontiguousarray(picture))
            written += 1
    except OSError as error:
        raise FileError(f"{path} cannot be written by the program that makes films: name another place.") from error
    finally:
        writer.close()
    _check_whole(path, written)


def _check_whole(path: Path, pictures: int) -> None:
    """Refuse a film with fewer pictures than were written, for instance because the disk became full."""
    import imageio_ffmpeg

    try:
        held, _ = imageio_ffmpeg.count_frames_and_secs(str(path))
    except (OSError, RuntimeError):
        held = 0
    if held != pictures:
        raise FileError(f"{path.name} could not be written whole: make room on the disk, or name another place.")

"""From the dataset of a run to its page: the data, and the file, which appears only when it is complete."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.errors import FileError, SettingError
from atmosbox.file.molecules import Molecules, molecules
from atmosbox.file.output_path import check_writable, write_whole
from atmosbox.file.provenance import parameters
from atmosbox.page.document import LANGUAGES, THEMES, view_page
from atmosbox.page.frame import pack
from atmosbox.page.panel import Meaning, declared, names, panel_record, plain
from atmosbox.page.stage import NEIGHBOURS, share, stage
from atmosbox.page.word import changed, notes, settings_of, story_of
from atmosbox.scene.panels import Panel, from_json

if TYPE_CHECKING:
    import xarray as xr

_FASTEST = 99.9  # percentile of the speeds that the colour scale must reach
_FIGURES, _TIME_FIGURES = 6, 9

Floats = NDArray[np.float64]


class Page(NamedTuple):
    """A run as data for its page: the record with all that is given once, and the frames."""

    record: dict[str, Any]
    frames: list[bytes]


def pages(runs: Sequence[xr.Dataset]) -> list[Page]:
    """Return the data of the page of one or several runs; of several, the heading of each names what differs."""
    headings = changed(runs) if len(runs) > 1 else [""]
    every = [molecules(run) for run in runs]
    units = {str(run["elapsed_time"].attrs.get("units", "ns")) for run in runs}
    if len(units) > 1:
        raise FileError(
            f"The times of the runs are in {' and '.join(sorted(units))}, so they cannot share a clock: view one run."
        )
    counted = [seen.neighbours is not None for seen in every]
    if any(counted) and not all(counted):
        raise FileError("Colours show neighbours in one run and speeds in the other: view one run.")
    fastest = NEIGHBOURS if all(counted) else max(_fastest(seen.speed) for seen in every)
    return [
        _page(run, seen, heading, fastest, len(runs)) for run, seen, heading in zip(runs, every, headings, strict=True)
    ]


def _page(dataset: xr.Dataset, seen: Molecules, heading: str, fastest: float, runs: int) -> Page:
    from atmosbox.plot.caption import footer

    room = share(seen.position.shape[1], len(seen.time), runs)
    kept = np.unique(np.rint(np.linspace(0, len(seen.time) - 1, room.frames)).astype(int))
    panels, graphs = _graphs(dataset)
    scene = str(parameters(dataset).get("scene", ""))
    told = stage(
        seen,
        title=str(dataset.attrs.get("title", scene)),
        story=story_of(dataset),
        settings=settings_of(dataset),
        fastest=fastest,
        time_unit=str(dataset["elapsed_time"].attrs.get("units", "ns")),
        panels=graphs,
        most=room.molecules,
    )
    record = {
        "stage": told.record,
        "heading": heading,
        "footer": footer(dataset),
        "notes": notes(seen, told.record, frames=len(kept)),
        **_values(dataset, panels, seen.walls),
    }
    shown = seen.speed if seen.neighbours is None else seen.neighbours
    frames = [
        told.frame(
            sequence,
            float(seen.time[index]),
            seen.side[index],
            seen.position[index],
            shown[index],
            drops=None if seen.drops is None else seen.drops[index],
            liquid=0 if seen.liquid is None else int(seen.liquid[index]),
            rained=0 if seen.rained is None else int(seen.rained[index]),
        )
        for sequence, index in enumerate(kept)
    ]
    return Page(record, frames)


def _graphs(dataset: xr.Dataset) -> tuple[list[Panel], list[dict[str, Any]]]:
    """Return the panels for which the file has data; and the same, with their headline sentences, for the page."""
    from atmosbox.plot.caption import headlines
    from atmosbox.plot.skewt import levels

    if "atmosbox_panels" not in dataset.attrs:
        return [], []
    try:
        stated = from_json(dataset.attrs["atmosbox_panels"])
    except ValueError as error:
        raise FileError(f"The file does not say what its graphs show, because {error}") from error
    panels: list[Panel] = []
    for panel in stated:
        lines = tuple(line for line in panel.lines if all(_held(dataset, name) for name in line.variables))
        if lines and panel.kind != "discs":
            panels.append(replace(panel, lines=lines))
    graphs = []
    for panel, told in zip(panels, headlines(dataset, tuple(panels)), strict=True):
        marks = levels(dataset, panel) if panel.kind == "skewt" else {}
        sentences = [each.sentence for each in told]
        graphs.append(panel_record(panel, partial(_meaning, dataset), sentences=sentences, marks=marks))
    return panels, graphs


def _held(dataset: xr.Dataset, name: str) -> bool:
    """Tell whether a run, which may have been stopped early, has values of a variable."""
    name = name.partition("[")[0]
    return name in dataset.variables and bool(dataset[name].notnull().any())


def _values(dataset: xr.Dataset, panels: Sequence[Panel], laws: Sequence[str]) -> dict[str, Any]:
    """Return the values of the graphs by name, and the names of the variables that are functions of time."""
    from atmosbox.plot.curve import read

    walls = ("x_low", "x_high", "y_low", "y_high", "z_low", "z_high")
    warm = [f"wall_temperature[{wall}]" for wall, law in zip(walls, laws, strict=True) if law == "heat_bath"]
    values: dict[str, Any] = {}
    timed: list[str] = []
    for name in dict.fromkeys(("elapsed_time", *names(panels), *warm)):
        if not _held(dataset, name):
            continue
        variable = read(dataset, name)
        if variable.ndim > 1:
            raise FileError(f"The variable {name!r} of the file has {variable.ndim} dimensions, and a graph needs one.")
        figures = _TIME_FIGURES if name == "elapsed_time" else _FIGURES
        values[name] = plain(variable.values, figures)
        if variable.dims == ("elapsed_time",):
            timed.append(name)
    return {"values": values, "timed": timed}


def _meaning(dataset: xr.Dataset, name: str) -> Meaning:
    """Return the meaning of a variable from the file, or from its declaration if the file lacks it."""
    if name.partition("[")[0] not in dataset:
        return declared(name)
    attrs = dataset[name.partition("[")[0]].attrs
    return Meaning(str(attrs.get("units", "1")), str(attrs.get("long_name", name.replace("_", " "))))


def _fastest(speed: NDArray[np.floating]) -> float:
    """Return a speed that only one molecule in a thousand exceeds [m/s]; 0 if no speed is known."""
    known = speed[np.isfinite(speed)]
    return float(np.percentile(known, _FASTEST)) if known.size else 0.0


def save(
    runs: Sequence[xr.Dataset],
    path: str | os.PathLike[str],
    *,
    theme: str = "auto",
    language: str = "auto",
    force: bool = False,
) -> Path:
    """Write the page that shows a run, or two side by side; the same runs give the same bytes.

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

    Examples
    --------
    >>> import xarray as xr
    >>> save([xr.Dataset()], "page.html", theme="pink")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: theme = pink is unknown: give auto, light or dark.
    """
    target = check_writable(path, force, example="page.html")
    write_whole(target, page_text(runs, theme=theme, language=language).encode("utf-8"))
    return target


def page_text(runs: Sequence[xr.Dataset], *, theme: str = "auto", language: str = "auto") -> str:
    """Return the HTML of the page that `save` writes."""
    check_choice("theme", theme, THEMES)
    check_choice("language", language, LANGUAGES)
    told = pages(runs)
    records, frames = [page.record for page in told], [pack(page.frames) for page in told]
    return view_page(records, frames, theme=theme, language=language)


def check_choice(name: str, value: str, known: Sequence[str]) -> None:
    """Refuse a theme or a language that does not exist."""
    if value not in known:
        raise SettingError(name, value, "is unknown", f"give {', '.join(known[:-1])} or {known[-1]}")

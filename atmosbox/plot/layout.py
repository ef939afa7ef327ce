"""The figure of a run: its panels, its title and its provenance on one page."""

from __future__ import annotations

from dataclasses import replace

import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec

from atmosbox.errors import Command, FileError, Option
from atmosbox.plot.caption import footer, headlines
from atmosbox.plot.curve import curve
from atmosbox.plot.draw import Entry, draw
from atmosbox.plot.place import Draw, page
from atmosbox.plot.skewt import BACKGROUND, draw_skewt
from atmosbox.plot.stroke import hollow_points
from atmosbox.plot.theme import Theme, find
from atmosbox.scene.panels import Line, Panel, from_json


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the figure of a run.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run as atmosbox returns or saves it, in SI units; it is not changed. Its attribute
        ``atmosbox_panels`` lists the panels to draw.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen of 16:9 with large type.

    Returns
    -------
    matplotlib.figure.Figure
        The figure. It opens no window; a notebook shows it.

    Raises
    ------
    FileError
        If the dataset carries no panels or lacks a variable that they show.
    SettingError
        If there is no such theme.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import Line, to_json
    >>> air = Line("elapsed_time", "air_temperature", "air")
    >>> panel = Panel("line", "Temperature", (air,), "time", "temperature", y_unit="degC")
    >>> dataset = xr.Dataset(
    ...     {"air_temperature": ("elapsed_time", [288.0, 290.0], {"units": "K"})},
    ...     coords={"elapsed_time": ("elapsed_time", [0.0, 1.0], {"units": "ns"})},
    ...     attrs={"atmosbox_panels": to_json([panel])},
    ... )
    >>> axes = figure(dataset).axes[0]
    >>> axes.get_xlabel(), axes.get_ylabel()
    ('time (ns)', 'temperature (°C)')
    """
    look = find(theme)
    panels = panels_of(dataset)
    heading = str(dataset.attrs.get("title", "")) if look.heading else ""
    small = footer(dataset) + explanation(dataset, panels)
    readings = [reading for each in headlines(dataset, panels) for reading in each]
    return page(panels, look, dataset, painter(dataset, look), readings, small, heading)


def painter(dataset: xr.Dataset, look: Theme, only: tuple[Line, ...] | None = None) -> Draw:
    """Return the function that draws a panel of a run at its place.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    look : Theme
        The theme: sizes of type, lines and markers.
    only : tuple of Line, optional
        The lines to draw; by default all.

    Examples
    --------
    >>> import xarray as xr
    >>> dataset = xr.Dataset({"p": ("z", [1e5, 9e4], {"units": "Pa"})}, coords={"z": [0.0, 900.0]})
    >>> drawing, panel = Figure(), Panel("profile", "Air", (Line("p", "z", "air"),), x_unit="hPa")
    >>> axes, _ = painter(dataset, find("notes"))(drawing, drawing.add_gridspec(1, 1)[0, 0], panel, None)
    >>> axes.lines[0].get_xdata().tolist()
    [1000.0, 900.0]
    """

    def draw_panel(drawing: Figure, spot: SubplotSpec, panel: Panel, above: Axes | None) -> tuple[Axes, list[Entry]]:
        if panel.kind == "skewt":
            return draw_skewt(drawing, spot, panel, dataset, look, only)
        axes = drawing.add_subplot(spot, sharex=above)
        return axes, draw(axes, panel, dataset, look, only)

    return draw_panel


def explanation(dataset: xr.Dataset, panels: tuple[Panel, ...]) -> str:
    """Return the text of the footer that explains error bars, hollow points and the background of a skew-T.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    panels : tuple of Panel
        The panels that are drawn.

    Examples
    --------
    >>> import xarray as xr
    >>> explanation(xr.Dataset(), (Panel("discs", "The box"),))
    ''
    """
    has_errors = any(line.error for panel in panels for line in panel.lines)
    has_hollow = any(
        hollow_points(curve(dataset, panel, line)).any()
        for panel in panels
        for line in panel.lines
        if line.role == "data" and panel.kind != "histogram"
    )
    along = " and ".join(dict.fromkeys(panel.x_label or "x" for panel in panels if panel.averages))
    small = f" · against {along}: averages of frames, ± 1 standard deviation of single frames" if along else ""
    if has_errors:
        small += f" · {'other ' if along else ''}bars and bands: ± 1 standard error"
        small += ", hollow: not known" if has_hollow else ""
    return small + (f" · {BACKGROUND}" if any(panel.kind == "skewt" for panel in panels) else "")


def panels_of(dataset: xr.Dataset) -> tuple[Panel, ...]:
    """Return the panels that a run lists, without the theory curves of headlines that it did not measure.

    Of a run that was stopped, only panels and curves are returned for which it has measured enough.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.

    Raises
    ------
    FileError
        If the dataset lists no panels, its list cannot be read, or the run was stopped too early for all of them.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import to_json
    >>> [panel.title for panel in panels_of(xr.Dataset(attrs={"atmosbox_panels": to_json([Panel("discs", "A box")])}))]
    ['A box']
    """
    if "atmosbox_panels" not in dataset.attrs:
        raise FileError("The file does not say what its figure shows: atmosbox did not write it.")
    try:
        panels = from_json(dataset.attrs["atmosbox_panels"])
    except ValueError as error:
        raise FileError(f"The file does not say what its figure shows, because {error}") from error
    if not panels:
        raise FileError("The file has no figure: its scene names no panels.")
    if dataset.attrs.get("atmosbox_status", "complete") != "complete":
        panels = tuple(begun for panel in panels if (begun := _begun(dataset, panel)) is not None)
        if not panels:
            again = Command("run", (Option("resume"),))
            raise FileError("The run was stopped too early for a figure", "let it go on with ", again)
    return tuple(replace(panel, lines=_found(dataset, panel)) for panel in panels)


def _begun(dataset: xr.Dataset, panel: Panel) -> Panel | None:
    """Return a panel of a run that was stopped, with the curves that it has; None if none of them is measured."""

    def held(names: tuple[str, ...]) -> bool:
        return all(name.partition("[")[0] in dataset.variables for name in names)

    if not panel.lines:
        return panel if held(panel.variables) else None
    lines = tuple(line for line in panel.lines if held(line.variables))
    return replace(panel, lines=lines) if any(line.role == "data" for line in lines) else None


def _found(dataset: xr.Dataset, panel: Panel) -> tuple[Line, ...]:
    """Return the lines of a panel that do not use the theory of a missing headline, such as a cloud base not found."""
    missing = {f"{name}_theory" for name in panel.headlines if name not in dataset}
    return tuple(line for line in panel.lines if missing.isdisjoint(line.variables))

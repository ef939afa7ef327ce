"""The figure of a run: its panels, its title and its provenance on one page."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.gridspec import SubplotSpec

from atmosbox.errors import FileError
from atmosbox.plot.caption import footer, headlines
from atmosbox.plot.curve import curve, read, unit_of
from atmosbox.plot.draw import Entry, draw
from atmosbox.plot.place import blank, frame, put_panels, settle
from atmosbox.plot.plane import axis_names
from atmosbox.plot.plate import Pen
from atmosbox.plot.skewt import BACKGROUND, draw_skewt, levels
from atmosbox.plot.stroke import hollow_points
from atmosbox.plot.theme import Theme, find, style
from atmosbox.scene.panels import Line, Panel, from_json

if TYPE_CHECKING:
    import xarray as xr


def figure(dataset: xr.Dataset, theme: str = "notes") -> Figure:
    """Draw the figure of a run.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run as atmosbox returns or saves it, in SI units; it is not changed. Its attribute
        ``atmosbox_panels`` says what to draw.
    theme : {"notes", "slides"}
        A figure for a page, or one for a screen of 16:9 with large type.

    Returns
    -------
    matplotlib.figure.Figure
        The figure, which belongs to no window; a notebook shows it.

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
    with style(look):
        drawing = blank(look.wide if len(panels) > 1 else look.narrow, look)
        pen = Pen(drawing)
        plates = put_panels(drawing, panels, look, Painter(dataset, look), headlines(dataset, panels))
        heading = str(dataset.attrs.get("title", "")) if look.heading else ""
        frame(pen, footer(dataset) + explanation(dataset, panels), heading, look)
        settle(pen, plates, look)
    return drawing


@dataclass(frozen=True)
class Painter:
    """Draws the panels of one run.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    look : Theme
        How large.
    only : tuple of Line, optional
        The lines to draw; all if nothing is said.

    Examples
    --------
    >>> import xarray as xr
    >>> dataset = xr.Dataset({"p": ("z", [1e5], {"units": "Pa"})}, coords={"z": [0.0]})
    >>> Painter(dataset, find("notes")).labels(Panel("profile", "Air", (Line("p", "z", "air"),), x_unit="hPa"))
    (('p', 'hPa'), ('z', '1'))
    """

    dataset: xr.Dataset
    look: Theme
    only: tuple[Line, ...] | None = None

    def draw(self, drawing: Figure, spot: SubplotSpec, panel: Panel, above: Axes | None) -> tuple[Axes, list[Entry]]:
        """Draw a panel at its place, along the abscissa of the one above if that is given."""
        if panel.kind == "skewt":
            return draw_skewt(drawing, spot, panel, self.dataset, self.look, self.only)
        axes = drawing.add_subplot(spot, sharex=above)
        return axes, draw(axes, panel, self.dataset, self.look, self.only)

    def labels(self, panel: Panel) -> tuple[tuple[str, str], tuple[str, str]]:
        """Return what the two axes of a panel show, and in which units."""
        return _labels(self.dataset, panel)

    def levels(self, panel: Panel) -> dict[str, float]:
        """Return the pressures that a panel marks [hPa]."""
        return levels(self.dataset, panel)


def explanation(dataset: xr.Dataset, panels: tuple[Panel, ...]) -> str:
    """Return what small type must say of bars, hollow points and the background.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.
    panels : tuple of Panel
        What is drawn of it.

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
    small = " · bars and bands: ± 1 standard error" if has_errors else ""
    small += ", hollow: not known" if has_hollow else ""
    return small + (f" · {BACKGROUND}" if any(panel.kind == "skewt" for panel in panels) else "")


def panels_of(dataset: xr.Dataset) -> tuple[Panel, ...]:
    """Return the panels that a run asks for.

    Parameters
    ----------
    dataset : xarray.Dataset
        The run.

    Raises
    ------
    FileError
        If it does not say, or names none.

    Examples
    --------
    >>> import xarray as xr
    >>> from atmosbox.scene.panels import to_json
    >>> [panel.title for panel in panels_of(xr.Dataset(attrs={"atmosbox_panels": to_json([Panel("discs", "A box")])}))]
    ['A box']
    """
    if "atmosbox_panels" not in dataset.attrs:
        raise FileError("The file does not say what its figure shows: it was not written by atmosbox run.")
    try:
        panels = from_json(dataset.attrs["atmosbox_panels"])
    except ValueError as error:
        raise FileError(f"The file does not say what its figure shows, because {error}") from error
    if not panels:
        raise FileError("The file has no figure: its scene names no panels.")
    return panels


def _labels(dataset: xr.Dataset, panel: Panel) -> tuple[tuple[str, str], tuple[str, str]]:
    """Return what the two axes show, and in which units."""
    if panel.kind == "discs":
        first, second = axis_names(dataset)
        return (panel.x_label or first, panel.x_unit or "nm"), (panel.y_label or second, panel.x_unit or "nm")
    line = panel.lines[0]
    names = [read(dataset, name).attrs.get("long_name", name.replace("_", " ")) for name in (line.x, line.y)]
    return (
        (panel.x_label or str(names[0]), unit_of(dataset, panel, "x")),
        (panel.y_label or str(names[1]), unit_of(dataset, panel, "y")),
    )

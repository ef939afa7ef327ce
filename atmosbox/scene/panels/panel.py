"""One graph of a figure."""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

from atmosbox.scene.panels.line import Line
from atmosbox.scene.panels.text_check import check_choice, check_text

__all__ = ["ATMOSPHERE_VARIABLES", "DISC_VARIABLES", "KINDS", "SCALES", "SKEWT_AXES", "Panel", "without_headlines"]

KINDS = ("line", "profile", "histogram", "discs", "skewt", "atmosphere")
SCALES = ("linear", "log")
SKEWT_AXES = {
    "x_unit": "degC",
    "y_unit": "hPa",
    "x_scale": "linear",
    "y_scale": "log",
    "x_invert": False,
    "y_invert": True,
}
ATMOSPHERE_VARIABLES = (
    "parcel_temperature",
    "environment_pressure",
    "cloud_liquid_water_mixing_ratio",
    "largest_haze_mixing_ratio",
    "rain_mixing_ratio",
    "relative_humidity",
    "cloud_base",
    "vapor_molecule_count",
)
"""Variables of the parcel that the picture of an atmosphere shows in addition to its height, if the run has them."""
DISC_VARIABLES = ("disc_position", "disc_velocity", "disc_diameter", "disc_mass")


@dataclass(frozen=True)
class Panel:
    """One graph of a scene's figure: its curves, its axes and their units.

    Parameters
    ----------
    kind : {"line", "profile", "histogram", "discs", "skewt", "atmosphere"}
        ``line``: the measured variable up the page, for instance against time. ``profile``: height or pressure up the
        page, the measured variable along it. ``histogram``: the data as steps between the bounds of their bins.
        ``discs``: the molecules of a flat box themselves, from the variables `DISC_VARIABLES`; it has no lines.
        ``skewt``: temperatures over pressure in a skew-T log-p diagram, whose axes are always in degC and hPa. CAPE and
        CIN are shaded between the first measured curve and the first of the environment: areas between *temperatures*,
        as is the custom, although the numbers CAPE and CIN are those of virtual temperatures. ``atmosphere``: the
        parcel on its ascent, over the ground or over mountains, with its cloud and its rain; its one line is the height
        of the parcel over time.
    title : str
        What the graph shows, in a few words.
    lines : tuple of Line
        The curves, in the order of the legend.
    x_label, y_label : str
        The quantities on the axes, without units; empty for the ``long_name`` of the first curve's variable.
    x_unit, y_unit : str
        The units of the axes ("hPa", "degC", "km", "nm", ...); empty for the units of the file.
    x_scale, y_scale : {"linear", "log"}
        The scales of the axes.
    x_invert, y_invert : bool
        Whether an axis decreases to the right or upward, as pressure does.
    averages : int
        Number of equal parts of the x axis in which measured curves of a ``line`` panel are averaged, so that noise
        does not fill the far end of a logarithmic axis; 0 draws every value.
    note : str
        A sentence under the title.
    headlines : tuple of str
        Names of the headline numbers of the run whose misfit is written into this panel.
    marks : tuple of str
        Names of single numbers of the file, pressures that are marked in a ``skewt`` panel if the run has found
        them. CAPE is shaded between the marks "lfc" and "el", CIN below "lfc".
    start : tuple of float
        Where the curves begin, before the first frame: x and y in the units of the axes. The curves of a ``profile``
        and the measured curves of a ``line`` panel are drawn from there; 0 is the left end of a logarithmic axis.
    guides : tuple of (axis, value, text)
        Thin lines across the graph, each at a value of one axis ("x" or "y"), with a text beside it that may be empty.
    x_limits, y_limits : tuple of float
        The two ends of an axis, in its unit; empty for an axis that shows all values.
    areas : bool
        Whether the area between the first curve of a ``profile`` and zero is shaded: positive as CAPE, negative as CIN.

    Raises
    ------
    ValueError
        If a kind or a scale is unknown, the title is empty, or the lines do not suit the kind.

    Examples
    --------
    >>> speeds = Line("speed", "speed_probability_density", "measured")
    >>> Panel("histogram", "Speeds of the molecules", (speeds,), x_label="speed").variables
    ('speed', 'speed_probability_density')
    """

    kind: str
    title: str
    lines: tuple[Line, ...] = ()
    x_label: str = ""
    y_label: str = ""
    x_unit: str = ""
    y_unit: str = ""
    x_scale: str = "linear"
    y_scale: str = "linear"
    x_invert: bool = False
    y_invert: bool = False
    averages: int = 0
    note: str = ""
    headlines: tuple[str, ...] = ()
    marks: tuple[str, ...] = ()
    start: tuple[float, ...] = ()
    guides: tuple[tuple[str, float, str], ...] = ()
    x_limits: tuple[float, ...] = ()
    y_limits: tuple[float, ...] = ()
    areas: bool = False

    def __post_init__(self) -> None:
        check_choice("panel", "kind", self.kind, KINDS)
        check_text("panel", "title", self.title)
        if self.kind == "skewt":
            self._set_skewt_axes()
        for name in ("x_label", "y_label", "x_unit", "y_unit", "note"):
            if not isinstance(getattr(self, name), str):
                raise ValueError(f"the {name} of the panel {self.title!r} is not a text.")
        for name in ("x_scale", "y_scale"):
            check_choice("panel", name, getattr(self, name), SCALES)
        for name in ("x_invert", "y_invert"):
            if not isinstance(getattr(self, name), bool):
                raise ValueError(f"{name} of the panel {self.title!r} is neither true nor false.")
        if type(self.averages) is not int or self.averages < 0 or (self.averages and self.kind != "line"):
            raise ValueError(f"averages of the panel {self.title!r} is {self.averages!r}: only a line panel has parts.")
        for name, kind in (("lines", Line), ("headlines", str), ("marks", str)):
            values = getattr(self, name)
            if not isinstance(values, tuple) or not all(isinstance(value, kind) for value in values):
                raise ValueError(f"{name} of the panel {self.title!r} is not a tuple of {kind.__name__}.")
        for name in ("start", "x_limits", "y_limits"):
            if len(getattr(self, name)) not in (0, 2):
                raise ValueError(f"{name} of the panel {self.title!r} is {getattr(self, name)!r}, and has two numbers.")
        if any(len(guide) != 3 or guide[0] not in ("x", "y") for guide in self.guides):
            raise ValueError(f"a guide of the panel {self.title!r} is not an axis, a value and a text.")
        if (self.kind == "discs") == bool(self.lines):
            wanted = "has no lines" if self.kind == "discs" else "needs at least one line"
            raise ValueError(f"the panel {self.title!r} is of the kind {self.kind!r}, which {wanted}.")
        if self.marks and self.kind != "skewt":
            raise ValueError(f"the panel {self.title!r} has marks, and only a panel of the kind 'skewt' shows them.")

    def _set_skewt_axes(self) -> None:
        """Give the panel the axes of a skew-T, the only ones allowed."""
        defaults = {field.name: field.default for field in fields(self)}
        for name, value in SKEWT_AXES.items():
            if getattr(self, name) not in (value, defaults[name]):
                raise ValueError(
                    f"the {name} of the panel {self.title!r} is {getattr(self, name)!r}: "
                    "a skew-T is in degC and hPa, whose logarithm decreases upward."
                )
            object.__setattr__(self, name, value)

    @property
    def measured_across(self) -> bool:
        """Whether the measured variable of a line is ``x``, with height or pressure up the page."""
        return self.kind in ("profile", "skewt")

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables that the panel draws, each once, in order."""
        if self.kind == "discs":
            return DISC_VARIABLES
        return tuple(dict.fromkeys(name for line in self.lines for name in line.variables))


def without_headlines(panel: Panel) -> Panel | None:
    """Return a panel without curves that come from headlines, for a run that has none; None if nothing is left.

    Examples
    --------
    >>> base = Line("air_temperature", "cloud_base_of_this_run", "cloud base")
    >>> without_headlines(Panel("profile", "Cloud", (base,))) is None
    True
    """
    from atmosbox.file.variables import known

    if panel.kind == "discs":
        return panel
    lines = tuple(line for line in panel.lines if all(known(name.partition("[")[0]) for name in line.variables))
    return replace(panel, lines=lines, headlines=()) if lines else None

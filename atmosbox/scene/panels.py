"""What the figure of a scene shows, as plain data: its panels, their curves, and both as one JSON string.

A scene names the variables of its file that belong on a graph, and the form of the graph; it draws nothing. The panels
are stored with the run as one JSON string (the attribute ``atmosbox_panels``), so that a file can be drawn long
afterwards, on a machine that has neither the scene nor the engine.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import MISSING, dataclass, fields, replace
from typing import Any


def check_text(what: str, name: str, value: object) -> None:
    """Refuse a value that is not a text, and an empty text."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be a text that is not empty.")


def check_choice(what: str, name: str, value: object, choices: tuple[str, ...]) -> None:
    """Refuse a word of a line or panel that is not one of the choices."""
    if value not in choices:
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be one of {', '.join(choices)}.")


ROLES = ("data", "theory", "environment", "reference")


@dataclass(frozen=True)
class Line:
    """One curve of a panel: two variables of the file, and what the curve is.

    The *measured* variable of a curve is ``x`` in a profile and a skew-T, where height or pressure goes up the page,
    and ``y`` in every other panel. A variable may also be a single number: beside a list of values it becomes a
    straight line across them, and two single numbers make one point.

    Parameters
    ----------
    x, y : str
        Names of the variables along the two axes. Their units are those of the file; the panel says which
        units are shown. "heat_from_wall[z_low]" is the part of a variable at one label, here of the dimension
        wall.
    label : str
        Label of the curve in the legend.
    role : {"data", "theory", "environment", "reference"}
        ``data`` was measured (solid, with its error band), ``theory`` calculated (dashed, dark),
        ``environment`` belongs to the environment of a parcel (dash-dotted), ``reference`` is a broad, pale line to
        compare with.
    error : str, optional
        Name of the standard error of the measured variable, drawn as a band or as bars of one standard error.

    Raises
    ------
    ValueError
        If a name is empty or the role is none of the four.

    Examples
    --------
    The lapse rate of a parcel, with its error bar:

    >>> Line("parcel_temperature", "parcel_pressure", "parcel", error="parcel_temperature_se").role
    'data'
    """

    x: str
    y: str
    label: str
    role: str = "data"
    error: str | None = None

    def __post_init__(self) -> None:
        for name in ("x", "y", "label"):
            check_text("line", name, getattr(self, name))
        if self.error is not None:
            check_text("line", "error", self.error)
        check_choice("line", "role", self.role, ROLES)

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables that the curve needs."""
        return tuple(name for name in (self.x, self.y, self.error) if name is not None)


KINDS = ("line", "profile", "histogram", "discs", "skewt", "atmosphere")
SCALES = ("linear", "log")
_SKEWT_AXES: dict[str, Any] = {
    "x_unit": "degC", "y_unit": "hPa", "x_scale": "linear", "y_scale": "log", "x_invert": False, "y_invert": True
}  # fmt: skip
ATMOSPHERE_VARIABLES = (
    "parcel_temperature", "environment_pressure", "cloud_liquid_water_mixing_ratio", "largest_haze_mixing_ratio",
    "rain_mixing_ratio", "relative_humidity", "cloud_base", "vapor_molecule_count",
)  # fmt: skip
"""Variables of the parcel that the picture of an atmosphere shows in addition to its height, if the run has them."""
_TEXTS = ("x_label", "y_label", "x_unit", "y_unit", "note")
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
    title, note : str
        What the graph shows, in a few words; a sentence under the title.
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
        The two ends of an axis, in its unit; empty for an axis that shows all values. Of a ``line`` panel,
        ``y_limits`` may be the lower end alone.
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
        for name in ("x_scale", "y_scale"):
            check_choice("panel", name, getattr(self, name), SCALES)
        panel, values = f"of the panel {self.title!r}", vars(self)
        wrong = [f"the {n} {panel} is not a text" for n in _TEXTS if not isinstance(values[n], str)]
        odd = [name for name in ("x_invert", "y_invert") if not isinstance(values[name], bool)]
        wrong += [f"{name} {panel} is neither true nor false" for name in odd]
        if type(self.averages) is not int or self.averages < 0 or (self.averages and self.kind != "line"):
            wrong.append(f"averages {panel} is {self.averages!r}: only a line panel has parts")
        for name, kind in (("lines", Line), ("headlines", str), ("marks", str)):
            if not isinstance(values[name], tuple) or not all(isinstance(value, kind) for value in values[name]):
                wrong.append(f"{name} {panel} is not a tuple of {kind.__name__}")
        for name in ("start", "x_limits", "y_limits"):
            if len(values[name]) not in (0, 2) and (name, len(values[name]), self.kind) != ("y_limits", 1, "line"):
                wrong.append(f"{name} {panel} is {values[name]!r}, and has two numbers")
        if any(len(guide) != 3 or guide[0] not in ("x", "y") for guide in self.guides):
            wrong.append(f"a guide {panel} is not an axis, a value and a text")
        if (self.kind == "discs") == bool(self.lines):
            wanted = "has no lines" if self.kind == "discs" else "needs at least one line"
            wrong.append(f"the panel {self.title!r} is of the kind {self.kind!r}, which {wanted}")
        if self.marks and self.kind != "skewt":
            wrong.append(f"the panel {self.title!r} has marks, and only a panel of the kind 'skewt' shows them")
        if wrong:
            raise ValueError(f"{wrong[0]}.")

    def _set_skewt_axes(self) -> None:
        """Give the panel the axes of a skew-T, the only ones allowed."""
        defaults = {field.name: field.default for field in fields(self)}
        for name, value in _SKEWT_AXES.items():
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


def over_time(
    title: str, curves: dict[str, str], label: str, unit: str = "", *, theory: str = "", more: tuple[Line, ...] = (),
    log: bool = False, parts: int = 0, headline: str = "", start: float | None = None, **others: Any,
) -> Panel:  # fmt: skip
    """Return a panel of curves over time.

    Parameters
    ----------
    title
        Title of the panel, a sentence.
    curves, more
        Names of the measured variables, with the label of each; further lines.
    label, unit
        Label and unit of the vertical axis.
    theory
        Label of the theory of the first curve; empty for none.
    log
        Whether the axis of time is logarithmic, because most of the change happens at the start.
    parts
        Number of equal parts of the axis of time over which the curves are averaged; 0 draws every value.
    headline
        Name of the number that is written into the panel; empty for none.
    start
        The value with which the measured curves begin at time 0, in ``unit``.
    others
        Further fields of the panel.

    Examples
    --------
    >>> over_time("It cools", {"gas_temperature": "air"}, "temperature", "K", theory="rest").lines[1].y
    'gas_temperature_theory'
    """
    time = "elapsed_time"
    lines = [Line(time, name, called) for name, called in curves.items()]
    if theory:
        lines.append(Line(time, f"{next(iter(curves))}_theory", theory, "theory"))
    return Panel(
        "line", title, (*lines, *more), x_label="time", y_label=label, y_unit=unit, averages=parts,
        x_scale="log" if log else "linear", headlines=(headline,) if headline else (),
        start=() if start is None else (0.0, start), **others,
    )  # fmt: skip


def over_height(
    title: str, lines: tuple[Line, ...], label: str, unit: str, *headlines: str, pressure: bool = False, **others: Any
) -> Panel:
    """Return a panel of curves along a height in km, or along a pressure in hPa.

    Parameters
    ----------
    title, lines
        Title of the panel, a sentence; its curves.
    label, unit
        Label and unit of the horizontal axis.
    *headlines
        Names of the numbers that are written into the panel.
    pressure
        Whether pressure goes up the page, in place of height.
    **others
        Further fields of the panel.

    Examples
    --------
    >>> air = Line("air_temperature", "parcel_pressure", "air")
    >>> over_height("It cools", (air,), "temperature", "K", pressure=True).y_unit
    'hPa'
    """
    axis: dict[str, Any] = {"y_label": "height", "y_unit": "km"}
    if pressure:
        axis = {"y_label": "pressure", "y_unit": "hPa", "y_scale": "log", "y_invert": True}
    return Panel("profile", title, lines, x_label=label, x_unit=unit, headlines=headlines, **axis | others)


_FORMAT = 1


def to_json(panels: Iterable[Panel]) -> str:
    """Return the panels of a figure as the text that is stored in a file.

    Examples
    --------
    >>> to_json([Panel("discs", "The box")])
    '{"format": 1, "panels": [{"kind": "discs", "title": "The box"}]}'
    """
    return json.dumps({"format": _FORMAT, "panels": [_as_record(panel) for panel in panels]})


def from_json(text: str) -> tuple[Panel, ...]:
    """Return the panels from the text that is stored in a file.

    Examples
    --------
    Reading restores what was written:

    >>> air = Line("elapsed_time", "air_temperature", "air")
    >>> panels = (Panel("line", "Temperature", (air,), y_unit="degC"),)
    >>> from_json(to_json(panels)) == panels
    True
    """
    try:
        record = json.loads(text)
    except (TypeError, ValueError) as error:
        raise ValueError(f"the panels are no JSON text: {error}.") from error
    if not isinstance(record, dict) or not isinstance(record.get("panels"), list):
        raise ValueError("the panels are not in the form that atmosbox writes.")
    if record.get("format") != _FORMAT:
        raise ValueError(
            f"the panels are in format {record.get('format')!r}, and this version of atmosbox reads format {_FORMAT}."
        )
    return tuple(_panel(item) for item in record["panels"])


def _panel(record: object) -> Panel:
    values = _values("panel", record, Panel)
    for name in ("lines", "headlines", "marks", "start", "guides", "x_limits", "y_limits"):
        if not isinstance(given := values.get(name, []), list):
            raise ValueError(f"{name} of a panel are no list.")
        values[name] = tuple(tuple(each) if name == "guides" else each for each in given)
    return Panel(**values | {"lines": tuple(Line(**_values("line", item, Line)) for item in values["lines"])})


def _values(what: str, record: object, kind: type[Line] | type[Panel]) -> dict[str, Any]:
    """Return a record as arguments of its class; raise ValueError for a missing or an unknown field."""
    if not isinstance(record, dict):
        raise ValueError(f"a {what} is written as {type(record).__name__}, not as a record.")
    known = {field.name: field.default is MISSING for field in fields(kind)}
    foreign = [name for name in record if name not in known]
    missing = [name for name, needed in known.items() if needed and name not in record]
    if foreign or missing:
        fault = f"has the unknown field {foreign[0]!r}" if foreign else f"lacks the field {missing[0]!r}"
        raise ValueError(f"a {what} {fault}: it was not written by this version of atmosbox.")
    return dict(record)


def _as_record(item: Line | Panel) -> dict[str, object]:
    """Return the fields of a line or panel that differ from their defaults."""
    record = {field.name: getattr(item, field.name) for field in fields(item)}
    record = {field.name: record[field.name] for field in fields(item) if record[field.name] != field.default}
    return record | ({"lines": [_as_record(line) for line in record["lines"]]} if "lines" in record else {})

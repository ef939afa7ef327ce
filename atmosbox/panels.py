"""What the figure of a scene shows, as plain data.

A scene names the variables of its file that belong on a graph and says how to look at them; it draws nothing.
The panels travel with the run as one JSON string (the attribute ``atmosbox_panels``), so that a file can be
drawn long afterwards, on a machine that has neither the scene nor the engine.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import MISSING, dataclass, fields
from typing import Any

KINDS = ("line", "profile", "histogram", "discs", "skewt")
ROLES = ("data", "theory", "environment", "reference")
SCALES = ("linear", "log")
SKEWT_AXES = {
    "x_unit": "degC",
    "y_unit": "hPa",
    "x_scale": "linear",
    "y_scale": "log",
    "x_invert": False,
    "y_invert": True,
}
DISC_VARIABLES = ("disc_position", "disc_velocity", "disc_diameter", "disc_mass")

_FORMAT = 1


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
        What the legend calls the curve.
    role : {"data", "theory", "environment", "reference"}
        ``data`` was measured (solid, with its error band), ``theory`` calculated (dashed, dark),
        ``environment`` is the air around a parcel (dash-dotted), ``reference`` a broad, pale line to compare with.
    error : str, optional
        Name of the standard error of the measured variable, drawn as a band or as bars of one standard error.
    minus : str, optional
        Name of a variable that is subtracted from the measured one, to show a misfit.

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
    minus: str | None = None

    def __post_init__(self) -> None:
        for name in ("x", "y", "label"):
            _check_text("line", name, getattr(self, name))
        for name in ("error", "minus"):
            if getattr(self, name) is not None:
                _check_text("line", name, getattr(self, name))
        _check_choice("line", "role", self.role, ROLES)

    @property
    def variables(self) -> tuple[str, ...]:
        """Names of the variables that the curve is made of."""
        return tuple(name for name in (self.x, self.y, self.error, self.minus) if name is not None)


@dataclass(frozen=True)
class Panel:
    """One graph of a scene's figure: its curves, its axes and the units in which they are read.

    Parameters
    ----------
    kind : {"line", "profile", "histogram", "discs", "skewt"}
        ``line``: the measured variable up the page, for instance against time. ``profile``: height or
        pressure up the page, the measured variable along it. ``histogram``: the data as steps between the
        bounds of their bins. ``discs``: the molecules of a flat box themselves, from the variables
        `DISC_VARIABLES`; it has no lines. ``skewt``: temperatures over pressure in a skew-T log-p diagram, whose
        axes are always in degC and hPa. CAPE and CIN are shaded between the first measured curve and the first
        of the environment: areas between *temperatures*, as is the custom, although the numbers CAPE and CIN are
        those of virtual temperatures.
    title : str
        What the graph shows, in a few words.
    lines : tuple of Line
        The curves, in the order of the legend.
    x_label, y_label : str
        The quantities on the axes, without units; empty for the ``long_name`` of the first curve's variable.
    x_unit, y_unit : str
        The units that the axes are read in ("hPa", "degC", "km", "nm", ...); empty for the units of the file.
    x_scale, y_scale : {"linear", "log"}
        The scales of the axes.
    x_invert, y_invert : bool
        Whether an axis decreases to the right or upward, as pressure does.
    averages : int
        Into how many equal parts of the x axis measured curves of a ``line`` panel are averaged, so that noise does
        not crowd the far end of a logarithmic axis; 0 draws every value.
    note : str
        A sentence under the title.
    headlines : tuple of str
        Names of the headline numbers of the run whose misfit is written into this panel.
    marks : tuple of str
        Names of single numbers of the file, pressures that are marked in a ``skewt`` panel if the run has found
        them. CAPE is shaded between those called "lfc" and "el", CIN below "lfc".

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

    def __post_init__(self) -> None:
        _check_choice("panel", "kind", self.kind, KINDS)
        _check_text("panel", "title", self.title)
        if self.kind == "skewt":
            self._set_skewt_axes()
        for name in ("x_label", "y_label", "x_unit", "y_unit", "note"):
            if not isinstance(getattr(self, name), str):
                raise ValueError(f"the {name} of the panel {self.title!r} is no text.")
        for name in ("x_scale", "y_scale"):
            _check_choice("panel", name, getattr(self, name), SCALES)
        for name in ("x_invert", "y_invert"):
            if not isinstance(getattr(self, name), bool):
                raise ValueError(f"{name} of the panel {self.title!r} is neither true nor false.")
        if type(self.averages) is not int or self.averages < 0 or (self.averages and self.kind != "line"):
            raise ValueError(f"averages of the panel {self.title!r} is {self.averages!r}: only a line panel has parts.")
        for name, kind in (("lines", Line), ("headlines", str), ("marks", str)):
            values = getattr(self, name)
            if not isinstance(values, tuple) or not all(isinstance(value, kind) for value in values):
                raise ValueError(f"{name} of the panel {self.title!r} is no tuple of {kind.__name__}.")
        if (self.kind == "discs") == bool(self.lines):
            wanted = "has no lines" if self.kind == "discs" else "needs at least one line"
            raise ValueError(f"the panel {self.title!r} is of the kind {self.kind!r}, which {wanted}.")
        if self.marks and self.kind != "skewt":
            raise ValueError(f"the panel {self.title!r} has marks, and only a panel of the kind 'skewt' shows them.")
        if self.kind == "skewt" and any(line.minus for line in self.lines):
            raise ValueError(f"the panel {self.title!r} shows temperatures in a skew-T, and no differences of them.")

    def _set_skewt_axes(self) -> None:
        """Give the panel the axes of a skew-T, which has no others."""
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


def to_json(panels: Iterable[Panel]) -> str:
    """Return the panels of a figure as the text that a file carries.

    Parameters
    ----------
    panels : iterable of Panel
        The panels, in reading order.

    Returns
    -------
    str
        JSON, in ASCII. What has its default value is left out.

    Examples
    --------
    >>> to_json([Panel("discs", "The box")])
    '{"format": 1, "panels": [{"kind": "discs", "title": "The box"}]}'
    """
    return json.dumps({"format": _FORMAT, "panels": [_as_record(panel) for panel in panels]})


def from_json(text: str) -> tuple[Panel, ...]:
    """Return the panels that a file carries.

    Parameters
    ----------
    text : str
        What `to_json` has written.

    Returns
    -------
    tuple of Panel
        The panels, in reading order.

    Raises
    ------
    ValueError
        If the text is no JSON, or was written by something else or by a version that words panels
        differently.

    Examples
    --------
    What was written comes back the same:

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
    for name in ("lines", "headlines", "marks"):
        if not isinstance(values.setdefault(name, []), list):
            raise ValueError(f"{name} of a panel are no list.")
    values["lines"] = tuple(Line(**_values("line", item, Line)) for item in values["lines"])
    for name in ("headlines", "marks"):
        values[name] = tuple(values[name])
    return Panel(**values)


def _values(what: str, record: object, kind: type[Line] | type[Panel]) -> dict[str, Any]:
    """Return a record as arguments of its class, or say which field is missing or foreign."""
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
    record: dict[str, object] = {}
    for field in fields(item):
        value = getattr(item, field.name)
        if value == field.default:
            continue
        if field.name == "lines":
            value = [_as_record(line) for line in value]
        record[field.name] = value
    return record


def _check_text(what: str, name: str, value: object) -> None:
    if not isinstance(value, str) or not value.strip():
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be a text that is not empty.")


def _check_choice(what: str, name: str, value: object, choices: tuple[str, ...]) -> None:
    if value not in choices:
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be one of {', '.join(choices)}.")

"""The panels of a figure as one JSON string, and back."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import MISSING, fields
from typing import Any

from atmosbox.scene.panels.line import Line
from atmosbox.scene.panels.panel import Panel

__all__ = ["from_json", "to_json"]

_FORMAT = 1


def to_json(panels: Iterable[Panel]) -> str:
    """Return the panels of a figure as the text that is stored in a file.

    Parameters
    ----------
    panels : iterable of Panel
        The panels, in reading order.

    Returns
    -------
    str
        JSON, in ASCII. Fields with their default values are left out.

    Examples
    --------
    >>> to_json([Panel("discs", "The box")])
    '{"format": 1, "panels": [{"kind": "discs", "title": "The box"}]}'
    """
    return json.dumps({"format": _FORMAT, "panels": [_as_record(panel) for panel in panels]})


def from_json(text: str) -> tuple[Panel, ...]:
    """Return the panels from the text that is stored in a file.

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
        If the text is no JSON, or was written by another program or by a version with another format.

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
        if not isinstance(values.setdefault(name, []), list):
            raise ValueError(f"{name} of a panel are no list.")
    values["lines"] = tuple(Line(**_values("line", item, Line)) for item in values["lines"])
    for name in ("headlines", "marks", "start", "x_limits", "y_limits"):
        values[name] = tuple(values[name])
    values["guides"] = tuple(map(tuple, values["guides"]))
    return Panel(**values)


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
    record: dict[str, object] = {}
    for field in fields(item):
        value = getattr(item, field.name)
        if value == field.default:
            continue
        if field.name == "lines":
            value = [_as_record(line) for line in value]
        record[field.name] = value
    return record

"""A panel of curves over time."""

from __future__ import annotations

from typing import Any

from atmosbox.scene.panels.line import Line
from atmosbox.scene.panels.panel import Panel

__all__ = ["over_time"]


def over_time(
    title: str,
    curves: dict[str, str],
    label: str,
    unit: str = "",
    *,
    theory: str = "",
    more: tuple[Line, ...] = (),
    log: bool = False,
    parts: int = 0,
    headline: str = "",
    start: float | None = None,
    **others: Any,
) -> Panel:
    """Return a panel of curves over time.

    Parameters
    ----------
    title
        Title of the panel, a sentence.
    curves
        Names of the measured variables, with the label of each.
    label, unit
        Label and unit of the vertical axis.
    theory
        Label of the theory of the first curve; empty for none.
    more
        Further lines.
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
        "line",
        title,
        (*lines, *more),
        x_label="time",
        y_label=label,
        y_unit=unit,
        x_scale="log" if log else "linear",
        averages=parts,
        headlines=(headline,) if headline else (),
        start=() if start is None else (0.0, start),
        **others,
    )

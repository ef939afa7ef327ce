"""The panel that shows how vapour and liquid approach equilibrium."""

from __future__ import annotations

from atmosbox.scene.panels import Line, Panel

__all__ = ["history"]


def history(
    title: str, curves: dict[str, str], label: str, unit: str = "", *, parts: int, headline: str = "", theory: str = ""
) -> Panel:
    """Return a panel of curves over the logarithm of time, because most of the change happens at the start.

    Parameters
    ----------
    title
        Title of the panel, a sentence.
    curves
        Names of variables, with the label of each.
    label, unit
        Label and unit of the vertical axis.
    parts
        Number of equal parts of the axis of time over which the curves are averaged.
    headline
        Name of the number that is written into the panel.
    theory
        Label of the theory of the first curve; empty for none.

    Examples
    --------
    >>> history("It cools", {"gas_temperature": "air"}, "temperature", "K", parts=10, theory="rest").lines[1].y
    'gas_temperature_theory'
    """
    time = "elapsed_time"
    lines = [Line(time, name, called) for name, called in curves.items()]
    if theory:
        lines.append(Line(time, f"{next(iter(curves))}_theory", theory, "theory"))
    return Panel(
        "line",
        title,
        tuple(lines),
        x_label="time",
        y_label=label,
        y_unit=unit,
        x_scale="log",
        averages=parts,
        headlines=(headline,) if headline else (),
    )

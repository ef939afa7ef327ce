"""How the scenes of vapour and liquid are shown."""

from __future__ import annotations

from atmosbox.scene.panels import Line, Panel

__all__ = ["history"]


def history(
    title: str, curves: dict[str, str], label: str, unit: str = "", *, parts: int, headline: str = "", theory: str = ""
) -> Panel:
    """Return a panel of curves over the logarithm of time, for all happens at first.

    Parameters
    ----------
    title
        What it shows, as a sentence.
    curves
        Names of variables, and what they are called.
    label, unit
        Of the vertical axis.
    parts
        Into how many equal parts of the axis of time the curves are averaged.
    headline
        Name of the number that is written into it.
    theory
        What the theory of the first curve is called; none if empty.

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

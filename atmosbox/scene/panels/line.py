"""One curve of a panel."""

from __future__ import annotations

from dataclasses import dataclass

from atmosbox.scene.panels.text_check import check_choice, check_text

__all__ = ["ROLES", "Line"]

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

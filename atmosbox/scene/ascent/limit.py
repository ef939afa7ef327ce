"""Checks of the settings of an ascent: what a lifted parcel may not be."""

from __future__ import annotations

from atmosbox.errors import Setting, SettingError

__all__ = ["refuse_descent", "refuse_supersaturation"]


def refuse_descent(top_pressure: float, ground_pressure: float, ground: str = "the pressure at the ground") -> None:
    """Refuse an ascent that does not go up.

    Parameters
    ----------
    top_pressure, ground_pressure
        Pressure at the end and at the start of the ascent [hPa].
    ground
        Name of the pressure at the start, for the message.

    Raises
    ------
    SettingError
        If the top is less than 2 % below the ground.

    Examples
    --------
    >>> refuse_descent(990.0, 1000.0)
    Traceback (most recent call last):
        ...
    atmosbox.errors.SettingError: top_pressure = 990 hPa is not below the pressure at the ground, 1000 hPa:
    give top_pressure="300hPa".
    """
    if top_pressure > 0.98 * ground_pressure:
        raise SettingError(
            "top_pressure",
            f"{top_pressure:g} hPa",
            f"is not below {ground}, {ground_pressure:g} hPa",
            Setting("top_pressure", f"{0.3 * ground_pressure:.0f}hPa"),
        )


def refuse_supersaturation(dewpoint: float, temperature: float) -> None:
    """Refuse a dewpoint above the temperature, both in degC.

    Raises
    ------
    SettingError
        If the air holds more vapour than saturation.

    Examples
    --------
    >>> refuse_supersaturation(26.0, 25.0)
    Traceback (most recent call last):
    ...
    atmosbox.errors.SettingError: dewpoint = 26 degC is above the temperature, 25 degC:
    such air is in its cloud already: give dewpoint="25degC" for saturated air.
    """
    if dewpoint > temperature:
        raise SettingError(
            "dewpoint",
            f"{dewpoint:g} degC",
            f"is above the temperature, {temperature:g} degC: such air is in its cloud already",
            Setting("dewpoint", f"{temperature:g}degC"),
            " for saturated air",
        )

"""One way of running a scene: an engine with its options, and settings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from atmosbox.errors import SettingError
from atmosbox.scene import engines
from atmosbox.scene.setup import Series

__all__ = ["Rung", "rungs"]


@dataclass(frozen=True)
class Rung:
    """One way of running a scene.

    Parameters
    ----------
    engine
        The engine with its options.
    settings
        The settings that differ from the scene's defaults.
    series
        Index of its series in the scene.
    value
        Its value of the setting or option that varies in the series.
    """

    engine: str
    settings: Mapping[str, Any]
    series: int
    value: float

    @property
    def label(self) -> str:
        """The engine and the settings as text, without the scene.

        Examples
        --------
        >>> Rung("exact", {"ascent": 400}, 0, 400.0).label
        'exact, ascent=400'
        """
        return ", ".join([self.engine, *(f"{name}={value}" for name, value in self.settings.items())])


def rungs(series: Sequence[Series], settings: Mapping[str, Any]) -> tuple[Rung, ...]:
    """Return every run of some series.

    Parameters
    ----------
    series
        The series.
    settings
        The user's settings for all series; a series overrides them by its own settings and its varied setting.

    Raises
    ------
    SettingError
        If there are no series or values, or an engine or one of its options is refused.

    Examples
    --------
    >>> [rung.label for rung in rungs([Series("exact", "ascent", (100, 200))], {"molecules": 500})]
    ['exact, molecules=500, ascent=100', 'exact, molecules=500, ascent=200']
    """
    found = []
    for place, row in enumerate(series):
        options = {parameter.name for parameter in engines.choose(row.engine).engine.parameters}
        for value in row.values:
            engine, own = row.engine, {**row.settings}
            if row.vary in options:
                engine += f"{',' if ':' in engine else ':'}{row.vary}={value:g}"
            else:
                own[row.vary] = value
            found.append(Rung(str(engines.choose(engine)), {**settings, **own}, place, float(value)))
    if not found:
        raise SettingError("scene", None, "declares nothing to compare", "give its module a ladder of Series")
    return tuple(found)

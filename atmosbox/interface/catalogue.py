"""The list of scenes, and the settings of a scene."""

from __future__ import annotations

import os
from collections.abc import Sequence

from atmosbox.interface.notebook import preformatted

__all__ = ["Printed", "scenes"]

_WIDTH = 100


class Printed(tuple[str, ...]):
    """Names that print as a table, in a terminal and in a notebook.

    Examples
    --------
    >>> Printed(["one", "two"], ["one  first", "two  second"])
    one  first
    two  second
    """

    lines: Sequence[str]

    def __new__(cls, names: Sequence[str], lines: Sequence[str]) -> Printed:
        """Make the tuple of names, with the lines that print them."""
        made = super().__new__(cls, names)
        made.lines = lines
        return made

    def __repr__(self) -> str:
        """Return the table."""
        return "\n".join(self.lines)

    def _repr_html_(self) -> str:
        """Return the table for a notebook."""
        return preformatted(repr(self))


def scenes(scene: str | os.PathLike[str] | None = None) -> Printed:
    """Return the names of all scenes, or of the settings of one scene; printed, each has a line that explains it.

    Parameters
    ----------
    scene
        Name of the scene whose settings to return, or the path of your own; by default the scenes are returned.

    Returns
    -------
    tuple of str
        The names, which print as a table.

    Raises
    ------
    UnknownSceneError
        If there is no scene of this name.

    Examples
    --------
    >>> import atmosbox as ab
    >>> "lifting-dry" in ab.scenes(), "temperature" in ab.scenes("lifting-dry")
    (True, True)
    """
    from atmosbox import scenarios
    from atmosbox.text.report import parameter_lines, scene_lines

    if scene is None:
        found = scenarios.summaries()
        return Printed(list(found), scene_lines(found, _WIDTH))
    module = scenarios.load(scene)
    declared = module.Settings.describe()
    story = (module.__doc__ or "").strip().partition("\n\n")[0].replace("\n", " ")
    lines = [f"{os.fspath(scene)}: {story}", "", *parameter_lines(declared, _WIDTH)]
    return Printed([parameter.name for parameter in declared], lines)

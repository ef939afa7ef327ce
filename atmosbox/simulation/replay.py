"""A scene made ready to run as a page ran it: from its link, and the link of a run that begins."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING
from urllib.parse import quote

from atmosbox import scenarios
from atmosbox.errors import Command, Option, SettingError, shown
from atmosbox.simulation.link import read_link, refuse
from atmosbox.simulation.preparation import Prepared, prepare
from atmosbox.version import __version__

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["check_nothing_changes", "link_start", "replayed"]


def link_start(prepared: Prepared) -> str:
    """Return the part of a link that a run without a turned knob has: all but the seed and the number of frames.

    Examples
    --------
    >>> link_start(prepare("temperature", {"molecules": 400, "seed": 7})).partition("&")[2]
    'scene=temperature&molecules=400'
    """
    changed = {name: value for name, value in prepared.settings.changed().items() if name != "seed"}
    pairs = {"atmosbox": __version__, "scene": os.path.basename(prepared.scene), **changed}
    return "&".join(f"{name}={quote(str(value), safe='')}" for name, value in pairs.items())


def replayed(
    text: str, scene: str | os.PathLike[str] | None = None, *, save_molecules: bool | None = False
) -> Prepared:
    """Return the scene of a link, ready to run as the page ran it.

    Parameters
    ----------
    text
        An address of a page, or its part from ``#`` on.
    scene
        The path of the scene, if it is one of your own: a link alone never makes atmosbox run a program.
    save_molecules
        As in `prepare`.

    Raises
    ------
    AtmosboxError
        If the link, its scene or one of its settings is refused.

    Examples
    --------
    >>> replayed(f"#atmosbox={__version__}&scene=temperature&molecules=40&seed=7&frames=90&end").settings.molecules
    40
    """
    named, settings, replay = read_link(text)
    if scene is None and named not in scenarios.names():
        own = Command("run", (named, Option("replay", "LINK"))) if named.endswith(".py") else Command("list")
        why = "of your own, whose file must be typed" if named.endswith(".py") else "that there is not"
        raise SettingError("replay", text, f"is for a scene {why}, {shown(named)}", own)
    if scene is not None and os.path.basename(scene).replace("_", "-") != named.replace("_", "-"):
        raise SettingError("replay", text, f"is for the scene {shown(named)}, not for {scene}", "leave one of them out")
    typed = named if scene is None else scene
    for told in scenarios.load(typed).Settings.describe():
        if told.kind == "str" and not told.choices and settings.get(told.name, told.default) != told.default:
            refuse(text, f"names a file, {told.name} = {shown(settings[told.name])}, which a link must not")
    prepared = prepare(typed, settings, engine="exact", save_molecules=save_molecules)
    return replace(prepared, replay=replay)


def check_nothing_changes(what: str, given: Mapping[str, object]) -> None:
    """Refuse options that would change a run that is already determined.

    Raises
    ------
    SettingError
        If any is given.
    """
    for name, value in given.items():
        if value is not None and value != []:
            raise SettingError(name, None, f"cannot change {what}", "leave it out")

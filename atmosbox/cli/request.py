"""Where the settings of a run come from: the command line, a settings file, an earlier run."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from atmosbox.cli.terminal import tell
from atmosbox.errors import AtmosboxError, ConfigError, FileError, SettingError, UnknownSceneError

if TYPE_CHECKING:
    from atmosbox.cli.config import Asked


@dataclass(frozen=True)
class Request:
    """A run as it was asked for, before anything of it is checked.

    Parameters
    ----------
    scene
        The name of a scene, or the path of one; None where a file says it.
    values
        What stood behind each ``--set``.
    config, source
        The files behind ``--config`` and ``--from``.
    seed
        What stood behind ``--seed``.
    save_molecules
        Whether the molecules are saved.
    engine
        What stood behind ``--engine``.
    accuracy
        What stood behind ``--accuracy``.
    """

    scene: str | None
    values: Sequence[str] = ()
    config: str | None = None
    source: str | None = None
    seed: str | None = None
    save_molecules: bool = False
    engine: str | None = None
    accuracy: str | None = None

    def gather(self) -> Asked:
        """Return what the files, ``--set`` and ``--seed`` ask for together; of two values the later one counts.

        Raises
        ------
        AtmosboxError
            If a file or a text cannot be understood, two of them name different scenes, or an accuracy is wished of
            a run whose engine is given.
        """
        from atmosbox.cli.config import Asked, load_config
        from atmosbox.scene.spelling import assignments

        scene = self.scene or ""
        settings: dict[str, Any] = {}
        engine = None
        molecules = self.save_molecules
        accuracy = self.accuracy
        if self.source is not None:
            run = _earlier(self.source)
            scene = _agreed(scene, run.scene, "--from", self.source, FileError)
            settings, engine, molecules = run.settings, run.engine, molecules or run.save_molecules
        if self.config is not None:
            asked = load_config(self.config)
            scene = _agreed(scene, asked.scene, "--config", self.config, ConfigError)
            settings, engine = _over(settings, asked.settings), asked.engine or engine
            accuracy = accuracy or asked.accuracy
        settings = _over(settings, assignments(self.values))
        if self.seed is not None:
            settings = _over(settings, {"seed": self.seed})
        if not scene:
            raise UnknownSceneError(
                "No scene is given: name one, such as atmosbox run lifting-dry; `atmosbox list` shows all."
            )
        if accuracy is not None and self.source is not None:
            problem = f"picks engine and settings, and so does --from {shlex.quote(self.source)}"
            raise SettingError("accuracy", accuracy, problem, "leave one of them out")
        return Asked(scene, settings, self.engine or engine, molecules, accuracy)


def is_path(scene: str) -> bool:
    """Return whether a scene is given by the path of its file rather than by its name."""
    return scene.endswith(".py") or "/" in scene or os.sep in scene


def _earlier(path: str) -> Asked:
    """Return the run in a file."""
    from atmosbox.cli.config import Asked
    from atmosbox.file.netcdf import read
    from atmosbox.file.provenance import parameters
    from atmosbox.version import __version__

    made = parameters(read(path))
    scene, settings = made.get("scene"), made.get("settings")
    if not isinstance(scene, str) or not isinstance(settings, dict):
        raise FileError(f"{path} does not say which run it holds: give a file that atmosbox run has written.")
    if made.get("version") != __version__:
        tell(f"note: {path} is from atmosbox {made.get('version')}, not {__version__}: numbers may differ")
    return Asked(scene, settings, str(made.get("engine", "exact")), made.get("save_molecules") is True)


def _agreed(scene: str, named: str, option: str, path: str, error: type[AtmosboxError]) -> str:
    """Return the scene that the command line and a file agree on.

    A file never makes atmosbox run a program: the path of a scene must be typed.
    """
    if not named:
        return scene
    if not scene:
        if is_path(named):
            again = f"atmosbox run {shlex.quote(named)} {option} {shlex.quote(path)}"
            raise error(f"{path} is for the scene in the file {named}, which must be typed: {again}.")
        return named
    if not (is_path(scene) or is_path(named)) and scene.replace("_", "-") != named.replace("_", "-"):
        raise error(f"{path} is for the scene {named}, not for {scene}: leave one of them out.")
    return scene


def _over(settings: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings with those replaced that have a new value, however their names are spelled."""
    from atmosbox.scene.spelling import field_name

    new = {field_name(name) for name in values}
    return {**{name: value for name, value in settings.items() if field_name(name) not in new}, **values}

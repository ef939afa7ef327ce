"""Where the settings of a run come from: the command line, a settings file, an earlier run."""

from __future__ import annotations

import os
import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from atmosbox.cli.terminal import tell
from atmosbox.errors import AtmosboxError, ConfigError, FileError, SettingError, UnknownSceneError


class Gathered(NamedTuple):
    """A run as all that was given says together; None for the engine or the accuracy that nothing names."""

    scene: str
    settings: dict[str, Any]
    engine: str | None
    molecules: bool
    accuracy: str | None


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

    def gather(self) -> Gathered:
        """Return the scene, its settings, the engine, whether molecules are saved, and the accuracy.

        What is given later wins: ``--from``, ``--config``, ``--set``, ``--seed``.

        Raises
        ------
        AtmosboxError
            If a file or a text cannot be understood, two of them name different scenes, or an accuracy is wished of
            a run whose engine is given.
        """
        from atmosbox.cli.config import load_config, parse_set

        scene = self.scene
        settings: dict[str, Any] = {}
        molecules = self.save_molecules
        engine = self.engine
        accuracy = self.accuracy
        if self.source is not None:
            run, settings, made_by, saved = _earlier(self.source)
            engine = engine or made_by
            molecules = molecules or saved
            scene = _agreed(scene, run, "--from", self.source, FileError)
        if self.config is not None:
            asked = load_config(self.config)
            engine = self.engine or asked.engine or engine
            accuracy = accuracy or asked.accuracy
            scene = _agreed(scene, asked.scene, "--config", self.config, ConfigError)
            settings = _over(settings, asked.settings)
        settings = _over(settings, parse_set(self.values))
        if self.seed is not None:
            settings = _over(settings, {"seed": self.seed})
        if scene is None:
            raise UnknownSceneError(
                "No scene is given: name one, such as atmosbox run lifting-dry; `atmosbox list` shows all."
            )
        if accuracy is not None and self.source is not None:
            problem = f"picks engine and settings, and so does --from {shlex.quote(self.source)}"
            raise SettingError("accuracy", accuracy, problem, "leave the one or the other out")
        return Gathered(scene, settings, engine, molecules, accuracy)


def is_path(scene: str) -> bool:
    """Return whether a scene is given by the path of its file rather than by its name."""
    return scene.endswith(".py") or "/" in scene or os.sep in scene


def _earlier(path: str) -> tuple[str, dict[str, Any], str, bool]:
    """Return scene, settings and engine of the run in a file, and whether it saved molecules."""
    from atmosbox.file.netcdf import read
    from atmosbox.file.provenance import parameters
    from atmosbox.version import __version__

    made = parameters(read(path))
    scene, settings = made.get("scene"), made.get("settings")
    if not isinstance(scene, str) or not isinstance(settings, dict):
        raise FileError(f"{path} does not say which run it holds: give a file that atmosbox run has written.")
    if made.get("version") != __version__:
        tell(f"note: {path} is from atmosbox {made.get('version')}, not {__version__}: numbers may differ")
    return scene, settings, str(made.get("engine", "exact")), made.get("save_molecules") is True


def _agreed(scene: str | None, named: str | None, option: str, path: str, error: type[AtmosboxError]) -> str | None:
    """Return the scene that the command line and a file agree on.

    A file never makes atmosbox run a program: the path of a scene must be typed.
    """
    if named is None:
        return scene
    if scene is None:
        if is_path(named):
            again = f"atmosbox run {shlex.quote(named)} {option} {shlex.quote(path)}"
            raise error(f"{path} is for the scene in the file {named}, which must be typed: {again}.")
        return named
    if not (is_path(scene) or is_path(named)) and scene.replace("_", "-") != named.replace("_", "-"):
        raise error(f"{path} is for the scene {named}, not for {scene}: leave the one or the other out.")
    return scene


def _over(settings: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return settings with others laid over them, however their names are spelled."""
    laid = {name.strip().replace("-", "_") for name in values}
    kept = {name: value for name, value in settings.items() if name.strip().replace("-", "_") not in laid}
    return {**kept, **values}

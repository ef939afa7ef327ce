"""Where the settings of a run come from: the command line, a settings file, an earlier run."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from atmosbox.cli.terminal import prints_to_stderr, tell
from atmosbox.errors import AtmosboxError, ConfigError, FileError, SettingError, UnknownSceneError

if TYPE_CHECKING:
    from atmosbox.cli.config import Asked
    from atmosbox.simulation.preparation import Prepared

WARM = 100.0  # degC: above it, a number without a unit may have been meant in kelvin


def gather(
    scene: str | None,
    values: Sequence[str] = (),
    config: str | None = None,
    source: str | None = None,
    seed: str | None = None,
    save_molecules: bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
) -> Asked:
    """Return the request for a run that the whole command line makes; its settings are not yet checked.

    If a setting has two values, the later in this list counts: ``--from``, ``--config``, ``--set``, ``--seed``.

    Parameters
    ----------
    scene
        The name of a scene, or the path of its file; None if the file after ``--config`` or ``--from`` names it.
    values
        The texts after each ``--set``.
    config, source
        The files after ``--config`` and ``--from``.
    seed, engine, accuracy
        The texts after the options of these names.
    save_molecules
        Whether the molecules are saved; None if they were in the earlier run, or take less than 10 MB.

    Raises
    ------
    AtmosboxError
        If a file or a text cannot be understood, if two of them name different scenes, or if both an accuracy and an
        engine are asked for.

    Examples
    --------
    >>> gather("lifting-dry", ["temperature=25degC"], seed="7").settings
    {'temperature': '25degC', 'seed': '7'}
    """
    from atmosbox.cli.config import Asked, load_config
    from atmosbox.scene.spelling import assignments

    scene = scene or ""
    settings: dict[str, Any] = {}
    of_file: str | None = None
    if source is not None:
        run = _earlier(source)
        scene = _agreed(scene, run.scene, "--from", source, FileError)
        settings, of_file = run.settings, run.engine
        save_molecules = run.save_molecules if save_molecules is None else save_molecules
    if config is not None:
        asked = load_config(config)
        scene = _agreed(scene, asked.scene, "--config", config, ConfigError)
        settings, of_file = _over(settings, asked.settings), asked.engine or of_file
        accuracy = accuracy or asked.accuracy
    settings = _over(settings, assignments(values))
    if seed is not None:
        settings = _over(settings, {"seed": seed})
    if not scene:
        raise UnknownSceneError(
            "No scene is given: name one, such as atmosbox run lifting-dry; `atmosbox list` shows all."
        )
    if accuracy is not None and source is not None:
        problem = f"picks engine and settings, and so does --from {shlex.quote(source)}"
        raise SettingError("accuracy", accuracy, problem, "leave one of them out")
    return Asked(scene, settings, engine or of_file, save_molecules, accuracy)


def checked(asked: Asked) -> Prepared:
    """Return the scene of a request, checked; say how a high temperature without a unit was taken."""
    from atmosbox.scene.spelling import field_name
    from atmosbox.simulation import runner

    with prints_to_stderr():
        made = runner.prepare(**asked._asdict())
    values = {field_name(name): str(value).strip() for name, value in asked.settings.items() if isinstance(value, str)}
    for parameter in made.settings.describe():
        name, value = parameter.name, values.get(parameter.name, "")
        if parameter.unit == "degC" and re.fullmatch(r"[0-9]+(\.[0-9]*)?", value) and float(value) > WARM:
            tell(f"note: {name}={value} is taken as {value} degC; for kelvin, give {name}={value}K")
    return made


def with_fewer_molecules(asked: Asked) -> Asked:
    """Return the request of a page in which a scene runs: on the exact engine, with as few molecules as suit watching.

    Numbers that the user gave are kept; what was taken instead of the scene's own is said.
    """
    from atmosbox.lab.wasm_module import SCENES
    from atmosbox.scene.spelling import field_name

    few = SCENES.get(asked.scene.replace("_", "-"), {})
    if not few or asked.accuracy is not None or {field_name(name) for name in asked.settings} & {"molecules", *few}:
        return asked.for_a_page()
    told = " and ".join(f"{name}={value}" for name, value in few.items())
    tell(f"note: the page begins with {told}, fewer than a run has; give --set molecules=N for more")
    return asked._replace(settings={**asked.settings, **few}).for_a_page()


def is_path(scene: str) -> bool:
    """Return whether a scene is given by the path of its file rather than by its name."""
    return scene.endswith(".py") or "/" in scene or os.sep in scene


def _earlier(path: str) -> Asked:
    """Return the request that made the run in a file."""
    from atmosbox.cli.config import Asked
    from atmosbox.file.netcdf import read
    from atmosbox.file.provenance import parameters
    from atmosbox.version import __version__

    made = parameters(read(path))
    scene, settings, kept = made.get("scene"), made.get("settings"), made.get("save_molecules")
    if not isinstance(scene, str) or not isinstance(settings, dict):
        raise FileError(f"{path} does not say which run it holds: give a file that atmosbox has written.")
    if "replay" in made:
        tell(f"note: in {path} knobs may have been turned, and this run turns none; --replay does")
    if made.get("version") != __version__:
        tell(f"note: {path} is from atmosbox {made.get('version')}, not {__version__}: numbers may differ")
    return Asked(scene, settings, str(made.get("engine", "exact")), kept if isinstance(kept, bool) else None)


def _agreed(scene: str, named: str, option: str, path: str, error: type[AtmosboxError]) -> str:
    """Return the scene, which the command line and a file must not name differently.

    A file never makes atmosbox run code: the path of a user's own scene must be typed.
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
    """Return the settings with new values in place of old ones; names may be spelled with - or _."""
    from atmosbox.scene.spelling import field_name

    new = {field_name(name) for name in values}
    return {**{name: value for name, value in settings.items() if field_name(name) not in new}, **values}

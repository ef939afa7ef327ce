"""Where the settings of a run come from: the command line, a settings file, an earlier run.

Which names and values are allowed is defined by the settings of the scene:
:class:`atmosbox.scene.settings.SceneSettings`.
"""

from __future__ import annotations

import os
import re
import shlex
import tomllib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from atmosbox.cli.option import Sought
from atmosbox.cli.terminal import prints_to_stderr, tell
from atmosbox.errors import ConfigError, FileError, SettingError, UnknownSceneError, shown
from atmosbox.scene.settings import Value
from atmosbox.scene.spelling import assignments, field_name, nearest

if TYPE_CHECKING:
    from atmosbox.simulation.preparation import Prepared

_LARGEST_CONFIG = 1_000_000  # bytes
_WORDS = {
    "scene": ("without a name", 'give the name of one, such as scene = "lifting-dry"'),
    "engine": ("without a name", 'give the name of one, such as engine = "exact"'),
    "accuracy": ("that is not a text", 'give a target or an error in quotes, such as accuracy = "0.5K"'),
}


class Asked(NamedTuple):
    """The request for a run by a settings file, by an earlier run or by the whole command line.

    Parameters
    ----------
    scene
        The name of the scene, or the path of its file; empty if none is named.
    settings
        The values as they were written, by name.
    engine
        The name of the engine, with its options; None if none is named.
    save_molecules
        Whether the molecules are saved; None if they take less than 10 MB.
    accuracy
        The requested accuracy, if any.
    """

    scene: str
    settings: dict[str, Any]
    engine: str | None = None
    save_molecules: bool | None = False
    accuracy: str | None = None

    def for_a_page(self) -> Asked:
        """Return the request with the exact engine, the one that a page contains, unless it names another."""
        return self._replace(engine="exact") if self.engine is None and self.accuracy is None else self


def load_config(path: str | os.PathLike[str]) -> Asked:
    r"""Return the scene, the settings, and the engine or the accuracy that a TOML file asks for.

    The file may name a scene, an engine or an accuracy, and hold one table of settings. It cannot run code::

        scene = "lifting-dry"
        accuracy = "lecture"

        [settings]
        temperature = "25degC"
        molecules = 4000

    Examples
    --------
    >>> import pathlib, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "lift.toml")
    ...     _ = path.write_text('scene = "lifting-dry" \n [settings] \n temperature = "25degC"')
    ...     load_config(path)
    Asked(scene='lifting-dry', settings={'temperature': '25degC'}, engine=None, save_molecules=False, accuracy=None)
    """
    where = shown(os.fspath(path), longest=4096)
    try:
        with open(path, "rb") as file:
            raw = file.read(_LARGEST_CONFIG + 1)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or "not a path"
        raise FileError(f"{where} cannot be read ({reason}): give the path of a settings file.") from error
    content = _toml(raw, where)

    def refusal(key: str, problem: str, fix: str) -> ConfigError:
        return ConfigError(f"{where} has {shown(key)} {problem}: {fix}.")

    known = (*_WORDS, "settings")
    for key in sorted(content.keys() - set(known)):
        near = nearest(key, known)
        fix = f"name it {near}" if near else "move what is a setting below a line [settings]"
        raise refusal(key, "outside the table [settings]", fix)
    settings = content.get("settings", {})
    words = {key: str(content[key]).strip() for key in _WORDS if key in content}
    for key, word in words.items():
        if not (word and isinstance(content[key], str)):
            raise refusal(key, *_WORDS[key])
    if not isinstance(settings, dict):
        raise refusal("settings", "that is not a table", "write a line [settings], and below it the settings")
    for key, value in settings.items():
        if not isinstance(value, Value):
            fix = 'give one number, true, false or a text in quotes, such as "25degC"'
            raise refusal(key, "that is not a number, switch or text", fix)
    return Asked(words.get("scene", ""), settings, words.get("engine"), accuracy=words.get("accuracy"))


def _toml(raw: bytes, where: str) -> dict[str, Any]:
    """Return the content of a settings file, or raise ConfigError."""
    if raw.startswith((b"\x89HDF", b"CDF")):
        raise ConfigError(f"{where} is a netCDF file, not a settings file: give it with --from {where}.")
    if len(raw) > _LARGEST_CONFIG or b"\0" in raw:
        raise ConfigError(f"{where} is not a settings file: give a TOML file of at most 1 MB, saved as UTF-8.")
    try:
        return tomllib.loads(raw.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise ConfigError(f"{where}, line {line} is not UTF-8 text: save the file as UTF-8.") from error
    except (ValueError, RecursionError) as error:
        fix = 'write one name = value a line, with text in quotes, such as temperature = "25degC"'
        raise ConfigError(f"{where} is not TOML ({shown(str(error), longest=200)}): {fix}.") from error


WARM = 100.0  # degC: above it, a number without a unit may have been meant in kelvin


def gather(sought: Sought, save_molecules: bool | None = None) -> Asked:
    """Return the request for a run that the whole command line makes; its settings are not yet checked.

    If a setting has two values, the later in this list counts: ``--from``, ``--config``, ``--set``, ``--seed``. The
    scene may be named by one of the files.

    Examples
    --------
    >>> gather(Sought("lifting-dry", ["temperature=25degC"], seed="7")).settings
    {'temperature': '25degC', 'seed': '7'}
    """
    from atmosbox.simulation.preparation import agreed

    scene, accuracy, source = sought.scene or "", sought.accuracy, sought.source
    settings: dict[str, Any] = {}
    of_file: str | None = None
    if source is not None:
        run = _earlier(source)
        scene = agreed(scene, run.scene, source, "from")
        settings, of_file = run.settings, run.engine
        save_molecules = run.save_molecules if save_molecules is None else save_molecules
    if sought.config is not None:
        asked = load_config(sought.config)
        scene = agreed(scene, asked.scene, sought.config, "config", ConfigError)
        settings, of_file = _over(settings, asked.settings), asked.engine or of_file
        accuracy = accuracy or asked.accuracy
    settings = _over(settings, assignments(sought.values or ()))
    settings = _over(settings, {} if sought.seed is None else {"seed": sought.seed})
    if not scene:
        raise UnknownSceneError(
            "No scene is given: name one, such as atmosbox run lifting-dry; `atmosbox list` shows all."
        )
    if accuracy is not None and source is not None:
        problem = f"picks engine and settings, and so does --from {shlex.quote(source)}"
        raise SettingError("accuracy", accuracy, problem, "leave one of them out")
    return Asked(scene, settings, sought.engine or of_file, save_molecules, accuracy)


def checked(asked: Asked) -> Prepared:
    """Return the scene of a request, checked; say how a high temperature without a unit was taken."""
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

    few = SCENES.get(asked.scene.replace("_", "-"), {})
    if not few or asked.accuracy is not None or {field_name(name) for name in asked.settings} & {"molecules", *few}:
        return asked.for_a_page()
    told = " and ".join(f"{name}={value}" for name, value in few.items())
    tell(f"note: the page begins with {told}, fewer than a run has; give --set molecules=N for more")
    return asked._replace(settings={**asked.settings, **few}).for_a_page()


def _earlier(path: str) -> Asked:
    """Return the request that made the run in a file."""
    from atmosbox.file.netcdf import read
    from atmosbox.file.provenance import parameters
    from atmosbox.version import __version__

    made = parameters(read(path))
    scene, settings, kept = made.get("scene"), made.get("settings"), made.get("save_molecules")
    if not isinstance(scene, str) or not isinstance(settings, dict):
        raise FileError(f"{path} does not say which run it holds: give a file that atmosbox has written.")
    if "replay" in made:
        tell(f"note: in {path} sliders may have been moved, and this run moves none; --replay does")
    if made.get("version") != __version__:
        tell(f"note: {path} is from atmosbox {made.get('version')}, not {__version__}: numbers may differ")
    return Asked(scene, settings, str(made.get("engine", "exact")), kept if isinstance(kept, bool) else None)


def _over(settings: Mapping[str, Any], values: Mapping[str, Any]) -> dict[str, Any]:
    """Return the settings with new values in place of old ones; names may be spelled with - or _."""
    new = {field_name(name) for name in values}
    return {**{name: value for name, value in settings.items() if field_name(name) not in new}, **values}

"""Read a settings file, without checking its settings.

Which names and values are allowed is defined by the settings of the scene:
:class:`atmosbox.scene.settings.SceneSettings`.
"""

from __future__ import annotations

import os
import tomllib
from typing import Any, NamedTuple

from atmosbox.errors import ConfigError, FileError, shown
from atmosbox.scene.settings import Value
from atmosbox.scene.spelling import nearest

__all__ = ["Asked", "load_config"]

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

    Parameters
    ----------
    path
        Path of the file.

    Returns
    -------
    Asked
        The request.

    Raises
    ------
    FileError
        If the file cannot be read.
    ConfigError
        If it is not TOML, or holds anything else; the message names what.

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
    words: dict[str, str | None] = {}
    for key, (problem, fix) in _WORDS.items():
        word = content.get(key)
        if word is not None and not (isinstance(word, str) and word.strip()):
            raise refusal(key, problem, fix)
        words[key] = word and word.strip()
    if not isinstance(settings, dict):
        raise refusal("settings", "that is not a table", "write a line [settings], and below it the settings")
    for key, value in settings.items():
        if not isinstance(value, Value):
            fix = 'give one number, true, false or a text in quotes, such as "25degC"'
            raise refusal(key, "that is not a number, switch or text", fix)
    return Asked(words["scene"] or "", settings, words["engine"], accuracy=words["accuracy"])


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

"""List and load the scenarios.

A scenario is a module that describes one experiment: its settings, how its box is built, what theory
predicts and what its figure shows. The scenarios of atmosbox are in the folder ``scenarios/`` at the top of
the checkout and are imported as ``atmosbox.scenarios.<module>``. A lecturer's own scenario is a module of the same
form, loaded by its path.

An installed atmosbox has the modules of that folder here, beside this file. A checkout has them two folders
up, so a checkout, installed or not, adds that folder to ``__path__``.
"""

import ast
import difflib
import importlib
import importlib.util
import os
import pkgutil
import sys
import traceback
import zlib
from importlib.abc import InspectLoader
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from atmosbox.errors import Command, FileError, Option, UnknownSceneError, shown

__all__ = ["REQUIRED", "Summary", "is_path", "load", "names", "place", "summaries"]

REQUIRED = ("Settings", "build", "theory", "headlines", "panels")
"""What every scenario module must define."""

_OWN = "_atmosbox_scene_"  # begins the name of the module of a user's own scene

_ORDER = (
    "temperature",
    "temperature-large",
    "elastic-collisions",
    "diffusion",
    "atmosphere",
    "lifting-dry",
    "convection",
    "evaporation",
    "condensation",
    "nuclei",
    "lifting-moist",
    "lifting-sounding",
    "mountains",
    "attraction",
)
"""The order of teaching; scenes not named here follow by name."""


class Summary(NamedTuple):
    """What `atmosbox list` says of a scene."""

    sentence: str
    """The first sentence of its docstring."""
    level: str
    """For whom it is: school, first year or second year."""
    minutes: int | None
    """How much time of a class it takes."""


def _checkout_scenarios(here: Path) -> Path | None:
    """Return the top-level folder ``scenarios/`` if ``here`` is in a checkout of atmosbox."""
    root = here.parent.parent
    project = root / "pyproject.toml"
    folder = root / "scenarios"
    # After `pip install --target`, a pyproject.toml and scenarios/ of another project may be there.
    if project.is_file() and folder.is_dir() and 'name = "atmosbox"' in project.read_text(encoding="utf-8"):
        return folder
    return None


_checkout = _checkout_scenarios(Path(__file__).resolve().parent)
if _checkout is not None:
    __path__.append(str(_checkout))


def names() -> tuple[str, ...]:
    """Return the names of all scenarios that come with atmosbox.

    The folder is listed; no scenario is imported.

    Returns
    -------
    tuple of str
        The names in the order of teaching, as a user types them: with dashes.

    Examples
    --------
    >>> "lifting-dry" in names()
    True
    """
    found = {module.name for module in pkgutil.iter_modules(__path__) if not module.name.startswith("_")}
    place = {name: k for k, name in enumerate(_ORDER)}
    typed = (name.replace("_", "-") for name in found)
    return tuple(sorted(typed, key=lambda name: (place.get(name, len(place)), name)))


def summaries() -> dict[str, Summary]:
    """Return what `atmosbox list` says of each scenario, by name; no scenario is imported.

    Examples
    --------
    >>> summaries()["lifting-dry"]
    Summary(sentence='A parcel of dry air rises and cools.', level='first year', minutes=15)
    """
    found = {}
    for name in names():
        spec = importlib.util.find_spec(f"{__name__}.{name.replace('-', '_')}")
        source = None
        if spec is not None and isinstance(spec.loader, InspectLoader):
            source = spec.loader.get_source(spec.name)
        tree = ast.parse(source or "")
        text = ast.get_docstring(tree) or ""
        said: dict[str, Any] = {
            ast.unparse(node.targets[0]): node.value.value
            for node in tree.body
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant)
        }
        sentence = text.partition("\n\n")[0].replace("\n", " ")
        found[name] = Summary(sentence, str(said.get("level", "")), said.get("minutes"))
    return found


def is_path(scene: str | os.PathLike[str]) -> bool:
    """Return whether a scenario is given by the path of its file rather than by its name."""
    text = os.fspath(scene)
    return isinstance(scene, os.PathLike) or text.endswith(".py") or "/" in text or os.sep in text


def load(name_or_path: str | os.PathLike[str]) -> ModuleType:
    """Load a scenario: one of atmosbox by its name, or your own by the path of its file.

    Parameters
    ----------
    name_or_path
        A name from `names`, such as ``"lifting-dry"`` (``"lifting_dry"`` is the same), or the path of a
        Python file: anything that ends in ``.py`` or contains a separator, such as ``"./my_scene.py"``. The
        file is run again at each call; like every Python program, it can run any code.

    Returns
    -------
    module
        The scenario, with its `REQUIRED` attributes ``Settings``, ``build``, ``theory``, ``headlines`` and
        ``panels``.

    Raises
    ------
    UnknownSceneError
        If no scenario has this name; the message offers the nearest names.
    FileError
        If the file is missing or unreadable, fails on import, or lacks a required attribute.

    Examples
    --------
    >>> scene = load("lifting-dry")
    >>> scene.__name__
    'atmosbox.scenarios.lifting_dry'
    """
    text = os.fspath(name_or_path)
    if is_path(name_or_path):
        return _load_file(Path(os.path.expanduser(text)))
    name = text.replace("_", "-")
    if name not in names():
        raise _unknown(text)
    return _complete(importlib.import_module(f"{__name__}.{name.replace('-', '_')}"))


def _complete(module: ModuleType) -> ModuleType:
    """Copy into a variant of another scenario the attributes that it does not define itself.

    A variant names the other scenario, ``variant_of = "temperature"``, and may give other default values of
    settings, ``defaults = {"molecules": 800}``.
    """
    base = getattr(module, "variant_of", None)
    if base is not None and not hasattr(module, "Settings"):
        other = load(base)
        settings = other.Settings.with_defaults(**getattr(module, "defaults", {}))
        for name in (*REQUIRED, *(["series"] if hasattr(other, "series") else [])):
            if not hasattr(module, name):
                setattr(module, name, settings if name == "Settings" else getattr(other, name))
    return module


def _unknown(text: str) -> UnknownSceneError:
    """Return the error for a name that no scenario has, with the nearest ones that exist."""
    near = difflib.get_close_matches(text.lower().replace("_", "-"), names(), n=3, cutoff=0.5)
    problem = f"There is no scene {shown(text)}"
    if os.path.isfile(f"{text}.py"):
        return UnknownSceneError(problem, f"to run your own file, give its path, ./{text}.py")
    if text.endswith(".nc"):
        return UnknownSceneError(
            problem, "to run the scene of a file again, type ", Command("run", (Option("from", text),))
        )
    meant = f"did you mean {' or '.join(near)}? " if near else ""
    return UnknownSceneError(problem, f"{meant}`", Command("list"), "` shows all")


def _load_file(path: Path) -> ModuleType:
    """Run a user's own file as a module and check that it is a scenario."""
    if os.path.isdir(path):
        raise FileError(f"{path} is a folder: give the path of the scene's .py file in it.")
    if not os.path.exists(path):
        raise FileError(
            f"There is no file {path}", "check its path, or take a scene that `", Command("list"), "` shows"
        )
    try:
        source = path.read_bytes()
    except OSError as error:
        raise FileError(f"{path} cannot be read ({error.strerror}): check its permissions.") from error

    # A unique name, so that a user's file cannot replace a module of Python or of another library; in
    # sys.modules, because dataclasses look a module up by its name.
    location = str(path.resolve())
    module = ModuleType(f"{_OWN}{zlib.crc32(os.fsencode(location)):08x}_{path.stem}")
    module.__file__ = location
    sys.modules[module.__name__] = module
    try:
        # Compiled from the source: bytecode in a cache beside the file may be older than the source.
        exec(compile(source, location, "exec", dont_inherit=True), module.__dict__)
    except (Exception, SystemExit) as error:
        del sys.modules[module.__name__]
        raise FileError(_why(path, location, error)) from error

    missing = [attribute for attribute in REQUIRED if not hasattr(_complete(module), attribute)]
    if missing:
        del sys.modules[module.__name__]
        raise FileError(
            f"{path} is not a scene, for it does not define {', '.join(missing)}: "
            "write them as the scenes of atmosbox do, such as scenarios/lifting_dry.py."
        )
    for name, declared in getattr(module, "variables", {}).items():
        if not (isinstance(declared, tuple) and len(declared) == 3 and all(isinstance(part, str) for part in declared)):
            raise FileError(
                f"{path} declares the variable {shown(name)} as {shown(declared)}: "
                'give dimensions, unit and words, such as ("elapsed_time", "m", "mean height").'
            )
    return module


def place(error: BaseException) -> str | None:
    """Return the line of a user's own scene in which an error arose, as "my_scene.py, line 30"; None if in none."""
    own = {module.__file__ for name, module in list(sys.modules.items()) if name.startswith(_OWN)}
    for frame in reversed(traceback.extract_tb(error.__traceback__)):
        if frame.filename in own:
            return f"{Path(frame.filename).name}, line {frame.lineno}"
    return None


def _why(path: Path, location: str, error: BaseException) -> str:
    """Return one sentence on why a user's file failed, with the line of that file."""
    if isinstance(error, SyntaxError) and error.filename == location:
        line, reason = error.lineno, error.msg
    else:
        frames = traceback.extract_tb(error.__traceback__)
        line = next((frame.lineno for frame in reversed(frames) if frame.filename == location), None)
        reason = " ".join(str(error).split())
    place = f"{path}, line {line}," if line else f"{path}"
    if isinstance(error, ModuleNotFoundError) and (error.name or "").startswith("atmosbox."):
        fix = "import what a scene needs from atmosbox.engine, atmosbox.scene and atmosbox.theory"
        return f"{place} imports {error.name}, which this version of atmosbox does not have: {fix}."
    what = f"{type(error).__name__}: {reason}" if reason else type(error).__name__
    return f"{place} cannot be run ({what}): correct it and run it again."

"""Make atmosbox/__init__.pyi, which tells an editor the settings of every scene: `python tools/stub.py`.

After ``atmosbox.run("lifting-dry", `` an editor then offers ``molecules=``, ``temperature=`` and the other settings,
each with its unit, its default and its description. All of this comes from the scenes; a test fails if the file differs
from what this program makes.
"""

import inspect
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from atmosbox import interface, scenarios  # noqa: E402
from atmosbox.scene.settings import Parameter  # noqa: E402

STUB = ROOT / "atmosbox" / "__init__.pyi"
HEAD = '''"""What an editor knows of `atmosbox`: made by tools/stub.py from the scenes, not to be edited by hand."""

import os
from typing import Any, Literal, overload

from atmosbox.interface import compare as compare
from atmosbox.interface import open as open
from atmosbox.interface import plot as plot
from atmosbox.interface import scenes as scenes
from atmosbox.interface import show as show
from atmosbox.interface import sweep as sweep
from atmosbox.interface.run_dataset import RunDataset, Show
from atmosbox.version import __version__ as __version__

__all__ = ["__version__", "compare", "open", "plot", "run", "scenes", "show", "sweep"]
'''


def annotation(parameter: Parameter) -> str:
    """Return the type annotation of a setting; a number may also be given as text with a unit."""
    if parameter.choices:
        return f"Literal[{', '.join(map(repr, parameter.choices))}]"
    return {"int": "int | str", "float": "float | str", "bool": "bool", "str": "str"}[parameter.kind]


def common() -> list[str]:
    """Return the arguments that `run` takes for every scene, from its signature."""
    kept = [p for p in inspect.signature(interface.run).parameters.values() if p.kind is p.KEYWORD_ONLY]
    return [f"{p.name}: {p.annotation} = {p.default!r}" for p in kept]


def overload(name: str) -> str:
    """Return the overload of `run` for one scene."""
    declared = scenarios.load(name).Settings.describe()
    taken = [f"{p.name}: {annotation(p)} = {p.default!r}" for p in declared]
    lines = [f"{p.name}{f' [{p.unit}]' if p.unit not in ('', '1') else ''}: {p.help}; {p.allowed}" for p in declared]
    told = "\n    ".join([scenarios.summaries()[name].sentence, "", *lines])
    listed = ",\n    ".join([f"scene: Literal[{name!r}]", "*", *common(), *taken])
    return f'@overload\ndef run(\n    {listed},\n) -> RunDataset:\n    r"""{told}\n    """'


def stub() -> str:
    """Return the content of the stub file."""
    general = ",\n    ".join(["scene: str | os.PathLike[str]", "*", *common(), "**settings: Any"])
    last = (
        f"@overload\ndef run(\n    {general},\n) -> RunDataset:\n"
        '    """Run a scene of your own, or any by its name; `atmosbox.scenes(scene)` shows its settings."""'
    )
    text = "\n".join([HEAD, *map(overload, scenarios.names()), last, ""])
    command = [sys.executable, "-m", "ruff", "format", "--stdin-filename", str(STUB), "-"]
    return subprocess.run(command, input=text, capture_output=True, encoding="utf-8", check=True, cwd=ROOT).stdout


if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")

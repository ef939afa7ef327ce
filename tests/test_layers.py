"""Who may import whom, read off the syntax tree of every file.

For the engine this is a matter of correct answers and not of taste: its compiled kernels are kept under a
digest of the engine's own sources, so a constant imported from elsewhere could change while old machine
code lives on.
"""

import ast
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Layer:
    """What the files of one layer may import beside the standard library and each other."""

    parts: str = ""  # parts of atmosbox; "version" is the number in atmosbox/__init__.py, "*" any part
    libraries: str = ""
    lazily: str = ""  # parts and libraries that only a function may import, or a type checker


FOUNDATION = "errors units conversion quantity spelling parameter settings config headline theory statistics"
FACTS = Layer(f"version {FOUNDATION}", "numpy scipy pydantic", lazily="metpy pint")

LAYERS = {
    "engine": Layer("", "numpy numba llvmlite"),
    **dict.fromkeys(FOUNDATION.split(), FACTS),
    "panels": Layer(),
    "target": Layer("errors"),
    "engines": Layer("errors parameter spelling", lazily="engine numpy xarray"),
    "accuracy": Layer("errors spelling"),
    "declaration": Layer("", "numpy"),
    "variables": Layer("declaration"),
    "diagnostics": Layer("version engine units errors panels statistics declaration variables", "numpy xarray"),
    "provenance": Layer("version errors", lazily="xarray"),
    "output": Layer("version engine units errors panels diagnostics provenance target", "numpy xarray netCDF4"),
    "checkpoint": Layer("version engine units errors panels diagnostics output target", "numpy xarray netCDF4"),
    "plot": Layer("version theory errors panels target", "numpy xarray matplotlib metpy"),
    "instruments": Layer("engine units statistics theory", "numpy"),
    "moisture": Layer("engine units theory", "numpy"),
    "knob": Layer("conversion", "numpy", lazily="engine settings units"),
    "piston": Layer("engine moisture units theory", "numpy", lazily="engines"),
    "exchange": Layer("engine headline moisture panels piston units theory", "numpy", lazily="xarray"),
    "rising": Layer(
        "engine engines errors headline instruments knob moisture panels piston scene statistics units theory",
        "numpy",
        lazily="xarray",
    ),
    "sounding": Layer("errors conversion units", "numpy", lazily="xarray metpy"),
    "scene": Layer("units", lazily="engine instruments knob"),
    "a scenario": Layer(
        "engine engines errors units theory statistics settings headline panels instruments knob moisture piston"
        " exchange rising scene sounding",
        "numpy",
        lazily="xarray",
    ),
    "scenarios": Layer("errors"),
    "preparation": Layer("version accuracy engine engines errors parameter settings scene scenarios"),
    "verification": Layer("accuracy engines errors headline", "numpy", lazily="xarray runner"),
    "recording": Layer(
        "diagnostics headline instruments preparation scene verification", "numpy", lazily="engine xarray"
    ),
    "runner": Layer(
        "engine errors headline panels preparation recording verification", lazily="xarray provenance output checkpoint"
    ),
    "extremes": Layer("engine engines errors theory statistics", "numpy"),
    "tradeoff": Layer("engines errors provenance runner scene scenarios", "numpy xarray"),
    "sheet": Layer(
        "version conversion errors headline parameter runner scenarios target", "numpy", lazily="reportlab matplotlib"
    ),
    "live": Layer(
        "version checkpoint engine engines errors instruments knob output page panels parameter preparation provenance"
        " quantity recording scene units variables",
        "numpy websockets",
        lazily="xarray",
    ),
    "page": Layer("errors panels variables units provenance target", "numpy", lazily="plot output scenarios xarray"),
    "film": Layer("errors panels plot units target", "numpy matplotlib PIL", lazily="xarray imageio_ffmpeg"),
    "compare": Layer("conversion errors parameter plot provenance quantity scenarios target", "numpy", lazily="xarray"),
    "sweep": Layer(
        "version checkpoint conversion declaration engines errors output parameter preparation provenance quantity"
        " runner scenarios target",
        "numpy xarray",
        lazily="distributed",
    ),
    "cli": Layer("*", "numpy typer rich", lazily="numba xarray netCDF4 matplotlib metpy pint"),
    "__main__": Layer("cli"),
    "version": Layer(lazily="runner xarray"),
}


DOORS = ("_jit", "window")
"""The files that may speak to the compiler: its one door, and what is written in single instructions."""


class Imports(ast.NodeVisitor):
    """Every import of a file, as (line, absolute name, whether it waits for a function call)."""

    def __init__(self, package):
        self.package = package.split(".")
        self.late = False
        self.found = []

    def note(self, node, name):
        self.found.append((node.lineno, name, self.late))

    def visit_Import(self, node):
        for alias in node.names:
            self.note(node, alias.name)

    def visit_ImportFrom(self, node):
        above = self.package[: len(self.package) + 1 - node.level] if node.level else []
        source = [*above, node.module] if node.module else above
        for alias in node.names:
            self.note(node, ".".join([*source, alias.name]))

    def visit_Call(self, node):
        if ast.unparse(node.func).split(".")[-1] in ("import_module", "__import__"):
            argument = node.args[0] if node.args else None
            self.note(node, argument.value if isinstance(argument, ast.Constant) else "a computed name")
        self.generic_visit(node)

    def visit_If(self, node):
        if ast.unparse(node.test).split(".")[-1] != "TYPE_CHECKING":
            self.generic_visit(node)
            return
        self.visit_late(node.body)
        for child in node.orelse:
            self.visit(child)

    def visit_FunctionDef(self, node):
        for child in [*node.decorator_list, node.args]:
            self.visit(child)
        self.visit_late(node.body)

    visit_AsyncFunctionDef = visit_FunctionDef

    def visit_late(self, body):
        before, self.late = self.late, True
        for child in body:
            self.visit(child)
        self.late = before


def layer_of(module):
    """Return the layer of a module of atmosbox, or of a name in it, given as its dotted parts."""
    part = module[1] if len(module) > 1 else "__init__"
    if part == "scenarios":
        name = module[2] if len(module) > 2 else "__init__"
        return "scenarios" if name in ("__init__", "names", "load", "REQUIRED") else "a scenario"
    return {"__init__": "version", "__version__": "version", "run": "runner"}.get(part, part)


def refusal(importer, name, late):
    """Return why a module may not import this name, or None if it may."""
    home, target = layer_of(importer), name.split(".")
    layer = LAYERS[home]
    if name == "a computed name":
        return None if home == "scenarios" else "only the door to the scenarios may"
    if target[0] == "atmosbox":
        thing, allowed = layer_of(target), layer.parts.split()
        if thing == "cli" and home not in ("cli", "__main__"):
            return "nobody imports cli"
        if thing == home == "a scenario":
            return "scenarios never import each other"
        if thing == home:
            return None
    elif target[0] in sys.stdlib_module_names:
        return None
    else:
        thing, allowed = target[0], layer.libraries.split()
        if home == "engine" and thing in ("numba", "llvmlite") and importer[-1] not in DOORS:
            return "engine/_jit.py is the one door to numba"
    if thing in layer.lazily.split():
        return None if late else "only inside a function"
    if thing in allowed or (target[0] == "atmosbox" and "*" in allowed):
        return None
    return f"not allowed to {home}"


def violations(root):
    """Return one line for every import below a checkout that the layers forbid."""
    lines = []
    for path in sorted([*root.glob("atmosbox/**/*.py"), *root.glob("scenarios/**/*.py")]):
        place = path.relative_to(root)
        parts = place.with_suffix("").parts
        module = parts if parts[0] == "atmosbox" else ("atmosbox", *parts)
        if layer_of(module) not in LAYERS:
            lines.append(f"{place.as_posix()}: belongs to no layer, give it one in LAYERS")
            continue
        imports = Imports(".".join(module[:-1]))
        imports.visit(ast.parse(path.read_text(encoding="utf-8"), filename=str(path)))
        for line, name, late in imports.found:
            if why := refusal(module, name, late):
                lines.append(f"{place.as_posix()}:{line}: {name}: {why}")
    return lines


def test_every_import_keeps_to_the_layers():
    assert violations(ROOT) == []


def test_every_layer_of_the_table_has_a_file():
    modules = [path.relative_to(ROOT).with_suffix("").parts for path in ROOT.glob("atmosbox/**/*.py")]
    assert set(LAYERS) - {layer_of(module) for module in modules} == {"a scenario"}
    assert list(ROOT.glob("scenarios/*.py"))


@pytest.mark.parametrize(
    ("place", "source"),
    [
        ("atmosbox/engine/contact.py", "import scipy"),
        ("atmosbox/engine/contact.py", "import xarray as xr"),
        ("atmosbox/engine/contact.py", "import numba"),
        ("atmosbox/engine/contact.py", "from atmosbox import units"),
        ("atmosbox/engine/contact.py", "from atmosbox.units import BOLTZMANN"),
        ("atmosbox/engine/contact.py", "from .. import units"),
        ("atmosbox/engine/contact.py", "from ..units import BOLTZMANN"),
        ("atmosbox/engine/contact.py", "import atmosbox"),
        ("atmosbox/engine/contact.py", "from atmosbox import __version__"),
        ("atmosbox/engine/contact.py", "def f():\n    from atmosbox.units import BOLTZMANN"),
        ("atmosbox/engine/contact.py", "class A:\n    def f(self):\n        import atmosbox.units"),
        ("atmosbox/engine/contact.py", "try:\n    import scipy\nexcept ImportError:\n    pass"),
        ("atmosbox/engine/contact.py", "if TYPE_CHECKING:\n    from atmosbox.units import Scale"),
        ("atmosbox/engine/contact.py", "import importlib\nimportlib.import_module('atmosbox.units')"),
        ("atmosbox/engine/contact.py", "import importlib\nimportlib.import_module('atmosbox.' + 'units')"),
        ("atmosbox/engine/contact.py", "__import__('scipy')"),
        ("atmosbox/engine/deep/file.py", "from ...units import BOLTZMANN"),
        ("atmosbox/theory.py", "import metpy.calc"),
        ("atmosbox/theory.py", "from metpy.calc import lcl"),
        ("atmosbox/theory.py", "from . import engine"),
        ("atmosbox/panels/line.py", "import numpy"),
        ("atmosbox/conversion.py", "import pint"),
        ("atmosbox/declaration.py", "from atmosbox.variables import VARIABLES"),
        ("atmosbox/variables.py", "from atmosbox.diagnostics import dataset"),
        ("atmosbox/diagnostics.py", "from atmosbox.output import write"),
        ("atmosbox/provenance.py", "import xarray"),
        ("atmosbox/provenance.py", "from atmosbox.output import read"),
        ("atmosbox/output.py", "from atmosbox.checkpoint import Checkpoint"),
        ("atmosbox/plot.py", "from atmosbox.engine import state"),
        ("atmosbox/plot/skewt.py", "from atmosbox.engine import state"),
        ("atmosbox/preparation.py", "from atmosbox.scenarios import lifting_dry"),
        ("atmosbox/runner.py", "def f():\n    from atmosbox import cli"),
        ("atmosbox/scenarios/__init__.py", "from . import lifting_dry"),
        ("atmosbox/cli.py", "import xarray"),
        ("atmosbox/__init__.py", "from atmosbox import runner"),
        ("atmosbox/__init__.py", "import numpy"),
        ("atmosbox/utils.py", "import math"),
        ("scenarios/moist.py", "from atmosbox.scenarios.lifting_dry import build"),
        ("scenarios/moist.py", "from . import lifting_dry"),
        ("scenarios/moist.py", "import scenarios.lifting_dry"),
        ("scenarios/moist.py", "import lifting_dry"),
        ("scenarios/moist.py", "from atmosbox.scenarios import load"),
        ("scenarios/moist.py", "from atmosbox import run"),
        ("scenarios/moist.py", "import xarray"),
    ],
)
def test_a_planted_violation_is_found(tmp_path, place, source):
    path = tmp_path / place
    path.parent.mkdir(parents=True)
    path.write_text(source, encoding="utf-8")
    assert len(violations(tmp_path)) == 1


@pytest.mark.parametrize(
    ("place", "source"),
    [
        ("atmosbox/engine/_jit.py", "import numba\nfrom numba.core import config\nimport llvmlite.ir"),
        (
            "atmosbox/engine/exact.py",
            "import math\nimport numpy as np\nfrom . import contact\nfrom .state import A",
        ),
        ("atmosbox/theory.py", "def f():\n    import metpy.calc\n    from pint import Unit"),
        ("atmosbox/output.py", "from atmosbox import __version__, units\nfrom .diagnostics import VARIABLES"),
        (
            "atmosbox/plot/skewt.py",
            "from .line import draw\nfrom atmosbox.plot import theme\nimport metpy.plots",
        ),
        ("atmosbox/preparation.py", "from atmosbox import scenarios\nfrom atmosbox.scenarios import load"),
        ("atmosbox/cli.py", "import typer\nfrom atmosbox import runner\ndef f():\n    import xarray"),
        ("atmosbox/__main__.py", "from atmosbox.cli import main"),
        (
            "atmosbox/__init__.py",
            "if TYPE_CHECKING:\n    import xarray\ndef run():\n    from . import runner",
        ),
        (
            "scenarios/moist.py",
            "import numpy\nfrom atmosbox import theory, units\nfrom atmosbox.engine.walls import W",
        ),
    ],
)
def test_a_lawful_import_is_let_through(tmp_path, place, source):
    path = tmp_path / place
    path.parent.mkdir(parents=True)
    path.write_text(source, encoding="utf-8")
    assert violations(tmp_path) == []

"""Which modules may import which, checked with the syntax tree of every file.

For the engine this is a matter of correct results and not of taste: its compiled kernels are kept under a
digest of the engine's own sources, so a constant imported from elsewhere could change while old machine
code lives on.
"""

import ast
import functools
import re
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Layer:
    """What the files of one layer may import besides the standard library and each other."""

    parts: str = ""  # packages of atmosbox; "version" is atmosbox/version.py and atmosbox itself, "*" any package
    libraries: str = ""
    lazily: str = ""  # parts and libraries that only a function may import, or a type checker


LAYERS = {
    "engine": Layer("", "numpy numba llvmlite"),
    "errors": Layer(),
    "theory": Layer("", "numpy scipy", lazily="metpy"),
    "file": Layer("version errors", "numpy xarray netCDF4"),
    "scenarios": Layer("errors"),
    "scene": Layer("engine errors theory", "numpy scipy", lazily="metpy pint xarray file"),
    "a scenario": Layer("engine errors theory scene", "numpy", lazily="xarray"),
    "simulation": Layer("version engine errors scenarios scene", "numpy", lazily="xarray file"),
    "plot": Layer("callable_room errors theory file scene scenarios", "numpy xarray matplotlib metpy"),
    "page": Layer("errors theory file scene", "numpy", lazily="plot scenarios xarray"),
    "film": Layer("errors theory file scene plot", "numpy matplotlib PIL", lazily="xarray imageio_ffmpeg"),
    "sheet": Layer(
        "version errors file scenarios scene simulation",
        "numpy jinja2 markdown_it reportlab uncertainties",
        lazily="matplotlib",
    ),
    "sweep": Layer(
        "version callable_room errors file scenarios scene simulation", "numpy xarray", lazily="distributed"
    ),
    "trade": Layer("version engine errors theory file scenarios scene simulation", "numpy xarray"),
    "lab": Layer("version engine errors theory file scene simulation page", "numpy", lazily="xarray"),
    "text": Layer("errors scene", "rich", lazily="simulation plot"),
    "callable_room": Layer(),
    "interface": Layer(
        "errors", "numpy xarray", lazily="scenarios scene simulation file plot page sweep text matplotlib IPython"
    ),
    "cli": Layer("*", "numpy typer rich", lazily="numba xarray netCDF4 matplotlib metpy pint"),
    "__main__": Layer("cli"),
    "version": Layer("callable_room", lazily="interface plot sweep"),
}
"""One row for each package; ``a scenario`` is a file of the top-level folder ``scenarios/``."""

DOORS = ("compiler",)
"""The file of the engine that may use numba."""


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
        return "scenarios" if name in ("__init__", "names", "summaries", "load", "REQUIRED") else "a scenario"
    return {"__init__": "version", "__version__": "version"}.get(part, part)


def refusal(importer, name, late):
    """Return why a module may not import this name, or None if it may."""
    home, target = layer_of(importer), name.split(".")
    layer = LAYERS[home]
    if name == "a computed name":
        lazy = importer[-1] == "__init__" and home in ("scenarios", "engine", "scene", "cli")
        return None if lazy else "only the __init__ of a folder that imports its own files may"
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
            return f"only {DOORS[0]} calls numba"
    if thing in layer.lazily.split():
        return None if late else "only inside a function"
    if thing in allowed or (target[0] == "atmosbox" and "*" in allowed):
        return None
    return f"not allowed to {home}"


@functools.cache
def imports(root):
    """Return the imports of every file in a checkout, by its path."""
    found = {}
    for path in sorted([*root.glob("atmosbox/**/*.py"), *root.glob("scenarios/**/*.py")]):
        place = path.relative_to(root)
        parts = place.with_suffix("").parts
        module = parts if parts[0] == "atmosbox" else ("atmosbox", *parts)
        visitor = Imports(".".join(module[:-1]))
        visitor.visit(ast.parse(path.read_text(encoding="utf-8"), filename=str(path)))
        found[place.as_posix()] = module, visitor.found
    return found


def violations(root):
    """Return one line for every import in a checkout that the layers forbid."""
    lines = []
    for place, (module, found) in imports(root).items():
        if layer_of(module) not in LAYERS:
            lines.append(f"{place}: belongs to no layer, give it one in LAYERS")
            continue
        for line, name, late in found:
            if why := refusal(module, name, late):
                lines.append(f"{place}:{line}: {name}: {why}")
    return lines


def test_every_import_keeps_to_the_layers():
    assert violations(ROOT) == []


def test_every_library_the_package_imports_is_a_dependency():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    declared = {re.match(r"[\w-]+", line).group().lower() for line in project["dependencies"]}
    imported = {name.split(".")[0] for _, found in imports(ROOT).values() for _, name, _ in found}
    used = {name.lower() for name in imported - sys.stdlib_module_names - {"atmosbox", "a computed name"}}
    used = {{"markdown_it": "markdown-it-py"}.get(name, name).replace("_", "-") for name in used}
    carried = {"rich", "pil", "ipython"}  # by numba, typer and matplotlib, and by a notebook
    extras = {
        re.match(r"[\w-]+", line).group().lower()
        for extra in ("movie", "cluster")
        for line in project["optional-dependencies"][extra]
    }
    assert used - carried == declared | extras
    assert declared.isdisjoint(extras)


FORBIDDEN = [
    ("atmosbox/engine/core/pair.py", "import scipy"),
    ("atmosbox/engine/core/pair.py", "import numba"),
    ("atmosbox/engine/core/pair.py", "from ...theory.constants import BOLTZMANN"),
    ("atmosbox/engine/core/pair.py", "class A:\n    def f(self):\n        import atmosbox.theory"),
    ("atmosbox/engine/core/pair.py", "import importlib\nimportlib.import_module('atmosbox.' + 'theory')"),
    ("atmosbox/theory/noise.py", "import metpy.calc"),
    ("atmosbox/simulation/runner.py", "def f():\n    from atmosbox import cli"),
    ("atmosbox/__init__.py", "import numpy"),
    ("atmosbox/utils.py", "import math"),
    ("scenarios/moist.py", "from . import lifting_dry"),
]


def planted(root, place, source):
    """Return the violations of a checkout that holds one file."""
    path = root / place
    path.parent.mkdir(parents=True)
    path.write_text(source, encoding="utf-8")
    return violations(root)


def test_a_planted_violation_is_found(tmp_path):
    for number, (place, source) in enumerate(FORBIDDEN):
        assert len(planted(tmp_path / str(number), place, source)) == 1, (place, source)


def test_no_kernel_takes_more_than_eight_arguments():
    kernels = {
        f"{path.stem}.{node.name}": len(node.args.args)
        for path in ROOT.glob("atmosbox/engine/**/*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.FunctionDef) and any("kernel" in ast.unparse(each) for each in node.decorator_list)
    }
    assert "pair.soonest_image" in kernels
    assert {name: number for name, number in kernels.items() if number > 8} == {}


def test_rooms_stand_on_floors():
    """The imports between packages have no cycle, so the packages can be put in an order."""
    standing = {name: set(f"{row.parts} {row.lazily}".split()) & set(LAYERS) for name, row in LAYERS.items()}
    standing["version"] -= {"interface", "plot", "sweep"}  # `atmosbox.run` imports them when it is used
    standing.pop("cli")
    standing.pop("__main__")
    while standing:
        ground = {name for name, below in standing.items() if not below & set(standing)}
        assert ground, f"these rooms import each other in a circle: {sorted(standing)}"
        for name in ground:
            del standing[name]


PUBLIC = {"_replace", "_asdict", "_fields", "_make", "_exit", "_get_tick", "_repr_png_"}
"""Of named tuples, of Python, of matplotlib and of IPython."""


def trespasses(root):
    """Return one line for every private attribute that is used outside its class and its file."""
    lines = []
    for path in sorted([*root.glob("atmosbox/**/*.py"), *root.glob("scenarios/**/*.py")]):
        place, tree = path.relative_to(root), ast.parse(path.read_text(encoding="utf-8"))
        if place.parts[:2] == ("atmosbox", "engine"):
            continue
        used = [node for node in ast.walk(tree) if isinstance(node, ast.Attribute) and node.attr.startswith("_")]
        own = {node.attr for node in used if getattr(node.value, "id", "") in ("self", "cls")}
        own |= {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
        lines += [
            f"{place.as_posix()}:{node.lineno}: {ast.unparse(node)}"
            for node in used
            if node.attr not in PUBLIC | own and not node.attr.endswith("__")
        ]
    return lines


def test_outside_the_engine_no_private_attribute_of_another_file_is_used():
    assert trespasses(ROOT) == []

"""Which modules may import which, checked with the syntax tree of every file.

For the engine this is a matter of correct results and not of taste: its compiled kernels are kept under a
digest of the engine's own sources, so a constant imported from elsewhere could change while old machine
code lives on.
"""

import ast
import functools
import sys
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
        "version errors file scenarios scene simulation page",
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


def imports_of(node, package, late=False):
    """Yield every import below a node as (line, absolute name, whether it waits for a function call)."""
    if isinstance(node, ast.Import):
        yield from ((node.lineno, alias.name, late) for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        above = package[: len(package) + 1 - node.level] if node.level else []
        source = [*above, node.module] if node.module else above
        yield from ((node.lineno, ".".join([*source, alias.name]), late) for alias in node.names)
    elif isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] in ("import_module", "__import__"):
        plain = node.args and isinstance(node.args[0], ast.Constant)
        yield node.lineno, node.args[0].value if plain else "a computed name", late
    waits = isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
    waits |= isinstance(node, ast.If) and ast.unparse(node.test).endswith("TYPE_CHECKING")
    for child in ast.iter_child_nodes(node):
        yield from imports_of(child, package, late or (waits and child in node.body))


@functools.cache
def imports(root):
    """Return the imports of every file in a checkout, by its path."""
    found = {}
    for path in sorted([*root.glob("atmosbox/**/*.py"), *root.glob("scenarios/**/*.py")]):
        place = path.relative_to(root)
        parts = place.with_suffix("").parts
        module = parts if parts[0] == "atmosbox" else ("atmosbox", *parts)
        tree = ast.parse(path.read_text(encoding="utf-8"), filename=str(path))
        found[place.as_posix()] = module, list(imports_of(tree, list(module[:-1])))
    return found


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


def test_folders_do_not_import_each_other_in_a_circle():
    below = {name: set(f"{row.parts} {row.lazily}".split()) & set(LAYERS) for name, row in LAYERS.items()}
    below["version"] -= {"interface", "plot", "sweep"}  # `atmosbox.run` imports them when it is used
    order = []
    while ready := [name for name in below if name not in order and below[name] <= {*order, name}]:
        order += ready
    assert set(LAYERS) - set(order) <= {"cli", "__main__"}


def test_files_do_not_import_each_other_in_a_circle():
    files = {".".join(path.relative_to(ROOT).with_suffix("").parts): path for path in ROOT.glob("atmosbox/**/*.py")}
    below = {}
    for name, path in files.items():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        blocks = [tree, *(node for node in tree.body if isinstance(node, ast.If))]  # with those for types alone
        told = [node for block in blocks for node in block.body if isinstance(node, ast.ImportFrom)]
        below[name] = {f"{node.module}.{each.name}" for node in told for each in node.names} & set(files)
        below[name] |= {node.module for node in told} & set(files)
    while ready := {name for name in below if not below[name] & set(below)}:
        below = {name: below[name] for name in set(below) - ready}
    assert sorted(below) == []


PUBLIC = {"_replace", "_asdict", "_fields", "_make", "_exit", "_get_tick", "_repr_png_"}
"""Of named tuples, of Python, of matplotlib and of IPython."""


def test_outside_the_engine_no_private_attribute_of_another_file_is_used():
    for path in sorted([*ROOT.glob("atmosbox/**/*.py"), *ROOT.glob("scenarios/**/*.py")]):
        if path.relative_to(ROOT).parts[:2] != ("atmosbox", "engine"):
            nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
            used = [node for node in nodes if isinstance(node, ast.Attribute) and node.attr.startswith("_")]
            own = {node.attr for node in used if getattr(node.value, "id", "") in ("self", "cls")}
            own |= {node.name for node in nodes if isinstance(node, ast.FunctionDef)}
            found = {node.attr for node in used if not node.attr.endswith("__")} - own - PUBLIC
            assert found == set(), path

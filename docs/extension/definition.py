"""Where the names of atmosbox are defined: read off the sources, so that nothing is imported for it."""

import ast
import functools
import importlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parents[2]


class Place(NamedTuple):
    """A file and a line in it; the line is 0 for the file itself."""

    path: Path
    line: int


def sources() -> list[Path]:
    """Return the Python files of atmosbox and of its scenes."""
    return sorted([*ROOT.glob("atmosbox/**/*.py"), *ROOT.glob("scenarios/*.py")])


def module_name(path: Path) -> str:
    """Return the name under which a file is imported."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    parts = ("atmosbox", *parts) if parts[0] == "scenarios" else parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def defined(body: list[ast.stmt], prefix: str = "") -> Iterator[tuple[str, int]]:
    """Return the names that a module or a class defines, and the line of each."""
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            yield f"{prefix}{node.name}", min([node.lineno, *(each.lineno for each in node.decorator_list)])
            if isinstance(node, ast.ClassDef):
                yield from defined(node.body, f"{prefix}{node.name}.")
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from ((f"{prefix}{each.id}", node.lineno) for each in targets if isinstance(each, ast.Name))


@functools.cache
def places() -> dict[str, Place]:
    """Return where everything is defined, by its full name, and by its own name where only one thing has it."""
    full: dict[str, Place] = {}
    short: dict[str, list[Place]] = {}
    for path in sources():
        module = module_name(path)
        full[module] = Place(path, 0)
        for name, line in defined(ast.parse(path.read_text(encoding="utf-8")).body):
            full[f"{module}.{name}"] = Place(path, line)
            if not module.startswith("atmosbox.cli"):  # which nothing else imports
                short.setdefault(name, []).append(Place(path, line))
    return {name: found[0] for name, found in short.items() if len(found) == 1} | full


def place(name: str) -> Place | None:
    """Return where a name is defined that a docstring or an annotation mentions."""
    return places().get(name) or places().get(name.rpartition(".")[2])


def place_of_member(module: str, fullname: str) -> Place | None:
    """Return where a member of a module is defined, also if the module has it from another."""
    thing: Any = importlib.import_module(module)
    for part in fullname.split("."):
        thing = getattr(thing, part, None)
    home, name = getattr(thing, "__module__", None) or module, getattr(thing, "__qualname__", None) or fullname
    return places().get(f"{home}.{name}") or place(f"{module}.{fullname}")

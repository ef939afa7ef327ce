"""Which numbers are older than the code that made them: a digest of the sources that a job depends on.

A digest covers what the code does, wherever it stands: each statement at the top level of a file is one member of a
set, without comments, docstrings, imports, and the words of refusals. A function may move to another file, a file may
be split, and no number becomes stale; but if a constant changes, all numbers do that depend on it.

A job depends on all rooms of the physics (`PHYSICS`), on each other room that its file imports or that it is named
after, on the scenarios that it names (on all of them if it names none), and on itself with the functions that stand
beside it. Parts of the physics that only some runs meet count for those alone (`MET_BY`). Jobs that take a second or
two need no digest: the tests make their numbers again each time.
"""

import ast
import functools
import hashlib
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
PHYSICS = ("engine", "theory", "scene", "simulation")
MET_BY: dict[str, tuple[str, ...]] = {
    "scene/ascent": ("lifting-dry", "lifting-moist", "lifting-sounding", "mountains"),
    "scene/knob.py": ("lab",),
    "scene/sounding": ("lifting-sounding",),
    "simulation/accuracy.py": (),
    "simulation/accuracy.json": (),
    "simulation/restart.py": (),
}
"""Of which scenarios or rooms a job must name or import one, so that a part of the physics changes its numbers: knobs
are turned by hand, a run that goes on from a saved state ends in the same bits as one that was never stopped, and the
measured trade chooses only for those who ask for an accuracy."""
LAYOUT = ("registry", "drawing")
"""Files of jobs that only lay out what the others find."""


class _Bare(ast.NodeTransformer):
    """Take away what does nothing."""

    def visit_Import(self, node: ast.Import) -> None:
        """Leave out where a name comes from: that is where a file stands."""

    def visit_ImportFrom(self, node: ast.ImportFrom) -> None:
        """Leave out where a name comes from: that is where a file stands."""

    def visit_Expr(self, node: ast.Expr) -> ast.AST | None:
        """Leave out docstrings, and texts that describe a constant."""
        return None if _is_text(node) else self.generic_visit(node)

    def visit_Raise(self, node: ast.Raise) -> ast.AST:
        """Keep what is raised, without its words."""
        if isinstance(node.exc, ast.Call):
            node.exc = node.exc.func
        return node

    def visit_If(self, node: ast.If) -> ast.AST | None:
        """Leave out what only a type checker reads."""
        return None if ast.unparse(node.test).endswith("TYPE_CHECKING") else self.generic_visit(node)


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def _told(node: Any) -> str:
    """Return a syntax tree as text that is the same in all versions of Python (`ast.dump` is not)."""
    if isinstance(node, list):
        return f"[{','.join(map(_told, node))}]"
    if not isinstance(node, ast.AST):
        return repr(node)
    held = ((name, value) for name, value in ast.iter_fields(node) if value is not None and value != [])
    return f"{type(node).__name__}({','.join(f'{name}={_told(value)}' for name, value in held)})"


def _entered(node: ast.stmt) -> str | None:
    """Return the name of the job that a function is, None for any other statement."""
    for each in getattr(node, "decorator_list", ()):
        if isinstance(each, ast.Call) and ast.unparse(each.func) == "job":
            return str(ast.literal_eval(each.args[0]))
    return None


@functools.cache
def statements(source: str, job: str | None = None) -> frozenset[str]:
    r"""Return digests of what a file does, statement by statement; of its jobs only one, if any.

    Examples
    --------
    >>> one = statements("import a\nk = 2  # so many\ndef f(x):\n    'Double.'\n    return a.b(k * x)")
    >>> one == statements("from c import a\ndef f(x): return a.b(k * x)\nk = 2"), len(one)
    (True, 2)
    """
    body = [node for node in ast.parse(source).body if _entered(node) in (None, job) and not _is_list_of_names(node)]
    return frozenset(_digest([_told(bare)]) for bare in map(_Bare().visit, body) if bare is not None)


def _is_list_of_names(node: ast.stmt) -> bool:
    return isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"


def _digest(texts: Iterable[str]) -> str:
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


@functools.cache
def room(folder: Path, without: frozenset[Path] = frozenset()) -> frozenset[str]:
    """Return digests of all that a folder, or a single module, does, with the tables that it reads."""
    files = sorted(folder.rglob("*")) if folder.is_dir() else [folder.with_suffix(".py")]
    found: set[str] = set()
    for file in files:
        if not without.isdisjoint((file, *file.parents)):
            continue
        if file.suffix == ".py":
            found |= statements(file.read_text(encoding="utf-8"))
        elif file.suffix in (".json", ".toml", ".csv"):
            found.add(_digest([file.read_text(encoding="utf-8")]))
    return frozenset(found)


@functools.cache
def _imports(source: str) -> frozenset[str]:
    """Return all modules that a file names in an import."""
    found = set()
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            found |= {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}
    return frozenset(found)


@functools.cache
def _words(source: str) -> frozenset[str]:
    """Return all words in the texts of a file."""
    texts = [n.value for n in ast.walk(ast.parse(source)) if isinstance(n, ast.Constant) and isinstance(n.value, str)]
    return frozenset(re.findall(r"[\w-]+", " ".join(texts)))


def scenarios_named(name: str, sources: Iterable[str], known: Iterable[str]) -> list[str]:
    """Return the scenarios that a job names, in its own name or in a text of its files; all if there is none.

    Examples
    --------
    >>> known = ["temperature", "temperature-large", "lifting-dry"]
    >>> scenarios_named("scene-temperature-large", [], known), scenarios_named("gas", ["'temperature'"], known)
    (['temperature-large'], ['temperature'])
    """
    known = list(known)
    own = [each for each in known if name == each or name.endswith(f"-{each}")]
    words = frozenset().union(*map(_words, sources))
    return own or [each for each in known if each in words] or known


def digest(name: str, file: Path, root: Path = ROOT) -> str:
    """Return the digest of the sources on which a job of a file depends."""
    jobs, package = file.parent, root / "atmosbox"
    members: set[str] = set()
    waiting, seen, imported = [file.stem], {*LAYOUT}, set()
    texts = []
    while waiting:
        each = waiting.pop()
        if each in seen:
            continue
        seen.add(each)
        source = (jobs / f"{each}.py").read_text(encoding="utf-8")
        texts.append(source)
        members |= statements(source, name)
        found = _imports(source)
        waiting += [module.split(".")[1] for module in found if module.startswith("jobs.")]
        tables = [root / f"{module.replace('.', '/')}.py" for module in found if module.startswith("tests.")]
        members |= {each for table in tables if table.is_file() for each in statements(table.read_text("utf-8"))}
        imported |= {module for module in found if module.startswith("atmosbox.")}
    standing = {path.stem for path in package.iterdir() if path.is_dir() or path.suffix == ".py"}
    rooms = {name, *(module.split(".")[1] for module in imported)} & standing - {"scenarios", "__init__"}
    scenes = {path.stem.replace("_", "-"): path for path in (root / "scenarios").glob("[!_]*.py")}
    named = scenarios_named(name, texts, sorted(scenes))
    for scene in named:
        members |= room(scenes[scene])
    without = frozenset(package / part for part, by in MET_BY.items() if rooms.union(named).isdisjoint(by))
    for each in {*PHYSICS, *rooms}:
        members |= room(package / each, without)
    return _digest(sorted(members))

"""How kernels are compiled: when they are first called, and not before; and where their machine code is kept.

What asks for a scene's facts, or for one of its schedules, does not wait for numba: `compiler`, the file that
loads it, is imported when the first kernel is called.

numba's own disk cache watches only the file that holds a function: edit a function that a cached kernel
calls *in another file*, or a constant imported from one, and the old machine code is served. Here the
cache is kept under a digest of all the engine's code, so that any edit of it, or a newly installed version,
starts a fresh one, and an edited comment does not. That is right only because the engine imports nothing of
atmosbox from outside its folder, which a test enforces.
"""

import ast
import contextlib
import functools
import hashlib
import os
import stat
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

__all__ = [
    "COMPILED",
    "POSITIVE",
    "Kernel",
    "announce",
    "cache_folder",
    "compilations",
    "kernel",
    "lowest_bit",
    "prefetch",
    "use_threads",
]

POSITIVE = (1 << 40) - 1
"""``index & POSITIVE`` tells the compiler that an index is not negative: that saves Python's counting from the end."""

COMPILED = not int(os.environ.get("NUMBA_DISABLE_JIT") or 0)
"""Whether kernels are compiled (they are not under ``NUMBA_DISABLE_JIT=1``, which the coverage run uses)."""


def _code_of(source: str) -> str:
    """Return what a source says to the compiler: its syntax tree without docstrings, comments and line numbers."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        if isinstance(body, list):
            # a text that stands alone is a docstring, or the description of a constant
            node.body = [part for part in body if not _is_text(part)]  # type: ignore[attr-defined]
    return ast.dump(tree)


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)


def source_digest(folder: Path | None = None, memory: Path | None = None) -> str:
    """Return a short digest of the code in the engine's folders, of numba and of Python.

    Only code counts: an edited docstring or comment leaves the digest as it is.

    Parameters
    ----------
    folder
        The folder of the sources, by default the engine's.
    memory
        A folder that remembers the digests of sources seen before: to parse them all takes a tenth of a second.
    """
    from importlib.metadata import version as version_of

    folder = folder or Path(__file__).parents[1]
    sources = {file.relative_to(folder).as_posix(): file.read_bytes() for file in sorted(folder.rglob("*.py"))}
    version = f"{version_of('numba')} {sys.version}"
    written = _digest([version, *(f"{name} {hashlib.sha256(text).hexdigest()}" for name, text in sources.items())])
    known = memory / f"{written}.digest" if memory else None
    if known and known.is_file():
        return known.read_text(encoding="ascii")
    digest = _digest([version, *(f"{name} {_code_of(text.decode())}" for name, text in sources.items())])
    if known:
        new = known.with_suffix(f".{os.getpid()}")
        new.write_text(digest, encoding="ascii")
        new.replace(known)
    return digest


def _digest(lines: list[str]) -> str:
    return hashlib.sha256("\n".join(lines).encode()).hexdigest()[:16]


def _homes_of_caches() -> list[Path]:
    """Return the folders to try, best first."""
    asked = os.environ.get("NUMBA_CACHE_DIR")
    if asked:
        return [Path(asked)]
    if sys.platform == "win32":
        home = Path(os.environ.get("LOCALAPPDATA", tempfile.gettempdir()))
    elif sys.platform == "darwin":
        home = Path("~/Library/Caches").expanduser()
    else:
        home = Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser()
    owner = str(os.getuid()) if hasattr(os, "getuid") else os.environ.get("USERNAME", "cache")
    return [home / "atmosbox", Path(tempfile.gettempdir()) / f"atmosbox-{owner}"]


def _is_ours(folder: Path) -> bool:
    """Tell whether no other user can put a file into a folder: what is kept there is loaded and run."""
    if not hasattr(os, "getuid"):
        return True
    about = folder.lstat()
    return stat.S_ISDIR(about.st_mode) and about.st_uid == os.getuid() and not about.st_mode & 0o022


def cache_folder() -> Path | None:
    """Return the folder of this engine's machine code, made if need be, or None where nothing can be kept.

    ``NUMBA_CACHE_DIR`` is respected; a read-only home falls back to a folder of the user's own among the temporary
    files. A folder that belongs to somebody else, or that others may write to, is not used: what is kept is run.
    """
    for home in _homes_of_caches():
        try:
            home.mkdir(mode=0o700, parents=True, exist_ok=True)
            if not _is_ours(home):
                continue
            folder = home / source_digest(memory=home)
            folder.mkdir(exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                pass
        except OSError:
            continue
        return folder
    return None


_WATCHES: list[Callable[[str, bool], None]] = []


@contextlib.contextmanager
def compilations(watch: Callable[[str, bool], None]) -> Iterator[None]:
    """Be told of every kernel that is really compiled while a block runs, and not found among what is kept.

    Parameters
    ----------
    watch
        Called with the name of the kernel and True when its compilation begins, and with False when it has ended.
    """
    _WATCHES.append(watch)
    try:
        yield
    finally:
        _WATCHES.remove(watch)


def announce(name: str, begins: bool) -> None:
    """Tell all who wait for it that the compilation of a kernel begins, or has ended."""
    for watch in tuple(_WATCHES):
        watch(name, begins)


class Kernel:
    """A function of the engine that is compiled when it is first called, by Python or by the code of another one.

    Whatever else is asked of it (``stats``, ``signatures``) is answered by what numba made of it.

    Parameters
    ----------
    function
        The function as it is written.
    compile
        Makes what runs.
    """

    def __init__(self, function: Callable[..., Any], compile: Callable[[], Any]) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        self._compile = compile

    @functools.cached_property
    def compiled(self) -> Any:
        """What runs."""
        return self._compile()

    @property
    def _numba_type_(self) -> Any:
        """What numba sees where the code of another kernel names this one."""
        from atmosbox.engine.core import compiler

        return compiler.type_of(self.compiled)

    def __call__(self, *arguments: Any) -> Any:
        """Run it."""
        return self.compiled(*arguments)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # what copies or pickles objects asks for what nobody has
            raise AttributeError(name)
        return getattr(self.compiled, name)


def kernel(
    function: Callable[..., Any] | None = None,
    *,
    entry: bool = False,
    early: bool = False,
    allocates: bool = False,
    parallel: bool = False,
) -> Any:
    """Compile a function of the engine.

    Parameters
    ----------
    function
        Numbers, arrays and NamedTuples of them come in; no strings, no exceptions, no allocation in loops.
    entry
        True for what Python calls: it keeps its machine code on disk. False for a law that other kernels call: it is
        always inlined into them, so that flags passed as constants cost nothing.
    early
        Whether it is written into its callers before they are compiled, as if it stood there: for the few lines of the
        innermost loop. It must have a single return (measured: with two, the loop takes 1.7 times as long).
    allocates
        Whether the function makes arrays. One that does not is compiled without numba's counting of references,
        which would cost a quarter of the time of an event.
    parallel
        Whether its `prange` loops share the work among threads. The cache tells two versions of one function apart by
        what they close over, not by this: give the serial and the parallel version different closure values.

    Returns
    -------
    Kernel
        The function, compiled when it is first called.
    """
    if function is None:
        return lambda f: kernel(f, entry=entry, early=early, allocates=allocates, parallel=parallel)
    if not COMPILED:
        return np.errstate(all="ignore")(function)  # as compiled code is silent

    def compile() -> Any:
        from atmosbox.engine.core import compiler

        return compiler.compiled(function, entry=entry, early=early, allocates=allocates, parallel=parallel)

    return Kernel(function, compile)


def use_threads(number: int) -> None:
    """Let parallel kernels run on so many threads, or on as many as this machine has."""
    if COMPILED:
        from atmosbox.engine.core import compiler

        compiler.use_threads(number)


def prefetch(array, index):
    """Ask the processor to bring ``array[index]`` (first axis) into its cache; uncompiled code does nothing."""


def lowest_bit(bits):
    """Return the number of the lowest bit that is set; there must be one."""
    return (int(bits) & -int(bits)).bit_length() - 1


if COMPILED:

    def _prefetch() -> Any:
        from atmosbox.engine.core import compiler

        return compiler.prefetch

    def _lowest_bit() -> Any:
        from atmosbox.engine.core import compiler

        return compiler.lowest_bit

    prefetch = Kernel(prefetch, _prefetch)
    lowest_bit = Kernel(lowest_bit, _lowest_bit)

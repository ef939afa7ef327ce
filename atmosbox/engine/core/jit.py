"""The only file that calls numba: how kernels are compiled, and where their machine code is kept.

numba's own disk cache watches only the file that holds a function: edit a function that a cached kernel
calls *in another file*, or a constant imported from one, and the old machine code is served. Here the
cache is kept under a digest of all the engine's code, so that any edit of it, or a newly installed version,
starts a fresh one, and an edited comment does not. That is right only because the engine imports nothing of
atmosbox from outside its folder, which a test enforces.
"""

import ast
import hashlib
import os
import stat
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import llvmlite.ir as ir
import numba
import numpy as np
from numba.core import caching, cgutils, config, types
from numba.extending import intrinsic

__all__ = ["COMPILED", "POSITIVE", "cache_folder", "kernel", "prange", "prefetch", "use_threads"]

POSITIVE = (1 << 40) - 1
"""``index & POSITIVE`` tells the compiler that an index is not negative: that saves Python's counting from the end."""

COMPILED = not config.DISABLE_JIT
"""Whether kernels are compiled (they are not under ``NUMBA_DISABLE_JIT=1``, which the coverage run uses)."""

prange = numba.prange
"""The ``range`` of a loop whose turns a kernel that is ``parallel`` shares among threads."""

_SHARED: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}


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
    folder = folder or Path(__file__).parents[1]
    sources = {file.relative_to(folder).as_posix(): file.read_bytes() for file in sorted(folder.rglob("*.py"))}
    version = f"{numba.__version__} {sys.version}"
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


_CACHE = cache_folder()


class _Locator(caching._CacheLocator):  # type: ignore[misc]
    """Tells numba where to keep a kernel: in a folder whose name stands for all sources, so that no file has a date."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._folder = str(_CACHE / function.__module__)  # type: ignore[operator]

    @classmethod
    def from_function(cls, py_func: Callable[..., Any], py_file: str) -> "_Locator":
        return cls(py_func)

    def get_cache_path(self) -> str:
        return self._folder

    def get_source_stamp(self) -> str:
        return ""

    def get_disambiguator(self) -> str:
        return ""


class _KeptKernel(caching.CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes: ClassVar = [_Locator]


class _KeptKernels(caching.FunctionCache):  # type: ignore[misc]
    """The machine code of a kernel on disk."""

    _impl_class = _KeptKernel


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
    callable
        The compiled function.
    """
    if function is None:
        return lambda f: kernel(f, entry=entry, early=early, allocates=allocates, parallel=parallel)
    if not COMPILED:
        return np.errstate(all="ignore")(function)  # as compiled code is silent
    options = _SHARED | {"_nrt": allocates, "parallel": parallel}
    if early:
        return numba.njit(inline="always", **options)(function)
    if not entry:
        return numba.njit(forceinline=True, **options)(function)
    compiled = numba.njit(nogil=True, **options)(function)
    if _CACHE is not None:
        compiled._cache = _KeptKernels(function)
    return compiled


def use_threads(number: int) -> None:
    """Let parallel kernels run on so many threads, or on as many as this machine has."""
    if COMPILED:
        numba.set_num_threads(min(number, config.NUMBA_NUM_THREADS))


if COMPILED:

    @intrinsic
    def prefetch(typing_context, array, index):
        """Ask the processor to bring ``array[index]`` (first axis) into its cache."""
        signature = types.void(array, types.int64)

        def generate(context, builder, signature, arguments):
            values = context.make_array(signature.args[0])(context, builder, arguments[0])
            place = cgutils.pointer_add(
                builder,
                values.data,
                builder.mul(arguments[1], builder.extract_value(values.strides, 0)),
            )
            i32 = ir.IntType(32)
            place = builder.bitcast(place, ir.IntType(8).as_pointer())
            function = cgutils.get_or_insert_function(
                builder.module,
                ir.FunctionType(ir.VoidType(), [place.type, i32, i32, i32]),
                "llvm.prefetch.p0",
            )
            builder.call(function, [place, i32(0), i32(3), i32(1)])
            return context.get_dummy_value()

        return signature, generate

else:

    def prefetch(array, index):
        """Do nothing: there is no cache to warm in uncompiled code."""

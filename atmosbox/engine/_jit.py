"""The one door to numba.

numba's own disk cache watches only the file that holds a function: edit a function that a cached kernel
calls *in another file*, or a constant imported from one, and the old machine code is served. Here the
cache is filed under a digest of all the engine's sources, so that any edit, or a newly installed version,
starts a fresh one. That is right only because the engine imports nothing of atmosbox from outside its
folder, which a test enforces.
"""

import hashlib
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import llvmlite.ir as ir
import numba
import numpy as np
from numba.core import cgutils, config, types
from numba.extending import intrinsic

__all__ = ["COMPILED", "POSITIVE", "cache_folder", "kernel", "prange", "prefetch", "use_threads"]

POSITIVE = (1 << 40) - 1
"""``index & POSITIVE`` tells the compiler that an index is not negative: that saves Python's counting from the end."""

COMPILED = not config.DISABLE_JIT
"""Whether kernels are compiled (they are not under ``NUMBA_DISABLE_JIT=1``, which the coverage run uses)."""

prange = numba.prange
"""The ``range`` of a loop whose turns a kernel that is ``parallel`` shares among threads."""

_SHARED: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}


def source_digest(folder: Path | None = None) -> str:
    """Return a short digest of every source in the engine's folder, of numba and of Python."""
    digest = hashlib.sha256(f"{numba.__version__} {sys.version}".encode())
    for file in sorted((folder or Path(__file__).parent).glob("*.py")):
        digest.update(file.name.encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()[:16]


def _home_of_caches() -> list[Path]:
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
    return [home / "atmosbox", Path(tempfile.gettempdir()) / f"atmosbox-{os.environ.get('USER', 'cache')}"]


def cache_folder() -> Path | None:
    """Return the folder of this engine's machine code, made if need be, or None where nothing can be written.

    ``NUMBA_CACHE_DIR`` is respected; a read-only home falls back to the folder for temporary files.
    """
    for home in _home_of_caches():
        folder = home / source_digest()
        try:
            folder.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=folder):
                pass
        except OSError:
            continue
        return folder
    return None


_CACHE = cache_folder()


def kernel(
    function: Callable[..., Any] | None = None, *, entry: bool = False, allocates: bool = False, parallel: bool = False
) -> Any:
    """Compile a function of the engine.

    Parameters
    ----------
    function
        Numbers, arrays and NamedTuples of them come in; no strings, no exceptions, no allocation in loops.
    entry
        True for what Python calls: it keeps its machine code on disk. False for a law that other kernels call: it is
        always inlined into them, so that flags passed as constants cost nothing.
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
        return lambda f: kernel(f, entry=entry, allocates=allocates, parallel=parallel)
    if not COMPILED:
        return np.errstate(all="ignore")(function)  # as compiled code is silent
    options = _SHARED | {"_nrt": allocates, "parallel": parallel}
    if not entry:
        return numba.njit(forceinline=True, **options)(function)
    if _CACHE is None:
        return numba.njit(nogil=True, **options)(function)
    before = config.CACHE_DIR
    config.CACHE_DIR = str(_CACHE)
    try:
        return numba.njit(cache=True, nogil=True, **options)(function)
    finally:
        config.CACHE_DIR = before


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

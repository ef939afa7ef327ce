"""How numba compiles a kernel; this file is imported when a kernel is first called.

Besides this file, `constant_modes`, `by_reference` and `exact.lanes` extend numba.
"""

import contextlib
import gc
import hashlib
import pickle
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import llvmlite.ir as ir
import numba
from numba.core import caching, cgutils, config, types
from numba.core.registry import cpu_target
from numba.core.serialize import dumps
from numba.extending import intrinsic

from atmosbox.engine.core.by_reference import by_reference
from atmosbox.engine.core.constant_modes import KernelCompiler, for_flags_read
from atmosbox.engine.core.kernel_cache import (
    ForeignError,
    announce,
    cache_folder,
    keep,
    own_content,
    own_folder,
    warn_once,
)

if sys.platform != "win32":
    import fcntl

__all__ = ["by_reference", "compiled", "prange", "prefetch", "type_of", "use_threads"]

prange = numba.prange
"""The ``range`` of a loop whose iterations a ``parallel`` kernel shares among threads."""

# No "fastmath" option, not even the fusing of products and sums, which only some processors have: results are the
# same to the last bit on all processors.
_SHARED: dict[str, Any] = {"error_model": "numpy"}
_CACHE = cache_folder()
_LONGEST = 120.0  # seconds
_CHECK = hashlib.sha256().digest_size  # bytes


class _Locator(caching._CacheLocator):  # type: ignore[misc]
    """Tells numba the folder of a kernel; its name holds the digest of all sources, so no file needs a time stamp."""

    def __init__(self, function: Callable[..., Any]) -> None:
        self._folder = str(own_folder(_CACHE / function.__module__))  # type: ignore[operator]

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


class _Files:
    """The files of a kernel: one for each version of it, with a checksum. They replace numba's files and index.

    numba would run what any user has written to the folder, and machine code in which the disk has changed a bit.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self._folder, self._name = folder, name

    def path(self, key: Any, suffix: str = "nbc") -> Path:
        """Return the path of the file of a version."""
        return self._folder / f"{self._name}.{hashlib.sha256(repr(key).encode()).hexdigest()[:16]}.{suffix}"

    def load(self, key: Any) -> Any:
        """Return the machine code of a version, or None if there is none that is whole."""
        content = own_content(self.path(key))
        if hashlib.sha256(content[_CHECK:]).digest() != content[:_CHECK]:
            return None
        known, data = pickle.loads(content[_CHECK:])
        return data if known == key else None

    def save(self, key: Any, data: Any) -> None:
        """Keep the machine code of a version."""
        content = dumps((key, data))
        keep(self.path(key), hashlib.sha256(content).digest() + content)


class _KeptKernels(caching.FunctionCache):  # type: ignore[misc]
    """The machine code of a kernel on disk; one process compiles what is not there while the others wait."""

    _impl_class = _KeptKernel

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._cache_file = _Files(Path(self.cache_path), self._impl.filename_base)
        self._locks: list[Any] = []

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return the machine code for some types, or None if it must be compiled; then announce the compilation."""
        found = self._kept(sig, target_context)
        if found is None and self._wait_for_others(sig, target_context):
            found = self._kept(sig, target_context)
        if found is None:
            announce(self._py_func.__qualname__, True)
        return found

    def _kept(self, sig: Any, target_context: Any) -> Any:
        """Return what is on disk, or None if it is missing, damaged or not ours: a damaged file may raise any error."""
        try:
            return super().load_overload(sig, target_context)
        except ForeignError as error:
            warn_once(str(error))
        except Exception:
            pass
        return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for some types, if it can be written."""
        with contextlib.suppress(OSError):
            super().save_overload(sig, data)
        announce(self._py_func.__qualname__, False)

    def _wait_for_others(self, sig: Any, target_context: Any) -> bool:
        """Take the right to compile; return whether another process had it until now.

        A process that ends gives up its right. The wait is no longer than the longest compilation.
        """
        if sys.platform == "win32":
            return False
        try:
            lock = self._cache_file.path(self._index_key(sig, target_context.codegen()), "lock").open("wb")
        except OSError:
            return False
        self._locks.append(lock)
        waited = False
        until = time.monotonic() + _LONGEST
        while time.monotonic() < until:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                waited = True
                time.sleep(0.05)
            else:
                break
        return waited

    def let_others_go_on(self) -> None:
        """Give up the right to compile, so that waiting processes go on."""
        for lock in self._locks:
            lock.close()
        self._locks.clear()


def _kept_kernels(function: Callable[..., Any]) -> _KeptKernels | None:
    """Return the machine code of a kernel on disk; None if there is no folder for it that is ours."""
    try:
        return _KeptKernels(function) if _CACHE is not None else None
    except ForeignError as error:
        warn_once(str(error))
    except OSError:
        pass
    return None


def compiled(
    function: Callable[..., Any], *, entry: bool, early: bool, allocates: bool, parallel: bool, kept: bool = True
) -> Any:
    """Return a function compiled by numba, for the types of the arguments of each call: see `jit.kernel`.

    Python can call only an entry, and an entry can be ``kept`` on disk. For all others numba leaves out the wrappers
    through which Python and C would call them, which take a fifth of the compilation time.
    """
    options = _SHARED | {"_nrt": allocates, "parallel": parallel, "pipeline_class": KernelCompiler}
    if early:
        return numba.njit(inline="always", **options)(function)
    options["no_cfunc_wrapper"] = True
    if not entry:
        return _of_plain_types(numba.njit(forceinline=True, no_cpython_wrapper=True, **options)(function))
    made = numba.njit(nogil=True, **options)(function)
    kernels = _kept_kernels(function) if kept else None
    if kernels:
        made._cache = kernels
    made.compile = _without_garbage_collection(made.compile, kernels)
    return made


def _without_garbage_collection(compile: Callable[[Any], Any], kernels: _KeptKernels | None) -> Callable[[Any], Any]:
    """Switch the garbage collector off while a kernel is compiled: it takes a tenth of that time and frees little."""

    def uncollected(signature: Any) -> Any:
        collects = gc.isenabled()
        gc.disable()
        try:
            return compile(signature)
        finally:
            if collects:
                gc.enable()
            if kernels:
                kernels.let_others_go_on()  # also where a kernel cannot be compiled

    return uncollected


def _of_plain_types(made: Any) -> Any:
    """Have a function compiled once for all whole numbers, not once for each constant in the source.

    The code is inlined, and the optimiser adapts it to each constant afterwards. Of the modes, the function gets only
    the flags that it reads, so that one version serves all boxes that differ in other flags.
    """
    template = made.get_call_template

    def plain(arguments: Any, keywords: Any) -> Any:
        plainest = (for_flags_read(made.py_func, types.unliteral(each)) for each in arguments)  # type: ignore[attr-defined]
        return template(tuple(plainest), keywords)

    made.get_call_template = plain
    return made


def type_of(thing: Any) -> Any:
    """Return the numba type of a compiled function, for the code of other kernels."""
    cpu_target.typing_context.refresh()  # intrinsics of ours may have been imported since
    return cpu_target.typing_context.resolve_value_type(thing)


def use_threads(number: int) -> None:
    """Set the number of threads of parallel kernels, at most as many as this machine has."""
    numba.set_num_threads(min(number, config.NUMBA_NUM_THREADS))


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


@intrinsic
def lowest_bit(typing_context, bits):
    """Return the number of the lowest bit that is set; there must be one."""
    signature = types.int64(types.int64)

    def generate(context, builder, signature, arguments):
        return builder.cttz(arguments[0], ir.Constant(ir.IntType(1), 1))

    return signature, generate

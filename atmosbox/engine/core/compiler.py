"""What numba makes of a kernel; imported when one is first called.

Besides this file only `stepped.window` calls numba, for its vectors.
"""

from collections.abc import Callable
from typing import Any, ClassVar

import llvmlite.ir as ir
import numba
from numba.core import caching, cgutils, config, types
from numba.core.registry import cpu_target
from numba.extending import intrinsic

from atmosbox.engine.core.jit import cache_folder

__all__ = ["compiled", "prange", "prefetch", "type_of", "use_threads"]

prange = numba.prange
"""The ``range`` of a loop whose turns a kernel that is ``parallel`` shares among threads."""

_SHARED: dict[str, Any] = {"error_model": "numpy", "fastmath": {"contract"}}
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


def compiled(function: Callable[..., Any], *, entry: bool, early: bool, allocates: bool, parallel: bool) -> Any:
    """Return what numba makes of a function, which is compiled for the types it is called with: see `jit.kernel`."""
    options = _SHARED | {"_nrt": allocates, "parallel": parallel}
    if early:
        return numba.njit(inline="always", **options)(function)
    if not entry:
        return numba.njit(forceinline=True, **options)(function)
    made = numba.njit(nogil=True, **options)(function)
    if _CACHE is not None:
        made._cache = _KeptKernels(function)
    return made


def type_of(thing: Any) -> Any:
    """Return the type of a compiled function, as other compiled code sees it."""
    return cpu_target.typing_context.resolve_value_type(thing)


def use_threads(number: int) -> None:
    """Let parallel kernels run on so many threads, or on as many as this machine has."""
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

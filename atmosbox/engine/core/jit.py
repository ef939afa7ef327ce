"""Kernels, functions of the engine that numba compiles when they are first called, and not before.

A program that needs only the facts of a scene, or a schedule, does not wait for numba: `compiler`, the file that
imports it, is imported when the first kernel is called. `kernel_cache` tells where the machine code is kept.
"""

import functools
import os
import threading
from collections.abc import Callable
from typing import Any

import numpy as np

POSITIVE = (1 << 40) - 1
"""``index & POSITIVE`` tells the compiler that an index is not negative: no code for counting from the end is made."""

COMPILED = not int(os.environ.get("NUMBA_DISABLE_JIT") or 0)
"""Whether kernels are compiled (they are not under ``NUMBA_DISABLE_JIT=1``, which the coverage run uses)."""


class _Quiet(threading.local):
    """Whether numpy gives no warnings now, as compiled code gives none."""

    now = False


_QUIET = _Quiet()


def _quietly(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that numpy runs without warnings; what it calls need not switch them off again."""

    @functools.wraps(function)
    def run(*arguments: Any) -> Any:
        if _QUIET.now:
            return function(*arguments)
        _QUIET.now = True
        try:
            with np.errstate(all="ignore"):
                return function(*arguments)
        finally:
            _QUIET.now = False

    return run


class Kernel:
    """A function of the engine that is compiled when Python or another kernel first calls it.

    ``compile`` returns the compiled function that other kernels call, whose attributes this object has too;
    ``for_python`` the one that Python calls, where it differs. Python runs a ``plain`` function uncompiled.
    """

    def __init__(
        self,
        function: Callable[..., Any],
        compile: Callable[[], Any],
        for_python: Callable[[], Any] | None = None,
        *,
        plain: bool = False,
    ) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        self._compile = compile
        self._for_python = for_python
        self._plain = plain

    @functools.cached_property
    def compiled(self) -> Any:
        """The function that other kernels call."""
        return self._compile()

    @functools.cached_property
    def _run(self) -> Any:
        """The function that Python calls."""
        if self._plain:
            return _quietly(self.py_func)
        return self._for_python() if self._for_python else self.compiled

    @property
    def stats(self) -> Any:
        """How often the machine code that Python calls was found on disk."""
        return self._run.stats

    @property
    def _numba_type_(self) -> Any:
        """The type that numba sees where the code of another kernel names this one."""
        from atmosbox.engine.core import compiler

        return compiler.type_of(self.compiled)

    def __call__(self, *arguments: Any) -> Any:
        """Run it."""
        return self.py_func(*arguments) if self._plain and _QUIET.now else self._run(*arguments)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):  # copy and pickle look for special methods, which numba's object need not have
            raise AttributeError(name)
        return getattr(self.compiled, name)


def kernel(
    function: Callable[..., Any] | None = None,
    *,
    entry: bool = False,
    early: bool = False,
    allocates: bool = False,
    parallel: bool = False,
    plain: bool = False,
) -> Any:
    """Compile a function of the engine: one of numbers, arrays and NamedTuples of them, without strings or exceptions.

    Parameters
    ----------
    function
        The function.
    entry
        Whether Python calls it: then its machine code is kept on disk. A kernel that another kernel calls is always
        inlined into it, so that flags passed as constants cost nothing.
    early
        Whether its code is inserted into its callers before they are compiled: for the few lines of the innermost
        loop. It must have a single return (measured: with two, the loop takes 1.7 times as long).
    allocates
        Whether the function makes arrays, never in a loop. One that does not is compiled without numba's counting of
        references, which would cost a quarter of the time of an event.
    parallel
        Whether its `prange` loops share the work among threads. The cache tells two versions of one function apart by
        the values that they close over, not by this flag: give the serial and the parallel version different ones.
    plain
        Whether Python runs the function uncompiled: for short functions that Python needs before anything is compiled.
    """
    if function is None:
        return lambda f: kernel(f, entry=entry, early=early, allocates=allocates, parallel=parallel, plain=plain)
    if not COMPILED:
        return _quietly(function)

    def compiled(**kind: bool) -> Any:
        from atmosbox.engine.core import compiler

        return compiler.compiled(function, **kind, allocates=allocates, parallel=parallel, kept=entry)

    called = functools.partial(compiled, entry=False, early=early)
    alone = functools.partial(compiled, entry=True, early=False)
    return Kernel(function, called, alone, plain=plain)


def use_threads(number: int) -> None:
    """Set the number of threads of parallel kernels, at most as many as this machine has."""
    if COMPILED:
        from atmosbox.engine.core import compiler

        compiler.use_threads(number)


def prefetch(array, index):
    """Ask the processor to bring ``array[index]`` (first axis) into its cache; without numba, do nothing."""


def by_reference(bundle):
    """Return a NamedTuple that kernels pass on by its address, not value by value.

    Each kernel that Python calls does this once. All kernels called from it are inlined, so the compiled code does not
    change; but a box is two hundred values, and passing each of them at each call took most of the compilation time.
    """
    return bundle


def lowest_bit(bits):
    """Return the number of the lowest bit that is set; there must be one."""
    return (int(bits) & -int(bits)).bit_length() - 1


if COMPILED:

    def _of_the_compiler(function: Callable[..., Any]) -> Kernel:
        """Return an instruction that `compiler` has under the name of this function."""

        def made() -> Any:
            from atmosbox.engine.core import compiler

            return getattr(compiler, function.__name__)

        return Kernel(function, made)

    by_reference, prefetch, lowest_bit = (_of_the_compiler(each) for each in (by_reference, prefetch, lowest_bit))

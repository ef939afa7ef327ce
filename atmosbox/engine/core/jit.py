"""How kernels are compiled: when they are first called, and not before.

What asks for a scene's facts, or for one of its schedules, does not wait for numba: `compiler`, the file that
loads it, is imported when the first kernel is called. Where the machine code is kept, `kernel_cache` says.
"""

import functools
import os
from collections.abc import Callable
from typing import Any

import numpy as np

__all__ = ["COMPILED", "POSITIVE", "Kernel", "by_reference", "kernel", "lowest_bit", "prefetch", "use_threads"]

POSITIVE = (1 << 40) - 1
"""``index & POSITIVE`` tells the compiler that an index is not negative: that saves Python's counting from the end."""

COMPILED = not int(os.environ.get("NUMBA_DISABLE_JIT") or 0)
"""Whether kernels are compiled (they are not under ``NUMBA_DISABLE_JIT=1``, which the coverage run uses)."""


class Kernel:
    """A function of the engine that is compiled when it is first called, by Python or by the code of another one.

    Whatever else is asked of it (``stats``, ``signatures``) is answered by what numba made of it.

    Parameters
    ----------
    function
        The function as it is written.
    compile
        Makes what other kernels call.
    for_python
        Makes what Python calls, where that is something else.
    plain
        Whether Python runs it as it is written, so that only code that is compiled asks for it to be compiled.
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
        """What other kernels call."""
        return self._compile()

    @functools.cached_property
    def _run(self) -> Any:
        """What Python calls."""
        if self._plain:
            return np.errstate(all="ignore")(self.py_func)
        return self._for_python() if self._for_python else self.compiled

    @property
    def _numba_type_(self) -> Any:
        """What numba sees where the code of another kernel names this one."""
        from atmosbox.engine.core import compiler

        return compiler.type_of(self.compiled)

    def __call__(self, *arguments: Any) -> Any:
        """Run it."""
        return self._run(*arguments)

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
    plain
        Whether Python runs the function as it is written: for short ones that Python needs before anything is compiled.

    Returns
    -------
    Kernel
        The function, compiled when it is first called.
    """
    if function is None:
        return lambda f: kernel(f, entry=entry, early=early, allocates=allocates, parallel=parallel, plain=plain)
    if not COMPILED:
        return np.errstate(all="ignore")(function)  # as compiled code is silent

    def compiled(**kind: bool) -> Any:
        from atmosbox.engine.core import compiler

        return compiler.compiled(function, **kind, allocates=allocates, parallel=parallel, kept=entry)

    called = functools.partial(compiled, entry=entry, early=early)
    alone = None if entry else functools.partial(compiled, entry=True, early=False)
    return Kernel(function, called, alone, plain=plain)


def use_threads(number: int) -> None:
    """Let parallel kernels run on so many threads, or on as many as this machine has."""
    if COMPILED:
        from atmosbox.engine.core import compiler

        compiler.use_threads(number)


def prefetch(array, index):
    """Ask the processor to bring ``array[index]`` (first axis) into its cache; uncompiled code does nothing."""


def by_reference(bundle):
    """Return a NamedTuple so that kernels hand it on by its place in memory, not value by value.

    Said once by each kernel that Python calls. All kernels in it are inlined, so it changes nothing in what runs; but
    a box is two hundred values, and to take them apart and put them together at each call was most of the compilation.
    """
    return bundle


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

    def _by_reference() -> Any:
        from atmosbox.engine.core import compiler

        return compiler.by_reference

    by_reference = Kernel(by_reference, _by_reference)
    prefetch = Kernel(prefetch, _prefetch)
    lowest_bit = Kernel(lowest_bit, _lowest_bit)

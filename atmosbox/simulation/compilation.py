"""Compilation of the kernels before a first run: what is said of it, and compilation in advance."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator

from atmosbox.engine.core.kernel_cache import compilations
from atmosbox.simulation.preparation import Prepared, build

_SENTENCE = "compiling the engine, once on this computer: about 15 s"


@contextlib.contextmanager
def told(tell: Callable[[float, str], None]) -> Iterator[None]:
    """Say that the engine is compiled if anything is compiled while a block runs.

    `tell` is called with the share that is done, zero, and a sentence.
    """
    said = False

    def watch(kernel: str, begins: bool) -> None:
        nonlocal said
        if not said:
            said = True
            tell(0.0, _SENTENCE)

    with compilations(watch):
        yield


def compile_kernels(prepared: Prepared) -> float:
    """Compile the kernels of a scene; return the processor time that it took [s], zero if they are stored already.

    The box is built as for a run, since the kernels depend on it, and advanced by a very short time.
    """
    began, compiled = time.process_time(), []
    with told(lambda share, sentence: compiled.append(sentence)):
        setup = build(prepared)
        setup.parcel.advance(0.0)
        step = getattr(setup.parcel, "time_step", 0.0)
        setup.parcel.advance(max(2.0 * step, 1e-4 * setup.frame))
    return time.process_time() - began if compiled else 0.0

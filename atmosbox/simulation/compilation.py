"""Compilation of the kernels before a first run: its progress, and compilation in advance."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from atmosbox.engine.core.kernel_cache import cache_folder, compilations
from atmosbox.simulation.preparation import Prepared, build

_USUAL = 15.0  # seconds that a compilation takes
_BREATH = 0.2
_NEVER_DONE = 0.97


@contextlib.contextmanager
def told(tell: Callable[[float, str], None]) -> Iterator[Callable[[], float]]:
    """Report the progress of compilation while a block runs, if anything is compiled in the block.

    `tell` is called with the expected share and a sentence, from a separate thread while the compiler works. Yields a
    function that returns the processor time of the compiler so far [s].

    Examples
    --------
    >>> with told(print) as spent:
    ...     spent()
    0.0
    """
    sentence = f"compiling the engine, once on this computer: about {_USUAL:.0f} s"
    before, began, depth = 0.0, 0.0, 0
    over = threading.Event()
    teller: threading.Thread | None = None

    def spent() -> float:
        return before + (time.process_time() - began if depth else 0.0)

    def go_on_telling() -> None:
        while not over.wait(_BREATH):
            if depth:
                tell(min(spent() / _USUAL, _NEVER_DONE), sentence)

    def watch(kernel: str, begins: bool) -> None:
        nonlocal before, began, depth, teller
        before, began = spent(), time.process_time()
        depth = max(depth + (1 if begins else -1), 0)
        if begins and teller is None:
            tell(0.0, sentence)
            teller = threading.Thread(target=go_on_telling, daemon=True)
            teller.start()

    try:
        with compilations(watch):
            yield spent
    finally:
        over.set()
        if teller is not None:
            teller.join()


def compile_kernels(prepared: Prepared) -> float:
    """Compile the kernels of a scene unless they are stored already; return the processor time that it took [s].

    The box is built as for a run, since the kernels depend on it, and advanced by a very short time.
    """
    with told(lambda share, sentence: None) as spent:
        setup = build(prepared)
        setup.parcel.advance(0.0)
        step = getattr(setup.parcel, "time_step", 0.0)
        setup.parcel.advance(max(2.0 * step, 1e-4 * setup.frame))
    return spent()


def cache_home() -> Path | None:
    """Return the folder in which machine code is stored, None if there is none."""
    folder = cache_folder()
    return None if folder is None else folder.parent


def compiled_here() -> int:
    """Return the number of bytes of machine code that are stored for the present engine."""
    folder = cache_folder()
    return 0 if folder is None else sum(file.stat().st_size for file in folder.rglob("*") if file.is_file())

"""Advance a box in a page, with the engine's own loop, and enter its molecules into their cells."""

import functools
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.advance import Passed, advancing, dry_loop
from atmosbox.engine.exact.layout import PLACE
from atmosbox.engine.liquid.moist_loop import moist_loop

__all__ = ["passing"]


@functools.cache
def passing(modes: Modes) -> tuple[Callable[..., Any], ...]:
    """Return the kernels ``pass_time`` and ``place`` of one set of modes."""
    pass_time, settle = advancing(modes, moist_loop if modes.phases else dry_loop)

    @kernel
    def place(gas, book, layout):
        """Enter all molecules into their cells and plan their events; return ``DONE`` or ``FULL``."""
        layout.due[0] = PLACE
        return Passed.DONE.value if settle(gas, book.now[0], layout) else Passed.FULL.value

    return pass_time, place

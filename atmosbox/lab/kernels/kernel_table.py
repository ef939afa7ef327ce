"""The kernels that a page calls, by name, for one set of modes."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.state import Modes
from atmosbox.engine.exact.advance import advancing, dry_loop
from atmosbox.engine.exact.exact import Status
from atmosbox.engine.exact.layout import PLACE
from atmosbox.engine.liquid.moist_loop import moist_loop
from atmosbox.engine.wells import well_advance
from atmosbox.lab.kernels.averaging import begin_averages_anew
from atmosbox.lab.kernels.gauging import gauging
from atmosbox.lab.kernels.knobs import knobs
from atmosbox.lab.kernels.picture import picture
from atmosbox.lab.kernels.starting import starting


def kernels(modes: Modes, *, wells: bool = False) -> dict[str, Callable[..., Any]]:
    """Return the kernels for a set of modes by name; ``wells`` if molecules attract each other."""
    found = knobs(modes, wells=wells) | {"start": starting(modes, wells=wells), "look": picture(modes, wells=wells)}
    found |= {"begin_averages_anew": begin_averages_anew} | gauging(modes, wells=wells)
    loops = moist_loop if modes.phases else dry_loop
    pass_time, settle = well_advance.advancing(modes) if wells else advancing(modes, loops)

    @kernel
    def place(gas, book, layout):
        """Enter all molecules into their cells or lists and plan their events; return ``DONE`` or ``FULL``."""
        layout.due[0] = PLACE
        state, clock = gas.tallies.random[0], gas.bath.clock[0] if wells else math.inf
        placed = settle(gas, book.now[0], layout)
        if wells and not math.isinf(clock):  # the first time of the bath is drawn already
            gas.tallies.random[0] = state
            gas.bath.clock[0] = clock
        return Status.DONE.value if placed else Status.FULL.value

    return found | {"pass_time": pass_time, "place": place}

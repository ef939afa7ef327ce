"""A run under way: its box advances from frame to frame, and its instruments look."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.headline import Headline
from atmosbox.instruments import Molecules, Readings
from atmosbox.preparation import Prepared
from atmosbox.scene import Setup
from atmosbox.verification import with_bias

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["Recording"]


@dataclass
class Recording:
    """A run under way: its box, its instruments, and the times of its frames."""

    prepared: Prepared
    setup: Setup
    attributes: dict[str, Any]
    times: list[float] = field(default_factory=lambda: [0.0])
    busy: float = 0.0

    def __post_init__(self) -> None:
        extra = (Molecules(),) if self.prepared.save_molecules else ()
        self.instruments = (*self.setup.instruments, *extra)

    @property
    def frames(self) -> int:
        """How many frames are complete."""
        return len(self.times) - 1

    def advance(self, watch: Callable[[float], None]) -> None:
        """Advance by one frame and measure."""
        setup = self.setup
        parcel = setup.parcel
        for sample in range(1, setup.samples + 1):
            until = (self.frames + sample / setup.samples) * setup.frame
            if sample == setup.samples:
                until = (self.frames + 1) * setup.frame
            busy = time.process_time()
            parcel.advance(max(until, parcel.time), watch)
            self.busy += time.process_time() - busy
            snapshot = parcel.snapshot()
            for instrument in self.instruments:
                instrument.look(parcel, snapshot)
        for instrument in self.instruments:
            instrument.close(parcel, snapshot)
        self.times.append(parcel.time)

    def dataset(self, status: str) -> tuple[xr.Dataset, tuple[Headline, ...]]:
        """Return all that has been measured so far, with theory beside it."""
        from atmosbox import diagnostics

        setup, settings, module = self.setup, self.prepared.settings, self.prepared.module
        in_unit = setup.scale.time / {"s": 1.0, "ns": 1e-9, "ps": 1e-12}[setup.time_unit]
        times = np.array(self.times) * in_unit
        readings = Readings()
        settle = min(setup.settle, max(self.frames - 2, 0))
        for instrument in self.instruments:
            readings.update(instrument.readings(setup.scale, settle))
        names = ("height", "height_bnds", "speed", "speed_bnds", "energy", "energy_bnds")
        coords = {name: readings.pop(name) for name in names if name in readings}
        coords["elapsed_time"] = times[1:]
        coords["elapsed_time_bnds"] = np.stack([times[:-1], times[1:]], axis=1)
        attributes = self.attributes | {"atmosbox_status": status}
        measured = diagnostics.dataset(readings, coords, attributes, time_unit=setup.time_unit)
        if self.frames < 2:
            return measured, ()
        answers = module.theory(measured, settings)
        full = diagnostics.dataset(readings | answers, coords, attributes, time_unit=setup.time_unit)
        headlines = with_bias(module.headlines(full, settings), self.prepared.parameters)
        return diagnostics.dataset(
            readings | answers, coords, attributes, headlines, time_unit=setup.time_unit
        ), headlines

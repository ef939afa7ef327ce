"""What a box with liquid in it has beside its gas, as the arrays that the kernels of a page work on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.engine.liquid.substance import Substance
from atmosbox.lab.kernels.hygrometer import Hygrometer, Sampled
from atmosbox.lab.kernels.moist_passing import Moisture
from atmosbox.page.page_liquid import POOL, RAIN, SWELLING, places
from atmosbox.scene.instruments import Leaving, MoistLift
from atmosbox.scene.instruments.water import _CRITICAL
from atmosbox.theory.equation_of_state import _CONTACT_SERIES

if TYPE_CHECKING:
    from atmosbox.page import Stage
    from atmosbox.scene.setup import Setup
    from atmosbox.scene.units import Scale

__all__ = ["bins_of", "hygrometer", "liquid_sight", "moisture"]

_WAY = 801
"""Values of the table of the adiabat of a parcel."""
_WIDER = 0.25
"""How much further than its planned way that table reaches at both ends."""


def moisture(parcel: Any) -> Any:
    """Return the liquid of a box, 0 if it has none."""
    if not hasattr(parcel, "vapour"):
        return 0
    reservoir = parcel._reservoir
    cover = np.array([reservoir.sticking, reservoir.log_rate])
    return Moisture(reservoir, cover, parcel._vapours, parcel._rotations, getattr(parcel, "_drops", 0))


def hygrometer(setup: Setup) -> Any:
    """Return what measures the water of a box, 0 if it has none."""
    parcel: Any = setup.parcel
    if not hasattr(parcel, "vapour"):
        return 0
    substance: Substance = parcel._liquid.substance
    lift = next((each for each in setup.instruments if type(each) is MoistLift), None)
    log_pressure, adiabat = (np.zeros(0), np.zeros(0)) if lift is None else _adiabat(setup, lift)
    width, empty, merged = _leaving(setup)
    return Hygrometer(
        sums=np.zeros(len(Sampled)),
        before=np.zeros(2),
        met=np.zeros(4),
        contact=np.array(_CONTACT_SERIES.coef),
        volatility=float(substance.volatility),
        power=float(substance.vapour_heat_capacity - substance.heat_capacity),
        binding=float(substance.binding_energy),
        critical=_CRITICAL / setup.scale.temperature,
        log_pressure=log_pressure,
        adiabat=adiabat,
        width=width,
        mean=np.full(width.size, math.nan),
        error=np.full(width.size, math.nan),
        empty=empty,
        merged=merged,
    )


def _adiabat(setup: Setup, lift: MoistLift) -> tuple[Any, Any]:
    """Return the adiabat of a parcel: its temperature at logarithms of pressure, both in the units of the engine."""
    seconds = np.linspace(0.0, setup.duration * setup.scale.time, _WAY)
    ends = np.log([lift.environment.pressure(t) for t in seconds])
    levels = np.linspace(ends.max() + _WIDER, ends.min() - _WIDER, _WAY)
    kelvin = lift._curve(np.exp(levels))
    return levels[::-1] - math.log(setup.scale.pressure), kelvin[::-1] / setup.scale.temperature


def _leaving(setup: Setup) -> tuple[Any, int, int]:
    """Return the widths of the bins of the energy of molecules that leave, how many are empty, and what makes one."""
    leaving = next((each for each in setup.instruments if type(each) is Leaving), None)
    if leaving is None:
        return np.zeros(0), 0, 1
    bounds = bins_of(setup, leaving)
    merged = leaving._merged
    parcel: Any = setup.parcel
    return np.diff(bounds)[:, 0] / setup.scale.energy, len(bounds) - parcel._reservoir.spectrum.size // merged, merged


def bins_of(setup: Setup, leaving: Leaving) -> Any:
    """Return the bounds of the bins of energy, ``(bin, 2)`` [J]."""
    fresh = Leaving(leaving._binding, leaving._merged)
    fresh.end_frame(setup.parcel, setup.parcel.snapshot())
    return fresh.readings(setup.scale, 0)["energy_bnds"]


def liquid_sight(parcel: Any, scale: Scale, stage: Stage | None) -> tuple[Any, ...]:
    """Return what the picture of the liquid is made of: the last fields of `Sight`."""
    record = None if stage is None else stage.record
    water = 0 if record is None else int(record["water"])
    spread = places(water)
    drops = len(parcel._drops.record) if hasattr(parcel, "_drops") else 0
    return (
        np.zeros((max(len(spread), drops) + 1, 4), np.float32),
        np.zeros(1, np.int64),
        1.0 if record is None else scale.length * float(record["metre"]),
        water,
        0.0 if record is None else SWELLING * float(record["species"][-1]["drawn"]),
        spread,
        np.array([POOL, RAIN]),
    )

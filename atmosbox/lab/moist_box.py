"""The liquid of a box and its instruments, as the arrays that the kernels of a page work on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox import theory as law
from atmosbox.engine.liquid.substance import Substance
from atmosbox.lab.kernels.hygrometer import Hygrometer
from atmosbox.lab.stage import instrument_of
from atmosbox.lab.theory_table import finer_at_kinks, theory_at
from atmosbox.page.frame import SWELLING, places
from atmosbox.scene.instruments import Leaving, MoistLift
from atmosbox.scene.instruments.water import _CRITICAL
from atmosbox.theory.equation_of_state import _CONTACT_SERIES

if TYPE_CHECKING:
    from atmosbox.page import Stage
    from atmosbox.scene.setup import Setup
    from atmosbox.scene.units import Scale
    from atmosbox.simulation.preparation import Prepared

_WAY = 801
"""Number of values in the table of the adiabat of a parcel."""
_WIDER = 0.25
"""Distance in the logarithm of pressure by which that table reaches beyond the planned ascent at both ends."""
_FARTHEST, _OFFSETS = 0.16, 41
"""If it rains: largest offset of the logarithm of pressure from the planned one, and number of offsets in the table."""


def hygrometer(prepared: Prepared, setup: Setup) -> Any:
    """Return the data of the instruments for the water of a box; 0 if it has none."""
    parcel: Any = setup.parcel
    arrays = parcel.arrays()
    if not arrays.modes.phases:
        return 0
    substance: Substance = arrays.substance
    scale, binding = setup.scale, float(substance.binding_energy)
    lift, none = instrument_of(setup, MoistLift), np.zeros(0)
    way: dict[str, Any] = dict.fromkeys(("moment", "planned", "log_pressure", "level", "around"), none)
    way["adiabat"] = np.zeros((0, 0))
    if lift is not None:
        rains = arrays.book.moisture.reservoir.rain > 0.0
        way = _adiabat_with_rain(prepared, setup, lift) if rains else _adiabat(setup, lift)
        way |= _environment(prepared, setup, lift)
    leaving = _leaving(setup)
    return Hygrometer(
        before=np.zeros(2),
        met=np.zeros(4),
        contact=np.array(_CONTACT_SERIES.coef),
        # the volatility that the substance holds is rounded to about nine digits
        volatility=float(law.saturation_vapor_pressure(scale.temperature)) / scale.pressure * math.exp(binding),
        power=float(substance.vapour_heat_capacity - substance.heat_capacity),
        binding=binding,
        critical=_CRITICAL / scale.temperature,
        mass=float(substance.mass),
        mean=np.full(leaving["width"].size, math.nan),
        error=np.full(leaving["width"].size, math.nan),
        **way,
        **leaving,
    )


def _levels(setup: Setup, lift: MoistLift) -> Any:
    """Return falling logarithms of pressure [Pa] over the whole range that a parcel may reach."""
    seconds = np.linspace(0.0, setup.duration * setup.scale.time, _WAY)
    ends = np.log([lift.environment.pressure(t) for t in seconds])
    return np.linspace(ends.max() + _WIDER, ends.min() - _WIDER, _WAY)


def _adiabat(setup: Setup, lift: MoistLift) -> dict[str, Any]:
    """Return the adiabat of a parcel that keeps its water, as a function of pressure alone: see `Hygrometer`."""
    levels = _levels(setup, lift)
    levels = finer_at_kinks(levels, lift.curve(np.exp(levels)))
    kelvin, falling = lift.curve(np.exp(levels)), levels[::-1] - math.log(setup.scale.pressure)
    adiabat = kelvin[None, ::-1] / setup.scale.temperature
    return {"moment": np.zeros(1), "planned": np.zeros(1), "log_pressure": falling, "adiabat": adiabat}


def _adiabat_with_rain(prepared: Prepared, setup: Setup, lift: MoistLift) -> dict[str, Any]:
    """Return the adiabat of a parcel whose water rains out, by moment and by pressure over planned pressure.

    The remaining water depends on the ascent, and is taken as planned; at another pressure the parcel has the same
    entropy.
    """
    parcel: Any = setup.parcel
    number = setup.frames * setup.samples
    shares = np.arange(1, number + 1) / number
    around = np.array([lift.environment.pressure(t) for t in (shares * setup.duration * setup.scale.time).tolist()])
    # theory gives the remaining water in the middle of each frame
    middle = slice(setup.samples // 2 - 1, None, setup.samples)
    kelvin, pressure = lift.curve(around)[middle], around[middle]
    told = theory_at(prepared, pressure, rains=True)
    water = told["humidity_mixing_ratio_theory"] + told["cloud_liquid_water_mixing_ratio_theory"]
    heat = float(parcel.arrays().book.moisture.reservoir.nuclei) / (parcel.number - parcel.vapour)
    offsets = np.linspace(-_FARTHEST, _FARTHEST, _OFFSETS)
    rows = [
        law.parcel_path(p * np.exp(offsets), p, t, w, nuclei_heat=heat).temperature
        for p, t, w in zip(pressure, kelvin, water, strict=True)
    ]
    return {
        "moment": shares[middle] * setup.duration,
        "planned": np.log(pressure / setup.scale.pressure),
        "log_pressure": offsets,
        "adiabat": np.array(rows) / setup.scale.temperature,
    }


def _environment(prepared: Prepared, setup: Setup, lift: MoistLift) -> dict[str, Any]:
    """Return the virtual temperature of the environment as a function of its pressure; empty if theory lacks it."""
    levels, name = _levels(setup, lift), "environment_virtual_temperature"
    if name not in theory_at(prepared, np.exp(levels[:2])):  # two levels only, for theory is slow if it rains
        return {"level": np.zeros(0), "around": np.zeros(0)}
    levels = finer_at_kinks(levels, theory_at(prepared, np.exp(levels))[name], 4)  # many kinks, and none is sharp
    around = theory_at(prepared, np.exp(levels))[name][::-1] / setup.scale.temperature
    return {"level": levels[::-1] - math.log(setup.scale.pressure), "around": around}


def _leaving(setup: Setup) -> dict[str, Any]:
    """Return the widths of the bins of energy of molecules that leave, which of them are empty, and `_merged`."""
    leaving: Leaving | None = instrument_of(setup, Leaving)
    if leaving is None:
        return {"width": np.zeros(0), "empty": 0, "merged": 1}
    bounds, parcel = bins_of(setup, leaving), setup.parcel
    edges, _ = parcel.emitted_energy  # type: ignore[attr-defined]
    empty = len(bounds) - (edges.size - 1) // leaving.merged
    return {"width": np.diff(bounds)[:, 0] / setup.scale.energy, "empty": empty, "merged": leaving.merged}


def bins_of(setup: Setup, leaving: Leaving) -> Any:
    """Return the bounds of the bins of energy : (bin, 2) [J]."""
    fresh = Leaving(leaving.binding, leaving.merged)
    fresh.end_frame(setup.parcel, setup.parcel.snapshot())
    return fresh.readings(setup.scale, 0)["energy_bnds"]


def liquid_picture(parcel: Any, scale: Scale, stage: Stage) -> tuple[Any, ...]:
    """Return the data for the picture of the liquid: the last fields of `Picture`."""
    record, water = stage.record, int(stage.record["water"])
    spread = places(water)
    arrays = parcel.arrays()
    drops = len(arrays.book.moisture.drops.record) if arrays.modes.drops else 0
    pieces, clump = np.zeros((max(len(spread), drops) + 1, 4), np.float32), float(record["species"][-1]["drawn"])
    return pieces, np.zeros(1, np.int64), scale.length * float(record["metre"]), water, SWELLING * clump, spread

"""The instruments of a box, as the arrays that the kernels of a page work on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox import theory as law
from atmosbox.lab.kernels.averaging import BLOCKS, Average
from atmosbox.lab.kernels.clustering import Crowd
from atmosbox.lab.kernels.flowing import Flow as Wind
from atmosbox.lab.kernels.flowing import can_flow
from atmosbox.lab.kernels.gauging import Gauges
from atmosbox.lab.kernels.hygrometer import Hygrometer
from atmosbox.lab.kernels.readings import Reading
from atmosbox.lab.kernels.sums import Bins, Sum
from atmosbox.lab.kernels.two_gases import Mixture
from atmosbox.lab.stage import instrument_of
from atmosbox.lab.theory_table import finer_at_kinks, pressures, theory_at
from atmosbox.scene.instruments import MOMENTS, Air, Clusters, Discs, Flow, Layers, Leaving, Mixing, MoistLift, Speeds
from atmosbox.scene.instruments.flow import modes_of_flow
from atmosbox.scene.instruments.mixing import expected_share
from atmosbox.scene.instruments.water import HIGHEST_SATURATED
from atmosbox.theory.equation_of_state import CONTACT_SERIES

if TYPE_CHECKING:
    from atmosbox.scene.setup import Setup
    from atmosbox.simulation.preparation import Prepared

_ALIKE, _ANY_SPEED, _UNMIXED = np.zeros(0, np.int64), np.zeros(1), Mixing(np.zeros(0, np.bool_), {}, 0)
_DENSITIES = 129
"""Number of densities at which the adiabatic lapse rate over gravity is tabulated, up to that at which discs freeze."""
_WAY = 801
"""Number of values in the table of the adiabat of a parcel."""
_WIDER = 0.25
"""Distance in the logarithm of pressure by which that table reaches beyond the planned ascent at both ends."""
_FARTHEST, _OFFSETS = 0.16, 41
"""If it rains: largest offset of the logarithm of pressure from the planned one, and number of offsets in the table."""
_POWERS = 4


def gauges(prepared: Prepared, setup: Setup) -> Gauges:
    """Return the data of the instruments at their start, with memory for further readings."""
    parcel: Any = setup.parcel
    air, discs = instrument_of(setup, Air) or Air(), instrument_of(setup, Discs)
    edges = (instrument_of(setup, Speeds) or Speeds(np.zeros(1))).edges
    layers, mixing = instrument_of(setup, Layers) or Layers(0), instrument_of(setup, Mixing) or _UNMIXED
    mass, wide, number, rows = parcel.mass, float(parcel.length[0]), len(Reading) + 5, layers.number
    kind, columns, low = mixing.right.astype(np.int64), mixing.bins, 0.0
    if columns:
        low = 0.5 * float(np.max(parcel.diameter, initial=0.0)) * (not parcel.periodic[0])
    elif discs is not None:
        kind, columns = np.ones(mass.size, np.int64), 1
        kind[np.argsort(mass, kind="stable")[: mass.size // 2]] = 0
    return Gauges(
        reading=np.zeros(number),
        means=np.zeros(number),
        samples=np.zeros(1),
        before=np.zeros(8),
        barometer=0 if air.barometer == "all" else 4,
        whole=_bins(wide),
        parts=_bins(wide, rows, layers.columns),
        fast=_bins(wide, int(edges.size > 1), edges=edges),
        sides=_bins(wide - 2.0 * low, 1, columns, low, kind=kind),
        speeds=np.zeros(edges.size - 1),
        layers=np.zeros(5 * rows),
        virial=np.zeros(rows),
        running=np.zeros(0 if discs is None else 3),
        mixture=_mixture(mixing, setup.frame),
        water=_hygrometer(prepared, setup),
        flow=_wind(setup),
    )


def _bins(
    width: float, rows: int = 1, columns: int = 1, low: float = 0.0, *, kind: Any = _ALIKE, edges: Any = _ANY_SPEED
) -> Bins:
    """Return bins of molecules; a scene without an instrument that needs them has no row, or no column, of them."""
    number = rows * columns * max(edges.size - 1, 1) * (2 if kind.size else 1)
    return Bins(kind, rows, columns, low, width, edges, np.zeros((number, len(Sum))))


def _wind(setup: Setup) -> Any:
    """Return the data of the wind; empty arrays in a scene that does not measure it, 0 if no kernel can."""
    flow, parcel = instrument_of(setup, Flow) or Flow(0, 0, 0), setup.parcel
    if not can_flow(parcel.arrays().modes):  # type: ignore[attr-defined]
        return 0
    rows, columns = flow.shape
    lapse, dense = np.zeros(2), 1.0
    high, across = modes_of_flow(rows, columns, periodic=parcel.periodic[0])
    if rows:
        gas = law.Gas(2 if parcel.planar else 3, float(parcel.diameter[0]))
        dense = law.FREEZING_PACKING_FRACTION_DISCS / float(law.packing_fraction_discs(1.0, gas.diameter))
        lapse = np.array(law.adiabatic_lapse_rate(gas, np.linspace(0.0, dense, _DENSITIES), 1.0))
    return Wind(
        sums=np.zeros((3, rows * columns)),
        frames=np.zeros(1),
        high=high,
        wave=np.concatenate(across),
        column=np.zeros((2, columns)),
        wind=np.zeros((2, rows * columns)),
        lapse=lapse,
        dense=dense,
        adiabat=np.full(rows, math.nan),
    )


def _mixture(mixing: Mixing, frame: float) -> Mixture:
    """Return the data of two gases that mix; empty arrays in a scene without them."""
    number, shape = len(mixing.moments) * mixing.bins, (len(mixing.moments), 2, mixing.bins)
    known = np.array([expected_share(mixing.bins, MOMENTS[name]) for name in mixing.moments]).reshape(shape)
    return Mixture(
        moments=np.array(list(mixing.moments.values()), float),
        frame=frame,
        off=np.full(len(known), math.inf),
        expected=known[:, 0].flatten(),
        scatter=known[:, 1].flatten(),
        mean=np.full(number, math.nan),
        error=np.full(number, math.nan),
    )


def average(summed: int, number: int, frames: int) -> Average:
    """Return averages of ``number`` quantities from ``summed`` sums, in blocks of some frames."""
    state = np.array([0, 0, frames, frames])
    return Average(np.zeros((BLOCKS + 2, summed)), state, np.full(number, np.nan), np.full(number, np.nan))


def _hygrometer(prepared: Prepared, setup: Setup) -> Any:
    """Return the data of the instruments for the water of a box; 0 if it has none."""
    parcel: Any = setup.parcel
    arrays = parcel.arrays()
    if not arrays.modes.phases:
        return 0
    scale, substance, lift = setup.scale, arrays.substance, instrument_of(setup, MoistLift)
    binding = float(substance.binding_energy)
    way: dict[str, Any] = dict.fromkeys(("moment", "planned", "log_pressure", "level", "around"), np.zeros(0))
    way["adiabat"] = np.zeros((0, 0))
    if lift is not None:
        rains = arrays.book.moisture.reservoir.rain > 0.0
        way |= _adiabat_with_rain(prepared, setup, lift) if rains else _adiabat(setup, lift)
        way |= _environment(prepared, setup, lift)
    leaving = _leaving(setup)
    return Hygrometer(
        before=np.zeros(2),
        met=np.zeros(4),
        contact=np.array(CONTACT_SERIES.coef),
        # the volatility that the substance holds is rounded to about nine digits
        volatility=float(law.saturation_vapor_pressure(scale.temperature)) / scale.pressure * math.exp(binding),
        power=float(substance.vapour_heat_capacity - substance.heat_capacity),
        binding=binding,
        critical=HIGHEST_SATURATED / scale.temperature,
        mass=float(substance.mass),
        mean=np.full(leaving["width"].size, math.nan),
        error=np.full(leaving["width"].size, math.nan),
        **way,
        **leaving,
    )


def _levels(setup: Setup, lift: MoistLift) -> Any:
    """Return falling logarithms of pressure [Pa] over the whole range that a parcel may reach."""
    ends = np.log(pressures(lift, np.linspace(0.0, setup.duration * setup.scale.time, _WAY)))
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
    around = pressures(lift, shares * setup.duration * setup.scale.time)
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
        return {}
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


def crowd(setup: Setup) -> Crowd:
    """Return the data of the drops at the start, without any drop."""
    parcel: Any = setup.parcel
    clusters = instrument_of(setup, Clusters) or Clusters(0)
    wells, drop, size = (np.zeros(parcel.number, np.int64) for _ in range(3))
    return Crowd(
        members=clusters.molecules, wells=wells, drop=drop, size=size, liquid=clusters.liquid, virial=np.zeros(1),
        gas_law=_gas_law(), full_depth=parcel.arrays().full_depth, strength=np.array([parcel.strength]),
        work=np.zeros(1),
    )  # fmt: skip


def _gas_law() -> NDArray[np.float64]:
    """Return the coefficients of B2 and B3, which are polynomials in x = e^(1 / T*) - 1, from theory at four x.

    >>> x = np.expm1(1.0 / 1.3)
    >>> second, third = (float(row @ x ** np.arange(4)) for row in _gas_law())
    >>> bool(abs(second / law.square_well_second_virial(1.3) - 1.0) < 1e-12)
    True
    """
    x = np.array([0.25, 0.5, 1.0, 2.0])
    warmth = 1.0 / np.log1p(x)
    told = np.stack([law.square_well_second_virial(warmth), law.square_well_third_virial(warmth)])
    return np.ascontiguousarray(np.linalg.solve(np.vander(x, _POWERS, increasing=True), told.T).T)

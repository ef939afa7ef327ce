"""The part of the plan of a page that is about water: readings, and the curves of theory."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.lab.box import LabBox
from atmosbox.lab.moist_box import bins_of, finer_at_kinks, theory_at
from atmosbox.lab.stage import plain
from atmosbox.scene.conversion import to_si
from atmosbox.scene.instruments import Leaving, MoistLift, Nuclei
from atmosbox.simulation.preparation import Prepared

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.scene.knob import Knob
    from atmosbox.scene.setup import Setup

WET_STATE = tuple(
    f"book.moisture.reservoir.{name}" for name in ("energy", "count", "clock", "bound", "absent", "top", "spectrum")
)
"""The arrays that are equal, to the last bit, if the liquid of two boxes is in the same state."""
DROP_STATE = (
    "gas.kinds.table",
    *(f"book.moisture.drops.{name}" for name in ("held", "cube", "core", "alive", "solute")),
)
"""The arrays that are equal if the drops of two boxes are in the same state."""

_POINTS = 121
_WARMEST, _COLDEST, _WARMTHS = 350.0, 240.0, 45
_WAY = 401
_WIDER = 1.25


def absent_readings(box: LabBox) -> set[str]:
    """Return the variables of the water that its instruments measure in other scenes, but not in this one."""
    moisture, water = box.book.moisture, box.gauges.water
    absent = set() if moisture.reservoir.rain > 0.0 else {"rain_mixing_ratio"}
    absent |= set() if water.level.size else {"parcel_buoyancy"}  # type: ignore[union-attr]
    if box.modes.drops:
        salted = moisture.drops.solute > 0.0
        absent |= set() if salted.any() else {"salted_drop_radius"}
        absent |= {"pure_drop_radius"} if salted.all() else set()
    return absent


def fixed_axes(box: LabBox) -> dict[str, Any]:
    """Return the middles of the bins of that histogram [J], and the radii of drops at which theory is drawn [m]."""
    leaving, nuclei = _instrument(box.setup, Leaving), _instrument(box.setup, Nuclei)
    found = {} if leaving is None else {"energy": plain(bins_of(box.setup, leaving).mean(axis=1))}
    return found if nuclei is None else found | {"radius": plain(nuclei.radius)}


def planned_alone(box: LabBox) -> list[str]:
    """Return the curves of theory that hold only on the planned ascent: if it rains, those that depend on the loss."""
    if not box.modes.phases or _instrument(box.setup, MoistLift) is None or not box.book.moisture.reservoir.rain > 0.0:
        return []
    mixing = [f"{name}_mixing_ratio_theory" for name in ("humidity", "cloud_liquid_water", "rain")]
    return ["adiabat_temperature", *mixing]


def moist_tables(prepared: Prepared, setup: Setup, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return the curves of theory of a scene with water: see `theory_table.tables`."""
    lift = _instrument(setup, MoistLift)
    if lift is not None:
        return _way(prepared, setup, lift, found)
    knob = next(knob for knob in setup.knobs if knob.name == "temperature")
    tables = [_walls(prepared, found, knob)]
    return tables if _instrument(setup, Leaving) is None else [*tables, _energies(prepared, found)]


def _walls(prepared: Prepared, found: xr.Dataset, knob: Knob) -> dict[str, Any]:
    """Return the curves of theory by the temperature of the walls, and for walls without a temperature."""
    kelvin = np.linspace(to_si(knob.low, knob.unit), to_si(knob.high, knob.unit), _POINTS)
    here = found.isel(elapsed_time=np.zeros(_POINTS, int))

    def at(warmth: Any) -> dict[str, Any]:
        walls = (("elapsed_time", "wall"), np.repeat(np.asarray(warmth)[:, None], here.sizes["wall"], axis=1))
        told = prepared.module.theory(here.assign(wall_temperature=walls), prepared.settings)
        return {name: values for name, values in told.items() if np.shape(values) == (_POINTS,)}

    of_walls = at(kelvin)
    if "liquid_saturation_vapor_pressure" in of_walls:  # belongs to the pool, whose temperature is measured
        del of_walls["liquid_saturation_vapor_pressure"]
    table = {"along": "wall_temperature[x_low]", "grid": plain(kelvin), "curves": {}}
    table["curves"] = {name: plain(values) for name, values in of_walls.items()}
    if knob.leave is not None:
        smooth = at(np.full(_POINTS, math.nan))
        table["otherwise"] = {name: plain(smooth[name])[0] for name in of_walls}
        table["times"] = {"condensation_rate_theory": "pool_open_share"}
    return table


def _energies(prepared: Prepared, found: xr.Dataset) -> dict[str, Any]:
    """Return the energy distributions of molecules that leave and that stay, by the temperature of the liquid."""
    grid = np.linspace(_COLDEST, _WARMEST, _WARMTHS)
    curves: dict[str, list[Any]] = {}
    ones = np.ones(found.sizes["elapsed_time"])
    for kelvin in grid:
        here = found.assign(liquid_temperature=("elapsed_time", kelvin * ones), evaporation_rate=("elapsed_time", ones))
        for name, values in prepared.module.theory(here, prepared.settings).items():
            if np.shape(values) == found.energy.shape:
                curves.setdefault(name, []).append(plain(values))
    return {"along": "temperature_of_those_that_left", "grid": plain(grid), "curves": curves}


def _way(prepared: Prepared, setup: Setup, lift: MoistLift, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return the environment along the ascent, and the curves of theory by the pressure of the parcel."""
    frames = (np.arange(setup.frames) + 0.5) * setup.frame
    moments = np.union1d(np.linspace(0.0, setup.duration, _WAY), frames)
    around, unit = lift.environment, setup.scale.time
    seconds = (moments * unit).tolist()
    outside = np.array([around.pressure(t) for t in seconds])
    curves = {
        "parcel_height": plain([around.height(t) for t in seconds]),
        "environment_temperature": plain([around.temperature(t) for t in seconds]),
        "environment_pressure": plain(outside),
    }
    middle = np.array([around.pressure(t) for t in (frames * unit).tolist()])
    spread = {
        "along": "moment",
        "grid": plain(frames),
        "curves": {"parcel_temperature_se": plain(lift.scatter(middle))},
        "times": {"parcel_temperature_se": "parcel_temperature"},
    }
    rains = "rain_mixing_ratio" in found
    # if it rains, theory is slow, and the only curve by pressure alone is straight
    levels = np.geomspace(_WIDER * outside.max(), outside.min() / _WIDER, _WAY // 2 if rains else 2 * _WAY - 1)
    if not rains:
        levels = finer_at_kinks(levels, theory_at(prepared, levels)["cloud_liquid_water_mixing_ratio_theory"])
    by_pressure = theory_at(prepared, levels)
    if any(name.startswith("environment_") for name in by_pressure):
        told = theory_at(prepared, outside)
        curves |= {name: plain(values) for name, values in told.items() if name.startswith("environment_")}
    known = [name for name in by_pressure if not name.startswith(("environment_", "parcel_", "relative_humidity"))]
    tables = [{"along": "moment", "grid": plain(moments), "curves": curves}, spread]
    if rains:  # the water that has rained out, and that which is left, depend on the ascent
        planned = theory_at(prepared, middle, rains=True)
        along = {name: plain(values) for name, values in planned.items() if "mixing_ratio" in name}
        tables.append({"along": "moment", "grid": plain(frames), "curves": along})
        known = ["dry_air_adiabat_temperature"]
    falling = {name: plain(by_pressure[name][::-1]) for name in known}
    return [*tables, {"along": "parcel_pressure", "grid": plain(levels[::-1]), "curves": falling}]


def _instrument(setup: Setup, kind: type) -> Any:
    return next((each for each in setup.instruments if type(each) is kind), None)

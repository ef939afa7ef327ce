"""Tables of the curves of theory, which a page cannot evaluate, and the planned ascent of a parcel on its graphs."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine import StalledError
from atmosbox.errors import EngineError, Setting, SettingError
from atmosbox.lab.stage import instrument_of, shown
from atmosbox.lab.wasm_module import elsewhere
from atmosbox.page.panel import plain
from atmosbox.scene.conversion import to_si
from atmosbox.scene.instruments import Leaving, Lift, MoistLift
from atmosbox.simulation.preparation import Prepared, build
from atmosbox.simulation.recording import Recording

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.scene.knob import Knob
    from atmosbox.scene.setup import Setup

_FRAMES = 3
_POINTS = 121
"""Number of values in a table along a knob, or along the time after a run."""
_LONG = 20.0
"""Theory is tabulated for this many times the length of a run, because the page goes on."""
_WAY = 401
"""Number of values in a table along the ascent of a parcel."""
_WARMEST, _COLDEST, _WARMTHS = 350.0, 240.0, 45
_WIDER = 1.25
_KINK, _STRAIGHT = 8.0, 1e-9
"""Second difference of a curve at a kink, over the median one; and share of the largest below which it is straight."""
_PLACES = 60
_TIME = "elapsed_time"
_KNOWN = ("environment", "reference")
"""Roles of the curves that are drawn from the start: the air around the parcel, and what it is compared with."""

Array = NDArray[np.float64]


def short_run(prepared: Prepared) -> xr.Dataset:
    """Return the measurements after three frames, as input for the scene's theory.

    A scene is refused if the engine cannot go on, or if its modes change in these frames, because too many molecules
    crowd together for a page.
    """
    setup = build(prepared)
    parcel: Any = setup.parcel
    modes = parcel.arrays().modes
    run = Recording(prepared, setup, {"atmosbox_parameters": json.dumps(prepared.parameters)})
    try:
        for _ in range(_FRAMES):
            run.advance(lambda passed: None)
    except StalledError as error:
        raise EngineError(f"The box of {prepared.scene} cannot begin: {error}.") from error
    if parcel.arrays().modes != modes:
        raise SettingError(
            "scene", prepared.scene,
            "has so many molecules in one place that the memory of the page is too small for them",
            "give it fewer molecules, let it begin in equilibrium (in atmosphere: ",
            Setting("start", "equilibrium"), "), or ", *elsewhere(prepared.scene)
        )  # fmt: skip
    found, _ = run.dataset("lab", settle=0, judged=False)
    return found


def tables(prepared: Prepared, setup: Setup, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return the curves of theory as functions of a measured variable or of a knob, from the result of `short_run`.

    In each, ``along`` is the variable that the table is a function of, divided by the variable ``over`` if there is
    one; ``grid`` has its values, and ``curves`` the values of each curve at these; the page interpolates linearly.
    ``otherwise`` has the values of curves while the variable is not known, and ``times`` names the variable by which a
    curve is multiplied. Theory predicts that the air has the temperature of the walls:

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> scene = prepare("temperature", {"molecules": 20})
    >>> (warmth,) = tables(scene, build(scene), short_run(scene))
    >>> warmth["along"], warmth["curves"]["air_temperature_theory"] == warmth["grid"]
    ('wall_temperature[z_low]', True)
    """
    lift, moist_lift = (instrument_of(setup, kind) for kind in (Lift, MoistLift))
    if moist_lift is not None:
        return _moist_way(prepared, setup, moist_lift, found)
    if lift is not None:
        return [_way(setup, lift, np.linspace(0.0, setup.duration, _WAY)), _adiabat(setup, lift)]
    knobs = {knob.name: knob for knob in setup.knobs}
    if "temperature" not in knobs or hasattr(setup.parcel, "drops"):
        return _course(prepared, setup, found)
    if "gravity" in knobs:
        return [_column(prepared, found, knobs["temperature"], knobs["gravity"])]
    if not hasattr(setup.parcel, "vapour"):
        return [_walls(prepared, found, knobs["temperature"])]
    table = _moist_walls(prepared, found, knobs["temperature"])
    return [table] if instrument_of(setup, Leaving) is None else [table, _energies(prepared, found)]


def _course(prepared: Prepared, setup: Setup, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return the curves of theory as functions of time, at each frame of a run and long after."""
    told = _told(prepared, found)
    if any(_is_series(values, found) and np.ptp(values) > 0.0 for values in told.values()):
        run = np.arange(1, setup.frames + 1) * float(found.elapsed_time[0])
        times = np.concatenate([run, run[-1] * np.geomspace(1.0, _LONG, _POINTS)[1:]])
        found = found.drop_dims("elapsed_time").assign_coords(elapsed_time=times)
        told = _told(prepared, found)
    series = {name: plain(values) for name, values in told.items() if _is_series(values, found)}
    rest = {name: [plain(values)] for name, values in told.items() if name not in series}
    return [_table(_TIME, found.elapsed_time.values, series), _table(_TIME, 0.0, rest)]


def _walls(prepared: Prepared, found: xr.Dataset, knob: Knob) -> dict[str, Any]:
    """Return the curves of theory as functions of the temperature of the walls."""
    grid, walls = _range(knob), found.wall_temperature
    rows = [_told(prepared, found, wall_temperature=walls.where(walls.isnull(), kelvin)) for kelvin in grid.tolist()]
    curves = {name: [_last(row[name], found) for row in rows] for name in rows[0]}
    return _table("wall_temperature[z_low]", grid, curves)


def _moist_walls(prepared: Prepared, found: xr.Dataset, knob: Knob) -> dict[str, Any]:
    """Return the same of a box with water, without profiles; its walls may also have no temperature."""
    kelvin = np.append(_range(knob), [] if knob.leave is None else [math.nan])
    here = found.isel(elapsed_time=np.zeros(kelvin.size, int))
    walls = np.repeat(kelvin[:, None], here.sizes["wall"], axis=1)
    told = _told(prepared, here, wall_temperature=((_TIME, "wall"), walls))
    told.pop("liquid_saturation_vapor_pressure", None)  # belongs to the pool, whose temperature is measured
    series = {name: plain(values) for name, values in told.items() if _is_series(values, here)}
    curves = {name: values[:_POINTS] for name, values in series.items()}
    left = {name: values[-1] for name, values in series.items()}
    more = {"otherwise": left, "times": {"condensation_rate_theory": "pool_open_share"}}
    return _table("wall_temperature[x_low]", kelvin[:_POINTS], curves, **({} if knob.leave is None else more))


def _range(knob: Knob) -> Array:
    """Return the values of a knob at which theory is tabulated [K]."""
    return np.linspace(to_si(knob.low, knob.unit), to_si(knob.high, knob.unit), _POINTS)


def _column(prepared: Prepared, found: xr.Dataset, knob: Knob, pull: Knob) -> dict[str, Any]:
    """Return the curves of theory of a column at rest as functions of the temperature of its floor over gravity.

    Hard molecules have no energy of their own to compare kT with. So, at the same ratio, a profile does not depend on
    gravity, or is in proportion to it, as pressure and temperature are.
    """
    usual, least, most = (to_si(gravity, pull.unit) for gravity in (pull.value, pull.low, pull.high))
    cold, warm = (to_si(temperature, knob.unit) for temperature in (knob.low, knob.high))
    grid = np.geomspace(cold / most, warm / least, _POINTS)

    def told(ratio: float, gravity: float) -> dict[str, Any]:
        walls = found.wall_temperature.where(found.wall_temperature.isnull(), ratio * gravity)
        return _told(prepared, found, gravity=0.0 * found.elapsed_time + gravity, wall_temperature=walls)

    rows = [told(ratio, usual) for ratio in grid.tolist()]
    double = told(grid[0], 2.0 * usual)
    grows = {name for name, values in rows[0].items() if np.allclose(double[name], 2.0 * np.asarray(values))}
    curves = {name: [_last(row[name] / (usual if name in grows else 1.0), found) for row in rows] for name in rows[0]}
    times = dict.fromkeys(sorted(grows), "gravity")
    return _table("wall_temperature[z_low]", grid, curves, over="gravity", times=times)


def _told(prepared: Prepared, found: xr.Dataset, **changed: Any) -> dict[str, Any]:
    """Return the curves of theory for these measurements, with some variables changed."""
    return dict(prepared.module.theory(found.assign(changed), prepared.settings))


def _table(along: str, grid: ArrayLike, curves: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return a table of curves with the values of the variable that it is a function of."""
    return {"along": along, "grid": plain(grid), "curves": curves, **more}


def pressures(lift: Lift | MoistLift, seconds: Any) -> Array:
    """Return the pressure of the environment at moments of the planned ascent [s]."""
    return np.array([lift.environment.pressure(t) for t in seconds.tolist()])


def _last(values: Any, found: xr.Dataset) -> Any:
    """Return a profile of theory, or the last value of a series, as JSON can hold it."""
    return plain(values[-1:])[0] if _is_series(values, found) else plain(values)


def _is_series(values: Any, found: xr.Dataset) -> bool:
    return bool(np.shape(values) == (found.sizes["elapsed_time"],))


def _way(setup: Setup, lift: Lift | MoistLift, moments: Array) -> dict[str, Any]:
    """Return height, pressure and temperature of the environment at moments of the planned ascent."""
    around, seconds = lift.environment, (moments * setup.scale.time).tolist()
    curves = {
        "parcel_height": plain([around.height(t) for t in seconds]),
        "environment_temperature": plain([around.temperature(t) for t in seconds]),
        "environment_pressure": plain([around.pressure(t) for t in seconds]),
    }
    return _table("moment", moments, curves)


def _adiabat(setup: Setup, lift: Lift) -> dict[str, Any]:
    """Return the temperature of the adiabat at each pressure that the parcel may reach."""
    ends = pressures(lift, np.linspace(0.0, setup.duration, _WAY) * setup.scale.time)
    levels = np.array(plain(np.geomspace(0.8 * ends.min(), 1.25 * ends.max(), _WAY)), np.float64)
    curve = plain([lift.environment.adiabat(p) for p in levels.tolist()])
    return _table("parcel_pressure", levels, {"adiabat_temperature": curve})


def _energies(prepared: Prepared, found: xr.Dataset) -> dict[str, Any]:
    """Return the energy distributions of molecules that leave and that stay, by the temperature of the liquid."""
    grid, ones = np.linspace(_COLDEST, _WARMEST, _WARMTHS), found.elapsed_time * 0.0 + 1.0
    rows = [_told(prepared, found, liquid_temperature=kelvin * ones, evaporation_rate=ones) for kelvin in grid]
    names = [name for name, values in rows[0].items() if np.shape(values) == found.energy.shape]
    curves = {name: [plain(row[name]) for row in rows] for name in names}
    return _table("temperature_of_those_that_left", grid, curves)


def _moist_way(prepared: Prepared, setup: Setup, lift: MoistLift, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return the environment along the ascent, and the curves of theory by the pressure of the parcel."""
    frames = (np.arange(setup.frames) + 0.5) * setup.frame
    moments = np.union1d(np.linspace(0.0, setup.duration, _WAY), frames)
    outside, middle = (pressures(lift, each * setup.scale.time) for each in (moments, frames))
    way = _way(setup, lift, moments)
    scatter, times = plain(lift.scatter(middle)), {"parcel_temperature_se": "parcel_temperature"}
    tables = [way, _table("moment", frames, {"parcel_temperature_se": scatter}, times=times)]
    rains = "rain_mixing_ratio" in found
    # if it rains, theory is slow, and the only curve by pressure alone is straight
    levels = np.geomspace(_WIDER * outside.max(), outside.min() / _WIDER, _WAY // 2 if rains else 2 * _WAY - 1)
    if not rains:
        levels = finer_at_kinks(levels, theory_at(prepared, levels)["cloud_liquid_water_mixing_ratio_theory"])
    by_pressure = theory_at(prepared, levels)
    if any(name.startswith("environment_") for name in by_pressure):
        told = theory_at(prepared, outside)
        way["curves"] |= {name: plain(values) for name, values in told.items() if name.startswith("environment_")}
    known = [name for name in by_pressure if not name.startswith(("environment_", "parcel_", "relative_humidity"))]
    if rains:  # the water that has rained out, and that which is left, depend on the ascent
        planned = theory_at(prepared, middle, rains=True)
        water = {name: plain(values) for name, values in planned.items() if "mixing_ratio" in name}
        tables.append(_table("moment", frames, water))
        known = ["dry_air_adiabat_temperature"]
    falling = {name: plain(by_pressure[name][::-1]) for name in known}
    return [*tables, _table("parcel_pressure", levels[::-1], falling)]


def theory_at(prepared: Prepared, pressure: Any, *, rains: bool = False) -> dict[str, Any]:
    """Return the curves of theory for a parcel and its environment at these pressures [Pa].

    Theory gets arbitrary values of the parcel's temperature and water, so curves that depend on these mean nothing.
    """
    import xarray as xr  # loads slowly

    water = ("humidity_mixing_ratio", "cloud_liquid_water_mixing_ratio", "rain_mixing_ratio")[: 3 if rains else 2]
    none = 0.0 * pressure
    series = {"parcel_pressure": pressure, "environment_pressure": pressure, "parcel_temperature": 280.0 + none}
    series |= dict.fromkeys(water, none)
    told = _told(prepared, xr.Dataset({name: (_TIME, values) for name, values in series.items()}))
    return {name: values for name, values in told.items() if np.shape(values) == pressure.shape}


def finer_at_kinks(levels: Any, curve: Any, times: int = 64) -> Any:
    """Return levels that are `times` closer together at the kinks of a curve, which linear interpolation would cut off.

    The curve of a parcel has a kink where the cloud begins, the curve of a sounding at each of its levels.

    >>> levels = np.linspace(0.0, 1.0, 11)
    >>> finer = finer_at_kinks(levels, np.where(levels < 0.45, levels**2, 2.0 * levels))
    >>> finer.size, [round(float(each), 3) for each in finer[:4]]
    (200, [0.0, 0.1, 0.2, 0.3])
    """
    bent = np.abs(np.diff(curve, 2))
    usual = np.median(bent[bent > _STRAIGHT * bent.max()])
    is_sharp = bent > _KINK * usual
    is_near = np.append(is_sharp, False) | np.append(False, is_sharp)
    pieces = [
        np.linspace(low, high, times + 1)[:-1] if near else [low]
        for low, high, near in zip(levels[:-1], levels[1:], is_near, strict=True)
    ]
    return np.concatenate([*pieces, levels[-1:]])


def show_plan(panels: Sequence[dict[str, Any]], tables: Sequence[Mapping[str, Any]], unit: float) -> None:
    """Add to the graphs of a page what is known of an ascent beforehand, from the curves of theory, see `tables`.

    Each graph gets ``planned``, the points that its axes must include; a curve against height or pressure that is known
    beforehand gets all its points, and a picture of the parcel its path, as heights at moments of the ascent. ``unit``
    is that of the moments, in that of the elapsed time.
    """
    way = _ascent(tables, unit)
    for panel in panels:
        panel["planned"] = {"x": [], "y": []}
        for line in panel["lines"]:
            points = {axis: plain(shown(way.get(line[axis]["name"], ()), line[axis]), 5) for axis in ("x", "y")}
            if not (points["x"] and points["y"]):
                continue
            for axis, values in points.items():
                panel["planned"][axis] += values
            if panel["kind"] == "atmosphere":
                line["planned"] = {"moment": plain(way["moment"], 5), "y": points["y"]}
            elif panel["across"] and line["role"] in _KNOWN:
                line["planned"] = points


def _ascent(tables: Sequence[Mapping[str, Any]], unit: float) -> dict[str, Array]:
    """Return the curves of theory along the planned ascent by their names [SI]; empty for another box."""
    around = next((table for table in tables if "environment_pressure" in table["curves"]), None)
    if around is None:
        return {}
    moments = np.linspace(0.0, around["grid"][-1], _PLACES)
    pressure = _between(around, "environment_pressure", moments)
    along = {"moment": moments, "parcel_pressure": pressure}
    found = {
        name: _between(table, name, along[table["along"]])
        for table in tables
        if table["along"] in along and "times" not in table
        for name in table["curves"]
    }
    way = {**along, **found, _TIME: moments * unit}
    return {name: values for name, values in way.items() if np.isfinite(values).all()}


def _between(table: Mapping[str, Any], name: str, places: Array) -> Any:
    """Return values of a curve of a table, as the page interpolates them."""
    return np.interp(places, np.array(table["grid"], float), np.array(table["curves"][name], float))

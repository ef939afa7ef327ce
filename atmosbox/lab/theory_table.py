"""Tables of the curves of theory, which a page cannot evaluate, and the planned ascent of a parcel on its graphs."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import StalledError
from atmosbox.errors import EngineError, Setting, SettingError
from atmosbox.lab.moist_plan import moist_tables
from atmosbox.lab.stage import plain
from atmosbox.lab.wasm_module import elsewhere
from atmosbox.scene.conversion import to_si
from atmosbox.scene.instruments import Lift
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


def short_run(prepared: Prepared) -> xr.Dataset:
    """Return the measurements after three frames, as input for the scene's theory.

    Raises
    ------
    EngineError
        If the engine cannot go on.
    SettingError
        If the modes of the engine change in these frames, because too many molecules crowd together for a page.
    """
    setup = build(prepared)
    parcel: Any = setup.parcel
    modes, run = (
        parcel.arrays().modes,
        Recording(prepared, setup, {"atmosbox_parameters": json.dumps(prepared.parameters)}),
    )
    try:
        for _ in range(_FRAMES):
            run.advance(lambda passed: None)
    except StalledError as error:
        raise EngineError(f"The box of {prepared.scene} cannot begin: {error}.") from error
    if parcel.arrays().modes != modes:
        raise SettingError(
            "scene",
            prepared.scene,
            "crowds so many molecules together that the page runs out of room for them",
            "give it fewer molecules, begin it where it comes to rest, as atmosphere with ",
            Setting("start", "equilibrium"),
            ", or ",
            *elsewhere(prepared.scene),
        )
    found, _ = run.dataset("lab", settle=0, judged=False)
    return found


def tables(prepared: Prepared, setup: Setup, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return the curves of theory as functions of a measured variable or of a knob.

    Parameters
    ----------
    prepared, setup
        The scene and its box.
    found
        The measurements of `short_run`.

    Returns
    -------
    list of dict
        ``along`` is the variable that the table is a function of, divided by the variable ``over`` if there is one;
        ``grid`` has its values, and ``curves`` the values of each curve at these; the page interpolates linearly.
        ``otherwise`` has the values of curves while the variable is not known, and ``times`` names the variable by
        which a curve is multiplied.

    Examples
    --------
    Theory predicts that the air has the temperature of the walls:

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> scene = prepare("temperature", {"molecules": 20})
    >>> (warmth,) = tables(scene, build(scene), short_run(scene))
    >>> warmth["along"], warmth["curves"]["air_temperature_theory"] == warmth["grid"]
    ('wall_temperature[z_low]', True)
    """
    if hasattr(setup.parcel, "vapour") and not hasattr(setup.parcel, "drops"):
        return moist_tables(prepared, setup, found)
    lift = next((each for each in setup.instruments if isinstance(each, Lift)), None)
    if lift is not None:
        return [_way(setup, lift), _adiabat(setup, lift)]
    knobs = {knob.name: knob for knob in setup.knobs}
    if "temperature" not in knobs:
        return _course(prepared, setup, found)
    if "gravity" in knobs:
        return [_column(prepared, found, knobs["temperature"], knobs["gravity"])]
    return [_walls(prepared, found, knobs["temperature"])]


def _course(prepared: Prepared, setup: Setup, found: xr.Dataset) -> list[dict[str, Any]]:
    """Return the curves of theory as functions of time, at each frame of a run and long after."""
    told = prepared.module.theory(found, prepared.settings)
    if any(_is_series(values, found) and np.ptp(values) > 0.0 for values in told.values()):
        run = np.arange(1, setup.frames + 1) * float(found.elapsed_time[0])
        times = np.concatenate([run, run[-1] * np.geomspace(1.0, _LONG, _POINTS)[1:]])
        found = found.drop_dims("elapsed_time").assign_coords(elapsed_time=times)
        told = prepared.module.theory(found, prepared.settings)
    series = {name: plain(values) for name, values in told.items() if _is_series(values, found)}
    rest = {name: [plain(values)] for name, values in told.items() if name not in series}
    return [
        {"along": "elapsed_time", "grid": plain(found.elapsed_time.values), "curves": series},
        {"along": "elapsed_time", "grid": [0.0], "curves": rest},
    ]


def _walls(prepared: Prepared, found: xr.Dataset, knob: Knob) -> dict[str, Any]:
    """Return the curves of theory as functions of the temperature of the walls."""
    grid = np.linspace(to_si(knob.low, knob.unit), to_si(knob.high, knob.unit), _POINTS).tolist()
    curves: dict[str, list[Any]] = {}
    for kelvin in grid:
        here = found.assign(wall_temperature=found.wall_temperature.where(found.wall_temperature.isnull(), kelvin))
        for name, values in prepared.module.theory(here, prepared.settings).items():
            curves.setdefault(name, []).append(_last(values, found))
    return {"along": "wall_temperature[z_low]", "grid": plain(grid), "curves": curves}


def _column(prepared: Prepared, found: xr.Dataset, knob: Knob, pull: Knob) -> dict[str, Any]:
    """Return the curves of theory of a column at rest as functions of the temperature of its floor over gravity.

    Hard molecules have no energy of their own to compare kT with. So, at the same ratio, a profile does not depend on
    gravity, or is in proportion to it, as pressure and temperature are.
    """
    usual, least, most = (to_si(gravity, pull.unit) for gravity in (pull.value, pull.low, pull.high))
    cold, warm = (to_si(temperature, knob.unit) for temperature in (knob.low, knob.high))
    grid = np.geomspace(cold / most, warm / least, _POINTS)

    def told(ratio: float, gravity: float) -> dict[str, Any]:
        here = found.assign(gravity=0.0 * found.elapsed_time + gravity)
        here["wall_temperature"] = found.wall_temperature.where(found.wall_temperature.isnull(), ratio * gravity)
        return dict(prepared.module.theory(here, prepared.settings))

    rows = [told(ratio, usual) for ratio in grid.tolist()]
    double = told(grid[0], 2.0 * usual)
    grows = {name for name, values in rows[0].items() if np.allclose(double[name], 2.0 * np.asarray(values))}
    per = {name: usual if name in grows else 1.0 for name in rows[0]}
    curves = {name: [_last(row[name] / each, found) for row in rows] for name, each in per.items()}
    times = dict.fromkeys(sorted(grows), "gravity")
    return {
        "along": "wall_temperature[z_low]",
        "over": "gravity",
        "grid": plain(grid),
        "curves": curves,
        "times": times,
    }


def _last(values: Any, found: xr.Dataset) -> Any:
    """Return a profile of theory, or the last value of a series, as JSON can hold it."""
    return plain(values[-1:])[0] if _is_series(values, found) else plain(values)


def _is_series(values: Any, found: xr.Dataset) -> bool:
    return bool(np.shape(values) == (found.sizes["elapsed_time"],))


def _way(setup: Setup, lift: Lift) -> dict[str, Any]:
    """Return height, pressure and temperature of the environment at each moment of the planned ascent."""
    moments = np.linspace(0.0, setup.duration, _WAY)
    around, seconds = lift.environment, (moments * setup.scale.time).tolist()
    curves = {
        "parcel_height": plain([around.height(t) for t in seconds]),
        "environment_temperature": plain([around.temperature(t) for t in seconds]),
        "environment_pressure": plain([around.pressure(t) for t in seconds]),
    }
    return {"along": "moment", "grid": plain(moments), "curves": curves}


def _adiabat(setup: Setup, lift: Lift) -> dict[str, Any]:
    """Return the temperature of the adiabat at each pressure that the parcel may reach."""
    around = lift.environment
    ends = [around.pressure(t * setup.scale.time) for t in np.linspace(0.0, setup.duration, _WAY)]
    pressures = plain(np.geomspace(0.8 * min(ends), 1.25 * max(ends), _WAY))
    curve = plain([around.adiabat(p) for p in pressures if p is not None])
    return {"along": "parcel_pressure", "grid": pressures, "curves": {"adiabat_temperature": curve}}


_PLACES = 60
_TIME = "elapsed_time"
_KNOWN = ("environment", "reference")
"""Roles of the curves that are drawn from the start: the air around the parcel, and what it is compared with."""

Array = NDArray[np.float64]


def show_plan(panels: Sequence[dict[str, Any]], tables: Sequence[Mapping[str, Any]], unit: float) -> None:
    """Add to the graphs of a page what is known of an ascent beforehand.

    Parameters
    ----------
    panels
        The graphs, as data for the page. Each gets ``planned``, the points that its axes must include; a curve against
        height or pressure that is known beforehand gets all its points, and a picture of the parcel its path, as
        heights at moments of the ascent.
    tables
        The curves of theory, see `atmosbox.lab.theory_table.tables`.
    unit
        Unit of the moments of the ascent, in that of the elapsed time.
    """
    way = _ascent(tables, unit)
    for panel in panels:
        panel["planned"] = {"x": [], "y": []}
        for line in panel["lines"]:
            points = {axis: _points(line[axis], way) for axis in ("x", "y")}
            if not (points["x"] and points["y"]):
                continue
            for axis, values in points.items():
                panel["planned"][axis] += values
            if panel["kind"] == "atmosphere":
                line["planned"] = {"moment": [float(f"{each:.5g}") for each in way["moment"]], "y": points["y"]}
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


def _between(table: Mapping[str, Any], name: str, places: Array) -> Array:
    """Return values of a curve of a table, as the page interpolates them."""
    found: Array = np.interp(places, np.array(table["grid"], float), np.array(table["curves"][name], float))
    return found


def _points(axis: Mapping[str, Any], way: Mapping[str, Array]) -> list[float]:
    """Return the values of a variable along the ascent, in the unit of its axis."""
    values = way.get(axis["name"], np.zeros(0)) * axis["factor"] + axis["offset"]
    return [float(f"{value:.5g}") for value in values]

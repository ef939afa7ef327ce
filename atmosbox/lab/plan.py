"""The plan of a page, as JSON: the addresses, units and meanings of the data in the memory of its engine."""

from __future__ import annotations

import math
import re
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.engine.core.walls import WALL_NAMES
from atmosbox.errors import Command, Option, Setting, on_command_line
from atmosbox.file.variables import known
from atmosbox.lab.box import LabBox, lab_box
from atmosbox.lab.gauges import bins_of
from atmosbox.lab.kernels.knobs import can_set_gravity
from atmosbox.lab.kernels.readings import MEASURED, Reading
from atmosbox.lab.memory_image import BASE, Image, arguments, image
from atmosbox.lab.stage import COLDER, instrument_of, lab_lesson, running_panels
from atmosbox.lab.theory_table import short_run, show_plan, tables
from atmosbox.lab.wasm_module import SCENES
from atmosbox.page import ROUND
from atmosbox.page.controls import gauges, knob_controls
from atmosbox.page.panel import declared, plain
from atmosbox.scene.conversion import declared_unit, to_si
from atmosbox.scene.instruments import MOMENTS, Air, Clusters, Leaving, MoistLift, Nuclei
from atmosbox.simulation.preparation import Prepared, link_start
from atmosbox.theory import WATER_MASS_RATIO
from atmosbox.theory.constants import BOLTZMANN, STANDARD_GRAVITY

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.scene.panels import Panel
    from atmosbox.scene.setup import Setup

STATE = ("gas.molecules", "gas.kinds.rotational_energy", "gas.tallies.count", "gas.tallies.heat", "gas.tallies.random")
"""The arrays that are equal, to the last bit, if two boxes are in the same state."""
WET_STATE = tuple(
    f"book.moisture.reservoir.{name}" for name in ("energy", "count", "clock", "bound", "absent", "top", "spectrum")
)
"""The arrays that are equal, to the last bit, if the liquid of two boxes is in the same state."""
DROP_STATE = (
    "gas.kinds.table",
    *(f"book.moisture.drops.{name}" for name in ("held", "cube", "core", "alive", "solute")),
)
"""The arrays that are equal if the drops of two boxes are in the same state."""

_SHOWN = re.compile(r"picture\.|gauges\.reading|.*\.(mean|error|adiabat|wind)")
"""The names of the arrays that the page reads, besides those of the state."""
_CROSSINGS, _SLOWLY = 4.0, 1.6
"""Times that a molecule crosses the box in a second at the usual pace, and the same where drops soon vanish."""
_WHOLE = 60.0
"""Least time that the usual pace takes for a whole run [s]."""
_SOON = 30.0
"""The same for air that turns over, so that rolls are soon seen, and the time that an ascent takes [s]."""
_TIME = "elapsed_time"
_SLOWEST = 0.15
"""Least speed of the longest arrow of the wind, in units of the thermal speed half-way between floor and ceiling."""
_FIGURES = 4
"""Significant digits of a curve that is drawn and not saved: the rounding is less than the width of a line."""
_AT_REST = "layer_temperature_conduction"
"""The temperature of air at rest between the walls of the start; it ends when a knob is turned."""


def lab_plan(prepared: Prepared) -> tuple[dict[str, Any], Image, LabBox]:
    """Return the plan of the page of a scene, the memory of its engine, and the box; refuse what cannot run in a page.

    >>> from atmosbox.simulation.preparation import prepare
    >>> plan, memory, _ = lab_plan(prepare("temperature", {"molecules": 20}))
    >>> plan["frames"], plan["size"] == memory.size, sorted(plan["knobs"])
    (1000, True, ['temperature'])
    """
    box = lab_box(prepared)
    setup, panels, stage = box.setup, running_panels(prepared), box.stage
    memory = image(arguments(box))
    state = (*STATE, *(WET_STATE if box.modes.phases else ()), *(DROP_STATE if box.modes.drops else ()))
    found, numbers = _knobs(box)
    begun = short_run(prepared)
    readings, profiles, wind = _readings(box, begun), _profiles(box), _wind(box)
    curves = [] if box.attracts else _drawn(tables(prepared, setup, begun), panels, profiles)
    unit = setup.scale.time / to_si(1.0, setup.time_unit)
    show_plan(stage.record["panels"], curves, unit)
    names, theory = [name for name, _, _ in readings], [name for table in curves for name in table["curves"]]
    units = {name: declared(name, setup.time_unit).unit for name in names + theory if known(name.partition("[")[0])}
    # how the scale of speeds follows the temperature
    scale = {"swift": box.swift, "colder": COLDER, "round": ROUND, "unit": setup.scale.velocity}
    plan = {
        "told": {
            "stage": stage.record,
            "controls": knob_controls(found),
            "settle": 0.0 if setup.ends else setup.settle * setup.frame * unit,
            "lesson": lab_lesson(prepared, {*names, *theory}, setup, stage.record["panels"]),
        },
        "base": BASE,
        "size": memory.size,
        "pieces": [[place, len(content)] for place, content in memory.pieces],
        "blocks": memory.blocks,
        "slots": {kernel: slots for kernel, slots in memory.slots.items() if slots},
        "arrays": {name: array for name, array in memory.arrays.items() if name in state or _SHOWN.match(name)},
        "state": state,
        "present": Reading["MOLECULES_IN_GAS"].value,
        "frame": setup.frame,
        "frames": setup.frames,
        "samples": setup.samples,
        "settle": 0 if setup.ends else setup.settle,
        "ends": setup.ends,
        # whether a graph draws one series against another, so that all their values are sent each time
        "whole": setup.ends or any({line.x, line.y} <= {*names} - {_TIME} for each in panels for line in each.lines),
        "rate": _rate(setup, _SOON if setup.ends or wind else _WHOLE),
        "time": unit,
        "length": setup.scale.length * stage.record["metre"],
        "fastest": stage.record["speed"]["high"],
        "scale": None if box.attracts else scale,
        "ledger": Reading["LEDGER_RESIDUAL"].value,
        "readings": readings,
        # the energy of discs on a table is not shown as a temperature
        "gauges": [] if box.gauges.running.size else gauges(prepared.settings, names),
        "profiles": profiles,
        "wind": wind,
        "fixed": _fixed(box),
        "tables": curves,
        "planned": [_AT_REST] if wind else _planned_alone(box),
        "knobs": numbers,
        "units": units,
        "command": _command(prepared),
        "link": link_start(prepared),
        "seeded": box.seeded,
        "seed": prepared.settings.seed,
    }
    return plan, memory, box


def _rate(setup: Setup, least: float) -> float:
    """Return the time of the box that passes in a second at the usual pace [reduced time].

    A molecule crosses the box `_CROSSINGS` times in a second, but the whole run lasts at least ``least`` seconds; an
    ascent lasts exactly as long.
    """
    parcel = setup.parcel
    whole = setup.duration / least
    if setup.ends or not parcel.number:
        return whole
    kT = 2.0 * parcel.energy()[0] / (3.0 * parcel.number)
    speed = math.sqrt(8.0 / math.pi * float(np.nanmax([kT, *parcel.wall_kT()])) / float(np.mean(parcel.mass)))
    sides = parcel.length[[0, 2]] if parcel.planar else parcel.length
    side = float(np.exp(np.log(sides).mean()))
    crossings = _SLOWLY if instrument_of(setup, Nuclei) else _CROSSINGS
    return min(whole, crossings * side / speed) if speed > 0.0 else whole


def _drawn(
    found: list[dict[str, Any]], panels: tuple[Panel, ...], measured: list[tuple[str, str, int, int, float]]
) -> list[dict[str, Any]]:
    """Return tables of theory without profiles that no panel draws or that kernels compute, and without empty series.

    The other profiles are rounded to `_FIGURES`. Series are not rounded, because they are saved too.
    """
    drawn = {name for panel in panels for name in panel.variables} - {name for name, *_ in measured}
    for table in found:
        table["curves"] = {
            name: [plain(row, _FIGURES) for row in rows] if isinstance(rows[0], list) else rows
            for name, rows in table["curves"].items()
            if (name in drawn if isinstance(rows[0], list) else any(value is not None for value in rows))
        }
    return found


def _readings(box: LabBox, begun: xr.Dataset) -> list[tuple[str, int, float]]:
    """Return the readings that are shown: name, index, and factor to SI units or to the unit of the page."""
    kinds, knobs = [Air, *map(type, box.setup.instruments)], {knob.name for knob in box.setup.knobs}
    names = [name for kind, measured in MEASURED.items() if kind in kinds for name in measured]
    names += ["gravity"] if "gravity" in knobs else []
    absent = _absent_readings(box, begun)
    found = [(name, Reading[name.upper()].value, _factor(name, box)) for name in names if name not in absent]
    warm = np.isfinite(box.setup.parcel.wall_kT())
    if box.modes.phases and "temperature" in knobs:
        warm[slice(*box.warmed)] = True
    first, factor = Reading["WALL_TEMPERATURE"].value, _factor("wall_temperature", box)
    walls = [(f"wall_temperature[{name}]", first + wall, factor) for wall, name in enumerate(WALL_NAMES) if warm[wall]]
    return found + walls


def _absent_readings(box: LabBox, begun: xr.Dataset) -> set[str]:
    """Return the variables that its instruments measure in other scenes, but not in this one."""
    measured = {"air_pressure": np.isfinite(begun.air_pressure.values).any()}  # needs a wall
    if box.modes.phases:
        moisture, water = box.book.moisture, box.gauges.water
        measured |= {"rain_mixing_ratio": moisture.reservoir.rain > 0.0, "parcel_buoyancy": water.level.size > 0}
    if box.modes.drops:
        salted = moisture.drops.solute > 0.0
        measured |= {"salted_drop_radius": salted.any(), "pure_drop_radius": not salted.all()}
    if box.attracts:
        theory = box.prepared.module.theory(begun, box.prepared.settings)
        measured |= {name: name in theory for name in MEASURED[Clusters] if name.endswith("_theory")}
    return {name for name, is_so in measured.items() if not is_so}


def _planned_alone(box: LabBox) -> list[str]:
    """Return the curves of theory that hold only on the planned ascent: if it rains, those that depend on the loss."""
    if instrument_of(box.setup, MoistLift) is None or not box.book.moisture.reservoir.rain > 0.0:
        return []
    mixing = [f"{name}_mixing_ratio_theory" for name in ("humidity", "cloud_liquid_water", "rain")]
    return ["adiabat_temperature", *mixing]


def _factor(name: str, box: LabBox) -> float:
    """Return the factor of a variable from the engine's units to SI units, or to the unit of the page."""
    scale, nuclei = box.setup.scale, instrument_of(box.setup, Nuclei)
    own = {
        _TIME: scale.time / to_si(1.0, box.setup.time_unit), "parcel_buoyancy": STANDARD_GRAVITY, "moment": 1.0,
        "temperature_of_those_that_left": scale.temperature,
    }  # fmt: skip
    units = {
        "K": scale.temperature, "Pa": scale.pressure, "m s-1": scale.velocity, "s m-1": 1.0 / scale.velocity,
        "m s-2": scale.acceleration, "m-3": scale.number_density, "J": scale.total_energy, "J-1": 1.0 / scale.energy,
        "s-1": scale.weight / scale.time, "kg kg-1": WATER_MASS_RATIO, "1": 1.0,
        "m": scale.length / (nuclei.width if nuclei else 1.0),  # radii are those of real drops
    }  # fmt: skip
    return own[name] if name in own else units[known(name).units]  # type: ignore[union-attr]


def _profiles(box: LabBox) -> list[tuple[str, str, int, int, float]]:
    """Return the averages that are shown: name, array, first index, number, and factor to SI units."""
    gauges, layers = box.gauges, box.gauges.virial.size
    water: Any = gauges.water
    wind: Any = gauges.flow and gauges.flow.high.size
    shown = ("number_density", "layer_temperature", "layer_pressure", "layer_wind")[: 4 if wind else 3]
    across = gauges.mixture.mean.size // len(MOMENTS)
    rows = [("speed_probability_density", "speeds", 0, gauges.speeds.size)]
    rows += [(name, "layers", place * layers, layers) for place, name in enumerate(shown)]
    rows += [(f"left_gas_share_{name}", "gauges.mixture", place * across, across) for place, name in enumerate(MOMENTS)]
    rows += [("leaving_energy_probability_density", "gauges.water", 0, water.width.size)] if water else []
    found = [
        (name + end, f"{array}.{part}", first, count, _factor(name, box))
        for name, array, first, count in rows
        for end, part in (("", "mean"), ("_se", "error"))
        if count
    ]
    if wind:
        found.append(("layer_temperature_adiabatic", "gauges.flow.adiabat", 0, layers, box.setup.scale.temperature))
    return found


def _wind(box: LabBox) -> dict[str, Any] | None:
    """Return the cells of the wind that is drawn, its factor to m/s, and the least speed of the longest arrow [m/s]."""
    flow, speed = box.gauges.flow, float(box.setup.scale.velocity)
    if not (flow and flow.high.size):
        return None
    return {"rows": flow.high.size, "columns": flow.wave.shape[1], "factor": speed, "least": _SLOWEST * speed}


def _fixed(box: LabBox) -> dict[str, Any]:
    """Return the coordinates that do not change, in SI: the middles of bins, and radii at which theory is drawn."""
    gauges, scale = box.gauges, box.setup.scale
    edges = {
        "speed": gauges.fast.edges * scale.velocity,
        "height": np.linspace(0.0, float(box.setup.parcel.length[2]), gauges.parts.rows + 1) * scale.length,
        "distance": np.linspace(0.0, gauges.sides.width, gauges.sides.columns + 1) * scale.length,
    }
    found = {name: plain(0.5 * (each[1:] + each[:-1])) for name, each in edges.items() if each.size > 2}
    leaving, nuclei = (instrument_of(box.setup, kind) for kind in (Leaving, Nuclei))
    found |= {} if leaving is None else {"energy": plain(bins_of(box.setup, leaving).mean(axis=1))}
    return found if nuclei is None else found | {"radius": plain(nuclei.radius)}


def _knobs(box: LabBox) -> tuple[list[Any], dict[str, Any]]:
    """Return the knobs that act in a page, and for each the kernel that it calls and the conversion of its value."""
    setup, scale, driver = box.setup, box.setup.scale, getattr(box.setup.parcel, "driver", None)
    warming = "warm_bath" if box.attracts and box.gas.bath.rate > 0.0 else "warm_walls"
    warm = {"kernel": warming, "argument": "kT", "times": BOLTZMANN, "over": scale.energy}
    # a part of the way, or a height; both are converted to a moment of the ascent
    lead = {"kernel": "lead", "argument": "towards", "end": float(driver.course.end)} if driver else {}
    pull = {"kernel": "set_gravity", "argument": "gravity", "everywhere": "gas.box.gravity"}
    acts: dict[str, dict[str, Any]] = {
        "temperature": warm, "floor_temperature": warm, "ceiling_temperature": warm, "altitude": lead, "way": lead,
        "gravity": pull | {"over": scale.acceleration, "rounds": True},
        "open_pool": {"kernel": "cover_pool", "argument": "share"},
        "attraction": {"kernel": "attract", "argument": "strength"},
    }  # fmt: skip
    # a knob of a user's own scene is a function in Python, of which the page knows nothing
    kept = [knob for knob in setup.knobs if knob.name in acts and box.prepared.scene in SCENES]
    kept = [knob for knob in kept if knob.name != "gravity" or can_set_gravity(box.modes)]
    numbers: dict[str, Any] = {}
    for knob in kept:
        unit = declared_unit(knob.unit)
        told: dict[str, Any] = {"up": unit.up, "down": unit.down, "offset": unit.offset, "times": 1.0, "over": 1.0}
        told |= acts[knob.name]
        if knob.leave is not None and box.modes.phases:
            told |= {"leave": "smooth_walls", "rounds": True}
        if knob.wall is not None:
            told["walls"] = {"first": knob.wall, "last": knob.wall + 1}
        if knob.places is not None:
            told |= {"grid": knob.places[0], "curves": {"to": knob.places[1]}, "rounds": True}
        numbers[knob.name] = told
    return kept, numbers


def _command(prepared: Prepared) -> str:
    """Return the command that starts the same run, with the seed at its end."""
    sets = (Setting(name, value) for name, value in prepared.settings.changed().items() if name != "seed")
    engine = [Option("engine", prepared.unusual_engine)] if prepared.unusual_engine else []
    return on_command_line(Command("run", (prepared.scene, *sets, *engine, Option("seed", prepared.settings.seed))))

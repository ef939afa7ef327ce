"""A box with its instruments and picture, as the arrays that the kernels of a page work on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from atmosbox.engine import AttractingParcelSet, ParcelSet
from atmosbox.engine.core.state import EVENT, MOLECULE, Gas, Modes, aligned_records
from atmosbox.engine.exact.advance import Book
from atmosbox.engine.exact.calendar import new_calendar
from atmosbox.engine.exact.cells import ROW
from atmosbox.engine.exact.layout import NUMBER, PLACES, Layout, describe, new_cells
from atmosbox.engine.exact.rows import FEWEST, LONGEST, MOST, row_stride
from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.engine.wells.vicinity import new_vicinity
from atmosbox.engine.wells.well_advance import Lists
from atmosbox.errors import SettingError
from atmosbox.lab.gauges import average, crowd, gauges
from atmosbox.lab.kernels.averaging import Average
from atmosbox.lab.kernels.flowing import can_flow
from atmosbox.lab.kernels.gauging import Gauges
from atmosbox.lab.kernels.picture import Picture
from atmosbox.lab.kernels.readings import MEASURED
from atmosbox.lab.kernels.starting import Start
from atmosbox.lab.stage import instrument_of, lab_stage, running_panels
from atmosbox.lab.start_plan import is_drawn, start_of
from atmosbox.lab.wasm_module import elsewhere, module_name
from atmosbox.page.frame import SWELLING, places
from atmosbox.scene.instruments import Flow, Layers, Speeds
from atmosbox.simulation.preparation import Prepared, build

if TYPE_CHECKING:
    from atmosbox.page import Stage
    from atmosbox.scene.setup import Setup
    from atmosbox.scene.units import Scale

_CORNERS = 4
_SPARE = 1.5
_LONGER = 4
"""Factor by which rows of cells and lists of neighbours can grow, because memory is reserved for that."""
_INSTRUMENTS = (*MEASURED, Layers, Speeds)
_BOXES = (ParcelSet, AttractingParcelSet, MoistParcelSet, DropParcelSet)


class LabBox(NamedTuple):
    """A box at its start, as the arrays and settings of a page.

    ``layers`` is the average of the profiles by height, one quantity after the other, and ``speeds`` the average of the
    shares of molecules by speed; they are empty in a scene that does not show them. If molecules attract each other,
    ``gas`` and ``layout`` are those of `well_gas` and `lists`, and ``crowd`` holds the data of the drops, otherwise 0.
    ``start`` says how molecules are placed with another seed, if ``seeded``. ``stage`` is what the page shows, and
    ``swift`` a speed that hardly any molecule exceeds, see `lab_stage`.
    """

    prepared: Prepared
    setup: Setup
    gas: Any
    ascent: Any
    book: Book
    layout: Any
    gauges: Gauges
    speeds: Average
    layers: Average
    picture: Picture
    crowd: Any
    start: Start
    seeded: bool
    stage: Stage
    swift: float

    @property
    def modes(self) -> Modes:
        """What the scene requires of the engine."""
        return self.setup.parcel.arrays().modes  # type: ignore[attr-defined, no-any-return]

    @property
    def attracts(self) -> bool:
        """Whether molecules attract each other."""
        return isinstance(self.setup.parcel, AttractingParcelSet)

    @property
    def module(self) -> str:
        """The name of the module that contains the kernels of this box."""
        return module_name(self.modes, wells=self.attracts)

    @property
    def warmed(self) -> tuple[int, int]:
        """The range of walls that a knob warms, first and last + 1: all six, or the four sides if there is a piston."""
        return (0, 6) if not self.modes.piston else (0, 4)


def _refuse(prepared: Prepared, setup: Setup) -> None:
    """Refuse a box for which there is no module; the message says what to use instead."""
    parcel: Any = setup.parcel
    flow, layers = instrument_of(setup, Flow), instrument_of(setup, Layers) or Layers(0)
    unknown = [type(each).__name__ for each in setup.instruments if type(each) not in _INSTRUMENTS]
    # wind is measured in a flat box of one gas, in the parts of the layers
    flows = type(parcel) is ParcelSet and parcel.planar and can_flow(parcel.arrays().modes)
    if flow is not None and not (flows and flow.shape == (layers.number, layers.columns)):
        unknown.append(Flow.__name__)
    why = None
    if str(prepared.engine) != "exact":
        why = "runs in the page with the exact engine alone"
    elif type(parcel) not in _BOXES:
        why = "has an engine of its own, which is not compiled for the page"
    elif parcel.driver is not None and parcel.arrays().ascent is None:
        why = "moves its piston in a way that is not compiled for the page"
    elif unknown:
        why = f"has an instrument that is not compiled for the page, {unknown[0]}"
    if why is not None:
        raise SettingError("scene", prepared.scene, why, *elsewhere(prepared.scene))


def lab_box(prepared: Prepared) -> LabBox:
    """Return the box of a scene for a page; refuse one that cannot be built, or cannot run in a page.

    >>> from atmosbox.simulation.preparation import prepare
    >>> lab_box(prepare("temperature", {"molecules": 20})).gauges.speeds.size
    58
    """
    setup = build(prepared)
    _refuse(prepared, setup)
    stage, swift = lab_stage(prepared, setup, running_panels(prepared))
    parcel: Any = setup.parcel
    arrays = parcel.arrays()
    attracts = type(parcel) is AttractingParcelSet
    layout: Any = lists(parcel) if attracts else _layout(arrays)
    measured, layers = gauges(prepared, setup), instrument_of(setup, Layers) or Layers(0)
    # a block of the profiles is twice as long as the correlation time of the column's energy: nearly independent
    block, rows = max(1, math.ceil(2.0 * layers.memory / setup.frame)), measured.parts.rows
    speeds, profiles = average(measured.speeds.size, measured.speeds.size, 1), average(5 * rows, 4 * rows, block)
    gas, drops = (well_gas(parcel), crowd(setup)) if attracts else (_gas(arrays, layout), 0)
    start, shown = start_of(parcel, layout), _picture(parcel, setup.scale, stage)
    box = LabBox(
        prepared, setup, gas, _ascent(arrays.ascent), arrays.book, layout, measured, speeds, profiles, shown, drops,
        start, is_drawn(parcel), stage, swift,
    )  # fmt: skip
    return _without_molecules(box) if box.seeded else box


def _without_molecules(box: LabBox) -> LabBox:
    """Return a box without its molecules, which the kernel ``start`` is to draw: the page gets smaller."""
    molecules = aligned_records(box.gas.molecules.size, MOLECULE)
    molecules[:] = box.gas.molecules
    # after those of the gas follow the molecules of the liquid, and the drops
    molecules[: box.setup.parcel.number][["x", "y", "z", "vx", "vy", "vz"]] = 0.0
    kinds = box.gas.kinds._replace(rotational_energy=np.zeros_like(box.gas.kinds.rotational_energy))
    return box._replace(gas=box.gas._replace(molecules=molecules, kinds=kinds))


def _layout(arrays: Any) -> Any:
    """Return the layout of the cells before molecules are placed, with memory for other cells."""
    old, modes = arrays.layout, arrays.modes
    shape = old.shape.copy()
    column: Any = old.column if modes.gravity and modes.rows else 0
    shape[PLACES] = FEWEST if modes.rows else ROW - 1
    numbers = shape[NUMBER : NUMBER + 3]
    most = max(*numbers[:2], column.count.size) if column else int(_SPARE * max(numbers))
    edge = np.pad(old.edge, ((0, 0), (0, most + 3 - old.edge.shape[1])))
    return old._replace(shape=shape, filled=old.filled.copy(), edge=edge, column=column)


def _gas(arrays: Any, layout: Layout) -> Gas:
    """Return the gas before its molecules are placed, with memory for longer rows, and for other cells if needed."""
    cells, number, modes = arrays.gas.cells, arrays.gas.molecules.size, arrays.modes
    many = math.prod(layout.shape[NUMBER : NUMBER + 3].tolist())
    if layout.column:
        many = cells.number_x * cells.number_y * layout.column.count.size
    elif modes.piston:
        many = int(_SPARE * many)
    words = many * (row_stride(MOST, modes.mixed) if modes.rows else _LONGER * cells.stride)
    events, most = aligned_records(number, EVENT), layout.edge.shape[1] - 1
    made = new_cells(events, layout.radius.size, words, most, cells.copies.radius, float(cells.copies.epoch[LONGEST]))
    gas: Gas = arrays.gas._replace(events=events, cells=made, calendar=new_calendar(number))
    if not modes.rows:
        return gas._replace(cells=made._replace(boundary=cells.boundary, first=cells.first, span=cells.span))
    describe(gas, layout, modes)
    return gas


def _ascent(ascent: Any) -> Any:
    """Return the data that control the piston, with memory for a course changed by hand; 0 for a box without ascent."""
    if ascent is None:
        return 0
    lift = ascent.lift
    time, moment = np.full(_CORNERS, math.inf), np.full(_CORNERS, lift.course_moment[-1])
    time[: lift.course_time.size], moment[: lift.course_time.size] = lift.course_time, lift.course_moment
    # the energy at the start is kept in `Book`
    return ascent._replace(lift=lift._replace(course_time=time, course_moment=moment), start_energy=0.0)


def well_gas(parcel: Any) -> Any:
    """Return the gas before the neighbours of its molecules are listed, with memory for longer lists."""
    number, gas = parcel.number, parcel.arrays().gas
    reach, stride = gas.vicinity.reach, gas.vicinity.stride
    vicinity = new_vicinity(parcel.length, parcel.periodic, number, reach, planar=parcel.planar)
    vicinity = vicinity._replace(entry=np.zeros(number * _LONGER * stride, np.uint32), stride=stride)
    return gas._replace(events=aligned_records(number, EVENT), calendar=new_calendar(number), vicinity=vicinity)


def lists(parcel: Any) -> Lists:
    """Return the lengths of the lists of neighbours."""
    return Lists(np.array([parcel.arrays().gas.vicinity.stride]), np.zeros(1, np.int64))


def _picture(parcel: Any, scale: Scale, stage: Stage) -> Picture:
    """Return the data of the picture, with memory for the molecules, drops, clumps or layers that are drawn."""
    record, arrays, shown = stage.record, parcel.arrays(), np.asarray(stage.shown, np.int64)
    place, plain = np.zeros((shown.size, 3), np.uint16), np.zeros(shown.size, np.uint8)
    highest = float(record["speed"]["high"]) / (1.0 if record["speed"]["counted"] else scale.velocity)
    water, spread = int(record["water"]), places(int(record["water"]))
    drops = len(arrays.book.moisture.drops.record) if arrays.modes.drops else 0
    pieces, clump = np.zeros((max(len(spread), drops) + 1, 4), np.float32), float(record["species"][-1]["drawn"])
    return Picture(
        shown, np.zeros(3), place, plain, highest, plain.copy(), pieces, np.zeros(1, np.int64),
        scale.length * float(record["metre"]), water, SWELLING * clump, spread,
    )  # fmt: skip

"""A box with its instruments and picture, as the arrays that the kernels of a page work on."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from atmosbox import theory as law
from atmosbox.engine import AttractingParcelSet, ParcelSet
from atmosbox.engine.core.state import EVENT, MOLECULE, Gas, Modes, aligned_records
from atmosbox.engine.exact.advance import Book
from atmosbox.engine.exact.calendar import new_calendar
from atmosbox.engine.exact.cells import ROW
from atmosbox.engine.exact.layout import NUMBER, PLACES, Layout, describe, new_cells
from atmosbox.engine.exact.rows import FEWEST, LONGEST, MOST, row_stride
from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.errors import SettingError
from atmosbox.lab.kernels.averaging import BLOCKS, Average
from atmosbox.lab.kernels.flowing import Flow as Wind
from atmosbox.lab.kernels.flowing import can_flow
from atmosbox.lab.kernels.gauging import Gauges
from atmosbox.lab.kernels.picture import Picture
from atmosbox.lab.kernels.readings import MEASURED, Reading
from atmosbox.lab.kernels.starting import Start
from atmosbox.lab.kernels.sums import Bins, Sum
from atmosbox.lab.kernels.two_gases import Mixture
from atmosbox.lab.moist_box import hygrometer, liquid_picture
from atmosbox.lab.stage import instrument_of, lab_stage, running_panels
from atmosbox.lab.start_plan import is_drawn, start_of
from atmosbox.lab.wasm_module import elsewhere, module_name
from atmosbox.lab.well_box import crowd, lists, well_gas
from atmosbox.scene.instruments import MOMENTS, Air, Discs, Flow, Layers, Mixing, Speeds
from atmosbox.scene.instruments.flow import modes_of_flow
from atmosbox.scene.instruments.mixing import expected_share
from atmosbox.simulation.preparation import Prepared, build

if TYPE_CHECKING:
    from atmosbox.page import Stage
    from atmosbox.scene.setup import Setup
    from atmosbox.scene.units import Scale

_CORNERS = 4
_SPARE = 1.5
_LONGER = 4
"""Factor by which the rows of cells can grow, because memory is reserved for that."""
_INSTRUMENTS = (*MEASURED, Layers, Speeds)
_ALIKE, _ANY_SPEED, _UNMIXED = np.zeros(0, np.int64), np.zeros(1), Mixing(np.zeros(0, np.bool_), {}, 0)
_BOXES = (ParcelSet, AttractingParcelSet, MoistParcelSet, DropParcelSet)
_DENSITIES = 129
"""Number of densities at which the adiabatic lapse rate over gravity is tabulated, up to that at which discs freeze."""


class LabBox(NamedTuple):
    """A box at its start, as the arrays and settings of a page.

    ``layers`` is the average of the profiles by height, one quantity after the other, and ``speeds`` the average of the
    shares of molecules by speed; they are empty in a scene that does not show them. If molecules attract each other,
    ``gas`` and ``layout`` are those of `well_box`, and ``crowd`` holds the data of the drops; otherwise it is 0.
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
    unknown = [type(each).__name__ for each in setup.instruments if type(each) not in _INSTRUMENTS]
    if not _is_measured(instrument_of(setup, Flow), instrument_of(setup, Layers), parcel):
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


def _is_measured(flow: Any, layers: Any, parcel: Any) -> bool:
    """Return whether there is no wind, or a wind that kernels can measure in the parts of the layers."""
    if flow is None:
        return True
    parts = None if layers is None else (layers.number, layers.columns)
    return parcel.planar and type(parcel) is ParcelSet and can_flow(parcel.arrays().modes) and flow.shape == parts


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
    gauges, layers = _gauges(prepared, setup), instrument_of(setup, Layers)
    # a block of the profiles is twice as long as the correlation time of the column's energy: nearly independent
    rows, memory = gauges.parts.rows, 0.0 if layers is None else layers.memory
    speeds = _average(gauges.speeds.size, gauges.speeds.size, 1)
    profiles = _average(5 * rows, 4 * rows, max(1, math.ceil(2.0 * memory / setup.frame)))
    gas, drops = (well_gas(parcel), crowd(setup)) if attracts else (_gas(arrays, layout), 0)
    start, shown = start_of(parcel, layout), _picture(parcel, setup.scale, stage)
    box = LabBox(
        prepared, setup, gas, _ascent(arrays.ascent), arrays.book, layout, gauges, speeds, profiles, shown, drops,
        start, is_drawn(parcel), stage, swift,
    )  # fmt: skip
    return _without_molecules(box) if box.seeded else box


def _without_molecules(box: LabBox) -> LabBox:
    """Return a box without its molecules, which the kernel ``start`` is to draw: the page gets smaller."""
    molecules = aligned_records(box.gas.molecules.size, MOLECULE)
    molecules[:] = box.gas.molecules
    in_gas = molecules[: box.setup.parcel.number]  # after these follow the molecules of the liquid, and the drops
    for name in ("x", "y", "z", "vx", "vy", "vz"):
        in_gas[name] = 0.0
    kinds = box.gas.kinds._replace(rotational_energy=np.zeros_like(box.gas.kinds.rotational_energy))
    return box._replace(gas=box.gas._replace(molecules=molecules, kinds=kinds))


def _layout(arrays: Any) -> Layout:
    """Return the layout of the cells before molecules are placed, with memory for other cells."""
    old, modes = arrays.layout, arrays.modes
    shape = old.shape.copy()
    column: Any = old.column if modes.gravity and modes.rows else 0
    shape[PLACES] = FEWEST if modes.rows else ROW - 1
    numbers = shape[NUMBER : NUMBER + 3]
    most = max(*numbers[:2], column.count.size) if column else int(_SPARE * max(numbers))
    edge = np.zeros((3, most + 3))
    edge[:, : old.edge.shape[1]] = old.edge
    layout: Layout = old._replace(shape=shape, filled=old.filled.copy(), edge=edge, column=column)
    return layout


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


def _gauges(prepared: Prepared, setup: Setup) -> Gauges:
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
        water=hygrometer(prepared, setup),
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
    number = len(mixing.moments) * mixing.bins
    known = [expected_share(mixing.bins, MOMENTS[name]) for name in mixing.moments]
    return Mixture(
        moments=np.array(list(mixing.moments.values()), float),
        frame=frame,
        off=np.full(len(known), math.inf),
        expected=np.concatenate([np.zeros(0), *(each[0] for each in known)]),
        scatter=np.concatenate([np.zeros(0), *(each[1] for each in known)]),
        mean=np.full(number, math.nan),
        error=np.full(number, math.nan),
    )


def _average(summed: int, number: int, frames: int) -> Average:
    """Return averages of ``number`` quantities from ``summed`` sums, in blocks of some frames."""
    state = np.array([0, 0, frames, frames])
    return Average(np.zeros((BLOCKS + 2, summed)), state, np.full(number, np.nan), np.full(number, np.nan))


def _picture(parcel: Any, scale: Scale, stage: Stage) -> Picture:
    shown, speed = np.asarray(stage.shown, np.int64), stage.record["speed"]
    place, plain = np.zeros((shown.size, 3), np.uint16), np.zeros(shown.size, np.uint8)
    highest = float(speed["high"]) / (1.0 if speed["counted"] else scale.velocity)
    liquid = liquid_picture(parcel, scale, stage)
    return Picture(shown, np.zeros(3), place, plain, highest, plain.copy(), *liquid)

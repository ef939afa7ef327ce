"""A molecule that condenses is in no cell, one that evaporates is in its cells: all tables agree after every event.

The kernels are those of `test_moist`.
"""

import math

import numpy as np
import pytest

from atmosbox.engine.exact.cells import overlapped
from atmosbox.engine.exact.rows import MOST, name_in
from atmosbox.engine.liquid import moist_parcelset
from tests.engine.boxes import SMOOTH, many_events
from tests.engine.test_moist import BOXES, OWN_KERNELS, liquid_of, moist, water

DIAMETER = 0.8


def box(name, substance=None, *, air=20, vapour=10, number=30, area=60.0, **options):
    """Return a box of air and vapour at random places, with its liquid; compiled code lifts molecules of one size."""
    kind, walls, driver = BOXES[name]
    substance = substance or water(diameter=1.0 if name == "lifted mist" else DIAMETER)
    liquid = liquid_of(kind, substance, area, number=number, nuclei=50.0)
    return moist(liquid, air, vapour, **{"walls": walls, "driver": driver and driver()} | options)


by_name = pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.nightly if name in OWN_KERNELS else ()) for name in BOXES]
)


def as_written(kernel):
    """Return the Python function of a kernel: numba distinguishes calls with other modes in compiled code only."""
    return getattr(kernel, "py_func", kernel)


def members(parcel):
    """Return for each molecule the sorted cells in which it is listed."""
    cells, modes = parcel._cells, parcel._modes
    in_cells = [[] for _ in parcel._fields]
    for cell in range(cells.number_x * cells.number_y * cells.number_z):
        start = cell * cells.stride
        if modes.rows:
            taken = int(cells.copies.occupied[start >> 1])
            names = [as_written(name_in)(start, place, cells, modes) for place in range(MOST) if taken >> place & 1]
        else:
            names = cells.row[start + 1 : start + 1 + cells.row[start]]
        for i in names:
            in_cells[i].append(cell)
    return [sorted(cells) for cells in in_cells]


def cells_it_overlaps(parcel, i):
    """Return the cells that molecule i overlaps, from its slots."""
    cells, event = parcel._cells, parcel._events[i]
    size = int(parcel._kinds.table["size_class"][parcel._fields["kind"][i]])
    ranges = []
    for axis, (name, number) in enumerate(zip("xyz", (cells.number_x, cells.number_y, cells.number_z), strict=True)):
        slot = int(event[f"slot_{name}"])
        first, span = as_written(overlapped)(slot, size, axis, cells, parcel._modes)
        ranges.append([(first + k) % number for k in range(span)])
    return sorted(
        (a * cells.number_y + b) * cells.number_z + c for a in ranges[0] for b in ranges[1] for c in ranges[2]
    )


def tables_agree(parcel):
    """Check that cells, calendar, clocks and the list of absent molecules agree."""
    assert parcel._modes.rows or parcel._crowded
    absent = np.isinf(parcel._fields["clock"])
    top = int(parcel._reservoir.top[0])
    assert sorted(parcel._reservoir.absent[:top]) == np.flatnonzero(absent).tolist()
    assert top == parcel.liquid + parcel.rained
    listed = members(parcel)
    leaf = parcel._calendar.leaf
    for i, gone in enumerate(absent):
        if gone:
            assert listed[i] == []
            assert parcel._calendar.time[leaf + i] == math.inf
            assert parcel._kinds.rotational_energy[i] == 0.0
            assert parcel._fields["vx"][i] == 0.0
        else:
            assert listed[i] == cells_it_overlaps(parcel, i)
            assert np.isfinite(parcel._calendar.time[leaf + i])


@many_events
@by_name
def test_all_tables_agree_after_every_molecule_that_comes_or_goes(name, monkeypatch):
    monkeypatch.setattr(moist_parcelset, "_CHUNK", 1)
    parcel = box(name)
    seen = [(0, 0)]
    tables_agree(parcel)

    def check(time):
        now = (parcel.condensed, parcel.evaporated)
        if now != seen[-1]:
            seen.append(now)
            tables_agree(parcel)

    while min(seen[-1]) < 15:
        parcel.advance(parcel.time + 1.0, watch=check)
        assert parcel.time < 200.0


@many_events
@pytest.mark.parametrize("name", ["mist", "pool", pytest.param("periodic", marks=pytest.mark.nightly)])
def test_a_molecule_that_evaporates_may_appear_anywhere(name, monkeypatch):
    monkeypatch.setattr(moist_parcelset, "_CHUNK", 1)
    sides = np.array([4.0, 5.0, 6.0])
    volatile = water(2.0, binding_energy=2.0, diameter=DIAMETER)
    parcel = box(name, volatile, air=1, vapour=0, sides=tuple(sides), number=5, area=200.0)
    places, seen = [], [0]

    def check(time):
        if parcel.evaporated > seen[-1]:
            seen.append(parcel.evaporated)
            clock = parcel._fields["clock"]
            newest = int(np.argmax(np.where(np.isfinite(clock), clock, -np.inf)))
            places.append([parcel._fields[u][newest] for u in "xyz"])

    while len(places) < 4000:
        parcel.advance(parcel.time + 20.0, watch=check)
        assert parcel.time < 20_000.0
    places = np.array(places)
    margin = 0.0 if name == "periodic" else 0.5 * DIAMETER
    if name == "periodic":
        places %= sides
    for axis in range(3):
        low, high = margin, sides[axis] - margin
        if name == "pool" and axis == 2:
            assert (places[:, 2] == low).all()
            continue
        share = (places[:, axis] - low) / (high - low)
        assert ((share >= 0.0) & (share <= 1.0)).all()
        # a mean of 1/2 and a variance of 1/12 within 4 standard errors: a false alarm in 16 000 per number
        assert abs(share.mean() - 0.5) < 4.0 * math.sqrt(1.0 / 12.0 / len(share))
        assert abs(np.mean((share - 0.5) ** 2) - 1.0 / 12.0) < 4.0 * math.sqrt(1.0 / 180.0 / len(share))


@many_events
@pytest.mark.parametrize(
    ("number", "crowded"), [(60, False), pytest.param(400, True, marks=pytest.mark.nightly)], ids=["longer", "lists"]
)
def test_rows_grow_where_many_leave_a_pool_at_once(number, crowded):
    # a small floor, from which more than fill a row, or the longest there is, come up within one mean free time
    volatile = water(1e6, binding_energy=2.0, diameter=0.05)
    parcel = box("pool", volatile, air=3, vapour=0, number=number, sides=(3.0, 3.0, 60.0), walls=SMOOTH)
    before = parcel._cells.stride
    parcel.advance(0.05)
    assert parcel._crowded is crowded
    assert parcel._cells.stride > before or crowded
    assert parcel.evaporated > min(100, 0.8 * number)
    tables_agree(parcel)
    parcel.advance(5.0)
    tables_agree(parcel)
    assert parcel.escaped() == 0
    assert parcel.ledger() < 1e-10

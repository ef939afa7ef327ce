"""The parcel of air: molecules in a box, advanced exactly.

`ParcelSet` checks what it is given, lays it out for the kernels, owns the random numbers and the moving
epoch of time, and turns the kernels' status codes into sentences.
"""

import math
from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.box import new_box
from atmosbox.engine.core.inputs import number
from atmosbox.engine.core.kind import classify
from atmosbox.engine.core.lift import FollowPressure
from atmosbox.engine.core.parcel import Array, Parcel, Snapshot
from atmosbox.engine.core.refusal import RefusedError, StalledError
from atmosbox.engine.core.state import EVENT, MOLECULE, SLOT_OFFSET, Cells, Gas, Modes, aligned_records
from atmosbox.engine.core.walls import HEAT_BATH, PISTON, POOL
from atmosbox.engine.exact.calendar import new_calendar
from atmosbox.engine.exact.cells import ROW, Grid, choose_grid, new_cells, new_rows
from atmosbox.engine.exact.exact import specialise
from atmosbox.engine.exact.laying_out import LAST, STRIDE, TALLER, Layout, fits
from atmosbox.engine.exact.passing import NOW, PLACE, Beside, Book, Passed, passing
from atmosbox.engine.exact.rows import MOST, copies_of, row_stride
from atmosbox.engine.exact.stall import crushing_height, why_crowded, why_crushed, why_stalled
from atmosbox.engine.exact.turning import HIGHEST, LOWEST, Ascent

__all__ = ["ParcelSet"]

_CHUNK = 200_000
_OVERLAP = 1e-9
_PLACES, _LONGER = 32, 16
"""How many places a row has at first, and how many it gets more when it was full."""
_NO_CLOCK = np.zeros(0)
_SHAPE = "stride", "number_x", "number_y", "number_z", "last_slot_x", "last_slot_y", "last_slot_z"
"""What a layout says of cells."""


class ParcelSet(Parcel):
    """A set of molecules with its box, advanced exactly: from event to event.

    What it is given, and what it tells, is described at `Parcel`.

    Examples
    --------
    Two molecules that approach each other along x bounce once and keep their energy:

    >>> pair = ParcelSet([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))
    >>> pair.advance(1.0)
    >>> pair.contacts, pair.snapshot().velocity[:, 0].tolist()
    (1, [-1.0, 1.0])
    """

    engine: ClassVar[str] = "exact"

    _frugal = True
    _layout: Any
    """The `Layout` of the cells."""
    _moments: NDArray[np.float64]
    """The local time now, and at which the rows of cells are to be filled: see `passing.Book`."""
    _crowded: bool
    """Whether so many molecules have come together in one cell that rows cannot hold copies of trajectories."""
    _present: slice | NDArray[np.bool_] = slice(None)
    """Which molecules are in the box: all of them."""
    _first_drop: int = 0
    """The first kind that is a drop, 0 if none is."""

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        self._crowded = False
        self._fill(position, velocity, rotational_energy)
        self._box = new_box(
            self._sides,
            self._periodic,
            moving=self._walls.law[5] == PISTON,
            gravity=self._gravity,
            planar=self._planar,
            exchange=1.0 / self._collision_number,
            stall=1e-9 * self._spread,
        )
        self._epoch_length = math.ldexp(1024.0, math.frexp(self._spread)[1] - 1)
        self._cells: Cells
        self._due = np.zeros(1, np.int64)
        self._start_energy = 0.0  # until all molecules are placed nobody asks for it
        self._lay_out()
        depth, i, j = self._overlap(self._gas())
        if depth > _OVERLAP:
            raise RefusedError(
                f"molecules {i} and {j} overlap at the start, by {depth:.3g} of their diameter: "
                "move them apart or make them smaller"
            )

    def _fill(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Write down the molecules."""
        self._kinds, kind, self._size_radius = classify(
            self._mass, self._diameter, self._rotation, np.array(rotational_energy) if self._rotates else None
        )
        self._molecules = aligned_records(len(position), MOLECULE)
        for axis, name in enumerate("xyz"):
            self._molecules[name] = position[:, axis]
            self._molecules["v" + name] = velocity[:, axis]
        self._molecules["kind"] = kind
        self._fields = self._molecules.view(np.ndarray)  # the same memory; numpy reads a field of it ten times faster

    def memory(self) -> int:
        """Return the bytes that molecules, events, cells and calendar take, and what is known of each molecule."""
        arrays = [self._molecules, self._events, self._cells.row, self._calendar.time, self._calendar.winner]
        arrays += [self._kinds.rotational_energy, self._kinds.table, self._cells.boundary]
        for each in (self._mass, self._diameter, self._rotation):
            arrays.append(each if each.strides != (0,) else each[:1])  # a number that all share takes the memory of one
        return sum(int(a.nbytes) for a in arrays)

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; nothing in the box changes by being looked at."""
        m = self._fields[self._present]
        dt = self._now - m["clock"]
        position = np.stack([m["x"] + dt * m["vx"], m["y"] + dt * m["vy"], m["z"] + dt * m["vz"]], axis=1)
        velocity = np.stack([m["vx"], m["vy"], m["vz"]], axis=1)
        if self.gravity > 0.0:
            position[:, 2] -= 0.5 * self.gravity * dt * dt
            velocity[:, 2] -= self.gravity * dt
        for axis in range(3):
            if self._periodic[axis]:
                position[:, axis] = np.mod(position[:, axis], self._sides[axis])
        spin = np.array(self._kinds.rotational_energy[self._present]) if self._rotates else np.zeros(len(m))
        return Snapshot(self.time, position, velocity, spin)

    def advance(self, until: float, watch: Callable[[float], None] | None = None) -> None:
        """Let time pass until ``until`` [time since the start]: see `Parcel.advance`."""
        until = number(until, "until")
        if until < self.time:
            raise RefusedError(f"until = {until} lies before now, t = {self.time}: give a later time")
        while True:
            turn = math.inf if self._ascends else self._next_turn()
            stop = min(until, turn)
            self._asked = None
            self._pass(stop, watch)
            if stop < turn:
                break
            self._turns[0] += 1
            self._drive()
            if watch is not None:
                watch(self.time)
            if stop >= until:
                break
        self._asked = until

    # ------------------------------------------------------------------ how

    def _piston_turned(self) -> None:
        velocity = self.piston_velocity
        filled = float(self._layout.filled[0])
        if self._ascends or not LOWEST * filled <= self.ceiling <= HIGHEST * filled:
            self._lay_out()
            return
        lowest = self.ceiling
        if velocity < 0.0:
            lowest += velocity * self._driver.interval if self._driver is not None else -math.inf
        self._replan(self._gas(), self._now, lowest)

    def _field_changes(self, gravity: float) -> None:
        _, position, velocity, _ = self.snapshot()
        for axis, name in enumerate("xyz"):
            place, side = position[:, axis], self._sides[axis]
            self._fields[name] = place % side if self._periodic[axis] else place
            self._fields["v" + name] = velocity[:, axis]
        self._fields["clock"] = self._now
        self._gravity, self._box = gravity, self._box._replace(gravity=gravity)
        self._lay_out()

    def _pass(self, until: float, watch: Callable[[float], None] | None) -> None:
        """Let time pass until ``until`` [time since the start], while nothing is asked of Python."""
        while (status := self._proceed(until, _CHUNK)) != Passed.DONE:
            if status != Passed.BUSY:
                self._answer(status)
            elif watch is not None:
                watch(float(self._walls.epoch[0]) + self._next_time())

    def _proceed(self, until: float, most: int) -> Passed:
        """Let time pass, or so many events; tell how far it has passed."""
        with np.errstate(over="ignore"):
            status, _ = self._pass_time(self._gas(), self._more(), self._book(), self._layout, until, most)
        self._cells = self._cells_now()
        return Passed(status)

    @property
    def _now(self) -> float:
        """The local time now, which compiled code writes [time]."""
        return float(self._moments[NOW])

    @_now.setter
    def _now(self, time: float) -> None:
        vars(self).setdefault("_moments", np.zeros(2))[NOW] = time

    def _cells_now(self) -> Cells:
        """Return the cells with as many, and as long rows, as compiled code has chosen."""
        shape = self._layout.shape.tolist()
        if shape == [getattr(self._cells, name) for name in _SHAPE]:
            return self._cells
        return self._cells._replace(**dict(zip(_SHAPE, shape, strict=True)))

    def _book(self) -> Book:
        """Return what the kernels must know of what is due."""
        interval = math.inf if self._driver is None else float(self._driver.interval)
        known = self._epoch_length, float(self._lowest_ceiling), float(self._start_energy)
        return Book(self._moments, self._due, self._turns, interval, *known)

    def _answer(self, status: Passed) -> None:
        """Do what compiled code cannot do, or raise the error that it cannot."""
        if status == Passed.FULL:
            self._give_memory()
        elif status in (Passed.OUTGROWN, Passed.CRAMPED):
            self._crowded |= status == Passed.CRAMPED
            self._lay_out()
        elif status == Passed.CRUSHED:
            raise StalledError(why_crushed(self))
        else:
            raise StalledError(why_stalled(self) if status == Passed.STALLED else why_crowded(self))

    def _more(self) -> Any:
        """Return what there is beside the molecules: see `passing.pass_time`."""
        return Beside(_NO_CLOCK, self._ascent() if self._ascends else 0)

    @property
    def _ascends(self) -> bool:
        """Whether compiled code turns the piston: it knows one driver, and molecules of one size."""
        return type(self._driver) is FollowPressure and self._same_size and not self._first_drop

    def _ascent(self) -> Ascent:
        """Return what the kernels must know that turn the piston."""
        assert isinstance(self._driver, FollowPressure)
        diameter = float(self._diameter[0])
        energy = self._start_energy, self._gravity_work
        heights = self._layout.filled, float(self._lowest_ceiling)
        return Ascent(self._driver.law(), self._turns, *heights, *energy, self._freedom, diameter)

    def _next_turn(self) -> float:
        """Return when the driver is asked next [time]."""
        return math.inf if self._driver is None else (int(self._turns[0]) + 1) * self._driver.interval

    def _gas(self) -> Gas:
        """Return all that the kernels work on."""
        return Gas(
            self._molecules, self._events, self._kinds, self._cells_now(),
            self._calendar, self._box, self._walls, self._tallies,
        )  # fmt: skip

    def _next_time(self) -> float:
        """Return the local time of the next event."""
        return float(self._calendar.time[1])

    def _give_memory(self) -> None:
        """Give the cells memory for what is wanted of them now; it is empty, unless rows are lists of names."""
        cells, layout = self._cells, self._layout
        stride, *numbers = layout.shape[:LAST].tolist()
        many, most = math.prod(numbers), max(numbers)
        if not self._modes.rows:
            row = new_rows(2 * many * stride)
            row.reshape(many, 2 * stride)[:, :stride] = cells.row.reshape(many, stride)
            layout.shape[STRIDE] = 2 * stride
            self._cells = cells._replace(row=row, stride=2 * stride)
            return
        row = new_rows(many * stride)
        copies = cells.copies._replace(value=row.view(np.float32), occupied=row.view(np.int64))
        if not fits(cells._replace(row=row), layout):  # the tables are written when cells have been chosen
            self._layout = layout._replace(edge=np.zeros((3, most + 1)))
            copies = copies._replace(
                centre=np.zeros((3, most + 1)), horizon=np.zeros(most), slack=np.zeros((most, 3)), room=np.zeros(most)
            )
            cells = cells._replace(boundary=np.zeros((len(layout.radii), 3, 2 * most + 2)))
        self._cells = cells._replace(row=row, copies=copies)

    def _lay_out(self) -> None:
        """Choose cells for the box as it is now and plan every molecule's event anew."""
        n = len(self._fields)
        moving = self._walls.law[5] == PISTON
        filled = self.ceiling
        self._lowest_ceiling = crushing_height(self._sides, self._diameter, planar=self._planar)
        length = np.array([self._sides[0], self._sides[1], TALLER * filled if moving else filled])
        kT = self._mean_kT()
        weight = float(self._mass.mean()) * self.gravity if n else 0.0
        contacts = self._collisions and bool(n) and float(self._diameter.max()) > 0.0
        grid = choose_grid(
            length,
            self._periodic,
            self._size_radius,
            n if contacts else 1,
            exact_radius=len(self._kinds.table) == 1,
            planar=self._planar,
            filled=filled,
            open_top=bool(moving),
            scale_height=kT / weight if weight > 0.0 and kT > 0.0 else math.inf,
            rows=contacts and not self._crowded,
        )
        self._modes = Modes(
            contacts=contacts,
            gravity=self.gravity > 0.0,
            rotation=self._rotates,
            mixed=len(self._kinds.table) > 1,
            spanning=grid.spanning,
            periodic=any(self._periodic),
            piston=bool(moving),
            phases=not isinstance(self._present, slice),
            pool=bool(self._walls.law[4] == POOL),
            drops=self._first_drop,
            images=grid.images,
            ascends=self._ascends,
            rows=grid.rows,
        )
        self._find_kernels()
        self._events = aligned_records(n, EVENT)
        self._calendar = new_calendar(n)
        self._layout = self._layout_of(grid, filled, length)
        stride = int(self._layout.shape[STRIDE])
        slot = np.zeros((0, 3), np.uint16)
        if n:
            slot = np.ndarray((n, 3), np.uint16, self._events.data, SLOT_OFFSET, (EVENT.itemsize, 2))
        row = new_rows(math.prod(grid.number) * stride)
        copies = copies_of(row, self._events.view(np.ndarray), self._box, self._layout, self._epoch_length)
        self._cells = new_cells(grid, slot, row, stride, copies)
        self._due[0] = PLACE
        while (status := self._proceed(0.0, 0)) != Passed.BUSY:
            self._answer(status)

    def _layout_of(self, grid: Grid, filled: float, length: Array) -> Layout:
        """Return how cells are laid out that cover so much when the ceiling is at the height ``filled`` [length]."""
        edge = np.zeros((3, max(grid.number) + 1))
        for axis in range(3):
            edge[axis, : grid.number[axis] + 1] = grid.edges[axis]
        few, many, none, longer = (row_stride(each, mixed=self._modes.mixed) for each in (_PLACES, MOST, 0, _LONGER))
        return Layout(
            shape=np.array([few if grid.rows else ROW, *grid.number, *grid.last_slot]),
            filled=np.array([filled]),
            length=length,
            room=np.zeros(3),
            width=np.zeros(3),
            edge=edge,
            radii=self._size_radius,
            usual=float(0.5 * self.diameter.mean()) if self.diameter.size else 0.0,
            shortest=few,
            longest=many,
            longer=longer - none,
        )

    def _find_kernels(self) -> None:
        self._replan, self._overlap = specialise(self._modes)
        self._pass_time = passing(self._modes)

    def _mean_kT(self) -> float:
        if not self.number:
            return 0.0
        kinetic, _, potential = self.energy()
        dimensions = 2.0 if self._planar else 3.0
        kT = 2.0 * kinetic / (dimensions * self.number)
        baths = [
            float(self._walls.schedule_kT[self._walls.schedule[w]]) for w in range(6) if self._walls.law[w] == HEAT_BATH
        ]
        return max([kT, *baths]) if kT > 0.0 or baths else potential / self.number

"""The parcel of air: molecules in a box, advanced exactly.

`ParcelSet` checks its arguments, arranges the data for the kernels, holds the random numbers and the
epoch of time, and turns the kernels' status codes into sentences.
"""

import math
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.kind import classify
from atmosbox.engine.core.lift import FollowPressure
from atmosbox.engine.core.packing import refuse_solid
from atmosbox.engine.core.parcel import Array, Parcel, Snapshot
from atmosbox.engine.core.refusal import RefusedError, StalledError, number
from atmosbox.engine.core.state import EVENT, MOLECULE, Cells, Gas, Modes, aligned_records
from atmosbox.engine.core.walls import PISTON, POOL, first_bath_kT
from atmosbox.engine.exact import layout
from atmosbox.engine.exact.advance import Book, advancing, dry_loop
from atmosbox.engine.exact.calendar import new_calendar
from atmosbox.engine.exact.cells import ROW, choose_grid
from atmosbox.engine.exact.exact import Status, specialise
from atmosbox.engine.exact.row_cells import MARGIN, TALLER, widths_for_rows
from atmosbox.engine.exact.rows import FEWEST
from atmosbox.engine.exact.stall import crushing_height, is_jammed, why_crowded, why_crushed, why_stalled
from atmosbox.engine.exact.turning import HIGHEST, LOWEST, Ascent

_CHUNK = 200_000
_WHY = {Status.STALLED: why_stalled, Status.CROWDED: why_crowded, Status.CRUSHED: why_crushed}
_NO_CLOCKS = np.full(1, math.inf)


class Arrays(NamedTuple):
    """What the kernels of a box work on: the arrays of the box itself, not copies of them.

    ``gas`` is their first argument, `Gas` or `WellGas`, and ``modes`` selects them; ``ascent`` is the piston that
    compiled code moves, None without one; ``book`` holds its times and the energy at the start, and ``layout`` the
    cells, or the sizes of the lists of neighbours if molecules attract each other.

    A box with liquid has its ``substance``; ``book.moisture`` is the liquid. If molecules attract each other,
    ``full_depth : (kind, kind)`` are the depths of their wells at full strength [energy].
    """

    gas: Any
    modes: Modes
    ascent: Ascent | None
    book: Book
    layout: Any
    substance: Any = None
    full_depth: Any = None


class ParcelSet(Parcel):
    """A set of molecules with its box, advanced exactly, from event to event.

    Its parameters, properties and refusals are described at `Parcel`; overlaps at the start are refused.

    Examples
    --------
    Two molecules that approach each other along x collide once and keep their energy:

    >>> pair = ParcelSet([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))
    >>> pair.advance(1.0)
    >>> pair.contacts, pair.snapshot().velocity[:, 0].tolist()
    (1, [-1.0, 1.0])
    """

    engine: ClassVar[str] = "exact"

    _frugal = True
    _crowded: bool
    """Whether so many molecules are in one cell that rows cannot hold copies of trajectories."""
    _present: slice | NDArray[np.bool_] = slice(None)
    """Which molecules are in the box: all of them."""
    _first_drop: int = 0
    """The number of the first kind that is a drop, 0 if there is none."""
    _start_energy: float = 0.0
    _loops = staticmethod(dry_loop)
    """Returns the kernels of the loop over events for a set of modes."""

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        if self._collisions:
            refuse_solid(self._sides, self._diameter, self._planar)
        self._crowded = False
        self._fill(position, velocity, rotational_energy)
        self._box = self._new_box(moving=self._walls.law[5] == PISTON, stall=1e-9 * self._spread)
        self._epoch_length = math.ldexp(1024.0, math.frexp(self._spread)[1] - 1)
        self._lowest_ceiling = crushing_height(self._sides, self._diameter, planar=self._planar)
        self._cells: Cells
        self._layout: Any
        self._lay_out()
        self._refuse_overlap(*self._overlap(self._gas()))

    def _fill(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Write the molecules into the engine's arrays."""
        self._kinds, kind, self._size_radius = classify(
            self._mass, self._diameter, self._rotation, np.array(rotational_energy) if self._rotates else None
        )
        self._write(position, velocity, kind)

    def _write(self, position: Array, velocity: Array, kind: NDArray[np.int64]) -> None:
        """Make records of molecules."""
        self._molecules = aligned_records(len(position), MOLECULE)
        self._fields = self._molecules.view(np.ndarray)  # the same memory; numpy reads its fields ten times faster
        self._fields["kind"] = kind
        self._move(position, velocity, 0.0)

    def _move(self, position: Array, velocity: Array, now: float) -> None:
        """Write positions and velocities at a local time."""
        for axis, name in enumerate("xyz"):
            self._fields[name], self._fields["v" + name] = position[:, axis], velocity[:, axis]
        self._fields["clock"] = now

    def _flown(self, m: NDArray[np.void], *, turn: bool = True) -> tuple[Array, Array]:
        """Return the positions now, brought back into a periodic box if asked, and the velocities of some records."""
        dt = self._now - m["clock"]
        position = np.stack([m[axis] + dt * m["v" + axis] for axis in "xyz"], axis=1)
        velocity = np.stack([m["v" + axis] for axis in "xyz"], axis=1)
        if self.gravity > 0.0:
            position[:, 2] -= 0.5 * self.gravity * dt * dt
            velocity[:, 2] -= self.gravity * dt
        for axis in range(3):
            if turn and self._periodic[axis]:
                position[:, axis] = np.mod(position[:, axis], self._sides[axis])
        return position, velocity

    def memory(self) -> int:
        """Return the memory of molecules, events, cells and calendar, and of the properties of molecules [bytes]."""
        arrays = [self._molecules, self._events, self._cells.row, self._calendar.time, self._calendar.winner]
        arrays += [self._kinds.rotational_energy, self._kinds.table, self._cells.boundary]
        for each in (self._mass, self._diameter, self._rotation):
            arrays.append(each if each.strides != (0,) else each[:1])  # a number shared by all is stored once
        return sum(int(a.nbytes) for a in arrays)

    def arrays(self) -> Arrays:
        """Return what the kernels of this box work on; they change as the box advances, and may be replaced."""
        return Arrays(self._gas(), self._modes, self._ascent(), self._book(), self._layout)

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; the box does not change."""
        m = self._fields[self._present]
        spin = np.array(self._kinds.rotational_energy[self._present]) if self._rotates else np.zeros(len(m))
        return Snapshot(self.time, *self._flown(m), spin)

    def advance(self, until: float, watch: Callable[[float], None] | None = None) -> None:
        """Advance the box to the time ``until`` [time since the start]: see `Parcel.advance`."""
        until = number(until, "until")
        if until < self.time:
            raise RefusedError(f"until = {until} lies before now, t = {self.time}: give a later time")
        while True:
            turn = self._next_turn()
            self._pass_until(min(until, turn), watch)
            if until < turn:
                break
            self._turns[0] += 1
            self._drive()
            if watch is not None:
                watch(self.time)
            if until == turn:
                break
        self._asked = until

    # ------------------------------------------------------------------ how events are resolved

    def _piston_turned(self) -> None:
        velocity, filled = self.piston_velocity, float(self._layout.filled[0])
        if self._ascends or not LOWEST * filled <= self.ceiling <= HIGHEST * filled:
            self._lay_out()
            return
        lowest = self.ceiling
        if velocity < 0.0:
            lowest += velocity * self._driver.interval if self._driver is not None else -math.inf
        self._replan(self._gas(), self._now, lowest)

    def _field_changes(self, gravity: float) -> None:
        position, velocity = self._flown(self._fields)
        turns = np.array(self._periodic)
        position[:, turns] %= self._sides[turns]
        self._move(position, velocity, self._now)
        self._gravity, self._box = gravity, self._box._replace(gravity=gravity)
        self._lay_out()

    def _pass_until(self, until: float, watch: Callable[[float], None] | None) -> None:
        """Resolve all events up to a time; make memory where the kernels lack it, and turn a status into a sentence."""
        self._asked = None
        crushed = math.inf
        if self.piston_velocity < 0.0 and not self._ascends:
            crushed = self.time + (self.ceiling - self._lowest_ceiling) / -self.piston_velocity
            if crushed <= self.time:
                raise StalledError(why_crushed(self))
        left, status = _CHUNK, Status.BUSY
        while status != Status.DONE:
            data, ascent, book = self._data(), self._ascent() or 0, self._book()
            status, done = self._pass_time(data, ascent, book, self._layout, min(until, crushed), left)
            self._now = float(book.now[0])
            left -= done
            if status == Status.FULL:
                self._make_room()
            elif status in _WHY:
                if status == Status.CRUSHED:
                    position, speed, since = self._walls.piston
                    self._now = float(since + (position - self._lowest_ceiling) / -speed)
                raise StalledError(_WHY[status](self))
            elif self.piston_velocity < 0.0 and is_jammed(self, self._fields, self._mass, self._start_energy):
                raise StalledError(why_crushed(self))
            elif status == Status.BUSY:
                left = _CHUNK
                if watch is not None:
                    watch(self.time)
        if crushed < until:
            raise StalledError(why_crushed(self))

    @property
    def _ascends(self) -> bool:
        """Whether compiled code moves the piston: it knows one driver, and needs molecules of one size."""
        return type(self._driver) is FollowPressure and self._same_size and not self._first_drop

    def _ascent(self) -> Ascent | None:
        """Return the data of a piston that compiled code moves, or None."""
        if not self._ascends:
            return None
        assert isinstance(self._driver, FollowPressure)
        diameter = float(self._diameter[0])
        energy = self._start_energy, self._gravity_work
        heights = float(self._layout.filled[0]), float(self._lowest_ceiling)
        return Ascent(self._driver.law(), self._turns, *heights, *energy, self._freedom, diameter)

    def _next_turn(self) -> float:
        """Return when Python sets the velocity of the piston next [time], ``inf`` if it never does."""
        driver = self._driver
        return math.inf if driver is None or self._ascends else (int(self._turns[0]) + 1) * driver.interval

    def _book(self) -> Book:
        """Return the times of the box, the energy at its start and its liquid."""
        return Book(
            np.array([self._now]), np.array([self._epoch_length]), self._clocks, np.array([self._next_turn()]),
            np.array([self._start_energy]), self._moisture,
        )  # fmt: skip

    def _data(self) -> Gas:
        """Return all data of the kernels, with the memory of the cells."""
        return Gas(
            self._molecules, self._events, self._kinds, self._cells,
            self._calendar, self._box, self._walls, self._tallies,
        )  # fmt: skip

    def _gas(self) -> Any:
        """Return all data of the kernels, with the present cells."""
        return layout.as_laid_out(self._data(), self._layout, self._modes)

    @property
    def _clocks(self) -> Any:
        """The times of events that belong to no molecule: here there are none."""
        return _NO_CLOCKS

    @property
    def _moisture(self) -> Any:
        """The liquid of the box: here there is none."""
        return 0

    # ------------------------------------------------------------------ memory for the cells

    def _lay_out(self) -> None:
        """Choose cells for the box as it is now and predict all events again."""
        self._choose()
        self._settle()

    def _settle(self) -> None:
        """Do what is due in the cells."""
        while not self._settled(self._gas(), self._now, self._layout):
            self._make_room()

    def _make_room(self) -> None:
        """Make memory for longer rows; where that does not help, choose other cells, or else rows without copies."""
        due = self._layout.due[0]
        if due in (layout.CHOOSE, layout.FOLLOW):
            self._crowded |= bool(due == layout.FOLLOW)
            self._choose()
            return
        cells, old = math.prod(self._layout.shape[layout.NUMBER : layout.NUMBER + 3].tolist()), self._cells.row
        words = cells * int(layout.stride_of(self._layout, self._modes))
        row = layout.new_rows(2 * words if due == layout.LENGTHEN else words)
        row[: old.size] = old
        copies = self._cells.copies._replace(value=row.view(np.float32), occupied=row.view(np.int64))
        self._cells = self._cells._replace(row=row, copies=copies)

    def _choose(self) -> None:
        """Choose cells for the box as it is now; all molecules are to be entered into them."""
        n, moving = len(self._fields), bool(self._walls.law[5] == PISTON)
        kT, bath = self._warmth()
        weight = float(self._mass.mean()) * self.gravity if n else 0.0
        contacts = self._collisions and bool(n) and float(self._diameter.max()) > 0.0
        shape, filled = np.array([FEWEST, 0, 0, 0, 0, 0, 0]), np.array([self.ceiling])
        self._layout = layout.Layout(shape, np.array([layout.PLACE]), filled, np.zeros((3, 1)), self._size_radius, None)
        rows = contacts and not self._crowded
        rows = rows and bool(layout.choose_cells(self.ceiling, n, self._box, moving, self._layout))
        grid = None
        if not rows:
            grid = choose_grid(
                np.array([*self._sides[:2], self.ceiling * (TALLER if moving else 1.0)]),
                self._periodic,
                self._size_radius,
                n if contacts else 1,
                exact_radius=len(self._kinds.table) == 1,
                planar=self._planar,
                filled=self.ceiling,
                open_top=moving,
                scale_height=max(kT, bath) / weight if weight > 0.0 and max(kT, bath) > 0.0 else math.inf,
            )
            shape[:] = ROW - 1, *grid.number, *grid.last_slot
        self._modes = Modes(
            contacts=contacts,
            gravity=self.gravity > 0.0,
            rotation=self._rotates,
            mixed=len(self._kinds.table) > 1,
            spanning=grid is not None and grid.spanning,
            periodic=any(self._periodic),
            piston=moving,
            phases=not isinstance(self._present, slice),
            pool=bool(self._walls.law[4] == POOL),
            drops=self._first_drop,
            images=grid is not None and grid.images,
            ascends=self._ascends,
            rows=rows,
        )
        self._find_kernels()
        self._events, self._calendar = aligned_records(n, EVENT), new_calendar(n)
        radius = 0.5 * float(self.diameter.mean()) if self.diameter.size else 0.0
        most = int(shape[layout.NUMBER : layout.NUMBER + 3].max()) if rows else 1
        self._cells = layout.new_cells(self._events, len(self._size_radius), 0, most, radius, self._epoch_length)
        if grid is not None:
            self._cells = self._cells._replace(boundary=grid.boundary, first=grid.first, span=grid.span)
            return
        self._layout = self._layout._replace(edge=np.zeros((3, most + 1)), column=self._column(kT, bath, weight))
        layout.write_cells(self._gas(), self._layout, self._modes)
        if self._layout.column.wanted:
            layout.write_column(kT, self._gas(), self._layout, self._modes)

    def _column(self, kT: float, bath: float, weight: float) -> layout.Column:
        """Return the data from which the layers of a column are chosen: none are wanted without gravity."""
        n, layers = len(self._fields), int(self._layout.shape[layout.NUMBER + 2])
        wanted = layers if layers > 1 and weight > 0.0 and max(kT, bath) > 0.0 else 0
        width = widths_for_rows(
            self._sides[0], self._sides[1], self.ceiling, float(self._size_radius.min()), n, self._planar
        )
        thinnest = max(2.002 * float(self._size_radius.max()) * MARGIN, 0.05 * width[2])
        return layout.Column(weight, bath, wanted, thinnest, np.zeros(layers, np.int64), np.zeros(layers + 1))

    def _find_kernels(self) -> None:
        _, _, self._replan, self._overlap, _ = specialise(self._modes)
        self._pass_time, self._settled = advancing(self._modes, self._loops)

    def _warmth(self) -> tuple[float, float]:
        """Return kT of the molecules and of the warmest wall [energy]; of a fall if no molecule moves."""
        if not self.number:
            return 0.0, 0.0
        baths = first_bath_kT(self._walls)
        kinetic, _, potential = self.energy()
        kT = 2.0 * kinetic / ((2.0 if self._planar else 3.0) * self.number)
        return kT if kT > 0.0 or baths else potential / self.number, max(baths, default=0.0)

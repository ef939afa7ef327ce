"""The parcel of air: molecules in a box, advanced exactly.

`ParcelSet` checks its arguments, arranges the data for the kernels, holds the random numbers and the
epoch of time, and turns the kernels' status codes into sentences.
"""

import math
from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.box import new_box
from atmosbox.engine.core.inputs import number
from atmosbox.engine.core.kind import classify
from atmosbox.engine.core.lift import FollowPressure
from atmosbox.engine.core.packing import refuse_solid
from atmosbox.engine.core.parcel import Array, Parcel, Snapshot
from atmosbox.engine.core.refusal import RefusedError, StalledError
from atmosbox.engine.core.state import EVENT, MOLECULE, SLOT_OFFSET, Cells, Gas, Modes, aligned_records
from atmosbox.engine.core.walls import HEAT_BATH, PISTON, POOL
from atmosbox.engine.exact.calendar import new_calendar
from atmosbox.engine.exact.cells import ROW, Grid, choose_grid, new_cells, new_rows
from atmosbox.engine.exact.epoch import next_time, set_back, whole_epochs
from atmosbox.engine.exact.exact import Status, specialise
from atmosbox.engine.exact.row_cells import TALLER, write_even_layers
from atmosbox.engine.exact.rows import FEWEST, MORE, MOST, copies_of, row_stride
from atmosbox.engine.exact.stall import crushing_height, is_jammed, why_crowded, why_crushed, why_stalled
from atmosbox.engine.exact.turning import HIGHEST, LOWEST, Ascent

__all__ = ["Arrays", "ParcelSet"]

_CHUNK = 200_000
_OVERLAP = 1e-9


class Arrays(NamedTuple):
    """What the kernels of a box work on: the arrays of the box itself, not copies of them.

    ``gas`` is their first argument, `Gas` or `WellGas`, and ``modes`` selects them; ``ascent`` is the piston that
    compiled code moves, None without one; ``now`` is the time that the clocks show, ``epoch_length`` the time after
    which they are set back, and ``clocks`` those of events that belong to no molecule [time]; ``start_energy`` is the
    energy at the start [energy]. ``grid`` are the cells, chosen for a ceiling at the height ``filled`` [length] and
    molecules of the radii ``size_radius : (size,)`` [length]; None if molecules attract each other.

    A box with liquid has its ``reservoir`` and its ``substance``; ``vapours`` is the number of molecules of water in
    vapour and liquid together, ``rotations`` the rotational degrees of freedom of all molecules together; ``drops``
    are those that are spheres. If molecules attract each other, ``full_depth : (kind, kind)`` are the depths of their
    wells at full strength [energy].
    """

    gas: Any
    modes: Modes
    ascent: Ascent | None
    now: float
    epoch_length: float
    clocks: Array
    start_energy: float
    grid: Grid | None
    filled: float
    size_radius: Array
    reservoir: Any = None
    substance: Any = None
    vapours: int = 0
    rotations: float = 0.0
    drops: Any = None
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

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        if self._collisions:
            refuse_solid(self._sides, self._diameter, self._planar)
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
        self._grid: Grid
        self._places: int
        self._lay_out()
        depth, i, j = self._overlap(self._gas())
        if depth > _OVERLAP:
            raise RefusedError(
                f"molecules {i} and {j} overlap at the start, by {depth:.3g} of their diameter: "
                "move them apart or make them smaller"
            )

    def _fill(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Write the molecules into the engine's arrays."""
        self._kinds, kind, self._size_radius = classify(
            self._mass, self._diameter, self._rotation, np.array(rotational_energy) if self._rotates else None
        )
        self._molecules = aligned_records(len(position), MOLECULE)
        for axis, name in enumerate("xyz"):
            self._molecules[name] = position[:, axis]
            self._molecules["v" + name] = velocity[:, axis]
        self._molecules["kind"] = kind
        self._fields = self._molecules.view(np.ndarray)  # the same memory; numpy reads its fields ten times faster

    def memory(self) -> int:
        """Return the memory of molecules, events, cells and calendar, and of the properties of molecules [bytes]."""
        arrays = [self._molecules, self._events, self._cells.row, self._calendar.time, self._calendar.winner]
        arrays += [self._kinds.rotational_energy, self._kinds.table, self._cells.boundary]
        for each in (self._mass, self._diameter, self._rotation):
            arrays.append(each if each.strides != (0,) else each[:1])  # a number shared by all is stored once
        return sum(int(a.nbytes) for a in arrays)

    def arrays(self) -> Arrays:
        """Return what the kernels of this box work on; they change as the box advances, and may be replaced."""
        return Arrays(
            gas=self._gas(),
            modes=self._modes,
            ascent=next(iter(self._ascent()), None),
            now=self._now,
            epoch_length=self._epoch_length,
            clocks=self._clocks,
            start_energy=self._start_energy,
            grid=getattr(self, "_grid", None),
            filled=float(self._filled),
            size_radius=self._size_radius,
        )

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; the box does not change."""
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
        """Advance the box to the time ``until`` [time since the start]: see `Parcel.advance`."""
        until = number(until, "until")
        if until < self.time:
            raise RefusedError(f"until = {until} lies before now, t = {self.time}: give a later time")
        while True:
            stop = min(until, self._next_turn() if not self._ascends else math.inf)
            local = stop - float(self._walls.epoch[0])
            if local > self._epoch_length and self._shift(local, watch):
                continue
            self._resolve(local, watch)
            if self._ascends or stop < self._next_turn():
                break
            self._turns[0] += 1
            self._drive()
            if watch is not None:
                watch(self.time)
            if stop >= until:
                break
        self._asked = until

    # ------------------------------------------------------------------ how events are resolved

    def _piston_turned(self) -> None:
        velocity = self.piston_velocity
        if self._ascends or not LOWEST * self._filled <= self.ceiling <= HIGHEST * self._filled:
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

    def _resolve(self, local: float, watch: Callable[[float], None] | None) -> None:
        """Resolve all events up to a local time."""
        self._asked = None
        crushed = math.inf
        if self.piston_velocity < 0.0 and not self._ascends:
            crushed = self._now + (self.ceiling - self._lowest_ceiling) / -self.piston_velocity
            if crushed <= self._now:
                raise StalledError(why_crushed(self))
        stop = min(local, crushed)
        unwatched = 0
        with np.errstate(over="ignore"):
            while True:
                status, done = self._proceed(stop)
                unwatched += done
                self._now = max(self._now, min(stop, self._next_time()))
                if status == Status.ROW_FULL:
                    self._grow_rows()
                elif status == Status.EPOCH_OVER:
                    self._refill_rows(float(self._calendar.time[1]))
                elif status == Status.OUTGROWN:
                    self._lay_out()
                elif status in (Status.STALLED, Status.CROWDED):
                    self._now = min(self._next_time(), stop)
                    raise StalledError(why_stalled(self) if status == Status.STALLED else why_crowded(self))
                elif status == Status.CRUSHED:
                    position, speed, since = self._walls.piston
                    self._now = float(since + (position - self._lowest_ceiling) / -speed)
                    raise StalledError(why_crushed(self))
                elif status == Status.TURNED:
                    self._now = float(self._walls.piston[2])
                    self._piston_turned()
                elif self.piston_velocity < 0.0 and is_jammed(self, self._fields, self._mass, self._start_energy):
                    self._now = min(self._next_time(), stop)
                    raise StalledError(why_crushed(self))
                elif status == Status.DONE:
                    break
                if watch is not None and (status == Status.BUSY or unwatched >= _CHUNK):
                    watch(float(self._walls.epoch[0]) + self._next_time())
                    unwatched = 0
        self._now = stop
        if crushed < local:
            raise StalledError(why_crushed(self))

    def _proceed(self, until: float) -> tuple[Status, int]:
        """Resolve a number of events up to a local time; return why the loop stopped, and their number."""
        status, done = self._advance(self._gas(), *self._ascent(), until, _CHUNK)
        return Status(status), int(done)

    @property
    def _ascends(self) -> bool:
        """Whether compiled code moves the piston: it knows one driver, and needs molecules of one size."""
        return type(self._driver) is FollowPressure and self._same_size and not self._first_drop

    def _ascent(self) -> tuple[Ascent] | tuple[()]:
        """Return the last argument of the kernels that move the piston; nothing if none does."""
        if not self._ascends:
            return ()
        assert isinstance(self._driver, FollowPressure)
        diameter = float(self._diameter[0])
        energy = self._start_energy, self._gravity_work
        heights = float(self._filled), float(self._lowest_ceiling)
        return (Ascent(self._driver.law(), self._turns, *heights, *energy, self._freedom, diameter),)

    def _next_turn(self) -> float:
        """Return when the driver is called next [time]."""
        return math.inf if self._driver is None else (int(self._turns[0]) + 1) * self._driver.interval

    def _gas(self) -> Gas:
        """Return all data of the kernels."""
        return Gas(
            self._molecules, self._events, self._kinds, self._cells,
            self._calendar, self._box, self._walls, self._tallies,
        )  # fmt: skip

    def _shift(self, local: float, watch: Callable[[float], None] | None) -> bool:
        """Move the epoch on towards the next event; return False if no event will ever come."""
        if self._now < self._epoch_length:
            self._resolve(self._epoch_length, watch)
        ahead = min(self._next_time(), self._next_turn() - float(self._walls.epoch[0]))
        step = float(whole_epochs(ahead, self._epoch_length))
        if step > 0.0:
            set_back(step, self._gas(), self._clocks, self._modes)
            self._now -= step
        return step > 0.0

    def _next_time(self) -> float:
        """Return the local time of the next event."""
        return float(next_time(self._gas(), self._clocks))

    @property
    def _clocks(self) -> Array:
        """The times of events that belong to no molecule: here there are none."""
        return np.full(1, math.inf)

    def _grow_rows(self) -> None:
        """Make the rows of all cells longer."""
        if self._modes.rows:
            if not self._enlarge_rows():
                self._lay_out_closer()
            else:
                self._refill_rows(self._now)
            return
        old = self._cells
        stride = 2 * old.stride
        cells = old.number_x * old.number_y * old.number_z
        row = new_rows(self._grid, stride)
        row.reshape(cells, stride)[:, : old.stride] = old.row.reshape(cells, old.stride)
        self._cells = old._replace(row=row, stride=stride)

    def _refill_rows(self, now: float) -> None:
        """Write the copies in all rows again at a local time; make the rows longer or lay out other cells if needed."""
        while self._refill(self._gas(), now):
            if not self._enlarge_rows():
                return self._lay_out_closer()

    def _enlarge_rows(self) -> bool:
        """Make new, empty rows with more places; return whether that is possible."""
        self._places += MORE
        if self._places > MOST:
            return False
        self._new_cells(row_stride(self._places, self._modes.mixed))
        return True

    def _new_cells(self, stride: int) -> None:
        """Make empty rows of ``stride`` words for the chosen cells."""
        grid, n = self._grid, len(self._fields)
        slot = np.zeros((0, 3), np.uint16)
        if n:
            slot = np.ndarray((n, 3), np.uint16, self._events.data, SLOT_OFFSET, (EVENT.itemsize, 2))
        row = new_rows(grid, stride)
        radius = 0.5 * self.diameter.mean() if self.diameter.size else 0.0
        copies = copies_of(
            row, self._events.view(np.ndarray), grid.edges, self._periodic, float(radius), self._epoch_length,
            planar=self._planar,
        )  # fmt: skip
        self._cells = new_cells(grid, slot, row, stride, copies)

    def _lay_out_closer(self) -> None:
        """Lay out other cells because a row has too many molecules: layers that follow the molecules, or else lists."""
        grid, found = self._grid, 0
        edge = np.zeros(grid.wanted + 1)
        if grid.wanted > 1:
            count = np.bincount(self._cells.slot[self._present, 2] >> 1, minlength=grid.number[2])
            found = write_even_layers(count, grid.edges[2], grid.wanted, grid.thinnest, edge)
        self._crowded = found == 0
        self._enter(self._choose(edge[: found + 1] if found else None))

    def _lay_out(self) -> None:
        """Choose cells for the box as it is now and predict all events again."""
        self._enter(self._choose())

    def _choose(self, layers: Array | None = None) -> Grid:
        """Choose cells for the box as it is now, with ``layers`` as edges along z if they are given."""
        n = len(self._fields)
        moving = self._walls.law[5] == PISTON
        self._filled = self.ceiling
        self._lowest_ceiling = crushing_height(self._sides, self._diameter, planar=self._planar)
        top = TALLER * self._filled if moving else self._filled
        kT = self._mean_kT()
        weight = float(self._mass.mean()) * self.gravity if n else 0.0
        contacts = self._collisions and bool(n) and float(self._diameter.max()) > 0.0
        return choose_grid(
            np.array([self._sides[0], self._sides[1], top]),
            self._periodic,
            self._size_radius,
            n if contacts else 1,
            exact_radius=len(self._kinds.table) == 1,
            planar=self._planar,
            filled=self._filled,
            open_top=bool(moving),
            scale_height=kT / weight if weight > 0.0 and kT > 0.0 else math.inf,
            rows=contacts and not self._crowded,
            layers=layers,
        )

    def _enter(self, grid: Grid) -> None:
        """Enter all molecules into the cells of a grid, and have their events predicted."""
        n = len(self._fields)
        self._grid = grid
        self._modes = Modes(
            contacts=self._collisions and bool(n) and float(self._diameter.max()) > 0.0,
            gravity=self.gravity > 0.0,
            rotation=self._rotates,
            mixed=len(self._kinds.table) > 1,
            spanning=bool(grid.spanning),
            periodic=any(self._periodic),
            piston=bool(self._walls.law[5] == PISTON),
            phases=not isinstance(self._present, slice),
            pool=bool(self._walls.law[4] == POOL),
            drops=self._first_drop,
            images=grid.images,
            ascends=self._ascends,
            rows=grid.rows,
        )
        self._find_kernels()
        self._events = aligned_records(n, EVENT)
        self._places = FEWEST
        self._new_cells(row_stride(self._places, self._modes.mixed) if grid.rows else ROW)
        while True:
            self._calendar = new_calendar(n)
            if self._place(self._gas(), self._now) != Status.ROW_FULL:
                return
            if not grid.rows:
                self._new_cells(2 * self._cells.stride)
            elif not self._enlarge_rows():
                return self._lay_out_closer()

    def _find_kernels(self) -> None:
        self._place, self._advance, self._replan, self._overlap, self._refill = specialise(self._modes)

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

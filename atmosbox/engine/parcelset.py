"""The parcel of air: molecules in a box, advanced exactly.

`ParcelSet` checks what it is given, lays it out for the kernels, owns the random numbers and the moving
epoch of time, and turns the kernels' status codes into sentences.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.calendar import new_calendar
from atmosbox.engine.cells import ROW, choose_grid, size_classes
from atmosbox.engine.exact import BUSY, ROW_FULL, STALLED, specialise
from atmosbox.engine.inputs import column, inside, matrix, natural_time, number, sides_of, whole
from atmosbox.engine.packing import packing_fraction
from atmosbox.engine.refusal import RefusedError, StalledError
from atmosbox.engine.state import EVENT, KIND, MOLECULE, SLOT_OFFSET, Box, Cells, Kinds, Modes, Tallies, aligned_records
from atmosbox.engine.walls import HEAT_BATH, PERIODIC, PISTON, WALL_NAMES, Specular, Wall, new_walls, wall_kT

__all__ = ["Driver", "ParcelSet", "Snapshot"]

_CHUNK = 200_000
_OVERLAP = 1e-9
Array = NDArray[np.float64]


class Snapshot(NamedTuple):
    """All molecules at one time.

    ``position``, ``velocity : (molecule, axis)`` [length, length/time]; ``rotational_energy :
    (molecule,)`` [energy].
    """

    time: float
    position: Array
    velocity: Array
    rotational_energy: Array


class Driver(Protocol):
    """What moves the piston: asked for its velocity at every multiple of ``interval``."""

    interval: float

    def velocity(self, parcel: "ParcelSet") -> float:
        """Return the velocity [length/time] from now until the next multiple of the interval."""


class ParcelSet:
    """A set of molecules with its box.

    Parameters
    ----------
    position, velocity : (molecule, axis)
        Centres [length] and velocities [length/time].
    length
        The three sides of the box [length]; along z up to where the ceiling starts.
    walls
        Six laws: x low, x high, y low, y high, z low, z high; specular by default.
    mass, diameter, rotation : (molecule,) or one number
        Mass [mass], diameter [length; 0 makes an ideal gas], rotational degrees of freedom (0, 2 or 3).
    rotational_energy : (molecule,)
        At the start [energy]; zero by default.
    gravity
        Downward acceleration [length/time^2].
    planar
        Whether this is a plane gas: all y and all y velocities are then those given, and never change.
    collision_number
        How many contacts pass, on average, between two exchanges of energy with rotation, >= 1, ``inf``
        for never.
    layers
        Number of layers of equal thickness by which the virial of contacts is counted.
    seed
        Seed of the random numbers.
    driver
        What moves the piston.

    Raises
    ------
    RefusedError
        If a number is impossible, or molecules overlap or stand outside the box.

    Examples
    --------
    Two molecules that approach each other along x bounce once and keep their energy:

    >>> pair = ParcelSet([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))
    >>> pair.advance(1.0)
    >>> pair.contacts, pair.snapshot().velocity[:, 0].tolist()
    (1, [-1.0, 1.0])
    """

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        *,
        length: Sequence[float],
        walls: Sequence[Wall] = (Specular(),) * 6,
        mass: ArrayLike = 1.0,
        diameter: ArrayLike = 1.0,
        rotation: ArrayLike = 0.0,
        rotational_energy: ArrayLike | None = None,
        gravity: float = 0.0,
        planar: bool = False,
        collision_number: float = 1.0,
        layers: int = 1,
        seed: int = 0,
        driver: Driver | None = None,
    ) -> None:
        x = matrix(position, "position")
        v = matrix(velocity, "velocity")
        if x.shape != v.shape:
            raise RefusedError(f"{len(x)} positions and {len(v)} velocities: give one velocity for each position")
        n = len(x)
        self._mass = column(mass, n, "mass", above=0.0)
        self._diameter = column(diameter, n, "diameter", least=0.0)
        self._rotation = column(rotation, n, "rotation", least=0.0)
        if not np.isin(self._rotation, (0.0, 2.0, 3.0)).all():
            raise RefusedError("the rotational degrees of freedom of a molecule are 0, 2 or 3")
        spin = column(0.0 if rotational_energy is None else rotational_energy, n, "rotational_energy", least=0.0)
        sides = sides_of(length)
        gravity = number(gravity, "gravity", least=0.0)
        collision_number = number(collision_number, "collision_number", least=1.0, infinite=True)
        layers = whole(layers, "layers", least=1)
        seed = whole(seed, "seed", least=0)
        if planar and (v[:, 1] != 0.0).any():
            raise RefusedError("a plane gas has no velocity along y: make the second column of velocity 0")
        if planar and n and np.ptp(x[:, 1]) > 0.0:
            raise RefusedError("the centres of a plane gas lie in one plane: make the second column of position equal")
        self._walls = new_walls(tuple(walls) if isinstance(walls, Sequence) else (), float(sides[2]))
        law = self._walls.law
        self._periodic = (law[0] == PERIODIC, law[2] == PERIODIC, law[4] == PERIODIC)
        if gravity > 0.0 and self._periodic[2]:
            raise RefusedError("a box that is periodic along z cannot have gravity: molecules would fall for ever")
        if driver is not None and law[5] != PISTON:
            raise RefusedError("a driver needs a piston: make wall z_high a Piston")
        if driver is not None and not (math.isfinite(driver.interval) and driver.interval > 0.0):
            raise RefusedError(f"interval of the driver = {driver.interval} must be finite and above 0")
        self._sides = sides
        self._planar = bool(planar)
        self._driver = driver
        x = inside(x, self._diameter, sides, self._periodic)
        if planar:  # nothing ever moves along y
            self._periodic = (self._periodic[0], False, self._periodic[2])
        self._kinds, kind = self._classify(spin)
        self._number = n
        self._freedom = (2.0 if planar else 3.0) + (float(self._rotation.mean()) if n else 0.0)
        self._molecules = aligned_records(n, MOLECULE)
        for axis, name in enumerate("xyz"):
            self._molecules[name] = x[:, axis]
            self._molecules["v" + name] = v[:, axis]
        self._molecules["kind"] = kind
        self._spread = natural_time(v, sides, n, self._walls, self._mass, gravity)
        self._box = self._new_box(gravity, collision_number)
        words = np.random.SeedSequence(seed).generate_state(1, np.uint64)
        self._tallies = Tallies(
            count=np.zeros(5, np.int64),
            impulse=np.zeros(6),
            heat=np.zeros(6),
            hits=np.zeros(6, np.int64),
            work=np.zeros(6),
            virial=np.zeros(layers),
            layer_scale=layers / float(sides[2]),
            random=words,
            progress=np.array([-math.inf, 0.0]),
        )
        self._epoch_length = 2.0 ** math.floor(math.log2(1024.0 * self._spread))
        self._now = 0.0
        self._asked: float | None = None
        self._turn = 0
        self._cells: Cells
        self._lay_out()
        depth, i, j = self._overlap(self._molecules, self._kinds, self._cells, self._box)
        if n > 1 and depth > _OVERLAP:
            raise RefusedError(
                f"molecules {i} and {j} overlap at the start, by {depth:.3g} of their diameter: "
                "move them apart or make them smaller"
            )
        self._start_energy = sum(self.energy())
        self._drive()

    def __repr__(self) -> str:
        """Return a line that says what is in the box."""
        sides = " x ".join(f"{side:.6g}" for side in self.length)
        return f"<ParcelSet: {self.number} molecules in {sides}, t = {self.time:.6g}, {self.contacts} contacts>"

    # ------------------------------------------------------------------ what it holds

    @property
    def number(self) -> int:
        """Number of molecules."""
        return self._number

    @property
    def time(self) -> float:
        """Time since the start [time]."""
        return float(self._walls.epoch[0]) + self._now if self._asked is None else self._asked

    @property
    def length(self) -> Array:
        """The three sides of the box now [length]."""
        sides = self._sides.copy()
        sides[2] = self.ceiling
        return sides

    @property
    def ceiling(self) -> float:
        """Height of the ceiling now [length]."""
        position, speed, since = self._walls.piston
        return float(position + speed * (self._now - since))

    @property
    def volume(self) -> float:
        """Volume of the box now [length^3]; of a plane gas, its area [length^2]."""
        sides = self.length
        return float(sides[0] * sides[2] if self._planar else math.prod(sides))

    @property
    def open_density(self) -> float:
        """Sum over molecules of one over the volume that its centre can reach now [1/length^3; planar: 1/length^2].

        Times kT it is the pressure on the walls of molecules that never meet, exactly; the volume of the
        box would be too large by the layer, half a diameter thin, that no centre enters.
        """
        if not self.number:
            return 0.0
        sides = self.length
        alike = len(self._kinds.table) == 1
        diameter = float(self._diameter[0]) if alike else self._diameter
        share = 1.0 if alike else np.ones(self.number)
        for axis in (0, 2) if self._planar else (0, 1, 2):
            share = share * (sides[axis] - (0.0 if self._periodic[axis] else diameter))
        each = 1.0 / share
        return float(np.sum(np.full(self.number, each) if alike else each))

    @property
    def piston_velocity(self) -> float:
        """Velocity of the ceiling [length/time]."""
        return float(self._walls.piston[1])

    @property
    def periodic(self) -> tuple[bool, bool, bool]:
        """Which axes are periodic."""
        return self._periodic

    @property
    def gravity(self) -> float:
        """Downward acceleration [length/time^2]."""
        return self._box.gravity

    @property
    def planar(self) -> bool:
        """Whether this is a plane gas."""
        return self._planar

    @property
    def mass(self) -> Array:
        """Mass of each molecule [mass]."""
        return self._mass

    @property
    def diameter(self) -> Array:
        """Diameter of each molecule [length]."""
        return self._diameter

    @property
    def degrees_of_freedom(self) -> float:
        """Translational and rotational degrees of freedom per molecule, on average."""
        return self._freedom

    @property
    def contacts(self) -> int:
        """Number of contacts since the start."""
        return int(self._tallies.count[0])

    @property
    def events(self) -> dict[str, int]:
        """Numbers of contacts, cells entered and left, stale predictions and wall hits since the start."""
        names = ("contacts", "entered", "left", "stale", "wall_hits")
        return {name: int(count) for name, count in zip(names, self._tallies.count, strict=True)}

    @property
    def wall_impulse(self) -> Array:
        """Outward normal impulse that each wall has taken up since the start [momentum]."""
        return np.array(self._tallies.impulse)

    @property
    def wall_heat(self) -> Array:
        """Heat that each wall has given since the start [energy]."""
        return np.array(self._tallies.heat)

    @property
    def wall_hits(self) -> NDArray[np.int64]:
        """How often each wall has been hit since the start."""
        return np.array(self._tallies.hits)

    def wall_kT(self) -> Array:
        """Return the temperature of each wall now [energy], NaN for one that has none."""
        plain = getattr(wall_kT, "py_func", wall_kT)  # asked once a frame: not worth compiling
        kT = [
            plain(self._walls, w, self.time) if law == HEAT_BATH else math.nan for w, law in enumerate(self._walls.law)
        ]
        return np.array(kT)

    @property
    def work(self) -> float:
        """Work that the piston has done on the molecules since the start [energy]."""
        return float(self._tallies.work.sum())

    @property
    def virial(self) -> Array:
        """Sum of r . dp over contacts since the start, by layer [energy]."""
        return np.array(self._tallies.virial)

    def memory(self) -> int:
        """Return the bytes that molecules, events, cells and calendar take."""
        arrays = (self._molecules, self._events, self._cells.row, self._calendar.time, self._calendar.winner)
        return sum(int(a.nbytes) for a in arrays) + int(self._kinds.rotational_energy.nbytes)

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; nothing in the box changes by being looked at."""
        m = self._molecules
        dt = self._now - m["clock"]
        position = np.stack([m["x"] + dt * m["vx"], m["y"] + dt * m["vy"], m["z"] + dt * m["vz"]], axis=1)
        velocity = self._velocity()
        if self.gravity > 0.0:
            position[:, 2] -= 0.5 * self.gravity * dt * dt
            velocity[:, 2] -= self.gravity * dt
        for axis in range(3):
            if self._periodic[axis]:
                position[:, axis] = np.mod(position[:, axis], self._sides[axis])
        spin = np.array(self._kinds.rotational_energy) if self._rotates else np.zeros(self.number)
        return Snapshot(self.time, position, velocity, spin)

    def _velocity(self) -> Array:
        """Return the velocity of each molecule at the time of its clock [length/time]."""
        m = self._molecules
        return np.stack([m["vx"], m["vy"], m["vz"]], axis=1)

    def energy(self) -> tuple[float, float, float]:
        """Return kinetic, rotational and potential energy now [energy]."""
        position, velocity = self.snapshot()[1:3]
        kinetic = 0.5 * float(np.sum(self._mass * np.sum(velocity * velocity, axis=1)))
        rotational = float(np.sum(self._kinds.rotational_energy)) if self._rotates else 0.0
        potential = self.gravity * float(np.sum(self._mass * position[:, 2])) if self.gravity else 0.0
        return kinetic, rotational, potential

    def ledger(self) -> float:
        """Return by how much the energy ledger fails to close, relative to the energy that there is.

        Kinetic + rotational + potential = what there was at the start + heat from the walls + work of the
        piston.
        """
        total = sum(self.energy())
        given = float(self._tallies.heat.sum()) + self.work
        scale = max(abs(total), abs(self._start_energy))
        return abs(total - self._start_energy - given) / scale if scale > 0.0 else 0.0

    def internal_energy(self) -> float:
        """Return kinetic + rotational energy from the ledger, without looking at the molecules [energy].

        Meant for boxes without gravity, where it costs nothing however many molecules there are.
        """
        return self._start_energy + float(self._tallies.heat.sum()) + self.work

    # ------------------------------------------------------------------ what it does

    def advance(self, until: float, watch: Callable[[float], None] | None = None) -> None:
        """Let time pass until ``until`` [time since the start].

        Parameters
        ----------
        until
            When to stop; however a run is cut into pieces, its molecules do the same.
        watch
            Called with the time every tenth of a second or so; what it raises (Ctrl-C) leaves a state
            that can go on.

        Raises
        ------
        RefusedError
            If ``until`` lies in the past or is not finite.
        StalledError
            If events pile up without end in a vanishing time.
        """
        until = number(until, "until")
        if until < self.time:
            raise RefusedError(f"until = {until} lies before now, t = {self.time}: give a later time")
        while True:
            stop = until
            if self._driver is not None:
                stop = min(stop, (self._turn + 1) * self._driver.interval)
            local = stop - float(self._walls.epoch[0])
            if local > self._epoch_length and self._shift(local, watch):
                continue
            self._resolve(local, watch)
            if self._driver is None or stop < (self._turn + 1) * self._driver.interval:
                break
            self._turn += 1
            self._drive()
            if stop >= until:
                break
        self._asked = until

    def set_piston_velocity(self, velocity: float) -> None:
        """Let the piston move at another velocity [length/time] from now on.

        Raises
        ------
        RefusedError
            If there is no piston, or the velocity is not finite.
        """
        if self._walls.law[5] != PISTON:
            raise RefusedError("this box has no piston: make wall z_high a Piston")
        velocity = number(velocity, "velocity of the piston")
        self._walls.piston[:] = self.ceiling, velocity, self._now
        if self.ceiling > 1.5 * self._filled or self.ceiling < 0.6 * self._filled:
            self._lay_out()
            return
        lowest = self.ceiling
        if velocity < 0.0:
            lowest += velocity * self._driver.interval if self._driver is not None else -math.inf
        self._replan(
            self._molecules,
            self._events,
            self._kinds,
            self._cells,
            self._calendar,
            self._box,
            self._walls,
            self._now,
            lowest,
        )

    # ------------------------------------------------------------------ how

    def _drive(self) -> None:
        if self._driver is not None:
            self.set_piston_velocity(self._driver.velocity(self))

    def _resolve(self, local: float, watch: Callable[[float], None] | None) -> None:
        """Resolve all events up to a local time."""
        self._asked = None
        crushed = math.inf
        if self.piston_velocity < 0.0:
            crushed = self._now + (self.ceiling - self._lowest_ceiling) / -self.piston_velocity
            if crushed <= self._now:
                raise StalledError(self._why_crushed())
        stop = min(local, crushed)
        with np.errstate(over="ignore"):
            while True:
                status, _ = self._advance(
                    self._molecules, self._events, self._kinds, self._cells, self._calendar,
                    self._box, self._walls, self._tallies, stop, _CHUNK,
                )  # fmt: skip
                self._now = max(self._now, min(stop, float(self._calendar.time[1])))
                if status == ROW_FULL:
                    self._grow_rows()
                elif status == STALLED:
                    self._now = min(float(self._calendar.time[1]), stop)
                    raise StalledError(self._why_stalled())
                elif self.piston_velocity < 0.0 and self._is_jammed():
                    self._now = min(float(self._calendar.time[1]), stop)
                    raise StalledError(self._why_crushed())
                elif status == BUSY:
                    if watch is not None:
                        watch(float(self._walls.epoch[0]) + float(self._calendar.time[1]))
                else:
                    break
        self._now = stop
        if crushed < local:
            raise StalledError(self._why_crushed())

    def _shift(self, local: float, watch: Callable[[float], None] | None) -> bool:
        """Move the epoch on, up to the next thing that happens; return whether anything is left to happen at all.

        By how much depends on events alone, never on where a run is cut.
        """
        if self._now < self._epoch_length:
            self._resolve(self._epoch_length, watch)
        ahead = float(self._calendar.time[1])
        if self._driver is not None:
            ahead = min(ahead, (self._turn + 1) * self._driver.interval - float(self._walls.epoch[0]))
        if math.isinf(ahead):
            return False
        self._rebase(max(1.0, math.floor(ahead / self._epoch_length)) * self._epoch_length)
        return True

    def _rebase(self, step: float) -> None:
        """Let all clocks read small numbers again, so that time keeps its digits for ever."""
        self._molecules["clock"] -= step
        self._events["contact_time"] -= step
        times = self._calendar.time
        times -= step
        self._walls.piston[2] -= step
        self._tallies.progress[0] -= step
        self._walls.epoch[0] += step
        self._now -= step

    def _grow_rows(self) -> None:
        old = self._cells
        stride = 2 * old.stride
        cells = old.number_x * old.number_y * old.number_z
        row = aligned_records(cells * stride, np.dtype([("i", "u4")]))["i"]
        row = np.ascontiguousarray(row)
        row.reshape(cells, stride)[:, : old.stride] = old.row.reshape(cells, old.stride)
        self._cells = old._replace(row=row, stride=stride)

    def _lay_out(self) -> None:
        """Choose cells for the box as it is now and plan every molecule's event anew."""
        n = self.number
        moving = self._walls.law[5] == PISTON
        self._filled = self.ceiling
        self._lowest_ceiling = self._crushing_height()
        self._cells_top = 1.75 * self._filled if moving else self._filled
        kT = self._mean_kT()
        weight = float(self._mass.mean()) * self.gravity if n else 0.0
        contacts = bool(n) and float(self._diameter.max()) > 0.0
        grid = choose_grid(
            np.array([self._sides[0], self._sides[1], self._cells_top]),
            self._periodic,
            self._size_radius,
            n if contacts else 1,
            exact_radius=len(self._kinds.table) == 1,
            planar=self._planar,
            filled=self._filled,
            open_top=bool(moving),
            scale_height=kT / weight if weight > 0.0 and kT > 0.0 else math.inf,
        )
        self._modes = Modes(
            contacts=contacts,
            gravity=self.gravity > 0.0,
            rotation=self._rotates,
            mixed=len(self._kinds.table) > 1,
            spanning=grid.spanning,
            periodic=any(self._periodic),
            piston=bool(moving),
        )
        place, self._advance, self._replan, self._overlap = specialise(self._modes)
        self._events = aligned_records(n, EVENT)
        slot = np.zeros((0, 3), np.uint16)
        if n:
            slot = np.ndarray((n, 3), np.uint16, self._events.data, SLOT_OFFSET, (EVENT.itemsize, 2))
        stride = ROW
        while True:
            cells = math.prod(grid.number)
            self._cells = Cells(
                row=np.ascontiguousarray(aligned_records(cells * stride, np.dtype([("i", "u4")]))["i"]),
                stride=stride,
                boundary=grid.boundary,
                first=grid.first,
                span=grid.span,
                slot=slot,
                number_x=grid.number[0],
                number_y=grid.number[1],
                number_z=grid.number[2],
                last_slot_x=grid.last_slot[0],
                last_slot_y=grid.last_slot[1],
                last_slot_z=grid.last_slot[2],
            )
            self._calendar = new_calendar(n)
            status = place(
                self._molecules,
                self._events,
                self._kinds,
                self._cells,
                self._calendar,
                self._box,
                self._walls,
                self._now,
            )
            if status != ROW_FULL:
                return
            stride *= 2

    def _crushing_height(self) -> float:
        """Return how low the ceiling may come: molecules filling 0.6 of the box, or a thousandth of the start."""
        sigma = self._diameter
        lowest = 1e-3 * float(self._sides[2])
        if sigma.size:
            filled = packing_fraction([float(self._sides[0]), float(self._sides[1]), 1.0], sigma, planar=self._planar)
            lowest = max(lowest, filled / 0.6, 1.02 * float(sigma.max()))
        return lowest

    def _classify(self, spin: Array) -> tuple[Kinds, NDArray[np.int64]]:
        """Gather equal molecules into kinds."""
        table, kind = np.unique(
            np.stack([self._mass, 0.5 * self._diameter, self._rotation], axis=1), axis=0, return_inverse=True
        )
        if not len(table):
            table = np.array([[1.0, 0.0, 0.0]])
        classes, self._size_radius = size_classes(table[:, 1])
        records = aligned_records(len(table), KIND)
        records["mass"], records["radius"], records["rotation"] = table.T
        records["size_class"] = classes
        self._rotates = bool((self._rotation > 0.0).any())
        return Kinds(records, spin if self._rotates else np.zeros(1)), kind.reshape(-1)

    def _new_box(self, gravity: float, collision_number: float) -> Box:
        length = [float(side) for side in self._sides]
        if self._walls.law[5] == PISTON:
            length[2] = math.inf
        inverse = [1.0 / float(side) if turn else 0.0 for side, turn in zip(self._sides, self._periodic, strict=True)]
        return Box(
            length_x=length[0],
            length_y=length[1],
            length_z=length[2],
            inverse_x=inverse[0],
            inverse_y=inverse[1],
            inverse_z=inverse[2],
            gravity=float(gravity),
            planar=self._planar,
            exchange=1.0 / collision_number,
            stall=1e-9 * self._spread,
        )

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

    def _is_jammed(self) -> bool:
        """Tell whether the piston has heated the molecules a million times, as only one that crushes them can.

        Between jammed spheres the gaps close while the speeds grow as one over them: the events have no end.
        """
        kinetic = 0.5 * float(np.sum(self._mass * np.sum(self._velocity() ** 2, axis=1)))
        baths = [float(kT) for kT in self.wall_kT() if math.isfinite(kT)]
        usual = self._start_energy + 2.0 * float(self._mass.sum()) * self.piston_velocity**2
        return kinetic > 1e6 * (usual + 2.0 * self.number * max(baths, default=0.0))

    def _why_crushed(self) -> str:
        return (
            f"the piston has come down to {self.ceiling:.6g} at t = {self.time:.6g}, where it would crush the "
            "molecules: stop it earlier, or let it move more slowly"
        )

    def _why_stalled(self) -> str:
        """Return a sentence on why events pile up, naming what to change."""
        baths = [w for w in range(6) if self._walls.law[w] == HEAT_BATH]
        kT = self.wall_kT()
        coldest = min(baths, key=lambda w: kT[w], default=None)
        mean = 2.0 * self.energy()[0] / (3.0 * self.number)
        if self._walls.law[5] == PISTON and self.piston_velocity < 0.0:
            return self._why_crushed()
        if coldest is not None and (kT[coldest] <= 1e-6 * mean or kT[coldest] < 1e-100 or self.gravity > 0.0):
            cause = (
                f"wall {WALL_NAMES[coldest]} at kT = {kT[coldest]:.3g} is too cold: "
                f"warm it{', or reduce the gravity of ' + format(self.gravity, '.3g') if self.gravity else ''}"
            )
        elif self.gravity > 0.0:
            cause = f"molecules come to rest: reduce the gravity of {self.gravity:.3g}, or give them more energy"
        else:
            cause = "molecules are jammed: lower the packing fraction"
        return f"events pile up without end at t = {self.time:.6g}: {cause}"

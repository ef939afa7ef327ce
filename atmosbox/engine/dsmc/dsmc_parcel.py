"""The parcel of air, advanced by direct simulation Monte Carlo: for columns and parcels of many molecules."""

import math
from collections.abc import Sequence
from typing import Any, ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.inputs import sum_of_squares
from atmosbox.engine.core.jit import use_threads
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.engine.core.parcel import Arrangement, Array, Snapshot
from atmosbox.engine.core.refusal import RefusedError, StalledError, number, shown, whole
from atmosbox.engine.dsmc.columns import Columns, March, MoleculeKinds, new_columns, new_gather, new_grid, new_workspace
from atmosbox.engine.dsmc.dsmc import numbers_of_cells, specialise
from atmosbox.engine.dsmc.pairing import new_tries

_REGROUP, _REGROUP_MANY, _MANY = 48, 16, 200_000
_THREADED = 10_000
_FASTEST = 6.5
_FORGET = 1.0 - 1.0 / 512.0
_COLUMNS = ("x", "y", "z", "vx", "vy", "vz", "spin")


class DsmcParcel(MarchingParcel):
    """A parcel of dilute gas whose molecules collide with random partners nearby.

    Its other parameters, and its properties, are described at `Parcel`; the method, at `dsmc`. Molecules have
    the cross section pi sigma^2 of spheres of their diameter sigma but no excluded volume: they may overlap, the
    pressure is n kT, and the virial of contacts stays 0. All molecules are of one kind.

    Parameters
    ----------
    position, velocity, **box
        See `Parcel`.
    dt
        Length of a step, above 0 up to 10, in units of the mean free time at the start and at the mean density. If the
        mean free path is longer than the box, the time in which a molecule crosses the box is used instead.
    occupancy
        Mean number of molecules in a cell, at least 1.
    cell
        Side of a cell in mean free paths at the start and at the mean density, instead of an occupancy; as nearly as
        the box allows.
    threads
        Number of threads that share the work of 10 000 molecules or more; the result is the same for any number.

    Raises
    ------
    RefusedError
        If a parameter is impossible, the gas is plane, or its molecules are not of one kind.

    Notes
    -----
    The errors of transport grow with the squares of step and cell [1]_: of a viscosity by 11 % (Δx / λ)^2, of a
    conductivity by 4.5 % (Δx / λ)^2; and with one over the occupancy, because the molecules of a cell keep their common
    momentum. When a piston moves, the cells stretch with the box, and the mean free path changes with them.

    References
    ----------
    .. [1] Alexander, F. J., Garcia, A. L., Alder, B. J. (1998), Phys. Fluids 10, 1540, doi:10.1063/1.869674.

    Examples
    --------
    Twenty thousand molecules that start with equal speeds collide until the speeds differ; their energy stays the same:

    >>> rng = np.random.default_rng(1)
    >>> angle = rng.normal(size=(20_000, 3))
    >>> velocity = angle / np.sqrt(np.sum(angle**2, axis=1))[:, None]
    >>> gas = DsmcParcel(1.0 + 98.0 * rng.random((20_000, 3)), velocity, length=(100, 100, 100))
    >>> gas.advance(200.0)
    >>> speed = np.sqrt(np.sum(gas.snapshot().velocity**2, axis=1))
    >>> bool(speed.std() > 0.3), round(float(np.mean(speed**2)), 9)
    (True, 1.0)
    """

    engine: ClassVar[str] = "dsmc"
    _frugal = True
    _wet = _pool = False
    _water: Any = None

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        *,
        dt: float = 0.2,
        occupancy: float = 10.0,
        cell: float | None = None,
        threads: int = 1,
        **box: Unpack[Arrangement],
    ) -> None:
        self._share = number(dt, "dt", above=0.0, most=10.0)
        self._occupancy = number(occupancy, "occupancy", least=1.0)
        self._cell = None if cell is None else number(cell, "cell", least=1e-3, most=1e3)
        self._threads = whole(threads, "threads", least=1)
        if box.get("planar"):
            raise RefusedError("the cells of dsmc are three-dimensional: a plane gas needs the engine exact")
        super().__init__(position, velocity, **box)

    # ------------------------------------------------------------------ the state

    @property
    def ideal(self) -> bool:
        """Whether the pressure is n kT: always true here, as there is no excluded volume."""
        return True

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are after the last step, in the order of their indices."""
        s, slot = self._columns, self._slots()
        position, velocity = (np.stack([column[slot] for column in part], axis=1) for part in (s[:3], s[3:6]))
        spin = s.spin[slot] if self._rotates else np.zeros(self._number)
        return Snapshot(self.time, position, velocity, spin)

    def _slots(self) -> Any:
        """Return the slots in the order of molecules; of many, reading from them is faster than writing to them."""
        slot = np.empty(self._number, np.intp)
        slot[self._columns.identity] = np.arange(self._number)
        return slot

    def energy(self) -> tuple[float, float, float]:
        """Return kinetic, rotational and potential energy now [energy]."""
        potential = self.gravity * self._gas.mass * float(np.sum(self._columns.z)) if self.gravity else 0.0
        spin = float(np.sum(self._columns.spin[: self._number])) if self._rotates else 0.0
        return self._kinetic(), spin, potential

    def _kinetic(self) -> float:
        """Return the kinetic energy of all molecules [energy]."""
        return float(0.5 * self._gas.mass * self._number * self._mean_square_speed())

    def memory(self) -> int:
        """Return the memory of molecules and cells, and of sorting the molecules into cells [bytes]."""
        arrays = (*self._columns, self._spare, *self._grid[3:], *self._workspace, *self._tries)
        return sum(int(a.nbytes) for a in arrays)

    # ------------------------------------------------------------------ how steps are made

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        n = self._number
        self._gas, kind = self._classify()
        self._cross_section = 4.0 * math.pi * self._gas.radius * self._gas.radius if self._collisions else 0.0
        self._box = self._new_box()
        sides = self._open_sides()
        if self._room and not min(sides) > 0.0:
            raise RefusedError(
                f"length = {shown(tuple(self._sides))} leaves no room between walls: make the diameter smaller"
            )
        for axis in range(3):
            if self._periodic[axis]:
                np.mod(position[:, axis], self._sides[axis], out=position[:, axis])
        room = self._room
        x, y, z, vx, vy, vz, self._spare = new_columns(room, 7)
        x[:n], y[:n], z[:n] = position.T
        del position  # a copy for ten million molecules takes much memory
        vx[:n], vy[:n], vz[:n] = velocity.T
        del velocity
        spin = np.zeros(room if self._rotates else 1)
        spin[:n] = rotational_energy if self._rotates else 0.0
        cell, order = np.zeros(room, np.uint32), np.zeros(room, np.uint32)
        self._columns = Columns(x, y, z, vx, vy, vz, spin, np.arange(room, dtype=np.uint32), cell, order, kind)
        self._round = _REGROUP_MANY if room >= _MANY else _REGROUP
        self._workers = self._threads if room >= _THREADED else 1
        self._lay_out(sides)
        self._find_kernels()
        fastest = self._fastest()
        self._grid.fastest[:] = _FASTEST * fastest
        path = min(self._path(math.prod(sides)), *sides)
        step = self._share * (path / (math.sqrt(8.0 / math.pi) * fastest) if fastest > 0.0 else self._spread)
        # however rarely molecules collide, a step is shorter than the time of their hops on the floor
        self._time_step = min(step, 0.5 * fastest / self._gravity) if self._gravity > 0.0 and fastest > 0.0 else step

    def _classify(self) -> tuple[MoleculeKinds, Any]:
        """Return the properties of the molecules, and the column of kinds, which is unused: there is one kind."""
        n = self._number
        if n and not self._alike:
            raise RefusedError(
                "the molecules of dsmc are all alike: give one mass, diameter and rotation, or take engine exact"
            )
        first = [float(a[0]) if n else b for a, b in ((self._mass, 1.0), (self._diameter, 0.0), (self._rotation, 0.0))]
        self._mass, self._diameter, self._rotation = (np.broadcast_to(np.float64(value), n) for value in first)
        return MoleculeKinds(first[0], 0.5 * first[1], first[2], np.zeros(1), np.zeros(1)), np.zeros(1, np.uint8)

    @property
    def _room(self) -> int:
        """Largest number of molecules that there may ever be in the box."""
        return len(self._mass)

    def _lay_out(self, sides: Sequence[float]) -> None:
        """Choose cells that are nearly cubes."""
        n = self._number or self._room
        volume = math.prod(sides)
        edge = math.inf
        if self._cross_section > 0.0 and n > 1:
            edge = float(cbrt(volume * self._occupancy / n)) if self._cell is None else self._cell * self._path(volume)
        asked = f"occupancy = {self._occupancy:g}" if self._cell is None else f"cell = {self._cell:g} mean free paths"
        numbers = numbers_of_cells(n, sides, edge, asked)
        self._grid = new_grid(numbers, self._workers)
        self._workspace = new_workspace(self._room, math.prod(numbers), self._workers)
        self._tries = new_tries(self._workers)

    def _find_kernels(self) -> None:
        self._march_kernel = specialise(self._rotates, self._workers > 1, self._wet, self._pool)
        self._gather = new_gather(self._workers > 1)

    def _march(self, steps: int) -> None:
        first, last = self._step, self._step + steps
        if not steps and self._room:
            self._resolve(first, 0, np.full(1, self.ceiling))
        while first < last:
            # at the first step the molecules are sorted by cells, and then at regular intervals
            turn = first + 1 if first == 0 else first + self._round - (first - 1) % self._round
            many = min(last, turn) - first
            position, speed, since = (float(value) for value in self._walls.piston)
            times = np.arange(first, first + many + 1, dtype=np.float64) * self._time_step
            ceilings: Array = position + speed * (times - since)
            lowest = 2.0 * self._gas.radius + 1e-3 * (float(self._sides[2]) - 2.0 * self._gas.radius)
            if speed < 0.0 and ceilings[-1] < lowest:
                many = int(np.argmax(ceilings < lowest)) - 1
            if many > 0 and self._room:
                self._resolve(first, many, ceilings)
            if speed < 0.0 and ceilings[-1] < lowest:
                self._step = first + max(many, 0)
                self._now = self._step * self._time_step
                raise StalledError(
                    f"the piston has come down to {self.ceiling:.6g} at t = {self.time:.6g} and leaves no box: "
                    "stop it earlier, or let it move more slowly"
                )
            first += many
            if first == turn and self._number:
                self._regroup()

    def _resolve(self, first: int, many: int, ceilings: Array) -> None:
        if self._workers > 1:
            use_threads(self._workers)
        run = March(first, many, self._time_step, ceilings, self._cross_section, self._tallies, self._water)
        self._march_kernel(
            self._columns, self._grid, self._gas, self._box, self._walls, self._workspace, self._tries, run
        )  # fmt: skip

    def _regroup(self) -> None:
        """Put the columns in the order of cells, and reset the largest relative speed found in each cell."""
        changed: dict[str, Any] = {}
        order = self._columns.order[: self._number]
        for name in _COLUMNS[: 7 if self._rotates else 6]:
            column = getattr(self._columns, name)
            self._gather(column[: self._number], order, self._spare, self._workers)
            changed[name], self._spare = self._spare, column
        # every step writes the column of cells again
        self._gather(self._columns.identity[: self._number], order, self._columns.cell, self._workers)
        self._columns = self._columns._replace(identity=self._columns.cell, cell=self._columns.identity, **changed)
        usual = _FASTEST * self._thermal_speed()
        np.maximum(self._grid.fastest * _FORGET, usual, out=self._grid.fastest)

    def _renew(self) -> None:
        self._box = self._box._replace(gravity=self._gravity)  # the length of a step is passed with every march

    def _open_sides(self) -> list[float]:
        """Return the sides of the space that centres can reach now [length]."""
        sides = zip(self.length, self._periodic, strict=True)
        return [float(side) - (0.0 if turn else 2.0 * self._gas.radius) for side, turn in sides]

    def _path(self, volume: float) -> float:
        """Return the mean free path of molecules that fill an open volume evenly [length]."""
        swept = math.sqrt(2.0) * (self._number or self._room) * self._cross_section
        return volume / swept if swept > 0.0 else math.inf

    def _fastest(self) -> float:
        """Return sqrt(kT/m) of the start or the hottest wall; if both are at rest, a speed from fall or piston."""
        if not self._room:
            return 0.0
        kT = self._warmest(self._gas.mass * self._mean_square_speed() / 3.0)
        if kT > 0.0:
            return math.sqrt(kT / self._gas.mass)
        fall = self._gravity * float(np.mean(self._columns.z)) * 2.0 / 3.0
        return max(math.sqrt(fall), abs(self.piston_velocity))

    def _thermal_speed(self) -> float:
        """Return sqrt(kT/m) now, of the lightest molecules if they differ [length/time]."""
        return math.sqrt(self._mean_square_speed() / 3.0)

    def _mean_square_speed(self) -> float:
        """Return the mean of the squared speed [length^2/time^2]."""
        return sum(sum_of_squares(v) for v in self._columns[3:6]) / max(self._number, 1)

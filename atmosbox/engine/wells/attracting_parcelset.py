"""The parcel of molecules that attract each other, advanced exactly: a gas that can condense to a liquid."""

from typing import Any, ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.inputs import column
from atmosbox.engine.core.kind import classify
from atmosbox.engine.core.parcel import Arrangement, Array
from atmosbox.engine.core.refusal import RefusedError, number
from atmosbox.engine.core.state import EVENT, Modes, aligned_records
from atmosbox.engine.core.walls import PISTON
from atmosbox.engine.exact.calendar import new_calendar
from atmosbox.engine.exact.layout import PLACE
from atmosbox.engine.exact.parcelset import Arrays, ParcelSet
from atmosbox.engine.wells.attraction import RandomBath, SquareWell, Wells, new_bath, new_wells
from atmosbox.engine.wells.vicinity import Vicinity, new_vicinity
from atmosbox.engine.wells.well_advance import Lists, advancing, as_listed
from atmosbox.engine.wells.well_events import WellGas, specialise

_TIGHT = 1.05
_KINDS = 64
_FEWEST = 64
"""Number of words of a list at first."""


class AttractingParcelSet(ParcelSet):
    """A set of molecules that attract each other, with its box, advanced exactly.

    Its other parameters, and its properties, are described at `Parcel`. Its potential energy is that of the wells and
    of gravity.

    Parameters
    ----------
    well
        Range and depth of the attraction.
    species : (molecule,)
        Whole numbers from 0: rows of the tables of the well. All molecules are of species 0 by default.
    strength
        Factor of the depth of all wells; it may be changed during the run.
    bath
        A heat bath that draws velocities again, or none.

    Raises
    ------
    RefusedError
        If there is a piston or rotation, a periodic side is too short for the wells, or a table does not fit.

    References
    ----------
    Alder, B. J., Wainwright, T. E. (1959), doi:10.1063/1.1730376.

    Examples
    --------
    Two molecules that meet at a relative speed of 2 are captured, collide, move apart, and leave the well again:

    >>> from atmosbox.engine.core.walls import Periodic
    >>> box = {"length": (10, 10, 10), "walls": (Periodic(),) * 6, "well": SquareWell(1.5, 1.0)}
    >>> pair = AttractingParcelSet([[4, 5, 5], [7, 5, 5]], [[1, 0, 0], [-1, 0, 0]], **box)
    >>> pair.advance(0.8)
    >>> pair.number_of_wells, pair.energy()[2], round(float(pair.snapshot().velocity[0, 0]), 6)
    (1, -1.0, 1.414214)
    >>> pair.advance(2.0)
    >>> pair.number_of_wells, pair.contacts, pair.snapshot().velocity[:, 0].round(12).tolist()
    (0, 1, [-1.0, 1.0])
    """

    engine: ClassVar[str] = "exact"

    _attraction_work = 0.0

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        *,
        well: SquareWell,
        species: ArrayLike = 0,
        strength: float = 1.0,
        bath: RandomBath | None = None,
        **box: Unpack[Arrangement],
    ) -> None:
        self._well = well.range, well.depth
        self._species = np.asarray(species)
        self._strength = number(strength, "strength of the attraction", least=0.0)
        self._bath = new_bath(bath)
        super().__init__(position, velocity, **box)

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        if self._walls.law[5] == PISTON:
            raise RefusedError("molecules that attract each other have no piston: make wall z_high another one")
        if self._rotates:
            raise RefusedError("rotation of molecules that attract each other is not available: make rotation 0")
        if not self._collisions:
            raise RefusedError("molecules that attract each other collide: make collisions True")
        super()._begin(position, velocity, rotational_energy)

    def _fill(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        species = column(self._species, len(position), "species").astype(np.int64)
        if (species != self._species).any():
            raise RefusedError("species of a molecule is not a whole number: give 0, 1, 2, ...")
        self._kinds, kind, self._size_radius = classify(self._mass, self._diameter, self._rotation, None, species)
        self._write(position, velocity, kind)
        radius = np.array(self._kinds.table["radius"])
        if len(radius) > _KINDS:
            raise RefusedError(
                f"{len(radius)} kinds of molecules that attract each other are too many: let them differ in at most "
                f"{_KINDS} masses, diameters and species together"
            )
        species_of_kind = np.zeros(len(radius), np.int64)
        species_of_kind[kind] = species
        self._species = species
        self._wells: Wells = new_wells(SquareWell(*self._well), species_of_kind, radius)
        self._full_depth = self._wells.depth.copy()
        self._wells.depth[:] *= self._strength

    def _lay_out(self) -> None:
        """Make the lists of all molecules, and predict all events again."""
        n = len(self._fields)
        reach = float(self._wells.distance.max(initial=0.0))
        shortest = 2.0 * _TIGHT * reach
        for axis in range(3):
            if self._periodic[axis] and self._sides[axis] < shortest:
                raise RefusedError(
                    f"length = {self._sides[axis]:.6g} along {'xyz'[axis]} is too short for molecules that attract "
                    f"each other up to a distance of {reach:.6g} on a periodic axis: make it {shortest:.6g} or more"
                )
        mixed, periodic = len(self._kinds.table) > 1, any(self._periodic)
        self._modes = Modes(contacts=True, gravity=self.gravity > 0.0, mixed=mixed, periodic=periodic)
        self._find_kernels()
        self._events = aligned_records(n, EVENT)
        self._calendar = new_calendar(n)
        vicinity = new_vicinity(self._sides, self._periodic, n, reach, planar=self._planar)
        self._vicinity: Vicinity = vicinity._replace(entry=np.zeros(n * _FEWEST, np.uint32))
        self._layout = Lists(np.array([_FEWEST]), np.array([PLACE]))
        self._settle()

    def _find_kernels(self) -> None:
        _, _, self._replan, self._overlap = specialise(self._modes)
        self._pass_time, self._settled = advancing(self._modes)

    def _data(self) -> Any:
        gas = WellGas(
            self._molecules, self._events, self._kinds, self._calendar, self._box,
            self._walls, self._tallies, self._wells, self._vicinity, self._bath,
        )  # fmt: skip
        return as_listed(gas, self._layout)

    def _make_room(self) -> None:
        """Make memory for longer lists."""
        old = self._vicinity.entry
        entry = np.zeros(2 * len(self._fields) * int(self._layout.stride[0]), np.uint32)
        entry[: old.size] = old
        self._vicinity = self._vicinity._replace(entry=entry)

    _gas = _data

    @property
    def _clocks(self) -> Any:
        """The time of the next draw of the bath."""
        return self._bath.clock

    def arrays(self) -> Arrays:
        """Return what the kernels of this box work on: see `ParcelSet.arrays`."""
        return super().arrays()._replace(full_depth=self._full_depth)

    def memory(self) -> int:
        """Return the memory of molecules, events, lists and calendar [bytes]."""
        arrays = [self._molecules, self._events, self._calendar.time, self._calendar.winner, self._kinds.table]
        arrays += [part for part in (*self._vicinity, *self._wells) if isinstance(part, np.ndarray)]
        return sum(int(a.nbytes) for a in arrays)

    # ------------------------------------------------------------------ the state

    def energy(self) -> tuple[float, float, float]:
        """Return kinetic, rotational and potential energy now [energy]; potential: of gravity and of the wells."""
        kinetic, rotational, potential = super().energy()
        return kinetic, rotational, potential + self.well_energy

    @property
    def well_energy(self) -> float:
        """Potential energy of all pairs that are inside their wells now, 0 or below [energy]."""
        return -float(np.sum(self._wells.depth * self._wells.number)) if self._wells.number.any() else 0.0

    @property
    def number_of_wells(self) -> int:
        """Number of pairs that are inside their wells now."""
        return int(self._wells.number.sum())

    @property
    def well_events(self) -> dict[str, int]:
        """Numbers of captures, releases, bounces in a well, and velocities drawn again since the start."""
        names = ("captures", "releases", "bounces", "drawn")
        return {name: int(count) for name, count in zip(names, self._wells.count, strict=True)}

    @property
    def stress(self) -> Array:
        """Sums of r_a dp_a over all events of pairs since the start, along x, y and z [energy]."""
        return np.array(self._wells.stress)

    @property
    def bath_heat(self) -> float:
        """Heat that the random bath has given since the start [energy]."""
        return float(self._bath.heat[0])

    def pairs(self) -> NDArray[np.int64]:
        """Return the pairs that are inside their wells now, (pair, 2), the lower index first."""
        n, stride = len(self._fields), int(self._layout.stride[0])
        entry = self._vicinity.entry.reshape(n, stride)
        listed = np.arange(1, stride)[None, :] <= entry[:, :1]
        first, place = np.nonzero(listed & (entry[:, 1:] & 1 == 1))
        second = (entry[first, place + 1] >> 1).astype(np.int64)
        lower = first < second
        return np.stack([first[lower], second[lower]], axis=1)

    def neighbours(self) -> NDArray[np.int64]:
        """Return the number of neighbours that each molecule has inside its well now, (molecule,)."""
        return np.bincount(self.pairs().reshape(-1), minlength=len(self._fields))

    # ------------------------------------------------------------------ changes during a run

    @property
    def attraction_work(self) -> float:
        """Energy that changes of the depth of the wells have given since the start [energy]."""
        return self._attraction_work

    @property
    def strength(self) -> float:
        """Factor of the depth of all wells."""
        return self._strength

    def set_strength(self, strength: float) -> None:
        """Set the depth of all wells from now on: a factor of the depth that `SquareWell` gives.

        No molecule moves at that moment, but the potential energy of the pairs in wells changes; the ledger holds the
        change as `attraction_work`.

        Raises
        ------
        RefusedError
            If the number is not finite, or below 0.

        Examples
        --------
        >>> from atmosbox.engine.core.walls import Periodic
        >>> facts = {"length": (10, 10, 10), "walls": (Periodic(),) * 6, "well": SquareWell()}
        >>> box = AttractingParcelSet([[4, 5, 5], [5.2, 5, 5]], [[0, 0, 0]] * 2, **facts)
        >>> box.set_strength(0.5)
        >>> box.well_energy, box.attraction_work, box.ledger()
        (-0.5, 0.5, 0.0)
        """
        strength = number(strength, "strength of the attraction", least=0.0)
        before = self.well_energy
        self._strength = strength
        self._wells.depth[:] = strength * self._full_depth
        self._attraction_work += self.well_energy - before
        self._replan(self._gas(), self._now)

    def set_bath_kT(self, kT: float) -> None:
        """Set the temperature of the random bath [energy] from now on; it replaces the bath's schedule.

        Raises
        ------
        RefusedError
            If there is no bath, or the temperature is not finite and above 0.
        """
        kT = number(kT, "kT of the random bath", above=0.0)
        if not self._bath.rate > 0.0:
            raise RefusedError("this box has no random bath: give it a RandomBath")
        self._bath.schedule_kT[:] = kT

    def _field_changes(self, gravity: float) -> None:
        self._move(*self._flown(self._fields, turn=False), self._now)
        self._gravity, self._box = gravity, self._box._replace(gravity=gravity)
        self._modes = self._modes._replace(gravity=gravity > 0.0)
        self._find_kernels()
        self._replan(self._gas(), self._now)

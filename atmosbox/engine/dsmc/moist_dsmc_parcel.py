"""The parcel of moist air, advanced by direct simulation Monte Carlo: for clouds of many molecules."""

import math
from collections.abc import Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine.core.kind import classify
from atmosbox.engine.core.parcel import Array
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.dsmc.columns import BLOCK, MoleculeKinds, new_workspace
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.dsmc.moist_columns import Water, new_water
from atmosbox.engine.liquid.moist_account import MoistAccount
from atmosbox.engine.liquid.substance import Liquid, Mist, Pool

_MOST_KINDS = 256


class MoistDsmcParcel(MoistAccount, DsmcParcel):
    """A parcel of dilute air and vapour with liquid in it, whose molecules collide with random partners nearby.

    Its other parameters, and its properties, are described at `DsmcParcel`; the laws of the liquid, at `liquid`. The
    molecules that are given are in the box; those of the liquid are added to them. They may differ in mass and
    rotation, but not in size. Molecules with mass, diameter and rotation of the substance are vapour.

    Parameters
    ----------
    liquid
        A mist in the box, or a pool on its floor.

    Raises
    ------
    RefusedError
        If there is a liquid in gravity, or a pool on a floor that is no smooth wall; if molecules differ in size,
        or the liquid is neither a mist nor a pool.

    Notes
    -----
    Steps and cells are those of the gas at the start; if all molecules are in the liquid, those of all molecules.

    Examples
    --------
    A molecule leaves the liquid because that is hot enough; the total energy stays the same:

    >>> from atmosbox.engine import Mist, Substance
    >>> water = Substance(mass=1.0, diameter=0.1, binding_energy=2.0, heat_capacity=9.0, volatility=1.0)
    >>> box = MoistDsmcParcel([], [], length=(1, 1, 1), liquid=Mist(water, number=1, kT=1.0), seed=1)
    >>> box.advance(50.0)
    >>> box.evaporated > 0, box.number + box.liquid, box.ledger() < 1e-12
    (True, 1, True)
    """

    engine: ClassVar[str] = "dsmc"
    _wet = True
    _water: Water

    def __init__(self, position: ArrayLike, velocity: ArrayLike, *, liquid: Liquid, **box: Any) -> None:
        self._liquid = liquid
        super().__init__(position, velocity, **box)

    # ------------------------------------------------------------------ the state

    @property
    def diameter(self) -> Array:
        """Diameter of each molecule of the gas [length]."""
        return np.broadcast_to(np.float64(2.0 * self._gas.radius), self.number)

    def _slots(self) -> Any:
        return np.argsort(self._columns.identity[: self._number])

    def memory(self) -> int:
        """Return the memory of molecules, cells and liquid, and of sorting the molecules into cells [bytes]."""
        calendar = self._water.calendar
        arrays = (self._columns.kind, self._spare_kind, self._water.hole, calendar.time, calendar.winner)
        return super().memory() + self._reservoir_memory() + sum(int(array.nbytes) for array in arrays)

    # ------------------------------------------------------------------ how steps are made

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        if not isinstance(self._liquid, Mist | Pool):
            raise RefusedError("the liquid of dsmc is a Mist or a Pool: drops that can be hit need the engine exact")
        self._refuse_what_no_liquid_bears()
        self._pool = isinstance(self._liquid, Pool)
        super()._begin(position, velocity, rotational_energy)
        diameter = np.full(len(self._gas.masses), 2.0 * self._gas.radius)
        self._open_reservoir(self._gas.masses, diameter, self._gas.rotations, self._columns.kind)
        self._water = new_water(self._reservoir, self._room if self._pool else 1)
        self._spare_kind = np.empty_like(self._columns.kind)

    def _classify(self) -> tuple[MoleculeKinds, Any]:
        """Return the properties of the molecules of gas and liquid, and the kind of each."""
        self._append_liquid()
        kinds, kind, _ = classify(self._mass, self._diameter, self._rotation, None)
        radii = kinds.table["radius"]
        if (radii != radii[0]).any():
            raise RefusedError(
                "the molecules of dsmc are all of one size, those of the liquid, too: give one diameter, or take "
                "engine exact"
            )
        if len(radii) > _MOST_KINDS:
            raise RefusedError(f"{len(radii)} kinds of molecules are more than {_MOST_KINDS}: give fewer masses")
        masses, rotations = (np.array(kinds.table[name]) for name in ("mass", "rotation"))
        if not self._rotates:
            rotations[:] = 0.0
        return MoleculeKinds(float(masses.min()), float(radii[0]), 0.0, masses, rotations), kind.astype(np.uint8)

    def _effort(self) -> int:
        return self._room

    def _lay_out(self, sides: Sequence[float]) -> None:
        super()._lay_out(sides)
        cells = self._grid.number_x * self._grid.number_y * self._grid.number_z
        # one block more, for the counters of the pool
        self._workspace = new_workspace(self._room + BLOCK, cells, self._workers, self._room if self._pool else 1)

    def _resolve(self, first: int, many: int, ceilings: Array) -> None:
        super()._resolve(first, many, ceilings)
        self._number = self.number

    def _regroup(self) -> None:
        n, kind = self._number, self._columns.kind
        self._gather(kind[:n], self._columns.order[:n], self._spare_kind, self._workers)
        self._columns, self._spare_kind = self._columns._replace(kind=self._spare_kind), kind
        super()._regroup()

    def _fastest(self) -> float:
        """Return sqrt(kT/m) of the lightest molecules, at the highest temperature of start, walls and liquid."""
        if not self._room:
            return 0.0
        kT = self._warmest(max(self._kT(), self._liquid.kT if self._liquid.number else 0.0))
        return math.sqrt(kT / self._gas.mass) if kT > 0.0 else abs(self.piston_velocity)

    def _thermal_speed(self) -> float:
        return math.sqrt(self._kT() / self._gas.mass)

    def _kT(self) -> float:
        """Return the kinetic temperature [energy]."""
        return self._kinetic() / (1.5 * max(self._number, 1))

    def _kinetic(self) -> float:
        n = self._number
        vx, vy, vz = (v[:n] for v in self._columns[3:6])
        return 0.5 * float(np.sum(self._gas.masses[self._columns.kind[:n]] * (vx * vx + vy * vy + vz * vz)))

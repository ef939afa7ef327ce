"""The parcel of moist air, advanced exactly: molecules that condense leave the box, and come back."""

import math
from typing import ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine import moist
from atmosbox.engine.liquid import (
    CONDENSED,
    EVAPORATED,
    LIQUID,
    RAINED,
    RAINED_ENERGY,
    THERMAL,
    Liquid,
    Mist,
    Pool,
    new_ledger,
)
from atmosbox.engine.parcel import Arrangement, Array
from atmosbox.engine.parcelset import ParcelSet
from atmosbox.engine.refusal import RefusedError
from atmosbox.engine.walls import POOL, SPECULAR

__all__ = ["MoistParcelSet"]

_CHUNK = 200_000


class MoistParcelSet(ParcelSet):
    """A set of molecules with its box and with liquid in it, advanced exactly.

    What it is given besides, and what it tells, is described at `Parcel`. The molecules that are given are in the
    box; those in the liquid come to them. Vapour are those that are as the substance of the liquid says.

    Parameters
    ----------
    liquid
        A mist in the box, or a pool on its floor.

    Raises
    ------
    RefusedError
        If a liquid is asked for in a plane gas, in gravity, or a pool on a floor that is no smooth wall.

    Examples
    --------
    A molecule of the liquid that is hot enough leaves it; the energy is still there:

    >>> from atmosbox.engine.liquid import Mist, Substance
    >>> water = Substance(mass=1.0, diameter=0.1, binding_energy=2.0, heat_capacity=9.0, volatility=1.0)
    >>> box = MoistParcelSet([], [], length=(1, 1, 1), liquid=Mist(water, number=1, kT=1.0))
    >>> box.advance(50.0)
    >>> box.evaporated > 0, box.number + box.liquid, box.ledger() < 1e-12
    (True, 1, True)
    """

    engine: ClassVar[str] = "exact"

    def __init__(self, position: ArrayLike, velocity: ArrayLike, *, liquid: Liquid, **box: Unpack[Arrangement]) -> None:
        self._liquid = liquid
        super().__init__(position, velocity, **box)

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        liquid = self._liquid
        if self._planar:
            raise RefusedError("a plane gas has no room for liquid: give it three dimensions")
        if self._gravity > 0.0:
            raise RefusedError("a box with liquid has no gravity: set it to 0")
        if isinstance(liquid, Pool):
            if self._walls.law[4] != SPECULAR:
                raise RefusedError("the floor under a pool is the pool itself: make wall z_low Specular")
            self._walls.law[4] = POOL
        super()._begin(position, velocity, rotational_energy)
        fastest = float(np.sqrt(np.max(np.sum(velocity * velocity, axis=1), initial=0.0)))
        baths = [float(kT) for kT in self.wall_kT() if math.isfinite(kT)]
        warm = math.sqrt(8.0 * max(baths, default=0.0) / liquid.substance.mass)
        self._draw(max(fastest, warm, 2.0 * abs(self.piston_velocity)))

    def _draw(self, speed: float) -> None:
        """Draw anew when the liquid does something, for molecules that may be as fast as a speed [length/time]."""
        begin = moist.specialise(self._modes)[0]
        begin(self._molecules, self._box, self._walls, self._tallies, self._ledger, self._now, speed)

    def _piston_turned(self) -> None:
        super()._piston_turned()
        speed = 2.0 * abs(self.piston_velocity)
        if speed > float(self._ledger.bound[0]):  # it may wake molecules at rest
            self._draw(speed)

    def _fill(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Write down the molecules of the gas, and behind them those of the liquid, which are not in the box."""
        substance = self._liquid.substance
        present, more = len(position), int(self._liquid.number)
        self._mass = np.append(self._mass, np.full(more, substance.mass))
        self._diameter = np.append(self._diameter, np.full(more, substance.diameter))
        self._rotation = np.append(self._rotation, np.full(more, substance.rotation))
        self._rotates = self._rotates or (bool(more) and substance.rotation > 0.0)
        self._same_size = bool(len(self._diameter)) and np.ptp(self._diameter) == 0.0
        nowhere = np.zeros((more, 3))
        super()._fill(
            np.concatenate([position, nowhere]),
            np.concatenate([velocity, nowhere]),
            np.append(rotational_energy, np.zeros(more)),
        )
        self._fields["clock"][present:] = np.inf
        rotation = float(substance.rotation) if self._rotates else 0.0
        alike = (self._kinds.table["mass"] == substance.mass) & (self._kinds.table["rotation"] == substance.rotation)
        alike &= self._kinds.table["radius"] == 0.5 * substance.diameter
        kind = int(np.flatnonzero(alike)[0]) if alike.any() else -1
        self._vapours = int(np.sum(self._fields["kind"] == kind))
        cube = float(np.mean(self._diameter**3)) if present + more else 0.0
        sides = self._sides - np.where(self._periodic, 0.0, substance.diameter)
        area = self._liquid.area if isinstance(self._liquid, Mist) else float(sides[0] * sides[1])
        self._ledger = new_ledger(self._liquid, area, present + more, present, kind, cube)._replace(rotation=rotation)

    @property
    def _present(self) -> NDArray[np.bool_]:  # type: ignore[override]
        inside: NDArray[np.bool_] = np.isfinite(self._fields["clock"])
        return inside

    def _proceed(self, until: float) -> int:
        status, _ = self._moist_advance(
            self._molecules, self._events, self._kinds, self._cells, self._calendar,
            self._box, self._walls, self._tallies, self._ledger, until, _CHUNK,
        )  # fmt: skip
        return int(status)

    def _lay_out(self) -> None:
        super()._lay_out()
        self._moist_advance = moist.specialise(self._modes)[1]

    def _next_time(self) -> float:
        return min(super()._next_time(), float(self._ledger.clock.min()))

    def _rebase(self, step: float) -> None:
        super()._rebase(step)
        self._ledger.clock[:] -= step

    # ------------------------------------------------------------------ what it holds

    @property
    def number(self) -> int:
        """Number of molecules of the gas."""
        return len(self._fields) - int(self._ledger.top[0])

    @property
    def liquid(self) -> int:
        """Number of molecules in the liquid."""
        return int(self._ledger.count[LIQUID])

    @property
    def vapour(self) -> int:
        """Number of molecules of the vapour."""
        return self._vapours - int(self._ledger.top[0])

    @property
    def condensed(self) -> int:
        """How many molecules have come into the liquid since the start."""
        return int(self._ledger.count[CONDENSED])

    @property
    def evaporated(self) -> int:
        """How many molecules have left the liquid for the vapour since the start."""
        return int(self._ledger.count[EVAPORATED])

    @property
    def rained(self) -> int:
        """How many molecules have left the box as rain since the start."""
        return int(self._ledger.count[RAINED])

    @property
    def liquid_energy(self) -> float:
        """Thermal energy of the liquid [energy]."""
        return float(self._ledger.energy[THERMAL])

    @property
    def liquid_kT(self) -> float:
        """Temperature of the liquid [energy], NaN where there is none and no nuclei."""
        capacity = self._ledger.molecule_capacity * self.liquid + self._ledger.nuclei
        return self.liquid_energy / capacity if capacity > 0.0 else float("nan")

    @property
    def condensed_energy(self) -> float:
        """Energy of the liquid, of its vapour's binding and of the rain [energy]."""
        return self._ledger.binding_energy * self.vapour + float(
            self._ledger.energy[THERMAL] + self._ledger.energy[RAINED_ENERGY]
        )

    @property
    def mass(self) -> Array:
        """Mass of each molecule of the gas [mass]."""
        return self._mass[self._present]

    @property
    def diameter(self) -> Array:
        """Diameter of each molecule of the gas [length]."""
        return self._diameter[self._present]

    @property
    def degrees_of_freedom(self) -> float:
        """Translational and rotational degrees of freedom per molecule of the gas, on average."""
        rotation = float(self._rotation.sum()) - self._ledger.rotation * int(self._ledger.top[0])
        return 3.0 + rotation / max(self.number, 1)

    @property
    def emitted_energy(self) -> tuple[Array, NDArray[np.int64]]:
        """Edges of energy [energy], and how many molecules left with so much beyond the binding energy."""
        edges = self._ledger.bin_width * np.arange(len(self._ledger.spectrum) + 1.0)
        return edges, np.array(self._ledger.spectrum)

    def memory(self) -> int:
        """Return the bytes that molecules, events, cells, calendar and ledger take."""
        return super().memory() + int(self._ledger.absent.nbytes + self._ledger.spectrum.nbytes)

"""The parcel of moist air, advanced exactly: molecules that condense leave the box, and evaporate into it again."""

import math
from typing import Any, ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.parcel import Arrangement, Array
from atmosbox.engine.exact.parcelset import Arrays, ParcelSet
from atmosbox.engine.liquid.moist_account import MoistAccount
from atmosbox.engine.liquid.moist_loop import Moisture, moist_loop
from atmosbox.engine.liquid.substance import Liquid


class MoistParcelSet(MoistAccount, ParcelSet):
    """A set of molecules with its box and with liquid in it, advanced exactly.

    Its other parameters, and its properties, are described at `Parcel`. The molecules that are given are in the
    box; those of the liquid are added to them. Molecules with mass, diameter and rotation of the substance are vapour.

    Parameters
    ----------
    liquid
        A mist in the box, or a pool on its floor.

    Raises
    ------
    RefusedError
        If there is a liquid in a plane gas or in gravity, or a pool on a floor that is no smooth wall.

    Examples
    --------
    A molecule leaves the liquid because that is hot enough; the total energy stays the same:

    >>> from atmosbox.engine import Mist, Substance
    >>> water = Substance(mass=0.62, diameter=1.0, binding_energy=2.0, heat_capacity=9.0, volatility=1.0)
    >>> liquid = Mist(water, number=1, kT=1.0)
    >>> box = MoistParcelSet([[2, 2, 2]], [[1, 0, 0]], length=(4, 4, 4), rotation=2.0, liquid=liquid)
    >>> box.advance(300.0)
    >>> box.evaporated > 0, box.number + box.liquid, box.ledger() < 1e-12
    (True, 2, True)
    """

    engine: ClassVar[str] = "exact"

    _loops = staticmethod(moist_loop)

    def __init__(self, position: ArrayLike, velocity: ArrayLike, *, liquid: Liquid, **box: Unpack[Arrangement]) -> None:
        self._liquid = liquid
        super().__init__(position, velocity, **box)

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        self._refuse_what_no_liquid_bears()
        super()._begin(position, velocity, rotational_energy)
        fastest = float(np.sqrt(np.max(np.sum(velocity * velocity, axis=1), initial=0.0)))
        baths = [float(kT) for kT in self.wall_kT() if math.isfinite(kT)]
        warm = math.sqrt(8.0 * max(baths, default=0.0) / self._liquid.substance.mass)
        self._draws(self._gas(), self._book(), max(fastest, warm, 2.0 * abs(self.piston_velocity)))

    def _reservoir_changes(self) -> None:
        self._draws(self._gas(), self._book(), float(self._reservoir.bound[0]))

    def _piston_turned(self) -> None:
        super()._piston_turned()
        self._wakes(self._gas(), self._book(), 2.0 * abs(self.piston_velocity))

    def _bath_changes(self, kT: float) -> None:
        self._wakes(self._gas(), self._book(), math.sqrt(8.0 * kT / self._liquid.substance.mass))

    def _fill(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Write the molecules of the gas into the arrays, then those of the liquid, which are not in the box."""
        present, more = len(position), int(self._liquid.number)
        self._append_liquid()
        nowhere = np.zeros((more, 3))
        super()._fill(
            np.concatenate([position, nowhere]),
            np.concatenate([velocity, nowhere]),
            np.append(rotational_energy, np.zeros(more)),
        )
        self._fields["clock"][present:] = np.inf
        table = self._kinds.table
        self._open_reservoir(table["mass"], 2.0 * table["radius"], table["rotation"], self._fields["kind"])

    @property
    def _present(self) -> NDArray[np.bool_]:  # type: ignore[override]
        return self.present

    def arrays(self) -> Arrays:
        """Return what the kernels of this box work on: see `ParcelSet.arrays`."""
        return super().arrays()._replace(substance=self._liquid.substance)

    def memory(self) -> int:
        """Return the memory of molecules, events, cells, calendar and reservoir [bytes]."""
        return super().memory() + self._reservoir_memory()

    def _find_kernels(self) -> None:
        super()._find_kernels()
        _, self._draws, self._wakes = moist_loop(self._modes)

    @property
    def _clocks(self) -> Any:
        """The times of the next events of the liquid."""
        return self._reservoir.clock

    @property
    def _moisture(self) -> Any:
        """The liquid of the box."""
        return Moisture(self._reservoir, self._vapours, self._rotations, 0)

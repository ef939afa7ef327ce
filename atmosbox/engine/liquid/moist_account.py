"""The properties and tallies of a box with liquid in it, for every engine that can hold one."""

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.parcel import Array, Parcel
from atmosbox.engine.core.refusal import RefusedError, number
from atmosbox.engine.core.walls import POOL, SPECULAR
from atmosbox.engine.liquid import reservoir
from atmosbox.engine.liquid.substance import Liquid, Mist, Pool


class MoistAccount(Parcel):
    """A box with liquid in it: the common part of the engines that can hold one.

    Every molecule has an index. First come those that are in the box at the start, then those of the liquid; the
    reservoir lists which of them are absent from the box.
    """

    _liquid: Liquid
    _reservoir: reservoir.Reservoir
    _vapours: int
    _rotations: float

    def _refuse_what_no_liquid_bears(self) -> None:
        """Refuse a plane gas, gravity, and a pool that is not the floor; make the floor a pool."""
        if self._planar:
            raise RefusedError("a plane gas has no room for liquid: give it three dimensions")
        if self._gravity > 0.0:
            raise RefusedError("a box with liquid has no gravity: set it to 0")
        if isinstance(self._liquid, Pool):
            if self._walls.law[4] != SPECULAR:
                raise RefusedError("the floor under a pool is the pool itself: make wall z_low Specular")
            self._walls.law[4] = POOL

    def _field_changes(self, gravity: float) -> None:
        raise RefusedError("a box with liquid has no gravity: leave it at 0")

    def _append_liquid(self) -> None:
        """Append the properties of the molecules of the liquid to those of the gas."""
        substance, more = self._liquid.substance, int(self._liquid.number)
        self._mass = np.append(self._mass, np.full(more, substance.mass))
        self._diameter = np.append(self._diameter, np.full(more, substance.diameter))
        self._rotation = np.append(self._rotation, np.full(more, substance.rotation))
        self._rotates = self._rotates or (bool(more) and substance.rotation > 0.0)
        self._same_size = bool(len(self._diameter)) and np.ptp(self._diameter) == 0.0

    def _open_reservoir(self, mass: Array, diameter: Array, rotation: Array, kind: NDArray[np.integer]) -> None:
        """Make the reservoir of the liquid, from the properties of each kind and the kind of each molecule."""
        liquid, substance = self._liquid, self._liquid.substance
        alike = (mass == substance.mass) & (diameter == substance.diameter) & (rotation == substance.rotation)
        vapour = int(np.flatnonzero(alike)[0]) if alike.any() else -1
        self._vapours = int(np.sum(kind == vapour))
        cube = float(np.mean(self._diameter * self._diameter * self._diameter)) if len(kind) else 0.0
        sides = self._sides - np.where(self._periodic, 0.0, substance.diameter)
        area = 1.0  # the area of drops changes
        if isinstance(liquid, Mist):
            area = liquid.area
        elif isinstance(liquid, Pool):
            area = float(sides[0] * sides[1])
        present = len(kind) - int(liquid.number)
        self._reservoir = reservoir.new_reservoir(liquid, area, len(kind), present, vapour, cube)
        if not self._rotates:
            self._reservoir = self._reservoir._replace(rotation=0.0)
        self._rotations = float(self._rotation.sum())

    def set_open_pool(self, share: float) -> None:
        """Cover a part of a pool, or all of it, with a foil through which heat passes but no water.

        Vapour sticks to the open part alone, and molecules leave from there alone: both rates are multiplied by
        `share`, and the vapour pressure at which they are equal stays the same. Molecules that hit the foil exchange
        heat with the pool as before.

        Parameters
        ----------
        share
            The fraction of the surface that is open [1], 0 to 1.

        Raises
        ------
        RefusedError
            If the liquid is no pool, or the share is not from 0 to 1.

        Examples
        --------
        >>> from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
        >>> from atmosbox.engine import Substance
        >>> water = Substance(mass=0.62, diameter=1.0, binding_energy=2.0, heat_capacity=9.0, volatility=1.0)
        >>> liquid = Pool(water, number=5, kT=1.0)
        >>> box = MoistParcelSet([[2, 2, 2]], [[1, 0, 0]], length=(4, 4, 4), rotation=2.0, liquid=liquid)
        >>> box.sticking
        1.0
        >>> box.set_open_pool(0.25)
        >>> box.sticking
        0.25
        """
        if not isinstance(self._liquid, Pool):
            raise RefusedError("the liquid of this box is not a pool, and only a pool can be covered: make it a Pool")
        reservoir.cover(self._reservoir, number(share, "open share of the pool", least=0.0, most=1.0))
        self._reservoir_changes()

    def _reservoir_changes(self) -> None:
        """Update times that have been drawn already, because the rates of the liquid have just changed."""

    @property
    def number(self) -> int:
        """Number of molecules of the gas."""
        return len(self._mass) - int(self._reservoir.top[0])

    @property
    def sticking(self) -> float:
        """Fraction of the vapour molecules that hit the liquid now and stay; less if a part of a pool is covered."""
        return float(self._reservoir.rates[reservoir.STICKING])

    @property
    def liquid(self) -> int:
        """Number of molecules in the liquid."""
        return int(self._reservoir.count[reservoir.LIQUID])

    @property
    def vapour(self) -> int:
        """Number of molecules of the vapour."""
        return self._vapours - int(self._reservoir.top[0])

    @property
    def condensed(self) -> int:
        """Number of molecules that have entered the liquid since the start."""
        return int(self._reservoir.count[reservoir.CONDENSED])

    @property
    def evaporated(self) -> int:
        """Number of molecules that have left the liquid for the vapour since the start."""
        return int(self._reservoir.count[reservoir.EVAPORATED])

    @property
    def rained(self) -> int:
        """Number of molecules that have left the box as rain since the start."""
        return int(self._reservoir.count[reservoir.RAINED])

    @property
    def liquid_energy(self) -> float:
        """Thermal energy of the liquid [energy]."""
        return float(self._reservoir.energy[reservoir.THERMAL])

    @property
    def liquid_kT(self) -> float:
        """Temperature of the liquid [energy], NaN if there is neither liquid nor nuclei."""
        capacity = self._reservoir.molecule_capacity * self.liquid + self._reservoir.nuclei
        return float(self.liquid_energy / capacity) if capacity > 0.0 else math.nan

    @property
    def condensed_energy(self) -> float:
        """Energy of the liquid, of the binding of its vapour, and of the rain [energy]."""
        held = self._reservoir.energy[reservoir.THERMAL] + self._reservoir.energy[reservoir.RAINED_ENERGY]
        return float(self._reservoir.binding_energy * self.vapour + held)

    @property
    def present(self) -> NDArray[np.bool_]:
        """Which of the molecules that the box has ever held are in the gas now, (molecule,)."""
        inside = np.ones(len(self._mass), np.bool_)
        inside[self._reservoir.absent[: self._reservoir.top[0]]] = False
        return inside

    @property
    def mass(self) -> Array:
        """Mass of each molecule of the gas [mass]."""
        return self._mass[self.present]

    @property
    def diameter(self) -> Array:
        """Diameter of each molecule of the gas [length]."""
        return self._diameter[self.present]

    @property
    def rotation(self) -> Array:
        """Rotational degrees of freedom of each molecule of the gas."""
        return self._rotation[self.present]

    @property
    def degrees_of_freedom(self) -> float:
        """Mean number of translational and rotational degrees of freedom of a molecule of the gas."""
        rotation = self._rotations - self._reservoir.rotation * int(self._reservoir.top[0])
        return float(3.0 + rotation / max(self.number, 1))

    @property
    def emitted_energy(self) -> tuple[Array, NDArray[np.int64]]:
        """Edges of bins of energy [energy], and the number of molecules that left with this energy beyond binding."""
        edges = self._reservoir.bin_width * np.arange(len(self._reservoir.spectrum) + 1.0)
        return edges, np.array(self._reservoir.spectrum)

    def _reservoir_memory(self) -> int:
        """Return the memory of the reservoir [bytes]."""
        return int(self._reservoir.absent.nbytes + self._reservoir.spectrum.nbytes)

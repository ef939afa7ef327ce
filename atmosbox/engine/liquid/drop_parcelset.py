"""The parcel of moist air with visible drops, advanced exactly."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.kind import classify
from atmosbox.engine.core.parcel import Array
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.core.state import KIND, Kinds, aligned_records
from atmosbox.engine.exact.cells import size_classes
from atmosbox.engine.liquid.drop_shape import DropRecords
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.engine.liquid.substance import Drops, Liquid


class DropParcelSet(MoistParcelSet):
    """A set of molecules with its box and with drops in it, advanced exactly.

    A nucleus catches a vapour molecule that hits it, and the molecule evaporates again:

    >>> from atmosbox.engine import Substance
    >>> water = Substance(mass=0.62, diameter=1.0, binding_energy=2.0, heat_capacity=9.0, volatility=1.0)
    >>> drops = Drops(water, nuclei=5.0, position=((3.0, 3.0, 3.0),))
    >>> facts = {"length": (6, 6, 6), "mass": [0.62, 1.0], "rotation": [3.0, 2.0]}
    >>> box = DropParcelSet([[1, 1, 1], [5, 5, 5]], [[1, 1, 1], [0, 0, 1]], liquid=drops, **facts)
    >>> box.advance(100.0)
    >>> box.condensed > 0, box.number + box.liquid, box.ledger() < 1e-12
    (True, 2, True)
    """

    def _fill(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Write the molecules of the gas into the arrays, after them those of the liquid, and then the drops."""
        liquid: Liquid = self._liquid
        if not isinstance(liquid, Drops):
            raise RefusedError("this box is for drops: give it Drops")
        if not (self._diameter > 0.0).all() or not liquid.substance.diameter > 0.0:
            raise RefusedError("drops cannot be hit by molecules without a diameter: give all of them one")
        if not self._collisions:
            raise RefusedError("drops need collisions: leave collisions on")
        substance, more = liquid.substance, int(liquid.number)
        number = len(liquid.position)
        held = np.full(number, more // number, np.int64)
        held[: more % number] += 1
        self._append_liquid()
        kinds, kind, _ = classify(self._mass, self._diameter, self._rotation, None)
        self._open_reservoir(kinds.table["mass"], 2.0 * kinds.table["radius"], kinds.table["rotation"], kind)
        self._reservoir.surface[0] = 0.0
        cubes = [length * length * length for length in liquid.nuclei_radii]
        ball = liquid.molecule_radius * liquid.molecule_radius * liquid.molecule_radius
        largest = float(cbrt(math.fsum(cubes) + self._vapours * ball))
        radius: Array = np.array([float(cbrt(cube + each * ball)) for cube, each in zip(cubes, held, strict=True)])
        where = self._checked(np.array(liquid.position, float), radius, largest)
        self._first_drop = len(kinds.table)
        table = aligned_records(self._first_drop + number, KIND)
        table[: self._first_drop] = kinds.table
        table["mass"][self._first_drop :] = liquid.nucleus_mass + held * substance.mass
        table["radius"][self._first_drop :] = radius
        classes, self._size_radius = size_classes(np.append(kinds.table["radius"], np.full(number, largest)))
        table["size_class"] = classes
        spin = np.concatenate([rotational_energy, np.zeros(more + number)]) if self._rotates else np.zeros(1)
        self._kinds = Kinds(table, spin)
        records = len(position) + more + number
        places = np.concatenate([position, np.zeros((more, 3)), where])
        speeds = np.concatenate([velocity, np.zeros((more + number, 3))])
        self._write(places, speeds, np.concatenate([kind, self._first_drop + np.arange(number)]))
        self._fields["clock"][len(position) : len(position) + more] = np.inf
        self._drops = DropRecords(
            record=np.arange(records - number, records),
            held=held,
            cube=np.array(cubes, float),
            core=np.full(number, float(liquid.nucleus_mass)),
            alive=np.ones(number, np.int64),
            solute=np.array(liquid.particles, float),
            rate=np.zeros(number),
            merged=np.zeros(1, np.int64),
            molecule_cube=float(ball),
            molecule_mass=float(substance.mass),
            molecule_radius=0.5 * float(substance.diameter),
            tension=float(liquid.surface_tension),
            plain=not (liquid.surface_tension > 0.0 or any(liquid.particles)),
        )

    def _checked(self, where: Array, radius: Array, largest: float) -> Array:
        """Return the centres of the drops, or refuse them."""
        if where.ndim != 2 or where.shape[1] != 3 or not np.isfinite(where).all():
            raise RefusedError("the positions of drops are three finite numbers each")
        for axis in range(3):
            side = float(self._sides[axis])
            if side < 2.0 * largest:
                raise RefusedError(
                    f"one drop of all the water would be {2.0 * largest:.4g} wide, the box is {side:.4g}: "
                    "make the box larger, or the molecules in drops smaller"
                )
            outside = (where[:, axis] < radius) | (where[:, axis] > side - radius)
            if not self._periodic[axis] and outside.any():
                raise RefusedError(f"drop {int(np.argmax(outside))} lies outside the box: move it inside")
        return where

    @property
    def _present(self) -> NDArray[np.bool_]:  # type: ignore[override]
        return np.append(self.present, np.zeros(len(self._drops.record), np.bool_))

    @property
    def _moisture(self) -> Any:
        """The liquid of the box, with its drops."""
        return super()._moisture._replace(drops=self._drops)

    def drops(self) -> tuple[Array, Array, NDArray[np.int64]]:
        """Return centres [length], radii [length] and numbers of molecules of the present drops."""
        alive = self._drops.alive == 1
        centre, _ = self._flown(self._fields[self._drops.record[alive]])
        return centre, np.array(self._kinds.table["radius"][self._first_drop :][alive]), self._drops.held[alive]

    @property
    def dissolved(self) -> Array:
        """Number of particles dissolved in each of the present drops."""
        return np.array(self._drops.solute[self._drops.alive == 1])

    @property
    def surface_energy(self) -> float:
        """Energy of the surface of all drops [energy]."""
        radius = self._kinds.table["radius"][self._first_drop :][self._drops.alive == 1]
        return float(4.0 * math.pi * self._drops.tension * np.sum(radius * radius))

    @property
    def merged(self) -> int:
        """Number of times that two drops have become one since the start."""
        return int(self._drops.merged[0])

    @property
    def condensed_energy(self) -> float:
        """Energy of the liquid, of the binding of its vapour, and of surface and motion of the drops [energy]."""
        m = self._fields[self._drops.record[self._drops.alive == 1]]
        mass = self._kinds.table["mass"][self._first_drop :][self._drops.alive == 1]
        flight = 0.5 * float(np.sum(mass * (m["vx"] ** 2 + m["vy"] ** 2 + m["vz"] ** 2)))
        return super().condensed_energy + self.surface_energy + flight

    def escaped(self) -> int:
        """Return how many molecules and drops are outside the box or have no finite position: 0 in a correct engine."""
        centre = self.drops()[0]
        lost = ~np.isfinite(centre).all(axis=1) | (centre < 0.0).any(axis=1) | (centre > self.length).any(axis=1)
        return super().escaped() + int(np.sum(lost)) + int(math.isnan(self.liquid_energy))

"""How molecules start, as data: what is drawn at random, and in which order.

Python draws a start with the other functions of this folder. The page of the lab reads the same data and draws the same
numbers, for any seed.
"""

from collections import namedtuple
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.random import RandomNumbers, Source
from atmosbox.engine.start.overlap import clear_of_drops
from atmosbox.engine.start.scatter import random_positions
from atmosbox.engine.start.velocity import equal_speeds, maxwell_velocities, rotational_energies

Array = NDArray[np.float64]


class _Gas(namedtuple("_Gas", "length diameter mass rotation periodic planar apart")):
    """What the parts of a start depend on: molecules and box; ``apart`` if molecules must not overlap."""


@dataclass(frozen=True, eq=False)
class Placed:
    """Molecules start at given places.

    Parameters
    ----------
    position : (molecule, axis)
        Centres [length].
    """

    position: Array
    draws: ClassVar[str] = "position"

    def draw(self, gas: _Gas, rng: Source) -> Array:
        """Return the positions."""
        return self.position


@dataclass(frozen=True, eq=False)
class Scattered:
    """Molecules start at random places without overlap: see `atmosbox.engine.random_positions`.

    Parameters
    ----------
    top
        Only heights below this one are used [length]; the whole box by default.
    scale_height
        If given, the density decreases with height as in an isothermal atmosphere of this scale height [length].
    numbered
        How molecules are numbered once all are placed: ``as placed``, ``at random`` or ``along x``.
    centre : (drop, axis)
        Centres of drops in a cube [length]; molecules of diameter 1 within reach of a drop get other places.
    reach : (drop,)
        Distance from the centre of each drop within which no centre of a molecule may be [length].
    """

    top: float | None = None
    scale_height: float | None = None
    numbered: Literal["as placed", "at random", "along x"] = "as placed"
    centre: ArrayLike = ()
    reach: ArrayLike = ()
    draws: ClassVar[str] = "position"

    def draw(self, gas: _Gas, rng: Source) -> Array:
        """Return random positions."""
        box = {"periodic": gas.periodic, "planar": gas.planar, "apart": gas.apart}
        place = random_positions(gas.length, gas.diameter, rng, top=self.top, scale_height=self.scale_height, **box)
        if gas.apart and np.size(self.reach):
            assert isinstance(rng, RandomNumbers)
            place = clear_of_drops(place, self.centre, self.reach, float(gas.length[0]), rng)
        if self.numbered == "as placed":
            return place
        key = rng.random(len(place)) if self.numbered == "at random" else place[:, 0]
        return place[np.argsort(key, kind="stable")]


@dataclass(frozen=True, eq=False)
class Maxwell:
    """Molecules start with the velocities of equilibrium: see `atmosbox.engine.maxwell_velocities`.

    Parameters
    ----------
    kT : (molecule,) or one number
        Temperature [energy].
    exact
        Whether total momentum is zero, and the kinetic energy exactly that of kT.
    """

    kT: ArrayLike
    exact: bool = False
    draws: ClassVar[str] = "velocity"

    def draw(self, gas: _Gas, rng: Source) -> Array:
        """Return random velocities."""
        return maxwell_velocities(self.kT, gas.mass, rng, planar=gas.planar, exact=self.exact)


@dataclass(frozen=True, eq=False)
class EqualSpeeds:
    """Molecules start with one speed [length/time] in random directions: see `atmosbox.engine.equal_speeds`."""

    speed: float
    draws: ClassVar[str] = "velocity"

    def draw(self, gas: _Gas, rng: Source) -> Array:
        """Return random velocities."""
        return equal_speeds(self.speed, gas.mass.size, rng, planar=gas.planar)


@dataclass(frozen=True, eq=False)
class Rotating:
    """Molecules start with the rotational energies of equilibrium: see `atmosbox.engine.rotational_energies`.

    Parameters
    ----------
    kT : (molecule,) or one number
        Temperature [energy].
    exact
        Whether their sum is exactly kT / 2 for each rotational degree of freedom; kT is one number then.
    """

    kT: ArrayLike
    exact: bool = False
    draws: ClassVar[str] = "rotational_energy"

    def draw(self, gas: _Gas, rng: Source) -> Array:
        """Return random rotational energies."""
        energy = rotational_energies(self.kT, gas.rotation, rng)
        if self.exact and gas.rotation.any():
            energy *= 0.5 * float(np.asarray(self.kT) * gas.rotation.sum()) / energy.sum()
        return energy


class Drawn(NamedTuple):
    """Molecules at their start.

    ``position`` and ``velocity : (molecule, axis)`` are zero, and ``rotational_energy : (molecule,)`` is None, if no
    part of the start draws them.
    """

    position: Array
    velocity: Array
    rotational_energy: Array | None


@dataclass(frozen=True, eq=False)
class Start:
    """How the molecules of a box start.

    Parameters
    ----------
    molecules
        Number of molecules.
    parts
        `Scattered` or `Placed`, `Maxwell` or `EqualSpeeds`, and `Rotating` if molecules rotate. The random numbers are
        drawn in the order of the parts; another order gives another start.

    Examples
    --------
    A gas at rest in a cube, at kT = 1; velocities are drawn first:

    >>> from atmosbox.engine import RandomNumbers
    >>> start = Start(20, (Maxwell(1.0, exact=True), Scattered()))
    >>> drawn = start.draw(RandomNumbers(1), length=(5, 5, 5))
    >>> drawn.position.shape, round(float((drawn.velocity**2).mean()), 12)
    ((20, 3), 1.0)
    """

    molecules: int
    parts: tuple[Placed | Scattered | Maxwell | EqualSpeeds | Rotating, ...]

    def draw(
        self,
        rng: Source,
        *,
        length: Sequence[float] = (),
        diameter: ArrayLike = 1.0,
        mass: ArrayLike = 1.0,
        rotation: ArrayLike = 0.0,
        periodic: tuple[bool, bool, bool] = (False, False, False),
        planar: bool = False,
        apart: bool = True,
    ) -> Drawn:
        """Return molecules at their start; molecules and box are described as in `atmosbox.engine.Parcel`.

        Parameters
        ----------
        rng
            Random numbers.
        length, diameter, mass, rotation, planar
            As in `atmosbox.engine.Parcel`.
        periodic, apart
            As in `atmosbox.engine.random_positions`.
        """
        n = self.molecules
        sigma, m, turning = (np.broadcast_to(np.asarray(each, np.float64), (n,)) for each in (diameter, mass, rotation))
        gas = _Gas(length, sigma, m, turning, periodic, planar, apart)
        drawn = Drawn(np.zeros((n, 3)), np.zeros((n, 3)), None)
        for part in self.parts:
            drawn = drawn._replace(**{part.draws: part.draw(gas, rng)})
        return drawn

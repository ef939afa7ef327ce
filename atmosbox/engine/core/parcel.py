"""What every engine's box is given, knows and tells, however it lets time pass."""

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, Protocol, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.account import Array, Snapshot
from atmosbox.engine.core.adjustment import Adjustable
from atmosbox.engine.core.inputs import column, inside, matrix, natural_time, number, sides_of, whole
from atmosbox.engine.core.random import new_state
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.core.saved_state import SavedState, pack, restore, save, unpack
from atmosbox.engine.core.state import Tallies
from atmosbox.engine.core.walls import PERIODIC, PISTON, Specular, Wall, new_walls

__all__ = ["Arrangement", "Array", "Driver", "Parcel", "Snapshot"]


class Driver(Protocol):
    """What moves the piston: asked for its velocity at every multiple of ``interval``."""

    interval: float

    def velocity(self, parcel: "Parcel") -> float:
        """Return the velocity [length/time] from now until the next multiple of the interval."""


class Arrangement(TypedDict, total=False):
    """What a `Parcel` may be given by name: see there."""

    length: Sequence[float]
    walls: Sequence[Wall]
    mass: ArrayLike
    diameter: ArrayLike
    rotation: ArrayLike
    rotational_energy: ArrayLike | None
    gravity: float
    planar: bool
    collision_number: float
    layers: int
    seed: int
    driver: Driver | None
    collisions: bool


class Parcel(Adjustable):
    """Molecules in a box: what is common to all engines.

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
    collisions
        Whether molecules meet each other; without that they meet walls alone, and take no room from each other.

    Raises
    ------
    RefusedError
        If a number is impossible, or molecules stand outside the box, or overlap where the engine minds.
    """

    engine: ClassVar[str]
    """The name of the engine, as the command line and the file give it."""

    _frugal: ClassVar[bool] = False
    """Whether to save memory: a number given for all molecules is kept once, velocities are read where they stand."""

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
        collisions: bool = True,
    ) -> None:
        x = matrix(position, "position")
        v = matrix(velocity, "velocity", copy=not self._frugal)
        if x.shape != v.shape:
            raise RefusedError(f"{len(x)} positions and {len(v)} velocities: give one velocity for each position")
        n = len(x)
        self._mass = column(mass, n, "mass", above=0.0, shared=self._frugal)
        self._diameter = column(diameter, n, "diameter", least=0.0, shared=self._frugal)
        self._rotation = column(rotation, n, "rotation", least=0.0, shared=self._frugal)
        if not np.isin(self._rotation, (0.0, 2.0, 3.0)).all():
            raise RefusedError("the rotational degrees of freedom of a molecule are 0, 2 or 3")
        spin = 0.0 if rotational_energy is None else rotational_energy
        spin = column(spin, n, "rotational_energy", least=0.0, shared=self._frugal)
        self._sides = sides_of(length)
        self._gravity = number(gravity, "gravity", least=0.0)
        self._collision_number = number(collision_number, "collision_number", least=1.0, infinite=True)
        layers = whole(layers, "layers", least=1)
        self._seed = whole(seed, "seed", least=0)
        if planar and (v[:, 1] != 0.0).any():
            raise RefusedError("a plane gas has no velocity along y: make the second column of velocity 0")
        if planar and n and np.ptp(x[:, 1]) > 0.0:
            raise RefusedError("the centres of a plane gas lie in one plane: make the second column of position equal")
        self._walls = new_walls(tuple(walls) if isinstance(walls, Sequence) else (), float(self._sides[2]))
        law = self._walls.law
        self._periodic = (bool(law[0] == PERIODIC), bool(law[2] == PERIODIC), bool(law[4] == PERIODIC))
        if self._gravity > 0.0 and self._periodic[2]:
            raise RefusedError("a box that is periodic along z cannot have gravity: molecules would fall for ever")
        if driver is not None and law[5] != PISTON:
            raise RefusedError("a driver needs a piston: make wall z_high a Piston")
        if driver is not None and not (math.isfinite(driver.interval) and driver.interval > 0.0):
            raise RefusedError(f"interval of the driver = {driver.interval} must be finite and above 0")
        self._planar = bool(planar)
        self._driver = driver
        self._collisions = bool(collisions)
        x = inside(x, self._diameter, self._sides, self._periodic)
        if planar:  # nothing ever moves along y
            self._periodic = (self._periodic[0], False, self._periodic[2])
        self._number = n
        self._freedom = (2.0 if planar else 3.0) + (float(self._rotation.mean()) if n else 0.0)
        self._rotates = bool((self._rotation > 0.0).any())
        self._alike = bool(n) and all(np.ptp(a) == 0.0 for a in (self._mass, self._diameter, self._rotation))
        self._same_size = bool(n) and np.ptp(self._diameter) == 0.0
        self._spread = natural_time(v, self._sides, n, self._walls, self._mass, self._gravity)
        self._tallies = Tallies(
            count=np.zeros(5, np.int64),
            impulse=np.zeros(6),
            heat=np.zeros(6),
            hits=np.zeros(6, np.int64),
            work=np.zeros(6),
            virial=np.zeros(layers),
            layer_scale=layers / float(self._sides[2]),
            random=new_state(self._seed),
            progress=np.array([-math.inf, 0.0]),
        )
        self._now = 0.0
        self._asked: float | None = None
        self._turns = np.zeros(1, np.int64)  # how often the driver has been asked since the start
        start = [v, x]
        del v, x  # so that an engine may let them go once it has its own
        self._begin(start.pop(), start.pop(), spin)
        self._start_energy = sum(self.energy()) + self.condensed_energy
        self._drive()

    def __repr__(self) -> str:
        """Return a line that says what is in the box."""
        sides = " x ".join(f"{side:.6g}" for side in self.length)
        name = type(self).__name__
        return f"<{name}: {self.number} molecules in {sides}, t = {self.time:.6g}, {self.contacts} contacts>"

    # ------------------------------------------------------------------ copies, and states on disk

    def __getstate__(self) -> Any:
        """Return what a copy needs: `copy.deepcopy` and pickle give a box that goes on as this one would."""
        return pack(vars(self))

    def __setstate__(self, state: Any) -> None:
        vars(self).update(unpack(*state))
        self._find_kernels()

    def state(self) -> SavedState:
        """Return the state of the box as named arrays and plain numbers, for a file: see `saved_state`.

        It holds all that changes while time passes, that of the driver included. What the box was made from is not
        told apart from that: a box is made again in the same way before it is put into the state.

        Raises
        ------
        RefusedError
            If the driver holds something that is neither a number nor an array, nor made of such.

        Examples
        --------
        >>> from atmosbox.engine import ParcelSet
        >>> def pair():
        ...     return ParcelSet([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))
        >>> first, second = pair(), pair()
        >>> first.advance(1.0)
        >>> second.restore(first.state())
        >>> second.time, second.contacts
        (1.0, 1)
        """
        return save(self)

    def restore(self, state: SavedState) -> None:
        """Put this box, which is made as the other one was, into a state of that one.

        From then on it does what the other one did, bit for bit, on any processor.

        Raises
        ------
        RefusedError
            If the state is that of a box with other parts.
        """
        restore(self, state)
        self._find_kernels()

    # ------------------------------------------------------------------ what each engine does its own way

    def _find_kernels(self) -> None:
        """Find the kernels that are compiled for a box like this one."""

    @abstractmethod
    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Lay out the molecules as the engine wants them."""

    @abstractmethod
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

    @abstractmethod
    def memory(self) -> int:
        """Return the bytes that molecules and all that finds their collisions take."""

    # ------------------------------------------------------------------ what it holds

    @property
    def number(self) -> int:
        """Number of molecules."""
        return self._number

    @property
    def present(self) -> NDArray[np.bool_]:
        """Which of the molecules that the box has ever held are in the gas now: all, unless some can condense.

        A molecule keeps its place in this list, whether it is in the gas or in the liquid.
        """
        return np.ones(self.number, np.bool_)

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
        alike = self._same_size
        diameter = float(self._diameter[0]) if alike else self.diameter
        share = 1.0 if alike else np.ones(self.number)
        for axis in (0, 2) if self._planar else (0, 1, 2):
            share = share * (sides[axis] - (0.0 if self._periodic[axis] else diameter))
        each = 1.0 / share
        return float(self.number * each if alike else np.sum(each))

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
        return self._gravity

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
    def ideal(self) -> bool:
        """Whether molecules have no excluded volume, so that the pressure is n kT."""
        return not (self._collisions and self._diameter.any())

    # ------------------------------------------------------------------ what moves it

    def _drive(self) -> None:
        if self._driver is not None:
            self.set_piston_velocity(self._driver.velocity(self))

"""The box of molecules: its parameters, its state, and what every engine must provide to advance it."""

import math
from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine.core.account import Array, Snapshot
from atmosbox.engine.core.adjustment import Adjustable
from atmosbox.engine.core.inputs import column, inside, matrix, natural_time, sides_of, speeds
from atmosbox.engine.core.random import new_state
from atmosbox.engine.core.refusal import LARGEST, SMALLEST, RefusedError, number, whole
from atmosbox.engine.core.saved_state import SavedState, pack, restore, save, unpack
from atmosbox.engine.core.state import Box, Tallies
from atmosbox.engine.core.walls import PERIODIC, PISTON, Specular, Wall, new_walls

if TYPE_CHECKING:
    from atmosbox.engine.start.start import Start

_OVERLAP = 1e-9

__all__ = ["Arrangement", "Array", "Driver", "Parcel", "Snapshot"]


class Driver(Protocol):
    """What sets the velocity of the piston: its ``velocity`` is called at every multiple of ``interval`` [time]."""

    interval: float

    def velocity(self, parcel: "Parcel") -> float:
        """Return the velocity [length/time] from now until the next multiple of the interval."""


class Arrangement(TypedDict, total=False):
    """The keyword arguments of `Parcel`; their meaning is described there."""

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
    """Molecules in a box: the part that all engines share.

    Parameters
    ----------
    position, velocity : (molecule, axis)
        Centres [length] and velocities [length/time].
    length
        The three sides of the box [length]; along z, the height of the ceiling at the start.
    walls
        Six laws: x low, x high, y low, y high, z low, z high; specular by default.
    mass, diameter, rotation : (molecule,) or one number
        Mass [mass], diameter [length; 0 makes an ideal gas], rotational degrees of freedom (0, 2 or 3).
    rotational_energy : (molecule,)
        Rotational energy at the start [energy]; zero by default.
    gravity
        Downward acceleration [length/time^2].
    planar
        Whether this is a plane gas: all y must be equal, all y velocities zero, and neither ever changes.
    collision_number
        Average number of contacts per exchange of energy with rotation, >= 1, ``inf`` for no exchange.
    layers
        Number of horizontal layers of equal thickness in which the virial of contacts is summed.
    seed
        Seed of the random numbers.
    driver
        What sets the velocity of the piston, a `Driver`; it needs a piston as ceiling.
    collisions
        Whether molecules collide with each other; if not, they hit walls alone and have no excluded volume.

    Raises
    ------
    RefusedError
        If a number is impossible, or molecules lie outside the box, or overlap in an engine that forbids it.
    """

    engine: ClassVar[str]
    """Name of the engine, as the command line and the output file give it."""

    start: "Start | None" = None
    """How the molecules started, if that was declared and the seed decides nothing else."""

    _frugal: ClassVar[bool] = False
    """Whether to save memory: a number given for all molecules is kept once, and velocities are not copied."""

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
        speeds(v)
        n = len(x)
        self._mass = column(mass, n, "mass", positive=True, small=SMALLEST, shared=self._frugal)
        self._diameter = column(diameter, n, "diameter", small=SMALLEST, shared=self._frugal)
        self._rotation = column(rotation, n, "rotation", shared=self._frugal)
        if not np.isin(self._rotation, (0.0, 2.0, 3.0)).all():
            raise RefusedError("the rotational degrees of freedom of a molecule are 0, 2 or 3")
        spin = 0.0 if rotational_energy is None else rotational_energy
        spin = column(spin, n, "rotational_energy", shared=self._frugal)
        self._sides = sides_of(length)
        self._gravity = number(gravity, "gravity", least=0.0, most=LARGEST)
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
        if driver is not None:
            number(driver.interval, "interval of the driver", above=0.0)
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
        self._asked = None
        self._turns = np.zeros(1, np.int64)  # number of the driver's calls since the start
        start = [v, x]
        del v, x  # so that an engine may free them once it has its own arrays
        self._begin(start.pop(), start.pop(), spin)
        self._start_energy = sum(self.energy()) + self.condensed_energy
        self._drive()

    def __repr__(self) -> str:
        """Return a line with the type, number of molecules, sides, time and number of contacts."""
        sides = " x ".join(f"{side:.6g}" for side in self.length)
        name = type(self).__name__
        return f"<{name}: {self.number} molecules in {sides}, t = {self.time:.6g}, {self.contacts} contacts>"

    def _new_box(self, *, moving: bool = False, stall: float = 0.0) -> Box:
        """Return the box for kernels; with a moving ceiling its height is ``inf``: the position is kept in `Walls`."""
        x, y, z = map(float, self._sides)
        a, b, c = (1.0 / side if turn else 0.0 for side, turn in zip((x, y, z), self._periodic, strict=True))
        exchange = 1.0 / self._collision_number
        return Box(x, y, math.inf if moving else z, a, b, c, self._gravity, self._planar, exchange, stall)

    def _refuse_overlap(self, depth: float, i: float, j: float) -> None:
        """Refuse molecules i and j, the deepest overlap at the start, if it is more than rounding makes."""
        if depth > _OVERLAP:
            raise RefusedError(
                f"molecules {i:.0f} and {j:.0f} overlap at the start, by {depth:.3g} of their diameter: "
                "move them apart or make them smaller"
            )

    # ------------------------------------------------------------------ copies, and states in files

    def __getstate__(self) -> Any:
        """Return the state for `copy.deepcopy` and pickle; the copy goes on exactly as this box would."""
        return pack(vars(self))

    def __setstate__(self, state: Any) -> None:
        vars(self).update(unpack(*state))
        self._find_kernels()

    def state(self) -> SavedState:
        """Return the state of the box as named arrays and plain numbers, for a file: see `saved_state`.

        The state holds everything that changes with time, the driver's numbers included. It does not tell how the box
        was made: to restore it, first make a box in the same way.

        Raises
        ------
        RefusedError
            If the driver holds anything else than numbers, arrays, and lists, tuples or plain objects of these.

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
        """Put this box into the saved state of a box that was made in the same way.

        From then on it does what that box did, bit for bit, on any processor.

        Raises
        ------
        RefusedError
            If the state is that of a box that was made in another way.
        """
        restore(self, state)
        self._find_kernels()

    # ------------------------------------------------------------------ what each engine does in its own way

    def _find_kernels(self) -> None:
        """Find the kernels that are compiled for a box like this one."""

    @abstractmethod
    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        """Set up the molecules in the engine's own arrays."""

    @abstractmethod
    def advance(self, until: float, watch: Callable[[float], None] | None = None) -> None:
        """Advance the box to the time ``until`` [time since the start].

        Parameters
        ----------
        until
            When to stop. The result does not depend on the pieces into which a run is cut.
        watch
            Called with the time about every tenth of a second. If it raises (Ctrl-C), the box is left in a state from
            which the run can go on.

        Raises
        ------
        RefusedError
            If ``until`` lies in the past or is not finite.
        StalledError
            If very many events happen in a vanishing time, so that time no longer advances.
        """

    @abstractmethod
    def memory(self) -> int:
        """Return the memory of the molecules and of the search for their collisions [bytes]."""

    # ------------------------------------------------------------------ the state

    @property
    def number(self) -> int:
        """Number of molecules."""
        return self._number

    @property
    def present(self) -> NDArray[np.bool_]:
        """Which molecules are in the gas now, (molecule,): all of them, unless some can condense.

        A molecule keeps its index, whether it is in the gas or in the liquid.
        """
        return np.ones(self.number, np.bool_)

    @property
    def volume(self) -> float:
        """Volume of the box now [length^3]; of a plane gas, its area [length^2]."""
        sides = self.length
        return float(sides[0] * sides[2] if self._planar else math.prod(sides))

    @property
    def open_density(self) -> float:
        """Sum over molecules of 1 / (volume that its centre can reach) now [1/length^3; planar: 1/length^2].

        Times kT it is exactly the pressure on the walls of molecules that never collide. The volume of the box would
        be too large for that: no centre enters the layer, half a diameter thick, at a wall.
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
    def periodic(self) -> tuple[bool, bool, bool]:
        """Whether each axis (x, y, z) is periodic."""
        return self._periodic

    @property
    def laws(self) -> NDArray[np.int64]:
        """Law of each of the six walls, (wall,), as in `atmosbox.engine.core.walls`."""
        return np.array(self._walls.law)

    @property
    def gravity(self) -> float:
        """Downward acceleration [length/time^2]."""
        return self._gravity

    @property
    def planar(self) -> bool:
        """Whether this is a plane gas."""
        return self._planar

    @property
    def rotation(self) -> Array:
        """Rotational degrees of freedom of each molecule."""
        return self._rotation

    @property
    def degrees_of_freedom(self) -> float:
        """Mean number of translational and rotational degrees of freedom of a molecule."""
        return self._freedom

    @property
    def ideal(self) -> bool:
        """Whether molecules have no excluded volume, so that the pressure is n kT."""
        return not (self._collisions and self._diameter.any())

    # ------------------------------------------------------------------ the driver

    @property
    def driver(self) -> Driver | None:
        """What sets the velocity of the piston, if anything does."""
        return self._driver

    def _drive(self) -> None:
        if self._driver is not None:
            self.set_piston_velocity(self._driver.velocity(self))

"""The parcel of air advanced in time steps, as simple programs do it: all move, then those that overlap collide."""

import math
from typing import Any, ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine.core.inputs import number, whole
from atmosbox.engine.core.jit import use_threads
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.engine.core.parcel import Arrangement, Array, Snapshot
from atmosbox.engine.core.refusal import RefusedError, StalledError, shown
from atmosbox.engine.core.state import KIND, Box, Kinds, Modes, aligned_records
from atmosbox.engine.core.walls import PISTON
from atmosbox.engine.exact.stall import crushing_height, why_crushed
from atmosbox.engine.stepped.bounce import CLAMP, FLIP, FOLD, MIRROR, REWIND
from atmosbox.engine.stepped.filing import new_records
from atmosbox.engine.stepped.flight import BLOCK, EULER, PARABOLA, SEMI_IMPLICIT
from atmosbox.engine.stepped.gridding import choose_cells
from atmosbox.engine.stepped.stepped import Rules, State, SteppedGas, specialise
from atmosbox.engine.stepped.stepped_start import judge_overlap, judge_step

__all__ = ["SteppedParcel"]

_MOTIONS = {"parabola": PARABOLA, "euler": EULER, "semi-implicit": SEMI_IMPLICIT}
_RULES = {"mirror": MIRROR, "fold": FOLD, "flip": FLIP, "clamp": CLAMP, "rewind": REWIND}
_REORDER = 64
_GO, _GO_ON, _LOOK = 0, 1, 2


class SteppedParcel(MarchingParcel):
    r"""A set of molecules with its box, advanced step by step: those that overlap and approach collide.

    Its other parameters, and its properties, are described at `Parcel`; the errors of the scheme, at `stepped`.

    Parameters
    ----------
    position, velocity, **box
        See `Parcel`.
    delta
        Length of a step, as the fraction of the smallest diameter that the thermal speed of the lightest molecule
        crosses in it, :math:`\Delta t \sqrt{kT/m} / \sigma`, at the highest of the temperatures of molecules and walls.
    dt
        Length of a step [time], instead of ``delta``; it is needed if all diameters are 0.
    motion
        Rule for the fall: "parabola" (exact), "euler" or "semi-implicit": see `flight`.
    smooth_walls
        Rule for specular walls at rest: "mirror" (exact), "fold", "flip", "clamp" or "rewind": see `bounce`.
    approaching
        Whether only pairs that approach collide. Without that test, a common mistake, a pair that still overlaps a step
        later collides once more, so that its molecules approach again.
    threads
        Number of threads; the result has the same bits for any number.

    Raises
    ------
    RefusedError
        As `Parcel`; or if the step is so long that a molecule would cross the box in it.

    Warns
    -----
    CoarseStepWarning
        If the fastest molecule moves by more than a tenth of the smallest radius in a step.

    Examples
    --------
    Two molecules that approach each other along x collide once and keep their energy:

    >>> pair = SteppedParcel([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4), delta=0.01)
    >>> pair.advance(1.0)
    >>> pair.contacts, pair.snapshot().velocity[:, 0].tolist()
    (1, [-1.0, 1.0])
    """

    engine: ClassVar[str] = "stepped"

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        *,
        delta: float = 0.05,
        dt: float | None = None,
        motion: str = "parabola",
        smooth_walls: str = "mirror",
        approaching: bool = True,
        threads: int = 1,
        **box: Unpack[Arrangement],
    ) -> None:
        self._delta = number(delta, "delta", least=1e-12)
        self._asked_step = None if dt is None else number(dt, "dt", least=1e-300)
        self._motion = _choice(motion, _MOTIONS, "motion")
        self._rule = _choice(smooth_walls, _RULES, "smooth_walls")
        self._approaching = bool(approaching)
        self._threads = whole(threads, "threads", least=1)
        super().__init__(position, velocity, **box)

    # ------------------------------------------------------------------ the state

    @property
    def delta(self) -> float:
        """Length of a step as the fraction of a diameter that a molecule crosses in it; 0 if diameters are 0."""
        return self._time_step * self._speed / self._smallest if self._smallest > 0.0 else 0.0

    @property
    def receding(self) -> int:
        """Number of times that an overlapping pair was found moving apart.

        A pair that collided has moved out of overlap a step later. So in a dilute gas these are missed collisions:
        three in four of those are found in this way, when the pair has passed its nearest distance but still overlaps.
        """
        return int(self._seen[0])

    @property
    def numerical_heat(self) -> float:
        """Energy that the scheme itself has made since the start [energy], negative if it has lost some.

        With gravity the Euler rules make energy in every step, and smooth walls that fold or clamp at every hit.
        The exact motion between walls that mirror, flip or rewind makes none, and no collision ever does.
        """
        return float(self._made[0])

    def memory(self) -> int:
        """Return the memory of the molecules and of the search for their collisions [bytes]."""
        held = (*self._state, *self._records, *self._kinds, self._pairs)
        return sum(int(array.nbytes) for array in held if array is not None)

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; the box does not change."""
        position = np.empty((self.number, 3))
        velocity = np.empty((self.number, 3))
        position[self._state.name] = self._state.position.T
        velocity[self._state.name] = self._state.velocity.T
        spin = np.array(self._kinds.rotational_energy) if self._rotates else np.zeros(self.number)
        return Snapshot(self.time, position, velocity, spin)

    # ------------------------------------------------------------------ how steps are made

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        for axis in range(3):
            if self._periodic[axis]:
                position[:, axis] = np.mod(position[:, axis], self._sides[axis]) % self._sides[axis]
        self._choose_step(velocity)
        n = self._number
        mixed = n > 0 and not self._alike
        self._modes = Modes(
            contacts=n > 1 and not self.ideal,
            gravity=self._gravity > 0.0,
            rotation=self._rotates,
            mixed=mixed,
            spanning=False,
            periodic=any(self._periodic),
            piston=bool(self._walls.law[5] == PISTON),
        )
        table = aligned_records(n if mixed else 1, KIND)
        if n:
            few = slice(None) if mixed else slice(1)
            table["mass"], table["radius"] = self._mass[few], 0.5 * self._diameter[few]
            table["rotation"] = self._rotation[few]
        self._kinds = Kinds(table, rotational_energy if self._rotates else np.zeros(1))
        kT = float(np.sum(self._mass[:, None] * velocity**2)) / (3.0 * n) if n else 0.0
        weight = self._gravity * float(self._mass.mean()) if n else 0.0
        self._grid = choose_cells(
            self._sides,
            self._periodic,
            self._diameter,
            planar=self._planar,
            scale_height=kT / weight if kT > 0.0 and weight > 0.0 else math.inf,
            equal=not mixed,
        )
        self._records = new_records(n, self._grid, self._threads, mixed=mixed)
        self._state = State(
            position=np.ascontiguousarray(position.T),
            velocity=np.ascontiguousarray(velocity.T),
            name=np.arange(n, dtype=np.uint32),
            size=(0.5 * self._diameter).astype(np.float32),
            cell=np.zeros(n, np.int32),
            hitting=np.zeros(n, np.uint32),
            before=np.zeros((self._threads, 2, BLOCK)),
        )
        inverse = np.where(self._periodic, 1.0 / self._sides, 0.0)
        sides = [float(side) for side in (*self._sides, *inverse)]
        self._box = Box._make([*sides, self._gravity, self._planar, 1.0 / self._collision_number, 0.0])
        self._pairs = np.zeros((self._threads, 256 + n // (4 * self._threads), 2), np.uint32)
        self._numbers = np.zeros((self._threads, 2), np.int64)
        self._seen = np.zeros(1, np.int64)
        self._made = np.zeros(1)
        self._total_mass = float(self._mass.sum())
        self._lowest_ceiling = crushing_height(self._sides, self._diameter, planar=self._planar)
        self._find_kernels()
        if n:
            self._advance(0, 1, _LOOK)
            pairs = np.concatenate([self._pairs[part, : self._numbers[part, 0]] for part in range(self._threads)])
            judge_overlap(pairs, self._state.position, self._diameter, self._sides, self._periodic)

    def _choose_step(self, velocity: Array) -> None:
        """Choose the length of a step; refuse one that is too long, and warn of a coarse one."""
        thermal = self._thermal_speeds(velocity)
        sized = self._diameter[self._diameter > 0.0]
        self._smallest = float(sized.min()) if sized.size else 0.0
        self._speed = float(thermal.max(initial=0.0)) or math.sqrt(self._gravity * float(self._sides[2]))
        if self._asked_step is not None:
            self._time_step = self._asked_step
        elif not self._number:
            self._time_step = self._spread
        elif not sized.size:
            raise RefusedError("molecules without size have no delta: give the length of a step as dt")
        else:
            step = self._delta * (self._smallest / self._speed if self._speed > 0.0 else self._spread)
            # however large the molecules are, a step is shorter than the time of their hops on the floor
            self._time_step = min(step, 0.5 * self._speed / self._gravity) if self._gravity > 0.0 else step
        if not self._number:
            return
        speed = np.maximum(np.abs(velocity).max(axis=0), float(thermal.max()))
        speed[2] = max(speed[2], abs(self.piston_velocity))
        if self._planar:
            speed[1] = 0.0
        room = self._sides - np.where(self._periodic, 0.0, float(self._diameter.max()))
        judge_step(self._time_step, speed, room, 0.5 * self._smallest)

    def _renew(self) -> None:
        self._box = self._box._replace(gravity=self._gravity)  # the length of a step is passed with every march
        self._modes = self._modes._replace(gravity=self._gravity > 0.0)
        self._find_kernels()

    def _find_kernels(self) -> None:
        self._kernel = specialise(self._modes, self._threads > 1)

    def _march(self, steps: int) -> None:
        allowed = steps
        speed = -self.piston_velocity * self._time_step
        if speed > 0.0:
            allowed = min(steps, max(0, math.floor((self.ceiling - self._lowest_ceiling) / speed)))
        done = 0
        while done < allowed and self._number:
            first = self._step + done
            many = min(allowed - done, _REORDER - first % _REORDER)
            self._advance(first, many, _GO)
            done += many
            if self._modes.contacts and (first + many) % _REORDER == 0:
                self._reorder()
        if allowed < steps:
            self._step += allowed
            self._now = self._step * self._time_step
            raise StalledError(why_crushed(self))

    def _advance(self, first: int, steps: int, phase: int) -> None:
        """Call the kernel, again with more memory for pairs whenever that is too short."""
        if self._threads > 1:
            use_threads(self._threads)
        rules = Rules(self._time_step, self._motion, self._rule, self._approaching)
        while True:
            gas = SteppedGas(
                self._state, self._kinds, self._box, self._walls, self._tallies, self._pairs, self._numbers,
                self._seen, self._made, self._total_mass,
            )  # fmt: skip
            span = (first, steps, phase)
            done = self._kernel(
                self._state, self._records, self._records.radius, self._grid, self._box, gas, rules, span
            )  # fmt: skip
            if done == steps:
                return
            first += done
            steps -= done
            phase = max(phase, _GO_ON)
            room = int(1.5 * self._numbers[:, 0].max()) + 256
            self._pairs = np.zeros((self._threads, room, 2), np.uint32)

    def _reorder(self) -> None:
        """Put neighbours next to each other in memory: molecules take the order of the records."""
        order = self._records.slot
        self._state = self._state._replace(
            position=np.take(self._state.position, order, axis=1),
            velocity=np.take(self._state.velocity, order, axis=1),
            name=self._state.name[order],
            size=self._state.size[order],
        )


def _choice(value: Any, choices: dict[str, int], name: str) -> int:
    """Return the number of a named choice, or refuse the name."""
    if not isinstance(value, str) or value not in choices:
        raise RefusedError(f"{name} = {shown(value)} is unknown: give one of {', '.join(choices)}")
    return choices[value]

"""The parcel of air advanced in time steps, as simple programs do it: all move, then those that overlap collide."""

import math
import warnings
from typing import ClassVar, Unpack

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.engine.core.parcel import Arrangement, Array, Snapshot
from atmosbox.engine.core.refusal import CoarseStepWarning, RefusedError, StalledError, number, shown
from atmosbox.engine.core.state import KIND, Kinds, Modes, aligned_records
from atmosbox.engine.core.walls import PISTON
from atmosbox.engine.exact.stall import crushing_height, why_crushed
from atmosbox.engine.stepped.flight import MOTIONS, SMOOTH_WALLS
from atmosbox.engine.stepped.stepped import INDEX_ORDER, LOOK, LOOK_AHEAD, RULES, Cells, Step, SteppedGas, specialise

_COARSE = 0.1
_OCCUPANCY = 4.0


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
    rule
        Which pairs collide, and how they are found: "pairwise", "index-order", "look-ahead" or "every-overlap": see
        `stepped`.
    motion
        Rule for the fall: "parabola" (exact) or "euler": see `flight`.
    smooth_walls
        Rule for smooth walls at rest: "mirror" (exact), "fold", "flip", "clamp" or "undo": see `flight`.

    Raises
    ------
    RefusedError
        As `Parcel`; or if the step is so long that a molecule would cross the box in it, or molecules overlap.

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
        rule: str = "pairwise",
        motion: str = "parabola",
        smooth_walls: str = "mirror",
        **box: Unpack[Arrangement],
    ) -> None:
        self._delta = number(delta, "delta", least=1e-12)
        self._asked_step = None if dt is None else number(dt, "dt", least=1e-300)
        choices = ((motion, MOTIONS, "motion"), (smooth_walls, SMOOTH_WALLS, "smooth_walls"), (rule, RULES, "rule"))
        for value, known, name in choices:
            if value not in known:
                raise RefusedError(f"{name} = {shown(value)} is unknown: give one of {', '.join(known)}")
        self._rules = tuple(known.index(value) for value, known, _ in choices)
        super().__init__(position, velocity, **box)

    # ------------------------------------------------------------------ the state

    @property
    def numerical_heat(self) -> float:
        """Energy that the scheme itself has made since the start [energy], negative if it has lost some.

        Only in gravity: the Euler rule makes energy in every step, and smooth walls that fold, clamp or undo make it at
        every hit. The parabola between walls that mirror or flip makes none, and no collision ever does.
        """
        return float(self._gas.made[0])

    def memory(self) -> int:
        """Return the memory of the molecules and of the search for their collisions [bytes]."""
        held = (self._gas.position, self._gas.velocity, *self._gas.kinds, *self._gas.cells[4:])
        return sum(int(array.nbytes) for array in held)

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; the box does not change."""
        spin = self._gas.kinds.rotational_energy.copy() if self._rotates else np.zeros(self.number)
        return Snapshot(self.time, self._gas.position.copy(), self._gas.velocity.copy(), spin)

    # ------------------------------------------------------------------ how steps are made

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        turns = np.array(self._periodic)
        position[:, turns] = np.mod(position[:, turns], self._sides[turns]) % self._sides[turns]
        self._choose_step(velocity)
        n = self._number
        mixed = n > 0 and not self._alike
        self._modes = Modes(
            contacts=n > 1 and not self.ideal,
            gravity=self._gravity > 0.0,
            rotation=self._rotates,
            mixed=mixed,
            periodic=any(self._periodic),
            piston=bool(self._walls.law[5] == PISTON),
        )
        table = aligned_records(n if mixed else 1, KIND)
        few = slice(None if mixed else min(n, 1))
        table["mass"][: few.stop], table["radius"][: few.stop] = self._mass[few], 0.5 * self._diameter[few]
        table["rotation"][: few.stop] = self._rotation[few]
        kinds, cells = Kinds(table, rotational_energy if self._rotates else np.zeros(1)), self._new_cells()
        self._gas = SteppedGas(
            position, velocity, kinds, self._new_box(), self._walls, self._tallies, cells, np.zeros(1), np.zeros(3)
        )
        self._lowest_ceiling = crushing_height(self._sides, self._diameter, planar=self._planar)
        self._find_kernels()
        self._kernel(self._gas, Step(0.0, 0.0, 0.0, 0.0, 0, 0, LOOK), 0, 1)
        self._refuse_overlap(*self._gas.deepest)

    def _new_cells(self) -> Cells:
        """Return cells in which there are a few molecules each; refuse a periodic box that is too short."""
        biggest, n = float(self._diameter.max(initial=0.0)), self._number
        for side, periodic in zip(self._sides, self._periodic, strict=True):
            if periodic and 0.45 * side <= 1.001 * biggest:
                raise RefusedError(
                    f"a periodic box of length {side:.6g} is too short for molecules of diameter {biggest:.6g}, which "
                    f"would meet their own images: make it longer than {2.25 * biggest:.6g}"
                )
        across, width = np.ones(3, np.int64), float(self._sides.max())
        while math.prod(across.tolist()) * _OCCUPANCY < n:
            width *= 0.9
            across = np.maximum(1, self._sides / width).astype(np.int64)
            across[1] = 1 if self._planar else across[1]
        (x, y, z), (order, cell) = across.tolist(), np.zeros((2, n), np.int64)
        return Cells(x, y, z, 0.5 * biggest, cell, order, np.zeros(x * y * z + 2, np.int64))

    def _choose_step(self, velocity: Array) -> None:
        """Choose the length of a step; refuse one in which molecules cross the box, and warn of a coarse one."""
        degrees = (2.0 if self._planar else 3.0) * max(self._number, 1)
        kT = self._warmest(float(np.sum(self._mass[:, None] * velocity**2)) / degrees)
        thermal = np.sqrt(kT / self._mass)
        self._smallest = float(self._diameter[self._diameter > 0.0].min(initial=math.inf))
        self._speed = float(thermal.max(initial=0.0)) or math.sqrt(self._gravity * float(self._sides[2]))
        if self._asked_step is None and self._number and math.isinf(self._smallest):
            raise RefusedError("molecules without size have no delta: give the length of a step as dt")
        step = self._asked_step or self._spread
        if self._asked_step is None and self._speed > 0.0:
            step = self._delta * self._smallest / self._speed
            # however large the molecules are, a step is shorter than the time of their hops on the floor
            step = min(step, 0.5 * self._speed / self._gravity) if self._gravity > 0.0 else step
        self._time_step = step
        if not self._number:
            return
        speed = np.maximum(np.abs(velocity).max(axis=0), float(thermal.max()))
        speed[2] = max(speed[2], abs(self.piston_velocity))
        speed[1] = 0.0 if self._planar else speed[1]
        fastest, radius = float(speed.max()), 0.5 * self._smallest
        room = self._sides - np.where(self._periodic, 0.0, float(self._diameter.max()))
        fine = _COARSE * radius / fastest if fastest > 0.0 else math.inf
        if (speed * step > room).any():
            axis, longest = int(np.argmax(speed * step > room)), float(np.min(room[speed > 0.0] / speed[speed > 0.0]))
            remedy = f"give dt = {min(fine, _COARSE * longest):.4g} or less" if longest > 0.0 else "make the box longer"
            raise RefusedError(
                f"dt = {step:.4g} is so long that a molecule as fast as {speed[axis]:.4g} would cross the box along "
                f"{'xyz'[axis]} in one step: {remedy}"
            )
        if step > fine:
            warnings.warn(
                f"the step is coarse: delta_max = dt v_max / radius = {step * fastest / radius:.3g}, the part of a "
                f"radius that the fastest molecule crosses in it, is above {_COARSE}, so that collisions come late and "
                f"some are missed: dt = {fine:.4g} would do",
                CoarseStepWarning,
                stacklevel=5,
            )

    def _renew(self) -> None:
        self._gas = self._gas._replace(box=self._gas.box._replace(gravity=self._gravity))
        self._modes = self._modes._replace(gravity=self._gravity > 0.0)
        self._find_kernels()

    def _find_kernels(self) -> None:
        self._kernel = specialise(self._modes)

    def _effort(self) -> int:
        all_pairs = self._rules[2] in (INDEX_ORDER, LOOK_AHEAD)
        return self._number + (self._number**2 // 16 if all_pairs else 0)

    def _march(self, steps: int) -> None:
        speed = -self.piston_velocity * self._time_step
        room = (self.ceiling - self._lowest_ceiling) / speed if speed > 0.0 else math.inf
        allowed = int(max(0.0, min(steps, room)))
        self._kernel(self._gas, Step(0.0, self._time_step, 0.0, 0.0, *self._rules), self._step, allowed)
        if allowed < steps:
            self._step += allowed
            self._now = self._step * self._time_step
            raise StalledError(why_crushed(self))

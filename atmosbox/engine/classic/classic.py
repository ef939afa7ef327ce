"""The schemes of common teaching applets: three of them, each in its own file, as a lesson and a baseline.

================  ======================================  ==================  ==========================
scheme            molecules                               tested pairs        beyond a wall
================  ======================================  ==================  ==========================
`classic_strips`     equal discs in a plane                  strips              the move is undone
`classic_lookahead`  discs of unequal mass in a plane        all pairs           put back onto the wall
`classic_spheres`    spheres in space                        all pairs           reflected
================  ======================================  ==================  ==========================
"""

import math
from typing import Any, ClassVar, Literal, Unpack

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.engine.classic.classic_lookahead import march_lookahead
from atmosbox.engine.classic.classic_spheres import march_spheres
from atmosbox.engine.classic.classic_strips import Strips, march_strips, strips_across
from atmosbox.engine.classic.classic_tally import Discs, Frame, Score
from atmosbox.engine.core.inputs import number
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.engine.core.parcel import Arrangement, Array, Snapshot
from atmosbox.engine.core.refusal import RefusedError, shown
from atmosbox.engine.core.walls import PISTON

__all__ = ["ClassicParcel", "Scheme"]

Scheme = Literal["strips", "lookahead", "spheres"]
SCHEMES: tuple[Scheme, ...] = ("strips", "lookahead", "spheres")


class ClassicParcel(MarchingParcel):
    r"""Molecules in a box, advanced the way teaching applets do it.

    Its other parameters, and its properties, are described at `Parcel`; it has no rotation and no piston. Molecules may
    overlap, at the start too.

    Parameters
    ----------
    position, velocity : (molecule, axis)
        Centres [length] and velocities [length/time].
    scheme
        ``"strips"``, ``"lookahead"`` or ``"spheres"``; by default strips for equal discs in a plane, lookahead for
        unequal ones, else spheres.
    delta
        The time step, as the fraction of its diameter that a molecule moves in it at its thermal speed,
        :math:`\Delta t \sqrt{kT/m} / \sigma`, for the fastest kind and the smallest size. A tenth is what an
        applet of 60 frames a second takes if a molecule crosses a picture of a hundred diameters in some 17 s.
    dt
        The time step itself [time], instead of delta.
    epsilon
        How far ahead the scheme ``"lookahead"`` looks [time].
    closing_only
        Whether spheres that move apart already are left unchanged; False shows a common mistake.
    **box
        The parameters of every engine's box: see `Parcel`.

    Raises
    ------
    RefusedError
        If a number is impossible, or the box has a feature that no classic scheme has.

    Examples
    --------
    Two discs that approach each other along x swap their velocities and keep their energy:

    >>> pair = ClassicParcel(
    ...     [[1, 1, 2], [3, 1, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 2, 4), planar=True
    ... )
    >>> pair.advance(1.0)
    >>> pair.scheme, pair.contacts, pair.snapshot().velocity[:, 0].tolist()
    ('strips', 1, [-1.0, 1.0])
    """

    engine: ClassVar[str] = "classic"

    def __init__(
        self,
        position: ArrayLike,
        velocity: ArrayLike,
        *,
        scheme: Scheme | None = None,
        delta: float = 0.1,
        dt: float | None = None,
        epsilon: float = 0.001,
        closing_only: bool = True,
        **box: Unpack[Arrangement],
    ) -> None:
        if scheme is not None and scheme not in SCHEMES:
            raise RefusedError(f"scheme = {shown(scheme)} is none of the classic ones: give {', '.join(SCHEMES)}")
        self._wish = scheme
        self._delta = _positive(delta, "delta")
        self._dt = None if dt is None else _positive(dt, "dt")
        self._epsilon = _positive(epsilon, "epsilon")
        self._closing_only = bool(closing_only)
        super().__init__(position, velocity, **box)

    def _begin(self, position: Array, velocity: Array, rotational_energy: Array) -> None:
        self._scheme = self._choose()
        n = self._number
        x = position.T.copy()
        for axis in range(3):
            if self._periodic[axis]:
                side = float(self._sides[axis])
                x[axis] -= side * np.floor(x[axis] / side)
                x[axis][x[axis] >= side] = 0.0
        self._discs = Discs(
            position=x,
            velocity=velocity.T.copy(),
            mass=self._mass,
            radius=0.5 * self._diameter,
            partner=np.full(n, -1, np.int64),
            met=np.full(n, -2, np.int64),
        )
        self._score = Score(numerical_heat=np.zeros(1), count=np.zeros(3, np.int64))
        self._strips = self._cut()
        self._time_step = self._dt if self._dt is not None else self._delta * self._passage(velocity)
        self._renew()

    def _renew(self) -> None:
        inverse = [1.0 / side if turn else 0.0 for side, turn in zip(self._sides, self._periodic, strict=True)]
        self._frame = Frame(
            length=self._sides,
            inverse=np.array(inverse),
            gravity=self._gravity,
            time_step=self._time_step,
            planar=self._planar,
            contacts=not self.ideal,
        )

    def _march(self, steps: int) -> None:
        books = (self._frame, self._walls, self._tallies, self._score, self._step, steps)
        if self._scheme == "strips":
            march_strips(self._discs, self._strips, *books)
        elif self._scheme == "lookahead":
            march_lookahead(self._discs, self._epsilon, *books)
        else:
            march_spheres(self._discs, self._closing_only, *books)

    def _effort(self) -> int:
        n = self._number
        return n if self._scheme == "strips" else n + n * n // 16

    def snapshot(self) -> Snapshot:
        """Return all molecules as they are now; the box does not change."""
        discs = self._discs
        return Snapshot(self.time, discs.position.T.copy(), discs.velocity.T.copy(), np.zeros(self._number))

    def memory(self) -> int:
        """Return the memory of molecules and strips [bytes]."""
        arrays: list[Any] = [*self._discs, self._strips.order, self._strips.first, self._strips.strip]
        return sum(int(array.nbytes) for array in arrays)

    # ------------------------------------------------------------------ tallies that only these schemes have

    @property
    def scheme(self) -> Scheme:
        """Name of the scheme that moves the molecules."""
        return self._scheme

    @property
    def numerical_heat(self) -> float:
        """Energy that the scheme itself has made since the start [energy], by its rule for the fall and at the walls.

        It is neither heat of a wall nor work, but an error; without gravity there is none. A ledger that closes shows
        only that all energy is accounted for.
        """
        return float(self._score.numerical_heat[0])

    @property
    def pair_tests(self) -> int:
        """Number of pairs that have been tested since the start."""
        return int(self._score.count[0])

    @property
    def repeated_contacts(self) -> int:
        """Number of contacts one step after a contact of the same two, as far as each one's last partner tells."""
        return int(self._score.count[1])

    @property
    def parting_contacts(self) -> int:
        """Number of contacts of pairs that were already moving apart: false collisions."""
        return int(self._score.count[2])

    # ------------------------------------------------------------------ how steps are made

    def _choose(self) -> Scheme:
        """Return the scheme asked for, or the default for these molecules; refuse what the scheme cannot do."""
        if self._walls.law[5] == PISTON:
            raise RefusedError("the classic schemes have no piston, wall z_high: give that box to the exact engine")
        if self._rotates:
            raise RefusedError(
                "the classic schemes have no rotation: make the rotational degrees of freedom 0, or give that box to "
                "the exact engine"
            )
        alike = not self._number or all(np.ptp(a) == 0.0 for a in (self._mass, self._diameter))
        if self._wish is None:
            if not self._planar:
                return "spheres"
            return "strips" if alike else "lookahead"
        if self._wish != "spheres" and not self._planar:
            raise RefusedError(
                f"scheme = {shown(self._wish)} is for a plane gas: choose 'spheres', or make planar true"
            )
        if self._wish == "strips" and not alike:
            raise RefusedError("scheme = 'strips' is for equal discs: choose 'lookahead' for unequal ones")
        return self._wish

    def _cut(self) -> Strips:
        """Return the strips; none if the scheme needs none."""
        n = self._number
        across = 0
        if self._scheme == "strips" and n:
            across = strips_across(float(self._sides[0]), float(self._diameter[0]), n, self._periodic[0])
        return Strips(
            order=np.zeros(n, np.int64),
            first=np.zeros(across + 1, np.int64),
            strip=np.zeros(n, np.int64),
            number=across,
            per_length=across / float(self._sides[0]),
        )

    def _passage(self, velocity: Array) -> float:
        """Return the time in which a molecule moves by a diameter at its thermal speed [time].

        For molecules without size, or at rest, it is the natural time of the box: see `inputs.natural_time`.
        """
        fastest = float(self._thermal_speeds(velocity).max(initial=0.0))
        sizes = self._diameter[self._diameter > 0.0]
        passage = float(sizes.min()) / fastest if fastest > 0.0 and sizes.size else self._spread
        return passage if math.isfinite(passage) and passage > 0.0 else self._spread


def _positive(value: float, name: str) -> float:
    found = number(value, name, least=0.0)
    if not found > 0.0:
        raise RefusedError(f"{name} = {shown(value)} is impossible: give a number above 0")
    return found

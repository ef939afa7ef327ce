"""What may be changed by hand while time passes, and how the books still close."""

import math
from abc import abstractmethod

from atmosbox.engine.core.account import Account
from atmosbox.engine.core.inputs import number
from atmosbox.engine.core.refusal import RefusedError
from atmosbox.engine.core.walls import HEAT_BATH, PISTON, WALL_NAMES

__all__ = ["Adjustable"]


class Adjustable(Account):
    """A box whose piston, heat baths and gravity may be changed between two advances; `Parcel` is one.

    What was planned for the old walls or in the old field is planned anew, and what a change gives to the molecules
    is entered in the ledger. A box that is left unchanged gives the same bytes as one that cannot be changed.
    """

    _now: float

    @property
    @abstractmethod
    def ceiling(self) -> float:
        """Height of the ceiling now [length]."""

    @property
    @abstractmethod
    def piston_velocity(self) -> float:
        """Velocity of the ceiling [length/time]."""

    @abstractmethod
    def _piston_turned(self) -> None:
        """Take note that the piston moves at another velocity from now on."""

    @abstractmethod
    def _field_changes(self, gravity: float) -> None:
        """Set another gravity from now on, refused where the engine could not go on with it."""

    def _bath_changes(self, kT: float) -> None:
        """Take note that a wall has this temperature [energy] from now on, or refuse it."""

    def set_piston_velocity(self, velocity: float) -> None:
        """Let the piston move at another velocity [length/time] from now on.

        Raises
        ------
        RefusedError
            If there is no piston, or the velocity is not finite.
        """
        if self._walls.law[5] != PISTON:
            raise RefusedError("this box has no piston: make wall z_high a Piston")
        velocity = number(velocity, "velocity of the piston")
        self._walls.piston[:] = self.ceiling, velocity, self._now
        self._piston_turned()

    def set_wall_kT(self, kT: float, wall: int | None = None) -> None:
        """Keep a wall, or all that are heat baths, at another temperature from now on.

        A schedule that the wall had is forgotten. Molecules learn of it when they hit the wall, and the heat that
        it then gives is in the ledger as ever.

        Parameters
        ----------
        kT
            The temperature [energy].
        wall
            Which wall, in the order of `walls.WALL_NAMES`; all heat baths if none is named.

        Raises
        ------
        RefusedError
            If the temperature is not finite and above 0, the wall is no heat bath, or there is none at all; or if the
            molecules would become too fast for the step of an engine that marches.

        Examples
        --------
        >>> from atmosbox.engine import HeatBath, ParcelSet
        >>> box = ParcelSet([[1, 1, 1]], [[1, 0, 0]], length=(2, 2, 2), walls=(HeatBath(1.0),) * 6)
        >>> box.set_wall_kT(2.0, wall=4)
        >>> box.wall_kT().tolist()
        [1.0, 1.0, 1.0, 1.0, 2.0, 1.0]
        """
        kT = number(kT, "kT of a wall")
        if not kT > 0.0:
            raise RefusedError(f"kT of a wall = {kT} is not positive: give a number above 0")
        baths = [w for w, law in enumerate(self._walls.law) if law == HEAT_BATH]
        if wall is not None and wall not in baths:
            name = WALL_NAMES[wall] if 0 <= wall < len(WALL_NAMES) else wall
            raise RefusedError(f"wall {name} is no heat bath: make it a HeatBath")
        if not baths:
            raise RefusedError("no wall of this box has a temperature: make one a HeatBath")
        self._bath_changes(kT)
        for each in baths if wall is None else [wall]:
            first, last = self._walls.schedule[each], self._walls.schedule[each + 1]
            self._walls.schedule_kT[first:last] = kT

    def set_gravity(self, gravity: float) -> None:
        """Let gravity be another from now on.

        No molecule moves in that moment, but all are higher up or lower down in energy; the ledger has it as
        `gravity_work`.

        Parameters
        ----------
        gravity
            Downward acceleration [length/time^2].

        Raises
        ------
        RefusedError
            If gravity is negative or not finite, or the box cannot have any: one that is periodic along z, or holds
            a liquid; or if molecules would fall too far in a step.

        Examples
        --------
        A molecule one unit above the floor has one unit of energy more when gravity is doubled:

        >>> from atmosbox.engine import ParcelSet
        >>> box = ParcelSet([[2, 2, 1]], [[0, 0, 0]], length=(4, 4, 4), gravity=1.0)
        >>> box.set_gravity(2.0)
        >>> box.gravity_work, box.energy()[2], box.ledger()
        (1.0, 2.0, 0.0)
        """
        gravity = number(gravity, "gravity", least=0.0)
        if gravity == self._gravity:
            return
        if gravity > 0.0 and self._periodic[2]:
            raise RefusedError("a box that is periodic along z cannot have gravity: molecules would fall for ever")
        before = self.energy()[2]
        self._field_changes(gravity)
        self._gravity_work += math.fsum((self.energy()[2], -before))

"""Changes by hand during a run: the piston, heat baths, gravity; the energy ledger still closes."""

import math
from abc import abstractmethod

from atmosbox.engine.core.account import Account
from atmosbox.engine.core.refusal import LARGEST, RefusedError, number, shown
from atmosbox.engine.core.walls import HEAT_BATH, PISTON, SPECULAR, WALL_NAMES, HeatBath, Specular, new_walls


class Adjustable(Account):
    """A box whose piston, heat baths and gravity may be changed between two advances; `Parcel` is one.

    Events that were predicted for the old walls or the old gravity are predicted again, and the energy that a change
    gives to the molecules is entered in the ledger. A box that is not changed gives the same bytes as one that cannot
    be changed.
    """

    @abstractmethod
    def _piston_turned(self) -> None:
        """Update what depends on the velocity of the piston, which has just changed."""

    @abstractmethod
    def _field_changes(self, gravity: float) -> None:
        """Set another gravity from now on, or refuse it if the engine could not go on with it."""

    def _bath_changes(self, kT: float) -> None:
        """Update what depends on the temperature of a wall [energy], which is about to change, or refuse it."""

    def set_piston_velocity(self, velocity: float) -> None:
        """Set the velocity of the piston [length/time] from now on.

        Raises
        ------
        RefusedError
            If there is no piston, or the velocity is not finite.
        """
        if self._walls.law[5] != PISTON:
            raise RefusedError("this box has no piston: make wall z_high a Piston")
        velocity = number(velocity, "velocity of the piston", least=-LARGEST, most=LARGEST)
        self._walls.piston[:] = self.ceiling, velocity, self._now
        self._piston_turned()

    def set_wall_kT(self, kT: float, wall: int | None = None) -> None:
        """Set the temperature of a wall, or of all heat baths, from now on.

        It replaces the wall's schedule. Molecules are affected when they hit the wall, and the heat that it then
        gives is entered in the ledger as always.

        Parameters
        ----------
        kT
            The temperature [energy].
        wall
            Number of the wall, in the order of `walls.WALL_NAMES`; all heat baths if none is given.

        Raises
        ------
        RefusedError
            If the temperature is not finite and above 0, the wall is not a heat bath, or there is none at all; or if
            the molecules would become too fast for the time step of a stepped engine.

        Examples
        --------
        >>> from atmosbox.engine import HeatBath, ParcelSet
        >>> pair = [[1, 1, 1], [3, 3, 3]], [[1, 0, 0], [0, 1, 0]]
        >>> box = ParcelSet(*pair, length=(4, 4, 4), walls=(HeatBath(1.0),) * 6)
        >>> box.set_wall_kT(2.0, wall=4)
        >>> box.wall_kT().tolist()
        [1.0, 1.0, 1.0, 1.0, 2.0, 1.0]
        """
        kT = number(kT, "kT of a wall", above=0.0, most=LARGEST)
        baths = [w for w, law in enumerate(self._walls.law) if law == HEAT_BATH]
        if wall is not None and wall not in baths:
            name = WALL_NAMES[wall] if 0 <= wall < len(WALL_NAMES) else wall
            raise RefusedError(f"wall {name} is not a heat bath: make it a HeatBath")
        if not baths:
            raise RefusedError("no wall of this box has a temperature: make one a HeatBath")
        self._bath_changes(kT)
        for each in baths if wall is None else [wall]:
            first, last = self._walls.schedule[each], self._walls.schedule[each + 1]
            self._walls.schedule_kT[first:last] = kT

    def set_wall(self, wall: int, law: Specular | HeatBath) -> None:
        """Turn a smooth wall into a heat bath, or a heat bath into a smooth wall, from now on.

        Parameters
        ----------
        wall
            Number of the wall, in the order of `walls.WALL_NAMES`.
        law
            The new law: `Specular`, or a `HeatBath` of one temperature.

        Raises
        ------
        RefusedError
            If the wall is a piston, a pool or periodic, if the law is neither of the two or its temperature changes
            with time; or if the molecules would become too fast for the time step of a stepped engine.

        Examples
        --------
        >>> from atmosbox.engine import HeatBath, ParcelSet, Specular
        >>> box = ParcelSet([[1, 1, 1], [3, 3, 3]], [[1, 0, 0], [0, 1, 0]], length=(4, 4, 4))
        >>> box.set_wall(1, HeatBath(2.0))
        >>> box.wall_kT().tolist()
        [nan, 2.0, nan, nan, nan, nan]
        >>> box.set_wall(1, Specular())
        >>> box.wall_kT().tolist()
        [nan, nan, nan, nan, nan, nan]
        """
        name = WALL_NAMES[wall] if 0 <= wall < len(WALL_NAMES) else wall
        if name == wall or self._walls.law[wall] not in (SPECULAR, HEAT_BATH):
            raise RefusedError(f"wall {name} is neither smooth nor a heat bath: choose one that is")
        if not isinstance(law, Specular | HeatBath):
            raise RefusedError(f"wall {name} = {shown(law)}: give Specular or HeatBath")
        new = new_walls(tuple(law if each == wall else Specular() for each in range(6)), self.ceiling)
        temperatures = new.schedule_kT[new.schedule[wall] : new.schedule[wall + 1]]
        if len(temperatures) > 1:
            raise RefusedError(f"the temperature of wall {name} changes with time: give one temperature")
        if new.law[wall] == HEAT_BATH:
            self._bath_changes(float(temperatures[0]))
        self._walls.schedule_kT[self._walls.schedule[wall] : self._walls.schedule[wall + 1]] = temperatures[0]
        self._walls.law[wall] = new.law[wall]
        self._walls.accommodation[wall] = new.accommodation[wall]

    def set_gravity(self, gravity: float) -> None:
        """Set the gravity from now on.

        No molecule moves at that moment, but the potential energy of all changes; the ledger holds the change as
        `gravity_work`.

        Parameters
        ----------
        gravity
            Downward acceleration [length/time^2].

        Raises
        ------
        RefusedError
            If gravity is negative or not finite, or the box cannot have any: one that is periodic along z, or holds
            a liquid; or if molecules would fall too far in a time step.

        Examples
        --------
        The potential energy of a molecule one unit above the floor rises by one unit when gravity is doubled:

        >>> from atmosbox.engine import ParcelSet, Periodic, Specular
        >>> column = {"length": (6, 6, 6), "walls": (Periodic(),) * 4 + (Specular(),) * 2}
        >>> box = ParcelSet([[2, 2, 1], [4, 4, 1]], [[0, 0, 0]] * 2, gravity=1.0, **column)
        >>> box.set_gravity(2.0)
        >>> box.gravity_work, box.energy()[2], box.ledger()
        (2.0, 4.0, 0.0)
        """
        gravity = number(gravity, "gravity", least=0.0, most=LARGEST)
        if gravity == self._gravity:
            return
        if gravity > 0.0 and self._periodic[2]:
            raise RefusedError("a box that is periodic along z cannot have gravity: molecules would fall for ever")
        before = self.energy()[2]
        self._field_changes(gravity)
        self._gravity_work += math.fsum((self.energy()[2], -before))

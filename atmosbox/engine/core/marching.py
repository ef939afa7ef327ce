"""A parcel that is advanced in equal time steps: the common part of the approximate engines."""

import math
from abc import abstractmethod
from collections.abc import Callable
from typing import Any

from atmosbox.engine.core.parcel import Parcel
from atmosbox.engine.core.refusal import RefusedError, number
from atmosbox.engine.core.walls import HEAT_BATH

_WORK = 400_000
_SLACK = 1e-9
_HOTTER = 16.0


class MarchingParcel(Parcel):
    """Molecules in a box, advanced in equal time steps.

    Steps end at the fixed times k * `time_step`, and a measurement sees the state after the last complete step.
    So the result does not depend on the pieces into which a run is cut.
    """

    _time_step = math.nan
    _step = 0
    _usual_kT = 0.0

    @property
    def time_step(self) -> float:
        """Length of a step [time]."""
        return self._time_step

    @property
    def steps(self) -> int:
        """Number of steps since the start."""
        return self._step

    def divide(self, interval: float) -> None:
        """Shorten the time step so that a whole number of steps makes an interval [time]; a run must not have begun."""
        interval = number(interval, "interval", above=0.0)
        if self._step:
            raise RefusedError("a time step is chosen before the first step")
        if self._effort():
            self._time_step = interval / math.ceil(interval / self._time_step * (1.0 - _SLACK))
            self._renew()

    def advance(self, until: float, watch: Callable[[float], None] | None = None) -> None:
        """Advance to ``until`` [time since the start], as far as whole steps go: see `Parcel.advance`."""
        until = number(until, "until")
        if until < self.time * (1.0 - _SLACK):
            raise RefusedError(f"until = {until} lies before now, t = {self.time}: give a later time")
        last = math.floor(until / self._time_step * (1.0 + 1e-13) + _SLACK)
        if not self._step and not last:
            self._march(0)  # compiles the kernels, so that a run's first step takes no longer than the others
        while self._step < last:
            steps = min(last - self._step, max(1, _WORK // max(self._effort(), 1)))
            turn = self._next_turn()
            steps = min(steps, turn - self._step)
            self._march(steps)
            self._step += steps
            self._now = self._step * self._time_step
            if self._driver is not None and self._step >= turn:
                self._turns[0] = math.floor(self._now / self._driver.interval + _SLACK)
                self._drive()
            if watch is not None:
                watch(self.time)

    def _next_turn(self) -> Any:
        """Return the number of the step before which the driver is called next."""
        if self._driver is None:
            return math.inf
        due = (int(self._turns[0]) + 1) * self._driver.interval
        return max(self._step + 1, math.ceil(due / self._time_step - _SLACK))

    def _effort(self) -> int:
        """Return the work of a step, as a number of molecules moved; it sets how often ``watch`` is called."""
        return self._number

    @abstractmethod
    def _march(self, steps: int) -> None:
        """Advance by a number of steps, with the piston at constant velocity."""

    @abstractmethod
    def _renew(self) -> None:
        """Update what depends on the time step or gravity: the step changed before the first one, or gravity did."""

    def _piston_turned(self) -> None:
        """Do nothing: every step reads the velocity of the piston."""

    def _field_changes(self, gravity: float) -> None:
        mass = float(self._mass.sum()) if self._number else 0.0
        speed = math.sqrt(2.0 * self.energy()[0] / (3.0 * mass)) if mass else math.inf
        if gravity * self._time_step > speed:
            raise RefusedError(
                f"gravity = {gravity:.6g} would reverse the motion of molecules within a step of "
                f"{self._time_step:.3g}: give {0.5 * speed / self._time_step:.3g} or less, or start the run with it"
            )
        self._gravity = gravity
        self._renew()

    def _bath_changes(self, kT: float) -> None:
        if kT > _HOTTER * self._usual_kT > 0.0:
            raise RefusedError(
                f"kT of a wall = {kT:.6g} is too hot for the step, which was chosen for {self._usual_kT:.6g}: give "
                f"{_HOTTER * self._usual_kT:.6g} or less, or start the run with it"
            )

    def _warmest(self, kT: float) -> float:
        """Return the highest of a temperature [energy] and the temperatures that the walls ever have."""
        for wall, law in enumerate(self._walls.law):
            if law == HEAT_BATH:
                first, last = self._walls.schedule[wall], self._walls.schedule[wall + 1]
                kT = max(kT, float(self._walls.schedule_kT[first:last].max()))
        self._usual_kT = kT
        return kT

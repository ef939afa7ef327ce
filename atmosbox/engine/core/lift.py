r"""A piston that follows a given pressure, as a parcel follows that of its environment on its planned ascent.

At the start of each interval the ceiling is given the velocity

.. math:: u = \frac{h - \sigma}{\Gamma} \left[ S + \frac{\ln(p / p_{env})}{20 \tau} \right],
          \quad S = -d \ln p_{env} / dt,

The first term is the expansion of an adiabat, the second closes the gap of pressure that is left. During the interval
the velocity is constant. Centres of molecules reach only the height h - sigma, so V is the volume open to centres.
At constant entropy hard spheres cool by :math:`d \ln T = -(2/f) Z\, d \ln V`, so that their pressure
p = n kT Z, with Z = 1 + b n, falls by

.. math:: \Gamma = -\frac{d \ln p}{d \ln V} = 1 + \frac{2}{f} Z + \frac{Z - 1}{Z},

which for molecules without size is the adiabatic index gamma = 1 + 2/f. If gamma were used instead of Gamma, ln p would
settle :math:`20 \tau S (1 - \gamma / \Gamma)` too low, where the second term makes up for the error. With Gamma a
finite-rate error remains: ln p is too high by what the finite speed of the parcel adds to it within 20 mean free times.
"""

import math
from collections import namedtuple
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.elementary import expm1, log, log_of_normal
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.parcel import Parcel
from atmosbox.engine.core.refusal import RefusedError, number
from atmosbox.engine.core.schedule import interpolate


class Course:
    """The moment of its plan that a parcel has reached, as a function of time.

    A plan gives the environment at each moment from 0 to its end. By default a parcel follows the plan: at time t it
    is at the moment t. When led by hand it goes to another moment, forwards or backwards, always at the pace of the
    plan, and stays there. So it never moves faster than planned.

    Parameters
    ----------
    end
        The last moment of the plan [time].

    Examples
    --------
    >>> course = Course(10.0)
    >>> course.moment(3.0)
    3.0
    >>> course.lead(4.0, towards=1.0)
    >>> course.moment(4.0), course.moment(5.0), course.moment(9.0)
    (4.0, 3.0, 1.0)
    """

    def __init__(self, end: float = math.inf) -> None:
        self.end = end
        self._time = [0.0]
        self._moment = [0.0]
        self._changed = 0.0

    @property
    def led(self) -> bool:
        """Whether `lead` has been called."""
        return len(self._time) > 1

    def moment(self, time: float) -> float:
        """Return the moment of the plan [time] at a time [time]."""
        if not self.led:
            return min(time, self.end)
        return float(interpolate(time, np.array(self._time), np.array(self._moment)))

    def corners(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the times and moments between which the moment is linear in time; it is constant after the last."""
        if self.led or not 0.0 < self.end < math.inf:
            return np.array(self._time), np.array(self._moment)
        return np.array([0.0, self.end]), np.array([0.0, self.end])

    def lead(self, time: float, towards: float) -> None:
        """Go to another moment of the plan, and stay there.

        Parameters
        ----------
        time
            The time now [time]; earlier parts of the course stay as they were.
        towards
            The moment to go to [time].

        Raises
        ------
        RefusedError
            If a number is not finite, the moment is not in the plan, or the time lies before that of the last call.
        """
        time, towards = number(time, "time"), number(towards, "the moment", least=0.0, most=self.end)
        if time < self._changed:
            raise RefusedError(f"time = {time} lies before the last change, at {self._changed}: give a later time")
        here = self.moment(time)
        if not self.led and time > self.end:  # it reached the end of the plan earlier
            self._time.append(self.end)
            self._moment.append(self.end)
        while self._time[-1] > time:
            self._time.pop()
            self._moment.pop()
        self._changed = time
        for when, where in ((time, here), (time + math.fabs(towards - here), towards)):
            if when > self._time[-1]:
                self._time.append(when)
                self._moment.append(where)


_EXCESS, _VIRIAL = range(2)


class Lift(namedtuple("Lift", "time log_pressure course_time course_moment measured interval relaxation memory")):
    """A pressure to follow, in the form that the kernels take.

    ``time``, ``log_pressure : (corner,)``: the schedule [time; logarithm of energy/length^3]; ``course_time``,
    ``course_moment : (turn,)``: the moment of the schedule [time] that the parcel reaches at each time [time];
    ``measured : (2,)``: the running average of (Z - 1) / n [length^3] and the virial at the last change of velocity
    [energy]; ``interval``: how long the piston keeps a velocity, ``relaxation``: the relaxation time of a gap of
    pressure, ``memory``: the averaging time of (Z - 1) / n [time].
    """


class Gauges(namedtuple("Gauges", "time number freedom dimensions energy virial density open_height")):
    """The state of the gas at one time, as the law of a lift needs it.

    The time [time]; the number of molecules, the degrees of freedom of each and the number of dimensions; their energy
    [energy] and the virial of their contacts since the start [energy]; the density in the volume that centres can
    reach [1/length^3] and the height of that volume [length].
    """


class FollowPressure:
    """A driver that moves the ceiling so that the pressure follows a schedule.

    The pressure is that of the virial theorem, p = n kT + w / 3 V = n kT Z. Here kT comes from the energy of
    translation and rotation in the ledger, and so has no noise at fixed volume; n is the density in the volume open
    to centres; and w, the virial of contacts per unit time, is measured: (Z - 1) / n is averaged over a hundred mean
    free times. With w the adiabat is T ~ p^(2/7) to second order in the packing fraction; without it, not even to
    first order.

    Parameters
    ----------
    time : (corner,)
        Times [time], increasing.
    pressure : (corner,)
        The pressure to follow at these times, > 0 [energy/length^3]; its logarithm is linear between them.
    mean_free_time
        Mean free time tau of the gas at the start [time].
    interval
        How long the piston keeps one velocity, in units of tau.
    relaxation
        Relaxation time of a gap of pressure, in units of tau.
    excess
        First guess of (Z - 1) / n [length^3]; measurements replace it.

    Attributes
    ----------
    course
        The `Course` along the schedule: its moment is the time, unless it is led by hand.

    Raises
    ------
    RefusedError
        If times do not increase, or a pressure or the mean free time is not finite and above 0.

    Examples
    --------
    The piston keeps each velocity for a quarter of a mean free time:

    >>> FollowPressure([0.0, 10.0], [1.0, 0.5], mean_free_time=2.0).interval
    0.5
    """

    def __init__(
        self,
        time: Sequence[float],
        pressure: Sequence[float],
        *,
        mean_free_time: float,
        interval: float = 0.25,
        relaxation: float = 20.0,
        excess: float = 0.0,
    ) -> None:
        self._time = np.asarray(time, np.float64)
        values = np.asarray(pressure, np.float64)
        if self._time.shape != values.shape or self._time.ndim != 1 or self._time.size < 1:
            raise RefusedError("give as many times as pressures, at least one")
        if not (np.diff(self._time) > 0.0).all():
            raise RefusedError("the times of a pressure schedule must increase")
        if not (np.isfinite(values).all() and (values > 0.0).all()):
            raise RefusedError("every pressure of a schedule must be finite and above 0")
        mean_free_time = number(mean_free_time, "mean_free_time", above=0.0)
        self._log = np.asarray(log_of_normal(values))
        self._relaxation = relaxation * mean_free_time
        self.interval = interval * mean_free_time
        self._memory = 100.0 * mean_free_time
        self._measured = np.array([excess, 0.0])
        self.course = Course(float(self._time[-1]))

    def pressure(self, parcel: Parcel) -> float:
        """Return the pressure of the parcel [energy/length^3]."""
        density = parcel.open_density
        kT = 2.0 * parcel.internal_energy() / (parcel.degrees_of_freedom * max(parcel.number, 1))
        return density * kT * (1.0 + float(self._measured[_EXCESS]) * density)

    def velocity(self, parcel: Parcel) -> float:
        """Return the velocity [length/time] of the ceiling for the next interval."""
        gauges = Gauges(
            time=parcel.time,
            number=parcel.number,
            freedom=parcel.degrees_of_freedom,
            dimensions=2.0 if parcel.planar else 3.0,
            energy=parcel.internal_energy(),
            virial=float(parcel.virial.sum()),
            density=parcel.open_density,
            open_height=parcel.ceiling - (float(parcel.diameter.mean()) if parcel.number else 0.0),
        )
        return float(ceiling_velocity(gauges, self.law()))

    def law(self) -> Lift:
        """Return the law in the form that kernels take which move the piston themselves."""
        times, moments = self.course.corners()
        return Lift(
            self._time, self._log, times, moments, self._measured, self.interval, self._relaxation, self._memory
        )


@kernel
def _log_pressure(time, lift):
    """Return the logarithm of the pressure to follow at a time [time]."""
    moment = interpolate(time, lift.course_time, lift.course_moment)
    return interpolate(moment, lift.time, lift.log_pressure)


@kernel(entry=True)
def ceiling_velocity(at, lift):
    """Return the velocity [length/time] of the ceiling for the next interval; the module's docstring has the formula.

    ``at`` are the `Gauges` of the gas now. The average of (Z - 1) / n, which hardly changes while n falls, is updated.
    """
    kT = 2.0 * at.energy / (at.freedom * max(at.number, 1))
    ideal = at.density * kT
    if at.time > 0.0 and ideal > 0.0:
        rate = (at.virial - lift.measured[_VIRIAL]) / lift.interval
        excess = rate / (at.dimensions * at.number * ideal)
        lift.measured[_EXCESS] += lift.interval / lift.memory * (excess - lift.measured[_EXCESS])
    lift.measured[_VIRIAL] = at.virial
    factor = 1.0 + lift.measured[_EXCESS] * at.density
    wanted = _log_pressure(at.time, lift)
    fall = wanted - _log_pressure(at.time + lift.interval, lift)
    fall += lift.interval / lift.relaxation * (log(ideal * factor) - wanted)
    return at.open_height * expm1(fall / stiffness(factor, at.freedom)) / lift.interval


@kernel
def stiffness(compressibility_factor: float, freedom: float) -> float:
    """Return -d ln p / d ln V without exchange of heat, V the open volume: Gamma in the module's docstring [1].

    For points it is the adiabatic index; spheres with Z = 1.1 are stiffer:

    >>> round(stiffness(1.0, 5), 6), round(stiffness(1.1, 5), 6)
    (1.4, 1.530909)
    """
    return 1.0 + 2.0 / freedom * compressibility_factor + 1.0 - 1.0 / compressibility_factor

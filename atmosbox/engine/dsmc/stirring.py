r"""Stirring: two parcels of finite size change places, one up and one down, each with the work of its piston.

The molecules are sorted by height. Those of a parcel are next to each other in that order, over the
whole width of the box; an exchange takes two parcels of equally many molecules, one higher by a random *lift* d::

    order of heights   0 . . . . a ooooooo a+n . . . . a+d xxxxxxx a+d+n . . . . N
    after it           0 . . . . a xxxxxxx a+n . . . . a+d ooooooo a+d+n . . . . N

Each molecule takes the height of its counterpart in the other parcel. So every layer has as many molecules as before,
each at a height where one was: neither the density nor the potential energy changes, and no gap makes a sound wave.

The exchange changes the energy of the parcels. The pressure at a place in the order is the weight of all that is above,
:math:`p(r) = p_0 - r\,m g / A`. Air that goes slowly from p to p' expands and does work on its environment,
or is compressed, and by Poisson's equation its temperature is multiplied by

.. math:: s = (p' / p)^{R / c_p}, \qquad R / c_p = 2 / (f + 2).

So every energy of the disordered motion is multiplied by s, in all f degrees of freedom, rotation included: velocities
relative to that of the parcel by :math:`\sqrt s`. The momentum of each parcel stays the same. The energy that is
gained in total is the work of the stirring, and is entered in the ledger.

Where the air is on an adiabat, the air that arrives is as warm as the air that was there, and stirring changes nothing;
elsewhere it mixes the potential temperature. The pressure :math:`p_0` below all molecules follows from the virial
theorem: it is measured, and no temperature profile is put in.

For comparison, single molecules can change places: they do not expand, so they do no work, and
keep their energies. Then stirring mixes the temperature, as conduction does.

References
----------
Poisson, S. D. (1823), Ann. Chim. Phys. 23, 337; Prandtl, L. (1925), doi:10.1002/zamm.19250050212 (mixing length).
"""

from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.elementary import exp, log
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import uniform

__all__ = ["Stirring", "StirringWork", "stir"]

_LEAST = 1e-3  # least pressure over that at the floor: it may be lower before the air has fallen, but is taken as this


class Stirring(NamedTuple):
    """The parameters of the stirring of a column.

    ``parcel``: molecules in a parcel; ``least``, ``most``: limits of the number of places in the order of heights by
    which it rises or sinks, not below the number of its molecules; ``rate``: exchanges per time [1/time];
    ``interval``: time from one set of exchanges to the next, as nearly as whole steps allow [time]; ``works``: whether
    parcels change places, which do work, or as many single molecules, which do none.
    """

    parcel: int
    least: int
    most: int
    rate: float
    interval: float
    works: bool = True


class StirringWork(NamedTuple):
    """What stirring has done, and its working memory.

    ``counted : (2,)``: work done on the molecules [energy], and number of exchanges. ``factor : (molecule,)``: factor
    of the velocities of air that comes from the floor to each place in the order of heights.
    """

    counted: Any
    factor: Any


@kernel
def _pressure_at_floor(order, columns, gas, column):
    r"""Return the pressure below all molecules, from the virial theorem of a column at rest [energy/length^3].

    The integral of the pressure over the volume is the sum of kT. The pressure below the weight of the molecules gives
    :math:`p_0 V = N k T + \sum m g (z_{top} - z)`.
    """
    gravity, area, low, high = column
    total = 0.0
    for i in range(order.size):
        p = order[i]
        vx, vy, vz = columns.vx[p], columns.vy[p], columns.vz[p]
        total += (vx * vx + vy * vy + vz * vz) / 3.0 + gravity * (high - columns.z[p])
    return gas.mass * total / (area * (high - low))


@kernel
def _mean_velocity(first, number, order, columns):
    """Return the mean velocity of a parcel [length/time]."""
    ux = uy = uz = 0.0
    for i in range(first, first + number):
        p = order[i]
        ux, uy, uz = ux + columns.vx[p], uy + columns.vy[p], uz + columns.vz[p]
    return ux / number, uy / number, uz / number


@kernel
def _scale(first, number, lift, mean, order, columns, gas, factor):
    """Multiply the energies of a parcel as it moves to another pressure; return the energy gained [energy].

    It moves from a place ``first`` to one that is higher by ``lift``; ``factor`` is described at `StirringWork`.
    """
    mass, rotates = gas.mass, gas.rotation > 0.0
    ux, uy, uz = mean
    sx = sy = sz = gain = 0.0
    for i in range(number):
        p = order[first + i]
        root = factor[first + i + lift] / factor[first + i]
        vx, vy, vz = columns.vx[p], columns.vy[p], columns.vz[p]
        gain -= 0.5 * mass * (vx * vx + vy * vy + vz * vz)
        vx, vy, vz = root * (vx - ux), root * (vy - uy), root * (vz - uz)
        sx, sy, sz = sx + vx, sy + vy, sz + vz
        columns.vx[p], columns.vy[p], columns.vz[p] = vx, vy, vz
        if rotates:
            gain += (root * root - 1.0) * columns.spin[p]
            columns.spin[p] *= root * root
    # molecules at rest relative to the parcel stay so, and the parcel keeps its mean velocity
    sx, sy, sz = ux - sx / number, uy - sy / number, uz - sz / number
    for i in range(first, first + number):
        p = order[i]
        vx, vy, vz = columns.vx[p] + sx, columns.vy[p] + sy, columns.vz[p] + sz
        columns.vx[p], columns.vy[p], columns.vz[p] = vx, vy, vz
        gain += 0.5 * mass * (vx * vx + vy * vy + vz * vz)
    return gain


@kernel
def _swap(i, j, order, z):
    """Exchange the molecules at two places in the order of heights."""
    p, q = order[i], order[j]
    z[p], z[q] = z[q], z[p]
    order[i], order[j] = q, p


@kernel(entry=True)
def stir(number, stirring, order, columns, gas, column, state, work):
    """Make a number of exchanges at random places.

    Parameters
    ----------
    number
        Number of exchanges.
    stirring
        The `Stirring`.
    order : (molecule,)
        Slots of the molecules in the order of heights; it is changed.
    columns, gas
        The molecules, and their common properties.
    column
        Acceleration of gravity [length/time^2], area of the column [length^2], height of its lower and upper end.
    state : (1,)
        State of the random numbers; it is advanced.
    work
        The `StirringWork`; its counts are increased.
    """
    n, factor = stirring.parcel, work.factor
    z = columns.z
    if number and stirring.works:
        # from the floor up the pressure falls by the weight of the air below
        pressure = _pressure_at_floor(order, columns, gas, column)
        fall = gas.mass * column[0] / column[1]
        power = 1.0 / (5.0 + gas.rotation)  # R / c_p for energies, half of it for velocities
        for i in range(order.size):
            factor[i] = exp(power * log(max(1.0 - fall * (i + 0.5) / pressure, _LEAST)))
    for _ in range(number):
        lift = stirring.least + np.int64(uniform(state) * (stirring.most - stirring.least + 1))
        places = order.size - n - lift + 1
        first = np.int64(uniform(state) * places)
        if stirring.works:
            above = first + lift
            lower, upper = _mean_velocity(first, n, order, columns), _mean_velocity(above, n, order, columns)
            work.counted[0] += _scale(first, n, lift, lower, order, columns, gas, factor)
            work.counted[0] += _scale(above, n, -lift, upper, order, columns, gas, factor)
            for i in range(first, first + n):
                _swap(i, i + lift, order, z)
        else:
            for i in range(n):
                one = first + i
                _swap(one, one + lift, order, z)
                first = np.int64(uniform(state) * places)
        work.counted[1] += 1.0

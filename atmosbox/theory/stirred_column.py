r"""A stirred column: how its temperature falls with height, from stirring, heat conduction and a warm floor.

Parcels at the pressures p and p' change places, and Poisson's law multiplies their temperatures by
:math:`(p'/p)^{R/c_p}`. So the potential temperature :math:`\theta = T\,(p_0/p)^{R/c_p}` is mixed. Let r be the share of
the molecules that are below. Where elements of the air climb by a lift :math:`\ell` with the frequency
:math:`u_\ell(r)`, the heat that stays there balances the heat that molecules conduct,

.. math:: \tfrac{f}{2} N k\,\Pi(r) \sum_\ell \bigl\{u_\ell(r)[\theta(r+\ell) - \theta(r)]
          + u_\ell(r-\ell)[\theta(r-\ell) - \theta(r)]\bigr\} = \frac{dq}{dr}, \qquad q = -\kappa \frac{dT}{dz},

with :math:`\Pi = (p/p_0)^{R/c_p}` and hydrostatic pressure. For a short lift the left side is that of an eddy
diffusivity; it is solved as it is, for a lift of any length. No heat passes the ceiling, and at the floor the
temperature has a jump, as in a gas beside any wall. If single molecules change places, :math:`\theta` is replaced by T.

All of this is derived from Fourier's law, hydrostatics and the rates of the exchanges. The conductivity is that of
Chapman and Enskog for spheres, times 5/4 if they rotate and divide their energy evenly in every collision; that factor
is the first approximation with one term for each kind of energy.

References
----------
Chapman, S., Cowling, T. G. (1970), The Mathematical Theory of Non-uniform Gases, 10.21 and 11.8.
Sone, Y. (2007), Molecular Gas Dynamics, 3.1.4 (the jump of the temperature at a wall).
"""

import functools
import math
from typing import NamedTuple

import numpy as np

from atmosbox.theory._array import FloatArray, require_not_negative, require_positive

__all__ = ["StirredColumn", "stirred_column", "thin_gas_conductivity"]

_NODES = 120
_JUMP = 2.127
"""Jump of the temperature at a wall that molecules leave with its temperature, in mean free paths [Sone]."""
_ROTATING = 1.25


class StirredColumn(NamedTuple):
    """Steady state of a column that is stirred for a long time.

    ``height``, ``temperature``, ``pressure : (node,)`` of elements with equal numbers of molecules [length, energy,
    energy/length^3]; ``work`` that the stirrer does on each molecule, and that leaves through the floor as heat
    [energy/time]; ``memory``, the time in which a surplus of energy decays [time].
    """

    height: FloatArray
    temperature: FloatArray
    pressure: FloatArray
    work: float
    memory: float


def thin_gas_conductivity(kT: float, mass: float, diameter: float, freedom: int = 3) -> float:
    r"""Return the heat conductivity of a thin gas of spheres over Boltzmann's constant [1/length/time].

    :math:`1.0252 \cdot \tfrac{75}{64} \sqrt{kT/\pi m} / \sigma^2`, and 5/4 of it with two degrees of freedom
    of rotation.

    Parameters
    ----------
    kT
        Temperature [energy].
    mass
        Mass of a molecule [mass].
    diameter
        Diameter of a molecule [length].
    freedom
        Degrees of freedom of a molecule, 3 or 5.

    Examples
    --------
    >>> round(thin_gas_conductivity(1.0, 1.0, 1.0), 6)
    0.677833
    """
    spheres = 1.025218 * 75.0 / 64.0 * math.sqrt(kT / (math.pi * mass)) / diameter**2
    return spheres * (_ROTATING if freedom > 3 else 1.0)


@functools.lru_cache(maxsize=16)
def stirred_column(
    molecules_per_area: float,
    bottom: float,
    top: float,
    kT: float,
    gravity: float,
    diameter: float,
    *,
    freedom: int,
    parcel: float,
    lifts: tuple[float, float],
    rate: float,
    works: bool = True,
    mass: float = 1.0,
) -> StirredColumn:
    """Return the profile of a thin gas that is stirred above a warm floor and below a smooth ceiling.

    Parameters
    ----------
    molecules_per_area
        Number of molecules over a unit of floor [length^-2].
    bottom, top
        Lowest and highest position of a molecule's centre [length].
    kT
        Temperature of the floor [energy].
    gravity
        Acceleration of gravity [length/time^2].
    diameter
        Diameter of a molecule, which only its collisions use [length].
    freedom
        Degrees of freedom of a molecule, 3 or 5.
    parcel
        Share of all molecules that are in a parcel.
    lifts
        Least and greatest lift of a parcel, as shares of all molecules.
    rate
        Number of exchanges per unit of time [1/time].
    works
        Whether parcels that do work change places, or single molecules.
    mass
        Mass of a molecule [mass].

    Returns
    -------
    StirredColumn
        The profile.

    Raises
    ------
    ValueError
        If a number is impossible, or the air would be at absolute zero below the ceiling.

    Examples
    --------
    Stirred fast, a gas of spheres cools by 2/5 of the floor's temperature in each scale height:

    >>> fast = stirred_column(
    ...     1000.0, 0.0, 1.0, 1.0, 1.0, 0.1, freedom=3, parcel=0.05, lifts=(0.15, 0.35), rate=5000.0
    ... )
    >>> inner = slice(12, -12)
    >>> round(float(np.polyfit(fast.height[inner], fast.temperature[inner], 1)[0]), 2)
    -0.4
    """
    require_positive(molecules_per_area=molecules_per_area, kT=kT, mass=mass, diameter=diameter, parcel=parcel)
    require_not_negative(gravity=gravity, rate=rate, bottom=bottom)
    if not top > bottom or not parcel <= lifts[0] <= lifts[1] <= 1.0 - parcel:
        raise ValueError("the ceiling must be above the floor, and a parcel must rise by its own size at least.")
    n = _NODES
    share = (np.arange(n) + 0.5) / n
    climbs = np.zeros((n, n))  # rate at which an element climbs from one place to another
    steps = range(round(lifts[0] * n), round(lifts[1] * n) + 1)
    for step in steps:
        room = 1.0 - step / n - parcel
        covered = np.clip(np.minimum(share, room) - np.maximum(share - parcel, 0.0), 0.0, None)
        climbs[np.arange(n - step), np.arange(step, n)] = rate / len(steps) * covered[: n - step] / room
    climbs += climbs.T
    weight = mass * gravity * molecules_per_area
    power = 2.0 / (freedom + 2.0)
    each = molecules_per_area / n
    path = 1.0 / (math.sqrt(2.0) * math.pi * diameter**2)
    here, above = np.arange(n - 1), np.arange(1, n)
    temperature = np.full(n, kT)
    topmost = molecules_per_area * kT / (top - bottom)
    for _ in range(200):
        topmost = _pressure_at_ceiling(topmost, weight * (1.0 - share), each * temperature, top - bottom)
        pressure = topmost + weight * (1.0 - share)
        exner = (pressure / (topmost + weight)) ** (power if works else 0.0)
        stirred = climbs * np.divide.outer(exner, exner) - np.diag(climbs.sum(axis=1))
        stirred *= 0.5 * freedom * each
        balance = stirred.copy()
        between = 0.5 * (temperature[1:] + temperature[:-1])
        thick = each * between * 2.0 / (pressure[1:] + pressure[:-1])
        conducts = np.array([thin_gas_conductivity(float(t), mass, diameter, freedom) for t in between]) / thick
        for one, other in ((here, above), (above, here)):
            balance[one, one] -= conducts
            balance[one, other] += conducts
        lowest = temperature[0] / pressure[0]
        floor = thin_gas_conductivity(kT, mass, diameter, freedom) / (0.5 * each * lowest + _JUMP * path * lowest)
        balance[0, 0] -= floor
        source = np.zeros(n)
        source[0] = floor * kT
        found = np.linalg.solve(balance, -source)
        change = float(np.abs(found - temperature).max())
        temperature = found
        if change < 1e-11 * kT:
            break
    if not (temperature > 0.0).all():
        raise ValueError("a column that is stirred so high is at absolute zero below its ceiling: make it lower.")
    slowest = np.linalg.eigvals(balance / ((0.5 * freedom + 1.0) * each)).real.max()
    thickness = each * temperature / pressure
    height = bottom + np.cumsum(thickness) - 0.5 * thickness
    work = float((stirred @ temperature).sum()) / molecules_per_area
    for values in (height, temperature, pressure):
        values.flags.writeable = False
    return StirredColumn(height, temperature, pressure, work, float(-1.0 / slowest))


def _pressure_at_ceiling(guess: float, weight: FloatArray, room: FloatArray, height: float) -> float:
    """Return the pressure at the ceiling at which elements of given kT fill the height, by Newton's method."""
    pressure = guess
    for _ in range(100):
        missing = float(np.sum(room / (pressure + weight))) - height
        step = missing / float(np.sum(room / (pressure + weight) ** 2))
        pressure = max(pressure + step, 0.1 * pressure)
        if abs(step) < 1e-13 * pressure:
            break
    return pressure

r"""Liquid water: a reservoir of molecules and energy, and the laws by which vapour and air exchange with it.

No molecule of the liquid is followed. What is known of it is how many they are, n, and their thermal energy
U; their heat capacity is :math:`C = c_l n + C_n` (in units of k), that of the nuclei on which the droplets sit
included. A molecule that comes in brings the binding energy :math:`\varphi` with it,

.. math:: U \to U + e + \varphi, \qquad n \to n + 1,

and one that leaves takes it along. Nothing in this knows of a relative humidity. The vapour pressure at which
the two counted rates meet follows from the substance, whose volatility is put in.

The rate of leaving is that of the *microcanonical* ensemble. With :math:`U' = U - \varphi`, :math:`C' = C -
c_l` and :math:`g = 2 + \zeta/2` for a vapour of :math:`\zeta` rotational degrees of freedom,

.. math:: R = Q \frac{U'^{\,C' + g - 1}}{\Gamma(C' + g)} \frac{\Gamma(C)}{U^{\,C - 1}},

and none leaves where :math:`U' \le 0`. It is the flux of phase space that a molecule which comes in takes the
other way, so the balance is detailed for any number of molecules, one even. A rate at the temperature U/C
would not be: the vapour pressure is convex, and in so small a drop U/C is never at rest. For a large drop both
agree, and that fixes :math:`Q T^{g - c_l} e^{-\varphi/T} = \alpha A e_s(T) / \sqrt{2 \pi m T}` with T = U/C.

References
----------
The law of Hertz and Knudsen, and the flux in balance with it: Persad, A. H., Ward, C. A. (2016),
doi:10.1021/acs.chemrev.5b00511. The microcanonical rate of leaving is that of Weisskopf, V. (1937),
doi:10.1103/PhysRev.52.295, who let a hot nucleus evaporate neutrons.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from atmosbox.engine.core.elementary import circle, exp, lgamma, log, log_of_normal
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import gamma, gamma_of_shape, uniform
from atmosbox.engine.liquid.substance import Drops, Liquid, Mist, Pool, Substance

__all__ = [
    "AIR_MET",
    "CONDENSED",
    "EVAPORATED",
    "LIQUID",
    "RAINED",
    "STICKING",
    "Drops",
    "Liquid",
    "Mist",
    "Pool",
    "Reservoir",
    "Substance",
    "condense",
    "cover",
    "direction",
    "evaporate",
    "evaporation_flux",
    "evaporation_rate",
    "exchange",
    "heat_capacity",
    "leave",
    "new_reservoir",
    "rain_out",
    "stays",
    "wait",
]

LIQUID, CONDENSED, EVAPORATED, RAINED, AIR_MET = range(5)
"""What is counted: molecules in the liquid now; since the start, those that came, left and rained; other hits."""

STICKING, LOG_RATE = range(2)
"""The rates of a liquid whose surface is covered as it is now: which part of the vapour sticks, and ln Q."""

THERMAL, RAINED_ENERGY = range(2)
"""The energies of a reservoir [energy]: of the liquid now, and what the rain took away."""

_BINS = 60
_WIDEST = 12.0
_NEVER = -600.0
"""Logarithm of the share of its rate at which a covered pool evaporates: never, in any time that there is."""


class Reservoir(NamedTuple):
    """The liquid, as the kernels know it.

    ``energy : (2,)`` [energy] and ``count : (5,)``: see `THERMAL` and `LIQUID`; ``clock : (3,)`` when a molecule
    may meet the mist next, leave, rain [time]; ``bound : (2,)`` the speed [length/time] and the volume [length^3]
    for which the first was drawn; ``absent : (molecule,)`` the numbers of molecules that are not in the box, of
    which the last to go is ``absent[top[0] - 1]``; ``spectrum : (bin,)`` how many left with which energy beyond
    the binding energy; ``surface : (1,)`` the area of the liquid over ``area``, which
    changes for drops alone; ``rates : (2,)`` see `STICKING`; ``log_rate`` the logarithm of Q for ``area`` that is open;
    then what `Substance` and `Liquid` say.
    """

    energy: Any
    count: Any
    clock: Any
    bound: Any
    absent: Any
    top: Any
    spectrum: Any
    surface: Any
    rates: Any
    bin_width: float
    log_rate: float
    area: float
    binding_energy: float
    molecule_capacity: float
    nuclei: float
    sticking: float
    rain: float
    keeps: int
    rotation: float
    diameter: float
    mean_cube: float
    kind: int


def new_reservoir(
    liquid: Liquid, area: float, capacity: int, present: int, kind: int, mean_cube: float = 0.0
) -> Reservoir:
    """Return the reservoir of a liquid.

    Parameters
    ----------
    liquid
        What is in the box at the start.
    area
        Of its surface [length^2].
    capacity, present
        How many molecules there are in vapour and liquid, and how many of them, the first ones, are in the box.
    kind
        Which kind of molecule the vapour is.
    mean_cube
        Mean cube of the diameters of all molecules [length^3].

    Examples
    --------
    >>> water = Substance(0.62, 1.0, 20.0, 9.0, 1e6)
    >>> reservoir = new_reservoir(Pool(water, number=5, kT=2.0), 1.0, 8, 3, 0)
    >>> float(reservoir.energy[0]), reservoir.absent.tolist(), int(reservoir.top[0])
    (90.0, [7, 6, 5, 4, 3, 0, 0, 0], 5)
    """
    substance = liquid.substance
    absent = np.zeros(max(capacity, 1), np.int64)
    missing = capacity - present
    absent[:missing] = np.arange(capacity - 1, present - 1, -1)
    count = np.zeros(5, np.int64)
    count[LIQUID] = liquid.number
    heat = (substance.heat_capacity * liquid.number + liquid.nuclei) * liquid.kT
    flux = liquid.sticking * area * substance.volatility / math.sqrt(2.0 * math.pi * substance.mass)
    log_rate = float(log(flux))
    return Reservoir(
        energy=np.array([heat, 0.0]),
        count=count,
        clock=np.full(3, math.inf),
        bound=np.array([0.0, 1.0]),
        absent=absent,
        top=np.array([missing], np.int64),
        spectrum=np.zeros(_BINS, np.int64),
        surface=np.ones(1),
        rates=np.array([liquid.sticking, log_rate]),
        bin_width=_WIDEST / _BINS * max(liquid.kT, 1e-300),
        log_rate=log_rate,
        area=float(area),
        binding_energy=float(substance.binding_energy),
        molecule_capacity=float(substance.heat_capacity),
        nuclei=float(liquid.nuclei),
        sticking=float(liquid.sticking),
        rain=float(liquid.rain),
        keeps=int(liquid.keeps),
        rotation=float(substance.rotation),
        diameter=float(substance.diameter),
        mean_cube=float(mean_cube),
        kind=kind,
    )


@kernel
def heat_capacity(reservoir):
    """Return the heat capacity of the liquid with its nuclei, in units of k."""
    return reservoir.molecule_capacity * reservoir.count[LIQUID] + reservoir.nuclei


@kernel
def evaporation_flux(reservoir, given):
    """Return how many molecules leave the liquid per time and surface; see the head of this file.

    ``given`` is what the surface gives to the liquid when it shrinks by a molecule [energy], 0 where it is flat.
    """
    if reservoir.count[LIQUID] < 1:
        return 0.0
    energy = reservoir.energy[THERMAL]
    left = energy - reservoir.binding_energy + given
    if not left > 0.0:
        return 0.0
    shape = 2.0 + 0.5 * reservoir.rotation
    capacity = heat_capacity(reservoir)
    rest = max(capacity - reservoir.molecule_capacity, 0.0)
    logarithm = reservoir.rates[LOG_RATE] + (rest + shape - 1.0) * log(left) - lgamma(rest + shape)
    logarithm += lgamma(capacity) - (capacity - 1.0) * log(energy)
    return exp(min(logarithm, 600.0))


@kernel
def evaporation_rate(reservoir):
    """Return how many molecules leave a liquid whose surface is flat per time [1/time]."""
    return reservoir.surface[0] * evaporation_flux(reservoir, 0.0)


@kernel
def wait(rate, state):
    """Return how long an event of this rate [1/time] lets itself be waited for [time]."""
    return -log_of_normal(uniform(state)) / rate if rate > 0.0 else math.inf


@kernel
def direction(pool, state):
    """Return where a molecule leaves the liquid to: by the cosine law upwards from a pool, anywhere from a droplet."""
    rise = math.sqrt(uniform(state)) if pool else 2.0 * uniform(state) - 1.0
    across = math.sqrt(max(1.0 - rise * rise, 0.0))
    cosine, sine = circle(uniform(state))
    return across * cosine, across * sine, rise


@kernel(plain=True)
def cover(reservoir, share):
    """Leave a share of the surface of the liquid open, from 0 to 1."""
    reservoir.rates[STICKING] = reservoir.sticking * share
    reservoir.rates[LOG_RATE] = reservoir.log_rate + (max(log(share), _NEVER) if share > 0.0 else _NEVER)


@kernel
def stays(reservoir, state):
    """Tell whether a molecule of the vapour that meets the liquid stays, always or by chance."""
    return reservoir.rates[STICKING] >= 1.0 or uniform(state) < reservoir.rates[STICKING]


@kernel
def condense(reservoir, energy):
    """Let a molecule of this kinetic and rotational energy join the liquid."""
    reservoir.energy[THERMAL] += energy + reservoir.binding_energy
    reservoir.count[LIQUID] += 1
    reservoir.count[CONDENSED] += 1


@kernel
def evaporate(reservoir, state):
    r"""Return with which energies of flight and of rotation the next molecule leaves; `leave` takes them out.

    Together they are to what stays behind as :math:`\Gamma(g) : \Gamma(C')`, to each other as :math:`\Gamma(2) :
    \Gamma(\zeta/2)`: those that fly fast arrive at a surface more often, and leave it so.
    """
    left = reservoir.energy[THERMAL] - reservoir.binding_energy
    rest = max(heat_capacity(reservoir) - reservoir.molecule_capacity, 0.0)
    flight = gamma(4.0, state)
    spin = gamma(reservoir.rotation, state)
    scale = left / (flight + spin + gamma_of_shape(rest, state))
    last = reservoir.spectrum.size - 1
    reservoir.spectrum[int(min(scale * (flight + spin) / reservoir.bin_width, float(last)))] += 1
    return scale * flight, scale * spin


@kernel
def leave(reservoir, energy):
    """Strike a molecule that leaves with this kinetic and rotational energy."""
    reservoir.energy[THERMAL] -= energy + reservoir.binding_energy
    reservoir.count[LIQUID] -= 1
    reservoir.count[EVAPORATED] += 1


@kernel
def exchange(reservoir, energy, rotation, state):
    r"""Return with which energies of flight and of rotation a molecule goes that met the liquid and did not stay.

    What it had and the liquid's own energy are shared as :math:`\Gamma(2) : \Gamma(\zeta/2) : \Gamma(C)`.
    """
    flight = gamma(4.0, state)
    spin = gamma(rotation, state)
    scale = (reservoir.energy[THERMAL] + energy) / (flight + spin + gamma_of_shape(heat_capacity(reservoir), state))
    return scale * flight, scale * spin


@kernel
def rain_out(reservoir):
    """Let one molecule of the liquid fall out of the box, with its share of the thermal energy."""
    capacity = heat_capacity(reservoir)
    taken = reservoir.energy[THERMAL] * reservoir.molecule_capacity / capacity
    reservoir.energy[THERMAL] -= taken
    reservoir.energy[RAINED_ENERGY] += taken
    reservoir.count[LIQUID] -= 1
    reservoir.count[RAINED] += 1

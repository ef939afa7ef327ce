r"""Liquid water: a reservoir of molecules and energy, and the laws of its exchange with vapour and air.

No molecule of the liquid is followed. The state of the liquid is its number of molecules, n, and its thermal energy
U; its heat capacity, with that of the nuclei of the droplets, is :math:`C = c_l n + C_n` (in units of k). A molecule
of energy e that enters also brings the binding energy :math:`\varphi`,

.. math:: U \to U + e + \varphi, \qquad n \to n + 1,

and a molecule that leaves takes both out. No relative humidity is put in. The vapour pressure at which both rates
are equal follows from the substance, whose volatility is put in.

The rate of leaving is that of the *microcanonical* ensemble. With :math:`U' = U - \varphi`, :math:`C' = C -
c_l` and :math:`g = 2 + \zeta/2` for a vapour of :math:`\zeta` rotational degrees of freedom,

.. math:: R = Q \frac{U'^{\,C' + g - 1}}{\Gamma(C' + g)} \frac{\Gamma(C)}{U^{\,C - 1}},

and no molecule leaves where :math:`U' \le 0`. This is the flux in phase space of molecules that enter, reversed; so
detailed balance holds for any number of molecules, even for one. With a rate at the temperature U/C it would not:
the vapour pressure is convex in temperature, and in so small a drop U/C fluctuates. For a large drop both rates
agree, and that fixes :math:`Q T^{g - c_l} e^{-\varphi/T} = \alpha A e_s(T) / \sqrt{2 \pi m T}` with T = U/C.

References
----------
The law of Hertz and Knudsen, and the flux in equilibrium with it: Persad, A. H., Ward, C. A. (2016),
doi:10.1021/acs.chemrev.5b00511. The microcanonical rate of leaving is that of Weisskopf, V. (1937),
doi:10.1103/PhysRev.52.295, for the evaporation of neutrons from a hot nucleus.
"""

import math
from collections import namedtuple

import numpy as np

from atmosbox.engine.core.elementary import circle, exp, lgamma, log, log_of_normal
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.core.random import gamma, gamma_of_shape, uniform
from atmosbox.engine.liquid.substance import Liquid

LIQUID, CONDENSED, EVAPORATED, RAINED, AIR_MET = range(5)
"""The counts: molecules in the liquid now; since the start, those that entered, left and rained; other hits."""

STICKING, LOG_RATE = range(2)
"""The rates of a liquid whose surface may be partly covered: the fraction of the vapour that sticks, and ln Q."""

THERMAL, RAINED_ENERGY = range(2)
"""The energies of a reservoir [energy]: the thermal energy of the liquid now, and the energy that the rain took out."""

MAY_MEET, LEAVES, RAINS = range(3)
"""The clocks: when the next molecule may meet the liquid, the next one leaves it, and the next one rains [time]."""

_BINS = 60
_WIDEST = 12.0
_NEVER = -600.0
"""Logarithm of the factor of the evaporation rate of a fully covered pool: so small that no molecule ever leaves."""


class Reservoir(
    namedtuple(
        "Reservoir",
        "energy count clock bound absent top spectrum surface rates bin_width log_rate area binding_energy "
        "molecule_capacity nuclei sticking rain keeps rotation diameter mean_cube kind",
    )
):
    """The liquid in the form that the kernels take.

    ``energy : (2,)`` [energy] and ``count : (5,)``: see `THERMAL` and `LIQUID`; ``clock : (3,)``: when a molecule
    may next meet the mist, leave, rain [time]; ``bound : (2,)``: the speed [length/time] and the volume [length^3]
    for which the first of these was drawn; ``absent : (molecule,)``: the indices of molecules that are not in the box,
    the last of them ``absent[top[0] - 1]``; ``spectrum : (bin,)``: number of molecules that left, by their energy
    beyond the binding energy; ``surface : (1,)``: the area of the liquid over ``area``, which changes for drops alone;
    ``rates : (2,)``: see `STICKING`; ``log_rate``: the logarithm of Q for the uncovered ``area``;
    then parameters of `Substance` and `Liquid`.
    """


def new_reservoir(
    liquid: Liquid, area: float, capacity: int, present: int, kind: int, mean_cube: float = 0.0
) -> Reservoir:
    """Return the reservoir of a liquid with a surface of this ``area`` [length^2].

    It has room for ``capacity`` molecules of vapour, air and liquid, of which the first ``present`` are in the box; the
    vapour is of a ``kind``, and ``mean_cube`` is the mean cube of all diameters [length^3].

    >>> from atmosbox.engine.liquid.substance import Pool, Substance
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
    """Return the number of molecules that leave the liquid per time and surface; the module's docstring has the law.

    ``given`` is the energy that the surface gives to the liquid when it shrinks by one molecule [energy]; 0 if flat.
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
    """Return the number of molecules that leave a liquid with a flat surface per time [1/time]."""
    return reservoir.surface[0] * evaporation_flux(reservoir, 0.0)


@kernel
def wait(rate, state):
    """Draw the waiting time [time] until the next event of a Poisson process of this rate [1/time]."""
    return -log_of_normal(uniform(state)) / rate if rate > 0.0 else math.inf


@kernel
def renew(t, state, reservoir):
    """Draw at time t when the next molecule leaves the liquid, and when the next one rains."""
    reservoir.clock[LEAVES] = t + wait(evaporation_rate(reservoir), state)
    reservoir.clock[RAINS] = t + wait(reservoir.rain * (reservoir.count[LIQUID] - reservoir.keeps), state)


@kernel
def direction(pool, state):
    """Draw the direction of a molecule that leaves: by the cosine law upwards from a pool, any from a droplet."""
    rise = math.sqrt(uniform(state)) if pool else 2.0 * uniform(state) - 1.0
    across = math.sqrt(max(1.0 - rise * rise, 0.0))
    cosine, sine = circle(uniform(state))
    return across * cosine, across * sine, rise


@kernel(plain=True)
def cover(reservoir, share):
    """Cover the surface of the liquid except for an open ``share``, from 0 to 1."""
    reservoir.rates[STICKING] = reservoir.sticking * share
    reservoir.rates[LOG_RATE] = reservoir.log_rate + (max(log(share), _NEVER) if share > 0.0 else _NEVER)


@kernel
def stays(reservoir, state):
    """Return whether a vapour molecule that meets the liquid stays: always, or with the probability of sticking."""
    return reservoir.rates[STICKING] >= 1.0 or uniform(state) < reservoir.rates[STICKING]


@kernel
def condense(reservoir, energy):
    """Add a molecule of this kinetic and rotational energy [energy] to the liquid."""
    reservoir.energy[THERMAL] += energy + reservoir.binding_energy
    reservoir.count[LIQUID] += 1
    reservoir.count[CONDENSED] += 1


@kernel
def evaporate(reservoir, state):
    r"""Draw the translational and rotational energies with which the next molecule leaves; `leave` takes them out.

    Their sum is to the energy that stays behind as gamma variates of shapes g and C', and they are to each other as
    gamma variates of shapes 2 and :math:`\zeta/2`: fast molecules arrive at a surface more often, and leave it more
    often too.
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
    """Remove from the liquid a molecule that leaves with this kinetic and rotational energy [energy]."""
    reservoir.energy[THERMAL] -= energy + reservoir.binding_energy
    reservoir.count[LIQUID] -= 1
    reservoir.count[EVAPORATED] += 1


@kernel
def emitted(mass, flow, pool, reservoir, state):
    """Remove a molecule from the liquid; return its velocity, its rotational energy, and its speed out of the liquid.

    The liquid moves upwards with the ``flow`` [length/time].
    """
    flight, spin = evaporate(reservoir, state)
    speed = math.sqrt(2.0 * flight / mass)
    ex, ey, ez = direction(pool, state)
    vx, vy, vz = speed * ex, speed * ey, speed * ez + flow
    energy = 0.5 * mass * (vx * vx + vy * vy + vz * vz) + spin
    if flow != 0.0 and energy + reservoir.binding_energy > reservoir.energy[THERMAL]:
        # only the last molecule can lack the energy of the flow: it leaves as if the air were at rest
        vz = speed * ez
        energy = flight + spin
    leave(reservoir, energy)
    return (vx, vy, vz), spin, speed


@kernel
def exchange(reservoir, energy, rotation, state):
    r"""Draw the translational and rotational energies of a molecule that met the liquid and did not stay.

    Its energy and the liquid's are shared as gamma variates of shapes 2, :math:`\zeta/2` and C.
    """
    flight = gamma(4.0, state)
    spin = gamma(rotation, state)
    scale = (reservoir.energy[THERMAL] + energy) / (flight + spin + gamma_of_shape(heat_capacity(reservoir), state))
    return scale * flight, scale * spin


@kernel
def rain_out(reservoir):
    """Remove one molecule of the liquid as rain, with its share of the thermal energy."""
    capacity = heat_capacity(reservoir)
    taken = reservoir.energy[THERMAL] * reservoir.molecule_capacity / capacity
    reservoir.energy[THERMAL] -= taken
    reservoir.energy[RAINED_ENERGY] += taken
    reservoir.count[LIQUID] -= 1
    reservoir.count[RAINED] += 1

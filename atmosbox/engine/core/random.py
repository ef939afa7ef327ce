"""Random numbers that depend on the seed and on nothing else: splitmix64, one 64-bit word of state.

References
----------
Steele, G. L., Lea, D., Flood, C. H. (2014), doi:10.1145/2660193.2660195.
Marsaglia, G., Tsang, W. W. (2000), doi:10.1145/358407.358414 (gamma variates of any shape).
"""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel

__all__ = ["gamma", "gamma_of_shape", "gaussian_pair", "uniform"]

_STEP = np.uint64(0x9E3779B97F4A7C15)
_MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
_MIX_2 = np.uint64(0x94D049BB133111EB)


@kernel
def uniform(state):
    """Return a number between 0 and 1, both excluded.

    Parameters
    ----------
    state : (1,)
        The state, moved on.

    Examples
    --------
    >>> 0.0 < uniform(np.array([7], np.uint64)) < 1.0
    True
    """
    state[0] += _STEP
    z = state[0]
    z = (z ^ (z >> np.uint64(30))) * _MIX_1
    z = (z ^ (z >> np.uint64(27))) * _MIX_2
    z = z ^ (z >> np.uint64(31))
    return (np.float64(z >> np.uint64(12)) + 0.5) * (1.0 / 4503599627370496.0)


@kernel
def gaussian_pair(state):
    """Return two independent normal numbers of mean 0 and variance 1 (Box and Muller).

    Examples
    --------
    >>> len(gaussian_pair(np.array([7], np.uint64)))
    2
    """
    radius = math.sqrt(-2.0 * math.log(uniform(state)))
    angle = 2.0 * math.pi * uniform(state)
    return radius * math.cos(angle), radius * math.sin(angle)


@kernel
def gamma(degrees, state):
    """Return a gamma variate of shape ``degrees`` / 2: the energy, in kT, of that many quadratic degrees of freedom.

    Parameters
    ----------
    degrees
        A whole number, 0 to 4.
    state : (1,)
        The state, moved on.

    Examples
    --------
    >>> gamma(0.0, np.array([7], np.uint64))
    0.0
    """
    energy = 0.0
    if degrees >= 4.0:
        energy -= math.log(uniform(state) * uniform(state))
    elif degrees >= 2.0:
        energy -= math.log(uniform(state))
    if degrees == 1.0 or degrees == 3.0:
        normal, _ = gaussian_pair(state)
        energy += 0.5 * normal * normal
    return energy


@kernel
def gamma_of_shape(shape, state):
    """Return a gamma variate of any shape: the energy, in kT, of twice as many quadratic degrees of freedom.

    Parameters
    ----------
    shape
        Not negative; of shape 0 it is 0.
    state : (1,)
        The state, moved on.

    Examples
    --------
    >>> gamma_of_shape(0.0, np.array([7], np.uint64))
    0.0
    """
    if not shape > 0.0:
        return 0.0
    boost = 1.0
    if shape < 1.0:
        boost = uniform(state) ** (1.0 / shape)
        shape += 1.0
    d = shape - 1.0 / 3.0
    c = 1.0 / math.sqrt(9.0 * d)
    while True:
        normal, _ = gaussian_pair(state)
        v = 1.0 + c * normal
        if v <= 0.0:
            continue
        v = v * v * v
        if math.log(uniform(state)) < 0.5 * normal * normal + d - d * v + d * math.log(v):
            return boost * d * v

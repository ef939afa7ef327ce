"""Random numbers that depend on the seed and on nothing else: splitmix64, one 64-bit word of state.

Word n of the sequence is a function of the initial state and n alone. So `RandomNumbers`, which makes many at once for
the start of a run, returns the numbers that kernels would draw one by one from the same state.

References
----------
Steele, G. L., Lea, D., Flood, C. H. (2014), doi:10.1145/2660193.2660195.
Marsaglia, G., Tsang, W. W. (2000), doi:10.1145/358407.358414 (gamma variates of any shape).
"""

import math

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.elementary import circle, exp, log, log_of_normal
from atmosbox.engine.core.jit import kernel

STEP = np.uint64(0x9E3779B97F4A7C15)
MIX_1 = np.uint64(0xBF58476D1CE4E5B9)
MIX_2 = np.uint64(0x94D049BB133111EB)
_WORD = (1 << 64) - 1
RUN, START = range(2)
"""The uses of a seed: for what happens in the box, and for positions and velocities at the start."""


@kernel(plain=True)
def _mixed(z):
    """Return the word of the sequence that follows from a state."""
    z = (z ^ (z >> np.uint64(30))) * MIX_1
    z = (z ^ (z >> np.uint64(27))) * MIX_2
    return z ^ (z >> np.uint64(31))


@kernel(plain=True)
def scramble(word):
    """Return a random word that depends on another word alone.

    >>> bool(scramble(np.uint64(1)) == scramble(np.uint64(2)))
    False
    """
    return _mixed(word + STEP)


@kernel(plain=True)
def _number(state):
    """Return a number between 0 and 1, both excluded, from a state; an array of them from an array."""
    return (np.float64(_mixed(state) >> np.uint64(12)) + 0.5) * (1.0 / 4503599627370496.0)


def new_state(seed: int, use: int = RUN) -> NDArray[np.uint64]:
    """Return the first state, (1,), for a seed of any length; each use of the seed has another one.

    >>> int(new_state(1)[0]) != int(new_state(1, START)[0])
    True
    """
    state = np.uint64(0x6A09E667F3BCC909 * (2 * use + 1) & _WORD)
    while True:
        state = scramble(state ^ np.uint64(seed & _WORD))
        seed >>= 64
        if not seed:
            return np.array([state], np.uint64)


class RandomNumbers:
    """Random numbers for the start of a run, where a few are needed for each molecule.

    Parameters
    ----------
    seed
        A whole number, not below 0.

    Examples
    --------
    >>> numbers = RandomNumbers(1)
    >>> numbers.random((2, 3)).shape, bool(0.0 < numbers.random(5).min())
    ((2, 3), True)
    """

    def __init__(self, seed: int) -> None:
        self.state = new_state(seed, START)

    def random(self, size: int | tuple[int, ...]) -> NDArray[np.float64]:
        """Return the next numbers between 0 and 1, both excluded, in an array of the shape ``size``."""
        number = math.prod(size) if isinstance(size, tuple) else size
        words = self.state + STEP * np.arange(1, number + 1, dtype=np.uint64)
        self.state[:] = words[-1:] if number else self.state
        return np.asarray(_number(words)).reshape(size)


Source = RandomNumbers | np.random.Generator
"""A source of random numbers for the start: a generator of numpy may be given instead."""


def normal(source: Source, size: int | tuple[int, ...]) -> NDArray[np.float64]:
    """Return independent normal numbers of mean 0 and variance 1 in an array of the shape ``size`` (Box and Muller).

    >>> numbers = normal(RandomNumbers(1), (1, 2))
    >>> numbers[0].tolist() == list(gaussian_pair(new_state(1, START)))
    True
    """
    number = math.prod(size) if isinstance(size, tuple) else size
    pairs = source.random(((number + 1) // 2, 2))
    radius = np.sqrt(-2.0 * log_of_normal(pairs[:, 0]))
    cosine, sine = circle(pairs[:, 1])
    return np.stack([radius * cosine, radius * sine], axis=1).reshape(-1)[:number].reshape(size)


@kernel
def uniform(state):
    """Return a number between 0 and 1, both excluded, and advance the state.

    >>> 0.0 < uniform(np.array([7], np.uint64)) < 1.0
    True
    """
    state[0] += STEP
    return _number(state[0])


@kernel
def gaussian_pair(state):
    """Return two independent normal numbers of mean 0 and variance 1, and advance the state (Box and Muller)."""
    radius = math.sqrt(-2.0 * log_of_normal(uniform(state)))
    cosine, sine = circle(uniform(state))
    return radius * cosine, radius * sine


@kernel
def gamma(degrees, state):
    """Return a gamma variate of shape ``degrees`` / 2: the energy in kT of 0 to 4 quadratic degrees of freedom.

    >>> gamma(0.0, np.array([7], np.uint64))
    0.0
    """
    energy = 0.0
    if degrees >= 4.0:
        energy -= log_of_normal(uniform(state) * uniform(state))
    elif degrees >= 2.0:
        energy -= log_of_normal(uniform(state))
    if degrees == 1.0 or degrees == 3.0:
        deviate, _ = gaussian_pair(state)
        energy += 0.5 * deviate * deviate
    return energy


@kernel
def gamma_of_shape(shape, state):
    """Return a gamma variate of any shape, 0 or above: the energy, in kT, of 2 * shape quadratic degrees of freedom.

    >>> gamma_of_shape(0.0, np.array([7], np.uint64))
    0.0
    """
    if not shape > 0.0:
        return 0.0
    boost = 1.0
    if shape < 1.0:
        boost = exp(log_of_normal(uniform(state)) / shape)
        shape += 1.0
    d = shape - 1.0 / 3.0
    c = 1.0 / math.sqrt(9.0 * d)
    while True:
        deviate, _ = gaussian_pair(state)
        v = 1.0 + c * deviate
        if v <= 0.0:
            continue
        v = v * v * v
        if log_of_normal(uniform(state)) < 0.5 * deviate * deviate + d - d * v + d * log(v):
            return boost * d * v

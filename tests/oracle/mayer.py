"""The fourth virial coefficient of the square well, by Monte Carlo integration of Mayer's integrals."""

import functools
import math

import numpy as np


@functools.cache
def fourth_virial(warmth, chains=20_000_000, reach=1.5):
    r"""Return the fourth virial coefficient [diameter^9] at T*, and its standard error.

    :math:`B_4 = -\tfrac18 \int f_{12} f_{23} f_{34} f_{41} [3 + 3 (f_{13} + f_{24}) + f_{13} f_{24}]`: each molecule of
    a chain of four is placed at random within the range of the one before.
    """
    random, x, parts = np.random.default_rng(4), math.expm1(1.0 / warmth), 40
    means = []

    def mayer(separation):
        square = np.einsum("na,na->n", separation, separation)
        return np.where(square < 1.0, -1.0, np.where(square < reach**2, x, 0.0))

    for _ in range(parts):
        n = chains // parts
        steps = random.normal(size=(3, n, 3))
        steps *= reach * (random.random((3, n)) ** (1.0 / 3.0) / np.sqrt(np.sum(steps**2, axis=2)))[:, :, None]
        first, second, third = steps
        two, three = first + second, second + third
        ring = mayer(first) * mayer(second) * mayer(third) * mayer(first + three)
        across, other = mayer(two), mayer(three)
        means.append(float(np.mean(ring * (3.0 + 3.0 * (across + other) + across * other))))
    room = (4.0 * math.pi / 3.0 * reach**3) ** 3 / 8.0
    return -room * float(np.mean(means)), room * float(np.std(means, ddof=1)) / math.sqrt(parts)

"""A sum in a page rounds like the sum of numpy with which Python starts a box."""

import numpy as np

from atmosbox.lab.kernels.pairwise import pairwise_sum


def test_a_sum_has_the_bits_of_numpy_whatever_the_number():
    numbers = np.random.default_rng(1).normal(size=30_011)
    for number in [*range(1, 400), 1000, 1024, 1025, 4001, 12_000, numbers.size]:
        assert pairwise_sum(numbers, 0, number) == np.sum(numbers[:number])

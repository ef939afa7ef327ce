"""Random numbers have the moments and the distributions that they claim, and repeat with their seed.

Each moment is held to 4 standard errors, computed from the distribution itself: a false alarm in 16 000 seeds
per check.
"""

import math

import numpy as np
import pytest
from scipy import stats

from atmosbox.engine.core.random import RUN, START, gamma, gaussian_pair, new_state, uniform
from tests.engine.boxes import held, random_state

NUMBER = 40_000
WORD = 1 << 64


@pytest.fixture(scope="module")
def uniforms():
    state = random_state(11)
    return np.array([uniform(state) for _ in range(NUMBER)])


@pytest.fixture(scope="module")
def normals():
    state = random_state(11)
    return np.array([gaussian_pair(state) for _ in range(NUMBER)])


def test_uniform_numbers_fill_the_interval_evenly(uniforms):
    assert stats.kstest(uniforms, "uniform").pvalue > 1e-4  # a false alarm in 10 000 seeds
    for power in range(1, 5):
        mean = 1.0 / (power + 1)
        assert held(uniforms**power, mean, 1.0 / (2 * power + 1) - mean**2)


def test_successive_uniform_numbers_are_uncorrelated(uniforms):
    for lag in (1, 2, 3):
        products = (uniforms[:-lag] - 0.5) * (uniforms[lag:] - 0.5)
        assert held(products, 0.0, 1.0 / 144.0)


def test_uniform_numbers_are_splitmix64():
    # the published generator started at 1234567: its first outputs
    published = [6457827717110365317, 3203168211198807973, 9817491932198370423, 4593380528125082431]
    state = np.array([1234567], np.uint64)
    assert [uniform(state) for _ in published] == pytest.approx([word / WORD for word in published], abs=1e-15)


def unmix(word):
    """Return the state from which splitmix64 makes this word, by inverting its steps."""

    def unshift(z, bits):
        x = z
        for _ in range(64 // bits + 1):
            x = z ^ (x >> bits)
        return x

    z = unshift(word, 31) * pow(0x94D049BB133111EB, -1, WORD) % WORD
    z = unshift(z, 27) * pow(0xBF58476D1CE4E5B9, -1, WORD) % WORD
    return (unshift(z, 30) - 0x9E3779B97F4A7C15) % WORD


def test_the_largest_and_the_smallest_word_make_neither_one_nor_zero():
    for word in [0, 1, WORD // 2, WORD - 2, WORD - 1]:
        number = uniform(np.array([unmix(word)], np.uint64))
        assert 0.0 < number < 1.0
        assert number == pytest.approx(word / WORD, abs=1e-15)


def test_the_same_seed_gives_the_same_numbers_and_each_other_seed_and_use_others():
    cases = [(seed, use) for seed in (0, 1, 2, 1 + WORD, 1 + 2 * WORD, 10**60) for use in (RUN, START)]
    first, again = ([int(new_state(*case)[0]) for case in cases] for _ in range(2))
    assert first == again
    assert len(set(first)) == len(cases)


def test_gaussian_pairs_are_normal_and_independent(normals):
    for column in normals.T:
        assert stats.kstest(column, "norm").pvalue > 1e-4
        assert held(column, 0.0, 1.0)
        assert held(column**2, 1.0, 2.0)
        assert held(column**4, 3.0, 96.0)
    first, second = normals.T
    assert held(first * second, 0.0, 1.0)
    assert held(first**2 * second**2, 1.0, 8.0)


@pytest.mark.parametrize("degrees", [1, 2, 3, 4])
def test_the_energy_of_quadratic_degrees_of_freedom_is_gamma_distributed(degrees):
    state = random_state(degrees)
    shape = 0.5 * degrees
    energies = np.array([gamma(float(degrees), state) for _ in range(NUMBER)])
    assert (energies > 0.0).all()
    assert stats.kstest(energies, "gamma", args=(shape,)).pvalue > 1e-4
    for power in (1, 2, 3):
        mean = math.gamma(shape + power) / math.gamma(shape)
        square = math.gamma(shape + 2 * power) / math.gamma(shape)
        assert held(energies**power, mean, square - mean**2)

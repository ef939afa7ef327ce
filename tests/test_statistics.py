"""Standard errors: right for correlated series, and refused if there are too few data."""

import numpy as np
import pytest
from scipy import signal

from atmosbox.scene.statistics import average_beside, block_average, overlapping_average

RUNS, VALUES = 4000, 400


def remembering(memory, seed):
    """Return many series (value, run) of variance 1 whose correlation fades as exp(-t / memory); of 0, as noise."""
    keep = np.exp(-1.0 / memory) if memory else 0.0
    noise = np.random.default_rng(seed).normal(size=(VALUES, RUNS))
    noise[1:] *= np.sqrt(1.0 - keep**2)
    return signal.lfilter([1.0], [1.0, -keep], noise, axis=0)


def variance_of_mean(memory):
    """Return the exact variance of the mean of such a series."""
    keep = np.exp(-1.0 / memory) if memory else 0.0
    lag = np.arange(1, VALUES)
    return (1.0 + 2.0 * np.sum((1.0 - lag / VALUES) * keep**lag)) / VALUES


def assert_covered(found, variance, *, short=0.0):
    """The stated error equals the scatter of 4000 runs, each of which knows its own error to a fourth at worst.

    Four standard errors of the mean of the squares, 0.02 each for errors that scatter by a half. `short` is the share
    of the variance that blocks of this length cannot see.
    """
    assert np.mean(found.standard_error**2) / variance == pytest.approx(1.0 - short, abs=0.03)
    # chi-square of 4000 means about the truth, 0
    assert np.mean(found.mean**2) / variance == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / RUNS))


def test_blocks_state_the_scatter_of_the_mean_if_they_are_told_the_memory():
    for memory in [0.0, 2.0, 5.0, 20.0]:
        assert_covered(block_average(remembering(memory, 3), memory=memory), variance_of_mean(memory))


@pytest.mark.parametrize(("memory", "short"), [(0.0, 0.0), (2.0, 0.0), (4.0, 0.03)])
def test_blocks_of_two_lengths_state_it_without_being_told(memory, short):
    assert_covered(overlapping_average(remembering(memory, 4)), variance_of_mean(memory), short=short)


def test_a_noisy_series_that_follows_a_slow_one_has_the_error_of_both():
    slow, quick = remembering(20.0, 5), remembering(1.0, 6)
    found = [average_beside(quick[:, run] + 0.7 * slow[:, run], slow[:, run], 20.0) for run in range(1000)]
    stated = np.mean([each.standard_error**2 for each in found])
    variance = 0.49 * variance_of_mean(20.0) + variance_of_mean(1.0)
    # 1000 runs that each know a variance by a half or less: 1.6 %, and the regression adds 2 %
    assert stated / variance == pytest.approx(1.0, abs=0.08)
    assert np.mean([each.mean**2 for each in found]) / variance == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / 1000))


@pytest.mark.parametrize("memory", [1e6, 1e12, 1e18])
def test_a_run_much_shorter_than_its_memory_states_an_error_that_grows_as_the_root_of_it(memory):
    """Of n blocks of a length L much less than the memory tau, the error of blocks times sqrt(3 tau / L)."""
    series = np.random.default_rng(1).normal(size=400)
    plain = float(block_average(series).standard_error)
    found = float(block_average(series, memory=memory).standard_error)
    assert found == pytest.approx(plain * np.sqrt(3.0 * memory / 20.0), rel=1e-3)

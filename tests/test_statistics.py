"""Error bars: honest for correlated series, and refused where there is nothing to tell."""

import numpy as np
import pytest
from scipy import signal

from atmosbox.scene.statistics import block_average, kolmogorov_smirnov_critical


def test_the_error_of_independent_values_is_that_of_their_mean():
    values = np.random.default_rng(3).normal(5.0, 2.0, size=20_000)
    mean, error = block_average(values, blocks=200)
    # 200 blocks know the error to 5 %; four of them for a false alarm in 16 000 seeds.
    assert error == pytest.approx(2.0 / np.sqrt(20_000), rel=0.2)
    assert abs(mean - 5.0) < 4.0 * error


def test_blocks_see_the_memory_of_a_correlated_series():
    # x' = 0.9 x + noise has the variance 1 / (1 - 0.81) and an integrated time of 19 values, so that its mean
    # scatters by 10 / sqrt(n): sqrt(19) times more than independent values would.
    noise = np.random.default_rng(4).normal(size=200_000)
    series = signal.lfilter([1.0], [1.0, -0.9], noise)
    error = block_average(series, blocks=200).standard_error
    assert error == pytest.approx(10.0 / np.sqrt(200_000), rel=0.2)
    assert error > 3.5 * series.std() / np.sqrt(series.size)


def test_each_layer_has_its_own_mean_and_error():
    values = np.stack([np.arange(40.0), np.ones(40)], axis=1)
    mean, error = block_average(values)
    assert np.allclose(mean, [19.5, 1.0])
    assert error[0] > 0.0
    assert error[1] == 0.0


def test_values_that_do_not_divide_evenly_are_dropped_from_the_start():
    assert float(block_average([100.0, 1.0, 2.0, 3.0, 4.0], blocks=2).mean) == 2.5


@pytest.mark.parametrize(
    ("values", "blocks", "sentence"),
    [
        ([1.0, 2.0], 1, "blocks = 1 must be at least 2"),
        ([1.0, 2.0], 20, "2 values cannot be divided into 20 blocks"),
        (1.0, 20, "1 values cannot be divided into 20 blocks"),
    ],
)
def test_too_few_values_have_no_error_bar(values, blocks, sentence):
    with pytest.raises(ValueError, match=sentence):
        block_average(values, blocks)


@pytest.mark.parametrize(("level", "critical"), [(0.05, 1.358), (0.01, 1.628), (0.001, 1.949)])
def test_kolmogorov_and_smirnovs_critical_values(level, critical):
    assert kolmogorov_smirnov_critical(1, level) == pytest.approx(critical, abs=5e-4)
    assert kolmogorov_smirnov_critical(400, level) == pytest.approx(critical / 20.0, abs=5e-5)

"""The engine's elementary functions against 60-digit arithmetic, compiled and not."""

import math

import mpmath
import numpy as np
import pytest

from atmosbox.engine.core import elementary
from atmosbox.engine.core.random import START, RandomNumbers, gaussian_pair, new_state, normal, uniform

RNG = np.random.default_rng(1)
MANY = 1500


def units(found, true):
    """Return the error in units of the last place of the true value."""
    true_float = float(true)
    if math.isinf(true_float):
        return 0.0 if found == true_float else math.inf
    return float(abs(mpmath.mpf(found) - true) / mpmath.mpf(math.ulp(true_float)))


def around(*places):
    """Return numbers close to some places, on both sides."""
    return np.concatenate([place + side * 10.0 ** RNG.uniform(-17, -2, 60) for place in places for side in (-1.0, 1.0)])


def powers(low, high):
    """Return numbers of every order of magnitude between two powers of ten."""
    return 10.0 ** RNG.uniform(low, high, MANY)


CASES = {
    "log": (mpmath.log, [RNG.random(MANY), powers(-323, 308), around(1.0, math.sqrt(0.5), math.sqrt(2.0)), [5e-324]]),
    "log_of_normal": (mpmath.log, [RNG.random(MANY), powers(-307, 308), around(1.0), [2.0**-1022, 2.0**-53]]),
    "log1p": (mpmath.log1p, [RNG.uniform(-1, 3, MANY), powers(-300, 300), -powers(-300, -0.01), [2.0**-53 - 1.0]]),
    "exp": (mpmath.exp, [RNG.uniform(-745, 709.7, MANY), RNG.uniform(-1, 1, MANY), powers(-300, 0), [-745.1, 709.78]]),
    "expm1": (mpmath.expm1, [RNG.uniform(-80, 709, MANY), RNG.uniform(-2, 2, MANY), powers(-300, 0), -powers(-300, 0)]),
    "cbrt": (mpmath.cbrt, [powers(-307, 308), RNG.uniform(0, 9, MANY), np.arange(1.0, 20.0) ** 3]),
    "lgamma": (mpmath.loggamma, [3.0 + powers(-290, 290), RNG.uniform(3, 20, MANY), RNG.uniform(1e3, 1e6, MANY)]),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_each_function_is_within_one_unit_in_the_last_place(name):
    true, parts = CASES[name]
    function = getattr(elementary, name)
    with mpmath.workdps(60):
        errors = [units(float(function(x)), true(mpmath.mpf(x))) for x in np.concatenate(parts).tolist()]
    assert max(errors) <= 1.0


def test_the_logarithm_of_gamma_is_nearly_that_good_where_it_has_its_zeros():
    x = np.concatenate([powers(-290, 0.5), RNG.uniform(0.01, 3.0, 2 * MANY), around(1.0, 2.0, 1.4616321449683623)])
    with mpmath.workdps(60):
        for u in x.tolist():
            error = abs(float(elementary.lgamma(u)) - mpmath.loggamma(mpmath.mpf(u)))
            # below 2 it is a difference of two numbers below 2, each with two or three roundings of up to 2^-52
            assert error <= 2.0**-50 * max(1.0, abs(math.lgamma(u)))
            assert u < 2.0 or error <= 1.5 * math.ulp(math.lgamma(u))


def test_cosine_and_sine_of_turns_are_within_one_unit_in_the_last_place():
    turns = np.concatenate([RNG.random(MANY), 10.0 ** RNG.uniform(-18, 0, MANY), np.arange(9) / 8, [1.0 - 2.0**-53]])
    with mpmath.workdps(60):
        for u in turns.tolist():
            cosine, sine = (float(each) for each in elementary.circle(u))
            assert units(cosine, mpmath.cospi(2 * mpmath.mpf(u))) <= 1.0, u
            assert units(sine, mpmath.sinpi(2 * mpmath.mpf(u))) <= 1.0, u


def test_numbers_made_at_once_are_those_drawn_one_by_one():
    state = new_state(11, START)
    at_once = RandomNumbers(11)
    assert at_once.random((2, 3)).ravel().tolist() == [uniform(state) for _ in range(6)]
    assert at_once.random(0).size == 0
    assert normal(at_once, (2, 2)).ravel().tolist() == [*gaussian_pair(state), *gaussian_pair(state)]

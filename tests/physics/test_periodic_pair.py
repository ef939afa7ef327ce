r"""Two spheres in a periodic cube, the smallest gas, collide exactly as often as geometry predicts.

Seen from one of them, the other is a point that flies among the images of a sphere of radius sigma. In a space of
volume V bounded by a surface of area S the mean chord is 4 V / S (Santalo 1976, doi:10.1017/CBO9780511617331), so

.. math:: \tau g = \frac{L^3 - 4 \pi \sigma^3 / 3}{\pi \sigma^2},

g being the relative speed, which never changes. From L = 2 sigma on the images of the sphere do not overlap.
"""

import math

import numpy as np
import pytest

from atmosbox.engine import ParcelSet, Periodic

WALLS = (Periodic(),) * 6


def paths(side, contacts, seed):
    """Return the mean free path of the relative motion, its standard error and the box."""
    random = np.random.default_rng(seed)
    direction = random.normal(size=3)
    velocity = 0.5 * np.array([direction, -direction]) / np.linalg.norm(direction)
    drift = [0.31, -0.17, 0.05]  # of both: it may make no difference
    half = 0.5 * side
    pair = ParcelSet([[0.1] * 3, [0.1 + half] * 3], velocity + drift, length=(side,) * 3, walls=WALLS)
    expected = (side**3 - 4.0 * math.pi / 3.0) / math.pi
    blocks, before = [], 0
    many = 40
    length = contacts * expected / many
    for k in range(many):
        pair.advance((k + 1) * length)
        blocks.append(pair.contacts - before)
        before = pair.contacts
    rate = np.array(blocks) / length
    mean = rate.mean()
    return 1.0 / mean, rate.std(ddof=1) / math.sqrt(many) / mean**2, pair


@pytest.mark.parametrize(
    "side", [5.5, *(pytest.param(side, marks=pytest.mark.nightly) for side in (2.0, 2.1, 2.5, 3.5))]
)
def test_the_mean_free_path_of_a_pair_is_exact(side):
    found, error, pair = paths(side, contacts=40_000, seed=round(10 * side))
    expected = (side**3 - 4.0 * math.pi / 3.0) / math.pi
    assert error < 0.01 * expected
    assert abs(found - expected) < 4.0 * error  # false alarm: 1 in 16 000 a side
    assert pair.ledger() < 1e-12

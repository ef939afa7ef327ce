"""Molecules that overlap are pushed apart, and no other molecules are moved."""

import numpy as np
import pytest

from atmosbox.engine.start.overlap import bins_of, push, spheres_of


def pushed(x, radius, sides, periodic=(False,) * 3, rounds=8):
    """Push centres in a box apart; return how many pairs were pushed in the last round."""
    spheres = spheres_of(2.0 * radius, sides, periodic, planar=False)._replace(x=x)
    return push(spheres, bins_of(spheres), rounds)


def test_molecules_that_do_not_overlap_stay_where_they_are():
    x = np.array([[1.0, 1.0, 1.0], [2.5, 1.0, 1.0], [1.0, 3.0, 3.0]])
    before = x.copy()
    assert pushed(x, np.full(3, 0.5), np.full(3, 4.0)) == 0
    assert (x == before).all()


def test_the_smaller_of_two_that_overlap_moves_more():
    x = np.array([[5.0, 5.0, 5.0], [6.2, 5.0, 5.0]])
    before = x.copy()
    assert pushed(x, np.array([1.0, 0.5]), np.full(3, 10.0)) == 0
    large, small = np.abs(x - before)[:, 0]
    # as the volumes are: 8 to 1
    assert small / large == pytest.approx(8.0, rel=1e-9)
    assert x[1, 0] - x[0, 0] >= 1.5
    assert (x[:, 1:] == before[:, 1:]).all()


@pytest.mark.parametrize("axis", range(3))
def test_two_that_overlap_across_a_periodic_face_are_pushed_apart_through_it(axis):
    x = np.full((2, 3), 3.0)
    x[:, axis] = 0.1, 5.6
    assert pushed(x, np.full(2, 0.5), np.full(3, 6.0), tuple(np.arange(3) == axis)) == 0
    across = (x[0, axis] - x[1, axis]) % 6.0
    assert 1.0 <= across < 1.1
    assert ((x[:, axis] >= 0.0) & (x[:, axis] < 6.0)).all()


def test_no_molecule_is_pushed_through_a_wall():
    random = np.random.default_rng(3)
    x = 0.5 + 3.0 * random.random((20, 3))
    while pushed(x, np.full(20, 0.5), np.full(3, 4.0)):
        assert x.min() >= 0.5
        assert x.max() <= 3.5
    apart = np.linalg.norm(x[:, None] - x[None], axis=2)[np.triu_indices(20, 1)]
    assert apart.min() >= 1.0

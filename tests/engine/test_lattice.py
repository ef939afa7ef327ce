"""Molecules on a lattice: without overlap, inside the box, and denser than any random start."""

import math

import numpy as np
import pytest

from atmosbox.engine import PackingError, lattice_positions


def distances(x, side=None):
    """Return the distances of all pairs, in a periodic cube if its side is given."""
    apart = x[:, None] - x[None]
    if side is not None:
        apart -= side * np.rint(apart / side)
    return np.linalg.norm(apart, axis=2)


def test_a_full_lattice_of_a_periodic_cube_has_twelve_neighbours_at_the_distance_of_the_face_centred_one():
    side = 6.0
    apart = distances(lattice_positions((side,) * 3, np.ones(256), periodic=(True,) * 3), side)
    nearest = side / 4.0 / math.sqrt(2.0)
    assert (np.sum(np.isclose(apart, nearest, rtol=1e-12), axis=1) == 12).all()
    assert apart[np.triu_indices(256, 1)].min() >= nearest * (1.0 - 1e-12)


def test_the_sites_are_chosen_at_random_where_there_are_more_than_molecules():
    arguments = ((8.0, 8.0, 8.0), np.ones(95))
    first = lattice_positions(*arguments)
    one, same, other = (lattice_positions(*arguments, rng=np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert (one == same).all()
    assert (one != other).any()
    assert (one != first).any()
    assert distances(one)[np.triu_indices(95, 1)].min() >= 1.0


def test_what_no_such_lattice_holds_is_refused():
    with pytest.raises(PackingError, match=r"no lattice in this box holds 100 molecules of diameter up to 1 "):
        lattice_positions((4.2, 4.2, 4.2), np.ones(100))

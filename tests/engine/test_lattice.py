"""Molecules on a lattice: without overlap, inside the box, and denser than any random start."""

import math

import numpy as np
import pytest

from atmosbox.engine import PackingError, lattice_positions
from tests.engine.boxes import apart


def test_a_full_lattice_of_a_periodic_cube_has_twelve_neighbours_at_the_distance_of_the_face_centred_one():
    side = 6.0
    x = lattice_positions((side,) * 3, np.ones(256), periodic=(True,) * 3)
    distance = apart(x, x, (side,) * 3, True)
    nearest = side / 4.0 / math.sqrt(2.0)
    assert (np.sum(np.isclose(distance, nearest, rtol=1e-12), axis=1) == 12).all()
    assert distance[np.triu_indices(256, 1)].min() >= nearest * (1.0 - 1e-12)


def test_the_sites_are_chosen_at_random_where_there_are_more_than_molecules():
    arguments = ((8.0, 8.0, 8.0), np.ones(95))
    first = lattice_positions(*arguments)
    one, same, other = (lattice_positions(*arguments, rng=np.random.default_rng(seed)) for seed in (1, 1, 2))
    assert (one == same).all()
    assert (one != other).any()
    assert (one != first).any()
    assert apart(one, one, arguments[0], False)[np.triu_indices(95, 1)].min() >= 1.0


def test_what_no_such_lattice_holds_is_refused():
    with pytest.raises(PackingError, match=r"no lattice in this box holds 100 molecules of diameter up to 1 "):
        lattice_positions((4.2, 4.2, 4.2), np.ones(100))

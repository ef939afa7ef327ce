"""Cells and slots: a sphere is listed in every cell that it overlaps, so two that touch always share one.

Only `choose_grid` and its result are used: for random boxes its tables are compared with plain geometry.
"""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from atmosbox.engine import RefusedError
from atmosbox.engine.exact.cells import choose_grid


def grid_of(
    sides,
    radii,
    *,
    periodic=(False,) * 3,
    molecules=300,
    scale_height=math.inf,
    open_top=False,
    planar=False,
    rows=False,
):
    return choose_grid(
        np.array(sides, np.float64),
        periodic,
        np.array(radii, np.float64),
        molecules,
        exact_radius=len(radii) == 1,
        planar=planar,
        filled=float(sides[2]),
        open_top=open_top,
        scale_height=scale_height,
        rows=rows,
    )


@st.composite
def grids(draw, *, even=False):
    """Return a grid, with the sides, the radii and the periodic axes that it was made for."""
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    sides = random.uniform(5.0, 30.0, 3)
    periodic = tuple(bool(turn) for turn in random.random(3) < 0.5)
    open_top = draw(st.booleans()) and not periodic[2]
    number = draw(st.integers(1, 4))
    radii = np.sort(10.0 ** random.uniform(-1.0, 0.0, number))
    scale_height = math.inf if even or periodic[2] else draw(st.sampled_from([math.inf, 0.2, 3.0, 50.0]))
    molecules = draw(st.sampled_from([1, 20, 300, 5000]))
    rows = draw(st.booleans())
    grid = grid_of(
        sides, radii, periodic=periodic, molecules=molecules, scale_height=scale_height, open_top=open_top, rows=rows
    )
    return grid, sides, radii, periodic


def slots_of(grid, size, axis):
    """Return the boundaries of one axis and, for each slot, the set of cells."""
    number = grid.number[axis]
    boundary = grid.boundary[size, axis]
    if grid.spanning:
        # between walls the outermost boundaries are infinite; the rest of a table is filled with infinity
        last = int(np.isfinite(boundary).sum()) + (-1 if math.isfinite(boundary[0]) else 1)
        first, span = grid.first[size, axis], grid.span[size, axis]
        sets = [[(int(first[s]) + k) % number for k in range(int(span[s]))] for s in range(last)]
    else:
        last = grid.last_slot[axis] + 1
        sets = [[(s // 2 + k) % number for k in range(1 + s % 2)] for s in range(last)]
    return boundary[: last + 1], sets


def cells_at(grid, size, axis, x, length, periodic):
    """Return the set of cells of a molecule whose centre is at x along an axis."""
    boundary, sets = slots_of(grid, size, axis)
    if periodic:
        x -= length * math.floor((x - boundary[0]) / length)
    slot = int(np.searchsorted(boundary, x, side="right")) - 1
    return set(sets[min(max(slot, 0), len(sets) - 1)])


@settings(max_examples=60)
@given(grids(), st.integers(0, 2**32))
def test_two_spheres_that_touch_share_a_cell(made, seed):
    grid, sides, radii, periodic = made
    random = np.random.default_rng(seed)
    for axis in range(3):
        for _ in range(40):
            pair = random.integers(len(radii), size=2)
            point = random.uniform(0.0, sides[axis])
            centres = [point + random.uniform(-1.0, 1.0) * radii[size] for size in pair]
            if not periodic[axis]:
                centres = [float(np.clip(x, r, sides[axis] - r)) for x, r in zip(centres, radii[pair], strict=True)]
                assume(all(abs(point - x) <= r for x, r in zip(centres, radii[pair], strict=True)))
            first, second = (
                cells_at(grid, size, axis, x, sides[axis], periodic[axis])
                for size, x in zip(pair, centres, strict=True)
            )
            assert first & second


def check_boundaries(grid, sizes):
    """Check that at each boundary a molecule enters or leaves exactly one cell, as the engine assumes."""
    for size in range(sizes):
        for axis in range(3):
            boundary, sets = slots_of(grid, size, axis)
            assert (boundary[1:] >= boundary[:-1]).all()
            wraps = len(sets) == 2 * grid.number[axis]
            after = [*sets[1:], sets[0]] if wraps else sets[1:]
            for here, there in zip(sets, after, strict=False):
                if len(there) > len(here):
                    assert there[:-1] == here
                else:
                    assert here[1:] == there
                    assert len(here) == len(there) + 1


@settings(max_examples=100)
@given(grids())
def test_a_boundary_is_the_entry_into_one_cell_or_the_way_out_of_one(made):
    grid, _, radii, _ = made
    check_boundaries(grid, len(radii))


@pytest.mark.parametrize("share", [0.0, 1e-300, 1e-13, 0.25, 0.5, 1.0, 1.5])
@pytest.mark.parametrize("periodic", [(False,) * 3, (True,) * 3])
@pytest.mark.parametrize("margin", [0.0, 1e-7])
def test_boundaries_are_right_for_spheres_that_just_fit_their_cells(share, periodic, margin):
    # a radius of half a cell, or a whole one, makes boundaries coincide
    sides = (24.0, 24.0, 24.0)
    width = 24.0 / grid_of(sides, [0.1, 0.3], periodic=periodic, molecules=4000).number[0]
    grid = grid_of(sides, [0.1, share * width / (1.0 + margin)], periodic=periodic, molecules=4000)
    check_boundaries(grid, 2)


@pytest.mark.parametrize("axis", range(3))
def test_a_periodic_box_of_two_diameters_is_allowed_and_a_shorter_one_is_refused(axis):
    walls, sides = np.arange(3) == axis, np.full(3, 5.0)
    sides[axis] = 2.0
    grid = grid_of(sides, [0.5], periodic=tuple(walls), molecules=2)
    assert grid.number[axis] == 3
    assert grid.images
    sides[axis] = 1.999
    with pytest.raises(RefusedError, match=rf"along {'xyz'[axis]} is too short"):
        grid_of(sides, [0.5], periodic=tuple(walls), molecules=2)


@pytest.mark.parametrize(("to_a_cell", "rows"), [(17.9, True), (18.1, False)])
def test_cells_that_large_spheres_make_wide_hold_lists_where_a_row_might_overflow(to_a_cell, rows):
    # four cells of five diameters along each side, and a moving molecule is in the rows of two cells on average
    grid = grid_of((20.0, 20.0, 20.0), (0.1, 2.0), molecules=round(to_a_cell * 64), rows=True)
    assert grid.rows == rows
    assert not rows or grid.number == (4, 4, 4)

"""Cells and slots: a sphere is listed in every cell that it overlaps, so two that touch always share one.

Only `choose_grid` and its result are used: for random boxes its tables are compared with plain geometry.
"""

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from atmosbox.engine import RefusedError
from atmosbox.engine.exact.cells import append, choose_grid, remove, size_classes

MARGIN = 1e-6  # how much larger than its sphere a molecule may be treated, in radii


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


@settings(max_examples=60)
@given(grids(even=True), st.integers(0, 2**32))
def test_a_sphere_is_listed_in_the_cells_that_it_overlaps_and_in_no_other(made, seed):
    grid, sides, radii, periodic = made
    random = np.random.default_rng(seed)
    for axis in range(3):
        number, width = grid.number[axis], sides[axis] / grid.number[axis]
        for _ in range(40):
            size = int(random.integers(len(radii)))
            r = radii[size]
            low, high = (0.0, sides[axis]) if periodic[axis] else (r, sides[axis] - r)
            x = random.uniform(low, high)

            def overlapped(reach, x=x, number=number, width=width, wraps=periodic[axis]):
                cells = range(math.floor((x - reach) / width), math.floor((x + reach) / width) + 1)
                return {c % number if wraps else min(max(c, 0), number - 1) for c in cells}

            listed = cells_at(grid, size, axis, x, sides[axis], periodic[axis])
            assert overlapped(r) <= listed <= overlapped(r * (1.0 + MARGIN))


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


@given(grids())
def test_cells_are_few_enough_and_slots_can_be_counted(made):
    grid, _, _, _ = made
    assert 1 <= math.prod(grid.number) < 10_000
    assert grid.boundary.shape[2] <= 65_535


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


@pytest.mark.parametrize("side", [2.0, 2.3, 3.0, 5.0, 50.0])
def test_two_molecules_need_no_more_than_a_few_cells(side):
    assert math.prod(grid_of((side,) * 3, [0.5], periodic=(True,) * 3, molecules=2).number) <= 64


def test_points_need_no_more_than_the_fewest_cells():
    assert grid_of((4.0, 4.0, 4.0), [0.0], molecules=1).number == (1, 1, 1)
    assert math.prod(grid_of((4.0, 4.0, 4.0), [0.0], periodic=(True,) * 3, molecules=1).number) <= 27


def test_gravity_makes_the_lowest_layers_the_thinnest():
    grid = grid_of((10.0, 10.0, 40.0), [0.05], molecules=4000, scale_height=5.0)
    middles = grid.boundary[0, 2][1 : 2 * grid.number[2] - 1].reshape(-1, 2).mean(axis=1)
    layers = np.diff(np.array([0.0, *middles, 40.0]))
    assert layers[-1] > 2.0 * layers[0]


def test_sizes_that_differ_by_less_than_a_tenth_share_a_table():
    radii = 10.0 ** np.random.default_rng(3).uniform(-2.0, 1.0, 500)
    classes, tops = size_classes(radii)
    assert (tops[classes] >= radii).all()
    assert (tops[classes] <= 1.1 * radii * (1 + 1e-12)).all()
    assert len(tops) < 80


def test_a_cell_lists_what_was_added_until_it_is_removed():
    random = np.random.default_rng(8)
    stride, cells = 16, 6
    row = np.zeros(stride * cells, np.uint32)
    truth = [set() for _ in range(cells)]
    for _ in range(2000):
        cell, i = int(random.integers(cells)), int(random.integers(40))
        if i in truth[cell]:
            remove(row, cell * stride, i)
            truth[cell].remove(i)
        elif len(truth[cell]) < stride - 1:
            append(row, cell * stride, i)
            truth[cell].add(i)
        listed = row[cell * stride + 1 : cell * stride + 1 + row[cell * stride]]
        assert sorted(listed.tolist()) == sorted(truth[cell])


@pytest.mark.parametrize(("to_a_cell", "rows"), [(17.9, True), (18.1, False)])
def test_cells_that_large_spheres_make_wide_hold_lists_where_a_row_might_overflow(to_a_cell, rows):
    # four cells of five diameters along each side, and a moving molecule is in the rows of two cells on average
    grid = grid_of((20.0, 20.0, 20.0), (0.1, 2.0), molecules=round(to_a_cell * 64), rows=True)
    assert grid.rows == rows
    assert not rows or grid.number == (4, 4, 4)

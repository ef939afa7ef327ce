"""The cells that compiled code lays out under a piston are those that Python chooses, to the last bit."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.cells import choose_grid
from atmosbox.engine.exact.laying_out import LAST, NUMBER, choose_cells, write_cells, write_layers
from atmosbox.lab.bench import bench
from atmosbox.simulation.preparation import prepare


@pytest.fixture(scope="module")
def box():
    return bench(prepare("lifting-dry", {"molecules": 300}))


@pytest.fixture(scope="module")
def writers(box):
    """Return what writes the cells of molecules that are alike, and of those that are not."""

    def writer(modes):
        return kernel(lambda gas, layout: write_cells(gas, layout, modes))

    return [writer(box.modes._replace(mixed=mixed)) for mixed in (False, True)]


def roomy(box, most=400):
    """Return gas and layout of a box with memory for many cells."""
    copies = box.gas.cells.copies._replace(
        centre=np.zeros((3, most)), slack=np.zeros((most, 3)), room=np.zeros(most), horizon=np.zeros(most)
    )
    gas = box.gas._replace(cells=box.gas.cells._replace(boundary=np.zeros((1, 3, 2 * most)), copies=copies))
    return gas, box.layout._replace(edge=np.zeros((3, most + 1)), shape=box.layout.shape.copy(), radii=np.array([0.5]))


@settings(max_examples=60)
@given(
    molecules=st.integers(50, 200_000),
    filling=st.floats(0.0005, 0.3),
    stretch=st.floats(0.2, 5.0),
    lean=st.floats(0.5, 2.0),
    turns=st.booleans(),
    mixed=st.booleans(),
)
def test_the_cells_are_those_of_python(box, writers, molecules, filling, stretch, lean, turns, mixed):
    radius = 0.5
    volume = molecules * math.pi / 6.0 / filling
    side = (volume / stretch) ** (1.0 / 3.0)
    x, y, filled = side * lean + 1.0, side / lean + 1.0, side * stretch + 1.0
    grid = choose_grid(
        np.array([x, y, 1.75 * filled]), (turns, False, False), np.array([radius]), molecules, exact_radius=not mixed,
        planar=False, filled=filled, open_top=True, scale_height=math.inf, rows=True,
    )  # fmt: skip
    gas, layout = roomy(box)
    gas = gas._replace(box=gas.box._replace(length_x=x, length_y=y, inverse_x=1.0 / x if turns else 0.0))
    possible = choose_cells(filled, molecules, gas.box, layout)
    assert possible == grid.rows
    if not possible or max(grid.number) >= 390:
        return
    writers[mixed](gas, layout)
    assert tuple(layout.shape[NUMBER:LAST]) == grid.number
    assert tuple(layout.shape[LAST:]) == grid.last_slot
    for axis in range(3):
        slots = grid.last_slot[axis] + 2
        np.testing.assert_array_equal(gas.cells.boundary[0, axis, :slots], grid.boundary[0, axis, :slots])
    # what copies must know follows from the edges alone: those of numpy give the same
    edge = np.zeros_like(layout.edge)
    for axis in range(3):
        edge[axis, : grid.number[axis] + 1] = grid.edges[axis]
    tables = gas.cells.copies._replace(
        centre=np.zeros((3, 400)), slack=np.zeros((grid.number[2], 3)), room=np.zeros(grid.number[2])
    )
    write_layers(gas.box, layout._replace(edge=edge), tables)
    copies, layers = gas.cells.copies, grid.number[2]
    np.testing.assert_array_equal(copies.centre, tables.centre)
    np.testing.assert_array_equal(copies.slack[:layers], tables.slack)
    np.testing.assert_array_equal(copies.room[:layers], tables.room)
    width = np.diff(edge[2, : layers + 1])
    np.testing.assert_allclose(copies.room[:layers], x * y * width, rtol=1e-14)
    assert np.isposinf(copies.slack[layers:]).all()  # of layers that are not there

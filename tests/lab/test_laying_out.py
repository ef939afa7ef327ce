"""The cells that a page lays out under its piston are those of Python, to the last bit."""

import functools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.cells import choose_grid
from atmosbox.engine.exact.rows import copies_of
from atmosbox.lab.kernels.laying_out import LAST, NUMBER, choose_cells, write_cells
from atmosbox.lab.lab_box import lab_box
from atmosbox.simulation.preparation import prepare


@pytest.fixture(scope="module")
def box():
    return lab_box(prepare("lifting-dry", {"molecules": 300}))


@functools.cache
def writer(modes):
    """Return the kernel for one set of modes: kernels take them as constants."""

    @kernel
    def write(gas, layout):
        write_cells(gas, layout, modes)

    return write


def roomy(box, most=400):
    """Return gas and layout of a box with memory for many cells."""
    copies = box.gas.cells.copies._replace(
        centre=np.zeros((3, most)), slack=np.zeros((most, 3)), room=np.zeros(most), horizon=np.zeros(most)
    )
    gas = box.gas._replace(cells=box.gas.cells._replace(boundary=np.zeros((1, 3, 2 * most)), copies=copies))
    return gas, box.layout._replace(edge=np.zeros((3, most + 1)), shape=box.layout.shape.copy())


@settings(max_examples=60)
@given(
    molecules=st.integers(50, 200_000),
    filling=st.floats(0.0005, 0.3),
    stretch=st.floats(0.2, 5.0),
    lean=st.floats(0.5, 2.0),
    mixed=st.booleans(),
)
def test_the_cells_are_those_of_python(box, molecules, filling, stretch, lean, mixed):
    radius = 0.5
    volume = molecules * math.pi / 6.0 / filling
    side = (volume / stretch) ** (1.0 / 3.0)
    x, y, filled = side * lean + 1.0, side / lean + 1.0, side * stretch + 1.0
    grid = choose_grid(
        np.array([x, y, 1.75 * filled]), (False, False, False), np.array([radius]), molecules, exact_radius=not mixed,
        planar=False, filled=filled, open_top=True, scale_height=math.inf, rows=True,
    )  # fmt: skip
    gas, layout = roomy(box)
    gas = gas._replace(box=gas.box._replace(length_x=x, length_y=y))
    possible = choose_cells(filled, molecules, gas.box, layout)
    assert possible == grid.rows
    if not possible or max(grid.number) >= 390:
        return
    writer(box.modes._replace(mixed=mixed))(gas, layout)
    assert tuple(layout.shape[NUMBER:LAST]) == grid.number
    assert tuple(layout.shape[LAST:]) == grid.last_slot
    for axis in range(3):
        slots = grid.last_slot[axis] + 2
        np.testing.assert_array_equal(gas.cells.boundary[0, axis, :slots], grid.boundary[0, axis, :slots])
    events = np.zeros(1, box.gas.events.dtype)
    copies = copies_of(
        np.zeros(32, np.uint32), events, grid.edges, (False, False, False), radius, 1.0, planar=False
    )  # fmt: skip
    layers = grid.number[2]
    for axis in range(3):
        n = grid.number[axis]
        np.testing.assert_array_equal(gas.cells.copies.centre[axis, :n], copies.centre[axis, :n])
    np.testing.assert_array_equal(gas.cells.copies.slack[:layers], copies.slack)
    np.testing.assert_array_equal(gas.cells.copies.room[:layers], copies.room)
    assert np.isposinf(gas.cells.copies.slack[layers:]).all()  # of layers that do not exist

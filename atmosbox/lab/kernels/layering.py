"""Layers of cells that hold about equally many molecules of an isothermal column: see `cells._layers`.

How thick they are depends on the temperature that the molecules have at the start, to its last digit, and so on the
seed. All other cells of a column are the same for every seed.
"""

from typing import Any, NamedTuple

from atmosbox.engine.core.elementary import expm1
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.exact.glance import CLOSING, DISTANCE, SLACK, SQUARE

__all__ = ["Column", "write_layers"]

_STEPS = 20_000
_MARGIN = 1.0 + 1e-7


class Column(NamedTuple):
    """What decides on the layers of a column, beside its temperature.

    ``height`` of the box, ``weight`` of a molecule [force], ``bath`` the temperature of the warmest wall [energy],
    ``wanted`` how many layers are asked for, ``thinnest`` of them [length]; ``around`` how far a member of a cell can
    be from its centre along x or y [length], ``area`` of the box [length^2], ``radius`` of all molecules [length];
    ``edge : (layer + 1,)`` memory for the edges [length].
    """

    height: float
    weight: float
    bath: float
    wanted: int
    thinnest: float
    around: float
    area: float
    radius: float
    edge: Any


@kernel
def _place(k, height):
    """Return a height of the table."""
    return height if k == _STEPS else k * (height / _STEPS)


@kernel
def _below(k, a, height):
    """Return which share of the molecules is below a height of the table, a tenth of them spread evenly."""
    z = _place(k, height)
    return 0.9 * expm1(-a * z / height) / expm1(-a) + 0.1 * z / height


@kernel
def _edges(scale_height, column):
    """Write the edges of the layers; tell whether there are as many of them as there is memory for."""
    height, edge = column.height, column.edge
    a = min(height / scale_height, 700.0)
    found = 1
    edge[0] = 0.0
    for j in range(1, column.wanted):
        share = j * (1.0 / column.wanted)
        lower, upper = 0, _STEPS + 1
        while upper - lower > 1:
            middle = (lower + upper) >> 1
            if _below(middle, a, height) <= share:
                lower = middle
            else:
                upper = middle
        z, under = _place(lower, height), _below(lower, a, height)
        z += (_place(lower + 1, height) - z) * ((share - under) / (_below(lower + 1, a, height) - under))
        if z - edge[found - 1] >= column.thinnest and height - z >= column.thinnest:
            if found == edge.size - 1:
                return False
            edge[found] = z
            found += 1
    edge[found] = height
    return found == edge.size - 1


@kernel
def write_layers(kT, gas, column):
    """Write the layers for molecules of a temperature [energy]; tell whether there are as many as before."""
    if not _edges(max(kT, column.bath) / column.weight, column):
        return False
    boundary, copies, edge = gas.cells.boundary, gas.cells.copies, column.edge
    number = edge.size - 1
    reach = column.radius * _MARGIN
    boundary[0, 2, 0] = column.radius
    boundary[0, 2, 2 * number - 1] = column.height - column.radius
    for k in range(1, number):
        boundary[0, 2, 2 * k - 1] = edge[k] - reach
        boundary[0, 2, 2 * k] = edge[k] + reach
    for k in range(number):
        width = edge[k + 1] - edge[k]
        beside = edge[k] - edge[k - 1] if k > 0 else 0.0
        if k < number - 1:
            beside = max(beside, edge[k + 2] - edge[k + 1])
        layer = max(0.5 * width + beside, column.around)
        copies.centre[2, k] = 0.5 * (edge[k + 1] + edge[k])
        copies.slack[k, DISTANCE] = SLACK * layer
        copies.slack[k, SQUARE] = SLACK * layer * layer
        copies.slack[k, CLOSING] = 4.0 * SLACK * layer
        copies.room[k] = column.area * width
    return True

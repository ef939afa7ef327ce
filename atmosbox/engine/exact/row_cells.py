"""Cells whose rows hold copies of trajectories: their number along each axis, and the boundaries of their slots.

They are wider than any molecule. Python runs these functions as they are written, when it lays out a box; the kernels
of the lab's page, which lays out its boxes itself, compile them.
"""

import math

from atmosbox.engine.core.elementary import expm1, log, root
from atmosbox.engine.core.jit import kernel

MARGIN = 1.0 + 1e-7
"""How much larger than its sphere a molecule is assumed to be."""
MOST_CELLS = 20_000
"""Largest number of cells along an axis."""
TALLER = 1.75
"""Height of the cells under a moving ceiling, relative to the height of the ceiling when they are laid out."""
_CROWD = 18.0
"""Largest mean number of molecules per cell with which rows may hold copies.

A molecule stays in the row of the cell that it comes from until its next event: where it flies across many cells, it is
in two rows on average. So a row holds 36 on average, and its 64 places leave room for fluctuations: 36 plus four times
its root is 60.
"""
_STEPS = 20_000
_EVENLY = 0.1
"""Fraction of all molecules that is assumed to be spread evenly over the height, wherever they are."""
_EMPTIER = 0.8
"""Layers that follow the molecules are used if the fullest then has less than this fraction of the fullest before."""


@kernel(plain=True)
def filled_share(x, y, z, radius, molecules, planar):
    """Return the fraction of a box that ``molecules`` spheres, or discs, of a radius fill."""
    size = math.pi * radius * radius * (1.0 if planar else 4.0 / 3.0 * radius)
    return molecules * size / (x * (1.0 if planar else y) * z)


@kernel(plain=True)
def cell_widths(x, y, z, cells, planar):
    """Return the width along each axis of ``cells`` cells, as cubic as possible; a shorter axis has one cell.

    >>> [float(width) for width in cell_widths(8.0, 8.0, 1.0, 4, False)]
    [4.0, 4.0, 1.0]
    """
    free_x, free_y, free_z = True, not planar, True
    while True:
        room = (x if free_x else 1.0) * (y if free_y else 1.0) * (z if free_z else 1.0)
        size = root(room / max(1.0, cells), int(free_x) + int(free_y) + int(free_z))
        wide_x, wide_y, wide_z = free_x and x >= size, free_y and y >= size, free_z and z >= size
        if wide_x == free_x and wide_y == free_y and wide_z == free_z:
            return size if free_x else x, size if free_y else y, size if free_z else z
        free_x, free_y, free_z = wide_x, wide_y, wide_z


@kernel(plain=True)
def widths_for_rows(x, y, z, radius, molecules, planar):
    """Return the intended widths of cells for molecules of a radius: eight to ten molecules to a cell."""
    # measured at packing fractions of .01, .1, .3 and .49: fewer lose, more gain in large boxes and lose in small ones
    filled = filled_share(x, y, z, radius, molecules, planar)
    return cell_widths(x, y, z, molecules / (9.0 if filled < 0.05 else 8.0 if filled < 0.2 else 10.0), planar)


@kernel(plain=True)
def _nearest(length, width, widest, periodic, above):
    """Return the number of cells next below, or above, that with the intended width; 0 if none is possible."""
    step, least = (2, 4) if periodic else (1, 1)
    top = min(step * math.floor(length / (2.002 * widest) / step), MOST_CELLS)
    if top < least:
        return 0
    return min(max(step * math.floor(length / width / step) + (step if above else 0), least), top)


@kernel(plain=True)
def cell_numbers(length, filled, radii, molecules, periodic, planar):
    """Return the numbers of cells along the axes that come nearest to the intended widths; zeros if there are none.

    ``length`` is the extent of the cells along x, y and z, ``filled`` the height up to which there are molecules now
    [length]; ``radii`` are those of the smallest and of the largest molecule [length].
    """
    x, y, z = length[0], length[1], length[2]
    found = (0, 0, 0)
    if min(x, y, filled) < 1e-6 or max(x, y, z) > 1e6:
        return found  # single precision would need other units
    width = widths_for_rows(x, y, filled, radii[0], molecules, planar)
    widest = radii[1] * MARGIN
    wanted = x / width[0] * (1.0 if planar else y / width[1]) * (z / width[2])
    best = math.inf
    for k in range(8):
        nx = _nearest(x, width[0], widest, periodic[0], k & 4)
        ny = 1 if planar else _nearest(y, width[1], widest, periodic[1], k & 2)
        nz = _nearest(z, width[2], widest, periodic[2], k & 1)
        if nx * ny * nz == 0:
            return found
        # the deviations from the intended number of cells and from the intended shape
        a, b, c = log(nx * width[0] / x), log(ny * width[1] / y), log(nz * width[2] / z)
        mean = (a + b + c) / 3.0
        a, b, c = a - mean, b - mean, c - mean
        misfit = abs(log(nx * ny * nz / max(wanted, 1.0))) + 0.5 * math.sqrt((a * a + b * b + c * c) / 3.0)
        if misfit < best:
            best = misfit
            found = (nx, ny, nz)
    return found if molecules / (found[0] * found[1] * found[2]) <= _CROWD else (0, 0, 0)


@kernel(plain=True)
def write_slots(edge, radius, periodic, mixed, opens, boundary):
    """Write the boundaries of the slots along one axis for molecules of a radius; return the last slot.

    If molecules of several kinds are ``mixed``, walls are not in the table: each molecule hits them at its own radius.
    On an axis that ``opens``, a molecule beyond the last edge has left the cells.
    """
    n = edge.size - 1
    length, reach = edge[n], radius * MARGIN
    for k in range(1, n):
        boundary[2 * k - 1] = edge[k] - reach
        boundary[2 * k] = edge[k] + reach
    if periodic:
        boundary[0] = reach
        boundary[2 * n - 1] = length - reach
        # one period further: the first boundary, and the one after it
        boundary[2 * n] = reach + length
        boundary[2 * n + 1] = boundary[1] + boundary[2 * n] - reach
        return 2 * n - 1
    boundary[0] = -math.inf if mixed else radius
    boundary[2 * n - 1] = length if opens else (math.inf if mixed else length - radius)
    return 2 * n - 2


@kernel(plain=True)
def write_layers(height, wanted, scale_height, thinnest, edge):
    """Write the edges of layers that hold about equal numbers of molecules of an isothermal column; return how many.

    There are ``wanted`` layers, or fewer so that none is thinner than ``thinnest`` [length]; 0 if the memory is too
    short for them.
    """
    # a table of heights; where the air is shallow, it begins with as many steps close to the floor
    shallow = min(40.0 * scale_height, height / 2) if scale_height < height / 5_000 else 0.0
    begin, first = _STEPS, 0
    if shallow > 0.0:
        begin, first = 0, math.ceil(shallow / height * _STEPS) - 1
        while first * (height / _STEPS) < shallow:
            first += 1
    whole = expm1(-height / scale_height if shallow > 0.0 else -min(height / scale_height, 700.0))
    found = 1
    edge[0] = 0.0
    for j in range(1, wanted):
        share = j * (1.0 / wanted)
        lower, upper = begin, 2 * _STEPS + 1 - first
        while upper - lower > 1:
            middle = (lower + upper) >> 1
            z = _height(middle, height, shallow, first)
            if _share_below(z, height, scale_height, shallow, whole) <= share:
                lower = middle
            else:
                upper = middle
        z, above = _height(lower, height, shallow, first), _height(upper, height, shallow, first)
        under = _share_below(z, height, scale_height, shallow, whole)
        z += (above - z) * ((share - under) / (_share_below(above, height, scale_height, shallow, whole) - under))
        if z - edge[found - 1] >= thinnest and height - z >= thinnest:
            if found == edge.size - 1:
                return 0
            edge[found] = z
            found += 1
    edge[found] = height
    return found


@kernel(plain=True)
def _height(k, height, shallow, first):
    """Return height k of the table: even steps up to ``shallow``, then steps of the whole height from ``first`` on."""
    if k < _STEPS:
        return k * (shallow / _STEPS)
    k += first - _STEPS
    return height if k == _STEPS else k * (height / _STEPS)


@kernel(plain=True)
def _share_below(z, height, scale_height, shallow, whole):
    """Return the fraction of the molecules below a height, some of them spread evenly; see `write_layers`."""
    depth = z / scale_height if shallow > 0.0 else min(height / scale_height, 700.0) * z / height
    return (1.0 - _EVENLY) * expm1(-depth) / whole + _EVENLY * z / height


@kernel(plain=True)
def write_even_layers(count, old, wanted, thinnest, edge):
    """Write the edges of layers that hold about equal numbers of the present molecules; return the number of layers.

    ``count : (layer,)`` are the numbers of molecules in the layers with the edges ``old : (layer + 1,)`` [length], in
    each of which they are assumed to be spread evenly. As in `write_layers` there are ``wanted`` layers, or fewer so
    that none is thinner than ``thinnest`` [length]; 0 if the memory is too short for them, or if the fullest layer
    would be nearly as full as before.

    >>> import numpy as np
    >>> edge = np.zeros(6)
    >>> write_even_layers(np.array([6, 2]), np.array([0.0, 1.0, 2.0]), 4, 0.0, edge)
    4
    >>> edge.round(2).tolist()
    [0.0, 0.34, 0.69, 1.09, 2.0, 0.0]
    >>> write_even_layers(np.array([5, 4]), np.array([0.0, 1.0, 2.0]), 2, 0.0, edge)
    0
    """
    last = count.size - 1
    height = old[last + 1]
    number, most = 0, 0
    for each in count:
        number += each
        most = max(most, each)
    # molecules below a height (passed), below the last edge (under), and in the fullest of the new layers
    passed, under, fullest = 0, 0.0, 0.0
    found, k, below = 1, 0, 0.0
    share = (1.0 - _EVENLY) * count[0] / number + _EVENLY * (old[1] - old[0]) / height
    edge[0] = 0.0
    for j in range(1, wanted):
        goal = j / wanted
        while k < last and below + share <= goal:
            below += share
            passed += count[k]
            k += 1
            share = (1.0 - _EVENLY) * count[k] / number + _EVENLY * (old[k + 1] - old[k]) / height
        part = (goal - below) / share
        z = old[k] + part * (old[k + 1] - old[k])
        if z - edge[found - 1] >= thinnest and height - z >= thinnest:
            if found == edge.size - 1:
                return 0
            edge[found] = z
            found += 1
            fullest = max(fullest, passed + part * count[k] - under)
            under = passed + part * count[k]
    edge[found] = height
    return found if max(fullest, number - under) < _EMPTIER * most else 0

"""Which molecules overlap: a search of half of each molecule's neighbourhood.

Cells are at least as wide as the largest molecule, so two molecules that overlap are in the same cell or in
adjacent ones, and molecules are sorted by cell (`filing`). Each molecule is compared with those that follow it in its
own row and with those in the four rows that follow its own, above and behind; those that precede it have been compared
already. In each of these rows eight are compared at a time, in single precision.
"""

import numpy as np

from atmosbox.engine.core.jit import kernel, lowest_bit
from atmosbox.engine.core.pair import nearest_image
from atmosbox.engine.stepped.window import LANES, within

__all__ = ["find_pairs"]


@kernel
def _search_closely(q, where, reach, radius, pairs, found, gas, modes):
    """Store every later neighbour of record q within reach; return the number of pairs stored so far.

    ``where`` is its cell along x, y and z, and the number of layers of cells.
    """
    ix, iy, iz, layers = where
    records, grid, box = gas.records, gas.grid, gas.box
    at_x = records.x[q]
    at_y = records.y[q]
    at_z = records.z[q]
    for dz in range(2):
        for dy in range(-dz, 2):
            jz = iz + dz
            jy = iy + dy
            if jz == layers:
                if not grid.wraps_z:
                    continue
                jz = 0
            if jy < 0 or jy == grid.number_y:
                if not grid.wraps_y:
                    continue
                jy += grid.number_y if jy < 0 else -grid.number_y
            row = (jz * grid.number_y + jy) * grid.number_x
            own = dz == 0 and dy == 0
            for turn in range(2):
                left = max(ix - 1, 0)
                right = min(ix + 1, grid.number_x - 1)
                if turn == 1:  # the cell on the far side, where a periodic row continues
                    if not grid.wraps_x or (ix > 0 and ix < grid.number_x - 1) or (own and ix == 0):
                        break
                    left = right = 0 if ix > 0 else grid.number_x - 1
                first = q + 1 if own and turn == 0 else np.int64(records.start[row + left])
                for r in range(first, np.int64(records.start[row + right + 1])):
                    k = r & 0x7FFFFFFF
                    rx, ry, rz = nearest_image(
                        records.x[k] - at_x, records.y[k] - at_y, records.z[k] - at_z, box, modes
                    )
                    near = reach
                    if radius is not None:
                        near = near + radius[k]
                    if rx * rx + ry * ry + rz * rz < near * near:
                        if found < pairs.shape[0]:
                            pairs[found, 0] = records.slot[q]
                            pairs[found, 1] = records.slot[k]
                        found += 1
    return found


@kernel
def _row(grid, iy, iz, layers, cells, shift_y, shift_z):
    """Return where a row of cells begins, and the shifts along y and z that bring the searcher next to that row."""
    y = np.float32(0.0)
    z = np.float32(0.0)
    if iz == layers:
        if not grid.wraps_z:
            return cells, y, z
        iz = 0
        z = shift_z
    if iy < 0 or iy == grid.number_y:
        if not grid.wraps_y:
            return cells, y, z
        y = -shift_y if iy < 0 else shift_y
        iy = grid.number_y - 1 if iy < 0 else 0
    return (iz * grid.number_y + iy) * grid.number_x, y, z


@kernel
def _glance(records, radius, first, at_x, y, z, reach):
    """Return which records are within reach in five stretches of records, each with its own `LANES` bits of the answer.

    ``first``, ``y``, ``z`` are five numbers each: where a stretch begins, and the shifted coordinates of the searcher.
    """
    xs, ys, zs = records.x, records.y, records.z
    return (
        within(xs, ys, zs, radius, first[0], at_x, y[0], z[0], reach)
        | within(xs, ys, zs, radius, first[1], at_x, y[1], z[1], reach) << LANES
        | within(xs, ys, zs, radius, first[2], at_x, y[2], z[2], reach) << 2 * LANES
        | within(xs, ys, zs, radius, first[3], at_x, y[3], z[3], reach) << 3 * LANES
        | within(xs, ys, zs, radius, first[4], at_x, y[4], z[4], reach) << 4 * LANES
    )


@kernel
def find_pairs(part, first, last, layers, slack, radius, gas, modes):
    """Find all pairs nearer than their mean diameter plus a slack whose earlier record is in a part of the records.

    Parameters
    ----------
    part, first, last
        The part, and its records ``first`` to ``last - 1``. Its row of ``gas.pairs`` is filled with slots, in the order
        of the records.
    layers
        Number of layers of cells now.
    slack
        An upper limit of the error of a distance in single precision [length].
    radius
        Radius of the records; None if all are equal.
    gas, modes
        The data of the engine, see `atmosbox.engine.stepped.stepped.Filed`; the flags of the scene.

    Returns
    -------
    int
        Number of pairs; larger than ``pairs`` if that array is too short.
    """
    records, grid, box, pairs = gas.records, gas.grid, gas.box, gas.pairs[part]
    found = 0
    if first >= last:
        return found
    end = np.int64(records.slot.size)
    number_x = np.int64(grid.number_x)
    cells = number_x * grid.number_y * layers
    end_x = number_x - 1
    x = records.x
    y = records.y
    z = records.z
    start = records.start
    common = np.float32(grid.reach + slack)
    shift_y = np.float32(-box.length_y)
    shift_z = np.float32(-box.length_z)
    for row in range(np.int64(records.cell[first]) // number_x, np.int64(records.cell[last - 1]) // number_x + 1):
        iz = row // grid.number_y
        iy = row - iz * grid.number_y
        own = row * number_x
        behind, behind_y, _ = _row(grid, iy + 1, iz, layers, cells, shift_y, shift_z)
        low, low_y, low_z = _row(grid, iy - 1, iz + 1, layers, cells, shift_y, shift_z)
        above, _, above_z = _row(grid, iy, iz + 1, layers, cells, shift_y, shift_z)
        high, high_y, high_z = _row(grid, iy + 1, iz + 1, layers, cells, shift_y, shift_z)
        for r in range(max(np.int64(start[own]), first), min(np.int64(start[own + number_x]), last)):
            q = r & 0x7FFFFFFF
            ix = np.int64(records.cell[q]) - own
            left = max(ix - 1, 0)
            right = min(ix + 1, end_x) + 1
            at_x = x[q]
            at_y = y[q]
            at_z = z[q]
            reach = common
            if radius is not None:
                reach = reach + radius[q]
            a = q + 1
            a_end = np.int64(start[np.uint32(own + right)])
            b = np.int64(start[np.uint32(behind + left)])
            b_end = np.int64(start[np.uint32(behind + right)])
            c = np.int64(start[np.uint32(low + left)])
            c_end = np.int64(start[np.uint32(low + right)])
            d = np.int64(start[np.uint32(above + left)])
            d_end = np.int64(start[np.uint32(above + right)])
            e = np.int64(start[np.uint32(high + left)])
            e_end = np.int64(start[np.uint32(high + right)])
            longest = max(max(a_end - a, b_end - b), max(c_end - c, d_end - d), e_end - e)
            if modes.periodic and (not grid.simple or (grid.wraps_x and (ix == 0 or ix == end_x))):
                found = _search_closely(q, (ix, iy, iz, layers), reach, radius, pairs, found, gas, modes)
                continue
            b_y = at_y + behind_y if modes.periodic else at_y
            c_y, c_z = (at_y + low_y, at_z + low_z) if modes.periodic else (at_y, at_z)
            d_z = at_z + above_z if modes.periodic else at_z
            e_y, e_z = (at_y + high_y, at_z + high_z) if modes.periodic else (at_y, at_z)
            from_y = (at_y, b_y, c_y, at_y, e_y)
            from_z = (at_z, at_z, c_z, d_z, e_z)
            bits = _glance(records, radius, (a, b, c, d, e), at_x, from_y, from_z, reach)
            beyond = 0
            while True:
                while bits != 0:
                    bit = lowest_bit(bits)
                    bits &= bits - 1
                    window = bit // LANES
                    begin, stop = (a, a_end) if window == 0 else ((b, b_end) if window == 1 else (c, c_end))
                    if window > 2:
                        begin, stop = (d, d_end) if window == 3 else (e, e_end)
                    k = begin + beyond + bit % LANES
                    if k < stop:
                        if found < pairs.shape[0]:
                            pairs[found, 0] = records.slot[q]
                            pairs[found, 1] = records.slot[k & 0x7FFFFFFF]
                        found += 1
                beyond += LANES
                if beyond >= longest:
                    break
                # results beyond the end of a row, and of all rows, are ignored
                begin_a, begin_b, begin_c = min(a + beyond, end), min(b + beyond, end), min(c + beyond, end)
                further = (begin_a, begin_b, begin_c, min(d + beyond, end), min(e + beyond, end))
                bits = _glance(records, radius, further, at_x, from_y, from_z, reach)
    return found

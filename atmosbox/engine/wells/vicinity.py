r"""The vicinity of a molecule: a list of the neighbours it can meet soon, and for each, whether it is inside the well.

Every molecule has a **shell**, a sphere about the place where it was when its list was made (its anchor). While both
are within their shells, two molecules whose anchors are farther apart than

.. math:: \lambda\sigma + s_i + s_j

cannot reach the edge of each other's well. So the list of a molecule holds those that are nearer, and it searches for
contacts among them alone. When a molecule leaves its shell, its list is made again; the lists of the others are changed
with it, so that either both molecules of a pair list each other or neither does. A shell is narrow where molecules are
crowded, and wide in a thin gas::

    list of i    | n | 2 j + 1 | 2 k | ...        j is in the well of i, k is near but outside

The last bit of an entry remembers whether the pair is inside its well: only an event of the pair changes it, in both
lists.

Anchors are sorted into cells, each a linked chain of molecules, which are searched when a list is made.

References
----------
Smallenburg, F. (2022), doi:10.1140/epje/s10189-022-00180-8 (lists of neighbours in event-driven dynamics).
"""

import math
from collections import namedtuple

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.elementary import root
from atmosbox.engine.core.jit import POSITIVE, kernel
from atmosbox.engine.core.pair import nearest_image
from atmosbox.engine.core.square_well import Well
from atmosbox.engine.core.state import Motion

_WIDTHS = 12
_RATIO = 0.85
_NEIGHBOURS = 16
"""Intended number of neighbours; measured: a dense liquid is fastest with this number, or slightly more."""
_FALL = 0.125
"""Fraction of a shell's radius reserved for the fall in gravity, so that a straight line gives the time to leave it."""
_END = -1


class Vicinity(
    namedtuple(
        "Vicinity",
        "entry stride anchor width cell next previous first mark found gap reach number_x number_y number_z inverse_x "
        "inverse_y inverse_z",
    )
):
    """Shells, lists and cells in the form that the kernels take.

    ``entry : (molecule * stride,)``: the lists. ``anchor : (molecule, 4)``: x, y, z and the radius of the shell
    [length]; ``width : (width,)``: the radii to choose from, the widest first. ``cell``, ``next`` and ``previous :
    (molecule,)`` and ``first : (cell,)``: chains of molecules, -1 at both ends. ``mark`` and ``found : (molecule,)``,
    ``gap : (molecule,)`` [length^2]: working memory. ``reach`` is the largest edge of any pair [length]; ``number_*``
    and ``inverse_*`` the number of cells along an axis, and one over their width [1/length].
    """


def new_vicinity(
    sides: NDArray[np.float64], periodic: tuple[bool, bool, bool], number: int, reach: float, *, planar: bool
) -> Vicinity:
    """Return empty lists for ``number`` molecules whose attraction reaches as far as ``reach`` at most [length]."""
    spacing = float(root(float(np.prod(sides if not planar else sides[[0, 2]])) / max(number, 1), 2 if planar else 3))
    widest = max(reach, spacing)
    # a path within two shells must not lead to another image than the nearest
    for axis in range(3):
        if periodic[axis]:
            widest = min(widest, 0.25 * (0.5 * float(sides[axis]) - reach))
    wide = max(0.6 * reach, 0.7 * spacing, 1e-6 * float(sides.max()))
    cells = [max(1, min(int(side / wide), 1 << 10)) for side in sides]
    if planar:
        cells[1] = 1
    while math.prod(cells) > 8 * max(number, 1) + 64:
        cells[int(np.argmax(cells))] //= 2
    return Vicinity(
        entry=np.zeros(0, np.uint32),
        stride=0,
        anchor=np.zeros((number, 4)),
        width=widest * np.cumprod(np.r_[1.0, np.full(_WIDTHS - 1, _RATIO)]),
        cell=np.full(number, _END, np.int32),
        next=np.full(number, _END, np.int32),
        previous=np.full(number, _END, np.int32),
        first=np.full(math.prod(cells), _END, np.int32),
        mark=np.zeros(number, np.uint8),
        found=np.zeros(number, np.int32),
        gap=np.zeros(number),
        reach=reach,
        number_x=cells[0],
        number_y=cells[1],
        number_z=cells[2],
        inverse_x=cells[0] / float(sides[0]),
        inverse_y=cells[1] / float(sides[1]),
        inverse_z=cells[2] / float(sides[2]),
    )


@kernel
def time_to_leave_shell(i, at, gas, modes):
    """Return for how long molecule i, whose `Motion` is ``at``, surely stays within its shell [time from now]."""
    anchor = gas.vicinity.anchor
    rx, ry, rz = at.x - anchor[i, 0], at.y - anchor[i, 1], at.z - anchor[i, 2]
    radius = anchor[i, 3]
    fall = math.inf
    if modes.gravity:
        fall = math.sqrt(2.0 * _FALL * radius / gas.box.gravity)
        radius *= 1.0 - _FALL
    b = rx * at.vx + ry * at.vy + rz * at.vz
    speed_squared = at.vx * at.vx + at.vy * at.vy + at.vz * at.vz
    room = radius * radius - (rx * rx + ry * ry + rz * rz)
    root = math.sqrt(max(b * b + speed_squared * room, 0.0))
    straight = math.inf
    if speed_squared > 0.0:
        straight = room / (b + root) if b > 0.0 else (root - b) / speed_squared
    return min(max(straight, 0.0), fall)


@kernel
def is_inside(entry):
    """Return whether the neighbour of an entry is inside the well."""
    return entry & 1 == 1


@kernel
def _place_of(i, j, vicinity):
    """Return where in memory the list of i has its entry of j, -1 if it has none."""
    start = (i * vicinity.stride) & POSITIVE
    place = -1
    for q in range(start + 1, start + 1 + np.int64(vicinity.entry[start])):
        if np.int64(vicinity.entry[q]) >> 1 == j:
            place = q
    return place


@kernel
def set_inside(i, j, inside, vicinity):
    """Store in both lists whether i and j are inside each other's well."""
    vicinity.entry[_place_of(i, j, vicinity)] = 2 * j + (1 if inside else 0)
    vicinity.entry[_place_of(j, i, vicinity)] = 2 * i + (1 if inside else 0)


@kernel
def _append(i, entry, vicinity):
    """Add an entry at the end of the list of molecule i."""
    start = (i * vicinity.stride) & POSITIVE
    n = np.int64(vicinity.entry[start]) + 1
    vicinity.entry[start + n] = entry
    vicinity.entry[start] = n


@kernel
def _strike(i, j, vicinity):
    """Remove j from the list of molecule i."""
    start = (i * vicinity.stride) & POSITIVE
    vicinity.entry[_place_of(i, j, vicinity)] = vicinity.entry[start + np.int64(vicinity.entry[start])]
    vicinity.entry[start] -= 1


@kernel
def _cell_along(x, inverse, number):
    """Return the cell of a coordinate along an axis; a coordinate beyond an end belongs to the cell at that end."""
    return min(max(np.int64(math.floor(x * inverse)), 0), number - 1)


@kernel
def _leave_cell(i, vicinity):
    """Remove molecule i from its cell."""
    before, after = np.int64(vicinity.previous[i]), np.int64(vicinity.next[i])
    if before >= 0:
        vicinity.next[before] = after
    elif vicinity.cell[i] >= 0:
        vicinity.first[vicinity.cell[i]] = after
    if after >= 0:
        vicinity.previous[after] = before


@kernel
def enter(i, x, y, z, vicinity):
    """Put molecule i, whose anchor is at x, y, z, into its cell."""
    cx = _cell_along(x, vicinity.inverse_x, vicinity.number_x)
    cy = _cell_along(y, vicinity.inverse_y, vicinity.number_y)
    cz = _cell_along(z, vicinity.inverse_z, vicinity.number_z)
    cell = (cx * vicinity.number_y + cy) * vicinity.number_z + cz
    after = np.int64(vicinity.first[cell])
    vicinity.cell[i] = cell
    vicinity.previous[i] = _END
    vicinity.next[i] = after
    vicinity.first[cell] = i
    if after >= 0:
        vicinity.previous[after] = i
    vicinity.anchor[i, 0], vicinity.anchor[i, 1], vicinity.anchor[i, 2] = x, y, z


@kernel
def _span(x, reach, inverse, number, turns):
    """Return the first cell within reach of a coordinate along an axis, and how many; a periodic axis has no ends."""
    low = np.int64(math.floor((x - reach) * inverse))
    high = np.int64(math.floor((x + reach) * inverse))
    if not turns:
        low = min(max(low, 0), number - 1)
        high = min(max(high, 0), number - 1)
    elif high - low >= number:
        low = 0
        high = number - 1
    return low, high - low + 1


@kernel
def _around(cell, number):
    """Return the number of a cell along an axis of ``number`` cells, which may be one period outside it."""
    return cell + number if cell < 0 else (cell - number if cell >= number else cell)


@kernel
def _gather(i, x, y, z, gas, modes):
    """Collect all molecules that could be in the list of i if its shell were the widest; return how many."""
    vicinity, box = gas.vicinity, gas.box
    anchor = vicinity.anchor
    reach = vicinity.reach + 2.0 * vicinity.width[0]
    number = 0
    first_x, span_x = _span(x, reach, vicinity.inverse_x, vicinity.number_x, box.inverse_x > 0.0)
    first_y, span_y = _span(y, reach, vicinity.inverse_y, vicinity.number_y, box.inverse_y > 0.0)
    first_z, span_z = _span(z, reach, vicinity.inverse_z, vicinity.number_z, box.inverse_z > 0.0)
    for cx in range(first_x, first_x + span_x):
        for cy in range(first_y, first_y + span_y):
            row = _around(cx, vicinity.number_x) * vicinity.number_y + _around(cy, vicinity.number_y)
            for cz in range(first_z, first_z + span_z):
                j = np.int64(vicinity.first[row * vicinity.number_z + _around(cz, vicinity.number_z)])
                while j >= 0:
                    rx, ry, rz = nearest_image(x - anchor[j, 0], y - anchor[j, 1], z - anchor[j, 2], box, modes)
                    gap = rx * rx + ry * ry + rz * rz
                    limit = vicinity.reach + vicinity.width[0] + anchor[j, 3]
                    if j != i and gap < limit * limit:
                        vicinity.found[number] = j
                        vicinity.gap[number] = gap
                        number += 1
                    j = np.int64(vicinity.next[j])
    return number


@kernel
def _shell_for(number, vicinity):
    """Return the radius of the shell for a molecule with ``number`` candidates [length]: narrow if they are many."""
    widest = vicinity.reach + 2.0 * vicinity.width[0]
    chosen = vicinity.width[vicinity.width.size - 1]
    for k in range(vicinity.width.size - 1, -1, -1):
        share = (vicinity.reach + 2.0 * vicinity.width[k]) / widest
        if number * share * share * share <= _NEIGHBOURS:
            chosen = vicinity.width[k]
    return chosen


@kernel
def well_of(i, j, gas, modes):
    """Return the law of a pair: a `square_well.Well`."""
    wells = gas.wells
    if modes.mixed:
        one, two = gas.molecules[i].kind, gas.molecules[j].kind
        return Well(wells.core[one, two], wells.edge[one, two], wells.depth[one, two])
    return Well(wells.core[0, 0], wells.edge[0, 0], wells.depth[0, 0])


@kernel
def _turns_back(x, length, inverse):
    """Return what to subtract from a coordinate to bring it into a periodic box [length]; 0 between walls."""
    return length * math.floor(x * inverse) if inverse > 0.0 else 0.0


@kernel
def _lists(i, j, gap, shell, gas, modes):
    """Return whether i, with this shell, and j list each other: ``gap`` is the squared distance of their anchors."""
    vicinity = gas.vicinity
    limit = vicinity.reach
    if modes.mixed:
        limit = gas.wells.distance[gas.molecules[i].kind, gas.molecules[j].kind]
    limit += shell + vicinity.anchor[j, 3]
    return gap < limit * limit


@kernel
def bring_back(i, at, gas):
    """Bring molecule i, whose `Motion` is ``at``, back into a periodic box; return its `Motion` there."""
    box, molecule = gas.box, gas.molecules[i]
    dx = _turns_back(at.x, box.length_x, box.inverse_x)
    dy = _turns_back(at.y, box.length_y, box.inverse_y)
    dz = _turns_back(at.z, box.length_z, box.inverse_z)
    molecule.x -= dx
    molecule.y -= dy
    molecule.z -= dz
    return Motion(at.x - dx, at.y - dy, at.z - dz, at.vx, at.vy, at.vz)


@kernel
def renew(i, at, fresh, gas, modes):
    """Make the list of molecule i, whose `Motion` is ``at``, and its shell again.

    Returns whether the lists must grow first; then nothing is changed. With ``fresh`` the distance decides if a pair
    that is new to the lists is inside its well; only at the start.
    """
    vicinity = gas.vicinity
    gathered = _gather(i, at.x, at.y, at.z, gas, modes)
    shell = _shell_for(gathered, vicinity)
    # which of them are listed, and do all lists have room?
    number = 0
    full = False
    for q in range(gathered):
        j = np.int64(vicinity.found[q])
        if _lists(i, j, vicinity.gap[q], shell, gas, modes):
            vicinity.found[number] = j
            vicinity.gap[number] = vicinity.gap[q]
            number += 1
            full |= np.int64(vicinity.entry[(j * vicinity.stride) & POSITIVE]) + 2 >= vicinity.stride
    full |= number + 2 >= vicinity.stride
    if not full:
        # 1: was listed, outside; 2: was listed, inside
        start = (i * vicinity.stride) & POSITIVE
        before = np.int64(vicinity.entry[start])
        for q in range(start + 1, start + 1 + before):
            entry = np.int64(vicinity.entry[q])
            vicinity.mark[entry >> 1] = 1 + (entry & 1)
        for q in range(number):
            j = np.int64(vicinity.found[q])
            mark = np.int64(vicinity.mark[j])
            inside = mark == 2
            if mark == 0:
                if fresh:
                    well = well_of(i, j, gas, modes)
                    inside = vicinity.gap[q] < well.edge and well.edge > well.core
                _append(j, 2 * i + (1 if inside else 0), vicinity)
            vicinity.mark[j] = 3 + (1 if inside else 0)
        # those that are no longer listed
        for q in range(start + 1, start + 1 + before):
            j = np.int64(vicinity.entry[q]) >> 1
            if vicinity.mark[j] < 3:
                _strike(j, i, vicinity)
                vicinity.mark[j] = 0
        for q in range(number):
            j = np.int64(vicinity.found[q])
            vicinity.entry[start + 1 + q] = 2 * j + (1 if vicinity.mark[j] == 4 else 0)
            vicinity.mark[j] = 0
        vicinity.entry[start] = number
        _leave_cell(i, vicinity)
        enter(i, at.x, at.y, at.z, vicinity)
        vicinity.anchor[i, 3] = shell
    return full

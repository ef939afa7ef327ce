"""Molecules as a structure of arrays, sorted into cells, for an engine that draws collision partners at random.

Each property of all molecules is one array (a column), so that a loop over molecules reads memory in order and the
compiler can compute eight of them at once. In every step molecules are *counted* by cell and an index of them is
written in the order of cells (a counting sort that keeps their order within a cell); now and then the columns
themselves are put in that order. Every thread counts one part of the columns, and its places in the index follow
those of the threads before it: the index is the same for any number of threads.
"""

import functools
import math
from collections import namedtuple
from typing import Any

import numpy as np

from atmosbox.engine.core.compiler import prange
from atmosbox.engine.core.jit import kernel

BLOCK = 1024
"""Number of molecules that are moved together: few enough to stay in the nearest cache."""

_EVEN_EMPTY = 8  # the work of a cell, even an empty one, in pairs
_LINE, _PAGE = 8, 512  # numbers in a line of the cache, and in a page of memory


class Columns(namedtuple("Columns", "x y z vx vy vz spin identity cell order kind")):
    """All molecules as columns: a structure of arrays.

    ``x``, ``y``, ``z``, ``vx``, ``vy``, ``vz : (slot,)`` [length, length/time], ``spin : (slot,)`` rotational
    energy [energy] where molecules rotate, ``identity : (slot,)`` index of the molecule in a slot.
    ``cell : (slot,)`` its cell, ``order : (slot,)`` slots in the order of cells, ``kind : (slot,)`` the
    kind of the molecule, if there are several.
    """


class Grid(namedtuple("Grid", "number_x number_y number_z first place fastest")):
    """Cells of equal size, ``number_*`` along each axis; x changes fastest in their index.

    ``first : (cell + 1,)``: where the molecules of each cell begin in the index; ``place : (thread, cell)``:
    where those of each thread begin; ``fastest : (cell,)``: the largest relative speed found in it [length/time].
    """


class Axis(namedtuple("Axis", "low high per_length last stride")):
    """An axis along which molecules move: the lowest and highest coordinate of a centre [length], and the cells.

    ``per_length``: number of cells per length [1/length], ``last``: index of the last cell, ``stride``: the step of
    a cell's number from one cell to the next along the axis.
    """


class MoleculeKinds(namedtuple("MoleculeKinds", "mass radius rotation masses rotations")):
    """The properties of the molecules: mass [mass], radius [length], rotational degrees of freedom.

    If there are several kinds, ``masses``, ``rotations : (kind,)`` are those of each kind, and ``mass`` is that of
    the lightest.
    """


class Workspace(namedtuple("Workspace", "mark queue random counters met cut left")):
    """Working memory of one step.

    ``mark : (thread, BLOCK)``: which molecules of a block need work at walls, ``queue : (thread, BLOCK)``: a list
    of them, ``random : (thread, 8)``: states of random numbers; ``counters : (block, 3, wall)``:
    tallies of wall hits of a block, summed in the order of blocks; ``met : (thread, 8)``: contacts; ``cut :
    (thread + 1,)``: the first cell of each thread's share of cells; ``left : (slot,)``: how long molecules that wait
    on a pool still have to fly [time], if there is one.
    """


class Features(namedtuple("Features", "rotates wet pool")):
    """The features that a box of many molecules requires: see `atmosbox.engine.dsmc.dsmc.specialise`."""


class Step(namedtuple("Step", "start length ceiling top key")):
    """One step: its start and its length [time], the height of the ceiling before and after it [length].

    ``key`` is a random word of this step.
    """


class Air(namedtuple("Air", "columns grid gas box walls workspace tries water")):
    """The molecules in their box, in the form that the kernels take; see the types of its parts.

    ``gas`` is a `MoleculeKinds`, ``tries`` are `pairing.Tries`; ``water`` is the liquid (`moist_columns.Water`), or
    None where there is none or it is not needed.
    """


class March(namedtuple("March", "first steps length ceilings cross_section tallies water")):
    """A number of steps: the first, how many, their length [time], and the data used between the parallel loops.

    ``ceilings : (step + 1,)``: height of the ceiling before and after each step [length]; ``cross_section`` of a
    pair [length^2]; ``tallies``: the tallies, ``water``: the liquid, or None.
    """


def new_columns(number: int, many: int) -> list[Any]:
    """Return ``many`` empty columns for a number of molecules.

    Each begins at a line of the cache, so that eight numbers that are read together are one line. Each begins at
    another place within a page than the one before it, as data at the same place of different pages compete for the
    same few lines.
    """
    stride = -(-number // _PAGE) * _PAGE + _PAGE // 8 + _LINE
    room = np.empty(many * stride + _LINE)
    start = -(room.ctypes.data // room.itemsize) % _LINE
    return [room[start + k * stride : start + k * stride + number] for k in range(many)]


def new_workspace(number: int, cells: int, threads: int, waiting: int = 1) -> Workspace:
    """Return the working memory for numbers of molecules, cells and threads, and of molecules waiting on a pool."""
    return Workspace(
        mark=np.zeros((threads, BLOCK), np.int32),
        queue=np.zeros((threads, BLOCK), np.int32),
        random=np.zeros((threads, 8), np.uint64),
        counters=np.zeros((-(-number // BLOCK), 3, 6)),
        met=np.zeros((threads, 8), np.int64),
        cut=np.linspace(0, cells, threads + 1).astype(np.int64),
        left=np.zeros(waiting),
    )


def new_grid(numbers: tuple[int, int, int], threads: int) -> Grid:
    """Return a grid of these numbers of cells along each axis, all empty, for a number of counting threads."""
    cells = math.prod(numbers)
    return Grid(
        *numbers,
        first=np.zeros(cells + 1, np.uint32),
        place=np.zeros((threads, cells), np.uint32),
        fastest=np.zeros(cells),
    )


@kernel
def share_of(thread, threads, number):
    """Return the first slot of a thread's share of the molecules, and the slot after its last: whole blocks.

    >>> [share_of(t, 2, 5000) for t in range(2)]
    [(0, 2048), (2048, 5000)]
    """
    blocks = (number + BLOCK - 1) // BLOCK
    return min(blocks * thread // threads * BLOCK, number), min(blocks * (thread + 1) // threads * BLOCK, number)


@kernel
def number_present(columns, water):
    """Return the number of molecules in the box: they are in the first slots; those of the liquid have no slot."""
    return columns.x.size - water.reservoir.top[0]


@kernel
def _axis(length, inverse, radius, number, stride):
    """Return an `Axis`: between walls centres come no nearer to them than a radius."""
    low = 0.0 if inverse > 0.0 else radius
    high = length - low
    return Axis(low, high, number / (high - low), number - 1, stride)


@kernel
def axes_of(top, grid, gas, box):
    """Return the `Axis` of each direction, under a ceiling at ``top`` [length]."""
    return (
        _axis(box.length_x, box.inverse_x, gas.radius, grid.number_x, 1),
        _axis(box.length_y, box.inverse_y, gas.radius, grid.number_y, grid.number_x),
        _axis(top, box.inverse_z, gas.radius, grid.number_z, grid.number_x * grid.number_y),
    )


@kernel
def place_along(u, axis):
    """Return the index of a coordinate's cell along an axis, times the stride."""
    return min(np.int32((u - axis.low) * axis.per_length), np.int32(axis.last)) * np.int32(axis.stride)


@kernel
def find_cell(p, axes, columns):
    """Compute the cell of the molecule in slot p, and store it."""
    x, y, z = axes
    columns.cell[p] = place_along(columns.x[p], x) + place_along(columns.y[p], y) + place_along(columns.z[p], z)


@kernel
def count_by_cell(cell, count, first, last):
    """Count the molecules of the slots ``first`` to ``last - 1`` by cell."""
    count[:] = 0
    for p in range(first, last):
        count[np.uint32(cell[p])] += np.uint32(1)


@kernel
def reserve_places(grid, cells):
    """Turn each thread's counts by cell into its first place in the index, and store where each cell begins."""
    threads = grid.place.shape[0]
    place = 0
    for c in range(cells):
        grid.first[c] = place
        for t in range(threads):
            count = grid.place[t, c]
            grid.place[t, c] = place
            place += count
    grid.first[cells] = place


@kernel
def share_cells(first, cells, cut):
    """Divide the cells into stretches, one for each thread, with about the same number of possible pairs.

    So molecules that are near each other in memory are computed by the same thread when they move and collide. Ten
    molecules in one cell are more work than ten molecules in ten cells:

    >>> cut = np.zeros(3, np.int64)
    >>> share_cells(np.array([0, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20]), 11, cut)
    >>> cut
    array([ 0,  1, 11])
    """
    total = 0
    for c in range(cells):
        number = np.int64(first[c + 1]) - np.int64(first[c])
        total += number * (number - 1) + _EVEN_EMPTY
    threads = cut.size - 1
    done = 0
    t = 1
    for c in range(cells):
        number = np.int64(first[c + 1]) - np.int64(first[c])
        done += number * (number - 1) + _EVEN_EMPTY
        while t < threads and done * threads >= total * t:
            cut[t] = c + 1
            t += 1
    cut[threads] = cells


@kernel
def index_by_cell(cell, order, place, first, last):
    """Write the slots ``first`` to ``last - 1`` into the index, each at the next place of its cell."""
    for p in range(first, last):
        c = np.uint32(cell[np.uint32(p)])
        q = np.uint32(place[c])
        place[c] = q + np.uint32(1)
        order[q] = p


@functools.cache
def new_gather(parallel: bool) -> Any:
    """Return the kernel that puts a column in another order, on one thread or on several."""

    @kernel(entry=True, allocates=parallel, parallel=parallel)
    def gather(column, order, target, threads):
        """Copy ``column[order]`` to ``target``."""
        parts = threads if parallel else 1
        for t in prange(parts):
            first, last = share_of(t, parts, column.size)
            for p in range(first, last):
                target[p] = column[order[np.uint32(p)]]

    return gather

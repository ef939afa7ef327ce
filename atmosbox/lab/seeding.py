"""A box that a page can start with any seed: its memory without molecules, and a check that nothing else differs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from atmosbox.engine.core.state import MOLECULE, aligned_records
from atmosbox.lab.kernels.laying_out import LAST, NUMBER
from atmosbox.lab.lab_box import LabBox, lab_box
from atmosbox.lab.memory_image import parts
from atmosbox.lab.work import arguments
from atmosbox.simulation.preparation import prepare

__all__ = ["is_the_seed_all", "without_molecules"]

_PLACES = ("x", "y", "z", "vx", "vy", "vz")


def without_molecules(box: LabBox) -> LabBox:
    """Return a box in which everything that the kernel ``start`` writes is cleared.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> empty = without_molecules(lab_box(prepare("temperature", {"molecules": 20})))
    >>> float(abs(empty.gas.molecules["x"]).max())
    0.0
    """
    gas = box.gas
    molecules = aligned_records(gas.molecules.size, MOLECULE)
    molecules[:] = gas.molecules
    gas_alone = slice(box.setup.parcel.number)  # the molecules of the liquid and the drops follow after these
    for name in _PLACES:
        molecules[name][gas_alone] = 0.0
    blank: dict[str, Any] = {"molecules": molecules, "tallies": gas.tallies._replace(random=np.zeros(1, np.uint64))}
    if box.modes.rotation:
        blank["kinds"] = gas.kinds._replace(rotational_energy=np.zeros_like(gas.kinds.rotational_energy))
    if box.modes.ascends:
        blank["walls"] = gas.walls._replace(piston=gas.walls.piston * [1.0, 0.0, 1.0])
    if box.attracts:
        clock = np.full(1, math.inf)
        blank["bath"] = gas.bath._replace(clock=clock)
        blank["wells"] = gas.wells._replace(number=np.zeros_like(gas.wells.number))
    else:
        copies, boundary = gas.cells.copies._replace(epoch=np.zeros_like(gas.cells.copies.epoch)), gas.cells.boundary
        layers = {}
        if box.modes.gravity:  # layers depend on the temperature at the start
            copies = copies._replace(slack=np.zeros_like(copies.slack), room=np.zeros_like(copies.room))
            copies = copies._replace(centre=copies.centre * [[1.0], [1.0], [0.0]])
            boundary = boundary.copy()
            boundary[:, 2] = 0.0
            box, layers = _without_layers(box), {"number_z": 0, "last_slot_z": 0}
        blank["cells"] = gas.cells._replace(copies=copies, boundary=boundary, **layers)
    book = box.book._replace(epoch_length=np.zeros(1), energy=np.zeros(1))
    if box.attracts:
        book = book._replace(clocks=clock)
    if box.modes.phases:
        reservoir = book.moisture.reservoir
        clock = np.where(np.isinf(reservoir.clock), math.inf, 0.0)  # an event that never happens does so for no seed
        reservoir = reservoir._replace(clock=clock, bound=reservoir.bound * [0.0, 1.0])
        book = book._replace(clocks=clock, moisture=book.moisture._replace(reservoir=reservoir))
    return box._replace(gas=gas._replace(**blank), book=book)


def _without_layers(box: LabBox) -> LabBox:
    """Return a box of a column in which the data of its present layers are cleared."""
    shape, edge = box.layout.shape.copy(), box.layout.edge.copy()
    shape[[NUMBER + 2, LAST + 2]] = 0
    edge[2] = 0.0
    layout = box.layout._replace(shape=shape, edge=edge)
    return box._replace(layout=layout, start=box.start and box.start._replace(layout=layout))


def is_the_seed_all(box: LabBox) -> bool:
    """Return whether a page can start a box with another seed: boxes of two seeds must differ in molecules only.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> is_the_seed_all(lab_box(prepare("temperature", {"molecules": 20})))
    True

    The masses of discs are drawn at random, and more than the positions depends on them:

    >>> is_the_seed_all(lab_box(prepare("elastic-collisions", {})))
    False
    """
    prepared = box.prepared
    if not box.seeded:
        return False
    other = prepare(
        prepared.scene, prepared.settings.changed() | {"seed": int(prepared.settings.seed) + 1}, engine=prepared.engine
    )
    second = lab_box(other)._replace(sight=box.sight)
    return second.seeded and _content(box) == _content(second)


def _content(box: LabBox) -> list[Any]:
    """Return all arguments of the kernels of a box, without the limit by which a pile-up of events is detected."""
    empty = without_molecules(box)
    # the calendar is left out: it is empty, and its length depends on its address in memory
    gas = empty.gas._replace(box=empty.gas.box._replace(stall=0.0), calendar=0)
    given = arguments(empty._replace(gas=gas))
    return [
        value.tobytes() if isinstance(value, np.ndarray) else value
        for name in given
        for _, value, _ in parts(given[name], "")
    ]

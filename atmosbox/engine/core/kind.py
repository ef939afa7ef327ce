"""Kinds of molecules: molecules of one kind have the same mass, size and rotation."""

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.core.state import KIND, Kinds, aligned_records
from atmosbox.engine.exact.cells import size_classes

Array = NDArray[np.float64]


def classify(
    mass: Array,
    diameter: Array,
    rotation: Array,
    rotational_energy: Array | None,
    species: NDArray[np.int64] | None = None,
) -> tuple[Kinds, NDArray[np.int64], Array]:
    """Group equal molecules into kinds; molecules of different species are never of the same kind.

    Returns the kinds; the kind of each molecule, (molecule,); the radius of each class of sizes, (size,) [length].

    >>> both = np.array([2.0, 1.0, 2.0]), np.ones(3), np.zeros(3)
    >>> classify(*both, None)[1].tolist()
    [1, 0, 1]
    """
    columns = np.stack([mass, 0.5 * diameter, rotation, *([] if species is None else [species])], axis=1)
    table, kind = np.unique(columns, axis=0, return_inverse=True)
    if not len(table):
        table = np.array([[1.0, 0.0, 0.0]])
    classes, radius = size_classes(table[:, 1])
    records = aligned_records(len(table), KIND)
    records["mass"], records["radius"], records["rotation"] = table.T[:3]
    records["size_class"] = classes
    return Kinds(records, np.zeros(1) if rotational_energy is None else rotational_energy), kind.reshape(-1), radius

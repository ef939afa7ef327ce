"""The terms of the energy budget of a box, and how much energy is missing from it.

What is stored now is what was stored at the start plus all that was given since. `STORES` and `GIVEN` are the only
list of these terms: a box computes its residual from them, a run writes them into its file under these names, and the
file is checked with them again.
"""

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["GIVEN", "STORES", "residual"]

STORES = ("kinetic_energy", "rotational_energy", "potential_energy", "condensed_energy")
"""Energy that a box holds."""
GIVEN = {
    "heat_from_wall": "wall_heat",
    "work_by_piston": "work",
    "work_by_gravity": "gravity_work",
    "numerical_heat": "numerical_heat",
    "heat_from_bath": "bath_heat",
    "work_by_attraction": "attraction_work",
}
"""Energy given to a box since its start, with the property of the box that holds it."""


def residual(terms: Mapping[str, ArrayLike], start: float | None = None) -> NDArray[np.float64]:
    """Return the energy missing from a budget, relative to the largest energy in it [1].

    Parameters
    ----------
    terms
        The terms by name, at one time or at several; those that a box lacks may be missing, and what is not in `STORES`
        was given. The last axis of ``heat_from_wall`` is that of the walls.
    start
        The energy stored at the start; None for what the first of several times implies.

    Examples
    --------
    A wall gives 2, another takes 1, and the piston does work of 3:

    >>> given = {"heat_from_wall": [[0.0, 0.0], [2.0, -1.0]], "work_by_piston": [0.0, 3.0]}
    >>> residual({"kinetic_energy": [10.0, 14.0], **given}).tolist()
    [0.0, 0.0]
    """
    stores = [np.asarray(terms[name], float) for name in STORES if name in terms]
    given = {name: np.asarray(value, float) for name, value in terms.items() if name not in STORES}
    each, sizes = ([made(value) for value in given.values()] for made in (np.asarray, np.abs))
    if "heat_from_wall" in given:
        place = list(given).index("heat_from_wall")
        each[place], sizes[place] = each[place].sum(axis=-1), sizes[place].sum(axis=-1)
    total, entered = np.asarray(sum(stores)), np.asarray(sum(each))
    begun = float((total - entered)[0]) if start is None else start
    # in deep wells a large kinetic and a large negative potential energy may have a small sum
    scale = np.maximum.reduce([np.abs(total), np.full(total.shape, abs(begun)), sum(sizes), *map(np.abs, stores)])
    missing: NDArray[np.float64] = np.abs(total - begun - entered) / np.where(scale > 0.0, scale, 1.0)
    return missing

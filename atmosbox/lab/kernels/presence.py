"""Which of the molecules that a box has ever held are in its gas now: those in the liquid, and drops, are not."""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel

__all__ = ["is_away", "number_in_gas"]


@kernel
def is_away(i, gas, modes):
    """Tell whether record i is a drop, or a molecule in the liquid."""
    if not modes.phases:
        return False
    molecule = gas.molecules[i]
    return math.isinf(molecule.clock) or (modes.drops > 0 and np.int64(molecule.kind) >= modes.drops)


@kernel
def number_in_gas(gas, modes):
    """Return how many molecules are in the gas now."""
    if not modes.phases:
        return gas.molecules.size
    number = 0
    for i in range(gas.molecules.size):
        if not is_away(i, gas, modes):
            number += 1
    return number

"""Which records of a box are molecules in its gas now: drops, and molecules in the liquid, are not."""

import math

import numpy as np

from atmosbox.engine.core.jit import kernel


@kernel
def is_away(i, gas, modes):
    """Return whether record i is a drop, or a molecule in the liquid."""
    if not modes.phases:
        return False
    molecule = gas.molecules[i]
    return math.isinf(molecule.clock) or (modes.drops > 0 and np.int64(molecule.kind) >= modes.drops)


@kernel
def number_in_gas(gas, modes):
    """Return the number of molecules in the gas now."""
    if not modes.phases:
        return gas.molecules.size
    number = 0
    for i in range(gas.molecules.size):
        if not is_away(i, gas, modes):
            number += 1
    return number

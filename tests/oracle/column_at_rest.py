"""A closed isothermal column of gas: reference values for a simulated one."""

import numpy as np

from atmosbox.theory.hydrostatic import _profile


def hydrostatic_column(height, molecules_per_area, bottom, top, kT, mass, gravity, diameter, dimensions=3):
    """Return the number density at each height of a column of spheres or discs."""
    z = np.asarray(height, float)
    profile = _profile(molecules_per_area, bottom, top, kT, mass, gravity, diameter, dimensions)
    return np.where((z >= bottom) & (z <= top), profile(np.clip(z, bottom, top)), 0.0)

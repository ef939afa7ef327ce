"""A closed isothermal column of gas: reference values for a simulated one."""

import numpy as np

from atmosbox.theory import column_floor_ratio
from atmosbox.theory.hydrostatic import _profile


def hydrostatic_column(height, molecules_per_area, bottom, top, kT, mass, gravity, diameter, dimensions=3):
    """Return the number density at each height of a column of spheres or discs."""
    z = np.asarray(height, float)
    profile = _profile(molecules_per_area, bottom, top, kT, mass, gravity, diameter, dimensions)
    return np.where((z >= bottom) & (z <= top), profile(np.clip(z, bottom, top)), 0.0)


def column_heat_capacity(depth, kT, mass, gravity, dof=3):
    """Return the heat capacity per molecule of points in a closed column, in k: f/2 + 1 - (n_0 / n)^2 exp(-a)."""
    a = mass * gravity * np.asarray(depth, float) / kT
    return dof / 2.0 + 1.0 - column_floor_ratio(depth, kT, mass, gravity) ** 2 * np.exp(-a)

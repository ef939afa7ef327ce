"""Kinetic theory of walls, pistons and noise: reference values for a simulated gas."""

import numpy as np
from scipy import special


def constant_energy_speed_factor(dof):
    """Return the mean speed in a box of constant energy over Maxwell's; for f quadratic terms 1 + 1/4f and so on."""
    f = np.asarray(dof, float)
    return np.sqrt(f / 2.0) * np.exp(special.gammaln(f / 2.0) - special.gammaln((f + 1.0) / 2.0))


def wall_flux(number_density, kT, mass):
    """Return the number of molecules that hit a wall per area and time, n sqrt(kT / 2 pi m)."""
    return number_density * np.sqrt(kT / (2.0 * np.pi * mass))


def compressibility_noise(compressibility_factor, collisions):
    """Return the standard error of Z from a number of independent collisions with Rayleigh-distributed impulses."""
    return (compressibility_factor - 1.0) * np.sqrt(4.0 / (np.pi * collisions))


def piston_pressure_ratio(piston_speed, kT, mass):
    """Return the pressure on a receding piston over that on one at rest: the mean of 2 n m (v - u)^2 over v > u."""
    s = piston_speed / np.sqrt(2.0 * kT / mass)
    return (1.0 + 2.0 * s**2) * special.erfc(s) - 2.0 / np.sqrt(np.pi) * s * np.exp(-(s**2))


def kolmogorov_smirnov_critical(samples, level):
    """Return the largest distance between a measured distribution of many values and the true one, by chance."""
    return special.kolmogi(level) / np.sqrt(samples)

"""Heat conduction of a dilute gas in first approximation: Chapman and Enskog's brackets by Monte Carlo integration."""

import numpy as np


def _flux(velocity, spin):
    """Return the two parts of the heat flux of molecules along three axes: of the motion, and of the rotation."""
    square = np.sum(velocity**2, axis=1)
    return np.stack([0.5 * (square - 5.0) * velocity.T, (spin - 1.0) * velocity.T])


def conduction_of_rotating_spheres(number, rng, parts=20):
    r"""Return the factor by which rotation increases the heat conductivity of spheres, and its standard error.

    Pairs of mass 1 and kT = 1 collide in proportion to relative speed; with Larsen and Borgnakke's exchange at every
    contact their energy is divided again as Gamma(2) : Gamma(1) : Gamma(1). The brackets are
    :math:`B_{ij} = \tfrac14 \langle g\,\Delta A_i \cdot \Delta A_j \rangle / 3`, and the conductivity goes as
    :math:`b \cdot B^{-1} b` for b = (5/2, 1).
    """
    found = []
    for _ in range(parts):
        one, other = rng.normal(size=(2, number, 3))
        spins = rng.exponential(size=(2, number))
        middle, speed = 0.5 * (one + other), np.sqrt(np.sum((one - other) ** 2, axis=1))
        before = _flux(one, spins[0]) + _flux(other, spins[1])
        direction = rng.normal(size=(number, 3))
        direction /= np.sqrt(np.sum(direction**2, axis=1))[:, None]
        energy = 0.25 * speed**2 + spins.sum(axis=0)
        shares = rng.standard_gamma([2.0, 1.0, 1.0], (number, 3))
        shares *= (energy / shares.sum(axis=1))[:, None]
        brackets = []
        for after, turned in ((speed, spins), (2.0 * np.sqrt(shares[:, 0]), shares[:, 1:].T)):
            away = 0.5 * after[:, None] * direction
            change = before - _flux(middle + away, turned[0]) - _flux(middle - away, turned[1])
            brackets.append(np.einsum("n,ian,jan->ij", speed, change, change) / (12.0 * number))
        smooth, rotating = brackets
        b = np.array([2.5, 1.0])
        found.append(float(b @ np.linalg.solve(rotating, b)) * smooth[0, 0] / b[0] ** 2)
    return float(np.mean(found)), float(np.std(found, ddof=1) / np.sqrt(parts))

"""One drop beside its vapour in a closed box, by counting states: the exact answer for any number of molecules.

Written without the engine and without `atmosbox.theory`. Between heat baths of kT = 1 the chance of n molecules in the
drop and v in the vapour is that of all their states,

    P(n) ~ e_s^v V(n)^(v + air) / v! exp(-E(n)) (n + s)! / (n! s!),

with the volume V(n) that the drop leaves to the centres of the others, its surface energy E(n), and the ways to arrange
n molecules and s dissolved particles.
"""

import numpy as np
from scipy.special import gammaln


def radii(n, core, ball):
    """Return the radius of a drop of n molecules."""
    return np.cbrt(core**3 + np.asarray(n, float) * ball**3)


def room(n, core, ball, side, diameter):
    """Return the volume that the centres of others can reach."""
    return (side - diameter) ** 3 - 4.0 / 3.0 * np.pi * (radii(n, core, ball) + 0.5 * diameter) ** 3


def chances(molecules, saturated, tension, salt, core, ball, *, air=0, side=1.0, diameter=0.0):
    """Return the chance of n = 0, 1, ... molecules in the drop."""
    n = np.arange(molecules + 1.0)
    v = molecules - n
    logs = v * np.log(saturated) - gammaln(v + 1.0) + (v + air) * np.log(room(n, core, ball, side, diameter))
    logs -= 4.0 * np.pi * tension * radii(n, core, ball) ** 2
    logs += gammaln(n + salt + 1.0) - gammaln(n + 1.0)
    weight = np.exp(logs - logs.max())
    return weight / weight.sum()


def vapour_over_drop(n, tension, salt, core, ball):
    """Return the vapour pressure over that of a flat surface of pure water: n lose one as often as n - 1 gain one."""
    n = np.asarray(n, float)
    surface = 4.0 * np.pi * tension * (radii(n, core, ball) ** 2 - radii(n - 1.0, core, ball) ** 2)
    return n / (n + salt) * np.exp(surface)


def critical(tension, salt, core, ball, most=100_000):
    """Return the number of molecules at which the vapour pressure is highest, and how high it is there."""
    n = np.arange(1.0, most)
    over = vapour_over_drop(n, tension, salt, core, ball)
    k = int(over.argmax())
    return n[k], over[k]

"""The potential energy of a gas of molecules that attract each other by a square well, by its virial series."""

import numpy as np

from atmosbox.theory.simple_fluid import _HARD, _third


def square_well_energy(density, temperature, reach=1.5):
    r"""Return the potential energy of a molecule in a gas of low density, in depths of the well.

    :math:`u = -T^2 (\rho\, dB_2/dT + \rho^2 / 2\; dB_3/dT)`, from the free energy that belongs to the pressure. It is
    minus half the mean number of wells that a molecule is in. In a very thin gas a molecule has rho V e^(1/T) partners
    in the volume V of its well.
    """
    x = np.expm1(1.0 / temperature)
    one, two, three = _third(reach)
    # -T^2 d/dT of x is e^(1/T) = 1 + x
    second = -_HARD * (reach**3 - 1.0)
    third = -(_HARD**2) / 8.0 * (one + x * (2.0 * two + 3.0 * x * three))
    return (1.0 + x) * density * (second + 0.5 * density * third)

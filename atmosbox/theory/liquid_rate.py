r"""The molecules that leave a liquid, large or small: their rate and their energy.

A liquid of n molecules with the heat capacity :math:`C = n c_l + C_n`, in k, and the thermal energy U has the density
of states :math:`U^{C-1} / \Gamma(C)`. With the states of a gas this determines, by detailed balance, the rate at which
molecules leave the liquid, for any n. A large liquid evaporates by the law of Hertz and Knudsen. Units are SI.
"""

import numpy as np
from numpy.typing import ArrayLike

from atmosbox.theory import _water
from atmosbox.theory._array import FloatArray, as_floats
from atmosbox.theory._water import (
    BINDING,
    LIQUID_HEAT,
    TRIPLE_TEMPERATURE,
    VAPOR_HEAT,
    checked_not_negative,
    checked_positive,
    checked_temperature,
)
from atmosbox.theory.constants import BOLTZMANN, WATER

__all__ = [
    "LEAVING_FREEDOM",
    "hertz_knudsen_flux",
    "leaving_energy_density",
    "microcanonical_flux",
    "staying_energy_density",
]

LEAVING_FREEDOM: float = VAPOR_HEAT - 0.5
"""Energy that a molecule carries across the surface, in kT: 2 of flight (fast ones cross more often), 1.5 rotation."""


def hertz_knudsen_flux(temperature: ArrayLike, accommodation: ArrayLike = 1.0) -> FloatArray:
    r"""Return the number of molecules that leave a large liquid, per area and time [m^-2 s^-1]; 0 at 0 K.

    It is the number that condenses at saturation, :math:`\alpha e_s / \sqrt{2 \pi m k T}` (Persad and Ward 2016,
    doi:10.1021/acs.chemrev.5b00511). For a liquid of a hundred molecules, whose temperature fluctuates, the mean of
    this flux is too high, because :math:`e_s` is convex.

    Parameters
    ----------
    temperature
        Temperature of the liquid [K].
    accommodation
        Share of the molecules that stick when they hit the liquid, :math:`\alpha`.

    Examples
    --------
    From a hundred square nanometres at 20 degC about eight molecules leave in a nanosecond:

    >>> round(float(hertz_knudsen_flux(293.15)) * 1e-25, 1)
    8.5
    """
    t = checked_temperature(as_floats(temperature))
    share = checked_not_negative(as_floats(accommodation), "accommodation")
    speed = np.sqrt(2.0 * np.pi * WATER.molecule_mass * BOLTZMANN * np.maximum(t, _water.COLDEST))
    flux: FloatArray = share * _water.saturation(t) / speed
    return flux


def microcanonical_flux(
    thermal_energy: ArrayLike, molecules: ArrayLike, nuclei_heat: ArrayLike = 0.0, accommodation: ArrayLike = 1.0
) -> FloatArray:
    r"""Return the number of molecules that leave a liquid of given energy, of any size, per area and time [m^-2 s^-1].

    With :math:`U' = U - \varphi`, :math:`C' = C - c_l` and Q such that a large liquid follows
    :func:`hertz_knudsen_flux`,

    .. math:: Q\, \frac{U'^{\,C' + 5/2}}{\Gamma(C' + 7/2)}\, \frac{\Gamma(C)}{U^{C-1}} ,

    and zero if U' is not positive (Weisskopf 1937, doi:10.1103/PhysRev.52.295). Its mean over the energies of a liquid
    in a heat bath, distributed as :math:`U^{C-1} e^{-U/kT}`, is the flux of Hertz and Knudsen at that temperature, for
    any n.

    Parameters
    ----------
    thermal_energy
        Thermal energy of the liquid U, C k times its temperature [J].
    molecules
        Molecules of the liquid n; for 0 the flux is 0.
    nuclei_heat
        Heat capacity of condensation nuclei at the temperature of the liquid, :math:`C_n` [k].
    accommodation
        Share of the molecules that stick when they hit the liquid.

    Examples
    --------
    From fifty molecules with the energy of 20 degC fewer evaporate than from a large liquid of that temperature:

    >>> energy = 50 * LIQUID_HEAT * BOLTZMANN * 293.15
    >>> round(float(microcanonical_flux(energy, 50) / hertz_knudsen_flux(293.15)), 2)
    0.74
    """
    from scipy import special  # loads slowly

    energy = checked_not_negative(as_floats(thermal_energy), "thermal_energy") / BOLTZMANN
    number = checked_not_negative(as_floats(molecules), "molecules")
    nuclei = checked_not_negative(as_floats(nuclei_heat), "nuclei_heat")
    share = checked_not_negative(as_floats(accommodation), "accommodation")
    leaves = (number >= 1.0) & (energy > BINDING)
    u = np.where(leaves, energy, 2.0 * BINDING)
    before = LIQUID_HEAT * np.maximum(number, 1.0) + nuclei
    after = before - LIQUID_HEAT
    weight = (after + LEAVING_FREEDOM - 1.0) * np.log(u - BINDING) - special.gammaln(after + LEAVING_FREEDOM)
    weight = weight - (before - 1.0) * np.log(u) + special.gammaln(before)
    t = TRIPLE_TEMPERATURE
    prefactor = float(hertz_knudsen_flux(t)) * np.exp(BINDING / t)
    flux: FloatArray = np.where(
        leaves, share * prefactor * np.exp(weight - (LEAVING_FREEDOM - LIQUID_HEAT) * np.log(t)), 0.0
    )
    return flux


def _mean_density(edges: ArrayLike, temperature: float, shape: float, least: float) -> FloatArray:
    from scipy import special  # loads slowly

    bounds = np.maximum(as_floats(edges) / BOLTZMANN - least, 0.0)
    warm = checked_positive(as_floats(temperature), "temperature")
    density: FloatArray = np.diff(special.gammainc(shape, bounds / warm)) / np.diff(as_floats(edges))
    return density


def leaving_energy_density(edges: ArrayLike, temperature: float) -> FloatArray:
    r"""Return the distribution of the energy of molecules that leave a liquid, (bin,) [J^-1].

    The energy is the binding energy :math:`\varphi` and a gamma variate, :math:`\varphi + kT\, \Gamma(2 + 3/2)`
    (Weisskopf 1937, doi:10.1103/PhysRev.52.295).

    Parameters
    ----------
    edges : (bin + 1,)
        Bounds of the bins over which the density is averaged [J].
    temperature
        Temperature of the liquid [K].

    Examples
    --------
    At 20 degC no molecule leaves with less than 94 zJ:

    >>> edges = np.array([0.0, 94e-21, 200e-21])
    >>> (leaving_energy_density(edges, 293.15) * np.diff(edges)).round(3)
    array([0., 1.])
    """
    return _mean_density(edges, temperature, LEAVING_FREEDOM, BINDING)


def staying_energy_density(edges: ArrayLike, temperature: float) -> FloatArray:
    r"""Return the distribution of the thermal energy of molecules in a liquid, (bin,) [J^-1].

    The energy is a gamma variate of the heat capacity, :math:`kT\, \Gamma(c_l / k)`.

    Parameters
    ----------
    edges, temperature
        As for :func:`leaving_energy_density`.

    Examples
    --------
    At 20 degC one molecule in three thousand has enough energy to leave:

    >>> edges = np.array([0.0, 94e-21, 1000e-21])
    >>> round(1.0 / float(staying_energy_density(edges, 293.15)[1] * np.diff(edges)[1]), -3)
    3000.0
    """
    return _mean_density(edges, temperature, LIQUID_HEAT, 0.0)

"""Two gases of unlike molecules that mix: the solution of their linear Boltzmann equation."""

from __future__ import annotations

import functools
import math

import numpy as np
from numpy.polynomial.legendre import leggauss, legval
from numpy.typing import ArrayLike, NDArray

from atmosbox.theory._array import FloatArray, as_floats

__all__ = ["diffusivity_factor", "mixing_wave"]

_ORDER = 6
"""Number of polynomials of the energy: the sixth changes D by less than 1e-4 of its value."""
_SHAPES = 8
"""Highest degree of the spherical harmonics of the direction."""


@functools.lru_cache(maxsize=16)
def diffusivity_factor(mass: tuple[float, float], share: float = 0.5) -> float:
    r"""Return the mutual diffusion coefficient of thin gases of hard spheres over its first approximation.

    The first approximation of Chapman and Enskog does not depend on the composition; the whole series does (Chapman and
    Cowling 1970, The Mathematical Theory of Non-uniform Gases, chapters 8 and 9).

    Parameters
    ----------
    mass
        Mass of a molecule of each gas [mass].
    share
        Share of the molecules that belong to the first gas, above 0 and below 1.

    Examples
    --------
    For equal molecules it is 1.0190. For a trace of light molecules among heavy ones it is 1.132, or
    :math:`32 / 9 \pi`, and this series lacks a hundredth of that; for a trace of heavy molecules among light ones it is
    1:

    >>> round(diffusivity_factor((1.0, 1.0)), 4), round(diffusivity_factor((1e-4, 1.0), 1e-6), 3)
    (1.019, 1.124)
    """
    collide = _collisions(mass, share, 1)
    push = np.zeros(2 * _ORDER)
    push[0], push[_ORDER] = 1.0 / mass[0], -1.0 / mass[1]
    drift = np.linalg.lstsq(collide, push, rcond=1e-13)[0]
    found = (drift[0] / mass[0] - drift[_ORDER] / mass[1]) * share * (1.0 - share)
    reduced = mass[0] * mass[1] / (mass[0] + mass[1])
    return float(found / (0.375 * math.sqrt(1.0 / (2.0 * math.pi * reduced))))


def mixing_wave(mass: tuple[float, float], wave_number: float, times: ArrayLike) -> FloatArray:
    r"""Return how a wave of the composition of two gases, half of each, decays from the height 1, (time,).

    Both densities vary as :math:`\cos kx` with opposite signs, at constant pressure and temperature. For equal
    molecules the wave decays as :math:`e^{-D k^2 t}`. With unlike molecules the diffusion carries heat (Dufour's
    effect), so that the wave is the sum of two waves, one of which decays more slowly than by D alone; and as the light
    molecules are faster, the gas starts to oscillate. All this is contained in the linear Boltzmann equation (Chapman
    and Cowling 1970, section 8.41)

    .. math:: \partial_t \varphi + i k c_z \varphi = -C \varphi

    which is solved here with polynomials of the energy and spherical harmonics of the direction. A dense gas has g
    times as many collisions; use g n for n.

    Parameters
    ----------
    mass
        Mass of a molecule of each gas [mass of the first].
    wave_number
        The wave number k [:math:`n \sigma^2`].
    times : (time,)
        Time since the beginning [:math:`\sqrt{m / kT} / n \sigma^2`].

    Examples
    --------
    For equal molecules half of the wave is left at the time that theory's D gives; for unlike ones more is left:

    >>> k = 0.1
    >>> half = math.log(2.0) / (0.215581 * k**2)
    >>> mixing_wave((1.0, 1.0), k, [0.0, half]).round(3).tolist()
    [1.0, 0.5]
    >>> slower = 0.375 * diffusivity_factor((1.0, 10.0)) * math.sqrt(1.1 / (2.0 * math.pi)) * k**2
    >>> mixing_wave((1.0, 10.0), k, [math.log(2.0) / slower]).round(3).tolist()
    [0.505]
    """
    rates, height = _decaying_parts(float(mass[1] / mass[0]), float(wave_number))
    return np.asarray((np.exp(np.multiply.outer(as_floats(times), rates)) @ height).real)


@functools.lru_cache(maxsize=4)
def _decaying_parts(mass_ratio: float, wave_number: float) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
    """Return the rates of the exponentials whose sum is the wave, and their heights."""
    collide, stream, norm = _equation(mass_ratio)
    scale = 1.0 / np.sqrt(norm)
    rates, modes = np.linalg.eig(-(1j * wave_number * stream + collide) * np.outer(scale, scale))
    opposed = np.zeros(len(norm), np.complex128)
    opposed[0], opposed[_ORDER] = 1.0 / scale[0], -1.0 / scale[_ORDER]
    return rates, (opposed @ modes) * np.linalg.solve(modes, opposed)


@functools.lru_cache(maxsize=4)
def _equation(mass_ratio: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    r"""Return :math:`C`, :math:`c_z` and the squares of the polynomials, harmonic by harmonic, gas by gas.

    The polynomials are :math:`c^l P_l(\cos\vartheta) L_p^{(l + 1/2)}(m c^2 / 2)`, products are means over both gases.
    """
    mass, share, size = (1.0, mass_ratio), 0.5, 2 * _ORDER
    whole = (_SHAPES + 1) * size
    collide, stream, norm = np.zeros((whole, whole)), np.zeros((whole, whole)), np.zeros(whole)
    energy, chance = _laguerre_points(_ORDER + _SHAPES + 2, 0.5)
    chance = chance / chance.sum()
    order = np.arange(_ORDER)
    for harmonic in range(_SHAPES + 1):
        block = slice(harmonic * size, (harmonic + 1) * size)
        collide[block, block] = _collisions(mass, share, harmonic)
        for gas, one in enumerate(mass):
            here = slice(harmonic * size + gas * _ORDER, harmonic * size + (gas + 1) * _ORDER)
            powers = np.array([math.gamma(p + harmonic + 1.5) / math.gamma(p + 1.0) for p in order]) / math.gamma(1.5)
            norm[here] = share * (2.0 / one) ** harmonic * powers / (2 * harmonic + 1)
            if harmonic > 0:
                below = slice(here.start - size, here.stop - size)
                above, under = (
                    np.array([_laguerre(p, shape, energy) for p in range(_ORDER)])
                    for shape in (harmonic + 0.5, harmonic - 0.5)
                )
                angle = share * harmonic / ((2.0 * harmonic - 1.0) * (2.0 * harmonic + 1.0))
                stream[here, below] = angle * (above * (chance * (2.0 * energy / one) ** harmonic)) @ under.T
                stream[below, here] = stream[here, below].T
    return collide, stream, norm


def _collisions(mass: tuple[float, float], share: float, harmonic: int) -> FloatArray:
    """Return the collision matrix between the polynomials of one harmonic: the rates at which they decay."""
    shares = share, 1.0 - share
    found = shares[0] * shares[1] * _of_pairs(mass, harmonic)
    for gas, one in enumerate(mass):
        pairs = _of_pairs((one, one), harmonic)
        both = pairs[:_ORDER, :_ORDER] + pairs[:_ORDER, _ORDER:] + pairs[_ORDER:, :_ORDER] + pairs[_ORDER:, _ORDER:]
        here = slice(gas * _ORDER, (gas + 1) * _ORDER)
        found[here, here] += 0.5 * shares[gas] ** 2 * both
    return found


def _of_pairs(mass: tuple[float, float], harmonic: int) -> FloatArray:
    r"""Return :math:`\langle \pi g (X Y - \bar X \bar Y) \rangle` for polynomials X, Y of either molecule of a pair.

    After a collision of hard spheres every direction is equally likely in the centre-of-mass system. So the mean of
    each polynomial over that direction is left, :math:`\bar X`, which points along the velocity of the centre.
    """
    total = mass[0] + mass[1]
    reduced = mass[0] * mass[1] / total
    points = harmonic + 2 * _ORDER  # with so many points all integrals are exact
    nodes, of_centre = _laguerre_points(points, 0.5)
    centre = np.sqrt(2.0 * nodes / total)[:, None, None]
    nodes, of_speed = _laguerre_points(points, 1.0)
    speed = np.sqrt(2.0 * nodes / reduced)[None, :, None]
    cosine, of_angle = leggauss(points)
    weight = np.multiply.outer(of_centre / of_centre.sum(), of_speed / of_speed.sum())
    of_angle = 0.5 * of_angle

    def parts(sign: float, other: float) -> tuple[FloatArray, FloatArray]:
        """Return the components of the velocity of one molecule across and along the velocity of the centre."""
        own = sign * other / total * speed
        return own * np.sqrt(1.0 - cosine**2), centre + own * cosine

    velocities = parts(1.0, mass[1]), parts(-1.0, mass[0])
    sizes = [np.hypot(*velocity) for velocity in velocities]
    polynomials, means = [], []
    for (_, along), size, one in zip(velocities, sizes, mass, strict=True):
        turned = _legendre(harmonic, along / size)
        each = [size**harmonic * _laguerre(p, harmonic + 0.5, 0.5 * one * size**2) for p in range(_ORDER)]
        polynomials.append(np.array(each).reshape(_ORDER, -1))
        means.append(np.array([(x * turned) @ of_angle for x in each]).reshape(_ORDER, -1))
    between = (velocities[0][0] * velocities[1][0] + velocities[0][1] * velocities[1][1]) / (sizes[0] * sizes[1])
    chance = np.multiply.outer(weight, of_angle).ravel()
    turned = _legendre(harmonic, between).ravel() * chance
    rows = [[(polynomials[a] * (chance if a == b else turned)) @ polynomials[b].T for b in range(2)] for a in range(2)]
    mean = np.concatenate(means)
    rate = math.pi * math.sqrt(8.0 / (math.pi * reduced))
    return np.asarray(rate / (2 * harmonic + 1) * (np.block(rows) - (mean * weight.ravel()) @ mean.T))


# scipy has these functions, but takes longer to load than all the rest of a scene's description.


def _laguerre_points(number: int, alpha: float) -> tuple[FloatArray, FloatArray]:
    r"""Return the points and weights that integrate :math:`x^\alpha e^{-x}` times a polynomial.

    They are the eigenvalues of a matrix (Golub and Welsch 1969, doi:10.1090/S0025-5718-69-99647-1).
    """
    order = np.arange(number)
    beside = np.sqrt(order[1:] * (order[1:] + alpha))
    points, vectors = np.linalg.eigh(np.diag(2.0 * order + alpha + 1.0) + np.diag(beside, 1) + np.diag(beside, -1))
    return points, math.gamma(alpha + 1.0) * vectors[0] ** 2


def _laguerre(number: int, alpha: float, x: FloatArray) -> FloatArray:
    r"""Return the polynomial :math:`L_n^{(\alpha)}(x)`."""
    before, now = np.zeros_like(x), np.ones_like(x)
    for n in range(number):
        before, now = now, ((2.0 * n + 1.0 + alpha - x) * now - (n + alpha) * before) / (n + 1.0)
    return now


def _legendre(number: int, x: FloatArray) -> FloatArray:
    """Return the polynomial :math:`P_n(x)`."""
    return np.asarray(legval(x, [0.0] * number + [1.0]))

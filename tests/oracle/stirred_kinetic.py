r"""A stirred column by the kinetic equation, to compare with Fourier's law: how much warmer it is, and its lapse rate.

A model, written without the engine: air as dense everywhere as the mean of the column, in which an element that climbs
by z cools by the factor :math:`s = e^{-2z/(f+2)}` (kT of the floor, m and g are 1). Its molecules depart by a share h
from those at rest at the temperature of the floor; collisions are those of Bhatnagar, Gross and Krook (1954),
doi:10.1103/PhysRev.94.511, with the conductivity of the gas,

.. math:: v\,\partial_z h = \nu\,[\rho + \tau\,(\varepsilon - \tfrac f2) - h]
          + \sum_j c_{ij} [s_{ij} (h_j - \rho_j) + \rho + (s_{ij} - 1) (\varepsilon - \tfrac f2) - h],

with the rates :math:`c_{ij}` at which elements change places. The floor sends back molecules of its own temperature,
the ceiling reflects. Of h two means over the motion along the layers are enough. Fourier's law with the jump of the
temperature at the floor is solved on the same layers.
"""

import math
from typing import NamedTuple

import numpy as np

JUMP = 2.127


class Profiles(NamedTuple):
    """Heights of layers of equal mass; temperatures minus that of the floor, by the kinetic equation and by Fourier."""

    height: np.ndarray
    kinetic: np.ndarray
    fourier: np.ndarray


def speeds(number):
    """Return points and weights for means over half of a Maxwellian, exact for polynomials up to 2 number - 1."""
    x, w = np.polynomial.legendre.leggauss(400)
    x, w = 6.0 * (x + 1.0), 6.0 * w
    w = w * np.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi)
    diagonal, beside, norms = [], [], []
    before, now = np.zeros_like(x), np.ones_like(x)
    for k in range(number):
        norms.append(float((w * now * now).sum()))
        diagonal.append(float((w * x * now * now).sum()) / norms[-1])
        beside.append(math.sqrt(norms[-1] / norms[-2]) if k else 0.0)
        before, now = now, (x - diagonal[-1]) * now - beside[-1] ** 2 * before
    points, vectors = np.linalg.eigh(np.diag(diagonal) + np.diag(beside[1:], 1) + np.diag(beside[1:], -1))
    return points, norms[0] * vectors[0] ** 2


def rates(layers, rate, parcel, lifts):
    """Return the rates at which elements of equal mass change places : (layer, layer)."""
    share = (np.arange(layers) + 0.5) / layers
    least, most = (round(lift * layers) for lift in lifts)
    found = np.zeros((layers, layers))
    for step in range(least, most + 1):
        room = 1.0 - step / layers - parcel
        covered = np.clip(np.minimum(share, room) - np.maximum(share - parcel, 0.0), 0.0, None)[: layers - step]
        part = (0.5 if step in (least, most) else 1.0) / (most - least)
        found[np.arange(layers - step), np.arange(step, layers)] = part * rate * covered / room
    return found + found.T


def stirred_profiles(knudsen, stirring, freedom, *, top=1.305, parcel=0.05, lifts=(0.15, 0.35), layers=120, points=6):
    """Return the temperatures of a column, for a Knudsen number and a rate of stirring as the scene defines them."""
    step = top / layers
    height = (np.arange(layers) + 0.5) * step
    path = knudsen * top / -math.expm1(-top)
    # conductivity over density: Chapman and Enskog, 5/4 of it for molecules that rotate
    free = 1.0 / (math.sqrt(2.0) * math.pi * path)
    conducts = 1.025218 * 75.0 / 64.0 / math.sqrt(math.pi) / free * (1.25 if freedom > 3 else 1.0)
    lift = np.linspace(*lifts, 101)
    square = parcel * float(np.mean(lift**2 / (1.0 - parcel - lift))) * top**2
    change = rates(layers, 2.0 * stirring * conducts / (freedom * square), parcel, lifts)
    moved = change * np.exp(2.0 / (freedom + 2.0) * (height[None, :] - height[:, None]))
    out, given, across = change.sum(axis=1), (moved - change).sum(axis=1), 0.5 * (freedom - 1.0)

    # Fourier: layers in a row, the floor at the bottom
    matrix = 0.5 * freedom * step * (moved - np.diag(out))
    link = conducts / step
    for one, other in ((np.arange(layers - 1), np.arange(1, layers)), (np.arange(1, layers), np.arange(layers - 1))):
        matrix[one, one] -= link
        matrix[one, other] += link
    matrix[0, 0] -= conducts / (0.5 * step + JUMP * path)
    fourier = np.linalg.solve(matrix, -0.5 * freedom * step * given)

    # kinetic: both means at the edges of the layers, at each speed up and down
    v, w = speeds(points)
    v, w = np.concatenate([v, -v]), np.concatenate([w, w])
    size = len(v)
    frequency = 0.5 * (freedom + 2.0) / conducts
    middle = 0.5 * (np.eye(layers, layers + 1) + np.eye(layers, layers + 1, 1))
    ascent = (np.eye(layers, layers + 1, 1) - np.eye(layers, layers + 1)) / step
    leaves = np.diag(out)
    motion = 0.5 * v * v - 0.5
    unknown = size * (layers + 1)
    whole, source = np.zeros((2 * unknown, 2 * unknown)), np.zeros(2 * unknown)
    rows = np.arange(2 * size * layers).reshape(2, size, layers)

    def columns(kind, k):
        first = kind * unknown + k * (layers + 1)
        return slice(first, first + layers + 1)

    for kind in range(2):
        heat = motion if kind == 0 else np.full(size, across)
        for k in range(size):
            row = rows[kind, k]
            own = v[k] * ascent + (frequency * np.eye(layers) + leaves - moved) @ middle
            whole[row[0] : row[-1] + 1, columns(kind, k)] += own
            source[row] = given * heat[k]
            for j in range(size):
                # temperature of both means; density of the first one alone, which stays when elements change places
                for other, weight in ((0, motion[j]), (1, 1.0)):
                    part = frequency * heat[k] * w[j] * weight / (0.5 * freedom) * np.eye(layers)
                    if kind == other == 0:
                        part = part + w[j] * (frequency * np.eye(layers) + leaves - moved)
                    whole[row[0] : row[-1] + 1, columns(other, j)] -= part @ middle
    last = 2 * size * layers
    for kind in range(2):
        for k in range(points):
            whole[last, columns(kind, k).start] = 1.0  # from the floor
            whole[last + 1, columns(kind, k + points).stop - 1] = 1.0  # from the ceiling
            whole[last + 1, columns(kind, k).stop - 1] = -1.0
            last += 2
    found = np.linalg.solve(whole, source).reshape(2, size, layers + 1) @ middle.T
    kinetic = np.einsum("k,kl->l", w * motion, found[0]) + np.einsum("k,kl->l", w, found[1])
    return Profiles(height, kinetic / (0.5 * freedom), fourier)


def lapse(profiles, part=0.1):
    """Return the decrease of the logarithm of both temperatures with height, away from floor and ceiling."""
    inner = slice(round(part * len(profiles.height)), -round(part * len(profiles.height)))
    return tuple(-np.polyfit(profiles.height[inner], np.log1p(each[inner]), 1)[0] for each in profiles[1:])

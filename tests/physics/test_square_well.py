"""Molecules that attract each other by a square well: the gas, compared with theory, and the liquid that forms."""

import itertools
import math

import numpy as np
import pytest

from atmosbox import theory
from atmosbox.engine import AttractingParcelSet, Periodic, RandomBath, Specular, SquareWell, random_positions
from atmosbox.scene.statistics import block_average
from tests.oracle.well_energy import square_well_energy

ROUND, WELL = (Periodic(),) * 6, SquareWell(1.5, 1.0)


def well_gas(number, density, kT, *, rate, seed, walls=ROUND, well=WELL, **box):
    """Return a cube of molecules that attract each other, with a random bath."""
    random = np.random.default_rng(seed)
    length = ((number / density) ** (1.0 / 3.0),) * 3
    return AttractingParcelSet(
        random_positions(length, np.ones(number), random, periodic=tuple(wall in ROUND for wall in walls[::2])),
        random.normal(size=(number, 3)) * math.sqrt(kT), length=length, walls=walls, well=well,
        bath=RandomBath(kT, rate), seed=seed, **box,
    )  # fmt: skip


@pytest.mark.parametrize("range_", [1.2, 1.5, 2.0])
def test_virial_coefficients_are_the_integrals_of_mayer(range_):
    """B2 = -1/2 int f, B3 = -1/3 int f f f: by quadrature, and by Monte Carlo of 4 million triples."""
    kT = 1.3
    second = 0.0
    for low, high, f in ((0.0, 1.0, -1.0), (1.0, range_, math.expm1(1.0 / kT))):
        r = np.linspace(low, high, 10_001)
        second -= 0.5 * np.trapezoid(4.0 * np.pi * r**2 * f, r)
    assert float(theory.square_well_second_virial(kT, range_)) == pytest.approx(second, rel=1e-5)
    random = np.random.default_rng(7)
    one, two = (random.uniform(-range_, range_, (4_000_000, 3)) for _ in range(2))

    def mayer(separation):
        square = np.sum(separation**2, axis=1)
        return np.where(square < 1.0, -1.0, np.where(square < range_**2, np.expm1(1.0 / kT), 0.0))

    product = -mayer(one) * mayer(two) * mayer(one - two) / 3.0 * (2.0 * range_) ** 6
    error = product.std() / math.sqrt(product.size)
    assert float(theory.square_well_third_virial(kT, range_)) == pytest.approx(product.mean(), abs=4.0 * error)


@pytest.mark.parametrize(
    ("kT", "runs"), [(1.5, 2), *(pytest.param(kT, 4, marks=pytest.mark.nightly) for kT in (1.0, 1.5, 2.0, 3.0))]
)
def test_a_thin_gas_has_the_pressure_and_energy_of_the_virial_series(kT, runs):
    """Z - 1 and u at phi = .01, from the momentum that pairs transfer: B2 and B3 together, in 4 standard errors.

    Four terms of the series would differ from three by up to 4e-5 here; B3 makes 5e-4 to 1.3e-3 of Z.
    """
    number, density = 600, 0.01 * 6.0 / math.pi
    volume = number / density
    factors, energies = [], []
    for seed in range(runs):
        gas = well_gas(number, density, kT, rate=0.05, seed=10 * seed + 1)
        gas.advance(60.0)
        for frame in range(60):
            before = gas.virial.sum()
            wells = []
            for part in range(4):
                gas.advance(60.0 + 10.0 * frame + 2.5 * (part + 1))
                wells.append(gas.well_energy / number)
            factors.append(1.0 + (gas.virial.sum() - before) / (3.0 * volume * 10.0 * density * kT))
            energies.append(np.mean(wells))
        assert gas.ledger() < 1e-12
    factor, energy = block_average(factors, 24), block_average(energies, 24)
    print(kT, factor, float(theory.square_well_compressibility(density, kT)), energy)
    assert factor.standard_error < 2.5e-3
    assert abs(factor.mean - theory.square_well_compressibility(density, kT)) < 4.0 * factor.standard_error
    assert abs(energy.mean - square_well_energy(density, kT)) < 4.0 * energy.standard_error


def test_air_that_does_not_attract_keeps_out_of_the_wells():
    """How many pairs are near: vapour e^(1/T) times as many as chance, air as many, but for excluded volume (5 %)."""
    number, density, kT = 500, 0.01, 1.0
    species = np.arange(number) % 2
    table = SquareWell(1.5, [[1.0, 0.0], [0.0, 0.0]])
    between = {"walls": (*ROUND[:4], Specular(), Specular()), "gravity": 1e-12}  # as other tests have: no new kernels
    gas = well_gas(number, density, kT, rate=0.2, seed=3, well=table, species=species, **between)
    near = {(0, 0): [], (0, 1): [], (1, 1): []}
    for frame in range(60):
        gas.advance(20.0 + 8.0 * frame)
        assert (species[gas.pairs()] == 0).all()
        x = gas.snapshot().position
        apart = x[:, None, :] - x[None, :, :]
        apart -= np.where(gas.periodic, gas.length * np.rint(apart / gas.length), 0.0)
        i, j = np.nonzero(np.triu(np.sum(apart**2, axis=2) < 2.25, 1))
        kinds = np.sort(np.stack([species[i], species[j]], axis=1), axis=1)
        for pair in near:
            near[pair].append(np.sum((kinds == pair).all(axis=1)))
    shell = 4.0 * math.pi / 3.0 * (1.5**3 - 1.0) * density
    half = number // 2
    for pair, factor in {(0, 0): math.exp(1.0 / kT), (0, 1): 1.0, (1, 1): 1.0}.items():
        mean = block_average(near[pair], 12)
        chance = (half * half if pair == (0, 1) else 0.5 * half * half) * shell / number
        assert abs(mean.mean - factor * chance) < 4.0 * mean.standard_error + 0.05 * factor * chance, pair


@pytest.mark.parametrize(
    ("well", "kT", "density"),
    [
        (SquareWell(1.01, 1.0), 1.0, 0.3),
        (SquareWell(2.0, 1.0), 1.0, 0.3),
        (SquareWell(1.5, 1e6), 1.0, 0.1),
        (SquareWell(1.5, 0.0), 1.0, 0.5),
        (WELL, 0.3, 0.2),
        (WELL, 100.0, 0.5),
        (WELL, 0.5, 0.95),
    ],
    ids=["narrow", "wide", "very deep", "no depth", "cold", "hot", "crystal"],
)
def test_extreme_wells_keep_their_energy(well, kT, density):
    number = 108
    side = (number / density) ** (1.0 / 3.0)
    half = side / 6.0
    corners = [c for c in itertools.product(range(6), repeat=3) if sum(c) % 2 == 0]
    position = (np.array(corners) + 0.25) * half
    assert len(position) == number
    velocity = np.random.default_rng(2).normal(size=(number, 3)) * math.sqrt(kT)
    box = AttractingParcelSet(position, velocity, length=(side,) * 3, walls=ROUND, well=well)
    # molecules that fall into such deep wells become a thousand times as fast
    box.advance(10.0 / math.sqrt(max(kT, 1e-4 * well.depth)))
    assert box.contacts > 20
    assert box.ledger() < 1e-12

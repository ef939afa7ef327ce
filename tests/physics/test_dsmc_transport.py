"""Transport in direct simulation Monte Carlo: viscosity and heat conduction, compared with Chapman and Enskog.

Means allow 4 standard errors from 20 blocks (a false alarm once in 1 500 for a fresh seed, never for these).
"""

import math

import numpy as np
import pytest

from atmosbox.engine import HeatBath, Periodic, maxwell_velocities
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.scene.statistics import block_average

pytestmark = pytest.mark.skipif(not COMPILED, reason="so many molecules take hours without numba")

P = Periodic()
BLOCKS = 20
VISCOSITY = 1.016034 * 5.0 / 16.0 / math.sqrt(math.pi)
CONDUCTIVITY = 1.025218 * 75.0 / 64.0 / math.sqrt(math.pi)
"""For hard spheres in sqrt(m kT) / sigma^2 and k sqrt(kT / m) / sigma^2, to fourth order in Sonine polynomials."""


def diameter(number_density):
    """Return the diameter of molecules whose mean free path is 1."""
    return 1.0 / math.sqrt(math.sqrt(2.0) * math.pi * number_density)


@pytest.mark.parametrize(
    "steps", [20_000, pytest.param(500_000, marks=pytest.mark.nightly)], ids=["5 percent", "1 percent"]
)
def test_viscosity_is_that_of_chapman_and_enskog(steps):
    # Green and Kubo: the fluctuations of the five components of the stress, over their correlation time
    number, density, lags = 1000, 80.0, 60
    volume, sigma = number / density, diameter(density)
    rng = np.random.default_rng(5)
    box = DsmcParcel(
        rng.random((number, 3)) * math.cbrt(volume),
        maxwell_velocities(1.0, np.ones(number), rng, exact=True),
        length=(math.cbrt(volume),) * 3,
        walls=(P,) * 6,
        diameter=sigma,
        seed=5,
        dt=0.2,
    )
    step = box.time_step
    box.advance(100 * step)
    stress = np.empty((5, steps))
    for k in range(steps):
        box.advance((101 + k) * step)
        velocity = box.snapshot().velocity
        flow = velocity.T @ velocity
        shear = flow[0, 1], flow[0, 2], flow[1, 2]
        stress[:, k] = *shear, (flow[0, 0] - flow[1, 1]) / 2.0, (flow[0, 0] + flow[1, 1] - 2.0 * flow[2, 2]) / 12.0**0.5
    found = []
    for block in np.array_split(stress, BLOCKS, axis=1):
        last = block.shape[1] - lags
        memory = np.array([np.mean(block[:, :last] * block[:, lag : last + lag]) for lag in range(lags)])
        found.append(step / volume * (memory.sum() - 0.5 * memory[0]) * sigma**2 / VISCOSITY)
    mean, error = block_average(found, BLOCKS)
    assert error < 0.07
    assert abs(mean - 1.0) < 4.0 * error


@pytest.mark.parametrize(("cell", "width"), [pytest.param(0.5, 3.0, marks=pytest.mark.nightly), (1.0, 6.0)])
def test_conductivity_is_that_of_chapman_and_enskog_and_grows_with_the_square_of_the_cell(cell, width):
    # a slab between two walls: T^(3/2) is linear in its middle, far from the walls
    height, occupancy, layers = 25.0, 10.0, 30
    cold, hot = 0.5, 1.5
    density = occupancy / cell**3
    number = round(density * width**2 * height)
    sigma = diameter(density)
    rng = np.random.default_rng(8)
    share = np.linspace(0.0, 1.0, 2001)
    warm = (cold**1.5 + (hot**1.5 - cold**1.5) * share) ** (2.0 / 3.0)
    below = np.cumsum(1.0 / warm)
    z = np.interp(rng.random(number), below / below[-1], share)
    x = np.column_stack([rng.random((number, 2)) * width, 0.5 * sigma + (height - sigma) * z])
    v = rng.normal(size=(number, 3)) * np.sqrt(np.interp(z, share, warm))[:, None]
    walls = (P, P, P, P, HeatBath(cold), HeatBath(hot))
    box = DsmcParcel(
        x, v - v.mean(axis=0), length=(width, width, height), walls=walls, diameter=sigma, seed=8, cell=cell
    )
    step = box.time_step
    box.advance(1500 * step)
    middle = (np.arange(layers) + 0.5) / layers * height
    inner = slice(layers // 4, layers - layers // 4)
    looks, each, kept = 100, 20, box.steps
    temperature, heat = np.empty((BLOCKS, layers)), np.empty(BLOCKS)
    for block in range(BLOCKS):
        before, began = box.wall_heat.copy(), box.time
        energy, count = np.zeros(layers), np.zeros(layers)
        for _ in range(looks):
            kept += each
            box.advance(kept * step)
            now = box.snapshot()
            layer = np.minimum((now.position[:, 2] / height * layers).astype(int), layers - 1)
            count += np.bincount(layer, minlength=layers)
            energy += np.bincount(layer, np.sum(now.velocity**2, axis=1), minlength=layers)
        temperature[block] = energy / count / 3.0
        gained = box.wall_heat - before
        heat[block] = 0.5 * (gained[5] - gained[4]) / (width**2 * (box.time - began))

    def conductivity(chosen):
        slope = np.polyfit(middle[inner], temperature[chosen].mean(axis=0)[inner] ** 1.5, 1)[0]
        return heat[chosen].mean() / (slope / 1.5) * sigma**2 / CONDUCTIVITY

    rest = [conductivity(np.arange(BLOCKS) != left_out) for left_out in range(BLOCKS)]
    error = math.sqrt((BLOCKS - 1) * np.var(rest))
    # Alexander, Garcia and Alder (1998), doi:10.1063/1.869674; the square of the step adds less than 0.1 %
    expected = 1.0 + 0.0453 * cell**2 + 0.0302 * 2.0 * step**2
    assert error < 0.012
    assert abs(conductivity(np.arange(BLOCKS)) - expected) < 4.0 * error

"""A column of gas under gravity: its density profile, its weight, and that it is as warm above as below.

Means allow 4 standard errors from 20 blocks: a false alarm once in 1 500 per comparison for a fresh seed (there are
some 110 here), and never for these. Only mechanics in gravity is put in.
"""

import numpy as np
import pytest

from atmosbox import theory
from atmosbox.engine import HeatBath, Periodic, Specular
from atmosbox.engine.core.measure import layer_sample
from atmosbox.scene.statistics import block_average
from tests.oracle import column_at_rest

S, P = Specular(), Periodic()


def profile(box, edges, step, samples, warm_up):
    """Return the density and kT of layers with their errors, and the mean height with its error."""
    box.advance(warm_up)
    counts, energy, freedom, heights = [], [], [], []
    for _ in range(samples):
        box.advance(box.time + step)
        here = box.snapshot()
        heights.append(here.position[:, 2].mean())
        layers = layer_sample(box, here, len(edges) - 1)
        counts.append(layers.number)
        energy.append(layers.energy)
        freedom.append(layers.freedom)
    area = float(box.length[0] * box.length[1])
    density = block_average(np.array(counts) / (area * np.diff(edges)))
    blocks = 20
    per_block = [
        np.array(a)[-samples // blocks * blocks :].reshape(blocks, -1, len(edges) - 1) for a in (energy, freedom)
    ]
    warmth = 2.0 * per_block[0].sum(axis=1) / per_block[1].sum(axis=1)
    return density, block_average(warmth), block_average(heights)


@pytest.mark.parametrize("depth", [1.0, 5.0])
def test_an_ideal_column_thins_out_as_the_barometric_law_says(gas, depth):
    number, gravity, kT = 1000, 0.5, 1.0
    height = depth * kT / gravity
    walls = (S, S, S, S, HeatBath(kT), HeatBath(kT))
    box = gas(number, (5.0, 5.0, height), walls=walls, diameter=0.0, gravity=gravity, seed=41)
    edges = np.linspace(0.0, height, 11)
    density, warmth, mean_height = profile(box, edges, 3.0, 2000, 200.0)
    truth = theory.hydrostatic_layers(edges, number / 25.0, 0.0, height, kT, 1.0, gravity)
    assert (np.abs(density.mean - truth) <= 4.0 * density.standard_error).all()
    assert density.standard_error[0] / truth[0] < 0.01
    assert truth[0] > 2.0 * (depth > 1.0) * truth[-1]
    exact = float(theory.column_mean_height(height, kT, 1.0, gravity))
    assert abs(mean_height.mean - exact) <= 4.0 * mean_height.standard_error
    assert mean_height.standard_error / exact < 0.005
    # as warm above as below
    assert (np.abs(warmth.mean - kT) <= 4.0 * warmth.standard_error).all()
    assert warmth.standard_error[0] < 0.01


@pytest.mark.parametrize("closed", [False, True])
def test_spheres_in_gravity_stand_as_high_as_their_equation_of_state_says(gas, closed):
    # so thin that spheres pile up only a little along the floor, of which the bulk's equation of state knows nothing
    number, gravity, kT, side, height = 150, 0.1, 1.0, 16.0, 30.0
    bath = S if closed else HeatBath(kT)
    walls = (P, P, P, P, bath, bath)
    rng = np.random.default_rng(43)
    box = gas(number, (side, side, height), walls=walls, gravity=gravity, seed=43)
    if closed:
        # a closed column keeps the energy of its start, so it must start as high as it shall stand
        heights = np.linspace(0.5, height - 0.5, 4001)
        density = column_at_rest.hydrostatic_column(heights, number / side**2, 0.5, height - 0.5, kT, 1.0, gravity, 1.0)
        mean_height = float(np.sum(heights * density) / np.sum(density))
        here = box.snapshot()
        surplus = number * gravity * (here.position[:, 2].mean() - mean_height)
        kinetic = 1.5 * number * kT - surplus
        velocity = rng.standard_normal((number, 3))
        velocity -= velocity.mean(axis=0)
        velocity *= np.sqrt(2.0 * kinetic / np.sum(velocity**2))
        box = gas(number, (side, side, height), walls=walls, gravity=gravity, seed=43, velocity=velocity)
    edges = np.linspace(0.0, height, 16)
    density, warmth, _ = profile(box, edges, 10.0, 4000, 500.0)
    truth = theory.hydrostatic_layers(edges, number / side**2, 0.5, height - 0.5, kT, 1.0, gravity, 1.0)
    filled = float(theory.packing_fraction(truth.max(), 1.0))
    assert filled < 0.03
    assert box.contacts > 300_000
    assert (density.standard_error[:10] / truth[:10] < 0.02).all()
    off = density.mean - truth
    assert (np.abs(off) <= 4.0 * density.standard_error + 0.005 * truth)[1:].all()
    # at contact with the floor n = p / kT is Z times that of the bulk, and it falls off within a diameter
    allowed = 4.0 * density.standard_error[0]
    assert -allowed <= off[0] <= 4.0 * filled * truth[0] + allowed
    # points would be closer to the floor: the difference is measurable
    points = theory.hydrostatic_layers(edges, number / side**2, 0.5, height - 0.5, kT, 1.0, gravity)
    assert np.abs((density.mean - points) / density.standard_error).max() > 10.0
    assert (np.abs(warmth.mean - kT) <= 4.0 * warmth.standard_error + 2.0 * kT / number).all()


def test_heavy_molecules_sink_each_by_its_own_scale_height(gas):
    number, gravity, kT, height = 1000, 0.25, 1.0, 12.0
    mass = np.where(np.arange(number) < number // 2, 1.0, 4.0)
    walls = (S, S, S, S, HeatBath(kT), HeatBath(kT))
    box = gas(number, (6.0, 6.0, height), walls=walls, diameter=0.0, mass=mass, gravity=gravity, seed=44)
    box.advance(300.0)
    rows = []
    for _ in range(1000):
        box.advance(box.time + 8.0)
        z = box.snapshot().position[:, 2]
        rows.append([z[mass == 1.0].mean(), z[mass == 4.0].mean()])
    mean, error = block_average(rows)
    exact = theory.column_mean_height(height, kT, np.array([1.0, 4.0]), gravity)
    assert (error / exact < 0.01).all()
    assert (np.abs(mean - exact) <= 4.0 * error).all()

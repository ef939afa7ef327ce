"""A column of gas under gravity: its density profile, its weight, and that it is as warm above as below.

Means allow 4 standard errors from 20 blocks: a false alarm once in 1 500 per comparison for a fresh seed (there are
some 110 here), and never for these. Only mechanics in gravity is put in.
"""

import numpy as np
import pytest

from atmosbox import theory
from atmosbox.engine import HeatBath, Periodic, Piston
from atmosbox.engine.core.measure import layer_sample
from atmosbox.scene.statistics import block_average

P = Periodic()


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
    walls = (P, P, P, P, HeatBath(kT), HeatBath(kT))
    box = gas(number, (5.0, 5.0, height), walls=walls, diameter=1e-3, gravity=gravity, seed=41)
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


def test_heavy_molecules_sink_each_by_its_own_scale_height(gas):
    number, gravity, kT, height = 1000, 0.25, 1.0, 12.0
    mass = np.where(np.arange(number) < number // 2, 1.0, 4.0)
    facts = {"walls": (P, P, P, P, HeatBath(kT), Piston()), "diameter": 1e-3, "mass": mass, "rotation": 2.0}
    box = gas(number, (6.0, 6.0, height), gravity=gravity, seed=44, **facts)
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

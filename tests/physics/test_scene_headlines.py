"""Scenes against the theory of their known errors: a parcel that rises at a finite speed, a small box of gas.

Each bound is stated with its test: 4 standard errors (a false alarm once in 1 500 for fresh seeds, and never for
these), plus what the theory itself leaves out.
"""

import math

import numpy as np
import pytest

from atmosbox import scenarios
from atmosbox.simulation import runner


def ascents(seeds, **settings):
    """Return how much too warm rising parcels are along their pressures [K], and the last of them."""
    warmer = []
    for seed in seeds:
        found = runner.execute(runner.prepare("lifting-dry", {"seed": seed, **settings})).dataset
        warmer.append(found.parcel_temperature.values - found.adiabat_temperature.values)
    return np.array(warmer), found


@pytest.mark.parametrize(("molecules", "seeds"), [(500, 48), (4000, 16)])
def test_the_energy_of_the_flow_makes_a_larger_parcel_warmer(molecules, seeds):
    # a uniform gas and the flow: 3.02 K at 300 hPa for 500 molecules, 3.61 K for 4000; without the flow 2.94 K for both
    length = 50
    misfits, found = ascents(range(seeds), molecules=molecules, ascent=length)
    scene = scenarios.load("lifting-dry")
    settings = runner.prepare("lifting-dry", {"molecules": molecules, "ascent": length}).settings
    ascent, density = scene._ascent(settings), scene._start(settings)[1]
    pressure, temperature = float(found.parcel_pressure[-1]), float(found.adiabat_temperature[-1])
    expected = (ascent.finite_speed(pressure) - ascent.room(pressure, density)) * temperature
    error = misfits[:, -1].std(ddof=1) / math.sqrt(seeds)
    assert error < 0.15
    assert abs(misfits[:, -1].mean() - expected) <= 4.0 * error

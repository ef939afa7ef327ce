"""The data of a run that a page gets."""

import numpy as np
import pytest

from atmosbox.page import Box, stage
from atmosbox.theory.constants import DRY_AIR, WATER

NANO = Box(length=(2e-8, 2e-8, 2e-8))


def air(count=50, diameter=DRY_AIR.diameter, box=NANO, **more):
    mass = np.full(count, DRY_AIR.molecule_mass)
    arguments = {"title": "t", "mass": mass, "diameter": np.full(count, diameter), "fastest": 900.0}
    return stage(box=box, **arguments | more)


def test_how_much_wider_molecules_are_drawn_is_what_the_stage_says():
    told = air(800).record
    (kind,) = told["species"]
    factor = kind["drawn"] / kind["diameter"]
    assert told["exaggeration"] == f"Molecules are drawn {factor:g} times as wide as they are."


def test_water_is_drawn_smaller_by_the_cube_root_of_its_mass():
    water = np.arange(10) < 4
    mass = np.where(water, WATER.molecule_mass, DRY_AIR.molecule_mass)
    told = air(10, mass=mass, water=water).record
    dry, wet = told["species"]
    assert [dry["name"], wet["name"]] == ["dry air", "water"]
    assert sum(told["kind"]) == 4
    ratio = (WATER.molecule_mass / DRY_AIR.molecule_mass) ** (1.0 / 3.0)
    np.testing.assert_allclose(wet["drawn"] / dry["drawn"], ratio, rtol=1e-5)


def test_discs_keep_their_own_sizes_and_are_halves_by_mass():
    told = air(
        4, mass=[1.0, 2.0, 8.0, 9.0], diameter=[0.1, 0.1, 0.2, 0.2], box=Box((1.0, 0.1, 1.0), planar=True), discs=True
    )
    assert told.record["size"] == [0.1, 0.1, 0.2, 0.2]
    assert told.record["kind"] == [0, 0, 1, 1]
    assert told.record["particle"] == "disc"


@pytest.mark.parametrize(("floor", "drops"), [("pool", 1), ("specular", 10)])
def test_a_pool_is_a_layer_and_a_mist_is_clumps(floor, drops):
    box = Box(NANO.length, walls=("specular",) * 4 + (floor, "specular"))
    told = air(box=box, water=np.arange(50) < 20)
    place, speed = np.full((50, 3), 1e-8), np.ones(50)
    still = told.frame(0, 0.0, NANO.length, place, speed)
    wet = told.frame(0, 0.0, NANO.length, place, speed, liquid=10)
    rainy = told.frame(0, 0.0, NANO.length, place, speed, liquid=10, rained=2)
    assert len(wet) == len(still) + 16 * drops
    assert len(rainy) == len(wet) + 16

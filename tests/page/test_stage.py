"""The data of a run that a page gets."""

import numpy as np
import pytest

from atmosbox.file.molecules import Molecules
from atmosbox.page import stage
from atmosbox.theory.constants import DRY_AIR, WATER

PLAIN = {"discs": False, "time": np.zeros(1), "planar": False, "gravity": False, "water": None}
SPECULAR = {"walls": ("specular",) * 6, "wall_temperature": np.full((1, 6), np.nan), "side": np.full((1, 3), 2e-8)}


def air(count=50, **more):
    mass, diameter = np.full(count, DRY_AIR.molecule_mass), np.full(count, DRY_AIR.diameter)
    placed = {"position": np.ones((1, count, 3)), "speed": np.ones((1, count)), "mass": mass, "diameter": diameter}
    return stage(Molecules(**PLAIN | SPECULAR | placed | more), title="t", fastest=900.0)


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
    halves = {"mass": np.array([1.0, 2.0, 8.0, 9.0]), "diameter": np.array([0.1, 0.1, 0.2, 0.2])}
    told = air(4, side=np.array([[1.0, 0.1, 1.0]]), planar=True, discs=True, **halves)
    assert told.record["size"] == [0.1, 0.1, 0.2, 0.2]
    assert told.record["kind"] == [0, 0, 1, 1]
    assert told.record["particle"] == "disc"


@pytest.mark.parametrize(("floor", "drops"), [("pool", 1), ("specular", 10)])
def test_a_pool_is_a_layer_and_a_mist_is_clumps(floor, drops):
    told = air(walls=("specular",) * 4 + (floor, "specular"), water=np.arange(50) < 20)
    side, place, speed = (2e-8,) * 3, np.full((50, 3), 1e-8), np.ones(50)
    still = told.frame(0, 0.0, side, place, speed)
    wet = told.frame(0, 0.0, side, place, speed, liquid=10)
    rainy = told.frame(0, 0.0, side, place, speed, liquid=10, rained=2)
    assert len(wet) == len(still) + 16 * drops
    assert len(rainy) == len(wet) + 16

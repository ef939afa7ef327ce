"""The data of the box that `atmosbox run --save-molecules` saves, and how a page shows them."""

import numpy as np
import pytest

from atmosbox.file.molecules import molecules
from atmosbox.file.netcdf import read, write
from atmosbox.page.stage import page_box
from atmosbox.simulation import runner
from atmosbox.theory.constants import DRY_AIR, WATER

RUNS = {
    "temperature": {"molecules": 20, "duration": 0.1},
    "lifting-dry": {"molecules": 100, "ascent": 20.0},
    "evaporation": {"molecules": 300, "pool": 40, "duration": 0.5},
    "condensation": {"molecules": 400, "drops": 3, "duration": 0.5, "humidity": 300.0},
}


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """Return a function that runs a small version of a scene, once, and reads its file."""
    folder, known = tmp_path_factory.mktemp("runs"), {}

    def run(scene):
        if scene not in known:
            outcome = runner.execute(runner.prepare(scene, RUNS[scene], save_molecules=True))
            known[scene] = read(write(outcome.dataset, folder / f"{scene}.nc"))
        return known[scene]

    return run


@pytest.mark.parametrize("scene", RUNS)
def test_every_molecule_is_in_the_box_of_its_frame(saved, scene):
    run = saved(scene)
    side, place = run.box_side.values[:, None, :], run.molecule_position.values
    known = np.isfinite(place)
    assert known.any()
    rounding = 1e-6 * side
    assert ((place >= -rounding) | ~known).all()
    assert ((place <= side + rounding) | ~known).all()


def test_the_ceiling_of_a_lifted_parcel_is_where_its_piston_is(saved):
    run = saved("lifting-dry")
    np.testing.assert_allclose(run.box_side.sel(axis="z"), run.piston_height, rtol=1e-12)
    height = run.box_side.sel(axis="z").values
    assert height[-1] > 1.5 * height[0]
    seen = molecules(run)
    assert page_box(seen)["walls"] == ["specular"] * 5 + ["piston"]
    assert page_box(seen)["reach"] == height.max() / 1e-9  # nm


def test_the_floor_under_a_pool_is_a_pool_and_its_molecules_are_water_from_the_start(saved):
    run = saved("evaporation")
    seen = molecules(run)
    assert page_box(seen)["walls"][4:] == ["pool", "piston"]
    assert seen.water.sum() == int(run.vapor_molecule_count[0] + run.liquid_molecule_count[0])
    np.testing.assert_allclose(run.molecule_mass.values[seen.water], WATER.molecule_mass)
    np.testing.assert_allclose(run.molecule_mass.values[~seen.water], DRY_AIR.molecule_mass)
    assert (run.molecule_diameter.values > 0.0).all()


def test_drops_have_places_inside_the_box_and_as_many_as_there_are(saved):
    run = saved("condensation")
    radius, place = run.drop_radius.values, run.drop_position.values
    alive = np.isfinite(radius)
    assert (alive.sum(axis=1) == run.drop_count.values).all()
    np.testing.assert_allclose(np.nanmax(radius, axis=1), run.largest_drop_radius)
    inside = (place >= radius[:, :, None]) & (place <= run.box_side.values[:, None, :] - radius[:, :, None])
    assert (inside | ~alive[:, :, None]).all()

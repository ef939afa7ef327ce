"""The box of a run with its molecules, alone and over the panels of its scene."""

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image
from typer.testing import CliRunner

import atmosbox
from atmosbox.cli import app
from atmosbox.file.molecules import Molecules, molecules
from atmosbox.file.netcdf import write
from atmosbox.plot import figure_with_box
from atmosbox.plot.box_picture import FACES, BoxPicture, Camera, corners
from atmosbox.plot.theme import find


@pytest.fixture(scope="module")
def runs():
    """Short runs of some scenes, with their molecules."""
    wanted = {
        "temperature": {"molecules": 60, "duration": 2.0},
        "lifting-dry": {"molecules": 60, "ascent": 20.0},
        "atmosphere": {"molecules": 80},
        "elastic-collisions": {"molecules": 20, "duration": 3.0},
    }
    return {scene: atmosbox.run(scene, save_molecules=True, **settings) for scene, settings in wanted.items()}


def picture(held):
    return BoxPicture(Figure().add_axes((0.0, 0.0, 1.0, 1.0)), held, find("notes"))


def legend(dataset):
    return picture(molecules(dataset)).legend()


def test_the_box_is_drawn_in_a_unit_that_can_be_read(runs):
    small, large = (picture(molecules(runs[scene])) for scene in ("temperature", "atmosphere"))
    assert (small.unit, large.unit) == ("nm", "km")
    assert 1.0 < small.largest.max() < 1000.0
    assert large.held.walls == ("periodic",) * 4 + ("heat_bath", "specular")


def test_a_piston_moves_and_the_camera_sees_the_largest_box(runs):
    held = molecules(runs["lifting-dry"])
    assert held.walls[5] == "piston"
    assert held.side[-1, 2] > 2.0 * held.side[0, 2]
    camera = Camera(held.side[-1])
    low, high = camera.limits(held.side[0])
    least, most = camera.limits(held.side[-1])
    assert (low >= least - 1e-12).all()
    assert (high <= most + 1e-12).all()


def test_every_wall_has_the_corners_that_lie_in_it():
    ends = corners(np.array([1.0, 2.0, 3.0]))
    for wall, face in enumerate(FACES):
        axis, end = divmod(wall, 2)
        assert set(ends[list(face)][:, axis]) == {end * (axis + 1.0)}


def test_the_caption_says_what_is_tinted_and_how_large_molecules_are_drawn(runs):
    assert legend(runs["temperature"])[1].replace("\u00a0", " ") == "orange: all walls kept at 25 °C"
    words = legend(runs["atmosphere"])
    assert "dashed: periodic sides" in words
    assert words[0].endswith("m wide")
    assert "grey lid: piston" in legend(runs["lifting-dry"])


def box_of(position, **others):
    """Some molecules in a box of 100 nm with plain walls."""
    frames, count = position.shape[:2]
    speed, side = np.full((frames, count), 400.0), np.full((frames, 3), 1e-7)
    each = np.full(count, 3.7e-10)
    walls, unknown = ("specular",) * 6, np.full((frames, 6), np.nan)
    plain = Molecules(False, np.arange(frames), position, speed, each, each, None, side, walls, unknown, False, False)
    return plain._replace(**others)


def test_no_more_molecules_are_drawn_than_can_be_told_apart():
    many = picture(box_of(np.random.default_rng(1).random((2, 9000, 3)) * 1e-7))
    many.artists(1)
    assert many.molecules.get_offsets().shape == (4000, 2)
    assert many.legend()[0].startswith("4000 of 9000 ")


def test_water_and_drops_are_marked_and_molecules_in_the_liquid_are_not_drawn():
    position = np.full((1, 3, 3), 3e-8)
    position[0, 2] = np.nan
    water, drops = np.array([False, True, True]), np.array([[[5e-8, 5e-8, 5e-8, 2e-8]]])
    moist = picture(box_of(position, water=water, drops=drops, liquid=np.array([1])))
    assert moist.legend()[1:] == ["red rims: water", "blue balls: drops"]
    moist.artists(0)
    assert len(moist.molecules.get_offsets()) == 3  # two molecules and a drop


# The figure


def test_the_box_is_drawn_at_the_start_half_way_and_at_the_end_over_all_panels(runs):
    run = runs["lifting-dry"]
    drawn = figure_with_box(run)
    boxes = [axes for axes in drawn.axes if len(axes.collections) > 4]
    lids = [max(path.vertices[:, 1].max() for path in axes.collections[-2].get_paths()) for axes in boxes]
    assert len(lids) == 3
    assert lids == sorted(lids)
    assert lids[2] > lids[0]
    panels = [axes for axes in drawn.axes if axes.get_title("left")]
    assert len(panels) == 2
    lowest = min(axes.get_position().y0 for axes in boxes)
    assert all(axes.get_position().y1 < lowest for axes in panels)
    assert "grey lid: piston" in drawn.get_supxlabel()


@pytest.mark.parametrize(
    ("theme", "scenes"), [("notes", ("atmosphere", "elastic-collisions")), ("slides", ("temperature", "atmosphere"))]
)
def test_every_kind_of_box_has_its_figure(runs, theme, scenes):
    for scene in scenes:
        drawn = figure_with_box(runs[scene], theme)
        assert len([text for text in drawn.texts if text.get_text().startswith("t = ")]) == 3


def test_the_command_draws_the_box_and_says_what_a_run_without_molecules_lacks(runs, tmp_path):
    full = write(runs["lifting-dry"], tmp_path / "full.nc")
    bare = write(runs["lifting-dry"].drop_vars(["molecule_position", "molecule_speed"]), tmp_path / "bare.nc")
    made = CliRunner().invoke(app, ["plot", str(full), "--with-box", "--out", str(tmp_path / "box.png")])
    assert made.exit_code == 0, made.output
    with Image.open(tmp_path / "box.png") as picture:
        assert picture.height > 0.9 * picture.width
    refused = CliRunner().invoke(app, ["plot", str(bare), "--with-box"])
    assert refused.exit_code == 2
    assert "type atmosbox run lifting-dry --save-molecules" in refused.stderr

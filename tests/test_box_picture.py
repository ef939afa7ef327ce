"""The box of a run with its molecules, alone and over the panels of its scene."""

import numpy as np
from matplotlib.figure import Figure

from atmosbox.file.molecules import Molecules, molecules
from atmosbox.plot import figure_with_box
from atmosbox.plot.box_picture import BoxPicture
from atmosbox.plot.theme import find


def picture(held):
    return BoxPicture(Figure().add_axes((0.0, 0.0, 1.0, 1.0)), held, find("notes"))


def legend(dataset):
    return picture(molecules(dataset)).legend()


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


def test_water_and_drops_are_marked_and_molecules_in_the_liquid_are_not_drawn():
    position = np.full((1, 3, 3), 3e-8)
    position[0, 2] = np.nan
    water, drops = np.array([False, True, True]), np.array([[[5e-8, 5e-8, 5e-8, 2e-8]]])
    moist = picture(box_of(position, water=water, drops=drops, liquid=np.array([1])))
    assert moist.legend()[1:] == ["red rims: water", "blue balls: drops"]
    moist.show(0)
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

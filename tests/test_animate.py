"""Films of runs: GIF and MP4, of molecules and of graphs, the same bytes twice, and what is refused."""

import importlib.util

import matplotlib
import numpy as np
import pytest
from PIL import Image

from atmosbox import film
from atmosbox.errors import FileError
from atmosbox.file import netcdf as output
from atmosbox.file.molecules import molecules
from atmosbox.film.film_file import sized
from atmosbox.film.film_sheet import Sheet
from atmosbox.film.graph import Running
from atmosbox.plot.box_picture import project
from atmosbox.plot.theme import FIELD_COLOURS, find, style
from tests.in_process import typed

LOOK = sized(find("notes"), "gif")

needs_ffmpeg = pytest.mark.skipif(importlib.util.find_spec("imageio_ffmpeg") is None, reason="needs atmosbox[movie]")


def test_molecules_are_where_the_file_says_and_their_colour_is_their_speed(runs):
    dataset = runs["temperature"]
    with style(LOOK):
        sheet = Sheet(dataset, LOOK, molecules(dataset))
        sheet.picture(7)
    drawn = sheet.stage.molecules
    seen = np.asarray(drawn.get_offsets())
    places, scale = project(dataset.molecule_position.values[7] * 1e9, sheet.stage.largest)
    order = np.argsort(scale, kind="stable")
    assert seen == pytest.approx(places[order], abs=1e-4)
    colours = matplotlib.colormaps[FIELD_COLOURS](sheet.stage.norm(dataset.molecule_speed.values[7][order]))
    assert np.asarray(drawn.get_facecolor()) == pytest.approx(colours)


def test_curves_end_at_the_clock_and_theory_stands_from_the_start(runs):
    dataset = runs["lifting-dry"]
    with style(LOOK):
        sheet = Sheet(dataset, LOOK)
        whole = len(sheet.graphs[1].axes.lines)
        sheet.picture(4)
        axes = sheet.graphs[1].axes
        shown = [line for line in axes.lines if len(line.get_xdata()) > 2]  # not the cursor
    assert whole > 1  # the adiabat, and the environment
    finite = [int(np.isfinite(np.asarray(line.get_ydata(), float)).sum()) for line in shown]
    assert sorted(set(finite)) == [6, dataset.sizes["elapsed_time"] + 1]  # all begin at the ground


def test_speeds_and_layers_grow_into_what_the_run_has_measured(runs):
    warm, column = Running(runs["temperature"]), Running(runs["atmosphere"])
    bins = np.diff(runs["temperature"].speed_bnds.values, axis=1)[:, 0]
    cold, late = (float(np.sum(warm.values("speed_probability_density", k) * bins)) for k in (0, 999))
    assert cold == pytest.approx(1.0, abs=0.05)
    assert late == pytest.approx(1.0, abs=0.05)
    last = runs["atmosphere"].sizes["elapsed_time"] - 1
    grown = column.values("number_density", last)
    known = np.isfinite(grown)
    assert known.sum() > 5
    assert grown[known] == pytest.approx(runs["atmosphere"].number_density.values[known])


def test_a_gif_has_the_pictures_asked_for_and_lasts_as_long(runs, tmp_path):
    path, _ = film.save(runs["temperature"], tmp_path / "warm.gif", fps=20.0, seconds=0.5)
    with Image.open(path) as opened:
        assert (opened.format, opened.n_frames, opened.size) == ("GIF", 10, (800, 450))
        lasts = 0
        for picture in range(opened.n_frames):
            opened.seek(picture)
            lasts += opened.info["duration"]
        assert lasts == 500
        assert opened.info["loop"] == 0
        assert opened.convert("RGB").getpixel((799, 0)) == (255, 255, 255)


@needs_ffmpeg
def test_an_mp4_is_what_presentations_play(runs, tmp_path):
    import imageio_ffmpeg

    path, _ = film.save(runs["lifting-dry"], tmp_path / "lift.mp4", seconds=0.4, fps=10.0)
    reader = imageio_ffmpeg.read_frames(str(path))
    about = next(reader)
    reader.close()
    assert (about["codec"], about["size"], about["fps"]) == ("h264", (1280, 720), 10.0)
    assert about["pix_fmt"].startswith("yuv420p")
    assert imageio_ffmpeg.count_frames_and_secs(str(path))[0] == 4
    assert [each.name for each in tmp_path.iterdir()] == ["lift.mp4"]


def test_the_command_films_beside_the_file_and_prints_the_path_and_the_same_run_gives_the_same_gif(runs, tmp_path):
    path = output.write(runs["temperature"], tmp_path / "run.nc")
    result = typed("animate", path, "--seconds", "0.2", "--quiet")
    assert result.exit_code == 0, result.output
    assert result.stdout.strip() == str(tmp_path / "run.gif")
    made = (tmp_path / "run.gif").read_bytes()
    assert made[:6] == b"GIF89a"
    assert typed("animate", path, "--seconds", "0.2", "--force").exit_code == 0
    assert (tmp_path / "run.gif").read_bytes() == made


def test_a_run_without_molecules_or_frames_is_refused(runs, tmp_path):
    bare = output.write(runs["lifting-dry"].drop_vars(["molecule_position", "molecule_speed"]), tmp_path / "bare.nc")
    refused = typed("animate", bare)
    assert (refused.exit_code, refused.stdout) == (2, "")
    assert "--save-molecules" in refused.stderr
    assert "--graphs" in refused.stderr
    with pytest.raises(FileError, match="no frame to film"):
        film.save(runs["temperature"].isel(elapsed_time=slice(0, 0)), tmp_path / "none.gif")

"""Films of runs: GIF and MP4, of molecules and of graphs, the same bytes twice, and what is refused."""

import importlib.util
import sys

import numpy as np
import pytest
from PIL import Image
from typer.testing import CliRunner

import atmosbox
from atmosbox import film
from atmosbox.cli import app
from atmosbox.errors import FileError, SettingError
from atmosbox.file import netcdf as output
from atmosbox.file.molecules import molecules
from atmosbox.film.film_file import sized
from atmosbox.film.film_sheet import Sheet
from atmosbox.film.graph import chosen
from atmosbox.film.pace import MOST, pace
from atmosbox.film.running import Running
from atmosbox.plot.run_figure import panels_of
from atmosbox.plot.theme import find, style
from atmosbox.scene.panels import Line, Panel, to_json

LOOK = sized(find("notes"), "gif")

needs_ffmpeg = pytest.mark.skipif(importlib.util.find_spec("imageio_ffmpeg") is None, reason="needs atmosbox[movie]")


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Short runs of some scenes, as datasets and as files."""
    folder = tmp_path_factory.mktemp("runs")
    wanted = {
        "temperature": {"molecules": 60, "duration": 2.0},
        "lifting-dry": {"molecules": 60, "ascent": 20.0},
        "atmosphere": {"molecules": 80},
        "elastic-collisions": {"molecules": 20, "duration": 3.0},
    }
    return {
        scene: (
            atmosbox.run(scene, out=folder / f"{scene}.nc", save_molecules=True, **settings),
            folder / f"{scene}.nc",
        )
        for scene, settings in wanted.items()
    }


@pytest.fixture(scope="module")
def sheets(runs):
    """The pages of their films; each test draws its own frames on them."""
    with style(LOOK):
        return {scene: Sheet(dataset, LOOK, molecules(dataset)) for scene, (dataset, _) in runs.items()}


def command(*words):
    return CliRunner().invoke(app, ["animate", *map(str, words)], env={"COLUMNS": None})


def refused(result, status=2):
    assert result.exit_code == status, result.output
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    return line


# The pace


def test_a_film_takes_evenly_spaced_frames_and_ends_with_the_last():
    frames = pace(1000, seconds=2.0, fps=25.0).frames
    assert frames.size == 50
    assert frames[-1] == 999
    assert set(np.diff(frames)) <= {20, 21}


def test_few_frames_are_shown_once_each_and_slower_if_a_length_is_wished():
    assert pace(40).frames.tolist() == list(range(40))
    assert pace(40, seconds=20.0).seconds == pytest.approx(20.0)
    assert pace(40, seconds=20.0, fps=10.0).seconds == pytest.approx(4.0)


def test_what_moves_smoothly_is_shown_at_twice_the_rate():
    assert pace(1000, smooth=True).fps == 2.0 * pace(1000).fps


def test_a_pace_that_is_none_is_refused():
    for wish in [{"fps": 0.0}, {"fps": float("nan")}, {"seconds": -1.0}, {"seconds": 1e9}]:
        with pytest.raises(SettingError, match="is not between"):
            pace(100, **wish)


def test_a_film_of_too_many_pictures_is_refused():
    with pytest.raises(SettingError, match=f"more than the {MOST}"):
        pace(100_000, fps=50.0, seconds=3600.0)


# The pictures


def test_pictures_have_their_size_and_change_with_the_clock(runs, sheets):
    for scene, sheet in sheets.items():
        with style(LOOK):
            first, last = sheet.picture(0), sheet.picture(runs[scene][0].sizes["elapsed_time"] - 1)
            again = sheet.picture(0)
        assert first.shape == (450, 800, 3)
        assert (first != last).any(axis=2).mean() > 0.005
        assert (first == again).all()


def test_molecules_are_where_the_file_says_and_their_colour_is_their_speed(runs, sheets):
    dataset, sheet = runs["temperature"][0], sheets["temperature"]
    with style(LOOK):
        sheet.picture(7)
    drawn = sheet.stage.molecules
    seen = np.asarray(drawn.get_offsets())
    places, scale = sheet.stage.camera.project(dataset.molecule_position.values[7] * 1e9)
    order = np.argsort(scale, kind="stable")
    assert seen == pytest.approx(places[order], abs=1e-4)
    colours = sheet.stage.colours(sheet.stage.norm(dataset.molecule_speed.values[7][order]))
    assert np.asarray(drawn.get_facecolor()) == pytest.approx(colours)


def test_curves_end_at_the_clock_and_theory_stands_from_the_start(runs):
    dataset = runs["lifting-dry"][0]
    with style(LOOK):
        sheet = Sheet(dataset, LOOK)
        whole = len(sheet.graphs[1].axes.lines)
        sheet.picture(4)
        axes = sheet.graphs[1].axes
        shown = [line for line in axes.lines if len(line.get_xdata()) > 2]  # not the cursor
    assert whole > 1  # the adiabat, and the environment
    finite = [int(np.isfinite(np.asarray(line.get_ydata(), float)).sum()) for line in shown]
    assert sorted(set(finite)) == [5, dataset.sizes["elapsed_time"] + 1]  # theory begins at the ground


def test_speeds_and_layers_grow_into_what_the_run_has_measured(runs):
    warm, column = Running(runs["temperature"][0]), Running(runs["atmosphere"][0])
    bins = np.diff(runs["temperature"][0].speed_bnds.values, axis=1)[:, 0]
    cold, late = (float(np.sum(warm.values("speed_probability_density", k) * bins)) for k in (0, 999))
    assert cold == pytest.approx(1.0, abs=0.05)
    assert late == pytest.approx(1.0, abs=0.05)
    last = runs["atmosphere"][0].sizes["elapsed_time"] - 1
    grown = column.values("number_density", last)
    known = np.isfinite(grown)
    assert known.sum() > 5
    assert grown[known] == pytest.approx(runs["atmosphere"][0].number_density.values[known])


def test_panels_of_two_kinds_are_filmed_and_no_misfits(runs):
    def titles(scene):
        dataset = runs[scene][0]
        return [panel.title for panel in chosen(dataset, panels_of(dataset), Running(dataset))]

    assert titles("temperature") == ["Cold molecules between warm walls", "Speeds follow Maxwell's law"]
    assert titles("lifting-dry") == ["The parcel expands", "It cools by ten degrees per kilometre"]
    assert titles("elastic-collisions") == ["Light and heavy: the same energy", "They do not keep their equal speeds"]


def test_a_run_of_one_frame_is_a_film_of_one_picture(runs, tmp_path):
    path, made = film.save(runs["temperature"][0].isel(elapsed_time=slice(0, 1)), tmp_path / "one.gif")
    assert made.frames.tolist() == [0]
    with Image.open(path) as opened:
        assert opened.n_frames == 1


def test_molecules_whose_scene_has_no_graph_that_grows_are_filmed_alone(runs, tmp_path):
    dataset = runs["atmosphere"][0].copy()
    law = Line("layer_temperature_theory", "height", "law", "theory")
    dataset.attrs["atmosbox_panels"] = to_json([Panel("profile", "A law", (law,))])
    with style(LOOK):
        sheet = Sheet(dataset, LOOK, molecules(dataset))
        sheet.picture(0)
    assert sheet.graphs == []
    with pytest.raises(FileError, match="no graph that grows"):
        film.save(dataset, tmp_path / "law.gif", graphs=True)


# The files


def test_a_gif_has_the_pictures_asked_for_and_lasts_as_long(runs, tmp_path):
    path, _ = film.save(runs["temperature"][0], tmp_path / "warm.gif", fps=20.0, seconds=0.5)
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
@pytest.mark.parametrize("theme", ["notes", pytest.param("slides", marks=pytest.mark.validate)])
def test_an_mp4_is_what_presentations_play(runs, tmp_path, theme):
    import imageio_ffmpeg

    path, _ = film.save(runs["lifting-dry"][0], tmp_path / "lift.mp4", theme=theme, seconds=0.4, fps=10.0)
    reader = imageio_ffmpeg.read_frames(str(path))
    about = next(reader)
    reader.close()
    assert (about["codec"], about["size"], about["fps"]) == ("h264", (1280, 720), 10.0)
    assert about["pix_fmt"].startswith("yuv420p")
    assert imageio_ffmpeg.count_frames_and_secs(str(path))[0] == 4
    assert [each.name for each in tmp_path.iterdir()] == ["lift.mp4"]


def test_an_mp4_without_its_program_is_refused_with_what_to_install(runs, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    sentence = refused(command(runs["lifting-dry"][1], "--out", tmp_path / "lift.mp4"))
    assert "type pip install 'atmosbox[movie]'" in sentence
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kind", ["gif", pytest.param("mp4", marks=needs_ffmpeg)])
def test_a_film_that_is_stopped_leaves_no_half_file(runs, tmp_path, kind):
    def stop(done):
        if done > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        film.save(runs["temperature"][0], tmp_path / f"warm.{kind}", seconds=0.4, fps=10.0, progress=stop)
    assert list(tmp_path.iterdir()) == []


@needs_ffmpeg
def test_a_film_without_its_end_is_refused(runs, tmp_path, monkeypatch):
    import imageio_ffmpeg

    monkeypatch.setattr(imageio_ffmpeg, "count_frames_and_secs", lambda path: (1, 0.1))
    with pytest.raises(FileError, match="could not be written whole"):
        film.save(runs["temperature"][0], tmp_path / "warm.mp4", seconds=0.2, fps=10.0)
    assert list(tmp_path.iterdir()) == []


# The command


def test_the_command_films_beside_the_file_and_prints_the_path_and_the_same_run_gives_the_same_gif(runs, tmp_path):
    path = tmp_path / "run.nc"
    path.write_bytes(runs["temperature"][1].read_bytes())
    result = command(path, "--seconds", "0.2", "--quiet")
    assert result.exit_code == 0, result.output
    assert result.stdout.strip() == str(tmp_path / "run.gif")
    made = (tmp_path / "run.gif").read_bytes()
    assert made[:6] == b"GIF89a"
    assert command(path, "--seconds", "0.2", "--force").exit_code == 0
    assert (tmp_path / "run.gif").read_bytes() == made


@pytest.fixture
def bare(runs, tmp_path):
    """A run without molecules."""
    dataset = runs["lifting-dry"][0]
    return output.write(dataset.drop_vars(["molecule_position", "molecule_speed"]), tmp_path / "bare.nc")


def test_a_run_without_molecules_is_refused_with_the_flag_that_saves_them(bare):
    sentence = refused(command(bare))
    assert "--save-molecules" in sentence
    assert "--graphs" in sentence


def test_the_graphs_alone_are_filmed_on_request(bare):
    result = command(bare, "--graphs", "--seconds", "0.3")
    assert result.exit_code == 0, result.output
    with Image.open(bare.with_suffix(".gif")) as opened:
        assert opened.n_frames == 3


def test_a_run_without_a_frame_is_refused(runs, tmp_path):
    with pytest.raises(FileError, match="no frame to film"):
        film.save(runs["temperature"][0].isel(elapsed_time=slice(0, 0)), tmp_path / "none.gif")


def test_what_cannot_be_filmed_so_is_refused_at_once(runs, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for words, said in [
        (("--out", "film.avi"), "format = avi is unknown"),
        (("--out", "film.gif", "--format", "mp4"), "does not go with the file name"),
        (("--fps", "0"), "pictures a second"),
    ]:
        assert said in refused(command(runs["temperature"][1], *words))
    assert list(tmp_path.iterdir()) == []

"""The figures: each kind of panel shows the numbers of its run, with units and errors.

A figure is drawn from the dataset alone, the same to the byte in another process, whatever the user's own settings are.
What cannot be drawn is refused in a sentence.
"""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import EllipseCollection, LineCollection
from matplotlib.container import ErrorbarContainer
from matplotlib.patches import StepPatch

from atmosbox import plot, scenarios
from atmosbox.errors import FileError
from atmosbox.plot import caption
from atmosbox.plot.curve import curve
from atmosbox.plot.run_figure import panels_of
from atmosbox.scene.panels import Line, Panel, to_json
from atmosbox.simulation.recording import Recording
from tests.in_process import typed

TIME = Line("elapsed_time", "air_temperature", "thermometer", error="air_temperature_se")


TEMPERATURE = Panel("line", "Temperature", (TIME,), "time", "temperature", y_unit="degC")


def variable(dims, values, units, **attrs):
    return (dims, np.asarray(values), {"units": units, **attrs})


def finished(scene, title, molecules, panels, variables, coords=None):
    """Return a dataset with the provenance that a run has."""
    names = [name for name in variables if f"{name}_tolerance" in variables]
    parameters = {
        "scene": scene,
        "version": "0.1.0",
        "engine": "exact",
        "settings": {"molecules": molecules, "seed": 1},
    }
    return xr.Dataset(
        variables,
        coords=coords or {},
        attrs={
            "title": title,
            "atmosbox_panels": to_json(panels),
            "atmosbox_headlines": json.dumps(names),
            "atmosbox_parameters": json.dumps(parameters),
            "atmosbox_status": "complete",
        },
    )


def small(values, panel=TEMPERATURE, **variables):
    """Return the shortest run that has a figure."""
    values = np.asarray(values, dtype=float)
    held = {
        "air_temperature": variable("elapsed_time", values, "K"),
        "air_temperature_se": variable("elapsed_time", np.full(values.shape, 2.0), "K"),
    }
    coords = {"elapsed_time": variable("elapsed_time", np.arange(values.size, dtype=float), "ns")}
    return finished("temperature", "A box", 10, [panel], held | variables, coords)


def tick_texts(axis):
    """Return the numbers that are visible on an axis."""
    low, high = sorted(axis.get_view_interval())
    room = 1e-9 * (high - low)
    drawn = [tick for tick in axis.get_major_ticks() if low - room <= tick.get_loc() <= high + room]
    labels = [label for tick in drawn for label in (tick.label1, tick.label2) if label.get_visible()]
    return [label for label in labels if label.get_text()]


@pytest.fixture(scope="module")
def drawings(runs):
    asked = {*((name, "notes") for name in runs), *(("lifting-dry", theme) for theme in plot.THEMES)}
    made = {(name, theme): plot.figure(runs[name], theme) for name, theme in sorted(asked)}
    for drawing in made.values():
        drawing.draw_without_rendering()
    return made


SHOWN_IN = {"K": (1.0, 0.0), "degC": (1.0, -273.15), "hPa": (1e-2, 0.0), "km": (1e-3, 0.0)}


def test_every_curve_of_every_profile_shows_the_numbers_of_its_variables(runs, drawings):
    found = 0
    for name, run in runs.items():
        for panel, axes in zip(panels_of(run), drawings[name, "notes"].axes, strict=True):
            if panel.kind == "histogram":
                steps = [patch.get_data().values for patch in axes.patches if isinstance(patch, StepPatch)]
                assert len(steps) >= 2
                assert all(any(np.allclose(each, run[line.y]) for line in panel.lines) for each in steps)
            for line in panel.lines if panel.kind == "profile" else ():
                told = [(line.x, panel.x_unit), (line.y, panel.y_unit)]
                if not all(unit in SHOWN_IN for _, unit in told):
                    continue
                wanted = np.column_stack(
                    [SHOWN_IN[unit][0] * run[each].values + SHOWN_IN[unit][1] for each, unit in told]
                )
                drawn = [each.get_xydata()[np.isfinite(each.get_xydata()).all(axis=1)] for each in axes.lines]
                drawn += [each[1:] for each in drawn if panel.start]  # the first point is the start of the run
                assert any(
                    len(each) > len(wanted) / 3  # a temperature that is hardly known is left out
                    and np.isclose(each[:, None], wanted[None], rtol=1e-6).all(axis=2).any(axis=1).all()
                    for each in drawn
                ), (name, panel.title, line.label)
                found += 1
    assert found == 8


def test_a_band_and_a_bar_are_one_standard_error_wide(runs, drawings):
    (band,) = plot.figure(small(np.linspace(280.0, 290.0, 300))).axes[0].collections
    y = band.get_paths()[0].vertices[:, 1]
    assert [y.min(), y.max()] == pytest.approx([280.0 - 273.15 - 2.0, 290.0 - 273.15 + 2.0])
    run = runs["atmosphere"]
    (bars,) = [
        each
        for axes in drawings["atmosphere", "notes"].axes
        for each in axes.containers
        if isinstance(each, ErrorbarContainer) and "temperature" in axes.get_xlabel()
    ]
    ends = np.array([each[:, 0] for each in bars[2][0].get_segments()])
    known = np.isfinite(run.layer_temperature_se.values) & np.isfinite(bars[0].get_xdata())
    assert np.diff(ends, axis=1)[:, 0] == pytest.approx(2.0 * run.layer_temperature_se.values[known])


def test_discs_are_true_to_size_in_their_box_coloured_by_speed_and_their_trails_end_at_them(runs, drawings):
    run, axes = runs["elastic-collisions"], drawings["elastic-collisions", "notes"].axes[0]
    (discs,) = [artist for artist in axes.collections if isinstance(artist, EllipseCollection)]
    place = run.disc_position.values[-1, :, ::2]
    assert axes.get_aspect() == 1.0
    assert axes.get_xlim() == axes.get_ylim() == pytest.approx((0.0, float(run.box_length[0])))
    assert discs.get_widths() == pytest.approx(run.disc_diameter)
    assert discs.get_offsets() == pytest.approx(place)
    assert np.asarray(discs.get_array()) == pytest.approx(np.linalg.norm(run.disc_velocity.values[-1], axis=1))
    trails = [artist for artist in axes.collections if isinstance(artist, LineCollection)]
    for segment in [each for trail in trails for each in trail.get_segments()][-3:]:
        assert np.min(np.linalg.norm(place - segment[-1], axis=1)) == pytest.approx(0.0, abs=1e-6)


def test_every_axis_has_a_label_with_its_unit_and_two_numbers_or_more(drawings):
    for axes in (axes for drawing in drawings.values() for axes in drawing.axes):
        for axis in (axes.xaxis, axes.yaxis):
            if label := axis.get_label_text():
                assert label.replace("\n", " ").rpartition(" (")[2].endswith(")"), label
                assert len(tick_texts(axis)) >= 2
            else:
                assert axis is axes.xaxis, "only an axis of time has its label below the panel beneath"


def test_a_point_whose_error_is_not_known_is_hollow_and_the_footer_says_so():
    line = Line("p", "height", "air", error="p_se")
    panel = Panel("profile", "Air", (line,), x_unit="hPa", y_unit="km")
    held = {"p": variable("height", [9e4, 8e4, 7e4], "Pa"), "p_se": variable("height", [1e3, 1e3, np.nan], "Pa")}
    height = {"height": variable("height", [1e3, 2e3, 3e3], "m")}
    drawing = plot.figure(finished("atmosphere", "A column", 9, [panel], held, height))
    (hollow,) = [line for line in drawing.axes[0].lines if line.get_markerfacecolor() == "white"]
    assert hollow.get_ydata() == pytest.approx([3.0])
    assert "hollow: not known" in drawing.get_supxlabel().replace("\n", " ")


def test_curves_differ_by_more_than_their_colour(drawings):
    for axes in (axes for drawing in drawings.values() for axes in drawing.axes):
        looks = [
            (line.get_marker(), str(line._unscaled_dash_pattern))
            for line in axes.lines
            if len(line.get_xdata()) > 2 and (line.get_linestyle(), line.get_marker()) != ("None", "None")
        ]
        assert len(set(looks)) == len(looks)


def test_a_slide_has_the_first_graph_of_each_of_two_columns():
    panels = [replace(TEMPERATURE, title=title) for title in ("one", "below it", "beside it")]
    run = small([280.0, 290.0]).assign_attrs(atmosbox_panels=to_json(panels))
    assert [axes.get_title(loc="left") for axes in plot.figure(run, "slides").axes] == ["one", "beside it"]


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_gaps_single_frames_and_constants_can_be_drawn(tmp_path, scale):
    panel = Panel("line", "Temperature", (TIME,), "time", "temperature", y_scale=scale)
    for values in ([300.0], [300.0, np.nan, 302.0], [np.nan, np.nan], [300.0] * 100, np.geomspace(1, 1e9, 50)):
        assert plot.save(small(values, panel), tmp_path / "figure.svg", force=True).stat().st_size > 1000


def test_a_headline_is_called_by_its_long_name_and_shown_in_its_units(runs):
    stated = {"h_se": 31.0, "h_theory": 8430.0, "h_tolerance": 124.0}
    run = xr.Dataset({name: variable((), value, "m") for name, value in stated.items()})
    run["h"] = variable((), 8400.0, "m", long_name="scale height", display_units="km")
    said = [words.replace("\u00a0", " ") for words in caption.headline(run, "h")]
    assert said == ["scale height", "8.40", "± 0.03 km", "theory 8.43 km", "difference −0.03 km"]


MINE = {"font.size": 30.0, "lines.linewidth": 9.0, "svg.hashsalt": "x", "savefig.dpi": 50, "axes.facecolor": "yellow"}


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory, runs):
    """The figures of two runs, in each format, drawn by another process; and the libraries that it had loaded."""
    folder = tmp_path_factory.mktemp("elsewhere")
    runs["elastic-collisions"].to_netcdf(folder / "svg.nc")
    for kind in ("png", "pdf"):
        small([280.0, 290.0]).to_netcdf(folder / f"{kind}.nc")
    code = (
        "import sys\nfrom atmosbox import plot\nprint(*sys.modules)\n"
        f"import matplotlib, xarray\nmatplotlib.rcParams.update({MINE})\n"
        "for kind in plot.FORMATS: plot.save(xarray.load_dataset(f'{kind}.nc', decode_times=False), f'far.{kind}')"
    )
    root = str(Path(__file__).resolve().parents[1])
    environment = {"PYTHONHASHSEED": "7", "MPLBACKEND": "svg", "TZ": "Asia/Tokyo", "PYTHONPATH": root}
    done = subprocess.run(
        [sys.executable, "-c", code], check=True, env=os.environ | environment, cwd=folder, stdout=subprocess.PIPE
    )
    return folder, set(done.stdout.decode().split())


@pytest.mark.parametrize("kind", plot.FORMATS)
def test_the_same_run_gives_the_same_bytes_in_another_process_whatever_the_users_own_settings(elsewhere, kind):
    folder, _ = elsewhere
    near = plot.save(xr.load_dataset(folder / f"{kind}.nc", decode_times=False), folder / f"near.{kind}")
    assert near.read_bytes() == (folder / f"far.{kind}").read_bytes()


def test_drawing_needs_no_window_and_no_pyplot_and_metpy_only_for_a_skew_t(elsewhere):
    assert not elsewhere[1] & {"matplotlib.pyplot", "metpy", "pint"}


def test_each_format_is_what_it_says_and_carries_the_settings_of_its_run(tmp_path):
    run = small([280.0, 290.0])
    png = plot.save(run, tmp_path / "figure.png").read_bytes()
    assert png.startswith(b"\x89PNG")
    assert int.from_bytes(png[16:20], "big") == 3.5 * 300
    svg = plot.save(run, tmp_path / "figure.SVG").read_text(encoding="utf-8")
    assert "<svg" in svg
    assert "dc:date" not in svg
    assert "&quot;seed&quot;: 1" in svg or '"seed": 1' in svg
    pdf = plot.save(run, tmp_path / "figure", "pdf")
    assert pdf.name == "figure.pdf"
    assert pdf.read_bytes().startswith(b"%PDF")
    assert b"/CIDFontType2" in pdf.read_bytes()  # TrueType, whose text can be searched
    assert b"CreationDate" not in pdf.read_bytes()


def test_a_file_that_cannot_be_drawn_is_refused_in_a_sentence():
    broken = small([280.0, 290.0]).assign_attrs
    cases = [
        (xr.Dataset(), "atmosbox did not write it"),
        (broken(atmosbox_panels="[]"), "not in the form that atmosbox writes"),
        (broken(atmosbox_panels='{"format": 9, "panels": []}'), "reads format 1"),
        (broken(atmosbox_panels=to_json(())), "its scene names no panels"),
        (broken(atmosbox_headlines="{"), "atmosbox_headlines of the file cannot be read"),
        (broken(atmosbox_parameters="[]"), "atmosbox_parameters of the file cannot be read"),
        (small([280.0]).drop_vars("air_temperature"), "has no variable 'air_temperature'"),
        (small([]), "stopped before its first frame"),
        (
            small([280.0], air_temperature=variable((), [[1.0]][0][0], "Pa")),
            "in 'Pa', which cannot be drawn in 'degC'",
        ),
        (
            small([280.0], air_temperature=variable(("elapsed_time", "axis"), [[1.0]], "K")),
            "and a line has one",
        ),
        (small([280.0, 290.0], air_temperature=variable("height", np.ones(3), "K")), "differ in length"),
        (
            small([280.0], Panel("line", "A", (Line("elapsed_time", "air_temperature[up]", "a"),))),
            "no part 'up'",
        ),
    ]
    for run, words in cases:
        with pytest.raises(FileError, match=words.replace("[", r"\[")) as refusal:
            plot.figure(run)
        assert str(refusal.value).endswith(".")


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_measured_curves_are_averaged_over_equal_parts_of_the_axis_and_theory_is_not(scale):
    time = np.array([1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0, 9.0])
    noise = np.where(time == 4.0, np.nan, time)
    held = {"noise": variable("elapsed_time", noise, "K"), "truth": variable("elapsed_time", time, "K")}
    dataset = xr.Dataset(held, coords={"elapsed_time": variable("elapsed_time", time, "ns")})
    lines = (Line("elapsed_time", "noise", "noise"), Line("elapsed_time", "truth", "truth", "theory"))
    panel = Panel("line", "Noise", lines, x_scale=scale, averages=2)
    measured, theory = (curve(dataset, panel, line) for line in lines)
    middle = 5.0 if scale == "linear" else 3.0 - 1e-9
    seen = time[time != 4.0]
    assert measured.y == pytest.approx([seen[seen < middle].mean(), seen[seen > middle].mean()])
    assert measured.x == pytest.approx(measured.y)
    assert measured.error == pytest.approx([seen[seen < middle].std(), seen[seen > middle].std()])
    assert theory.y.tolist() == time.tolist()


def test_a_temperature_that_is_hardly_known_is_not_drawn():
    held = {
        "t": variable("height", [288.0, 14.0, 250.0, 250.0], "K"),
        "t_se": variable("height", [1.0, 13.0, np.nan, 50.0], "K"),
        "n": variable("height", [9.0, 1.0, 2.0, 2.0], "1"),
        "n_se": variable("height", [1.0, 1.0, 2.0, 1.0], "1"),
    }
    dataset = xr.Dataset(held, coords={"height": variable("height", [1.0, 2.0, 3.0, 4.0], "m")})

    def drawn(name, role="data"):
        line = Line(name, "height", "air", role, error=f"{name}_se")
        return np.isfinite(curve(dataset, Panel("profile", "Air", (line,)), line).x).tolist()

    assert drawn("t") == [True, False, False, True]
    assert drawn("t", "theory") == drawn("n") == [True] * 4
    all_unknown = dataset.assign(t_se=variable("height", [np.nan] * 4, "K"))
    line = Line("t", "height", "air", error="t_se")
    assert np.isfinite(curve(all_unknown, Panel("profile", "Air", (line,)), line).x).all()


def test_a_line_of_a_headline_that_the_run_could_not_give_is_left_out():
    base = Line("t", "cloud_base_theory", "condensation level", "reference")
    panel = Panel("profile", "A kink", (Line("t", "p", "parcel"), base), headlines=("cloud_base",))
    held = xr.Dataset({"t": ("time", [280.0]), "p": ("time", [9e4])}, attrs={"atmosbox_panels": to_json([panel])})
    assert [line.label for line in panels_of(held)[0].lines] == ["parcel"]
    found = held.assign(cloud_base=9e4, cloud_base_theory=9.1e4)
    assert [line.label for line in panels_of(found)[0].lines] == ["parcel", "condensation level"]


@pytest.mark.parametrize("scene", ["atmosphere", "temperature"])
def test_a_run_stopped_after_one_frame_is_drawn_if_the_stop_message_says_so(scene, tmp_path, monkeypatch):
    advance = Recording.advance

    def advance_once(recording, watch):
        if recording.frames:
            raise KeyboardInterrupt
        advance(recording, watch)

    monkeypatch.setattr(Recording, "advance", advance_once)
    monkeypatch.chdir(tmp_path)
    stopped = typed("run", scene, "--set", "molecules=200", "--out", "x.nc")
    assert "1 complete frames are kept in x.part.nc" in stopped.stderr
    drawn = typed("plot", "x.part.nc")
    if scene == "atmosphere":  # a layer needs two frames for its mean
        assert "atmosbox plot" not in stopped.stderr
        assert "stopped too early for a figure" in drawn.stderr
    else:
        assert "atmosbox plot x.part.nc" in stopped.stderr
        assert drawn.exit_code == 0, drawn.stderr


def test_the_titles_of_scenes_are_true_of_their_settings():
    def titles(name, **settings):
        scene = scenarios.load(name)
        return [panel.title for panel in scene.panels(scene.Settings(**settings))]

    assert "Too dry for a cloud" in titles("lifting-moist", dewpoint=-60.0)
    assert "It arrives as warm as it started" in titles("mountains", rain=False)
    assert "Discs alike: the same energy" in titles("elastic-collisions", mass_ratio=1.0)


def test_the_numbers_of_a_run_and_where_they_come_from_stand_below_its_figure(runs, drawings):
    said = " ".join(text.get_text() for text in drawings["lifting-dry", "slides"].texts).replace("\n", " ")
    value = float(runs["lifting-dry"].temperature_at_700_hpa) - 273.15
    assert f"{abs(value):.1f}" in said
    assert "agrees" in said
    assert "lifting-dry · 60 molecules · seed 1 · exact engine" in said
    assert caption.footer(runs["atmosphere"].assign_attrs(atmosbox_status="interrupted")).endswith("interrupted run")
    assert " · 20 discs · " in caption.footer(runs["elastic-collisions"])


def test_drawing_changes_neither_the_run_nor_the_users_settings_of_matplotlib(runs):
    run = runs["temperature"].copy(deep=True)
    with matplotlib.rc_context(MINE):
        before = dict(matplotlib.rcParams)
        plot.figure(runs["temperature"])
        assert dict(matplotlib.rcParams) == before
    xr.testing.assert_identical(run, runs["temperature"])

"""The skew-T: a parcel in its environment, drawn by MetPy, with CAPE and CIN shaded and the levels marked."""

import json
from itertools import combinations

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.text import Text

from atmosbox import plot, theory
from atmosbox.errors import FileError
from atmosbox.plot.skewt import levels
from atmosbox.plot.theme import OKABE_ITO
from atmosbox.scene.panels import Line, Panel, from_json, to_json
from atmosbox.scene.sounding import weisman_klemp

FRAMES = 80
CURVES = (
    Line("parcel_temperature", "parcel_pressure", "parcel", error="parcel_temperature_se"),
    Line("adiabat_temperature", "parcel_pressure", "adiabat", "theory"),
    Line("environment_temperature", "environment_pressure", "environment", "environment"),
    Line("environment_dew_point_temperature", "environment_pressure", "its dewpoint", "environment"),
)
SKEWT = Panel("skewt", "A storm", CURVES, "temperature", "pressure", headlines=("cape",), marks=("lcl", "lfc", "el"))
BUOYANCY = Panel(
    "profile",
    "Buoyancy",
    (Line("parcel_buoyancy", "parcel_pressure", "parcel"),),
    x_label="buoyancy",
    y_label="pressure",
    y_unit="hPa",
    y_scale="log",
    y_invert=True,
)
NAN = float("nan")


def ascent(frames=FRAMES, panels=(SKEWT, BUOYANCY), warmer=0.0, **scalars):
    """Return the run of a parcel that is lifted through the air before a thunderstorm.

    The levels are those where the temperatures of theory's parcel and of the air cross, so that they have no noise.
    """
    air = weisman_klemp()
    pressure = np.geomspace(1000e2, 150e2, FRAMES)[:frames]

    def around(levels):
        return np.interp(-np.log(pressure), -np.log(air.pressure), levels)

    water = float(theory.mixing_ratio(theory.saturation_vapor_pressure(air.dewpoint[0]), 1000e2))
    adiabat = theory.parcel_path(pressure, 1000e2, air.temperature[0], water).temperature
    noise = np.random.default_rng(4).normal(0.0, 0.4, FRAMES)[:frames]
    temperature = around(air.temperature) + warmer
    frame = "elapsed_time"
    held = {
        "parcel_temperature": (frame, adiabat + noise, {"units": "K"}),
        "parcel_temperature_se": (frame, np.full(frames, 0.4), {"units": "K"}),
        "parcel_pressure": (frame, pressure, {"units": "Pa"}),
        "adiabat_temperature": (frame, adiabat, {"units": "K"}),
        "environment_temperature": (frame, temperature, {"units": "K"}),
        "environment_dew_point_temperature": (frame, around(air.dewpoint), {"units": "K"}),
        "environment_pressure": (frame, pressure, {"units": "Pa"}),
        "parcel_buoyancy": (frame, 9.81 * (adiabat / temperature - 1.0), {"units": "m s-2"}),
        "cape": ((), 2190.0, {"units": "J kg-1", "display_name": "CAPE"}),
        "cape_se": ((), 40.0, {"units": "J kg-1"}),
    }
    found = {"lcl": 882e2, "lfc": 820e2, "el": 200e2} | scalars
    held |= {name: ((), value, {"units": "Pa"}) for name, value in found.items() if value is not None}
    parameters = {"scene": "lifting-sounding", "version": "0.1.0", "settings": {"molecules": 20000, "seed": 1}}
    return xr.Dataset(
        held,
        coords={frame: (frame, np.arange(frames, dtype=float), {"units": "ns"})},
        attrs={
            "title": "Lifting through a sounding",
            "atmosbox_panels": to_json(panels),
            "atmosbox_headlines": '["cape"]',
            "atmosbox_parameters": json.dumps(parameters),
            "atmosbox_status": "complete" if frames == FRAMES else "interrupted",
        },
    )


@pytest.fixture(scope="module")
def run():
    return ascent()


@pytest.fixture(scope="module")
def drawings(run):
    made = {theme: plot.figure(run, theme) for theme in plot.THEMES}
    for drawing in made.values():
        drawing.draw_without_rendering()
    return made


each_theme = pytest.mark.parametrize("theme", plot.THEMES)


def areas(axes):
    """Return the shaded areas, not the band of a standard error."""
    return [each for each in axes.collections if isinstance(each, PolyCollection) and each.get_hatch()]


def corners(area):
    """Return temperatures [degC] and pressures [hPa] of the shaded areas."""
    paths = [path.vertices for path in area.get_paths()]
    return np.concatenate(paths) if paths else np.zeros((0, 2))


def grey_lines(axes):
    """Return dry adiabats, moist adiabats and mixing ratios."""
    return [each for each in axes.collections if isinstance(each, LineCollection) and len(each.get_segments()) > 5]


def names_of_levels(axes):
    return [text for text in axes.texts if text.get_text() in ("LCL", "LFC", "EL")]


def box_of(text):
    """Return the bounding box of a text, without the line that leads to it."""
    return Text.get_window_extent(text)


def legend_texts(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def tick_texts(axis, limits):
    """Return the numbers at the ticks of an axis, between its ends."""
    low, high = min(limits), max(limits)
    drawn = [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
    return [text for text in drawn if text.get_text()]


def numbers(axis):
    limits = axis.axes.get_xlim() if axis is axis.axes.xaxis else axis.axes.get_ylim()
    return [text.get_text() for text in tick_texts(axis, limits)]


def seen_texts(drawing):
    found = list(drawing.texts)
    for axes in drawing.axes:
        found += [axes.xaxis.label, axes.yaxis.label, *axes.texts]
        found += tick_texts(axes.xaxis, axes.get_xlim()) + tick_texts(axes.yaxis, axes.get_ylim())
        found += axes.get_legend().get_texts() if axes.get_legend() else []
    return [text for text in found if text.get_text()]


def test_pressure_falls_upward_on_a_logarithmic_axis_and_isotherms_lean_to_the_right(drawings):
    axes = drawings["notes"].axes[0]
    assert axes.get_yscale() == "log"
    bottom, top = axes.get_ylim()
    assert bottom > 1000.0 > 150.0 > top
    assert {"1000", "850", "700", "500", "300"} <= set(numbers(axes.yaxis))
    for temperature in (-40.0, 0.0, 20.0):
        low, high = axes.transData.transform([(temperature, 1000.0), (temperature, 200.0)])
        assert (high - low)[0] / (high - low)[1] == pytest.approx(np.tan(np.radians(30.0)))


@each_theme
def test_every_curve_lies_wholly_within_the_diagram(drawings, theme):
    axes = drawings[theme].axes[0]
    frame = axes.get_window_extent()
    curves = [line for line in axes.lines if len(line.get_xdata()) == FRAMES]
    assert len(curves) == len(CURVES)
    for line in curves:
        place = axes.transData.transform(line.get_xydata())
        assert frame.x0 < place[:, 0].min() < place[:, 0].max() < frame.x1
        assert frame.y0 < place[:, 1].min() < place[:, 1].max() < frame.y1


@each_theme
def test_both_axes_have_a_label_and_two_numbers_or_more(drawings, theme):
    axes = drawings[theme].axes[0]
    assert axes.get_xlabel() == "temperature (°C)"
    assert axes.get_ylabel() == "pressure (hPa)"
    assert len(numbers(axes.xaxis)) >= 2
    assert len(numbers(axes.yaxis)) >= 5


@each_theme
def test_no_text_meets_another_or_leaves_the_figure(drawings, theme):
    drawing = drawings[theme]
    boxes = [(text.get_text(), box_of(text)) for text in seen_texts(drawing)]
    assert {"LCL", "LFC", "EL"} <= {text for text, _ in boxes}
    page = drawing.bbox
    for text, box in boxes:
        assert page.x0 <= box.x0 <= box.x1 <= page.x1, text
        assert page.y0 <= box.y0 <= box.y1 <= page.y1, text
    for (text, box), (other, other_box) in combinations(boxes, 2):
        across = min(box.x1, other_box.x1) - max(box.x0, other_box.x0)
        up = min(box.y1, other_box.y1) - max(box.y0, other_box.y0)
        assert min(across, up) < 2.0, f"{text!r} meets {other!r}"


def test_the_curves_differ_by_more_than_their_colour(drawings):
    curves = [line for line in drawings["notes"].axes[0].lines if len(line.get_xdata()) == FRAMES]
    assert len({str(line._unscaled_dash_pattern) for line in curves}) == len(CURVES)


def test_the_background_is_paler_and_thinner_than_any_curve(drawings):
    axes = drawings["notes"].axes[0]
    grey = grey_lines(axes)
    assert len(grey) == 3
    assert len({str(each.get_linestyle()) for each in grey}) == 3
    for lines in grey:
        assert min(to_rgb(lines.get_color()[0])) > 0.7
        assert max(lines.get_linewidth()) < min(line.get_linewidth() for line in axes.lines)
        assert lines.get_zorder() < min(line.get_zorder() for line in axes.lines)
    assert any("grey: dry adiabats" in text.get_text().replace("\n", " ") for text in drawings["notes"].texts)


def test_the_grey_lines_are_adiabats(drawings):
    dry, moist, _ = grey_lines(drawings["notes"].axes[0])
    for line in dry.get_segments():
        theta = (line[:, 0] + 273.15) * (1000.0 / line[:, 1]) ** (2.0 / 7.0)
        assert np.ptp(theta) < 1e-3 * theta.mean()
    for line in moist.get_segments():
        start = float(np.interp(1000.0, line[::-1, 1], line[::-1, 0]))
        assert start == pytest.approx(10.0 * round(start / 10.0), abs=0.05)
        assert np.all(np.diff(line[:, 0]) < 0.0)


def test_cape_is_shaded_between_lfc_and_el_where_the_parcel_is_warmer_and_cin_below(run, drawings):
    axes = drawings["notes"].axes[0]
    cape, cin = areas(axes)
    assert legend_texts(axes)[-2:] == ["CAPE", "CIN"]
    assert corners(cape)[:, 1].min() >= 200.0 - 1e-6
    assert corners(cape)[:, 1].max() <= 820.0 + 1e-6
    assert corners(cin)[:, 1].min() >= 820.0 - 1e-6
    pressure = run.parcel_pressure.values / 100.0
    parcel, air = (run[name].values - 273.15 for name in ("parcel_temperature", "environment_temperature"))
    for area, sign in ((cape, 1.0), (cin, -1.0)):
        warmer = sign * (corners(area)[:, 0] - np.interp(-corners(area)[:, 1], -pressure, air))
        assert warmer.min() > -0.05  # straight in the logarithm of the pressure there, in the pressure here
        assert warmer.max() > 0.3
        assert warmer.max() <= (sign * (parcel - air)).max() + 0.05
    assert cape.get_hatch() != cin.get_hatch()
    palette = [to_rgb(colour) for colour in OKABE_ITO]
    for area in (cape, cin):
        assert any(np.allclose(area.get_facecolor()[0][:3], colour) for colour in palette)


def test_without_an_el_cape_goes_up_to_where_the_ascent_ends():
    drawing = plot.figure(ascent(frames=50, panels=(SKEWT,), el=NAN))
    (cape, _) = areas(drawing.axes[0])
    top = float(ascent(frames=50).parcel_pressure.min()) / 100.0
    assert corners(cape)[:, 1].min() == pytest.approx(top)


@pytest.mark.parametrize("lfc", [NAN, None])
def test_without_an_lfc_nothing_is_shaded(lfc):
    drawing = plot.figure(ascent(panels=(SKEWT,), warmer=30.0, lfc=lfc, el=lfc))
    assert areas(drawing.axes[0]) == []
    assert "CAPE" not in legend_texts(drawing.axes[0])
    assert [text.get_text() for text in names_of_levels(drawing.axes[0])] == ["LCL"]


@each_theme
def test_levels_are_marked_at_their_pressure_and_named_apart(drawings, theme):
    axes = drawings[theme].axes[0]
    marks = [each for each in axes.collections if isinstance(each, LineCollection)][-3:]
    assert sorted(mark.get_segments()[0][0, 1] for mark in marks) == pytest.approx([200.0, 820.0, 882.0])
    heights = [box_of(text) for text in names_of_levels(axes)]
    assert [text.get_text() for text in names_of_levels(axes)] == ["LCL", "LFC", "EL"]
    assert all(lower.y1 <= upper.y0 + 1.0 for lower, upper in combinations(heights, 2))
    assert min(box.x0 for box in heights) > axes.get_window_extent().x1


def test_levels_that_crowd_at_an_end_stay_beside_the_diagram():
    drawing = plot.figure(ascent(panels=(SKEWT,), lcl=999e2, lfc=998e2, el=997e2))
    axes = drawing.axes[0]
    boxes = [box_of(text) for text in names_of_levels(axes)]
    assert len(boxes) == 3
    assert min(box.y0 for box in boxes) > axes.get_window_extent().y0 - 10.0
    assert all(min(a.y1, b.y1) - max(a.y0, b.y0) < 2.0 for a, b in combinations(boxes, 2))


def test_a_level_outside_the_diagram_is_not_marked():
    drawing = plot.figure(ascent(frames=20, panels=(SKEWT,), lcl=120e2, el=NAN))
    assert [text.get_text() for text in names_of_levels(drawing.axes[0])] == ["LFC"]


def test_levels_have_the_names_that_forecasters_use_and_others_their_own():
    panel = Panel("skewt", "A", CURVES, marks=("cloud_base", "ground_level", "el", "nowhere"))
    held = {"cloud_base": 9e4, "ground_level": 1e5, "el": NAN}
    dataset = xr.Dataset({name: ((), value, {"units": "Pa"}) for name, value in held.items()})
    assert levels(dataset, panel) == pytest.approx({"LCL": 900.0, "ground level": 1000.0})


@pytest.mark.parametrize(
    ("mark", "words"),
    [(("height", [1.0, 2.0], {"units": "Pa"}), "is a list"), (((), 280.0, {"units": "K"}), "cannot be drawn in 'hPa'")],
)
def test_a_mark_that_is_no_pressure_is_refused(run, mark, words):
    with pytest.raises(FileError, match=words):
        plot.figure(run.assign(lfc=mark))


@pytest.mark.parametrize("frames", [1, 2, 41])
def test_a_run_that_was_cut_short_can_be_drawn(frames):
    drawing = plot.figure(ascent(frames=frames, panels=(SKEWT,), lfc=NAN, el=NAN), "slides")
    drawing.draw_without_rendering()
    bottom, top = drawing.axes[0].get_ylim()
    assert bottom / top > 2.0
    assert bottom > 1000.0
    left, right = drawing.axes[0].get_xlim()
    assert right - left >= 40.0


@pytest.mark.parametrize(
    ("name", "part"),
    [("parcel_temperature", slice(10, 14)), ("parcel_pressure", slice(3)), ("environment_temperature", slice(None))],
)
def test_gaps_in_a_variable_can_be_drawn(name, part):
    run = ascent(panels=(SKEWT,)).copy(deep=True)
    run[name][part] = NAN
    drawing = plot.figure(run)
    drawing.draw_without_rendering()
    assert bool(areas(drawing.axes[0])) == (part != slice(None))


def test_a_run_of_nothing_but_gaps_is_an_empty_diagram():
    run = ascent(panels=(SKEWT,)).copy(deep=True)
    for line in CURVES:
        run[line.x][:] = NAN
    drawing = plot.figure(run)
    drawing.draw_without_rendering()
    assert len(numbers(drawing.axes[0].xaxis)) >= 2


@pytest.mark.parametrize(
    "suffix", ["svg", *(pytest.param(name, marks=pytest.mark.validate) for name in ("png", "pdf"))]
)
def test_the_same_run_gives_the_same_bytes(tmp_path, suffix):
    run = ascent(panels=(SKEWT,))
    first = plot.save(run, tmp_path / f"first.{suffix}")
    with matplotlib.rc_context({"font.size": 30.0, "hatch.linewidth": 5.0, "axes.grid": True}):
        before = dict(matplotlib.rcParams)
        second = plot.save(run, tmp_path / f"second.{suffix}")
        assert dict(matplotlib.rcParams) == before
    assert first.read_bytes() == second.read_bytes()


def test_drawing_does_not_change_the_run(run, drawings):
    xr.testing.assert_identical(run, ascent())


# The panel as data


def test_a_skew_t_travels_in_the_file_with_its_marks():
    assert from_json(to_json([SKEWT, BUOYANCY])) == (SKEWT, BUOYANCY)
    assert json.loads(to_json([SKEWT]))["panels"][0]["marks"] == ["lcl", "lfc", "el"]
    assert "marks" not in to_json([BUOYANCY])


def test_a_skew_t_has_the_axes_of_one_whatever_is_left_out():
    panel = Panel("skewt", "A", CURVES)
    assert (panel.x_unit, panel.y_unit, panel.y_scale, panel.y_invert) == ("degC", "hPa", "log", True)
    assert panel == Panel("skewt", "A", CURVES, x_unit="degC", y_unit="hPa", y_scale="log", y_invert=True)


def test_a_skew_t_that_cannot_be_drawn_is_refused_where_it_is_written():
    cases = [
        (lambda: Panel("skewt", "A", CURVES, x_unit="K"), "the x_unit of the panel 'A' is 'K': a skew-T is in degC"),
        (lambda: Panel("skewt", "A", CURVES, y_unit="km"), "the y_unit of the panel 'A' is 'km'"),
        (lambda: Panel("skewt", "A", CURVES, x_scale="log"), "the x_scale of the panel 'A' is 'log'"),
        (lambda: Panel("skewt", "A", CURVES, x_invert=True), "the x_invert of the panel 'A'"),
        (lambda: Panel("skewt", "A"), "needs at least one line"),
        (lambda: Panel("skewt", "A", CURVES, averages=3), "only a line panel has parts"),
        (lambda: Panel("skewt", "A", CURVES, marks=["lfc"]), "marks of the panel 'A' is no tuple of str"),
        (lambda: Panel("skewt", "A", (Line("t", "p", "a", minus="u"),)), "no differences"),
        (lambda: Panel("profile", "A", CURVES, marks=("lfc",)), "only a panel of the kind 'skewt' shows them"),
        (lambda: from_json('{"format": 1, "panels": [{"kind": "skewt", "title": "A", "marks": "lfc"}]}'), "marks of a"),
    ]
    for make, words in cases:
        with pytest.raises(ValueError, match=words):
            make()

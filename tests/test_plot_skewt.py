"""The skew-T: a parcel in its environment, drawn by MetPy, with CAPE and CIN shaded and the levels marked."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgb

from atmosbox import plot, theory
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
SKEWT = Panel("skewt", "A storm", CURVES, "temperature", "pressure", marks=("lcl", "lfc", "el"))
NAN = float("nan")


def ascent(frames=FRAMES, **scalars):
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
    temperature = around(air.temperature)
    frame = "elapsed_time"
    held = {
        "parcel_temperature": (frame, adiabat + noise, {"units": "K"}),
        "parcel_temperature_se": (frame, np.full(frames, 0.4), {"units": "K"}),
        "parcel_pressure": (frame, pressure, {"units": "Pa"}),
        "adiabat_temperature": (frame, adiabat, {"units": "K"}),
        "environment_temperature": (frame, temperature, {"units": "K"}),
        "environment_dew_point_temperature": (frame, around(air.dewpoint), {"units": "K"}),
        "environment_pressure": (frame, pressure, {"units": "Pa"}),
    }
    found = {"lcl": 882e2, "lfc": 820e2, "el": 200e2} | scalars
    held |= {name: ((), value, {"units": "Pa"}) for name, value in found.items() if value is not None}
    return xr.Dataset(
        held,
        coords={frame: (frame, np.arange(frames, dtype=float), {"units": "ns"})},
        attrs={
            "title": "Lifting through a sounding",
            "atmosbox_panels": to_json([SKEWT]),
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


def areas(axes):
    """Return the shaded areas, not the band of a standard error."""
    return [each for each in axes.collections if isinstance(each, PolyCollection) and each.get_hatch()]


def corners(area):
    """Return temperatures [degC] and pressures [hPa] of the shaded areas."""
    paths = [path.vertices for path in area.get_paths()]
    return np.concatenate(paths) if paths else np.zeros((0, 2))


def test_areas_are_shaded_where_the_parcel_is_warmer_from_lfc_to_el_and_colder_below(run, drawings):
    axes = drawings["notes"].axes[0]
    warm, cold = areas(axes)
    assert [text.get_text() for text in axes.get_legend().get_texts()[-2:]] == ["warmer", "colder"]
    assert corners(warm)[:, 1].min() >= 200.0 - 1e-6
    assert corners(warm)[:, 1].max() <= 820.0 + 1e-6
    assert corners(cold)[:, 1].min() >= 820.0 - 1e-6
    pressure = run.parcel_pressure.values / 100.0
    parcel, air = (run[name].values - 273.15 for name in ("parcel_temperature", "environment_temperature"))
    for area, sign in ((warm, 1.0), (cold, -1.0)):
        excess = sign * (corners(area)[:, 0] - np.interp(-corners(area)[:, 1], -pressure, air))
        assert excess.min() > -0.05  # straight in the logarithm of the pressure there, in the pressure here
        assert excess.max() > 0.3
        assert excess.max() <= (sign * (parcel - air)).max() + 0.05
    assert warm.get_hatch() != cold.get_hatch()
    palette = [to_rgb(colour) for colour in OKABE_ITO]
    for area in (warm, cold):
        assert any(np.allclose(area.get_facecolor()[0][:3], colour) for colour in palette)


def test_levels_are_marked_at_their_pressure_and_named(drawings):
    axes = drawings["notes"].axes[0]
    marks = [each for each in axes.collections if isinstance(each, LineCollection)][-3:]
    assert sorted(mark.get_segments()[0][0, 1] for mark in marks) == pytest.approx([200.0, 820.0, 882.0])
    named = [text.get_text() for text in axes.texts]
    assert [name for name in named if name in ("LCL", "LFC", "EL")] == ["LCL", "LFC", "EL"]


@pytest.mark.parametrize("frames", [1, 41])
def test_a_run_that_was_cut_short_can_be_drawn(frames):
    drawing = plot.figure(ascent(frames=frames, lfc=NAN, el=NAN), "slides")
    drawing.draw_without_rendering()
    bottom, top = drawing.axes[0].get_ylim()
    assert bottom / top > 2.0
    assert bottom > 1000.0
    left, right = drawing.axes[0].get_xlim()
    assert right - left >= 40.0


# The panel as data


def test_a_skew_t_that_cannot_be_drawn_is_refused_where_it_is_written():
    cases = [
        (lambda: Panel("skewt", "A", CURVES, x_unit="K"), "the x_unit of the panel 'A' is 'K': a skew-T is in degC"),
        (lambda: Panel("skewt", "A", CURVES, y_unit="km"), "the y_unit of the panel 'A' is 'km'"),
        (lambda: Panel("skewt", "A", CURVES, x_scale="log"), "the x_scale of the panel 'A' is 'log'"),
        (lambda: Panel("skewt", "A", CURVES, x_invert=True), "the x_invert of the panel 'A'"),
        (lambda: Panel("skewt", "A", CURVES, marks=["lfc"]), "marks of the panel 'A' is not a tuple of str"),
        (lambda: Panel("profile", "A", CURVES, marks=("lfc",)), "only a panel of the kind 'skewt' shows them"),
        (lambda: from_json('{"format": 1, "panels": [{"kind": "skewt", "title": "A", "marks": "lfc"}]}'), "marks of a"),
    ]
    for make, words in cases:
        with pytest.raises(ValueError, match=words):
            make()

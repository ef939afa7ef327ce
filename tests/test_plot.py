"""The figures: drawn from the dataset alone, byte for byte reproducible, legible on a page and on a wall."""

import itertools
import json
import os
import subprocess
import sys
from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path

import matplotlib
import numpy as np
import pytest
import xarray as xr
from matplotlib.collections import EllipseCollection, LineCollection, PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.container import ErrorbarContainer
from matplotlib.figure import Figure
from matplotlib.patches import StepPatch

from atmosbox import plot, scenarios
from atmosbox.errors import FileError, SettingError
from atmosbox.plot import caption, tick, units
from atmosbox.plot.curve import curve
from atmosbox.plot.run_figure import panels_of
from atmosbox.scene.panels import Line, Panel, to_json
from atmosbox.simulation.recording import Recording
from tests.in_process import typed

K_B = 1.380649e-23  # J/K
AIR = 28.9647e-3 / 6.02214076e23  # kg
G = 9.80665  # m/s2

TIME = Line("elapsed_time", "air_temperature", "thermometer", error="air_temperature_se")


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


def headline(name, value, se, theory, units, title, against="theory", **attrs):
    return {
        name: variable((), value, units, display_name=title, **attrs),
        f"{name}_se": variable((), se, units),
        f"{name}_theory": variable((), theory, units, display_name=against),
        f"{name}_tolerance": variable((), 4 * se, units),
    }


def noise(rng, size, correlation=0.8):
    """Return correlated noise of unit variance, as a thermometer of few molecules shows."""
    steps = rng.normal(size=size) * np.sqrt(1 - correlation**2)
    out = np.zeros(size)
    for i in range(1, size):
        out[i] = correlation * out[i - 1] + steps[i]
    return out


def temperature():
    rng = np.random.default_rng(1)
    time = np.arange(1, 301) * 0.02
    warming = 300.0 + (250.0 - 300.0) * np.exp(-time / 0.3)
    air = warming + 8.8 * noise(rng, 300)
    edges = np.linspace(0, 1400, 36)
    speed = (edges[1:] + edges[:-1]) / 2
    maxwell = 4 * np.pi * (AIR / (2 * np.pi * K_B * 300)) ** 1.5 * speed**2 * np.exp(-AIR * speed**2 / (2 * K_B * 300))
    counts = rng.poisson(maxwell * 40 * 12000)
    panels = [
        Panel(
            "line",
            "Temperature of the air",
            (
                TIME,
                Line(
                    "elapsed_time",
                    "wall_temperature",
                    "wall, with scatter",
                    "theory",
                    error="air_temperature_noise",
                ),
            ),
            x_label="elapsed time",
            y_label="air temperature",
            y_unit="degC",
            headlines=("mean_temperature",),
        ),
        Panel(
            "line",
            "Pressure on the walls",
            (
                Line("elapsed_time", "air_pressure", "blows on the walls", error="air_pressure_se"),
                Line("elapsed_time", "air_pressure_theory", "n k T Z", "theory"),
            ),
            x_label="elapsed time",
            y_label="air pressure",
            y_unit="hPa",
            headlines=("mean_pressure",),
        ),
        Panel(
            "histogram",
            "Speeds of the molecules",
            (
                Line("speed", "speed_probability_density", "measured", error="speed_probability_density_se"),
                Line("speed", "speed_probability_density_theory", "Maxwell", "theory"),
            ),
            x_label="speed",
            y_label="probability density",
        ),
    ]
    per_frame = "elapsed_time"
    variables = {
        "air_temperature": variable(per_frame, air, "K"),
        "air_temperature_se": variable(per_frame, np.full(300, 4.0), "K"),
        "air_temperature_noise": variable((), 8.8, "K"),
        "wall_temperature": variable((), 300.0, "K"),
        "air_pressure": variable(per_frame, 1e5 * air / 300 + 2500 * rng.normal(size=300), "Pa"),
        "air_pressure_se": variable(per_frame, np.full(300, 2500.0), "Pa"),
        "air_pressure_theory": variable(per_frame, 1e5 * warming / 300, "Pa"),
        "speed_probability_density": variable("speed", counts / 480000, "s m-1"),
        "speed_probability_density_se": variable("speed", np.sqrt(counts + 1) / 480000, "s m-1"),
        "speed_probability_density_theory": variable("speed", maxwell, "s m-1"),
        "speed_bnds": (("speed", "bounds"), np.stack((edges[:-1], edges[1:]), axis=1)),
        **headline("mean_temperature", 300.42, 0.53, 300.0, "K", "mean T", "wall", display_units="degC"),
        **headline("mean_pressure", 100210.0, 160.0, 100000.0, "Pa", "p", "n k T Z", display_units="hPa"),
    }
    coords = {
        "elapsed_time": variable("elapsed_time", time, "ns", long_name="elapsed time"),
        "speed": variable("speed", speed, "m s-1", bounds="speed_bnds"),
    }
    return finished("temperature", "Temperature is the motion of molecules", 800, panels, variables, coords)


def atmosphere():
    rng = np.random.default_rng(2)
    height = np.arange(500.0, 20000.0, 1000.0)
    scale = K_B * 288.15 / (AIR * G)
    barometric = 2.5e25 * np.exp(-height / scale)
    hydrostatic = barometric * (1 - 0.04 * np.exp(-height / scale))
    pressure = barometric * K_B * 288.15
    share = 0.01 * np.exp(height / 2 / scale)
    isothermal = Line("air_temperature_theory", "height", "isothermal", "theory")
    panels = [
        Panel(
            "profile",
            "Number density",
            (
                Line("number_density", "height", "measured", error="number_density_se"),
                Line("number_density_barometric", "height", "barometric", "theory"),
                Line("number_density_theory", "height", "hydrostatic with Z", "theory"),
            ),
            x_label="number density",
            y_label="height",
            y_unit="km",
            x_scale="log",
            headlines=("scale_height",),
        ),
        Panel(
            "profile",
            "Pressure",
            (
                Line("layer_pressure", "height", "measured", error="layer_pressure_se"),
                Line("layer_pressure_theory", "height", "barometric", "theory"),
            ),
            x_label="pressure",
            y_label="height",
            x_unit="hPa",
            y_unit="km",
            x_scale="log",
        ),
        Panel(
            "profile",
            "Temperature",
            (Line("layer_temperature", "height", "measured", error="layer_temperature_se"), isothermal),
            x_label="temperature",
            y_label="height",
            x_unit="degC",
            y_unit="km",
            headlines=("lapse_rate",),
        ),
    ]
    kick = rng.normal(size=(3, height.size)) * share
    variables = {
        "number_density": variable("height", hydrostatic * (1 + kick[0]), "m-3"),
        "number_density_se": variable("height", hydrostatic * share, "m-3"),
        "number_density_barometric": variable("height", barometric, "m-3"),
        "number_density_theory": variable("height", hydrostatic, "m-3"),
        "layer_pressure": variable("height", pressure * (1 + kick[1]), "Pa"),
        "layer_pressure_se": variable("height", pressure * share, "Pa"),
        "layer_pressure_theory": variable("height", pressure, "Pa"),
        "layer_temperature": variable("height", 288.15 * (1 + kick[2]), "K"),
        "layer_temperature_se": variable("height", 288.15 * share, "K"),
        "air_temperature_theory": variable((), 288.15, "K"),
        **headline("scale_height", 8452.0, 31.0, scale, "m", "H", "k T / m g", display_units="km"),
        **headline("lapse_rate", 0.0002, 0.0003, 0.0, "K m-1", "lapse rate", "0", display_units="K km-1"),
    }
    coords = {"height": variable("height", height, "m", long_name="height")}
    return finished("atmosphere", "An atmosphere at rest", 20000, panels, variables, coords)


def elastic_collisions(molecules=70, frames=240):
    """Return a small flat gas, half of it heavy, moved in steps in which approaching pairs swap momentum."""
    rng = np.random.default_rng(3)
    box, dt = 20e-9, 0.4e-12
    side = int(np.ceil(np.sqrt(molecules)))
    places = (np.indices((side, side)).reshape(2, -1).T[rng.permutation(side**2)[:molecules]] + 0.5) * box / side
    heavy = np.arange(molecules) % 2 == 1
    mass, diameter = np.where(heavy, 4 * AIR, AIR), np.where(heavy, 1.1e-9, 0.6e-9)
    velocity = np.where(heavy, 100.0, 600.0)[:, None] * rng.normal(size=(molecules, 2))
    first, second = np.triu_indices(molecules, 1)
    reach, total = (diameter[first] + diameter[second]) / 2, mass[first] + mass[second]
    position_of, velocity_of = [], []
    for _ in range(frames):
        places = places + velocity * dt
        for pair in np.flatnonzero(np.linalg.norm(places[first] - places[second], axis=1) < reach):
            i, j = first[pair], second[pair]
            along = (places[j] - places[i]) / np.linalg.norm(places[j] - places[i])
            closing = (velocity[j] - velocity[i]) @ along
            if closing < 0:
                velocity[i] += 2 * mass[j] / total[pair] * closing * along
                velocity[j] -= 2 * mass[i] / total[pair] * closing * along
        out = (places < diameter[:, None] / 2) & (velocity < 0) | (places > box - diameter[:, None] / 2) & (
            velocity > 0
        )
        velocity = np.where(out, -velocity, velocity)
        position_of.append(np.clip(places, diameter[:, None] / 2, box - diameter[:, None] / 2))
        velocity_of.append(velocity.copy())
    depth = np.full((frames, molecules, 1), 1e-9)
    energy = 0.5 * mass * np.sum(np.square(velocity_of), axis=2)
    panels = [
        Panel("discs", "Discs that collide without loss"),
        Panel(
            "line",
            "The energy is shared",
            (
                Line("elapsed_time", "kinetic_energy_light", "light half"),
                Line("elapsed_time", "kinetic_energy_heavy", "heavy half"),
                Line("elapsed_time", "kinetic_energy_theory", "equal shares", "theory"),
            ),
            x_label="elapsed time",
            y_label="mean kinetic energy",
        ),
        Panel(
            "line",
            "Energy and momentum are kept",
            (
                Line("elapsed_time", "energy_change", "energy"),
                Line("elapsed_time", "momentum_change", "momentum"),
            ),
            x_label="elapsed time",
            y_label="relative change",
            headlines=("energy_drift",),
        ),
    ]
    walk = np.cumsum(rng.normal(size=(2, frames)) * 1.1e-16, axis=1)
    per_disc = ("elapsed_time", "molecule", "axis")
    variables = {
        "disc_position": variable(per_disc, np.concatenate((position_of, depth), axis=2), "m"),
        "disc_velocity": variable(per_disc, np.concatenate((velocity_of, 0 * depth), axis=2), "m s-1"),
        "disc_diameter": variable("molecule", diameter, "m"),
        "disc_mass": variable("molecule", mass, "kg"),
        "box_length": variable((), box, "m"),
        "kinetic_energy_light": variable("elapsed_time", energy[:, ~heavy].mean(axis=1), "J"),
        "kinetic_energy_heavy": variable("elapsed_time", energy[:, heavy].mean(axis=1), "J"),
        "kinetic_energy_theory": variable((), energy.mean(), "J"),
        "energy_change": variable("elapsed_time", walk[0], "1"),
        "momentum_change": variable("elapsed_time", walk[1], "1"),
        **headline("energy_drift", 6.2e-16, 0.0, 0.0, "1", "largest change of energy"),
    }
    coords = {"elapsed_time": variable("elapsed_time", (1 + np.arange(frames)) * 0.4, "ps")}
    return finished("elastic-collisions", "Elastic collisions", molecules, panels, variables, coords)


def lifting_dry():
    rng = np.random.default_rng(4)
    pressure = np.geomspace(1000e2, 300e2, 220)
    adiabat = 288.15 * (pressure / 1000e2) ** (2 / 7)
    parcel = adiabat + 0.4 * np.log(1000e2 / pressure) + 0.35 * noise(rng, 220, 0.9)
    height = (288.15 - adiabat) / 9.7611e-3
    environment = 288.15 - 6.5e-3 * height
    both = (
        Line("parcel_temperature", "parcel_pressure", "parcel", error="parcel_temperature_se"),
        Line("environment_temperature", "parcel_pressure", "environment", "environment"),
        Line("adiabat_temperature", "parcel_pressure", "dry adiabat", "theory"),
    )
    over_height = tuple(Line(line.x, "parcel_height", line.label, line.role, line.error) for line in both)
    misfit = Line(
        "parcel_temperature",
        "parcel_pressure",
        "parcel",
        error="parcel_temperature_se",
        minus="adiabat_temperature",
    )
    zero = Line("adiabat_temperature", "parcel_pressure", "dry adiabat", "theory", minus="adiabat_temperature")
    log_pressure = {"y_label": "pressure", "y_unit": "hPa", "y_scale": "log", "y_invert": True}
    panels = [
        Panel("profile", "Temperature and pressure", both, "temperature", x_unit="degC", **log_pressure),
        Panel("profile", "Temperature and height", over_height, "temperature", "height", "degC", "km"),
        Panel(
            "profile",
            "Misfit to the adiabat",
            (misfit, zero),
            "parcel minus adiabat",
            x_unit="K",
            headlines=("top_temperature", "mean_lapse_rate"),
            **log_pressure,
        ),
    ]
    variables = {
        "parcel_pressure": variable("elapsed_time", pressure, "Pa"),
        "parcel_height": variable("elapsed_time", height, "m"),
        "parcel_temperature": variable("elapsed_time", parcel, "K"),
        "parcel_temperature_se": variable("elapsed_time", np.full(220, 0.35), "K"),
        "environment_temperature": variable("elapsed_time", environment, "K"),
        "adiabat_temperature": variable("elapsed_time", adiabat, "K"),
        **headline("top_temperature", 204.40, 0.053, 204.28, "K", "T(300 hPa)", "adiabat"),
        **headline(
            "mean_lapse_rate",
            9.72e-3,
            0.03e-3,
            9.7611e-3,
            "K m-1",
            "lapse rate",
            "g/cp",
            display_units="K km-1",
        ),
    }
    coords = {"elapsed_time": variable("elapsed_time", np.arange(220.0), "ns", long_name="elapsed time")}
    return finished("lifting-dry", "Why rising air cools", 10000, panels, variables, coords)


SCENES = {
    "temperature": temperature,
    "atmosphere": atmosphere,
    "elastic-collisions": elastic_collisions,
    "lifting-dry": lifting_dry,
}

TEMPERATURE = Panel("line", "Temperature", (TIME,), "time", "temperature", y_unit="degC")


@pytest.fixture(scope="module")
def runs():
    return {name: make() for name, make in SCENES.items()}


@pytest.fixture(scope="module")
def drawings(runs):
    made = {(name, theme): plot.figure(run, theme) for name, run in runs.items() for theme in plot.THEMES}
    for drawing in made.values():
        drawing.draw_without_rendering()  # the places of legends are known only after drawing
    return made


def small(values, panel=TEMPERATURE, **variables):
    """Return the shortest run that has a figure."""
    values = np.asarray(values, dtype=float)
    held = {
        "air_temperature": variable("elapsed_time", values, "K"),
        "air_temperature_se": variable("elapsed_time", np.full(values.shape, 2.0), "K"),
    }
    coords = {"elapsed_time": variable("elapsed_time", np.arange(values.size, dtype=float), "ns")}
    return finished("temperature", "A box", 10, [panel], held | variables, coords)


def alone(run, panel=0):
    """Return a run with one of its panels."""
    return run.assign_attrs(atmosbox_panels=to_json([panels_of(run)[panel]]))


def all_axes(drawing):
    return [axes for outer in drawing.axes for axes in (outer, *outer.child_axes)]


def tick_texts(axis):
    """Return the numbers that are visible on an axis."""
    low, high = sorted(axis.get_view_interval())
    room = 1e-9 * (high - low)
    drawn = [tick for tick in axis.get_major_ticks() if low - room <= tick.get_loc() <= high + room]
    labels = [label for tick in drawn for label in (tick.label1, tick.label2) if label.get_visible()]
    return [label for label in labels if label.get_text()]


def texts(drawing):
    """Return all visible text of a figure."""
    found = list(drawing.texts)
    for axes in all_axes(drawing):
        found += [axes.xaxis.label, axes.yaxis.label, *axes.texts]
        found += tick_texts(axes.xaxis) + tick_texts(axes.yaxis)
        found += axes.get_legend().get_texts() if axes.get_legend() else []
    return [text for text in found if text.get_text()]


def written(drawing):
    return [text.get_text().replace("\n", " ") for text in texts(drawing)]


# Layout


def test_no_text_meets_another_or_leaves_the_figure(drawings):
    for named, drawing in drawings.items():
        boxes = [(text.get_text(), text.get_window_extent()) for text in texts(drawing)]
        page = drawing.bbox
        for text, box in boxes:
            assert page.x0 <= box.x0 <= box.x1 <= page.x1, (named, text)
            assert page.y0 <= box.y0 <= box.y1 <= page.y1, (named, text)
        for (text, box), (other, other_box) in combinations(boxes, 2):
            across = min(box.x1, other_box.x1) - max(box.x0, other_box.x0)
            up = min(box.y1, other_box.y1) - max(box.y0, other_box.y0)
            assert min(across, up) < 2.0, f"{named}: {text!r} meets {other!r}"


def test_titles_and_legends_keep_clear_of_the_data(drawings):
    for named, drawing in drawings.items():
        frames = [axes.get_window_extent() for axes in drawing.axes]
        for axes in drawing.axes:
            legend = axes.get_legend()
            for artist in [*axes.texts, *([legend] if legend else [])]:
                box = artist.get_window_extent()
                assert not any(frame.x0 < box.x1 and box.x0 < frame.x1 and frame.y0 < box.y1 - 1
                               and box.y0 + 1 < frame.y1 for frame in frames), named  # fmt: skip


def test_every_axis_has_a_label_with_its_unit_and_two_numbers_or_more(drawings):
    outer = [axes for drawing in drawings.values() for axes in drawing.axes]
    for axes in itertools.chain.from_iterable(map(all_axes, drawings.values())):
        is_bar = axes not in outer
        for axis in (axes.xaxis, axes.yaxis):
            label = axis.get_label_text()
            if label:
                assert label.replace("\n", " ").rpartition(" (")[2].endswith(")")
                assert len(tick_texts(axis)) >= 2
            else:
                below = [o for o in axes.get_shared_x_axes().get_siblings(axes) if o.get_xlabel()]
                assert axis is axes.xaxis
                assert is_bar or below
                assert not tick_texts(axis)


def test_type_is_large_enough_to_read(drawings):
    for (scene, theme), drawing in drawings.items():
        least = {"notes": 8.0, "slides": 12.0}[theme]
        assert min(text.get_fontsize() for text in texts(drawing)) >= least, (scene, theme)


def test_slides_are_sixteen_to_nine_and_notes_fit_a_page(drawings):
    for (_, theme), drawing in drawings.items():
        width, height = drawing.get_size_inches()
        if theme == "slides":
            assert width / height == pytest.approx(16 / 9)
        else:
            assert width < 7.5


def test_one_panel_alone_has_the_width_of_a_column():
    assert plot.figure(small([280.0, 290.0])).get_figwidth() == 3.5


@pytest.mark.parametrize("theme", plot.THEMES)
def test_the_title_of_the_run_stands_above_its_panels(drawings, theme):
    assert "Why rising air cools" in written(drawings["lifting-dry", theme])


def test_long_titles_notes_and_labels_are_broken_into_lines_that_fit():
    long = "a sentence that goes on and on for much longer than any panel is wide, as people write them "
    line = Line("elapsed_time", "air_temperature", long, error="air_temperature_se")
    drawing = plot.figure(small([280.0, 290.0], Panel("line", long, (line, line), long, long, note=long)))
    for text in texts(drawing):
        box = text.get_window_extent()
        assert drawing.bbox.x0 <= box.x0
        assert box.x1 <= drawing.bbox.x1


def test_panels_over_each_other_share_the_axis_of_time(drawings):
    first, second = drawings["temperature", "notes"].axes[:2]
    assert first.get_xlim() == second.get_xlim()
    assert (first.get_xlabel(), second.get_xlabel()) == ("", "elapsed time (ns)")


# Curves and other content


def lines_of(axes):
    return [line for line in axes.lines if len(line.get_xdata()) > 1 and line.get_linestyle() != "None"]


def test_theory_is_dashed_and_dark_and_data_solid_with_a_band(drawings):
    axes = drawings["lifting-dry", "notes"].axes[0]
    parcel, environment, adiabat = lines_of(axes)
    assert not parcel.is_dashed()
    assert adiabat.is_dashed()
    assert environment.is_dashed()
    assert max(to_rgb(adiabat.get_color())) < 0.2
    (band,) = [artist for artist in axes.collections if isinstance(artist, PolyCollection)]
    assert to_rgb(band.get_facecolor()[0][:3]) == pytest.approx(to_rgb(parcel.get_color()))


def test_curves_differ_by_more_than_their_colour(drawings):
    for axes in (axes for drawing in drawings.values() for axes in drawing.axes):
        looks = [(line.get_marker(), str(line._unscaled_dash_pattern)) for line in lines_of(axes)]
        assert len(set(looks)) == len(looks)


def test_a_band_is_one_standard_error_wide(runs, drawings):
    (band,) = drawings["lifting-dry", "notes"].axes[2].collections
    misfit = runs["lifting-dry"].parcel_temperature - runs["lifting-dry"].adiabat_temperature
    x = band.get_paths()[0].vertices[:, 0]
    assert [x.min(), x.max()] == pytest.approx([float(misfit.min()) - 0.35, float(misfit.max()) + 0.35])


def test_few_values_are_points_with_bars_and_no_line(runs, drawings):
    axes = drawings["atmosphere", "notes"].axes[2]
    (bars,) = [each for each in axes.containers if isinstance(each, ErrorbarContainer)]
    assert bars.has_xerr
    assert bars[0].get_xdata() == pytest.approx(runs["atmosphere"].layer_temperature - 273.15)
    assert bars[0].get_ydata() == pytest.approx(runs["atmosphere"].height / 1000)


def test_theory_may_have_a_band_of_the_scatter_to_expect(drawings):
    bands = [a for a in drawings["temperature", "notes"].axes[0].collections if isinstance(a, PolyCollection)]
    y = bands[1].get_paths()[0].vertices[:, 1]
    assert [y.min(), y.max()] == pytest.approx([26.85 - 8.8, 26.85 + 8.8])


def test_pressure_falls_upward_on_a_logarithmic_axis_with_plain_numbers(drawings):
    axes = drawings["lifting-dry", "notes"].axes[0]
    assert axes.get_yscale() == "log"
    low, high = axes.get_ylim()
    assert low > 1000.0 > 300.0 > high
    numbers = [text.get_text() for text in tick_texts(axes.yaxis)]
    assert {"1000", "850", "700", "500", "400", "300"} <= set(numbers)


def test_height_begins_at_the_ground_and_time_at_zero(drawings):
    assert drawings["atmosphere", "notes"].axes[0].get_ylim()[0] == 0.0
    assert drawings["temperature", "notes"].axes[0].get_xlim()[0] == 0.0


def test_the_axis_of_a_small_quantity_says_its_power_of_ten_in_the_label(drawings):
    axes = drawings["elastic-collisions", "notes"].axes[2]
    assert axes.get_ylabel().replace("\n", " ") == "relative change (10⁻¹⁵)"
    assert all(abs(float(text.get_text().replace("−", "-"))) < 10 for text in tick_texts(axes.yaxis))


def test_numbers_that_hardly_differ_are_written_in_full():
    drawing = plot.figure(
        small([300.0, 300.0 + 1e-5], Panel("line", "T", (Line("elapsed_time", "air_temperature", "air"),)))
    )
    drawing.draw_without_rendering()
    axis = drawing.axes[0].yaxis
    assert axis.get_offset_text().get_text() == ""
    assert all(text.get_text().startswith(("300", "299.99")) for text in tick_texts(axis))


@pytest.mark.parametrize("theme", plot.THEMES)
def test_a_logarithmic_axis_of_a_good_decade_has_four_numbers_or_more_and_small_ticks(drawings, theme):
    for axes in drawings["atmosphere", theme].axes[:2]:
        assert len(tick_texts(axes.xaxis)) >= 4
        assert len(axes.xaxis.get_minorticklocs()) + len(axes.xaxis.get_majorticklocs()) >= 10


def test_numbers_on_an_axis_have_equally_many_decimals():
    run = small([1.17e-3, 1.34e-3], Panel("line", "E", (Line("elapsed_time", "air_temperature", "a"),)))
    drawing = plot.figure(run)
    drawing.draw_without_rendering()
    numbers = [text.get_text() for text in tick_texts(drawing.axes[0].yaxis)]
    assert "1.20" in numbers
    assert {len(number) for number in numbers} == {4}


@pytest.mark.parametrize(
    ("low", "high", "numbers"),
    [(9e-4, 1.0, ["0.001", "0.01", "0.1", "1"]), (1e-5, 1e-2, ["10⁻⁵", "10⁻⁴", "10⁻³", "10⁻²"])],
)
def test_powers_of_ten_are_written_alike_along_an_axis(low, high, numbers):
    drawing = Figure()
    axis = drawing.add_subplot(xscale="log", xlim=(low, high)).xaxis
    assert tick.put_ticks(axis, log=True, length=200.0, size=16.0) == 0
    drawing.draw_without_rendering()
    assert [text.get_text() for text in tick_texts(axis)] == numbers


def test_axes_that_run_backwards_do_so_together():
    line = Line("elapsed_time", "air_temperature", "air")
    panels = [Panel("line", title, (line,), x_invert=True) for title in ("A", "B")]
    for axes in plot.figure(small([280.0, 290.0]).assign_attrs(atmosbox_panels=to_json(panels))).axes:
        assert axes.xaxis_inverted()


def test_a_reference_is_broader_and_paler_under_the_theory_that_it_coincides_with(runs):
    run = runs["atmosphere"]
    panel = Panel(
        "profile",
        "Density",
        (
            Line("number_density_theory", "height", "with Z", "theory"),
            Line("number_density_barometric", "height", "barometric", "reference"),
        ),
    )
    for theme in plot.THEMES:
        axes = plot.figure(run.assign_attrs(atmosbox_panels=to_json([panel])), theme).axes[0]
        theory, reference = lines_of(axes)
        assert theory.is_dashed()
        assert not reference.is_dashed()
        assert reference.get_zorder() < theory.get_zorder()
        assert reference.get_linewidth() > 2 * theory.get_linewidth()
        dark, pale = (np.dot((0.299, 0.587, 0.114), to_rgb(line.get_color())) for line in (theory, reference))
        assert dark + 0.4 < pale < 0.8  # distinct from each other and from white paper in grey print too


def test_a_point_whose_error_is_not_known_is_hollow_and_the_footer_says_so(runs, drawings):
    run = alone(runs["atmosphere"].copy(deep=True), 1)
    run["layer_pressure_se"][-3:] = np.nan
    drawing = plot.figure(run)
    (axes,) = drawing.axes
    (hollow,) = [line for line in axes.lines if line.get_markerfacecolor() == "white"]
    assert hollow.get_ydata() == pytest.approx(run.height[-3:] / 1000)
    (bars,) = [each for each in axes.containers if isinstance(each, ErrorbarContainer)]
    assert hollow.get_zorder() > bars[0].get_zorder()
    assert any(text.endswith("hollow: not known") for text in written(drawing))
    assert not any("hollow" in text for text in written(drawings["atmosphere", "notes"]))


@pytest.mark.parametrize(("scale", "left"), [("linear", 0.0), ("log", 0.5)])
def test_a_curve_begins_at_its_start_and_a_guide_stands_at_its_value_within_the_limits(scale, left):
    frames = {"start": (0.0, 5.0), "guides": (("y", 9.0, "nine"), ("y", 99.0, "beyond")), "y_limits": (0.0, 20.0)}
    panel = replace(TEMPERATURE, lines=(replace(TIME, error=None),), x_scale=scale, **frames)
    dataset = small([280.0, 290.0], panel).assign_coords(elapsed_time=("elapsed_time", [1.0, 2.0], {"units": "ns"}))
    axes = plot.figure(dataset).axes[0]
    assert axes.lines[0].get_xdata().tolist() == [left, 1.0, 2.0]
    assert axes.lines[0].get_ydata()[0] == 5.0
    assert [text.get_text() for text in axes.texts if text.get_text()] == ["nine", "start"]
    assert axes.get_ylim() == (0.0, 20.0)


def test_a_curve_that_goes_up_and_down_often_is_thin_and_its_legend_is_not():
    rng = np.random.default_rng(5)
    panel = Panel("line", "T", (Line("elapsed_time", "air_temperature", "air"), replace(TIME, error=None)))
    for values, is_thin in ((np.linspace(280, 290, 900), False), (rng.normal(288, 5, 900), True)):
        axes = plot.figure(small(values, panel), "slides").axes[0]
        assert (axes.lines[0].get_linewidth() < 0.7 * plot.THEMES["slides"].line) == is_thin
        assert axes.get_legend().get_lines()[0].get_linewidth() >= plot.THEMES["slides"].line


def test_the_axis_of_pressure_begins_at_1000_hpa_where_the_data_nearly_do(runs):
    run = alone(runs["lifting-dry"].isel(elapsed_time=slice(12, None)))
    axes = plot.figure(run).axes[0]
    assert run.parcel_pressure.max() < 94000.0
    assert "1000" in [text.get_text() for text in tick_texts(axes.yaxis)]
    high_up = plot.figure(run.isel(elapsed_time=slice(60, None))).axes[0]
    assert max(high_up.get_ylim()) < 900.0


def test_a_histogram_is_drawn_between_the_bounds_of_its_bins(runs, drawings):
    axes = drawings["temperature", "notes"].axes[2]
    steps = [patch for patch in axes.patches if isinstance(patch, StepPatch)]
    assert steps[0].get_data().edges == pytest.approx(np.linspace(0, 1400, 36))
    assert steps[0].get_data().values == pytest.approx(runs["temperature"].speed_probability_density)
    run = runs["temperature"].pad(speed=(0, 60), constant_values=0.0)
    speeds = 20.0 + 40.0 * np.arange(run.sizes["speed"])
    run = run.drop_vars("speed_bnds", errors="ignore").assign_coords(speed=variable("speed", speeds, "m s-1"))
    assert 1200.0 < plot.figure(run).axes[2].get_xlim()[1] < 1500.0 < speeds[-1]  # not to its empty bins


def test_discs_are_true_to_size_in_their_box_and_coloured_by_speed(runs, drawings):
    run, axes = runs["elastic-collisions"], drawings["elastic-collisions", "notes"].axes[0]
    (discs,) = [artist for artist in axes.collections if isinstance(artist, EllipseCollection)]
    assert axes.get_aspect() == 1.0
    assert axes.get_xlim() == axes.get_ylim() == pytest.approx((0.0, 20.0))
    assert discs.get_widths() == pytest.approx(run.disc_diameter * 1e9)
    assert discs.get_offsets() == pytest.approx(run.disc_position[-1, :, :2] * 1e9)
    assert np.asarray(discs.get_array()) == pytest.approx(np.linalg.norm(run.disc_velocity[-1], axis=1))
    assert discs.get_cmap().name in ("viridis", "cividis")


def test_heavy_discs_have_a_thicker_rim(runs, drawings):
    run, axes = runs["elastic-collisions"], drawings["elastic-collisions", "notes"].axes[0]
    (discs,) = [artist for artist in axes.collections if isinstance(artist, EllipseCollection)]
    rims, heavy = np.asarray(discs.get_linewidths()), run.disc_mass.values > 2 * AIR
    assert rims[heavy].min() > rims[~heavy].max()
    assert "heavy half: 4 × the mass" in written(drawings["elastic-collisions", "notes"])


def test_the_trails_of_discs_end_at_the_discs_and_fade_backwards(runs, drawings):
    axes = drawings["elastic-collisions", "notes"].axes[0]
    (trails,) = [artist for artist in axes.collections if isinstance(artist, LineCollection)]
    ends = np.array([segment[-1] for segment in trails.get_segments()])[-70:]
    assert ends == pytest.approx(runs["elastic-collisions"].disc_position[-1, :, :2].values * 1e9)
    alpha = trails.get_colors()[:, 3]
    assert np.all(np.diff(alpha) >= 0)
    assert alpha[0] < alpha[-1]


def test_discs_that_leap_between_frames_have_no_trails(runs):
    run = alone(runs["elastic-collisions"].isel(elapsed_time=slice(0, None, 60)))
    place = run.disc_position.values[:, :, :2]
    leap = np.median(np.linalg.norm(np.diff(place, axis=0), axis=2), axis=0) > 0.1 * float(run.box_length)
    assert 0 < leap.sum() < leap.size
    (trails,) = [each for each in plot.figure(run).axes[0].collections if isinstance(each, LineCollection)]
    ends = np.array([segment[-1] for segment in trails.get_segments()])[-(~leap).sum() :]
    assert ends == pytest.approx(1e9 * place[-1, ~leap])
    collections = plot.figure(run.isel(molecule=leap)).axes[0].collections
    assert not any(isinstance(artist, LineCollection) for artist in collections)


def test_a_few_very_fast_discs_do_not_take_all_the_colours(runs):
    run = alone(runs["elastic-collisions"].copy(deep=True))
    run["disc_velocity"][:, :6] *= 300.0
    (discs,) = [each for each in plot.figure(run).axes[0].collections if isinstance(each, EllipseCollection)]
    shades = discs.norm(np.linalg.norm(run.disc_velocity[-1].values, axis=1))
    assert np.ptp(np.clip(shades[6:], 0.0, 1.0)) > 0.3


def test_the_rims_of_many_small_discs_leave_their_colours_to_be_seen(runs):
    run = alone(runs["elastic-collisions"].copy(deep=True))
    run["disc_diameter"] = run.disc_diameter / 20
    drawing = plot.figure(run, "slides")
    axes = drawing.axes[0]
    (discs,) = [each for each in axes.collections if isinstance(each, EllipseCollection)]
    nanometre = axes.get_window_extent().width * 72 / drawing.dpi / 20.0  # [pt]
    assert np.all(np.asarray(discs.get_linewidths()) < 0.2 * run.disc_diameter.values * 1e9 * nanometre)


@pytest.mark.parametrize(("heavy", "words"), [(3.74, "3.7 ×"), (1080.0, "1100 ×"), (123456.0, "120\u2009000 ×")])
def test_the_ratio_of_masses_is_written_without_exponent(runs, heavy, words):
    run = alone(runs["elastic-collisions"].copy(deep=True))
    run["disc_mass"] = xr.where(run.disc_mass > 2 * AIR, heavy * AIR, AIR)
    assert any(words in text for text in written(plot.figure(run)))


def test_a_part_of_a_variable_can_be_drawn():
    line = Line("elapsed_time", "heat[z_high]", "ceiling")
    heat = variable(("elapsed_time", "wall"), [[1.0, 2.0], [3.0, 4.0]], "J")
    run = small([280.0, 290.0], Panel("line", "Heat", (line,), "time", "heat"), heat=heat)
    for labels in (["z_low", "z_high"], np.array([b"z_low", b"z_high"])):
        axes = plot.figure(run.assign_coords(wall=labels)).axes[0]
        assert axes.lines[0].get_ydata().tolist() == [2.0, 4.0]


def test_two_single_numbers_are_a_point():
    panel = Panel("profile", "Cloud base", (Line("base_t", "base_p", "cloud base"),), "T", "p", "degC", "hPa")
    base = {"base_t": variable((), 288.15, "K"), "base_p": variable((), 9e4, "Pa")}
    assert plot.figure(small([280.0], panel, **base)).axes[0].lines[0].get_xydata().tolist() == [[15.0, 900.0]]


@pytest.mark.parametrize("scale", ["linear", "log"])
def test_gaps_single_frames_and_constants_can_be_drawn(tmp_path, scale):
    panel = Panel("line", "Temperature", (TIME,), "time", "temperature", y_scale=scale)
    for values in ([300.0], [300.0, np.nan, 302.0], [np.nan, np.nan], [300.0] * 100, np.geomspace(1, 1e9, 50)):
        assert plot.save(small(values, panel), tmp_path / "figure.svg", force=True).stat().st_size > 1000


# Texts


def test_numbers_stand_first_and_large_and_what_the_textbook_says_under_them(drawings):
    drawing = drawings["lifting-dry", "notes"]
    sizes = {text.get_text(): text.get_size() for text in drawing.texts}
    said = " ".join(sizes)
    assert "T(300 hPa)" in said
    assert "difference +0.12 K" in said
    assert "difference −0.04 K km⁻¹" in said
    assert sizes["204.40"] > 1.5 * sizes["T(300 hPa)"]


def test_a_headline_is_called_by_its_long_name_and_shown_in_its_units(runs):
    run = xr.Dataset(headline("h", 8400.0, 31.0, 8430.0, "m", "", long_name="scale height", display_units="km"))
    said = [words.replace("\u00a0", " ") for words in caption.headline(run, "h")]
    assert said == ["scale height", "8.40", "± 0.03 km", "theory 8.43 km", "difference −0.03 km"]


def test_headlines_that_no_panel_claims_stand_in_the_first_with_curves(runs):
    panels = (Panel("discs", "The box"), TEMPERATURE)
    first, second = caption.headlines(runs["temperature"], panels)
    assert first == []
    assert [reading.label for reading in second] == ["mean T", "p"]
    assert [reading.difference for reading in second] == ["difference +0.4\u00a0K", "difference +2.1\u00a0hPa"]


def test_what_was_not_measured_is_not_said():
    run = small([280.0, 290.0], **headline("mean", np.nan, np.nan, 280.0, "K", "mean"))
    assert caption.headline(run, "mean") is None
    assert caption.headline(run, "nowhere") is None


def test_the_footer_says_where_the_figure_comes_from(drawings):
    said = "atmosbox 0.1.0 · lifting-dry · 10\u2009000 molecules · seed 1 · exact engine"
    assert any(text.startswith(said) for text in written(drawings["lifting-dry", "notes"]))


def test_an_interrupted_run_says_so(runs):
    run = runs["atmosphere"].assign_attrs(atmosbox_status="interrupted")
    assert caption.footer(run).endswith("interrupted run")


def test_the_footer_counts_discs_as_discs_and_one_molecule_as_one(runs):
    assert " · 70 discs · " in caption.footer(runs["elastic-collisions"])
    alone = runs["temperature"].attrs["atmosbox_parameters"].replace('"molecules": 800', '"molecules": 1')
    assert " · 1 molecule · " in caption.footer(runs["temperature"].assign_attrs(atmosbox_parameters=alone))


def test_a_misfit_that_rounds_to_zero_has_no_sign():
    assert caption.number(-0.04, 0.9, signed=True) == "0.0 ± 0.9"
    assert caption.number(0.003, 2.6, signed=True) == "0 ± 3"
    assert caption.number(-0.06, 0.9, signed=True) == "−0.1 ± 0.9"


def test_the_titles_of_scenes_are_true_of_their_settings():
    def titles(name, **settings):
        scene = scenarios.load(name)
        return [panel.title for panel in scene.panels(scene.Settings(**settings))]

    assert "Cold molecules between warm walls" in titles("temperature")
    assert "Hot molecules between cooler walls" in titles("temperature", start_temperature=500.0)
    assert "Discs alike: the same energy" in titles("elastic-collisions", mass_ratio=1.0)


def test_numbers_have_the_digits_that_their_error_allows():
    assert caption.number(1234.5678, 0.234) == "1234.6 ± 0.2"
    assert caption.number(0.0, 0.0) == "0"
    assert caption.number(-1.5e-9, 3e-10, signed=True) == "(−1.5 ± 0.3) × 10⁻⁹"


def test_a_difference_of_temperatures_in_celsius_is_in_kelvin():
    assert units.of_difference("degC") == "K"
    assert float(units.convert(5.0, "K", "degC", difference=True)) == 5.0
    assert float(units.convert(5.0, "ns", "ps")) == pytest.approx(5000.0)


def test_the_numbers_of_a_logarithmic_axis_are_few_and_apart():
    for decades in [0.05, 0.3, 0.7, 1.0, 2.5, 8.0, 30.0]:
        for low in [1e-20, 3.0]:
            for length in [100.0, 300.0]:
                limits, inch = (low, low * 10**decades), length / 72
                drawing = Figure(figsize=(2 * inch, 2 * inch), dpi=72)
                axes = drawing.add_axes((0.2, 0.2, 0.5, 0.5), xscale="log", xlim=limits, yscale="log", ylim=limits)
                axes.tick_params(labelsize=8.0)
                for axis, pressure in ((axes.xaxis, False), (axes.yaxis, True)):
                    tick.put_ticks(axis, log=True, length=length, size=8.0, pressure=pressure)
                for axis, ends in ((axes.xaxis, ("x0", "x1")), (axes.yaxis, ("y0", "y1"))):
                    axis.get_tightbbox()  # puts the numbers at their places
                    boxes = [text.get_window_extent() for text in tick_texts(axis)]
                    assert 2 <= len(boxes) <= 18
                    places = sorted(tuple(getattr(box, end) for end in ends) for box in boxes)
                    assert all(left[1] < right[0] for left, right in pairwise(places))


# The file


MINE = {"font.size": 30.0, "lines.linewidth": 9.0, "svg.hashsalt": "x", "savefig.dpi": 50, "axes.facecolor": "yellow"}
"""A user's own settings of matplotlib."""


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


def test_the_users_own_matplotlib_settings_are_not_changed():
    with matplotlib.rc_context(MINE):
        before = dict(matplotlib.rcParams)
        plot.figure(small([280.0, 290.0]))
        assert dict(matplotlib.rcParams) == before


def test_drawing_does_not_change_the_run(runs, drawings):
    for scene, make in SCENES.items():
        xr.testing.assert_identical(runs[scene], make())


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


def test_an_unknown_format_is_refused_with_those_that_are_known(tmp_path):
    for name, format, words in [
        ("figure.gif", None, "format = gif is unknown: give a file name or format of png, svg or pdf"),
        ("figure", None, "format is not given: give a file name or format of png, svg or pdf"),
        ("figure.png", "pdf", "format = pdf does not go with the file name figure.png"),
    ]:
        with pytest.raises(SettingError, match=words):
            plot.save(small([280.0]), tmp_path / name, format)


def test_an_unknown_theme_is_refused_with_those_that_are_known(tmp_path):
    with pytest.raises(SettingError, match='give theme="notes" or theme="slides"'):
        plot.figure(small([280.0]), "poster")
    with pytest.raises(SettingError, match="theme = poster"):
        plot.save(small([280.0]), tmp_path / "figure.png", theme="poster")


def broken(**changes):
    run = small([280.0, 290.0])
    return run.assign_attrs(changes)


def test_a_file_that_cannot_be_drawn_is_refused_in_a_sentence():
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


def test_one_moment_alone_is_its_own_mean():
    dataset = xr.Dataset(
        {"noise": variable("elapsed_time", [5.0], "K")}, coords={"elapsed_time": variable("elapsed_time", [1.0], "ns")}
    )
    line = Line("elapsed_time", "noise", "noise")
    assert curve(dataset, Panel("line", "Noise", (line,), averages=9), line).y.tolist() == [5.0]


def test_a_line_of_a_headline_that_the_run_could_not_give_is_left_out():
    base = Line("t", "cloud_base_theory", "condensation level", "reference")
    panel = Panel("profile", "A kink", (Line("t", "p", "parcel"), base), headlines=("cloud_base",))
    held = xr.Dataset({"t": ("time", [280.0]), "p": ("time", [9e4])}, attrs={"atmosbox_panels": to_json([panel])})
    assert [line.label for line in panels_of(held)[0].lines] == ["parcel"]
    found = held.assign(cloud_base=9e4, cloud_base_theory=9.1e4)
    assert [line.label for line in panels_of(found)[0].lines] == ["parcel", "condensation level"]


USUAL = ("atmosphere", "temperature", "lifting-sounding")


@pytest.mark.parametrize(
    "scene",
    [pytest.param(name, marks=() if name in USUAL else pytest.mark.validate) for name in scenarios.names()],
)
def test_a_run_stopped_after_one_frame_is_drawn_if_the_stop_message_says_so(scene, tmp_path, monkeypatch):
    advance = Recording.advance

    def advance_once(recording, watch):
        if recording.frames:
            raise KeyboardInterrupt
        advance(recording, watch)

    monkeypatch.setattr(Recording, "advance", advance_once)
    monkeypatch.chdir(tmp_path)
    few = () if scene == "elastic-collisions" else ("--set", "molecules=200")
    stopped = typed("run", scene, *few, "--out", "x.nc")
    assert "1 complete frames are kept in x.part.nc" in stopped.stderr
    drawn = typed("plot", "x.part.nc")
    if scene == "atmosphere":  # a layer needs two frames for its mean
        assert "atmosbox plot" not in stopped.stderr
        assert "stopped too early for a figure" in drawn.stderr
    else:
        assert "atmosbox plot x.part.nc" in stopped.stderr
        assert drawn.exit_code == 0, drawn.stderr

"""The figure of a sweep: curves, families of curves, words, and sweeps that cannot be drawn."""

from pathlib import Path

import numpy as np
import xarray as xr

from atmosbox.plot.sweep_figure import figure, is_sweep
from atmosbox.sweep import plan
from atmosbox.sweep.result import join

LABELS = {"mean_temperature": ("K", "degC", "temperature"), "mean_pressure": ("Pa", "hPa", "pressure")}


def measured(headlines):
    """Return what a run has measured: value, standard error and theory by name, with unit, shown unit and label."""
    made = {}
    for name, (value, error, theory, unit, shown, label) in headlines.items():
        made[name] = ((), value, {"units": unit, "display_units": shown, "long_name": label})
        made |= {f"{name}_se": error, f"{name}_tolerance": 0.0}
        made |= {} if theory is None else {f"{name}_theory": theory}
    return xr.Dataset({**made, "ledger": 1e-15}, attrs={"names": list(headlines)})


def swept(vary, members=4, law=lambda values: (300.0, 1e5)):
    """Return a sweep whose runs scatter about a law of the settings."""
    grid = plan("temperature", vary, members=members)
    rng = np.random.default_rng(1)
    rows = {}
    for task in grid.tasks(Path()):
        rows[task.point, task.member] = measured(
            {
                name: (answer + 0.01 * answer * rng.normal(), 0.01 * answer, answer, *words)
                for (name, words), answer in zip(LABELS.items(), law(grid.values(task.point)), strict=True)
            }
        )
    return join(grid, rows, {}, "then: atmosbox sweep")


def by_temperature(values):
    return values["temperature"] + 273.15, 1e5 * (values["temperature"] + 273.15) / 300.0


def curves(axes):
    """Return the numbers of the dashed curves of some axes."""
    return [line.get_ydata() for line in axes.lines if line.is_dashed()]


def texts(drawing):
    return " ".join(text.get_text() for axes in drawing.axes for text in (*axes.texts, *axes.get_legend().get_texts()))


def test_one_setting_becomes_points_with_bars_and_theory_dashed():
    found = swept(["temperature=-10degC:40degC:6"], members=8, law=by_temperature)
    assert is_sweep(found)
    for name in LABELS:  # a point whose runs have failed
        for part in (name, f"{name}_se", f"{name}_theory"):
            found[part][1] = np.nan
    drawing = figure(found)
    first, second = drawing.axes
    assert (first.get_ylabel(), second.get_ylabel()) == ("temperature (°C)", "pressure (hPa)")
    assert second.get_xlabel() == "temperature of the walls (°C)"
    assert (second.get_xscale(), second.get_yscale()) == ("linear", "linear")
    (dashed,) = curves(first)
    assert np.allclose(dashed, [-10.0, np.nan, 10.0, 20.0, 30.0, 40.0], equal_nan=True)
    assert len(first.containers[0]) == 3, "points, caps and bars"
    said = texts(drawing)
    assert "mean of 8 runs" in said
    assert "theory, joined" in said


SLAB = {
    "vapor_pressure": ("Pa", "hPa", [5.8e5, 11.7e5, 22.3e5], [0.5e5, 0.7e5, 0.9e5]),
    "clapeyron_slope": ("K", "K", [763.0, 831.0, 978.0], [65.0, 51.0, 48.0]),
    "liquid_density": ("kg m-3", "kg m-3", [1205.0, 1122.0, 1012.0], [1.0, 2.0, 7.0]),
    "vapor_density": ("kg m-3", "kg m-3", [24.2, 52.9, 128.6], [1.5, 2.1, 6.5]),
}


def slabs():
    """Return a sweep over slabs of liquid with the results of six real runs."""
    grid = plan(
        "attraction", ["temperature=111.4K,123.8K,136.2K"], members=1, settings={"start": "slab", "density": 1.0}
    )
    rows = {}
    for task in grid.tasks(Path()):
        found = {}
        for name, (unit, shown, values, errors) in SLAB.items():
            found[name] = (values[task.point - 1], errors[task.point - 1], None, unit, shown, name)
        rows[task.point, task.member] = measured(found)
    return join(grid, rows, {}, "then: atmosbox sweep")


def test_vapour_pressures_are_drawn_over_one_over_temperature_with_the_slope_of_each_run():
    drawing = figure(slabs())
    left, right = drawing.axes
    assert (left.get_xlabel(), left.get_yscale()) == ("1000 K / T", "log")
    points = left.containers[0].lines[0].get_xydata()[::2]
    np.testing.assert_allclose(
        points, np.column_stack([1e3 / np.array([111.4, 123.8, 136.2]), [5800.0, 11700.0, 22300.0]])
    )
    (line,) = [line for line in left.lines if line.get_linewidth() == max(each.get_linewidth() for each in left.lines)]
    ends = line.get_xydata().reshape(3, 3, 2)[:, :2]  # two ends and a gap for each run
    slopes = np.diff(np.log(ends[:, :, 1]), axis=1) / np.diff(ends[:, :, 0], axis=1)
    np.testing.assert_allclose(slopes[:, 0], -1e-3 * np.array(SLAB["clapeyron_slope"][2]))
    np.testing.assert_allclose(np.exp(np.log(ends[:, :, 1]).mean(axis=1)), points[:, 1])
    said = " ".join(text.get_text() for text in drawing.texts)
    assert "L/RΔZ, measured within the runs" in said
    assert right.get_ylabel() == "temperature (K)"


def test_a_second_setting_of_few_values_becomes_a_family_of_curves():
    drawing = figure(swept(["molecules=100,200", "temperature=0:40:5"], law=by_temperature))
    said = texts(drawing)
    assert "molecules 100" in said
    assert "molecules 200" in said
    assert len(curves(drawing.axes[0])) == 1, "theories that are the same are drawn once"
    assert drawing.axes[1].get_xlabel() == "temperature of the walls (°C)"
    apart = figure(swept(["pressure=500,1000", "temperature=0:40:5"], law=lambda v: (300.0, 1e2 * v["pressure"])))
    assert len(curves(apart.axes[1])) == 2
    assert "theory, pressure 500 hPa" in texts(apart)

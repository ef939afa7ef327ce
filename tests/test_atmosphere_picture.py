"""The picture of the atmosphere shows the cloud that the run has measured, where it has measured it."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.figure import Figure

import atmosbox as ab
from atmosbox.plot.atmosphere_picture import ascent_of, draw_atmosphere, draw_ground, draw_way
from atmosbox.plot.theme import THEMES

NOTES = THEMES["notes"]


def lift(height, **others):
    """Return a run whose parcel was at such heights [m], in an environment whose pressure falls by e in 8 km."""
    height = np.asarray(height, float)
    data = {
        "parcel_height": height,
        "parcel_temperature": 298.0 - 6e-3 * height,
        "environment_pressure": 1e5 * np.exp(-height / 8e3),
    } | {name: np.asarray(values, float) for name, values in others.items() if np.ndim(values)}
    scalars = {name: values for name, values in others.items() if not np.ndim(values)}
    timed = {name: ("elapsed_time", values) for name, values in data.items()}
    return xr.Dataset(timed | scalars, coords={"elapsed_time": np.arange(height.size) + 1.0})


def drawn(dataset, until):
    """Return the text of the legend for a parcel at a frame."""
    axes, way = Figure(figsize=(2.0, 4.0)).add_subplot(), ascent_of(dataset)
    draw_ground(axes, way, NOTES)
    return [label for _, label in draw_way(axes, way, until, np.array([until]), NOTES)]


def cloudy(molecules, top, seed):
    """Return a run up to a pressure, and in which of its frames there is a cloud."""
    run = ab.run("lifting-moist", molecules=molecules, top_pressure=top, ascent=60, seed=seed)
    return run, ascent_of(run).cloudy


def test_molecules_that_cluster_by_chance_are_no_cloud_and_what_condenses_above_the_base_is_one():
    for seed in range(1, 5):
        run, seen = cloudy(1000, "905hPa", seed)  # up to 79 % relative humidity
        assert float(run.cloud_liquid_water_mixing_ratio.max()) > 1e-3
        assert not seen.any(), seed
    run, seen = cloudy(3000, "500hPa", 1)
    assert seen[run.parcel_pressure < 65e3].all()


def test_the_cloud_appears_when_the_parcel_has_passed_its_measured_base():
    height = np.linspace(0.0, 6e3, 61)
    held = {
        "cloud_liquid_water_mixing_ratio": np.where(height < 1.5e3, 3e-4, 2e-3),
        "largest_haze_mixing_ratio": np.full(61, 5e-4),
    }
    run = lift(height, **held, cloud_base=1e5 * np.exp(-1.5e3 / 8e3))
    assert ascent_of(run).base == pytest.approx(1.5, abs=0.02)
    assert drawn(run, 10) == ["parcel"]
    assert drawn(run, 20) == ["parcel", "cloud"]
    below = lift(height, **held, cloud_base=1.013e5)
    assert np.isnan(ascent_of(below).base), "a base below the ground is none"


def test_a_way_that_goes_down_again_has_mountains_below_it_and_rain_where_it_fell():
    height = 2e3 * np.sin(np.linspace(0.0, np.pi, 41))
    rain = np.maximum.accumulate(np.where(height > 1.2e3, height - 1.2e3, 0.0)) * 1e-6
    liquid, haze = np.where(height > 1e3, 1e-3, 0.0), np.full(41, 5e-4)
    run = lift(height, cloud_liquid_water_mixing_ratio=liquid, largest_haze_mixing_ratio=haze, rain_mixing_ratio=rain)
    way, axes = ascent_of(run), Figure().add_subplot()
    assert way.crosses
    assert not ascent_of(lift(np.linspace(0.0, 2e3, 9))).crosses
    assert [label for _, label in draw_atmosphere(axes, run, NOTES)] == ["parcel", "cloud", "rain"]
    streaks = next(each for each in axes.collections if type(each).__name__ == "LineCollection")
    falls = [line[0, 1] for line in streaks.get_segments()]
    assert min(falls) >= 1.2 - 0.1
    assert drawn(run, 5) == ["parcel"]


def test_the_parcel_is_drawn_as_large_as_it_has_grown():
    way = ascent_of(lift([0.0, 8e3]))
    temperature = (298.0 - 48.0) / 298.0
    assert way.radius.tolist() == pytest.approx([1.0, (temperature * np.e) ** (1.0 / 3.0)])

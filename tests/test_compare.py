"""Comparisons of runs: exactly the settings that differ are named, and differences have standard errors."""

import json
import math

import pytest
import xarray as xr

import atmosbox
from atmosbox.file import netcdf as output
from atmosbox.plot import compare as comparison
from atmosbox.plot.compare import compared, naming
from tests.in_process import typed

SMALL = {"molecules": 100, "ascent": 20.0}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Files of short runs that differ in one thing or more."""
    folder = tmp_path_factory.mktemp("compared")
    wanted = {
        "mild": ("lifting-dry", {}),
        "cold": ("lifting-dry", {"temperature": 5.0}),
        "again": ("lifting-dry", {"seed": 2}),
        "coldagain": ("lifting-dry", {"temperature": 5.0, "seed": 2}),
    }
    for name, (scene, settings) in wanted.items():
        found = atmosbox.run(scene, out=folder / f"{name}.nc", save_molecules=False, **SMALL, **settings)
        if name == "mild":
            made = json.loads(found.attrs["atmosbox_parameters"]) | {"engine": "stepped:delta=0.01"}
            output.write(found.assign_attrs(atmosbox_parameters=json.dumps(made)), folder / "stepped.nc")
    atmosbox.run("lifting-moist", out=folder / "moist.nc", molecules=300, ascent=20.0)
    return folder


def command(folder, *words):
    words = [str(folder / word) if word.endswith(".nc") else word for word in words]
    return typed("compare", *words, COLUMNS=None)


def read(folder, *names):
    return [output.read(folder / f"{name}.nc") for name in names]


def legend(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


# What differs


def test_the_changed_setting_alone_is_named(files):
    cases = [
        (("cold", "mild"), "temperature 5 degC / 15 degC", ("5 degC", "15 degC")),
        (("mild", "again"), "seed 1 / 2", ("seed 1", "seed 2")),
        (("mild", "stepped"), "engine exact / stepped:delta=0.01", ("exact", "stepped:delta=0.01")),
        (
            ("mild", "coldagain"),
            "temperature 15 degC / 5 degC, seed 1 / 2",
            ("temperature 15 degC, seed 1", "temperature 5 degC, seed 2"),
        ),
    ]
    for pair, title, labels in cases:
        named = naming(read(files, *pair), pair)
        assert named.title == title
        assert named.labels == labels
        assert not named.same


def test_runs_of_unlike_scenes_are_called_by_their_files_and_each_adiabat_by_its_own_scene(files, tmp_path):
    result = command(files, "mild.nc", "moist.nc", "--out", str(tmp_path / "both.png"))
    assert result.stdout.splitlines()[:2] == ["lifting-dry and lifting-moist: different scenes", ""]
    runs = read(files, "mild", "moist")
    named = naming(runs, ["mild", "moist"])
    assert [change.name for change in named.changes] == ["scene"]
    assert named.labels == ("mild", "moist")
    labels = legend(comparison.figure(runs, named.labels, named.title).axes[0])
    assert labels == ["mild", "moist", "dry adiabat, mild", "moist adiabat, moist", "environment"]


def test_the_same_run_twice_is_said_to_be_the_same(files):
    named = naming(read(files, "mild", "mild"), ["mild", "mild"])
    assert named.same
    assert named.changes == ()
    assert len(set(named.labels)) == 2


def test_a_scene_of_ones_own_is_named_without_being_run(files, tmp_path):
    one, other = read(files, "mild", "cold")
    trap = tmp_path / "my_scene.py"
    trap.write_text("raise SystemExit('run')", encoding="utf-8")
    for dataset in (one, other):
        made = json.loads(dataset.attrs["atmosbox_parameters"]) | {"scene": str(trap)}
        dataset.attrs["atmosbox_parameters"] = json.dumps(made)
    assert naming([one, other], ["a", "b"]).title == "temperature 15 / 5"


# By how much the results differ


def run_with(value, error, theory=None):
    held = {"t": ((), value, {"units": "K", "display_units": "degC", "long_name": "warmth"}), "t_se": error}
    if theory is not None:
        held["t_theory"] = theory
    return xr.Dataset(held, attrs={"atmosbox_headlines": '["t"]'})


def test_a_difference_has_the_errors_of_both_runs():
    (found,) = compared([run_with(280.0, 0.3, 279.0), run_with(290.0, 0.4, 290.5), run_with(math.nan, 0.1)])
    assert found.unit == "degC"
    assert found.runs[0].value == pytest.approx(6.85)
    assert found.difference(1) == pytest.approx(10.0)
    assert found.error(1) == pytest.approx(0.5)
    assert found.sigma(1) == pytest.approx(20.0)
    assert found.expected(1) == pytest.approx(11.5)
    assert math.isnan(found.difference(2))


# The figure


def test_theory_is_drawn_once_if_it_is_the_same_and_else_for_each(files):
    def adiabats(*names):
        axes = comparison.figure(read(files, *names), list(names), "Lifting").axes[0]
        assert legend(axes).count("dry adiabat") == 1
        return sum(line.get_linestyle() == "--" for line in axes.lines if len(line.get_xdata()) > 1)

    once, each = adiabats("mild", "again"), adiabats("mild", "cold")
    assert each == once + 1  # the environment; the adiabat follows the measured pressure of each run


# The command


def test_json_holds_the_same_numbers_and_nothing_else_is_printed(files, tmp_path):
    result = command(files, "cold.nc", "mild.nc", "--out", str(tmp_path / "both.svg"), "--json")
    found = json.loads(result.stdout)
    assert found["changes"] == {"temperature": ["5 degC", "15 degC"]}
    number = found["headlines"][0]
    first, second = number["runs"]
    assert second["difference"] == pytest.approx(second["value"] - first["value"])
    error = math.hypot(first["standard_error"], second["standard_error"])
    assert second["difference_standard_error"] == pytest.approx(error)
    assert second["sigma"] == pytest.approx(second["difference"] / error)
    assert first["sigma"] is None

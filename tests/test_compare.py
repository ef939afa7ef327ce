"""Comparisons of runs: exactly the settings that differ are named, and differences have standard errors."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_hex
from typer.testing import CliRunner

import atmosbox
from atmosbox.cli import app
from atmosbox.cli.output_name import beside
from atmosbox.errors import FileError
from atmosbox.file import netcdf as output
from atmosbox.plot.compare import compared, naming
from atmosbox.plot.compare import figure as comparison
from atmosbox.plot.curve import Curve
from atmosbox.scene.panels import Line, Panel, to_json

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
    atmosbox.run("elastic-collisions", out=folder / "discs.nc", molecules=20, duration=2.0)
    return folder


def command(folder, *words):
    words = [str(folder / word) if word.endswith(".nc") else word for word in words]
    return CliRunner().invoke(app, ["compare", *words], env={"COLUMNS": None})


def refused(result):
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    return line


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


def test_equal_settings_with_other_numbers_are_not_the_same_run(files):
    one, other = read(files, "mild", "mild")
    other["air_temperature"] = other["air_temperature"] + 1.0
    named = naming([one, other], ["one", "other"])
    assert not named.same
    assert named.title == "the same settings, different results"
    assert named.labels == ("one", "other")


def test_runs_with_many_changes_are_called_by_their_files(files):
    one, other = read(files, "mild", "coldagain")
    made = json.loads(other.attrs["atmosbox_parameters"])
    made["settings"]["ascent"] = 21.0
    other.attrs["atmosbox_parameters"] = json.dumps(made)
    named = naming([one, other], ["one", "other"])
    assert [change.name for change in named.changes] == ["temperature", "ascent", "seed"]
    assert named.labels == ("one", "other")


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


def test_a_number_that_one_run_alone_has_is_left_out():
    assert compared([run_with(280.0, 0.3), xr.Dataset()]) == ()


def test_a_result_that_no_file_holds_is_refused():
    changed = xr.Dataset(attrs={"atmosbox_headlines": '["warmth"]'})
    with pytest.raises(FileError, match="No file has the variable 'warmth'"):
        compared([changed, changed])


def test_two_seeds_agree_within_their_errors(files):
    # |z| < 4 for three numbers of two independent runs: a false alarm in 5000 pairs of seeds.
    for each in compared(read(files, "mild", "again")):
        assert abs(each.sigma(1)) < 4.0


# The figure


def test_runs_differ_by_colour_and_marker_and_the_legend_says_their_setting(files):
    runs = read(files, "cold", "mild")
    drawing = comparison.figure(runs, ["5 °C", "15 °C"], "Lifting")
    axes = drawing.axes[0]
    assert legend(axes)[:2] == ["5 °C", "15 °C"]
    bars = [container[0] for container in axes.containers]
    assert len({to_hex(line.get_color()) for line in bars}) == 2
    assert len({line.get_marker() for line in bars}) == 2


def test_theory_is_drawn_once_if_it_is_the_same_and_else_for_each(files):
    def adiabats(*names):
        axes = comparison.figure(read(files, *names), list(names), "Lifting").axes[0]
        assert legend(axes).count("dry adiabat") == 1
        return sum(line.get_linestyle() == "--" for line in axes.lines if len(line.get_xdata()) > 1)

    once, each = adiabats("mild", "again"), adiabats("mild", "cold")
    assert each == once + 1  # the environment; the adiabat follows the measured pressure of each run


PLAIN = Panel("line", "Warm", (Line("elapsed_time", "t", "air"),))


def test_one_law_at_other_places_is_the_same_law():
    x = np.linspace(0.0, 1.0, 30)
    law = Curve(x, x**2, None)
    assert comparison._same(law, Curve(x[1:-1] + 0.01, (x[1:-1] + 0.01) ** 2, None), PLAIN)
    assert not comparison._same(law, Curve(x, x**2 + 0.01, None), PLAIN)


def test_runs_in_other_units_of_time_are_drawn_in_one():
    def run(unit, end):
        warm = Panel("line", "Warm", (Line("elapsed_time", "t", "air"),))
        return xr.Dataset(
            {"t": ("elapsed_time", [280.0, 290.0], {"units": "K"})},
            coords={"elapsed_time": ("elapsed_time", [0.0, end], {"units": unit})},
            attrs={"atmosbox_panels": to_json([warm])},
        )

    axes = comparison.figure([run("ns", 1000.0), run("us", 1.0)], ["a", "b"], "Two").axes[0]
    ends = {float(np.asarray(line.get_xdata(), float)[-1]) for line in axes.lines}
    assert sorted(ends) == pytest.approx([1000.0] * len(ends))


def test_runs_without_a_graph_in_common_are_refused(files):
    assert "no graph in common" in refused(command(files, "mild.nc", "discs.nc"))


@pytest.mark.parametrize("kind", ["svg", *(pytest.param(name, marks=pytest.mark.validate) for name in ("png", "pdf"))])
def test_the_same_comparison_gives_the_same_bytes(files, tmp_path, kind):
    made = [tmp_path / f"{k}.{kind}" for k in (1, 2)]
    for path in made:
        assert command(files, "cold.nc", "mild.nc", "--out", str(path), "--quiet").exit_code == 0
    assert made[0].read_bytes() == made[1].read_bytes()


# The command


def test_the_command_says_what_differs_and_by_how_much(files, tmp_path):
    path = tmp_path / "both.png"
    result = command(files, "cold.nc", "mild.nc", "--out", str(path))
    assert result.exit_code == 0, result.output
    assert result.stdout.splitlines()[0] == "lifting-dry: temperature 5 degC / 15 degC"
    assert "σ)" in result.stdout
    assert result.stdout.splitlines()[-1] == f"file: {path}"
    assert path.read_bytes()[1:4] == b"PNG"


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


def test_three_runs_stand_below_each_other(files, tmp_path):
    path = tmp_path / "three.pdf"
    result = command(files, "cold.nc", "mild.nc", "again.nc", "--out", str(path))
    assert result.exit_code == 0, result.output
    assert "minus the first" in result.stdout
    assert path.read_bytes()[:4] == b"%PDF"


def test_one_run_too_few_or_too_many_is_refused(files):
    assert "give a second run" in refused(command(files, "mild.nc"))
    assert "give two to six runs" in refused(command(files, *["mild.nc"] * 7))


def test_the_same_run_twice_is_drawn_and_said_on_stderr(files, tmp_path):
    result = command(files, "mild.nc", "mild.nc", "--out", str(tmp_path / "same.png"))
    assert result.exit_code == 0, result.output
    assert "hold the same run" in result.stderr
    assert "the same run" in result.stdout


def test_a_page_shows_two_runs_and_no_more(files, tmp_path):
    sentence = refused(command(files, "mild.nc", "cold.nc", "again.nc", "--out", str(tmp_path / "all.html")))
    assert "atmosbox view" in sentence


def test_a_page_needs_the_molecules_of_both_runs(files, tmp_path):
    path = tmp_path / "both.html"
    assert "--save-molecules" in refused(command(files, "mild.nc", "cold.nc", "--out", str(path)))
    for temperature in (5.0, 15.0):
        atmosbox.run(
            "lifting-dry", out=tmp_path / f"{temperature}.nc", save_molecules=True, temperature=temperature, **SMALL
        )
    result = command(tmp_path, "5.0.nc", "15.0.nc", "--out", str(path))
    assert result.exit_code == 0, result.output
    assert path.read_text(encoding="utf-8").lower().startswith("<!doctype html")


def test_the_figure_stands_beside_the_first_file():
    assert beside(["runs/a.nc", "b.nc"], "svg") == Path("runs/a-and-b.svg")
    assert len(beside([f"{'long' * 20}{k}.nc" for k in range(6)], "png").name) < 150


def test_a_run_that_does_not_say_what_it_is_is_refused(files):
    (one,) = read(files, "mild")
    other = one.copy()
    other.attrs = {}
    with pytest.raises(FileError, match="does not say which run it holds"):
        naming([one, other], ["one", "other"])

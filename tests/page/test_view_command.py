"""The command `atmosbox view`."""

import pytest
import xarray as xr
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.file.netcdf import write

RUNNER = CliRunner()


def view(*words):
    """Return what the command said, and how it ended."""
    return RUNNER.invoke(app, ["view", *map(str, words)])


@pytest.fixture
def file(run, tmp_path):
    return write(run(4, 6), tmp_path / "warm.nc")


def test_the_page_stands_beside_the_run_by_its_name(file):
    done = view(file)
    assert done.exit_code == 0
    assert done.stdout == f"{file.with_suffix('.html')}\n"
    assert file.with_suffix(".html").read_text(encoding="utf-8").startswith("<!doctype html>")


@pytest.mark.parametrize("option", ["-o", "--out"])
def test_the_page_can_have_another_name_and_theme(file, tmp_path, option):
    done = view(file, option, tmp_path / "page.html", "--theme", "dark")
    assert done.exit_code == 0
    assert 'data-theme="dark"' in (tmp_path / "page.html").read_text(encoding="utf-8")


def test_two_runs_become_one_page(file, run, tmp_path):
    other = write(run(5, 6, settings={"temperature": 60.0}), tmp_path / "hot.nc")
    done = view(file, other)
    assert done.exit_code == 0
    assert (tmp_path / "warm-and-hot.html").is_file()


def test_three_runs_are_refused(file):
    done = view(file, file, file)
    assert done.exit_code == 2
    assert "give one run, or two to compare" in done.stderr


def test_a_page_is_not_replaced_before_anything_is_read(tmp_path):
    (tmp_path / "run.html").write_text("mine")
    done = view(tmp_path / "run.nc")
    assert done.exit_code == 2
    assert "--force" in done.stderr


def broken(folder, kind, run):
    path = folder / "bad.nc"
    if kind == "empty":
        path.touch()
    elif kind == "text":
        path.write_text("elapsed_time, temperature\n")
    elif kind == "foreign":
        xr.Dataset({"t2m": ("time", [280.0])}).to_netcdf(path)
    elif kind == "without molecules":
        write(run().drop_dims("molecule"), path)
    return path


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("missing", "does not exist"),
        ("empty", "is empty"),
        ("text", "is no netCDF file"),
        ("foreign", "was written by another program"),
        ("without molecules", "holds no molecules: type atmosbox run temperature --save-molecules"),
    ],
)
def test_what_is_no_run_with_molecules_is_refused_in_a_sentence(tmp_path, run, kind, said):
    done = view(broken(tmp_path, kind, run))
    assert done.exit_code == 2
    assert said in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "bad.html").exists()

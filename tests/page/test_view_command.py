"""The command `atmosbox view`."""

import pytest
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.file.netcdf import write

RUNNER = CliRunner()


def view(*words):
    """Return the output of the command, and its exit status."""
    return RUNNER.invoke(app, ["view", *map(str, words)])


@pytest.fixture
def file(run, tmp_path):
    return write(run(4, 6), tmp_path / "warm.nc")


def test_the_page_stands_beside_the_run_by_its_name(file):
    done = view(file)
    assert done.exit_code == 0
    assert done.stdout == f"{file.with_suffix('.html')}\n"
    assert file.with_suffix(".html").read_text(encoding="utf-8").startswith("<!doctype html>")


def test_the_page_can_have_another_name_and_theme(file, tmp_path):
    done = view(file, "--out", tmp_path / "page.html", "--theme", "dark")
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

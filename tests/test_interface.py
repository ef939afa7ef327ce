"""The functions that scripts and notebooks call: `atmosbox.run` and the others."""

import importlib.util
import sys
from pathlib import Path

import pytest
import xarray as xr

import atmosbox as ab
from atmosbox import errors
from atmosbox.interface import drawing
from tests.few_frames import few_frames_of

ROOT = Path(__file__).resolve().parents[1]
SCENE = "elastic-collisions"


few_frames = few_frames_of({SCENE: (60, 20), "temperature": (60, 10)})
"""Runs have few frames: their ends took most of the time."""


@pytest.fixture(scope="module")
def lifted():
    return ab.run("lifting-dry", molecules=200)


# A run and its numbers


def test_a_run_begins_with_its_numbers_and_is_a_dataset_in_all_else(lifted):
    head, _, table, *rest = repr(lifted).splitlines()
    assert head.startswith("lifting-dry: ")
    assert "200 molecules" in head
    assert table.split()[:3] == ["quantity", "measured", "theory"]
    assert rest[0].startswith("temperature at 700 hPa [degC]")
    plain = xr.Dataset(lifted.variables, attrs=lifted.attrs).set_coords(lifted.coords)
    assert repr(lifted).endswith(repr(plain))
    assert lifted.identical(plain)
    shown = lifted._repr_html_()
    assert shown.index("temperature at 700 hPa") < shown.index("xarray.Dataset") < shown.index("parcel_temperature")


def test_two_runs_are_laid_over_each_other_with_their_numbers(lifted):
    warm = ab.run("lifting-dry", molecules=200, temperature="30 degC")
    both = ab.compare(lifted, warm)
    assert repr(both).splitlines()[0] == "lifting-dry: temperature 15 degC / 30 degC"
    assert any(line.startswith("temperature at 300 hPa") for line in repr(both).splitlines())
    assert "<pre" in both._repr_html_()
    assert both.figure.axes


# Pages and bars


def test_the_page_runs_inside_a_notebook(monkeypatch, browser, tmp_path):
    monkeypatch.setattr(drawing, "in_notebook", lambda: True)
    file = tmp_path / "notebook.html"
    run = ab.run("temperature", molecules=50, duration="20 ns", save_molecules=True)
    shown = ab.show(run, height=500)
    file.write_text(f"<body>{shown._repr_html_()}</body>", encoding="utf-8")
    tab = browser.new_page(viewport={"width": 1000, "height": 600})
    faults = []
    tab.on("pageerror", lambda fault: faults.append(fault))
    tab.goto(file.as_uri())
    frame = tab.frame_locator("iframe")
    frame.locator("canvas").first.wait_for(timeout=20_000)
    assert tab.locator("iframe").bounding_box()["height"] == 500
    assert "What is temperature?" in frame.locator("h1").inner_text()
    tab.close()
    assert faults == []


# Refusals


def test_a_refusal_says_what_to_write_in_python():
    for call, fix in [
        (lambda: ab.run("lifting-dry", molecules=0), "give molecules=50."),
        (lambda: ab.run("lifting-dry", temperature="5 hPa"), 'give temperature="15degC".'),
        (lambda: ab.run("lifting-dry", rotation="maybe"), "give rotation=True."),
        (lambda: ab.run("lifting-dry", molecule=300), "give molecules=4000."),
        (lambda: ab.run("lifting-dry", engine="exakt"), 'give engine="exact".'),
        (lambda: ab.run("lifting-dry", accuracy="good"), 'accuracy="'),
        (lambda: ab.run("lifting-dri"), "`atmosbox.scenes()` shows all."),
        (lambda: ab.sweep("temperature", {}), "give vary={"),
        (lambda: ab.sweep("temperature", {"molecules": [100]}, members=0), "give members=1."),
        (lambda: ab.sweep("temperature", {"molecules": "100:x"}), 'give vary={"molecules": "'),
        (lambda: ab.compare("a.nc"), "give two to six."),
        (lambda: ab.open("a.nc"), "check the name and the folder."),
    ]:
        with pytest.raises(errors.AtmosboxError) as refused:
            call()
        assert fix in str(refused.value)
        assert "--" not in str(refused.value)


# The stub for editors


def test_what_an_editor_knows_is_what_the_scenes_say():
    spec = importlib.util.spec_from_file_location("tools_stub", ROOT / "tools" / "stub.py")
    made = importlib.util.module_from_spec(spec)
    before = sys.path[:]
    try:
        spec.loader.exec_module(made)
    finally:
        sys.path[:] = before
    assert (ROOT / "atmosbox" / "__init__.pyi").read_text(encoding="utf-8") == made.stub(), (
        "the settings of a scene have changed: run python tools/stub.py"
    )

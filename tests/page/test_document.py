"""The page as one document, and as a file."""

import hashlib
import json
import re
from importlib import resources

import pytest

from atmosbox.errors import FileError
from atmosbox.page import lab_page, save, view_page
from atmosbox.page.document import MODULES
from atmosbox.page.saved_run import pages

PACKAGE = resources.files("atmosbox.page")


def told(page):
    """Return the data of the runs in a page."""
    _, _, rest = page.partition('<script type="application/json" id="told">')
    return json.loads(rest.partition("</script>")[0])["runs"]


def test_the_libraries_are_as_published():
    listed = {}
    for line in PACKAGE.joinpath("vendor", "VERSIONS").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            _, _, name, digest = line.split()
            listed[name] = digest
    held = {
        f"{folder.name}/{file.name}": hashlib.sha256(file.read_bytes()).hexdigest()
        for folder in PACKAGE.joinpath("vendor").iterdir()
        if folder.is_dir()
        for file in folder.iterdir()
    }
    assert held == listed
    assert {"three/LICENSE", "uplot/LICENSE", "lean-qr/LICENSE"} <= set(held)


def test_every_script_stands_after_those_that_it_imports_and_none_is_forgotten():
    scripts = {file.name: file.read_text(encoding="utf-8") for file in PACKAGE.joinpath("web").iterdir()}
    scripts = {name: text for name, text in scripts.items() if name.endswith(".js") and name != "boot.js"}
    lab = lab_page({"title": "Air"}, [["20", 5, 9]], "AA==", "AA==")
    for page, entry in ((view_page([], []), "view.js"), (lab, "lab.js")):
        order = re.findall(r'data-module="([\w.]+)"', page)
        assert order[-1] == entry
        for place, name in enumerate(order):
            wanted = re.findall(r'^import .* from "\./([\w.]+)"', scripts.get(name, ""), re.MULTILINE)
            assert set(wanted) <= set(order[:place]), name
    assert set(MODULES) <= set(scripts)


@pytest.mark.parametrize("page", [view_page([], []), lab_page({"title": "Air"}, [["20", 5, 9]], "AA==", "AA==")])
def test_a_page_asks_for_nothing_outside_of_itself(page):
    assert re.findall(r'<(?:script|img|link|iframe)[^>]*(?:src|href)="(?!data:)', page) == []
    assert "default-src 'none'" in page
    assert "@import" not in page
    assert page.count("Permission is hereby granted, free of charge") == 2 + ("qr.mjs" in page)


def test_words_of_a_run_cannot_break_out_of_the_page(run):
    wicked = '</script><script>alert("1")</script><!--'
    dataset = run(3, 4)
    dataset.attrs["title"] = dataset.attrs["comment"] = wicked
    (page,) = pages([dataset])
    text = view_page([page.record], [""])
    assert "alert(" in text
    assert "<script>alert" not in text
    assert told(text)[0]["stage"]["title"] == wicked


def test_a_run_that_is_larger_than_a_page_is_thinned_and_the_page_says_so(run, tmp_path):
    path = save([run(400, 6000)], tmp_path / "page.html")
    assert path.stat().st_size <= 10_000_000
    (record,) = told(path.read_text(encoding="utf-8"))
    shown = record["stage"]["molecules_shown"]
    assert f"{shown} of the 6000 molecules are drawn." in record["notes"]
    assert any(note.startswith("240 of the 400 frames are drawn") for note in record["notes"])
    assert len(record["values"]["air_temperature"]) == 400


def test_two_runs_are_headed_by_what_was_changed_and_share_a_scale_of_colours(run):
    warm = run(settings={"temperature": 60.0})
    warm["molecule_speed"] = warm.molecule_speed * 1.5
    first, second = pages([run(), warm])
    assert [first.record["heading"], second.record["heading"]] == ["temperature 27 °C", "temperature 60 °C"]
    assert first.record["stage"]["speed"] == second.record["stage"]["speed"]
    assert [page.record["heading"] for page in pages([run(), run()])] == ["run 1", "run 2"]
    other = run(scene="./other.py")
    other.attrs["title"] = "Another"
    assert [page.record["heading"] for page in pages([run(), other])] == ["Warmth", "Another"]


def test_a_run_that_cannot_be_shown_is_refused_with_what_to_type(run, tmp_path):
    whole = run()
    for spoilt, said in [
        (whole.drop_vars("molecule_position"), "no molecules: type atmosbox.run"),
        (whole.drop_vars("box_side"), "earlier atmosbox and lacks box_side"),
        (whole.isel(elapsed_time=slice(0)), "holds no frame"),
        (whole.expand_dims(configuration=2), "comparison of engines"),
        (whole.drop_attrs(), "does not say which run it holds"),
    ]:
        with pytest.raises(FileError, match=said):
            save([spoilt], tmp_path / "page.html")
    assert list(tmp_path.iterdir()) == []

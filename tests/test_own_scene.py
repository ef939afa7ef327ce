"""A scene of one's own: its variables, one of several gases, and the line that is named if it fails."""

from pathlib import Path

import pytest

from atmosbox.file.netcdf import read
from atmosbox.simulation import runner
from tests.in_process import typed

EXAMPLES = Path(__file__).resolve().parents[1] / "docs" / "examples"
FLASK = (EXAMPLES / "my_scene.py").read_text(encoding="utf-8")


@pytest.mark.nightly  # no scene needs its kernels
def test_of_two_gases_in_gravity_each_has_its_own_height(tmp_path):
    file = tmp_path / "two.nc"
    result = typed("run", EXAMPLES / "two_gases.py", "molecules=300", "--out", file)
    assert result.exit_code == 0, result.output
    dataset = read(file)
    helium, argon = runner.headlines_of(dataset)
    assert helium.agrees
    assert argon.agrees
    assert argon.value + 10.0 * argon.standard_error < argon.theory * 2.0 < helium.value
    assert dataset.argon_mean_height.attrs["units"] == "m"
    assert dataset.argon_mean_height.attrs["ancillary_variables"] == "argon_mean_height_theory"
    assert set(dataset.helium_number_density.attrs["ancillary_variables"].split()) == {
        "helium_number_density_se",
        "helium_number_density_theory",
    }
    found = (dataset.helium_layer_temperature - 288.15) / dataset.helium_layer_temperature_se
    assert abs(found).max() < 5.0
    for words in (["plot", file, "--out", tmp_path / "two.svg"], ["check", file]):
        assert typed(*words).exit_code == 0


WRONG = {
    "an unknown name in build": ("rng = Random", "rng = random", "LINE cannot be run (NameError: name 'random"),
    "a box that no engine makes": ("velocities(1.0", "velocities(-1.0", "LINE: the box cannot be built"),
    "no setup": ("    return Setup(", "    Setup(", "my_scene.py cannot be run (TypeError: build returns a NoneType"),
    "a variable without a declaration": (
        '"air_temperature_theory": np',
        '"light_height": np',
        "my_scene.py cannot be run (KeyError: light_height is not a variable of atmosbox: declare it in the scene",
    ),
    "no theory": ('    return {"air_', '    {"air_', "my_scene.py cannot be run (TypeError: theory returns a NoneType"),
    "a missing variable": ("dataset.heat_from_wall", "dataset.heat", "LINE cannot be run (AttributeError"),
    "wrong arguments": ("return (Headline(", "return (Headline(*range(30),", "LINE cannot be run (TypeError"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_scene_that_fails_is_told_its_line_and_the_reason(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    old, new, said = WRONG[name]
    scene = FLASK.replace(old, new).replace("450", "100")
    assert scene.count(new) == 1
    Path("my_scene.py").write_text(scene, encoding="utf-8")
    engine = "exact" if "engine" in name else "dsmc"  # whose kernels other tests need
    result = typed("run", "./my_scene.py", "molecules=10", "--engine", engine)
    assert result.exit_code in (1, 2)
    *_, sentence = result.stderr.splitlines()  # before it, that the engine is compiled
    assert said.replace("LINE", f"my_scene.py, line {scene.partition(new)[0].count(chr(10)) + 1}") in sentence
    assert "bug" not in sentence

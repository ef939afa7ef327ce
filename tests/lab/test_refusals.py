"""A box that cannot run in a page is refused in one sentence that says what to use instead."""

import pytest

from atmosbox.errors import SettingError, on_command_line
from atmosbox.lab import save_lab
from atmosbox.simulation.preparation import prepare


@pytest.mark.parametrize(
    ("scene", "settings", "engine", "reason"),
    [
        ("condensation", {"molecules": 500, "drops": 3}, None, "DropSizes"),
        ("attraction", {"start": "slab", "density": 1.0}, None, "Slab"),
        ("temperature", {"molecules": 50}, "dsmc", "exact engine"),
        pytest.param(
            *("atmosphere", {"molecules": 1000, "gravity": 100, "height": 1000}, "exact", "start=.equilibrium"),
            marks=pytest.mark.nightly,  # its cells have no rows, which no other test needs
        ),
    ],
)
def test_a_box_without_a_module_names_the_reason_and_the_way_out(tmp_path, scene, settings, engine, reason):
    with pytest.raises(SettingError, match=reason) as refused:
        save_lab(prepare(scene, settings, engine=engine), tmp_path / "lab.html")
    assert f"atmosbox run {scene} --save-molecules, then atmosbox view" in refused.value.said(on_command_line)
    assert not list(tmp_path.iterdir())

"""What a page is told: the command that it saves begins the very same run."""

import shlex

import pytest

from atmosbox.lab.lab_plan import lab_plan
from atmosbox.simulation.preparation import prepare


@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        ("temperature", {}),
        ("temperature", {"molecules": 50, "temperature": "300 K", "start": "equal", "seed": 7}),
        ("lifting-dry", {"molecules": 200, "rotation": False, "ascent": 12.5}),
    ],
)
def test_the_command_that_is_saved_begins_the_same_run(scene, settings):
    prepared = prepare(scene, settings)
    plan, _, _ = lab_plan(prepared)
    program, verb, named, *options = shlex.split(plan["command"])
    assert (program, verb, named) == ("atmosbox", "run", scene)
    assert options[-2:] == ["--seed", str(prepared.settings.seed)]
    values = dict(each.split("=", 1) for each in options if "=" in each)
    assert prepare(scene, values | {"seed": options[-1]}).settings == prepared.settings


@pytest.mark.parametrize(
    ("scene", "names"), [("temperature", ["thermometer", "barometer"]), ("elastic-collisions", [])]
)
def test_discs_of_a_table_have_no_thermometer(scene, names):
    plan, _, _ = lab_plan(prepare(scene, {}))
    assert [each["name"] for each in plan["gauges"]] == names

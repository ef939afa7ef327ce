"""The plan of a page: the command that it saves starts exactly the same run."""

import json
import re
import shlex

import numpy as np
import pytest

from atmosbox import scenarios
from atmosbox.lab.box import lab_box
from atmosbox.lab.memory_image import parts
from atmosbox.lab.page_file import lab_text, served_start
from atmosbox.lab.plan import lab_plan
from atmosbox.lab.start_plan import is_drawn, start_of
from atmosbox.lab.theory_table import short_run, tables
from atmosbox.lab.wasm_module import SCENES, module_bytes
from atmosbox.page.lesson import lesson_of
from atmosbox.scene.instruments import MOMENTS
from atmosbox.simulation.preparation import build, prepare
from atmosbox.simulation.recording import Recording
from atmosbox.simulation.runner import execute


@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        ("temperature", {}),
        ("temperature", {"molecules": 50, "temperature": "300 K", "start": "equal", "seed": 7}),
        ("lifting-dry", {"molecules": 200, "temperature": 10.0, "ascent": 12.5}),
        ("atmosphere", {"molecules": 5500, "start": "equilibrium"}),
    ],
)
def test_the_command_that_is_saved_begins_the_same_run(scene, settings):
    prepared = prepare(scene, settings, engine="exact")
    plan, _, _ = lab_plan(prepared)
    program, verb, named, *options = shlex.split(plan["command"])
    assert (program, verb, named) == ("atmosbox", "run", scene)
    assert options[-2:] == ["--seed", str(prepared.settings.seed)]
    values = dict(each.split("=", 1) for each in options if "=" in each)
    engine = options[options.index("--engine") + 1] if "--engine" in options else None
    begun = prepare(scene, values | {"seed": options[-1]}, engine=engine)
    assert (begun.settings, begun.engine) == (prepared.settings, prepared.engine)


def test_the_same_scene_gives_the_same_memory_wherever_python_keeps_its_arrays():
    prepared, kept, images = prepare("elastic-collisions", {}), [], []
    for number in range(4):
        images.append(lab_plan(prepared)[1])
        kept.append(np.zeros(37 + 101 * number))  # so that the next arrays lie elsewhere
    assert all(image == images[0] for image in images)


def test_every_preset_has_a_box_that_the_page_can_run():
    for scene, usual in SCENES.items():
        for preset in lesson_of(scenarios.load(scene)).presets:
            prepared = prepare(scene, usual | preset.values, engine="exact")
            assert module_bytes(lab_box(prepared).module, scene)


def told_without_molecules(setup):
    """Return what the page is told of a box besides its molecules."""
    gas = setup.parcel.arrays().gas
    box = gas.kinds.table, gas.box._replace(stall=0.0), gas.walls._replace(piston=0)
    told = parts((*box, start_of(setup.parcel, 0), setup.duration), "")
    return [value.tobytes() if isinstance(value, np.ndarray) else value for _, value, _ in told]


@pytest.mark.parametrize("scene", SCENES)
def test_the_seed_of_a_declared_start_decides_nothing_but_the_molecules(scene):
    first, second = (build(prepare(scene, SCENES[scene] | {"seed": seed}, engine="exact")) for seed in (1, 2))
    assert is_drawn(first.parcel) == (scene not in ("elastic-collisions", "convection"))
    if is_drawn(first.parcel):
        assert told_without_molecules(first) == told_without_molecules(second)


@pytest.mark.nightly
@pytest.mark.parametrize("scene", ["diffusion", "evaporation", "lifting-dry", "lifting-moist", "lifting-sounding"])
def test_a_page_of_as_many_molecules_as_a_run_has_is_no_larger_than_promised(scene):
    assert len(lab_text(prepare(scene, {}, engine="exact"), others=False).encode()) < 1_500_000


@pytest.mark.nightly
def test_the_page_of_convection_has_room_for_its_presets():
    text = lab_text(prepare("convection", {}, engine="exact"))
    offered = [key for key, *_ in json.loads(re.search(r'id="starts">(.*?)</script>', text)[1])]
    assert [key.partition(":")[0] for key in offered[1:]] == ["Inversion", "Land and sea", "Mixed air at the start"]
    assert len(text.encode()) < 1_500_000


def test_theory_that_changes_with_time_goes_on_as_theory_does():
    prepared = prepare("diffusion", {"molecules": 1000})
    plan, _, _ = lab_plan(prepared)
    course, rest = plan["tables"]
    assert course["along"] == "elapsed_time"
    decay = np.array(course["curves"]["mixing_amplitude_theory"])
    time = np.array(course["grid"]) / course["grid"][plan["frames"] - 1] * prepared.settings.duration
    # as in the file of a run; the table has seven figures
    expected = execute(prepared).dataset.mixing_amplitude_theory
    np.testing.assert_allclose(decay[: plan["frames"]], expected, rtol=2e-6)
    # beyond it the slowest decay alone is left: equal times, equal ratios
    np.testing.assert_allclose(np.diff(np.log(decay[-20:])) / np.diff(time[-20:]), -1.0, atol=0.02)
    assert time[-1] == pytest.approx(20.0 * prepared.settings.duration)
    assert {f"left_gas_share_{name}_theory" for name in MOMENTS} <= set(rest["curves"])


def test_theory_of_a_column_follows_the_temperature_of_its_floor_and_gravity():
    prepared = prepare("atmosphere", {"molecules": 3000}, engine="exact")
    begun = short_run(prepared)
    (table,) = tables(prepared, build(prepared), begun)
    for kelvin, gravity in ((150.0, 1.7), (105.0, 19.0)):
        here = begun.assign(wall_temperature=begun.wall_temperature * 0.0 + kelvin)
        here["gravity"] = "elapsed_time", np.full(here.sizes["elapsed_time"], gravity)
        for name, expected in prepared.module.theory(here, prepared.settings).items():
            layers = np.array(table["curves"][name]).T
            found = [np.interp(kelvin / gravity, table["grid"], layer) for layer in layers]
            found = np.array(found) * (gravity if name in table["times"] else 1.0)
            np.testing.assert_allclose(found, expected, atol=5e-4 * expected.max(), err_msg=name)


def is_done(task, found):
    """Return whether a task is done in a run, as the page judges it: in both halves of some frames."""
    number, near = task["frames"], True
    for goal in task["reach"]:
        values = np.lib.stride_tricks.sliding_window_view(found[goal["name"]].values, number)
        halves = np.split(values, [number // 2], axis=1) if number > 1 else [values]
        near &= np.all([np.abs(half.mean(axis=1) - goal["target"]) <= goal["within"] for half in halves], axis=0)
    return bool(near.any())


DRAWN = {
    "temperature": ("elapsed_time", 1.0),
    "temperature-large": ("elapsed_time", 1.0),
    "diffusion": ("elapsed_time", 4.862158),
    "atmosphere": ("height", 25.0),
    "lifting-dry": ("parcel_height", 9.0758),
    "convection": ("height", 13.5),
    "evaporation": ("elapsed_time", 2.0),
    "condensation": ("elapsed_time", 5.0),
    "lifting-moist": ("parcel_pressure", 300.0),
    "lifting-sounding": ("parcel_pressure", 150.0),
    "mountains": ("elapsed_time", 7.271811),
}
"""What a class draws its prediction along, and the last value of it in the unit of the graph."""


def test_the_scenes_with_a_prediction_to_draw():
    assert list(DRAWN) == [n for n in scenarios.names() if "draw" in lesson_of(scenarios.load(n)).predict]


@pytest.mark.parametrize(
    "scene",
    [pytest.param(name, marks=() if name in ("temperature", "lifting-dry") else pytest.mark.nightly) for name in DRAWN],
)
def test_what_a_class_may_draw_is_on_a_graph_of_the_scene(scene):
    told = lab_plan(prepare(scene, SCENES[scene], engine="exact"))[0]["told"]
    drawn = told["lesson"]["predict"]["draw"]
    assert (drawn["along"]["name"], drawn["along"]["places"][-1]) == (DRAWN[scene][0], pytest.approx(DRAWN[scene][1]))
    panel = told["stage"]["panels"][drawn["graph"]]
    lines = [each["x" if panel["across"] else "y"]["name"] for each in panel["lines"]]
    assert drawn["measured"]["name"] in lines
    assert drawn["measured"]["range"][0] < drawn["measured"]["range"][1]


EACH = [pytest.param(name, 20, marks=pytest.mark.nightly) for name in scenarios.names()]


@pytest.mark.parametrize(("scene", "seeds"), [("temperature", 5), ("elastic-collisions", 5), *EACH])
def test_no_task_is_done_by_waiting(scene, seeds):
    task = lab_plan(prepare(scene, SCENES[scene], engine="exact"))[0]["told"]["lesson"]["task"]
    for seed in range(1, seeds + 1):
        prepared = prepare(scene, SCENES[scene] | {"seed": seed}, engine="exact")
        setup = build(prepared)
        recording = Recording(prepared, setup, {})
        while recording.frames < min(setup.frames, 400):
            recording.advance(lambda passed: None)
        assert not is_done(task, recording.dataset("lab", settle=0, judged=False)[0]), seed


OWN = """
from atmosbox.scene.engines import EXACT
from atmosbox.scene.instruments import Air
from atmosbox.scene.knob import Knob
from atmosbox.scene.panels import Line, Panel
from atmosbox.scene.settings import SceneSettings, setting
from atmosbox.scene.setup import Setup
from atmosbox.scene.units import Scale


class Settings(SceneSettings):
    speed: float = setting(1.0, "1", "speed at the start", low=0.1, high=5.0)


def build(settings, engine=EXACT):
    parcel = engine.make([[1, 1, 1], [3, 1, 1]], [[settings.speed, 0, 0], [0, 0, 0]], length=(4, 2, 2))
    knob = Knob("temperature", "of one wall", "K", 1.0, 9.0, 5.0, print)
    return Setup(parcel, Scale(1.0, 1.0, 1.0), 10.0, 10, (Air(),), knobs=(knob,))


def theory(dataset, settings):
    return {}


def headlines(dataset, settings):
    return ()


panels = (Panel("line", "Warmth", (Line("elapsed_time", "air_temperature", "air"),)),)
"""


def test_a_scene_of_ones_own_has_its_settings_in_the_page_and_no_knob_that_is_a_function_in_python(tmp_path):
    (tmp_path / "mine.py").write_text(OWN, encoding="utf-8")
    mine = prepare(tmp_path / "mine.py", {"speed": 2.0})
    start, module = served_start(mine, mine)
    assert module == "contacts-rows"
    assert start.plan["knobs"] == {}
    assert [(each["name"], each["value"]) for each in start.plan["told"]["controls"]] == [("speed", 2.0), ("seed", 1)]

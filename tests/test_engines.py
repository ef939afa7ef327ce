"""The list of engines: which engines and options are accepted, and which are refused."""

import json
import warnings

import pytest

import atmosbox
from atmosbox.engine import CoarseStepWarning
from atmosbox.engine.core.account import GIVEN, STORES
from atmosbox.errors import SettingError, UnknownSettingError
from atmosbox.scene.engines import FEW, choose, used
from atmosbox.simulation import runner
from atmosbox.simulation.preparation import build
from atmosbox.simulation.recording import Recording


def test_a_choice_is_spelled_as_it_is_read_and_presets_by_their_names():
    for text in (
        "exact",
        "exact:collisions=off",
        "stepped:delta=0.02,motion=euler",
        "stepped:applet",
        "stepped:applet-discs,delta=0.1",
        "dsmc:dt=0.5,threads=2",
    ):
        assert str(choose(text)) == text
        assert choose(choose(text)) == choose(text)


def test_what_is_no_engine_or_option_is_refused_with_what_to_type():
    cases = [
        ("exakt", "exact"), ("classic", "stepped:applet"), ("classic:delta=0.2", "stepped:applet"), ("", "exact"),
        ("stepped:", "stepped"), ("stepped:delta", "stepped:delta=value"), ("stepped:delta=soon", "stepped:delta="),
        ("stepped:delta=-1", "stepped:delta="), ("stepped:delta=0.1,delta=0.2", 'stepped:delta" once'),
        ("stepped:motion=eule", "stepped:motion=euler"), ("dsmc:threads=0", "dsmc:threads=1"),
    ]  # fmt: skip
    for text, fix in cases:
        with pytest.raises(SettingError, match=f'give engine="{fix}'):
            choose(text)
    changed = choose("stepped:applet,smooth_walls=clamp")
    assert str(changed) == "stepped:rule=index-order,motion=euler,smooth_walls=clamp"
    with pytest.raises(UnknownSettingError, match='give engine="stepped:delta=1"'):
        choose("stepped:delt=1")
    with pytest.raises(UnknownSettingError, match="give one of collisions"):
        choose("exact:delta=1")


def test_a_file_knows_its_engine_also_one_of_an_earlier_version():
    made = atmosbox.run("elastic-collisions", duration="1 s", engine="stepped:applet,delta=0.005")
    assert str(used(made)) == "stepped:applet,delta=0.005"
    assert used(made).ideal is False
    assert choose("dsmc").ideal is True
    for earlier, ideal in (("classic:scheme=strips", False), ("stepped:threads=2,collisions=off", True)):
        old = made.assign_attrs(atmosbox_parameters=json.dumps({"engine": earlier}))
        assert (used(old).name, used(old).ideal) == ("stepped", ideal)
    with pytest.raises(SettingError, match="engine = exakt"):
        used(made.assign_attrs(atmosbox_parameters=json.dumps({"engine": "exakt"})))


@pytest.mark.parametrize("scene", ["atmosphere", "evaporation", "lifting-moist", "lifting-sounding", "mountains"])
def test_many_molecules_of_a_thin_gas_run_on_dsmc_and_few_on_the_exact_engine(scene):
    as_it_comes, many, few = (
        runner.prepare(scene, given) for given in ({}, {"molecules": FEW + 1}, {"molecules": FEW})
    )
    assert [each.engine.name for each in (as_it_comes, many, few)] == ["dsmc", "dsmc", "exact"]
    assert {each.unusual_engine for each in (as_it_comes, many, few)} == {""}
    asked = runner.prepare(scene, {}, engine="exact")
    assert (str(asked.engine), asked.unusual_engine) == ("exact", "exact")


MOVES, SPINS, FALLS, LIQUID = STORES
WALLS, PISTON, _, SCHEME, BATH, ATTRACTION = GIVEN
SMALL = {"molecules": 200}
DRY = {"molecules": 200, "ascent": 50}
LIFTED = {"molecules": 300, "ascent": 20}
HILLS = {"molecules": 300, "travel": 20}
CLUMP = {"molecules": 200, "start": "drop", "density": 0.15, "duration": "0.4 ns"}
PARTS = [
    ("temperature", "", {}, {}, {MOVES, WALLS}),
    ("temperature-large", "", SMALL, {}, {MOVES, WALLS}),
    ("elastic-collisions", "", {}, {}, {MOVES}),
    ("diffusion", "", {"molecules": 300}, {}, {MOVES}),
    ("atmosphere", "exact", SMALL, {"temperature": 400.0}, {MOVES, FALLS, WALLS}),
    ("atmosphere", "exact", SMALL | {"plane": True}, {}, {MOVES, FALLS, WALLS}),
    ("atmosphere", "exact", SMALL | {"start": "bottom", "floor": "isolated"}, {}, {MOVES, FALLS}),
    ("atmosphere", "stepped:delta=0.8,motion=euler", SMALL, {}, {MOVES, FALLS, WALLS, SCHEME}),
    ("atmosphere", "dsmc", SMALL | {"rotation": True}, {}, {MOVES, SPINS, FALLS, WALLS}),
    ("attraction", "", CLUMP, {"attraction": 0.5}, {MOVES, FALLS, BATH, ATTRACTION}),
    ("attraction", "", CLUMP | {"start": "pool", "bath": "none", "air": 0.1}, {}, {MOVES, FALLS}),
    ("attraction", "", CLUMP | {"bath": "walls"}, {}, {MOVES, FALLS, WALLS}),
    ("attraction", "", {"molecules": 200, "heating": 100, "duration": "0.4 ns"}, {}, {MOVES, FALLS, BATH}),
    ("condensation", "", {"molecules": 300}, {}, {MOVES, SPINS, LIQUID, WALLS}),
    ("nuclei", "", {"molecules": 300}, {}, {MOVES, SPINS, LIQUID, WALLS}),
    ("convection", "", {"molecules": 300, "duration": 60}, {"floor_temperature": 400.0}, {MOVES, FALLS, WALLS}),
    ("evaporation", "", {"molecules": 300, "pool": 60}, {}, {MOVES, SPINS, LIQUID, PISTON}),
    ("lifting-dry", "", DRY, {}, {MOVES, SPINS, PISTON}),
    ("lifting-dry", "stepped:delta=0.8", DRY, {}, {MOVES, SPINS, PISTON}),
    ("lifting-moist", "", LIFTED, {}, {MOVES, SPINS, LIQUID, PISTON}),
    ("lifting-moist", "dsmc", LIFTED | {"rain": True}, {}, {MOVES, SPINS, LIQUID, PISTON}),
    ("lifting-sounding", "", LIFTED, {}, {MOVES, SPINS, LIQUID, PISTON}),
    ("mountains", "", HILLS, {}, {MOVES, SPINS, LIQUID, PISTON}),
]


@pytest.mark.parametrize(("scene", "engine", "settings", "turned", "terms"), PARTS)
def test_energy_minus_heat_and_work_is_constant_in_every_scene_with_every_switch(
    scene, engine, settings, turned, terms
):
    prepared = runner.prepare(scene, settings, engine=engine or None)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", CoarseStepWarning)
        recording = Recording(prepared, build(prepared), {})
        for frame in range(4):
            if frame == 2:
                for knob in recording.setup.knobs:
                    if knob.name in turned:
                        knob.set(turned[knob.name])
            recording.advance(lambda now: None)
    made = recording.dataset("complete", judged=False)[0]
    assert {name for name in (*STORES, *GIVEN) if name in made and made[name].values.any()} == terms
    for check in runner.verify(made):
        assert check.passed, check.sentence


def test_a_term_that_is_left_out_of_the_budget_is_found():
    prepared = runner.prepare("attraction", CLUMP)
    recording = Recording(prepared, build(prepared), {})
    for _ in range(4):
        recording.advance(lambda now: None)
    made = recording.dataset("complete", judged=False)[0].drop_vars("heat_from_bath")
    failed = [check for check in runner.verify(made) if not check.passed]
    assert [check.name for check in failed] == ["balance"]
    assert "is not constant" in failed[0].sentence


def test_a_file_of_an_engine_names_its_source_and_the_energy_of_its_scheme():
    for engine, source in (("dsmc", True), ("exact", False)):
        made = atmosbox.run("atmosphere", engine=engine, molecules=300, duration=5)
        assert "numerical_heat" not in made
        assert ("10.1063/1.869674" in made.attrs.get("references", "")) == source

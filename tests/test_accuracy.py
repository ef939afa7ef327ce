"""Expected accuracy: what a user asks for, what is picked, what the report says, and whether the table is right."""

import importlib.util
import itertools
import json
import math
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from hypothesis import example, given
from hypothesis import strategies as st
from scipy import stats
from typer.testing import CliRunner

import atmosbox
from atmosbox import scenarios
from atmosbox.cli import app
from atmosbox.cli.expectation import expectation_lines
from atmosbox.errors import Option, SettingError
from atmosbox.file import netcdf as output
from atmosbox.file import provenance
from atmosbox.scene import engines
from atmosbox.scene.headline import AS_STATED, ENGINE_IS_OFF, Headline
from atmosbox.simulation import accuracy, runner
from atmosbox.simulation.accuracy import TARGETS, ExpectedError, Measured, Table, Target, choose, expect, parse
from atmosbox.simulation.accuracy import cheapest as cheapest_of
from atmosbox.text.report import headline_lines
from atmosbox.trade import timed_run

ROOT = Path(__file__).resolve().parents[1]


def way(engine="exact", cost=1.0, kelvin=0.1, share=0.001, bias=0.0, **settings):
    """Return a way of running a scene at 200 K, whose only error is noise but for a bias of its temperature [K]."""
    errors = {
        "mean_temperature": ExpectedError("K", bias, 0.0, kelvin, 200.0),
        "mean_pressure": ExpectedError("1", 0.0, 0.0, share, 1e5),
    }
    return Measured(engine, settings, cost, 8, errors)


UNITS = ("", "K", " K", "%", " %", "degC", "apples", " a b")
LABELS = {"mean_temperature": "temperature", "mean_pressure": "pressure"}
TABLES = {
    "temperature": Table(
        ("duration", "molecules"),
        LABELS,
        (
            way(),
            way(cost=0.5, kelvin=0.4, share=0.004, duration=10.0),
            way(cost=0.1, kelvin=2.0, share=0.02, duration=1.0),
            way("stepped:applet,delta=0.01", 0.05, kelvin=0.5, bias=2.5, duration=1.0),
            way(cost=0.01, kelvin=0.01, share=0.0001, start="equal"),
            Measured("exact", {"molecules": 2}, 0.001, 8, {}),
        ),
    )
}


@pytest.fixture
def hand_made(monkeypatch):
    """Replace the table that comes with atmosbox by a hand-made one."""
    monkeypatch.setattr(cheapest_of, "load", lambda: TABLES)


def command(*words):
    return CliRunner().invoke(app, list(words), env={"COLUMNS": None})


# What is asked for


def test_a_wish_is_a_target_or_the_largest_error():
    cases = [
        ("sketch", TARGETS["sketch"]),
        (" Lecture ", TARGETS["lecture"]),
        ("0.5K", Target("0.5K", kelvin=0.5)),
        ("0.5 K", Target("0.5K", kelvin=0.5)),
        (".5k", Target(".5K", kelvin=0.5)),
        ("2e-1K", Target("2e-1K", kelvin=0.2)),
        ("2%", Target("2%", share=0.02, absolute=True)),
        ("2 %", Target("2%", share=0.02, absolute=True)),
        ("100%", Target("100%", share=1.0, absolute=True)),
    ]
    for text, target in cases:
        assert parse(text) == target


def test_what_is_no_wish_is_refused_with_what_to_type():
    cases = [
        ("3 apples", "accuracy = 3 apples has an unknown unit", 'give accuracy="3K" or accuracy="3%".'),
        ("3", "accuracy = 3 has no unit", 'give accuracy="3K" or accuracy="3%".'),
        ("lectur", "is neither one of sketch, lecture, reference nor an error", 'give accuracy="lecture".'),
        ("very good", "is neither one of", 'give accuracy="lecture", or an error such as 0.5K or 2%.'),
        ("-1K", "accuracy = -1K is neither", "such as 0.5K"),
        ("0K", "is not an error above 0 and of at most 1000 K", "such as 0.5K"),
        ("101%", "of at most 100 %", "or 2%."),
        ("25degC", "is a temperature and not the error of one", 'give accuracy="25K".'),
        ("0,5K", "is written with a comma", 'give accuracy="0.5K".'),
        (0.5, "accuracy = 0.5 is not a text", 'give accuracy="lecture"'),
    ]
    for text, problem, fix in cases:
        with pytest.raises(SettingError) as caught:
            parse(text)
        assert problem in str(caught.value)
        assert fix in str(caught.value)


@given(st.text(max_size=30) | st.builds("{}{}".format, st.floats() | st.integers(), st.sampled_from(UNITS)))
@example("1e999")
@example("9999degC")
@example("0,5apples")
@example("0")
def test_any_wish_is_read_or_refused_in_a_sentence_that_tells_what_is_read(text):
    refusal = None
    try:
        assert parse(parse(text).text) == parse(text)
    except SettingError as error:
        refusal = error
    assert str(refusal).isprintable()
    if refusal is not None:
        told = [part.value for part in refusal.remedy if isinstance(part, Option)]
        assert told
        assert all(map(parse, told))


def test_the_targets_are_in_order():
    sketch, lecture, reference = (TARGETS[name] for name in ("sketch", "lecture", "reference"))
    assert sketch.kelvin > lecture.kelvin
    assert sketch.share > lecture.share
    assert reference.best


# What is picked


def test_the_error_of_a_run_is_that_of_bias_noise_and_what_is_not_known_of_the_bias():
    assert ExpectedError("K", -2.0, 1.0, 2.0, 300.0).total == 3.0


def test_the_cheapest_way_within_the_wish_is_picked():
    cases = [
        ("3K", "stepped:applet,delta=0.01", {"duration": 1.0}),
        ("2.5K", "exact", {"duration": 1.0}),  # the bias counts: sqrt(2.5² + 0.5²) K is more
        ("1.9K", "exact", {"duration": 10.0}),
        ("0.1K", "exact", {}),
        ("2%", "stepped:applet,delta=0.01", {"duration": 1.0}),
        ("1%", "exact", {"duration": 10.0}),  # 2 K are 1 % of 200 K, and the pressure is off by 2 %
        ("sketch", "stepped:applet,delta=0.01", {"duration": 1.0}),
        ("lecture", "exact", {"duration": 10.0}),
        ("reference", "exact", {}),
    ]
    for target, engine, settings in cases:
        picked = choose("temperature", target, tables=TABLES)
        assert (picked.way.engine, picked.way.settings, picked.met) == (engine, settings, True)


def test_a_share_holds_for_temperatures_too():
    off = {"temperature": Table((), LABELS, (way(kelvin=5.0), way(cost=2.0, kelvin=3.0)))}
    assert choose("temperature", "2%", tables=off).way.cost == 2.0


def test_another_experiment_is_not_picked_for_its_accuracy_but_when_it_is_asked_for():
    assert "start" not in choose("temperature", "reference", tables=TABLES).way.settings
    other = choose("temperature", "reference", {"start": "equal", "pressure": 500.0}, TABLES)
    assert other.way.settings == {"start": "equal"}
    with pytest.raises(SettingError, match="with these settings, at which nothing was measured"):
        choose("temperature", "sketch", {"start": "unequal"}, TABLES)


def test_of_other_experiments_the_nearest_is_taken_and_what_it_does_not_vary_is_not_set():
    plane = way(cost=0.1, plane=True, knudsen=0.05, duration=100.0)
    tables = {"atmosphere": Table(("duration",), LABELS, (way(), plane))}
    flat = choose("atmosphere", "sketch", {"plane": True}, tables)
    assert (flat.way, flat.sets) == (plane, {"duration": 100.0})
    assert flat.at({"plane": True, "duration": 100.0}).differs == ("knudsen",)
    assert choose("atmosphere", "sketch", {"knudsen": 0.05}, tables).way == way()
    assert choose("atmosphere", "sketch", {"knudsen": 0.2}, tables).sets == {}


def test_a_way_that_does_not_come_to_every_headline_is_not_picked():
    assert choose("temperature", "100%", tables=TABLES).way.settings != {"molecules": 2}


def test_a_number_that_nothing_reaches_is_refused_with_the_best_and_its_cost():
    with pytest.raises(SettingError) as caught:
        choose("temperature", "0.01K", tables=TABLES)
    assert str(caught.value) == (
        "accuracy = 0.01K is more than any measured run of temperature reaches: the best, exact, comes to 0.1 K at "
        'the cost of the default run: give accuracy="0.1K", or reference.'
    )
    with pytest.raises(SettingError, match=r'comes to 0\.1 % at .* give accuracy="0\.1%"'):
        choose("temperature", "0.01%", tables=TABLES)


def test_what_a_refusal_tells_to_type_is_granted():
    for kelvin in [0.0951, 0.123456, 1.0, 9.99]:
        table = {"temperature": Table((), LABELS, (way(kelvin=kelvin),))}
        with pytest.raises(SettingError) as caught:
            choose("temperature", "0.01K", tables=table)
        asked = caught.value.remedy[0].value
        assert choose("temperature", asked, tables=table).met


def test_a_target_that_nothing_reaches_is_answered_with_the_best():
    coarse = {"temperature": Table((), LABELS, (way(kelvin=9.0), way(kelvin=5.0, cost=3.0)))}
    picked = choose("temperature", "sketch", tables=coarse)
    assert (picked.way.cost, picked.met) == (3.0, False)
    assert "Nothing that was measured is within 5 % and 3 K" in " ".join(expectation_lines(picked, (), "exact", 80))


def test_a_scene_that_was_not_measured_and_a_bare_number_are_refused():
    with pytest.raises(SettingError, match="is not a text"):
        choose("temperature", 0.5, tables=TABLES)
    with pytest.raises(SettingError, match="not for lifting-dry, whose errors were not measured: leave it out, or"):
        choose("lifting-dry", "sketch", tables=TABLES)


def test_kelvins_are_not_asked_of_a_scene_without_temperatures():
    pressure = {"mean_pressure": ExpectedError("1", 0.0, 0.0, 0.1, 1e5)}
    table = {"temperature": Table((), {"mean_pressure": "pressure"}, (Measured("exact", {}, 1.0, 4, pressure),))}
    with pytest.raises(SettingError, match="says nothing of temperature, which has no temperature"):
        choose("temperature", "1K", tables=table)


def test_an_engine_given_by_hand_is_looked_up_at_its_own_settings_alone():
    found = expect("temperature", "stepped:applet,delta=0.01", {"duration": 1.0, "seed": 7}, TABLES)
    assert found.way is TABLES["temperature"].ways[3]
    assert expect("temperature", "stepped:applet,delta=0.01", {}, TABLES) is None
    assert expect("temperature", "stepped:applet,delta=0.02", {"duration": 1.0}, TABLES) is None
    assert expect("lifting-dry", "stepped:applet,delta=0.01", {}, TABLES) is None


# What is run and what the report says


def test_a_pick_sets_what_the_user_has_not_set(hand_made):
    prepared = runner.prepare("temperature", {"seed": 3}, accuracy="lecture")
    assert prepared.settings.changed() == {"duration": 10.0, "seed": 3}
    assert prepared.expectation.differs == ()
    prepared = runner.prepare("temperature", {"duration": "2 ns", "start-temperature": 0.0}, accuracy="lecture")
    assert prepared.settings.changed() == {"duration": 2.0, "start_temperature": 0.0}
    assert prepared.expectation.differs == ("duration", "start_temperature")


def test_the_default_run_promises_nothing_that_was_not_asked_for():
    prepared = runner.prepare("temperature", {})
    assert prepared.expectation is None
    assert "accuracy" not in prepared.parameters


def test_an_accuracy_and_an_engine_exclude_each_other(tmp_path):
    for engine in ("exact", "stepped:applet"):
        with pytest.raises(SettingError, match=f"picks the engine itself: leave it out, or the engine {engine}"):
            runner.prepare("temperature", {}, accuracy="sketch", engine=engine)
    result = command("run", "temperature", "--accuracy", "sketch", "--engine", "stepped:applet", "--dry-run")
    assert (result.exit_code, result.stdout) == (2, "")
    assert "picks the engine itself" in result.stderr


def test_an_accuracy_and_an_earlier_run_exclude_each_other(tmp_path):
    made = {"scene": "temperature", "settings": {}, "version": atmosbox.__version__}
    earlier = xr.Dataset(attrs=provenance.global_attributes(made, title="A box", command="a test"))
    file = output.write(earlier, tmp_path / "short.nc")
    result = command("run", "--from", str(file), "--accuracy", "sketch", "--dry-run")
    assert result.exit_code == 2
    assert "leave one of them out" in result.stderr


@pytest.mark.parametrize("target", ["sketch", "reference"])
def test_a_run_is_made_as_it_was_picked_and_says_what_it_expected_and_found(tmp_path, hand_made, target):
    file = tmp_path / "warm.nc"
    fast = ("--set", "molecules=20", "--set", "duration=2ns")
    words = ("run", "temperature", "--accuracy", target, *fast, "--out", str(file))
    planned = command(*words, "--dry-run")
    assert f"accuracy {target} (" in planned.stdout
    assert not file.exists()
    result = command(*words, "--json")
    assert result.exit_code == 0, result.output
    made = json.loads(result.stdout)
    picked = choose("temperature", target, tables=TABLES)
    told = made["accuracy"]
    assert (told["wish"], told["engine"], made["engine"]) == (target, picked.way.engine, picked.way.engine)
    assert set(told["differs"]) == {"duration", "molecules"}
    temperature = told["errors"]["mean_temperature"]
    assert temperature["total"] == picked.way.errors["mean_temperature"].total
    (headline,) = (one for one in made["headlines"] if one["name"] == "mean_temperature")
    assert temperature["found"] == pytest.approx(headline["difference"])
    (headline,) = (one for one in made["headlines"] if one["name"] == "mean_pressure")
    assert told["errors"]["mean_pressure"]["found"] == pytest.approx(headline["difference"] / headline["theory"])

    kept = provenance.parameters(output.read(file))
    assert kept["engine"] == picked.way.engine
    assert kept["accuracy"]["wish"] == target
    assert kept["accuracy"]["errors"]["mean_temperature"]["noise"] == temperature["noise"]


def test_a_run_says_what_it_expected_and_found_in_its_table(tmp_path, hand_made):
    words = ("--accuracy", "0.1K", "--set", "molecules=20", "--set", "duration=2ns", "--out", str(tmp_path / "warm.nc"))
    shown = " ".join(command("run", "temperature", *words).stdout.split())
    assert "accuracy 0.1K: exact, at the cost of the default run; its errors were measured in 8 runs" in shown
    assert "expected of a single run error bias noise found temperature 0.1 K" in shown
    assert "measured at other settings, with the default of duration, the default of molecules;" in shown


def test_an_accuracy_may_stand_in_a_settings_file_and_in_python(tmp_path, hand_made):
    file = tmp_path / "warm.toml"
    file.write_text('scene = "temperature"\naccuracy = "sketch"\n[settings]\nmolecules = 20\n', encoding="utf-8")
    planned = json.loads(command("run", "--config", str(file), "--dry-run", "--json").stdout)
    assert (planned["engine"], planned["accuracy"]["wish"]) == ("stepped:applet,delta=0.01", "sketch")
    over = json.loads(command("run", "--config", str(file), "--accuracy", "0.1K", "--dry-run", "--json").stdout)
    assert (over["engine"], over["accuracy"]["wish"]) == ("exact", "0.1K")
    dataset = atmosbox.run("temperature", accuracy="lecture", molecules=20, duration="1 ns")
    assert provenance.parameters(dataset)["accuracy"]["wish"] == "lecture"
    assert "accuracy='lecture'" in dataset.history


def test_an_approximate_engine_without_a_measurement_says_so_and_the_exact_one_need_not():
    prepared = runner.prepare("temperature", {"molecules": 3}, engine="stepped:applet")
    (line,) = expectation_lines(prepared.expectation, (), str(prepared.engine), 200)
    assert line.startswith("no error was measured for the engine stepped:applet at these settings")
    assert expectation_lines(None, (), "", 80) == []


def test_the_expected_errors_are_shown_whole_at_every_width():
    for width in [20, 40, 80, 200]:
        picked = choose("temperature", "sketch", tables=TABLES)
        warm = Headline("mean_temperature", 202.25, 0.3, 200.0, 0.0, "", "K", "degC", "temperature")
        words = " ".join(" ".join(expectation_lines(picked, (warm,), "stepped:applet,delta=0.01", width)).split())
        for value in ("stepped:applet,delta=0.01, duration=1", "2.5 K", "+2.5 K ± 0 K", "0.5 K", "+2.2 K", "0.1 %"):
            assert value in words


# A bias that is known


def headline(value, **known):
    return Headline("t", value, 0.1, 300.0, 0.2, "the box is small", "K", "K", "temperature", **known)


def test_a_known_bias_excuses_a_misfit_to_its_side_alone():
    cases = [
        (300.59, {}, True),
        (300.7, {}, False),
        (302.5, {"bias": 2.0}, True),
        (302.7, {"bias": 2.0}, False),
        (302.7, {"bias": 2.0, "bias_se": 0.1}, True),
        (299.3, {"bias": 2.0}, False),
        (299.3, {"bias": -2.0}, True),
        (300.0, {"bias": 2.0}, True),
        (math.nan, {"bias": 2.0}, False),
    ]
    for value, known, agrees in cases:
        assert headline(value, **known).agrees is agrees


def test_a_misfit_that_only_a_known_bias_excuses_is_told():
    lines = headline_lines([headline(302.5, bias=2.0)], 200)
    assert lines[1].endswith("yes, with the stated model error")
    assert " ".join(lines[2:]) == (
        "expected within: 4 standard errors (chance) plus 2.2 K, because the box is small, and "
        "the measured error of this engine is that large."
    )
    assert headline_lines([headline(300.3, bias=2.0)], 200)[1].endswith("yes")


def test_the_bias_of_an_approximate_engine_is_counted_in_the_run_and_when_its_file_is_read(tmp_path, monkeypatch):
    settings = {"molecules": 20, "duration": 1.0}
    errors = {"mean_temperature": ExpectedError("K", -3.0, 0.5, 5.0, 298.15)}
    errors["mean_pressure"] = ExpectedError("1", 0.01, 0.002, 0.05, 1e5)
    known = Measured("stepped:applet,delta=0.01", settings, 0.1, 8, errors)
    tables = {"temperature": Table(("duration", "molecules"), LABELS, (known,))}
    monkeypatch.setattr(cheapest_of, "load", lambda: tables)
    outcome = runner.execute(runner.prepare("temperature", settings, engine="stepped:applet,delta=0.01"))
    found = {one.name: one for one in outcome.headlines}
    assert (found["mean_temperature"].bias, found["mean_temperature"].bias_se) == (-3.0, 0.5)
    assert found["mean_pressure"].bias == pytest.approx(0.01 * found["mean_pressure"].theory)
    assert found["mean_speed"].bias == 0.0
    cold = outcome.dataset
    cold["mean_temperature"] = cold.mean_temperature.copy(data=cold.mean_temperature_theory.item() - 43.0)
    cold["mean_temperature_se"] = cold.mean_temperature_se.copy(data=10.0)
    again = output.read(output.write(cold, tmp_path / "steps.nc"))
    warm = next(one for one in runner.headlines_of(again) if one.name == "mean_temperature")
    assert (warm.bias, warm.verdict, warm.excuse) == (-3.0, AS_STATED, ENGINE_IS_OFF)
    (said,) = (one for one in runner.verify(again) if one.name == "mean_temperature")
    assert said.passed
    assert said.sentence.endswith(ENGINE_IS_OFF)
    other = runner.execute(
        runner.prepare("temperature", {**settings, "pressure": 900.0}, engine="stepped:applet,delta=0.01")
    )
    assert all(one.bias == 0.0 for one in other.headlines)


# The table that comes with atmosbox


def test_every_way_of_the_shipped_table_can_be_run_and_every_scene_has_its_default_run():
    held = accuracy.load()
    declared = {name for name in scenarios.names() if hasattr(scenarios.load(name), "ladder")}
    assert declared == set(scenarios.names()) >= set(held)
    not_measured = {"attraction", "convection", "diffusion", "nuclei"}
    assert declared - set(held) <= not_measured, "all others are measured"
    for scene, table in held.items():
        usual = str(runner.prepare(scene, {}).engine)
        assert [one.cost for one in table.ways if (one.engine, dict(one.settings)) == (usual, {})] == [1.0]
        for one in table.ways:
            prepared = runner.prepare(scene, one.settings, engine=one.engine)
            assert prepared.settings.changed() == one.settings
            assert str(engines.choose(one.engine)) == one.engine
            assert one.members >= 4
            assert one.cost > 0.0
            assert one.errors.keys() <= table.labels.keys()
            assert all(error.noise > 0.0 and error.bias_se > 0.0 for error in one.errors.values())


def test_every_target_has_a_pick_in_every_measured_scene():
    for scene, target in itertools.product(accuracy.load(), TARGETS):
        picked = choose(scene, target)
        assert picked.way.errors.keys() == picked.labels.keys()
        assert picked.met == (target == "reference" or picked.way.excess(TARGETS[target]) <= 1.0)


def hold(scene, held, members):
    """Hold a way of running a scene to a fresh measurement with other seeds.

    Both measurements estimate their noise from the scatter of the seeds, so the bias is judged by Student's
    distribution (Welch) and the noise by Fisher's, both at the odds of four standard errors: a table that is right
    is called wrong with a probability of 6e-5 for each bias and each noise.
    """
    way = timed_run.Way(held.engine, held.settings)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # coarse steps are what is measured here
        runs = [timed_run.run(scene, way, 100_000 + seed) for seed in range(members)]
    tail = stats.norm.sf(4.0)
    for name, known in held.errors.items():
        if name in timed_run.PROFILES:  # its bias is a root mean square along the curve, and its scatter is not normal
            continue
        errors = np.array([run.quantities[name].error[0] for run in runs])
        bias, noise = errors.mean(), errors.std(ddof=1)
        parts = np.array([known.bias_se**2, noise**2 / members])
        freedom = parts.sum() ** 2 / (parts**2 / np.array([held.members - 1, members - 1])).sum()
        limit = stats.t.isf(tail, freedom) * math.sqrt(parts.sum())
        assert abs(bias - known.bias) <= limit, (held.label, name, bias, known)
        freedoms = members - 1, held.members - 1
        low, high = stats.f.ppf(tail, *freedoms), stats.f.isf(tail, *freedoms)
        assert low <= (noise / known.noise) ** 2 <= high, (held.label, name, noise, known)


def cheapest(scene, name):
    """Return the cheapest way of an engine in the shipped table."""
    return min(
        (one for one in accuracy.load()[scene].ways if engines.choose(one.engine).name == name),
        key=lambda one: one.cost,
    )


@pytest.mark.parametrize(
    "name", sorted({engines.choose(way.engine).name for way in accuracy.load()["lifting-dry"].ways})
)
def test_the_shipped_table_is_what_a_fresh_measurement_finds(name):
    hold("lifting-dry", cheapest("lifting-dry", name), members=6)


@pytest.mark.validate
@pytest.mark.parametrize(
    ("scene", "held"),
    [
        pytest.param(scene, one, id=f"{scene}, {one.label}")
        for scene, table in accuracy.load().items()
        for one in table.ways
    ],
)
def test_every_way_of_the_shipped_table_is_what_a_fresh_measurement_finds(scene, held):
    hold(scene, held, members=8)


def test_the_tool_measures_a_scene_and_keeps_the_others(tmp_path):
    file = tmp_path / "accuracy.json"
    file.write_text('{"scenes": {"another": {}}}', encoding="utf-8")
    words = [str(ROOT / "docs" / "examples" / "my_scene.py"), "--budget", "60s", "--json", str(file)]
    tool = [sys.executable, str(ROOT / "benchmarks" / "accuracy.py")]
    done = subprocess.run([*tool, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "declares nothing to compare" in done.stderr
    assert list(json.loads(file.read_text())["scenes"]) == ["another"]


@pytest.fixture
def tool():
    """The tool as a module."""
    spec = importlib.util.spec_from_file_location("benchmarks_accuracy", ROOT / "benchmarks" / "accuracy.py")
    module = importlib.util.module_from_spec(spec)
    before = sys.path[:]
    spec.loader.exec_module(module)
    sys.path[:] = before
    return module


def test_the_tool_makes_a_table_of_ratios_of_what_can_be_relied_on(tmp_path, monkeypatch, tool, capsys):
    rungs = {  # seconds, members, escaped, ledger, why there are no more
        "exact, duration=2": (0.5, 9, 0, 1e-15, ""),
        "exact, duration=20": (2.0, 8, 0, 1e-15, ""),
        "exact, molecules=200, duration=2": (0.6, 5, 0, 1e-15, ""),
        "exact, molecules=3": (9.0, 3, 0, 1e-15, ""),
        "exact, molecules=4": (1.0, 4, 0, 1e-15, "left out: one run takes too much of the budget"),
        "exact, molecules=5": (1.0, 4, 1, 1e-15, ""),
        "exact, molecules=6": (1.0, 4, 0, 1e-5, ""),
        "exact, molecules=7": (1.0, 4, 0, 1e-15, "The run cannot go on."),
    }
    costs, members, escaped, ledger, why = map(list, zip(*rungs.values(), strict=True))
    each = ("rung", "quantity"), np.full((len(rungs), 3), 0.123456)
    settings = [dict(pair.split("=") for pair in label.split(", ")[1:]) for label in rungs]
    dataset = xr.Dataset(
        {
            **dict.fromkeys(("bias", "bias_se", "noise"), each),
            "engine_seconds": ("rung", costs),
            "members": ("rung", members),
            "escaped": ("rung", escaped),
            "ledger": ("rung", ledger),
            "left_out": ("rung", why),
            "engine": ("rung", ["exact"] * len(rungs)),
            "settings": ("rung", [json.dumps(one) for one in settings]),
        },
        coords={
            "rung": list(rungs),
            "quantity": ["mean_temperature", "mean_pressure", "layer_temperature"],
            "label": ("quantity", ["temperature", "pressure", "profile"]),
            "unit": ("quantity", ["K", "1", "K"]),
            "theory": ("quantity", [298.15, 1e5, 298.15]),
        },
        attrs=provenance.global_attributes(
            {"scene": "temperature", "tradeoff": {"budget": 60.0}}, title="A trade", command="a test --seed 1"
        ),
    )
    monkeypatch.setattr(tool.tradeoff, "measure", lambda scene, **words: dataset)
    file = tmp_path / "accuracy.json"
    file.write_text('{"scenes": {"another": {}}}', encoding="utf-8")
    tool.main(["temperature", "--budget", "1min", "--json", str(file)])
    held = json.loads(file.read_text(encoding="utf-8"))["scenes"]
    assert list(held) == ["another", "temperature"]
    table = Table.of(held["temperature"])
    assert table.labels == LABELS
    how = {"version": atmosbox.__version__, "budget": 60.0, "command": "a test --seed 1", "seconds": 2.0}
    assert table.how == how
    assert [(dict(one.settings), one.cost, one.members) for one in table.ways] == [
        ({"duration": 2.0}, 0.25, 9),
        ({}, 1.0, 8),
        ({"molecules": 4}, 0.5, 4),
    ]
    assert table.ways[0].errors["mean_temperature"] == ExpectedError("K", 0.1235, 0.1235, 0.1235, 298.15)
    printed = capsys.readouterr().out
    assert "| exact, duration=2 | 0.25 | 9 |" in printed
    for reason in ("3 runs, give a longer", "left the box", "budget does not close", "cannot go on"):
        assert reason in printed
    output.write(dataset, tmp_path / "trade.nc")
    file.unlink()
    tool.main([str(tmp_path / "trade.nc"), "--json", str(file)])
    assert json.loads(file.read_text(encoding="utf-8"))["scenes"] == {"temperature": held["temperature"]}
    monkeypatch.setattr(tool, "FEWEST", 9)
    with pytest.raises(SystemExit, match="default run did not run often enough"):
        tool.main(["temperature", "--json", str(file)])
    assert json.loads(file.read_text(encoding="utf-8"))["scenes"] == {"temperature": held["temperature"]}

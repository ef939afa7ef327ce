"""The link of a run: the page and Python run it to the last bit, and what is wrong with it is said in a sentence."""

import contextlib
import json
import random
import re
import shlex
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import atmosbox
from atmosbox import __version__, scenarios
from atmosbox.errors import SettingError, UnknownSceneError
from atmosbox.file.netcdf import read
from atmosbox.lab import page_file as lab_file
from atmosbox.lab import save_lab
from atmosbox.lab.wasm_module import SCENES
from atmosbox.simulation.link import read_link
from atmosbox.simulation.preparation import prepare, replayed
from atmosbox.simulation.recording import Recording
from atmosbox.simulation.runner import build
from tests.in_process import typed
from tests.lab.test_browser import SMALL, Lab, state_of

WHOLE = f"#atmosbox={__version__}&scene=temperature&molecules=50&seed=7&turns=3:temperature:60&frames=9&end"
TURNED = {
    "temperature": ({}, 90, {"temperature": (-200.0, 500.0)}),
    "lifting-dry": ({"molecules": 100, "ascent": 40}, 60, {"altitude": (0.0, 9.0)}),
    "atmosphere": ({"molecules": 500}, 20, {"temperature": (100.0, 600.0), "gravity": (1.0, 20.0)}),
    "convection": (
        {"molecules": 300},
        60,
        {"floor_temperature": (-250.0, 500.0), "ceiling_temperature": (-250.0, 500.0), "gravity": (1.0, 30.0)},
    ),
    "condensation": ({"molecules": 300}, 60, {"temperature": (-20.0, 60.0)}),
    "evaporation": ({"molecules": 300, "pool": 60}, 60, {"temperature": (-20.0, 60.0), "open_pool": (0.0, 100.0)}),
    "attraction": ({"molecules": 100}, 60, {"attraction": (0.0, 1.0), "temperature": (60.0, 250.0)}),
    "mountains": ({"molecules": 200, "travel": 20}, 80, {"way": (0.0, 100.0)}),
    "lifting-moist": ({"molecules": 200, "ascent": 30}, 60, {"altitude": (0.0, 5.0)}),
}
"""Settings, number of frames, and the knobs of a scene with the range in which they are turned."""


@pytest.fixture(scope="module")
def new_tab(new_tab):
    """A function that opens a tab without a network."""
    return lambda **options: new_tab(**{"offline": True, "reduced_motion": "reduce", **options})


@pytest.fixture
def lab(usual_tab, tmp_path):
    """A function that opens the page of a scene, at a link."""
    opened = []

    def show(scene, settings, link="", *, others=False):
        path = tmp_path / f"{scene}.html"
        if not path.exists():
            save_lab(prepare(scene, SCENES[scene] | settings, engine="exact"), path, others=others)
        opened.append(Lab(usual_tab, path.as_uri() + link))
        return opened[-1]

    yield show
    for each in opened:
        each.close()


def link_of(shown):
    """Return the link of the run in a page."""
    shown.page.click("#link")
    text = shown.page.input_value("dialog[open] #linked")  # not that of an earlier link
    shown.page.keyboard.press("Escape")
    command, link = text.split("\n")  # for a page that was opened from a file
    assert shlex.split(command) == ["atmosbox", "run", "--replay", link]
    return link


def end_of(link, least=100):
    """Return the SHA-256 of the state after the run of a link in Python."""
    prepared = replayed(link)
    setup = build(prepared)
    recording = Recording(prepared, setup, {})
    while recording.frames < prepared.frames(setup):
        recording.advance(lambda now: None)
    assert setup.parcel.contacts > least
    return state_of(setup.parcel)


def turn(shown, scene):
    """Turn the knobs of a page twenty times, take three turns back, play for a while, and stop at a frame."""
    _, frames, knobs = TURNED[scene]
    draw = random.Random(scene)
    if scene != "convection":
        shown.ask(type="reset", seed=2**53 - 1)
    for each in range(20):
        name = draw.choice(list(knobs))
        shown.ask(type="frames", value=1 + frames * each // 20)
        if each == 7:  # play for a while, at another pace and out of sight, and stop within a frame
            shown.ask(type="pace", value=0.3)
            shown.ask(type="play")
            time.sleep(0.2)
            shown.ask(type="watched", **{"is": False})
            shown.ask(type="pause")
            shown.ask(type="watched", **{"is": True})
        shown.ask(type="set", name=name, value=round(draw.uniform(*knobs[name]), draw.choice([0, 2, 13])))
        shown.ask(type="pause")  # an ascent that had come to its end plays on when it is led elsewhere
        shown.ask(type="undo") if each in (0, 5, 13) else None
        shown.ask(type="step") if each == 11 else None
    shown.ask(type="frames", value=frames)


@pytest.mark.parametrize(
    "scene", [pytest.param(name, marks=() if name == "temperature" else pytest.mark.nightly) for name in TURNED]
)
def test_a_run_with_twenty_turns_is_the_same_to_the_last_bit_in_its_page_in_a_new_one_and_in_python(lab, scene):
    settings = SMALL[scene][0] | TURNED[scene][0]
    shown = lab(scene, settings)
    turn(shown, scene)
    link, state = link_of(shown), shown.digest()
    assert len(read_link(link)[2].turns) > 15
    assert end_of(link) == state
    shown.close()
    again = lab(scene, settings, link)
    again.ask(type="frames", value=read_link(link)[2].frames)
    assert again.digest() == state
    assert link_of(again) == link


def test_a_saved_table_names_the_command_that_repeats_it_in_python_whose_file_can_be_used_as_any(
    lab, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    shown = lab("temperature", {"molecules": 50, "duration": "2 ns"})
    for frame, value in ((30, 300.0), (60, -100.0), (90, None)):
        shown.ask(type="frames", value=frame)
        shown.ask(type="set", name="temperature", value=value) if value else shown.ask(type="undo")
    shown.ask(type="frames", value=200)
    about, table = shown.table()
    program, *words = shlex.split(next(line for line in about if "--replay" in line)[2:])
    assert program == "atmosbox"
    assert typed(*words, "--out", "run.nc").exit_code == 0
    run = read("run.nc")
    np.testing.assert_array_equal(run.collision_count, table["collision_count"])
    np.testing.assert_allclose(run.wall_temperature[:, 4], table["wall_temperature[z_low]"])
    told = [[turn[part] for part in ("frame", "time_unit", "value", "unit")] for turn in json.loads(run.atmosbox_turns)]
    assert told == [[30, "ns", 300.0, "degC"], [60, "ns", -100.0, "degC"], [90, "ns", None, "degC"]]
    assert run.comment.startswith("Knobs were turned, see atmosbox_turns")
    assert run.atmosbox_headlines == "[]"  # a mean over all these temperatures has no theory
    # the histogram is that of the time after the last turn, which undid both others
    np.testing.assert_allclose(run.air_temperature_theory[-1], 298.15)
    late = np.sqrt((run.molecule_speed[140:] ** 2).mean())
    mean = np.sqrt((run.speed_probability_density * run.speed**2 * np.diff(run.speed_bnds, axis=1)[:, 0]).sum())
    assert float(mean) == pytest.approx(float(late), rel=0.05)
    for command in ("check", "plot"):
        assert typed(command, "run.nc").exit_code == 0
    assert typed("run", "--from", "run.nc", "--dry-run").exit_code == 0


@pytest.mark.parametrize(
    ("part", "wrong", "sentence"),
    [
        (WHOLE, "", "is not a link of a run, or only a part of one: copy the link again from the page, as a whole"),
        ("&end", "", "is not a link of a run, or only a part"),
        ("&end", "&end&x=1", "is not a link of a run"),
        (__version__, "9.8", f"is of atmosbox 9.8, and this is {__version__}, whose numbers may differ: type pip"),
        ("=temperature", "=nowhere", "is for a scene that there is not, nowhere: type atmosbox list."),
        ("=temperature", "=..%2Fown.py", "is for a scene of your own, whose file must be typed, ../own.py: type"),
        ("molecules=50", "molecules=0", "molecules = 0 is below the allowed range"),
        ("molecules=50", "colour=5", "colour = 5 is not a setting of this scene: give one of molecules"),
        ("molecules=50", "molecules=50&molecules=60", "has a setting twice"),
        ("=temperature&molecules=50", "=lifting-sounding&sounding=%2Fetc%2Fpasswd", "names a file, sounding = /etc"),
        ("3:temperature", "3:wind", "moves the slider wind, which the scene does not have (it has temperature): copy"),
        (":60", ":501", "moves temperature to 501, outside its range of -200 to 500 degC"),
        (":60", ":nan", "has moves of sliders that cannot be read"),
        (":60", ":60,2:temperature:50", "has moves of sliders that cannot be read"),  # backwards
        (":60", ":60" + ",3:temperature:60" * 5_000, "has moves of sliders that cannot be read"),  # too many
        (":60", ":60" + ",3:temperature:60" * 20_000, "is not a link of a run"),
        ("frames=9", "frames=1000001", "is of more than 1000000 frames"),
        ("&frames", "&predict=air_temperature:1,2,3,4&frames", "has a prediction that cannot be read: it needs a"),
        ("&frames", "&predict=air_temperature:1,2,warm,4,5&frames", "has a prediction that cannot be read"),
        ("&frames", "&predict=1,2,3,4,5&frames", "has a prediction that cannot be read"),
    ],
)  # fmt: skip
def test_a_link_that_cannot_be_run_is_refused_in_a_sentence_with_what_helps(part, wrong, sentence):
    assert part in WHOLE
    ended = typed("run", "--replay", WHOLE.replace(part, wrong, 1), "--out", "never.nc")
    assert (ended.exit_code, ended.stderr.count("\n")) == (2, 1)
    assert sentence in ended.stderr


def changed(place, piece):
    """Return a link of which one piece is another text."""
    pieces = re.split(r"([#&=:,])", WHOLE)
    return "".join([*pieces[:place], piece, *pieces[place + 1 :]])


pieces = st.text(max_size=9) | st.sampled_from(
    ["", "&", "%00", "%FF", "-1", "1e999", "9" * 400, "start", "seed", "a=b"]
)


def test_a_prediction_in_a_link_changes_nothing_of_the_run():
    drawn = WHOLE.replace("&frames", "&predict=air_temperature:-70,20.5,1e-7,25,25&frames")
    assert end_of(drawn, least=5) == end_of(WHOLE, least=5)


@given(st.text() | st.builds(changed, st.integers(0, 34), pieces))
def test_any_text_is_a_link_or_refused(text):
    with contextlib.suppress(SettingError, UnknownSceneError):
        assert replayed(text).replay.link.startswith("#atmosbox=")


def test_all_scenes_come_with_an_index_in_the_order_of_teaching(usual_tab, tmp_path, monkeypatch):
    told = scenarios.summaries()
    monkeypatch.setattr(
        scenarios, "summaries", lambda: {name: told[name] for name in ("temperature", "elastic-collisions")}
    )
    monkeypatch.setattr(lab_file, "_MOST_BYTES", 0)  # one start in each page, which is quicker
    ended = typed("lab", "--all", "--out", tmp_path / "labs", "--quiet")
    assert (ended.exit_code, ended.stdout.strip()) == (0, str(tmp_path / "labs" / "index.html"))
    usual_tab.goto((tmp_path / "labs" / "index.html").as_uri())
    assert usual_tab.locator("h2").all_inner_texts() == [
        "What is temperature?",
        "Do light or heavy discs have more energy?",
    ]
    assert usual_tab.evaluate("[...document.images].map((each) => each.naturalWidth)") == [480, 480]
    assert usual_tab.locator("small").first.inner_text() == "school · 10 minutes"
    assert usual_tab.locator("small").last.inner_text() == f"Made by atmosbox {__version__}."
    usual_tab.click("text=Do light or heavy discs")
    usual_tab.wait_for_selector("body[data-ready]")
    ended = typed("lab", "--all", "--out", tmp_path / "labs")
    assert (ended.exit_code, "exists already: add --force" in ended.stderr) == (2, True)
    ended = typed("lab", "temperature", "--all")
    assert (ended.exit_code, "scene cannot change what --all writes: leave it out" in ended.stderr) == (2, True)


def test_theory_of_a_thermostat_ends_where_a_knob_is_turned():
    link = f"#atmosbox={__version__}&scene=attraction&molecules=60&seed=1&turns=3:temperature:200&frames=6&end"
    theory = atmosbox.run(replay=link, progress=False).air_temperature_theory.values
    assert np.isfinite(theory).tolist() == [True] * 3 + [False] * 3


def test_a_link_excludes_settings_of_its_own():
    for words in (["seed", "3"], ["set", "molecules=60"], ["engine", "dsmc"]):
        ended = typed("run", "--replay", WHOLE, f"--{words[0]}", words[1])
        assert (ended.exit_code, "cannot change a run that is replayed: leave it out" in ended.stderr) == (2, True)
    with pytest.raises(SettingError, match="molecules cannot change a run that is replayed"):
        atmosbox.run(replay=WHOLE, molecules=60)
    with pytest.raises(UnknownSceneError, match="No scene is given"):
        atmosbox.run()


def test_a_page_opens_the_links_of_its_starts_and_refuses_others_in_a_sentence(lab):
    shown = lab("elastic-collisions", {"molecules": 10}, others=True)
    first = shown.digest()
    for name, value in (("molecules", "5"), ("seed", "3")):
        shown.ask(type="set", name=name, value=value)
        shown.ask(type="frames", value=20)
        link, state = link_of(shown), shown.digest()
        assert end_of(link, least=5) == state
        shown.page.goto(shown.page.url.partition("#")[0] + link)  # which opens the page again
        shown.page.wait_for_selector("body[data-ready]")
        shown.ask(type="frames", value=20)
        assert shown.digest() == state
    for part, wrong, sentence in (
        ("&end", "&en", "This link is damaged"),
        ("=", "=9.", f"This link is of atmosbox 9.{__version__}"),
        ("elastic-collisions", "mountains", "This link is for the scene mountains: open it in the page that"),
        ("seed=3", "seed=99", "This page has no box with the settings of the link: type atmosbox run --replay"),
        ("&frames", "&predict=running_energy_heavy:1,2,3,4,5&frames", "The prediction of this link cannot be read"),
        ("&frames", "&turns=0:constructor:3&frames", "constructor = 3 cannot be turned in frame 0"),
    ):  # fmt: skip
        shown.page.goto(shown.page.url.partition("#")[0] + link.replace(part, wrong, 1))
        assert sentence in shown.note()
        shown.page.locator("#notes button").click()
    assert shown.digest() != first  # the box of the last link, without its turn


def values_of(page):
    """Return the values of the handles of a prediction, as a screen reader says them."""
    return page.locator(".handle[role=slider]").evaluate_all("(all) => all.map((each) => each.ariaValueText)")


def drag(page, handle, up):
    """Drag a handle of a prediction up by some pixels."""
    box = handle.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y - up, steps=4)
    page.mouse.up()


def test_a_prediction_is_drawn_by_hand_and_by_keyboard_and_goes_into_link_and_table(lab):
    shown = lab("temperature", {"molecules": 50})
    page, button = shown.page, shown.page.get_by_role("button", name="Draw your prediction")
    button.click()
    assert page.get_by_role("slider", name="time 0.25 ns").get_attribute("aria-valuetext") == "−50 °C"
    assert page.get_by_role("button", name="Done").is_disabled()  # nothing was drawn
    drag(page, page.locator(".handle").first, -60)
    last = page.get_by_role("slider", name="time 1 ns")
    last.press("PageUp")
    last.press("ArrowUp")
    last.press("ArrowLeft")
    last.press("ArrowRight")
    first, *others = values_of(page)
    assert others == ["−50 °C", "−50 °C", "−50 °C", "5 °C"]  # steps of 5 degrees
    low = float(first.removesuffix(" °C").replace("−", "-"))
    assert low < -60.0
    page.get_by_role("button", name="Done").click()
    assert page.locator(".key", has_text="your prediction").count() == 1
    shown.ask(type="frames", value=9)
    shown.ask(type="reset", seed=7)  # it stays when the box begins again
    shown.ask(type="frames", value=9)
    link = link_of(shown)
    assert f"&predict=air_temperature:{low:g},-50,-50,-50,5&frames=9&end" in link
    replayed(link)
    about, _ = shown.table()
    place = about.index("# predicted: elapsed_time [ns], air_temperature [K]")
    told = [tuple(map(float, line[2:].split(", "))) for line in about[place + 1 : place + 6]]
    assert told == [(0.0, round(low + 273.15, 2)), (0.25, 223.15), (0.5, 223.15), (0.75, 223.15), (1.0, 278.15)]
    shown.close()
    again = lab("temperature", {"molecules": 50}, link)
    assert again.page.locator(".key", has_text="your prediction").count() == 1
    assert link_of(again).partition("&predict=")[2].startswith(f"air_temperature:{low:g},-50,-50,-50,5&")
    again.page.select_option("#language", "de")  # which writes the page again
    again.page.get_by_role("button", name="Neu zeichnen").click()
    assert values_of(again.page) == [first, *others]
    again.page.get_by_role("button", name="Abbrechen").click()
    again.page.get_by_role("button", name="Vorhersage entfernen").click()
    again.page.select_option("#language", "en")
    assert again.page.locator(".key", has_text="your prediction").count() == 0
    assert "predict" not in link_of(again)
    again.close()
    for wrong in (",5&", ",5,13&"), (",5&", ",,5&"), ("air_temperature:", "air_pressure:"):
        refused = lab("temperature", {"molecules": 50}, link.replace(*wrong))
        assert "The prediction of this link cannot be read" in refused.note()
        refused.close()


def test_results_are_hidden_until_the_prediction_is_drawn_if_the_address_says_so(lab, usual_tab):
    usual_tab.emulate_media(reduced_motion="no-preference")
    shown = lab("lifting-dry", {"molecules": 100, "ascent": 40}, "?predict")
    page = shown.page
    page.wait_for_timeout(500)
    assert page.locator("#time").inner_text() == "0 ns"  # it waits
    shown.ask(type="frames", value=20)
    results = [page.locator(name) for name in ("#gauges", ".sentences", ".atmosphere", ".histogram", ".key")]
    shown.until(lambda: page.locator("#gauges button").count() > 0)
    assert not any(each.is_visible() for found in results for each in found.all())
    assert page.locator(".asked").inner_text().startswith("Predict: temperature")
    curves = "document.querySelector('.asked').textContent"
    assert "dry adiabat" not in page.evaluate(curves)
    assert page.get_by_role("button", name="Cancel").count() == 0
    place = page.locator(".handle").nth(2).bounding_box()
    page.locator(".handle").nth(2).press("ArrowLeft")  # a profile: to the left is colder
    assert page.locator(".handle").nth(2).bounding_box()["x"] < place["x"]
    page.get_by_role("button", name="Done").click()
    shown.until(lambda: all(each.is_visible() for each in page.locator("#gauges, .graph, .key").all()))
    assert "dry adiabat" in page.locator(".key").all_inner_texts()[1]
    assert page.locator("body[data-playing=true]").count() == 1
    usual_tab.emulate_media(reduced_motion="reduce")


def test_a_page_inside_of_another_has_no_header_and_tells_its_height(lab, tmp_path):
    page = lab("elastic-collisions", {"molecules": 10}).page
    hears = "addEventListener('message', ({ data }) => { document.body.dataset.told = data.height; })"
    frame = '<iframe src="elastic-collisions.html?embed" width="1000" height="300"></iframe>'
    (tmp_path / "course.html").write_text(f"<body><script>{hears}</script>{frame}", encoding="utf-8")
    page.goto((tmp_path / "course.html").as_uri())
    assert 500 < float(page.wait_for_selector("body[data-told]").get_attribute("data-told")) < 800
    assert not page.frames[1].locator("header").is_visible()

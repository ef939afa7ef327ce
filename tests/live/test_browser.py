"""A real browser: a slider is moved, the air follows, and the recording opens in xarray."""

import re

import pytest
import xarray as xr

from atmosbox.live import Session
from atmosbox.page import live_page
from atmosbox.simulation.preparation import prepare


@pytest.fixture
def visit(new_tab, usual_tab, serve, tmp_path):
    """Return a function that opens the page of a scene with a reader's settings; a fault in it fails the test."""
    opened, faults = [], []
    heard = {
        "pageerror": lambda error: faults.append(str(error)),
        "console": lambda said: faults.append(said.text) if said.type == "error" else None,
    }

    def page(scene, settings, *, ahead=0.0, before="", **reader):
        session = Session(prepare(scene, settings), folder=tmp_path)
        while session.state()["frame"] < ahead * session.setup.frames:
            session.obey({"type": "play"})
            session.run(0.1)
        site = serve(session, document=live_page())
        site.__enter__()
        tab = new_tab(**reader) if reader or before else usual_tab
        if before:
            tab.add_init_script(before)
        opened.append((tab, site))
        for event, hear in heard.items():
            tab.on(event, hear)
        tab.goto(site.address)
        tab.wait_for_selector("body[data-ready]", timeout=20_000)
        return tab

    yield page
    for tab, site in opened:
        tab.goto("about:blank")
        for event, hear in heard.items():
            tab.remove_listener(event, hear)
        site.__exit__()
    assert not faults


def time_of(page):
    """Return the time of the box [ns]."""
    return float(page.locator("#time").inner_text().split()[0])


def play_to(page, time):
    """Wait until the box has come to a time [ns]."""
    for _ in range(400):
        if time_of(page) > time:
            return
        page.wait_for_timeout(100)
    raise AssertionError(f"the box has only come to {page.locator('#time').inner_text()}")


def test_a_parcel_that_has_risen_is_drawn_although_the_page_does_not_know_its_own_size_yet(visit):
    page = visit("lifting-dry", {"molecules": 50}, ahead=0.5, before="window.ResizeObserver = class { observe() {} };")
    page.wait_for_selector("body[data-playing=true]")
    play_to(page, time_of(page) + 0.5)


def test_moving_the_slider_makes_the_measured_temperature_follow_and_the_recording_opens(visit, tmp_path):
    page = visit("temperature", {"molecules": 100}, reduced_motion="reduce")
    page.click("#record")
    page.click("#play")
    page.wait_for_selector("body[data-playing=true]")
    slider = page.locator("input[type=range][name=temperature]")
    assert slider.input_value() == "25"
    for pace in ("2×", "4×", "8×", "16×"):
        page.click("#faster")
        page.locator("#pace", has_text=pace).wait_for()
    play_to(page, 1.0)
    slider.fill("300")
    slider.dispatch_event("change")
    play_to(page, time_of(page) + 3.0)
    page.click("#record")
    page.wait_for_selector("#record[aria-pressed=false]")
    page.click("#play")
    page.wait_for_selector("body[data-playing=false]")
    note = page.locator("#notes").inner_text()
    name = re.search(r"(\d+) frames are in (\S+\.nc)", note)
    assert name
    made = xr.load_dataset(tmp_path / name.group(2).rsplit("/", 1)[-1])
    assert made.sizes["elapsed_time"] == int(name.group(1))
    walls = made.air_temperature_theory.values
    assert walls[0] == pytest.approx(298.15)
    assert walls[-1] == pytest.approx(573.15)
    turned = int((walls > 500.0).argmax())
    late = made.air_temperature.values[turned + 25 :]
    assert late.size > 80
    # 100 molecules scatter by sqrt(2 / 300) of T, 47 K; a gas so thin forgets its energy in a frame, the time to a
    # wall, so that there are 25 samples at least, and 4 errors of their mean are 38 K
    assert late.mean() == pytest.approx(573.15, abs=38.0)
    assert made.air_temperature.values[: turned - 5].mean() < 373.15


def test_the_page_opens_playing_unless_the_reader_wants_nothing_to_move(visit):
    still = visit("temperature", {"molecules": 100}, reduced_motion="reduce")
    moving = visit("temperature", {"molecules": 100})
    moving.wait_for_selector("body[data-playing=true]")
    play_to(moving, 0.05)
    assert still.evaluate("document.body.dataset.playing") == "false"
    assert still.locator("#time").inner_text() == "0 ns"


def test_a_knob_of_a_box_that_rests_acts_at_once_and_the_words_follow_it(visit):
    page = visit("temperature", {"molecules": 100}, reduced_motion="reduce")
    assert "walls at 25.0 °C" in page.locator("#caption").inner_text()
    slider = page.locator("input[type=range][name=temperature]")
    slider.fill("400")
    slider.dispatch_event("change")
    page.locator("#caption", has_text="walls at 400 °C").wait_for(timeout=2000)
    page.locator("#legend", has_text="1500").wait_for(timeout=2000)
    assert "being built" not in page.locator("#vitals").inner_text()
    page.keyboard.press("Escape")
    page.locator("#undo").click()
    page.locator("#caption", has_text="walls at 25.0 °C").wait_for(timeout=2000)
    page.locator("#undo:disabled").wait_for(timeout=2000)


@pytest.mark.parametrize(
    ("scene", "settings", "knob", "value", "words"),
    [
        ("evaporation", {"molecules": 300, "pool": 60}, "temperature", "10", "walls at 10.0 °C"),
        ("evaporation", {"molecules": 300, "pool": 60}, "open_pool", "0", "smooth"),
        ("elastic-collisions", {"molecules": 20}, "speed", "1", "walls kept at a temperature"),
    ],
)
def test_walls_and_pool_of_a_box_that_plays_are_changed_without_a_new_start(visit, scene, settings, knob, value, words):
    page = visit(scene, settings)
    page.wait_for_selector("body[data-playing=true]")
    play_to(page, 0.02)
    slider = page.locator(f"input[type=range][name='{knob}']")
    slider.fill(value)
    slider.dispatch_event("change")
    page.locator("#caption", has_text=words).wait_for(timeout=2000)
    assert time_of(page) > 0.02, "the box did not begin anew"
    assert slider.input_value() == value
    assert "being built" not in page.locator("#vitals").inner_text()


def test_a_challenge_is_judged_by_what_has_been_measured(visit):
    page = visit("lifting-dry", {"molecules": 1000, "ascent": 400, "temperature": 44.8}, ahead=0.9)
    page.click("text=Challenge 1")
    for pace in ("2×", "4×", "8×", "16×"):
        page.click("#faster")
        page.locator("#pace", has_text=pace).wait_for()
    page.locator(".challenge.reached").wait_for(timeout=20_000)
    assert re.search(r"Reached: 30\d hPa, −(47|48)\.\d °C\.", page.locator(".verdict").inner_text())


def test_what_is_measured_can_be_heard(visit):
    page = visit("temperature", {"molecules": 100})
    page.locator("#gauges output").first.wait_for(timeout=10_000)
    assert page.get_by_role("group", name="what is measured now").count() == 1
    page.keyboard.press("m")
    heard = page.locator("#voice").inner_text()
    assert re.fullmatch(r"[\d.]+ ns: temperature −?[\d.]+ °C, pressure \d+ hPa", heard)


def test_a_phone_shows_everything_whole_and_nothing_lies_on_another(visit):
    page = visit("temperature", {"molecules": 100}, size=(390, 844), locale="de-DE", reduced_motion="reduce")
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    for group in ("footer > *", "#lesson .tries > *", "#controls .setting > *", "#tools > *"):
        boxes = page.evaluate(
            """(group) => [...document.querySelectorAll(group)].map((each) => each.getBoundingClientRect())
               .filter(({ width }) => width > 0).map(({ left, right, top, bottom }) => [left, right, top, bottom])""",
            group,
        )
        assert len(boxes) > 2, group
        for number, (left, right, top, bottom) in enumerate(boxes):
            assert left >= 0
            assert right <= 390
            for other in boxes[number + 1 :]:
                beside = right <= other[0] + 1.0 or other[1] <= left + 1.0
                assert beside or bottom <= other[2] + 1.0 or other[3] <= top + 1.0, group

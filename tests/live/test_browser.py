"""A real browser: a slider is moved, the air follows, and what is recorded opens in xarray."""

import re

import pytest
import xarray as xr

from atmosbox.live import Session
from atmosbox.page import live_page
from atmosbox.simulation.preparation import prepare


@pytest.fixture
def page(browser, serve, tmp_path):
    """The page of a hundred molecules between warm walls, in a browser; a fault in it fails the test."""
    session = Session(prepare("temperature", {"molecules": 100}), folder=tmp_path)
    faults = []
    with serve(session, document=live_page()) as site:
        context = browser.new_context(viewport={"width": 1280, "height": 720}, reduced_motion="reduce")
        shown = context.new_page()
        shown.on("pageerror", lambda error: faults.append(str(error)))
        shown.on("console", lambda said: faults.append(said.text) if said.type == "error" else None)
        shown.goto(site.address)
        shown.wait_for_selector("body[data-ready]", timeout=20_000)
        yield shown
        context.close()
    assert not faults


def play_to(page, time):
    """Wait until the box has come to a time [ns]."""
    for _ in range(400):
        if float(page.locator("#time").inner_text().split()[0]) > time:
            return
        page.wait_for_timeout(100)
    raise AssertionError(f"the box has only come to {page.locator('#time').inner_text()}")


def test_moving_the_slider_makes_the_measured_temperature_follow_and_the_recording_opens(page, tmp_path):
    page.click("#record")
    page.click("#play")
    page.wait_for_selector("body[data-playing=true]")
    slider = page.locator("input[type=range][aria-label=temperature]")
    assert slider.input_value() == "25"
    for pace in ("2×", "4×", "8×", "16×"):
        page.click("#faster")
        page.locator("#pace", has_text=pace).wait_for()
    play_to(page, 1.0)
    slider.fill("300")
    slider.dispatch_event("change")
    play_to(page, 7.0)
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
    late = made.air_temperature.values[turned + 50 :]
    blocks = late[: len(late) // 20 * 20].reshape(20, -1).mean(axis=1)
    # 100 molecules scatter by sqrt(2 / 300) of T; 20 blocks, 4 errors of their mean: 1 false alarm in 1300
    assert abs(blocks.mean() - 573.15) < 4.0 * blocks.std(ddof=1) / 20**0.5
    assert made.air_temperature.values[: turned - 5].mean() < 373.15

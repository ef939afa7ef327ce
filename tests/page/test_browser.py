"""The page in a real browser, opened from disk and without a network."""

import numpy as np
import pytest

from atmosbox.page.document import packaged, words
from atmosbox.page.saved_run import pages
from atmosbox.plot.curve import curve
from atmosbox.scene.panels import Line, Panel, from_json, to_json

PHONE = (390, 844)


def data(page, name):
    """Return the state that the page reports."""
    return page.evaluate(f"document.body.dataset.{name}")


def time(page):
    return float(data(page, "time"))


def picture(page):
    """Return the picture of the box, after it has been drawn again."""
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")
    return page.locator(".box canvas").first.screenshot()


def until(page, condition):
    """Wait for a condition; the page forbids the script with which playwright would wait."""
    for _ in range(300):
        if page.evaluate(condition):
            return
        page.wait_for_timeout(50)
    pytest.fail(f"it never came true that {condition}")


def test_space_lets_the_molecules_fly_and_stops_them(opened):
    page = opened("warm")
    before = picture(page)
    page.keyboard.press("Space")
    until(page, "Number(document.body.dataset.time) > 0.015")
    assert data(page, "playing") == "true"
    page.keyboard.press("Space")
    assert data(page, "playing") == "false"
    stopped = time(page)
    assert picture(page) != before
    assert time(page) == stopped


WITHOUT_WEBGL = """
    const usual = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      return kind.startsWith("webgl") ? null : usual.call(this, kind, ...more);
    };
    console.error = () => {};
"""


def test_without_webgl_a_sentence_stands_where_the_box_would_and_all_else_works(opened):
    page = opened("pair", before=WITHOUT_WEBGL)
    assert page.locator(".no-picture").all_inner_texts() == [words("en")["page"]["no_picture"]] * 2
    assert page.locator(".box canvas").first.is_hidden()
    page.keyboard.press("Space")
    until(page, "Number(document.body.dataset.time) > 0.015")


def test_a_browser_that_is_too_old_is_told_so(new_tab, site):
    tab = new_tab()
    tab.add_init_script("delete window.DecompressionStream")
    tab.goto(site("warm"))
    assert words("en")["page"]["cannot_start"] in tab.locator(".failure").inner_text()


def test_arrows_step_through_the_frames_and_change_the_pace(opened):
    page = opened("warm")
    page.keyboard.press("ArrowRight")
    assert time(page) == pytest.approx(0.02)
    page.keyboard.press("Shift+ArrowRight")
    assert time(page) == pytest.approx(0.12)
    page.keyboard.press("ArrowLeft")
    assert time(page) == pytest.approx(0.11)
    page.keyboard.press("End")
    page.keyboard.press("ArrowRight")
    assert time(page) == pytest.approx(0.2)
    page.keyboard.press("Home")
    assert time(page) == pytest.approx(0.01)
    pace = page.inner_text("#pace")
    page.keyboard.press("ArrowDown")
    assert page.inner_text("#pace").startswith("1/2×")
    page.keyboard.press("ArrowUp")
    assert page.inner_text("#pace") == pace


def test_a_molecule_is_followed_by_a_click_and_by_a_key(opened):
    page = opened("warm")
    assert page.inner_text("#status") == ""
    page.keyboard.press("t")
    assert data(page, "traced") != ""
    assert "Following a molecule of dry air" in page.inner_text("#status")
    page.keyboard.press("ArrowRight")
    assert "m/s" in page.inner_text("#status")
    page.keyboard.press("t")
    assert data(page, "traced") == ""
    box = page.locator(".box canvas").bounding_box()
    found = set()
    for step in range(40):  # somewhere near the middle there is a molecule
        page.mouse.click(box["x"] + box["width"] * (0.3 + 0.01 * step), box["y"] + box["height"] * 0.5)
        found.add(data(page, "traced"))
        if found - {""}:
            break
    assert found - {""}


def test_a_click_on_a_graph_over_time_goes_there_and_what_is_to_come_is_veiled(opened):
    page = opened("warm")
    over = page.locator(".graph.line .u-over").first
    size = over.bounding_box()
    over.click(position={"x": 0.5 * size["width"], "y": 20})
    assert 0.08 < time(page) < 0.13
    veil = page.locator(".graph.line .veil").first.bounding_box()
    assert veil["x"] == pytest.approx(size["x"] + 0.5 * size["width"], abs=3)
    assert page.locator(".graph.profile .dot").first.is_visible()


def test_two_runs_stand_side_by_side_on_one_clock(opened):
    page = opened("pair")
    assert page.locator(".box canvas").count() == 2
    assert page.locator(".box h2").all_inner_texts() == ["Atemperature 27 °C", "Btemperature 60 °C"]
    left, right = (page.locator(".box").nth(number).bounding_box() for number in range(2))
    assert left["y"] == right["y"]
    assert left["x"] + left["width"] <= right["x"]
    assert page.locator("#line").count() == 1
    assert page.locator(".graph.line").count() == 1  # with the curves of both
    before = [page.locator(".box canvas").nth(number).screenshot() for number in range(2)]
    page.keyboard.press("ArrowRight")
    picture(page)
    after = [page.locator(".box canvas").nth(number).screenshot() for number in range(2)]
    assert before[0] != after[0]
    assert before[1] != after[1]


def test_water_is_told_from_air_and_c_changes_what_colours_mean(opened):
    page = opened("moist")
    assert page.locator("#legend .chip").all_inner_texts() == ["dry air", "water", "liquid water"]
    kinds = picture(page)
    page.keyboard.press("c")
    assert "speed (m/s)" in page.inner_text("#legend")
    assert picture(page) != kinds
    page.keyboard.press("End")
    page.click(".more")
    assert "clumps" in page.inner_text("#caption")


@pytest.mark.nightly
def test_a_projector_shows_all_at_once(opened):
    page = opened("warm")
    size = page.evaluate("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
    assert size == [1280, 720]
    box = page.locator(".box").bounding_box()
    assert box["width"] >= 560
    assert box["height"] >= 400
    for graph in page.locator(".graph").all():
        frame = graph.bounding_box()
        assert frame["y"] + frame["height"] <= 720


def test_a_phone_needs_no_scrolling_sideways_and_has_the_bar_at_hand(opened):
    page = opened("warm", size=PHONE)
    assert page.evaluate("document.documentElement.scrollWidth") <= PHONE[0]
    bar = page.locator("#play").bounding_box()
    assert bar["y"] + bar["height"] <= PHONE[1]
    assert min(bar["width"], bar["height"]) >= 40
    page.locator("#play").tap()
    until(page, "Number(document.body.dataset.time) > 0.011")
    assert page.locator(".box").bounding_box()["width"] <= PHONE[0]


def test_the_page_draws_the_same_numbers_as_the_figure_of_the_run(browser, run):
    unsure = np.array([np.nan, 70.0, 70.0] + [5.0] * 17)  # of about 150 K
    dataset = run(air_temperature_se=unsure)
    line = Line("air_temperature", "air_pressure", "air", error="air_temperature_se")
    known = Panel("profile", "Known", (line,), x_unit="K", y_unit="hPa")
    dataset.attrs["atmosbox_panels"] = to_json((*from_json(dataset.attrs["atmosbox_panels"]), known))
    (shown,) = pages([dataset])
    context = browser.new_context()
    page = context.new_page()
    page.route("http://page.test/**", lambda route: route.fulfill(body="<!doctype html>", content_type="text/html"))
    page.route(
        "http://page.test/*.js",
        lambda route: route.fulfill(
            body=packaged("web", route.request.url.rpartition("/")[2]), content_type="text/javascript"
        ),
    )
    page.goto("http://page.test/")
    told = {"panels": shown.record["stage"]["panels"], "numbers": {k: shown.record[k] for k in ("values", "timed")}}
    drawn = page.evaluate(
        """async ({ panels, numbers }) => {
             const { curvesOf, Numbers } = await import("http://page.test/curves.js");
             return panels.map((panel) => curvesOf(panel, new Numbers(numbers)));
           }""",
        told,
    )
    context.close()
    compared = 0
    for panel, curves in zip(from_json(dataset.attrs["atmosbox_panels"]), drawn, strict=True):
        for line, found in zip(panel.lines, curves, strict=True):
            expected = curve(dataset, panel, line)
            np.testing.assert_allclose(found["x"], expected.x, rtol=2e-5)
            np.testing.assert_allclose(found["y"], expected.y, rtol=2e-5, atol=2e-3)
            if expected.error is not None:
                np.testing.assert_allclose(found["error"], expected.error, rtol=2e-5)
            compared += 1
    assert compared == 4
    assert np.isnan(found["x"]).tolist() == [True] * 3 + [False] * 17

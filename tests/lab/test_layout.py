"""The page on the screens of classes: all is whole and legible, moves by keyboard, and has the name that is seen."""

from pathlib import Path

import numpy as np
import pytest

from atmosbox import scenarios
from atmosbox.lab import save_lab
from atmosbox.lab.wasm_module import SCENES
from atmosbox.page.document import LANGUAGES
from atmosbox.simulation.preparation import prepare

SIZES = ((1280, 800), (1024, 768), (1920, 1080), (390, 844), (844, 390), (640, 400))
"""Projectors, a phone upright and on its side, and 1280 x 800 at 200 %."""
FEW = {"atmosphere": 1000, "lifting-dry": 300, "lifting-moist": 400, "lifting-sounding": 300, "mountains": 400}
FEW |= {"condensation": 300, "evaporation": 400, "attraction": 300}
USUAL = ("temperature", "lifting-sounding", "evaporation")

FAULTS = Path(__file__).with_name("layout_faults.js").read_text(encoding="utf-8")


def drawn(page, size=None):
    """Give a page a size, and wait for four pictures: a graph gets its size in one, and its texts in the next."""
    if size:
        page.set_viewport_size({"width": size[0], "height": size[1]})
        page.wait_for_function("(width) => innerWidth === width", arg=size[0])
    page.evaluate(
        """() => new Promise((done) => {
             let left = 4;
             const next = () => { if (left--) requestAnimationFrame(next); else done(); };
             next();
           })"""
    )


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    """Return a function that writes the page of a scene, with few molecules, once."""
    folder, made = tmp_path_factory.mktemp("labs"), {}

    def address(scene):
        if scene not in made:
            few = {"molecules": FEW[scene]} if scene in FEW else {}
            prepared = prepare(scene, SCENES[scene] | few, engine="exact")
            others = scene in ("elastic-collisions", "convection")  # with presets
            made[scene] = save_lab(prepared, folder / f"{scene}.html", others=others).as_uri()
        return made[scene]

    return address


@pytest.fixture
def opened(new_tab, written):
    """Return a function that opens the page of a scene in a tab, whose faults fail the test."""
    faults, tabs = [], []

    def show(scene, size=(1280, 800), **options):
        tab = new_tab(size, reduced_motion="reduce", **options)
        tab.on("pageerror", lambda error: faults.append(str(error)))
        tab.goto(written(scene))
        tab.wait_for_selector("body[data-ready]", timeout=30_000)
        tab.evaluate("document.dispatchEvent(new CustomEvent('ask', {detail: {type: 'frames', value: 4}}))")
        tab.wait_for_timeout(600)
        tabs.append(tab)
        return tab

    yield show
    for tab in tabs:
        tab.close()
    assert not faults


def _tier(scene):
    return pytest.param(scene, marks=() if scene in USUAL else pytest.mark.nightly)


def speak(page, language):
    """Choose a language in the page."""
    page.evaluate(
        """(to) => {
             const list = document.getElementById("language");
             list.value = to;
             list.dispatchEvent(new Event("change"));
           }""",
        language,
    )
    drawn(page)


@pytest.mark.parametrize("scene", [_tier(scene) for scene in scenarios.names()])
def test_on_every_screen_nothing_is_cut_off_or_lies_on_another_and_all_can_be_read(opened, scene):
    page = opened(scene)
    found = []
    for language in ("de", "en") if scene in USUAL else LANGUAGES[1:]:
        speak(page, language)
        for theme, sizes in (("light", SIZES), ("dark", SIZES[1:2])):
            page.evaluate("(to) => { document.documentElement.dataset.theme = to; }", theme)
            for width, height in sizes:
                drawn(page, (width, height))
                faults = page.evaluate(FAULTS)
                if page.locator("#menu").is_visible():
                    page.click("#menu")
                    drawn(page)
                    assert page.locator("#save").is_visible()
                    faults += [f"menu: {each}" for each in page.evaluate(FAULTS) if not each.startswith("the ")]
                    page.click("#menu")
                found += [f"{language} {theme} {width} x {height}: {fault}" for fault in faults]
    assert not found, "\n".join(found)


@pytest.mark.parametrize("scene", [_tier("temperature"), _tier("lifting-sounding"), _tier("convection")])
def test_a_prediction_can_be_drawn_on_every_screen(opened, scene):
    page, found = opened(scene), []
    speak(page, "de")
    page.locator("#lesson .choices button").nth(3).click()
    for width, height in SIZES:
        drawn(page, (width, height))
        page.locator(".asked").scroll_into_view_if_needed()
        boxes = [each.bounding_box() for each in page.locator(".handle").all()]
        centres = np.array([(each["x"] + each["width"] / 2, each["y"] + each["height"] / 2) for each in boxes])
        faults = page.evaluate(FAULTS)
        if min(min(each["width"], each["height"]) for each in boxes) < 24.0:
            faults.append("the handles are too small")
        if np.hypot(*np.diff(centres, axis=0).T).min() < 24.0:
            faults.append("the handles are too close")
        if centres[:, 0].min() < 12.0 or centres[:, 0].max() > width - 12.0:
            faults.append("the handles are cut off")
        found += [f"drawing {width} x {height}: {fault}" for fault in faults]
    page.locator(".handle").first.press("PageUp")
    page.locator(".asked .main").click()
    for width, height in SIZES:
        drawn(page, (width, height))
        found += [f"drawn {width} x {height}: {fault}" for fault in page.evaluate(FAULTS)]
    assert not found, "\n".join(found)


CONTROLS = "button, input, select, summary, canvas[tabindex]"


@pytest.mark.parametrize("scene", [_tier(scene) for scene in scenarios.names()])
def test_every_control_is_reached_and_moved_by_keyboard_and_has_the_name_that_is_seen(opened, scene):
    page = opened(scene)
    for language in LANGUAGES[1:]:
        speak(page, language)
        for label in page.locator("#controls .setting.number .name").all_inner_texts():
            slider = page.get_by_role("slider", name=label, exact=True)
            assert page.get_by_role("spinbutton", name=label, exact=True).count() == slider.count() == 1
            before = slider.input_value()
            slider.press("ArrowLeft")
            assert slider.input_value() != before
            slider.press("ArrowRight")
        # what is written on a control is in its name
        assert not page.evaluate(
            """(controls) => [...document.querySelectorAll(controls)]
               .filter(({ tagName, textContent }) => tagName !== "SELECT" && /\\p{L}/u.test(textContent))
               .filter(({ ariaLabel, textContent }) => !(ariaLabel ?? textContent).includes(textContent))
               .map((each) => each.outerHTML)""",
            CONTROLS,
        )
    wanted = page.evaluate(
        """(controls) => [...document.querySelectorAll(controls)]
           .filter((each) => each.checkVisibility() && !each.disabled)
           .map((each, place) => { each.dataset.place = place; return place; })""",
        CONTROLS,
    )
    reached = set()
    for _ in range(len(wanted) + 5):
        page.keyboard.press("Tab")
        reached.add(page.evaluate("document.activeElement?.dataset.place"))
    assert {str(place) for place in wanted} <= reached
    live = page.locator("[role=status], [aria-live=polite], output:not([aria-live=off])")
    assert not {"time", "vitals", "pace"} & set(live.evaluate_all("(all) => all.map(({ id }) => id)"))

"""The texts of the pages: one complete table for each language, and no text outside the tables."""

import functools
import re
from importlib import resources
from typing import get_args

import pytest

from atmosbox import scenarios
from atmosbox.cli.option import Language
from atmosbox.page.controls import knob_controls, setting_controls
from atmosbox.page.document import LANGUAGES, words
from atmosbox.page.lesson import lesson_of
from atmosbox.page.word import card_of
from atmosbox.simulation.preparation import build, prepare

WEB = resources.files("atmosbox.page").joinpath("web")
SCRIPTS = {
    file.name: file.read_text(encoding="utf-8") for file in WEB.iterdir() if file.name.endswith((".js", ".html"))
}
GAP = re.compile(r"\{\w*\}")


def asked():
    """Return the keys that scripts and document use; for a key that is composed, its pattern."""
    text = "\n".join(SCRIPTS.values())
    keys = set(re.findall(r'\bword\("(\w+)"', text)) | set(re.findall(r'data-word(?:-\w+)?="(\w+)"', text))
    return keys | {name.lower() for name in re.findall(r"@@(WAIT|NO_SCRIPT|CANNOT_START)@@", text)}


@functools.cache
def said_by_scenes():
    """Return all texts of the scenes of atmosbox on a page with graphs: titles, curves, axes, settings."""
    found = set()
    for name in scenarios.names():
        prepared = prepare(name, {})
        module, settings = prepared.module, prepared.settings
        panels = module.panels(settings) if callable(module.panels) else module.panels
        found |= {module.title, (module.__doc__ or "").split("\n\n")[0].replace("\n", " ")}
        for panel in panels:
            found |= {panel.title, panel.x_label, panel.y_label} | {line.label for line in panel.lines}
            found |= {re.sub(r"[\d.]+", "{}", words) for _, _, words in panel.guides}
            found |= {"CAPE", "CIN"} if panel.areas else set()
        small = {"molecules": 200} if hasattr(settings, "molecules") else {}
        box = build(prepare(name, small))
        lesson = lesson_of(module)
        found |= {preset.title for preset in lesson.presets}
        found |= set(re.split(r"(?<=[.?]) ", lesson.story)) | set(lesson.predict["choices"])
        found |= {lesson.predict[part] for part in ("ask", "why")} | {lesson.task[part] for part in ("ask", "hint")}
        made = knob_controls(box.knobs) + setting_controls(settings.describe(), settings.as_dict(), ["seed"])
        found |= {control["label"] for control in made}
    return {text.replace("\u00a0", " ") for text in found if text and not text[0].isdigit()}


def test_the_command_line_offers_the_languages_that_there_are():
    shipped = {
        file.name.removesuffix(".toml") for file in resources.files("atmosbox.page").joinpath("language").iterdir()
    }
    assert set(LANGUAGES) == set(get_args(get_args(Language)[0])) == {"auto", *shipped}


@pytest.mark.parametrize("language", LANGUAGES[1:])
def test_a_table_has_all_words_with_the_same_gaps_and_no_other(language):
    english, table = words("en")["page"], words(language)["page"]
    assert set(table) == set(english)
    for key, text in english.items():
        assert sorted(GAP.findall(table[key])) == sorted(GAP.findall(text)), key
        assert '"' not in table[key]
        assert "<" not in table[key]


def test_every_word_that_the_page_asks_for_is_in_the_table_and_none_is_left_over():
    known = set(words("en")["page"])
    assert asked() <= known
    text = "\n".join(SCRIPTS.values())
    unused = {key for key in known - asked() if not re.search(rf'"{key}"', text)}
    put_together = {"box", "flat_box", "box_gravity", "flat_box_gravity"}
    walls = {"specular", "periodic", "heat_bath", "piston", "pool"}
    gauges = {"thermometer", "barometer", "hygrometer"}
    assert unused <= put_together | walls | gauges | {f"why_{name}" for name in gauges}


@pytest.mark.parametrize("language", ["de", "es"])
def test_all_that_scenes_say_on_a_page_is_translated(language):
    table = words(language)["phrase"]
    assert said_by_scenes() - set(table) == set()


@pytest.mark.parametrize("language", ["de", "es"])
def test_what_every_scene_models_and_leaves_out_is_translated(language):
    cards = {name: card_of(scenarios.load(name).__doc__ or "") for name in scenarios.names()}
    assert all(cards.values())
    assert {text for card in cards.values() for text in card.values()} == set(words(language)["card"])


@pytest.mark.parametrize("language", ["de", "es"])
def test_every_refusal_of_the_box_is_translated(language):
    refusals = re.findall(r"refuse\(((?!told).*?)\);", SCRIPTS["lab_worker.js"], re.DOTALL)
    told = {one or other for text in refusals for one, other in re.findall(r'`([^`]+)`|"([^"]+)"', text)}
    assert len(told) > 9
    assert {re.sub(r"\$\{[^}]*\}( \$\{[^}]*\})?", "{}", text) for text in told} <= set(words(language)["phrase"])


def test_terms_are_explained_that_a_graph_has_and_in_every_language():
    explained = {language: set(words(language)["gloss"]) for language in LANGUAGES[1:]}
    assert explained["en"] <= said_by_scenes()
    assert explained["de"] == explained["es"] == explained["en"]


def test_a_reader_gets_the_language_that_was_asked_for_or_that_of_the_browser(browser, site, run, tmp_path):
    from atmosbox.page import save

    seen = {}
    for name, language, locale in [
        ("asked", "de", "en-US"),
        ("own", "auto", "es-MX"),
        ("none", "auto", "fr-FR"),
    ]:
        path = save([run()], tmp_path / f"{name}.html", language=language)
        context = browser.new_context(locale=locale, reduced_motion="reduce")
        page = context.new_page()
        page.goto(path.as_uri())
        page.wait_for_selector("body[data-ready]")
        seen[name] = page.evaluate("[document.documentElement.lang, document.getElementById('trace').textContent]")
        text = page.locator("#graphs").inner_text()
        assert ("Geschwindigkeit" in text, "rapidez" in text.lower()) == (name == "asked", name == "own")
        context.close()
    assert seen == {"asked": ["de", "Verfolgen"], "own": ["es", "Seguir"], "none": ["en", "Trace"]}

"""Names and assignments as users spell them, and the words with which users are told things."""

import json
import re
from pathlib import Path

import pytest
from typer.main import get_command

from atmosbox import scenarios
from atmosbox.cli import app
from atmosbox.errors import SettingError
from atmosbox.file.dataset import VARIABLES
from atmosbox.scene.spelling import assignments, nearest

ROOT = Path(__file__).resolve().parents[1]


def test_the_nearest_name_is_the_one_that_was_meant():
    cases = [
        ("temprature", "temperature"),
        ("Temperature", "temperature"),
        ("pressure-top", "pressure_top"),
        ("temp", "temperature"),
        ("molecule", "molecules"),
        ("pressure", "pressure_top"),
        ("x", None),
        ("", None),
        ("\0" * 10**5, None),
    ]
    for name, meant in cases:
        assert nearest(name, ["molecules", "temperature", "pressure_top", "seed"]) == meant


def test_an_assignment_is_a_name_and_a_value():
    assert assignments(["temperature=25degC", " pressure-top = 300 hPa ", "title='a = b'", 'start="bottom"']) == {
        "temperature": "25degC",
        "pressure_top": "300 hPa",
        "title": "a = b",
        "start": "bottom",
    }


def test_what_is_no_assignment_is_refused_with_its_text():
    cases = [
        (["temperature"], 'temperature has no "=" between name and value: give temperature="value".'),
        (["=5"], '=5 has no name: give name="value".'),
        (["a="], 'a= has no value: give a="value".'),
        (["a=''"], "a='' has no value: give a=\"value\"."),
        (["a-b=1", "a_b=2"], "a_b = 2 is given twice: give a_b once."),
    ]
    for items, sentence in cases:
        with pytest.raises(SettingError) as caught:
            assignments(items)
        assert str(caught.value) == sentence


WORDS = {
    r"anew": "again",
    r"oftener": "more often",
    r"as good as": "nearly",
    r"put in(?! quotes)": "prescribed",
    r"misfits?": "difference",
    r"ledger": "energy budget",
    r"wells? give": "attraction",
    r"wish(es)?": "target",
    r"glance": "a quick test",
    r"lanes?": "numbers tested at once",
    r"ladders?|rungs?": "setting that was measured",
    r"furniture|outlook|pulse|pens?": "the name of the thing itself",
    r"random baths?|(?<!heat )baths? of": "thermostat, heat bath",
    r"within error\?": "agrees?",
    r"allowed: |\dσ *\+": "expected within",
    r"slowest mode": "left-right difference",
    r"with walls and size": "finite column and molecules",
    r"in floors of": "area as a multiple of that of the floor",
    r"than (it|the air) can hold": "than saturated air has",
    r"no fault of": "no error of",
    r"conspire": "extremely unlikely",
    r"outrun": "faster than",
    r"helps? out": "supplies part of",
    r"hand(ed|s)? on": "carried from molecule to molecule",
    r"out of nothing": "what it is made of",
    r"among (its|their) like": "molecules of the same kind",
    r"a matter of the": "depends on",
    r"at the price of": "against",
    r"and that is all": "and nothing else",
    r"nothing (that )?stands still": "molecules still condense and evaporate",
    r"check of neither": "tests nothing",
    r"(never|ever) part|part again": "separate",
    r"(never|ever) comes? to rest": "keeps fluctuating",
    r"updraughts?": "updraft",
    r"way of running": "engine and setting",
    r"next to no time": "a vanishing time",
    r"next to none": "hardly any",
    r"forgets? its": "no longer depends on",
    r"open air": "far from walls",
    r"figure of speech": "what happens",
    r"letting time pass": "to compute",
    r"memory of the gas": "the time in which the gas exchanges its energy",
    r"hands? over": "passes over",
    r"same work is": "from how many degrees of freedom the work is taken",
    r"who carries|who changes the": "what",
    r"another history": "grows in other steps",
    r"at the expense of": "gained from, takes from",
    r"as it comes": "with the default settings",
    r"in leaps": "in jumps",
    r"(at|in|with) even ratios": "in equal ratios",
    r"(minute|second|hour)s? buys?": "what more computing time gives",
    r"all the way up": "at every height",
    r"looks at it thousands": "tests it",
    r"proves? nothing by itself": "what it does not show",
}
"""Words and turns of phrase that a first-year student has to guess at, and what to say."""


def prose(text):
    """Return a text without code, links, what jobs have put between marks, and what the maker of a sheet fills in."""
    for part in (r"<!-- (?:table|number):.*?<!-- end -->", r"```.*?```", r"`[^`]*`", r"\]\([^)]*\)", r"\{\{.*?\}\}"):
        text = re.sub(part, " ", text, flags=re.DOTALL)
    return " ".join(text.split())


def texts():
    """Yield what a reader may see, with its place: pages, notebooks, cards, sheets, labels, help and variables."""
    for path in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(ROOT.glob("docs/**/*.md"))]:
        yield path.name, prose(path.read_text(encoding="utf-8"))
    for path in sorted(ROOT.glob("docs/notebooks/*.ipynb")):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        yield path.name, prose("\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "markdown"))
    for path in sorted(ROOT.glob("scenarios/*.toml")):
        yield path.name, prose(path.read_text(encoding="utf-8"))
    for name in scenarios.names():
        scene = scenarios.load(name)
        labels = [setting.help for setting in scene.Settings.describe()]
        for panel in scene.panels(scene.Settings()):
            labels += [panel.title, *(line.label for line in panel.lines)]
        yield f"{name}.py", prose("\n".join([scene.__doc__ or "", *labels]))
    group = get_command(app)
    for name, command in group.commands.items():
        helps = [command.help, *(getattr(parameter, "help", "") for parameter in command.params)]
        yield f"atmosbox {name} --help", prose("\n".join(filter(None, helps)))
    yield "variables.py", prose("\n".join(each.long_name for each in VARIABLES.values()))


def test_no_reader_has_to_guess_what_a_word_means():
    found = [
        f'{place}: "{match.group()}", say: {instead}'
        for place, text in texts()
        for word, instead in WORDS.items()
        for match in re.finditer(rf"\b(?:{word})(?!\w)", text, re.IGNORECASE)
    ]
    assert found == []

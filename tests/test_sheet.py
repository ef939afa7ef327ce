"""Sheets: every scene has one of two pages, with commands that run, units, and answers from its own runs."""

import base64
import functools
import gzip
import io
import re
import shlex
from pathlib import Path

import numpy as np
import pypdf
import pytest

from atmosbox import scenarios, theory
from atmosbox import sheet as sheets
from atmosbox.errors import ConfigError, FileError, SettingError, on_command_line
from atmosbox.page.document import phrase, words
from atmosbox.sheet.pdf import PAPERS, pdf
from atmosbox.sheet.sheet_run import Trial, execute
from atmosbox.sheet.sums import Measured, filled, measured, theoretical
from atmosbox.sheet.text import LANGUAGES, SECTIONS, read, text_of, translated
from atmosbox.simulation import runner
from tests.few_frames import FRAMES, few_frames_of
from tests.in_process import typed
from tests.oracle import moist_adiabat

ROOT = Path(__file__).resolve().parents[1]
NAMES = scenarios.names()

SMALL = {
    "attraction": {"molecules": 100, "duration": "0.2 ns"},
    "atmosphere": {"molecules": 60, "duration": 20},
    "condensation": {"molecules": 500, "duration": "20 ns"},
    "convection": {"molecules": 300, "duration": 60},
    "diffusion": {"molecules": 400},
    "elastic-collisions": {"duration": "6 s"},
    "evaporation": {"molecules": 1000, "pool": 200, "duration": "12 ns"},
    "lifting-dry": {"molecules": 200, "ascent": 100},
    "lifting-moist": {"molecules": 1000, "ascent": 400},
    "lifting-sounding": {"molecules": 1000, "ascent": 40},
    "mountains": {"molecules": 1000, "travel": 40},
    "nuclei": {"molecules": 1000, "duration": "10 ns"},
    "temperature": {"molecules": 50, "duration": "2 ns"},
    "temperature-large": {"molecules": 100, "duration": "2 ns"},
}
"""Runs that take a second, and report what the scene does."""


few_frames = few_frames_of(FRAMES)


@functools.cache
def blank(name):
    """Return the sheet of a scene as students get it."""
    return sheets.worksheet(name)


def commands_of(text):
    """Return letter and command of each run of a sheet."""
    return re.findall(r"^\*\*([A-D])\*\*, .*:\n\n```sh\n(.*)\n```$", text, re.MULTILINE)


def text_of_pdf(content):
    pages = [page.extract_text() for page in pypdf.PdfReader(io.BytesIO(content)).pages]
    return pages, " ".join(" ".join(pages).replace("\xa0", " ").split())


OWN = '''
"""Discs that nobody has written questions for. They fly {and meet}.

Modelled: discs. Left out: friction. Exaggerated: nothing.
"""

variant_of = "elastic-collisions"
defaults = {"duration": 2.0}
from atmosbox.scenarios.elastic_collisions import build, headlines, panels, theory
from atmosbox.scenarios.elastic_collisions import Settings as Others

Settings = Others.with_defaults(**defaults)
del variant_of
'''


@pytest.fixture
def own(tmp_path):
    path = tmp_path / "my_scene.py"
    path.write_text(OWN, encoding="utf-8")
    return path


@pytest.mark.parametrize(("name", "paper"), [*((name, "a4") for name in NAMES), ("lifting-dry", "letter")])
def test_the_sheet_of_every_scene_is_two_pages_whose_type_is_embedded(name, paper):
    sheet = blank(name)
    content, pages = pdf(sheet, paper)
    each, text = text_of_pdf(content)
    assert len(each) == pages <= 2
    assert f"{pages} / {pages}" in text
    assert all(command in text for _, command in commands_of(sheet.text))
    for heading in ("Goal", "Predict, before you run anything", "Run", "Measure", *SECTIONS.values(), "leaves out"):
        assert heading in text
    reader = pypdf.PdfReader(io.BytesIO(content))
    box = reader.pages[0].mediabox
    assert (float(box.width), float(box.height)) == pytest.approx(PAPERS[paper], abs=0.01)
    fonts = [font.get_object() for page in reader.pages for font in page["/Resources"]["/Font"].values()]
    used = [font for font in fonts if font["/Subtype"] == "/TrueType"]
    assert used
    assert all("/FontFile2" in font["/FontDescriptor"].get_object() for font in used)


@pytest.mark.parametrize("name", NAMES)
def test_the_commands_of_a_sheet_are_the_runs_that_it_means(name):
    commands = commands_of(sheets.worksheet(name, {"seed": 7}).text)
    assert "".join(letter for letter, _ in commands) in ("AB", "ABC", "ABCD")
    found = []
    for letter, command in commands:
        program, verb, scene, *words = shlex.split(command)
        assert (program, verb, scene) == ("atmosbox", "run", name)
        options = dict(zip(words[::2], words[1::2], strict=True))
        given = dict(
            word.split("=", 1) for option, word in zip(words[::2], words[1::2], strict=True) if option == "--set"
        )
        settings = runner.prepare(name, {**given, "seed": options["--seed"]}).settings
        assert options["--out"] == f"{name}-{letter}.nc"
        found.append(settings.as_dict())
    assert found[0] == runner.prepare(name, {"seed": 7}).settings.as_dict()
    for other in found[1:]:
        assert sum(other[key] != value for key, value in found[0].items()) == 1, "one thing is changed at a time"


@pytest.mark.parametrize("name", NAMES)
def test_the_rows_of_a_table_are_headlines_of_the_scene(name):
    first = runner.prepare(name, SMALL[name])
    words = read(text_of(first.module))
    (made,) = execute([Trial("A", "", first)])
    assert words["row"]
    for row in words["row"]:
        headline = filled(row["headline"], {"A": made})
        if headline not in made.headlines:  # a run with few molecules, or a fast one, may have no level to report
            assert headline in ("cloud_base", "lfc", "el", "cin", "cape", "mean_liquid_temperature", "metpy_cape")
            continue
        found = made.headlines[headline]
        assert row["unit"] == found.display_unit
        assert filled(row["label"], {"A": made}).startswith(found.label)
    for found in made.headlines.values():
        assert not found.tolerance or phrase("de", found.reason) != found.reason


@pytest.mark.parametrize("temperature", [0.0, 17.84, 30.0])
def test_the_latent_heat_in_the_answers_of_evaporation_is_that_of_theory(temperature):
    first = runner.prepare("evaporation", {"temperature": temperature})
    last = read(text_of(first.module))["further"][-1]
    run = {"A": Trial("A", "", first)}
    latent = float(moist_adiabat.water_latent_heat_vaporization(temperature + 273.15)) / 1e6
    (told,) = re.findall(r"([\d.]+) MJ/kg", filled(last["answer"], run))
    assert float(told) == pytest.approx(latent, abs=0.001)
    (carried,) = re.findall(r"takes (\d+) zJ", filled(last["ask"], run))
    edges = np.linspace(90e-21, 250e-21, 2001)
    density = theory.leaving_energy_density(edges, temperature + 273.15)
    mean = float((density * np.diff(edges) * 0.5 * (edges[1:] + edges[:-1])).sum())
    assert float(carried) == pytest.approx(mean * 1e21, abs=0.6)


@pytest.fixture(scope="module")
def answered():
    return sheets.worksheet("elastic-collisions", {"seed": 3}, answers=True)


def test_the_answers_are_numbers_of_the_runs_and_not_written_down(answered):
    light = answered.runs[0].fact("energy_of_light_discs")
    _, _, row, *_ = (line for line in answered.text.splitlines() if line.startswith("|"))
    _, _, letter, value, expected, misfit = (cell.strip() for cell in re.split(r"(?<!\\)\|", row)[1:-1])
    assert (letter, value) == ("A", measured(light.n, light.s))
    assert expected == theoretical(1.0, light.s)
    assert float(misfit.replace("−", "-")) == pytest.approx((light.n - 1.0) / light.s, abs=0.051)
    assert any(value in text for text in re.findall(r"^> (.+)$", answered.text, re.MULTILINE))
    assert "____" not in answered.text


def test_the_answers_tick_the_right_prediction_and_the_students_sheet_none(answered):
    assert re.findall(r"- \[x\] (.*)", answered.text) == ["4.5 times"]
    assert "☑ 4.5 times" in text_of_pdf(pdf(answered).content)[1]
    text = blank("elastic-collisions").text
    assert "- [ ] 4.5 times" in text
    assert "[x]" not in text


def test_a_scene_without_words_gets_a_sheet_from_its_card_and_headlines(own):
    sheet = sheets.worksheet(own)
    assert "Discs that nobody has written questions for. They fly {and meet}." in sheet.text
    assert "energy of a light disc / mean energy" in sheet.text
    assert "Left out: friction. Exaggerated: nothing." in sheet.text
    assert "--seed 2 --out my_scene-B.nc" in sheet.text
    assert pdf(sheet).pages <= 2
    answered = sheets.worksheet(own, answers=True).text
    assert "B minus A: energy of a light disc / mean energy: " in answered
    assert "±" in answered


def test_words_that_cannot_be_understood_are_refused_with_file_and_entry(own):
    cases = [
        ("goal = 3", "goal is not a text: put it in quotes"),
        ("goal = 'a'\nhurry = 'b'", "hurry is unknown"),
        ("goal = 'a'\n[[notice]]\nasks = 'b'", "notice 1, asks is unknown: correct the name"),
        ("goal = 'a'\n[[notice]]\nask = ' '", "notice 1, ask is empty"),
        ("goal = 'a'\n[notice]\nask = 'b'", "write [[notice]] with two brackets"),
        ("goal = 'a'\n[[notice]]\nask = 'b'\nlines = 99", "notice 1, lines"),
        ("goal = 'a'\n[[change]]\ntitle = 'b'", "change 1, set is missing"),
        ("goal = 'a'\n[[predict]]\nask = 'b'\nchoices = 'c'", "a list of texts for choices"),
        ("goal = 'a'\n[[predict]]\nask = 'b'\nchoices = ['c']\nright = 2", "right = 2"),
        ("goal = 'a'\n[[predict]]\nask = 'b'\nsketch = {x = 'c'}", "predict 1, sketch, y is missing"),
        ("goal = 'a'\n" + 4 * "[[change]]\ntitle = 'b'\nset = {seed = 3}\n", "keep 3"),
        ("goal = ", "is not TOML"),
        ("goal = '{{ A.molecule }}'", "goal: molecule is asked for before run A was made"),
        ("goal = 'a'\n[[change]]\ntitle = 'b'\nset = {seed = '{{ A.sed }}'}", "change 1, set, seed: sed is asked for"),
        ("goal = '{{ A.molecules'", "cannot be understood"),
        ("goal = '<script>alert(1)</script>'", "goal: the mark <script> is not printed"),
        ("goal = 'see <script>alert(1)</script>'", "the mark <script> is not printed"),
        ("goal = 'see ![a](b.png)'", "the mark image is not printed"),
        ("goal = '- a list'", "begins as a bullet list of Markdown does"),
    ]
    for written, said in cases:
        path = own.with_suffix(".sheet.toml")
        path.write_text(written, encoding="utf-8")
        with pytest.raises(ConfigError, match=re.escape(said)) as refused:
            sheets.worksheet(own)
        assert str(refused.value).startswith(str(path))
        assert "\n" not in str(refused.value)


class Run:
    """A run whose facts are known."""

    def __init__(self):
        x, y = Measured(3.0, 0.3, 2.0), Measured(4.0, 0.4)
        self.facts = {"x": x, "y": y, "n": 800, "s": [9.0, 1.0, 2.0, 3.0, 2.0]}

    def fact(self, name):
        return self.facts[name]


def test_a_sum_that_would_take_for_ever_is_refused_at_once():
    cases = [
        "{{ ().__class__.__base__.__subclasses__() }}", "{{ A.__class__ }}", "{{ A.x.__init__.__globals__ }}",
        "{{ A.fact.__func__ }}", "{{ round.__globals__ }}", "{{ self.__init__ }}", "{{ ''.format }}",
        "{{ __import__('os') }}", "{{ A['x'] }}", "{{ A|attr('fact') }}", "{% for i in range(10**9) %}x{% endfor %}",
        "{% include '/etc/passwd' %}", "{% set x = 1 %}", "{{ range(10**9) }}", "{{ lipsum(10**9) }}",
        "{{ 9 ** 9 ** 9 ** 9 }}", "{{ 'a' * 10 ** 10 }}", "{{ [1] * 10 ** 10 }}", "{{ '%0999999999d' % 1 }}",
        "{{ 'a'.ljust(10 ** 10) }}", "{{ " + 1900 * "(" + "1" + 1900 * ")" + " }}", "{{ " + 3900 * "-" + "1 }}",
        "{{ " + 5000 * "9" + " * 2 }}", "{{ " + 100_000 * "1+" + "1 }}", "{{ 1 / 0 }}", "{{ A }}", "{{ round }}",
    ]  # fmt: skip
    for sum in cases:
        with pytest.raises(ConfigError):
            filled(sum, {"A": Run()})


def test_a_sum_carries_its_error_and_knows_what_it_has_in_common_with_itself():
    names = {"A": Run()}
    assert filled("{{ A.x - A.y }}", names) == "−1.00 ± 0.50"
    assert filled("{{ A.x / A.y }}", names) == "0.75 ± 0.11"
    assert filled("{{ 2 * A.x }} {{ A.x ** 2 }}", names) == "6.00 ± 0.60 9.0 ± 1.8"
    assert filled("{{ A.x - A.x }} {{ (A.x + A.y) / A.x }}", names) == "0 2.33 ± 0.19"
    assert filled("{{ exp(A.x) }} {{ abs(A.x - A.y) }} {{ -A.x }}", names) == "20.1 ± 6.0 1.00 ± 0.50 −3.00 ± 0.30"
    assert filled("{{ A.x.theory }} {{ round(A.x.sigmas, 1) }} {{ A.x.misfit }}", names) == "2 3.3 1.00 ± 0.30"
    assert filled("{{ last(A.s) }} {{ mean(A.s) }} {{ highest(A.s) }} {{ A.n }}", names) == "2 2 9 800"
    assert filled("{{ word(A.x - A.y, 'warmer', 'colder') }} {as it is}", names) == "colder {as it is}"
    assert filled("{{ round(1, 10 ** 9) }}", names) == "1.000000000000"
    with pytest.raises(ConfigError, match="this number has no theory"):
        filled("{{ A.y.theory }}", names)


@pytest.mark.parametrize("name", ["temperature", "lifting-dry", "nuclei"])
def test_a_screen_reader_finds_headings_headers_names_and_descriptions_in_the_page_of_a_sheet(tmp_path, name):
    page = sheets.save(blank(name), tmp_path / "sheet.html").read_text(encoding="utf-8")
    tags = re.findall(r"<(\w+)([^>]*)>", page)
    levels = [int(tag[1]) for tag, _ in tags if re.fullmatch("h[1-6]", tag)]
    assert (levels[0], set(levels[1:])) == (1, {2})
    assert '<html lang="en">' in page
    headers = [attributes for tag, attributes in tags if tag == "th"]
    assert headers
    assert all("scope=" in attributes for attributes in headers)
    assert page.count('<th scope="row"></th>') == 0
    fields = re.findall(r"<label>(?:\w+: )?<input|<(?:textarea|input)[^>]* aria-label=", page)
    assert len(fields) == sum(tag in ("input", "textarea") for tag, _ in tags) > 4
    pictures = [attributes for tag, attributes in tags if tag in ("svg", "img")]
    assert all('role="img" aria-label="Empty axes' in attributes for attributes in pictures)
    assert "____" not in page


@pytest.mark.parametrize("scene", SMALL)
def test_a_sheet_for_pages_names_pages_and_graphs_and_nothing_that_is_typed(scene):
    made = sheets.worksheet(scene, SMALL[scene] | ({"ascent": 50} if scene == "lifting-dry" else {}), lab=True)
    assert "--" not in re.sub(r"-{3,}", "", made.text)
    assert "atmosbox" not in made.text
    assert "```sh" not in made.text
    assert [run.page for run in made.runs] == re.findall(r"open `(.+\.html)`", made.text)
    assert "logarithmic" not in made.text
    assert ("until it stops" in made.text) == scene.startswith(("lifting", "mountains"))
    rows = re.findall(r"^\| ([^|]*) \| ([^|]*) \| ([A-D]) \|", made.text, re.MULTILINE)
    shown = {run.letter: run.prepared.module.panels(run.prepared.settings) for run in made.runs}
    assert rows
    assert {graph for graph, _, _ in rows if graph} <= {panel.title for panel in shown["A"]}
    curve = ""
    for _, told, letter in rows:  # no run has a line of a curve that its page does not show
        curve = told or curve
        assert curve.partition(", at ")[0].partition(", in ")[0] in {
            line.label for panel in shown[letter] for line in panel.lines
        }


def test_pages_are_written_beside_their_sheet_or_nothing_is(tmp_path):
    out = tmp_path / "sheet.md"
    asked = ["sheet", "elastic-collisions", "--lab", "--set", "molecules=20", "--out", str(out)]
    (tmp_path / "elastic-collisions-B.html").touch()
    assert typed(*asked).exit_code != 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["elastic-collisions-B.html"]
    told = typed(*asked, "--force")
    assert told.exit_code == 0, told.output
    pages = [tmp_path / f"elastic-collisions-{letter}.html" for letter in "ABC"]
    assert told.stdout.split() == [str(path) for path in (out, *pages)]
    stored = re.search(r'id="stored"[^>]*>([^<]+)<', pages[1].read_text(encoding="utf-8"))[1]
    assert b"mass_ratio=1000.0 --seed 1" in gzip.decompress(base64.b64decode(stored))
    # a second sheet uses the same pages
    again = typed(*asked[:-1], str(tmp_path / "again.md"))
    assert again.exit_code == 0, again.output


def kept_in_a_translation(found, place=""):
    """Return by place what a text has in every language: sums, without their words in quotes, and what is typed."""
    if isinstance(found, str):
        kept = re.findall(r"\{\{.*?\}\}|`.*?`", found)
        return {place: sorted(re.sub(r"'[^']*'|\"[^\"]*\"", "", each) for each in kept)}
    entries = found.items() if isinstance(found, dict) else enumerate(found) if isinstance(found, list) else ()
    return {k: v for key, each in entries for k, v in kept_in_a_translation(each, f"{place} {key}").items()}


@pytest.mark.parametrize("name", NAMES)
def test_the_german_text_of_a_scene_has_the_entries_and_sums_of_the_english_one(name):
    path = text_of(scenarios.load(name))
    english, german = read(path), read(path, "de")
    assert kept_in_a_translation(german) == kept_in_a_translation(english)
    for part in ("goal", "constants", "leaves_out"):
        assert german[part] != english[part] or not english[part]
    for part in ("predict", *SECTIONS):
        for one, other in zip(english[part], german[part], strict=True):
            assert one["ask"] != other["ask"]
    text = re.sub(r"\{\{.*?\}\}", "", translated(path, "de").read_text(encoding="utf-8"))
    assert not re.search(r"\d,\d", text), "numbers have a decimal point, as those of the program"


def test_all_that_the_layout_says_is_translated():
    code = "\n".join(path.read_text(encoding="utf-8") for path in Path(sheets.__file__).parent.glob("*.[pj]*"))
    asked = set(re.findall(r'said\("([^"]+)"\)|"([^"]+)" \| said', code))
    lists = re.findall(r'\[(.+)\] \| map\("said"\)', code)
    told = {one or other for one, other in asked} | {each for one in lists for each in re.findall('"([^"]+)"', one)}
    assert len(told) > 30
    table = words("de")
    assert told | set(SECTIONS.values()) <= set(table["sheet"]) | set(table["phrase"])
    for english, german in table["sheet"].items():
        assert german.count("{}") == english.count("{}")


@pytest.mark.parametrize("kind", [{"answers": True}, {"lab": True}, {}])
def test_a_german_sheet_has_no_english_words_of_the_layout(tmp_path, kind):
    made = sheets.worksheet("elastic-collisions", {"duration": "6 s"}, language="de", **kind)
    page = sheets.save(made, tmp_path / "sheet.html").read_text(encoding="utf-8")
    assert '<html lang="de">' in page
    page = re.sub(r"<(style|code)[^>]*>.*?</\1>", "", page, flags=re.DOTALL)
    for english, german in words("de")["sheet"].items():
        if english != german:
            assert not re.search(rf"(?<!\w){re.escape(english.partition('{')[0])}(?!\w)", page), english
    assert "9.8 ist 9,8" in page or made.answers
    assert pdf(made).pages <= 3


def test_a_sheet_in_a_language_that_its_scene_has_not_is_refused_with_one_sentence(own, tmp_path):
    assert set(LANGUAGES) == {"en", *(each for each in ("de", "es") if "sheet" in words(each))}
    with pytest.raises(SettingError, match="language = fr is unknown: give en or de"):
        sheets.worksheet("lifting-dry", language="fr")
    with pytest.raises(FileError) as refused:
        sheets.worksheet(own, language="de")
    assert refused.value.said(on_command_line) == (
        "This scene has no worksheet in German (no file generic.sheet.de.toml): leave --language out."
    )
    own.with_suffix(".sheet.toml").write_text("goal = 'a'\n[[notice]]\nask = 'b'\nlines = 3", encoding="utf-8")
    path = own.with_suffix(".sheet.de.toml")
    for written, said in [
        ("goal = 'c'", "notice is missing or has other entries than the English file"),
        ("goal = 'c'\nnotice = []", "notice is missing or has other entries"),
        ("goal = 'c'\n[[notice]]\nanswer = 'd'", "notice 1, answer is not a text of the English file: remove it"),
        ("goal = 'c'\n[[notice]]\nask = 'd'\nlines = 3", "notice 1, lines is not a text of the English file"),
        ("goal = 'c'\n[[notice]]\nask = '{{ A.molecule }}'", "notice 1, ask: molecule is asked for before"),
    ]:
        path.write_text(written, encoding="utf-8")
        with pytest.raises(ConfigError, match=re.escape(f"{path}: {said}")):
            sheets.worksheet(own, language="de")
    path.write_text("goal = 'c'\n[[notice]]\nask = 'd'", encoding="utf-8")
    told = typed("sheet", str(own), "--language", "de", "--out", str(tmp_path / "sheet.md"))
    assert told.exit_code == 0, told.output
    text = (tmp_path / "sheet.md").read_text(encoding="utf-8")
    assert text.count("____\n") == 4
    assert "**1.** d" in text

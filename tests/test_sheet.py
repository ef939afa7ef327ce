"""Sheets: every scene has one that fills two pages, with commands that run, units, and answers from its own runs."""

import io
import os
import re
import shlex
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pypdf
import pytest
from typer.testing import CliRunner

from atmosbox import scenarios
from atmosbox import sheet as sheets
from atmosbox.cli import app
from atmosbox.errors import ConfigError, FileError, PhysicsError, SettingError
from atmosbox.sheet.arithmetic import Measured, filled
from atmosbox.sheet.block import Answer, Blank, Commands, Kept, Measurements, Text
from atmosbox.sheet.markdown import markdown
from atmosbox.sheet.number_text import bare, measured, spelled, theoretical
from atmosbox.sheet.pdf import PAPERS, load_fonts, pdf
from atmosbox.sheet.sheet_run import Trial, execute, trials
from atmosbox.sheet.text import SECTIONS, read, text_of
from atmosbox.simulation import runner

ROOT = Path(__file__).resolve().parents[1]
NAMES = scenarios.names()

SMALL = {
    "atmosphere": {"molecules": 60, "duration": 20},
    "condensation": {"molecules": 500, "duration": "20 ns"},
    "elastic-collisions": {"duration": "6 s"},
    "evaporation": {"molecules": 1000, "pool": 200, "duration": "12 ns"},
    "lifting-dry": {"molecules": 200, "ascent": 100},
    "lifting-moist": {"molecules": 1000, "ascent": 400},
    "lifting-sounding": {"molecules": 2000, "ascent": 40},
    "mountains": {"molecules": 2000, "travel": 40},
    "temperature": {"molecules": 50, "duration": "2 ns"},
    "temperature-large": {"molecules": 100, "duration": "2 ns"},
}
"""Runs that take a second, and report what the scene does."""


def flat(blocks):
    """Yield all blocks, those that are kept together one by one."""
    for block in blocks:
        if isinstance(block, Kept):
            yield from flat(block.blocks)
        else:
            yield block


def text_of_pdf(content):
    pages = [page.extract_text() for page in pypdf.PdfReader(io.BytesIO(content)).pages]
    return pages, " ".join(" ".join(pages).replace("\xa0", " ").split())


def command_line(*words, folder):
    command = [sys.executable, "-m", "atmosbox", "sheet", *words]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=False)


OWN = '''
"""Discs that nobody has written questions for. They fly {and meet}.

Modelled: discs. Left out: friction. Exaggerated: nothing.
"""

variant_of = "elastic-collisions"
defaults = {"duration": 6.0}
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


@pytest.mark.parametrize("paper", PAPERS)
@pytest.mark.parametrize("name", NAMES)
def test_the_sheet_of_every_scene_is_at_most_two_pages(name, paper):
    sheet = sheets.worksheet(name)
    content, pages = pdf(sheet, paper)
    each, text = text_of_pdf(content)
    assert len(each) == pages
    assert 1 <= pages <= 2
    assert f"{pages} / {pages}" in text
    for block in flat(sheet.blocks):
        if isinstance(block, Commands):
            assert block.lines[0] in text
    for heading in ("Goal", "Predict, before you run anything", "Run", "Measure", *SECTIONS.values(), "leaves out"):
        assert heading in text
    box = pypdf.PdfReader(io.BytesIO(content)).pages[0].mediabox
    assert (float(box.width), float(box.height)) == pytest.approx(PAPERS[paper], abs=0.01)


@pytest.mark.parametrize("name", NAMES)
def test_every_sign_of_a_sheet_is_in_its_embedded_type(name):
    content = pdf(sheets.worksheet(name)).content
    fonts = [font.get_object() for page in pypdf.PdfReader(io.BytesIO(content)).pages
             for font in page["/Resources"]["/Font"].values()]  # fmt: skip
    assert fonts
    used = [font for font in fonts if font["/Subtype"] == "/TrueType"]
    assert used
    assert all("/FontFile2" in font["/FontDescriptor"].get_object() for font in used)
    from matplotlib import get_data_path
    from matplotlib.ft2font import FT2Font

    known = FT2Font(str(Path(get_data_path()) / "fonts" / "ttf" / "DejaVuSans.ttf")).get_charmap()
    assert {sign for sign in markdown(sheets.worksheet(name)) if ord(sign) not in known} <= {"\n"}


@pytest.mark.parametrize("name", NAMES)
def test_the_commands_of_a_sheet_are_the_runs_that_it_means(name):
    sheet = sheets.worksheet(name, {"seed": 7})
    commands = [block for block in flat(sheet.blocks) if isinstance(block, Commands)]
    assert [block.letter for block in commands] == list("ABCD"[: len(commands)])
    assert len(commands) >= 2
    found = []
    for block in commands:
        program, verb, scene, *words = shlex.split(block.lines[0])
        assert (program, verb, scene) == ("atmosbox", "run", name)
        options = dict(zip(words[::2], words[1::2], strict=True))
        given = dict(
            word.split("=", 1) for option, word in zip(words[::2], words[1::2], strict=True) if option == "--set"
        )
        settings = runner.prepare(name, {**given, "seed": options["--seed"]}).settings
        assert options["--out"] == f"{name}-{block.letter}.nc"
        found.append(settings.as_dict())
    assert found[0] == runner.prepare(name, {"seed": 7}).settings.as_dict()
    for other in found[1:]:
        assert sum(other[key] != value for key, value in found[0].items()) == 1, "one thing is changed at a time"


@pytest.mark.parametrize("name", NAMES)
def test_the_rows_of_a_table_are_headlines_of_the_scene(name):
    first = runner.prepare(name, SMALL[name])
    words = read(text_of(first.module))
    (made,) = execute([Trial("A", "", first)])
    assert words.rows
    for row in words.rows:
        headline = filled(row.headline, {"A": made})
        if headline not in made.headlines:  # few molecules, or a hurried run, may have no level to report
            assert headline in ("cloud_base", "lfc", "el", "cin", "cape", "mean_liquid_temperature", "metpy_cape")
            continue
        found = made.headlines[headline]
        assert row.unit == found.display_unit
        assert filled(row.label, {"A": made}).startswith(found.label)


@pytest.mark.parametrize("name", NAMES)
def test_every_question_has_an_answer_and_room_to_write_one(name):
    words = read(text_of(scenarios.load(name)))
    assert set(words.questions) == set(SECTIONS)
    for section in words.questions.values():
        assert section
        assert all(question.answer and question.lines for question in section)
    assert words.predict
    for prediction in words.predict:
        assert prediction.answer
        assert prediction.choices or prediction.sketch or prediction.lines
    assert words.goal.count(". ") <= 2
    assert words.leaves_out


def test_the_words_of_a_sheet_stand_beside_every_scene_and_the_file_of_no_scene_is_left():
    beside = {path.name.removesuffix(".sheet.toml") for path in (ROOT / "scenarios").glob("*.sheet.toml")}
    assert beside == {name.replace("-", "_") for name in NAMES}


@pytest.fixture(scope="module")
def answered():
    return sheets.worksheet("elastic-collisions", {"seed": 3}, answers=True)


def test_the_answers_are_numbers_of_the_runs_and_not_written_down(answered):
    first = runner.prepare("elastic-collisions", {"seed": 3})
    (run,) = execute(trials(first, []))
    light = run.fact("energy_of_light_discs")
    (table,) = [block for block in flat(answered.blocks) if isinstance(block, Measurements)]
    line = table.rows[0][2][0]
    assert line.measured == measured(light.value, light.error)
    assert line.theory == theoretical(1.0, light.value, light.error)
    assert float(line.misfit.replace("−", "-")) == pytest.approx((light.value - 1.0) / light.error, abs=0.051)
    answers = [block.text for block in flat(answered.blocks) if isinstance(block, Answer)]
    assert any(measured(light.value, light.error) in text for text in answers)
    assert not any(isinstance(block, Blank) for block in flat(answered.blocks))
    other = markdown(sheets.worksheet("elastic-collisions", {"seed": 4}, answers=True))
    assert measured(light.value, light.error) not in other


def test_the_answers_fit_on_two_pages_and_are_marked_as_such(answered):
    content, pages = pdf(answered)
    assert pages <= 2
    text = text_of_pdf(content)[1]
    assert "Elastic collisions: answers" in text
    assert "Name:" not in text


def test_no_break_parts_a_question_from_its_answer_or_the_runs_of_a_quantity(answered, monkeypatch):
    monkeypatch.setitem(PAPERS, "short", (PAPERS["a4"][0], 260.0))
    content, pages = pdf(answered, "short")
    assert pages >= 6
    each = [" ".join(page.replace("\xa0", " ").split()) for page in text_of_pdf(content)[0]]

    def where(text):
        return {number for number, page in enumerate(each) if text in page}

    asked = [block for block in answered.blocks if isinstance(block, Kept)]
    parted = 0
    for kept in asked:
        answers = [block.text for block in kept.blocks if isinstance(block, Answer)]
        numbers = [re.match(r"\*\*(\d+\.)\*\* (.{12})", block.text) for block in kept.blocks if isinstance(block, Text)]
        if answers and any(numbers):
            (number,) = [match for match in numbers if match]
            parted += 1
            assert where(f"{number[1]} {number[2]}") & where(answers[0][:20]), number[0]
    assert parted >= 9
    (table,) = [block for block in flat(answered.blocks) if isinstance(block, Measurements)]
    for label, _, lines in table.rows:
        cells = " ".join(" ".join(filter(None, (line.run, line.measured, line.theory, line.misfit))) for line in lines)
        assert any(label in page and cells in page for page in each), label


def test_the_students_sheet_gives_nothing_away():
    sheet = sheets.worksheet("elastic-collisions")
    assert not any(isinstance(block, Answer) for block in flat(sheet.blocks))
    (table,) = [block for block in flat(sheet.blocks) if isinstance(block, Measurements)]
    assert all(line.measured == line.theory == line.misfit == "" for _, _, lines in table.rows for line in lines)


def test_the_same_sheet_gives_the_same_bytes(tmp_path):
    again = [command_line("temperature", "--out", f"{number}.pdf", folder=tmp_path) for number in (1, 2)]
    assert [done.returncode for done in again] == [0, 0]
    assert again[0].stdout == "1.pdf\n"
    first, second = ((tmp_path / f"{number}.pdf").read_bytes() for number in (1, 2))
    assert first == second
    assert pdf(sheets.worksheet("temperature")).content == first
    assert pdf(sheets.worksheet("temperature")).content == first
    assert str(tmp_path).encode() not in first


@pytest.mark.parametrize("name", NAMES)
def test_markdown_is_well_formed(name):
    text = markdown(sheets.worksheet(name))
    assert text.count("\n# ") + text.startswith("# ") == 1
    assert text.count("```") % 2 == 0
    lines = text.splitlines()
    rows = [line for line in lines if line.startswith("|")]
    cells = {len(re.split(r"(?<!\\)\|", row)) for row in rows}
    assert cells == {8}
    assert re.fullmatch(r"\| quantity .*", rows[0])
    numbers = [int(found) for found in re.findall(r"^\*\*(\d+)\.\*\*", text, re.MULTILINE)]
    assert numbers == list(range(1, len(numbers) + 1))
    assert "{" not in text
    assert not re.search(r"[\^_]\(", text)


def test_units_stand_beside_the_quantities():
    text = markdown(sheets.worksheet("lifting-dry"))
    assert "temperature at 700 hPa [°C]" in text
    assert "lapse rate of the first kilometre [K km⁻¹]" in text


def test_what_is_set_stands_in_texts_and_commands_of_all_runs():
    text = markdown(sheets.worksheet("temperature", {"molecules": 100, "temperature": "0 degC"}, engine="dsmc"))
    assert "100 molecules of air" in text
    assert "between walls of 0 °C" in text
    assert "--set molecules=100 --set temperature=0degC --engine dsmc --out temperature-A.nc" in text
    assert "--set molecules=400 --set temperature=0degC --engine dsmc --out temperature-B.nc" in text
    assert "engine dsmc" in text


def test_answers_say_where_their_words_may_not_fit():
    sheet = sheets.worksheet("elastic-collisions", {"molecules": 20, "duration": "20 s"}, answers=True)
    assert "the words of the answers are for the scene as it comes" in markdown(sheet)
    dry = {"molecules": 100, "ascent": 20, "top_pressure": "500 hPa"}
    text = markdown(sheets.worksheet("lifting-dry", dry, answers=True))
    assert "Written for the scene as it comes" in text
    assert "temperature at 500 hPa" in text


def test_a_change_that_changes_nothing_is_refused():
    with pytest.raises(ConfigError, match="Run B of this sheet sets rotation=False, and so does run A"):
        sheets.worksheet("lifting-dry", {"rotation": False})


def test_a_scene_without_words_gets_a_sheet_from_its_card_and_headlines(own):
    blank = markdown(sheets.worksheet(own))
    assert "Discs that nobody has written questions for. They fly {and meet}." in blank
    assert "energy of a light disc over the mean" in blank
    assert "Left out: friction. Exaggerated: nothing." in blank
    assert "--seed 2 --out my_scene-B.nc" in blank
    assert pdf(sheets.worksheet(own, {"seed": 5})).pages <= 2
    answered = markdown(sheets.worksheet(own, answers=True))
    assert "B less A: energy of a light disc over the mean: " in answered
    assert "±" in answered


def test_the_example_of_the_pages_has_words_of_its_own():
    text = markdown(sheets.worksheet(ROOT / "docs" / "examples" / "my_scene.py"))
    assert "A vacuum flask keeps coffee hot" in text
    assert "--set pressure=0.005Pa" in text


@pytest.mark.parametrize(
    ("written", "said"),
    [
        ("goal = 3", "the sheet needs a text goal"),
        ("goal = 'a'\nhurry = 'b'", "the sheet does not know hurry"),
        ("goal = 'a'\n[[notice]]\nasks = 'b'", "needs a text ask"),
        ("goal = 'a'\n[notice]\nask = 'b'", "two brackets"),
        ("goal = 'a'\n[[notice]]\nask = 'b'\nlines = 99", "from 0 to 12"),
        ("goal = 'a'\n[[change]]\ntitle = 'b'", "needs the setting that it changes"),
        ("goal = 'a'\n[[predict]]\nask = 'b'\nchoices = 'c'", "a list of texts"),
        ("goal = 'a'\n[[predict]]\nask = 'b'\nsketch = {x = 'c'}", "needs a text y"),
        ("goal = ", "is not TOML"),
        ("goal = '{A.molecule}'", "before run A was made"),
        ("goal = '{A.molecules'", "cannot be filled in"),
        ("goal = '{().__class__}'", "is none of its sums"),
        ("goal = '{__import__(\"os\")}'", "is none of its sums"),
        ("goal = '{9 ** 9 ** 9 ** 9}'", "cannot be filled in"),
    ],
)
def test_words_that_cannot_be_understood_are_refused_with_their_file(own, written, said):
    own.with_suffix(".sheet.toml").write_text(written, encoding="utf-8")
    with pytest.raises(ConfigError, match=re.escape(said)):
        sheets.worksheet(own)


def test_a_sum_carries_its_error():
    class Run:
        def fact(self, name):
            return {"x": Measured(3.0, 0.3, 2.0), "y": Measured(4.0, 0.4), "n": 800, "s": [9.0, 1.0, 2.0, 3.0, 2.0]}[
                name
            ]

    names = {"A": Run()}
    assert filled("{A.x - A.y}", names) == "−1.00 ± 0.50"
    assert filled("{A.x / A.y}", names) == "0.75 ± 0.11"
    assert filled("{2 * A.x} {A.x ** 2}", names) == "6.00 ± 0.60 9.0 ± 1.8"
    assert filled("{A.x.theory} {A.x.sigmas:.1f} {A.x.misfit}", names) == "2.00 3.3 1.00 ± 0.30"
    assert filled("{last(A.s)} {mean(A.s)} {highest(A.s)} {A.n}", names) == "2.00 2.00 9.00 800"
    assert filled("{word(A.x - A.y, 'warmer', 'colder')} {{as it is}}", names) == "colder {as it is}"
    with pytest.raises(ConfigError, match="theory says nothing"):
        filled("{A.y.theory}", names)


def test_numbers_and_units_are_printed_as_in_print():
    assert bare(0.0) == "0"
    assert bare(4.44e-15) == "4.44·10⁻¹⁵"
    assert bare(999.96) == "1000"
    assert measured(288.149, 0.0) == "288"
    assert measured(float("nan"), 1.0) == "–"
    assert spelled("percent") == "%"
    assert spelled("K km-1") == "K km⁻¹"


def test_a_file_appears_whole_and_replaces_nothing_unasked(tmp_path, monkeypatch):
    sheet = sheets.worksheet("temperature")
    path = sheets.save(sheet, tmp_path / "sheet", "md")
    assert path.name == "sheet.md"
    assert path.read_text(encoding="utf-8") == markdown(sheet)
    with pytest.raises(FileError, match="exists already: add --force"):
        sheets.save(sheet, path)
    sheets.save(sheet, path, force=True)
    with pytest.raises(SettingError, match="does not go with the file name"):
        sheets.check(path, "pdf", force=True)
    with pytest.raises(SettingError, match="paper = a5 is unknown"):
        sheets.check(tmp_path / "a.pdf", paper="a5")
    (tmp_path / "b.pdf").mkdir()
    with pytest.raises(FileError, match="is a folder"):
        sheets.check(tmp_path / "b.pdf")
    with pytest.raises(FileError, match="does not exist"):
        sheets.check(tmp_path / "no" / "a.pdf")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(FileError, match="disk has no room"):
        sheets.save(sheet, tmp_path / "c.md")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["b.pdf", "sheet.md"]


def test_the_command_says_the_path_and_refuses_in_a_sentence(tmp_path):
    done = command_line("lifting-dry", "--format", "md", "--seed", "7", folder=tmp_path)
    assert (done.returncode, done.stdout) == (0, "lifting-dry-sheet.md\n")
    assert "--seed 7" in (tmp_path / "lifting-dry-sheet.md").read_text(encoding="utf-8")
    again = command_line("lifting-dry", "--format", "md", folder=tmp_path)
    assert again.returncode == 2
    assert again.stderr.startswith("error: lifting-dry-sheet.md exists already: add --force to replace it")
    wrong = command_line("lifting-dry", "--set", "temperature=25m", folder=tmp_path)
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert "is a length" in wrong.stderr
    nobody = command_line("lifting-wet", folder=tmp_path)
    assert nobody.returncode == 2
    assert sorted(each.name for each in tmp_path.iterdir()) == ["lifting-dry-sheet.md"]


def test_without_reportlab_a_pdf_is_refused_before_a_run_is_spent_and_markdown_is_not(tmp_path, monkeypatch):
    load_fonts.cache_clear()
    for name in [each for each in sys.modules if each.split(".")[0] == "reportlab"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "reportlab", None)
    with pytest.raises(FileError, match="type pip install reportlab, or give --format md"):
        sheets.check(tmp_path / "sheet.pdf")
    assert sheets.check(tmp_path / "sheet.md") == tmp_path / "sheet.md"
    monkeypatch.undo()
    load_fonts()


def test_ctrl_c_writes_nothing(tmp_path, monkeypatch):
    def stopped(*_, **__):
        raise runner.Interrupted(None)

    monkeypatch.setattr(runner, "execute", stopped)
    words = ["sheet", "elastic-collisions", "--answers", "--out", str(tmp_path / "a.pdf")]
    assert CliRunner().invoke(app, words).exit_code == 130
    assert list(tmp_path.iterdir()) == []


def test_a_run_whose_energy_is_not_accounted_for_gives_no_sheet(monkeypatch):
    honest = runner.execute
    monkeypatch.setattr(runner, "execute", lambda *a, **k: honest(*a, **k)._replace(ledger=1e-3))
    with pytest.raises(PhysicsError, match="The energy ledger of run A is off by 1e-03"):
        sheets.worksheet("elastic-collisions", {"duration": "2 s"}, answers=True)


def test_a_run_that_disagrees_with_theory_is_named(monkeypatch):
    honest = runner.execute

    def off(*words, **named):
        found = honest(*words, **named)
        return found._replace(headlines=tuple(replace(each, value=each.value + 1.0) for each in found.headlines))

    monkeypatch.setattr(runner, "execute", off)
    sheet = sheets.worksheet("elastic-collisions", answers=True)
    assert "Run A disagrees with theory: largest change of the energy." in sheet.disagreements
    assert "Run A disagrees with theory: largest change of the energy." in markdown(sheet)

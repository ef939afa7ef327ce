import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read


def cell(lines, line, column, value):
    """Return lines with one cell of one line, counted from 1, replaced."""
    cells = lines[line - 1].split(",")
    cells[column] = str(value)
    return [*lines[: line - 1], ",".join(cells), *lines[line:]]


P, Z, T, TD = range(4)


@pytest.mark.parametrize("column", [P, T])
def test_a_level_without_pressure_or_temperature_is_left_out(written, csv_lines, column):
    sounding = read(written(cell(csv_lines, 6, column, -9999)))
    assert len(sounding) == 11
    assert sounding.remarks[0] == "1 level without pressure or temperature left out."


def test_a_level_without_dewpoint_below_one_that_has_it_is_left_out(written, csv_lines):
    sounding = read(written(cell(csv_lines, 6, TD, -9999)))
    assert len(sounding) == 11
    assert "1 level without dewpoint below one that has it left out." in sounding.remarks


def test_levels_above_the_highest_dewpoint_are_kept_dry(written, csv_lines):
    sounding = read(written(cell(cell(csv_lines, 13, TD, -9999), 12, TD, "")))
    assert len(sounding) == 12
    assert list(sounding.temperature[-2:] - sounding.dewpoint[-2:]) == [30.0, 30.0]
    assert sounding.temperature[-3] - sounding.dewpoint[-3] < 30.0
    assert "Above 300 hPa no dewpoint: taken 30 K below the temperature." in sounding.remarks


def test_a_level_that_is_given_twice_is_taken_once(written, csv_lines, same_as):
    sounding = read(written([*csv_lines[:6], csv_lines[5], *csv_lines[6:]]))
    same_as(sounding)
    assert "1 level given twice taken once." in sounding.remarks


def test_two_levels_of_the_same_pressure_that_differ_are_refused(written, csv_lines):
    twice = cell([*csv_lines[:6], csv_lines[5], *csv_lines[6:]], 7, T, 3.3)
    with pytest.raises(SoundingError, match="line 7: the pressure of 800 hPa is that of the level before it"):
        read(written(twice))


def test_a_wide_gap_is_remarked(written, csv_lines):
    del csv_lines[7]
    assert read(written(csv_lines)).remarks == ("The widest gap below 300 hPa, 200 hPa, is from 700 to 500 hPa.",)


def test_lines_and_not_levels_are_named_when_levels_are_left_out(written, csv_lines):
    lines = cell(cell(csv_lines, 4, T, ""), 9, TD, 30)
    with pytest.raises(SoundingError, match=r"ascent\.txt, line 9: the dewpoint of 30 degC is above the temperature"):
        read(written(lines))


def test_the_line_is_right_in_a_file_from_the_top_down(written, csv_lines):
    lines = [csv_lines[0], *reversed(csv_lines[1:])]
    with pytest.raises(SoundingError, match=r"line 4: the dewpoint of 30 degC is above the temperature"):
        read(written(cell(lines, 4, TD, 30)))


def test_a_table_without_a_column_is_refused(written, csv_lines):
    header = csv_lines[0].replace("T [degC],Td", "x [degC],Td")
    with pytest.raises(SoundingError, match="line 1: there is no temperature: name its column temperature"):
        read(written([header, *csv_lines[1:]]))


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda line: f"{line[P]},{line[Z]},,{line[TD]}", "no level has both pressure and temperature"),
        (lambda line: f"{line[P]},{line[Z]},{line[T]},", "no level has pressure, temperature and dewpoint"),
    ],
)
def test_a_table_without_values_is_refused(written, csv_lines, change, sentence):
    with pytest.raises(SoundingError, match=sentence):
        read(written([csv_lines[0], *(change(line.split(",")) for line in csv_lines[1:])]))


def test_a_table_without_levels_is_refused(written, csv_lines):
    with pytest.raises(SoundingError, match="no level has both pressure and temperature"):
        read(written(csv_lines[:1]))


def test_four_levels_are_too_few(written, csv_lines):
    with pytest.raises(SoundingError, match="line 5: the sounding ends after 4 of at least 5 levels"):
        read(written(csv_lines[:5]))
    with pytest.raises(SoundingError, match="line 2: the sounding ends after 1 of at least 5 levels"):
        read(written(csv_lines[:2]))


def test_a_wrong_unit_is_recognised(written, csv_lines):
    cases = [
        ("T [K]", r"line 2: a temperature of 25\.\d K does not occur in the atmosphere and looks like degC: name"),
        ("T [degF]", None),  # -55 degF and 77 degF occur in the atmosphere too
        ("Td [K]", r"line 2: a dewpoint of 23\.\d K does not occur in the atmosphere and looks like degC: name"),
        (
            "p [Pa]",
            r"line 2: a pressure of 990 Pa at the ground does not occur in the atmosphere and looks like hPa: name",
        ),
        ("p [kPa]", r"line 2: a pressure of 990 kPa does not occur in the atmosphere and looks like hPa: name"),
    ]
    for wrong, sentence in cases:
        name = wrong.split()[0] + " "
        header = ",".join(wrong if cell.startswith(name) else cell for cell in csv_lines[0].split(","))
        with pytest.raises(SoundingError, match=sentence or "above the temperature"):
            read(written([header, *csv_lines[1:]]))


def test_kelvins_called_degrees_celsius_are_recognised(written, csv_lines):
    with pytest.raises(SoundingError, match=r"a temperature of 298 C does .* looks like K: .* .temperature \[K\]"):
        read(written(["p_hPa,T_C,Td_C", "1000,298,290", "850,288,280", "700,278,270", "500,260,250", "300,230,215"]))


def test_a_single_wrong_value_is_no_question_of_units(written, csv_lines):
    with pytest.raises(SoundingError, match=r"line 5: a temperature of 225 degC does not .* \(-113.15 to 61.85 degC\)"):
        read(written(cell(csv_lines, 5, T, 225)))

import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read

KELVIN = 273.15


def table(levels, header, row, separator=","):
    return [separator.join(header), *(separator.join(str(x) for x in row(*level)) for level in levels)]


def test_usual_names_units_and_separators_are_understood(written, levels, same_as):
    for separator in [",", ";", "\t", ", ", " ; "]:
        cases = [
            ["pressure [hPa]", "height [m]", "temperature [degC]", "dewpoint [degC]"],
            ["Pressure (mb)", "HEIGHT (m)", "Temp (°C)", "Dew point (°C)"],
            ["pres_hPa", "hght_m", "T_C", "Td_C"],
            ["p/hPa", "z/m", "T/degC", "Td/degC"],
            ["pressure_hPa", "geopotential height_m", "temperature_C", "dew point temperature_C"],
            ['"air_pressure {millibars}"', "alt [gpm]", "tair [celsius]", "dewpoint_temperature [degree_Celsius]"],
        ]
        for header in cases:
            same_as(read(written(table(levels, header, lambda *level: level, separator), "a.csv")))


def test_columns_may_stand_in_any_order_among_others(written, levels, same_as):
    header = ["time [s]", "Td [K]", "RH", "T [degC]", "p [Pa]"]
    lines = table(levels, header, lambda p, z, t, td: (1, td + KELVIN, 50, t, p * 100))
    same_as(read(written(lines)))


def test_units_may_stand_in_the_second_row(written, levels, same_as):
    lines = table(levels, ["pressure", "height", "temperature", "dewpoint"], lambda *level: level)
    for units in ("hPa,m,degC,degC", "[hPa],[m],[degC],[degC]", "hPa;m;degC;degC"):
        separator = ";" if ";" in units else ","
        rows = [line.replace(",", separator) for line in lines]
        same_as(read(written([rows[0], units, *rows[1:]])))


def test_comments_and_blank_lines_are_skipped(written, csv_lines, same_as):
    same_as(read(written(["# by hand", "", csv_lines[0], "# the ground", *csv_lines[1:], "", ",,,"])))


def test_the_names_may_stand_in_a_comment(written, csv_lines, same_as):
    same_as(read(written(["# " + csv_lines[0], *csv_lines[1:]])))


def test_blanks_may_separate(written, levels, same_as):
    lines = table(levels, ["p_hPa", "z_m", "T_C", "Td_C"], lambda *level: level, "   ")
    same_as(read(written(lines)))


def test_lines_of_a_description_may_precede_the_names(written, csv_lines, same_as):
    same_as(read(written(["Station: Nowhere, pressure and all", "Operator: N. N.", *csv_lines])))


def test_the_usual_marks_of_missing_values_are_understood(written, csv_lines):
    for mark in ["", "NaN", "-9999", "-9999.00", "-999", "9999", "999.9", "M", "null", "--", "////"]:
        cells = csv_lines[5].split(",")
        csv_lines[5] = ",".join([*cells[:2], mark, cells[3]])
        sounding = read(written(csv_lines))
        assert len(sounding) == 11
        assert 800e2 not in sounding.pressure


def test_a_refusal_names_the_line_the_value_and_the_fix(written, csv_lines):
    cases = [
        (("850.0", "high"), "line 5: the pressure high is not a number"),
        (("850.0", "inf"), "line 5: the pressure inf is not finite"),
        (("850.0", "1e999"), "line 5: the pressure 1e999 is too large"),
        (("850.0", "1_000"), "line 5: the pressure 1_000 is not a number"),
        (("T [degC]", "T"), "line 1: the temperature has no unit"),
        (("T [degC]", "T [warm]"), "line 1: the unit warm of the temperature is not known"),
        (("T [degC]", "T [hPa]"), "line 1: hPa is not a unit of temperature"),
        (("Td [degC]", "RH [%]"), "line 1: there is no dewpoint"),
        (("z [m]", "p [Pa]"), "line 1: p .Pa. is a second column of pressure"),
    ]
    for change, sentence in cases:
        with pytest.raises(SoundingError, match=sentence) as caught:
            read(written([line.replace(*change) for line in csv_lines]))
        assert str(caught.value).count("\n") == 0
        assert ": " in str(caught.value).split(sentence[:20])[-1]


def test_a_decimal_comma_is_refused(written, csv_lines):
    lines = [line.replace(",", ";") for line in csv_lines]
    lines[3] = lines[3].replace(".", ",")
    with pytest.raises(SoundingError, match=r"line 4: the pressure 900,0 is written with a comma: write a decimal"):
        read(written(lines))


def test_too_few_and_too_many_cells_are_refused(written, csv_lines):
    with pytest.raises(SoundingError, match="line 5: there are 2 of 4 columns"):
        read(written([*csv_lines[:4], "850.0,1457.0", *csv_lines[5:]]))
    with pytest.raises(SoundingError, match="line 5: there are 5 columns, but 4 names"):
        read(written([*csv_lines[:4], csv_lines[4] + ",7", *csv_lines[5:]]))


def test_a_cell_or_a_line_of_great_length_is_refused_and_not_taken_for_names(written, csv_lines):
    with pytest.raises(SoundingError, match="line 5: there are 1 of 4 columns"):
        read(written([*csv_lines[:4], "1" * 200_000, *csv_lines[5:]]))
    with pytest.raises(SoundingError, match="begins no sounding that is known"):
        read(written([csv_lines[0] + "," * 10_000, *csv_lines[1:]]))


def test_a_text_without_names_is_not_recognised(written, csv_lines):
    with pytest.raises(SoundingError, match="begins no sounding that is known"):
        read(written(csv_lines[1:]))

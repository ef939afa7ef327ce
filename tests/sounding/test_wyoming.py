import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read


def page(lines, title="99999 XYZ Nowhere &amp; Co Observations at 00Z 01 Feb 2003"):
    head = ["<HTML>", "<TITLE>University of Wyoming - Radiosonde Data</TITLE>", f"<H2>{title}</H2>", "<PRE>"]
    tail = [
        "</PRE><H3>Station information and sounding indices</H3><PRE>",
        "                         Station identifier: XYZ",
        "                             Station number: 99999",
        "          Convective Available Potential Energy: 1234.56",
        "</PRE>",
        "</BODY></HTML>",
    ]
    return [*head, *lines, *tail]


def test_a_table_is_read_without_the_level_below_the_ground(written, wyoming_lines, same_as):
    sounding = read(written(wyoming_lines))
    same_as(sounding)
    assert sounding.name == "ascent"
    assert sounding.source.endswith("ascent.txt, table of the University of Wyoming")
    assert sounding.remarks == ("1 level without pressure or temperature left out.",)


def test_the_saved_page_is_read_with_its_title(written, wyoming_lines, same_as):
    sounding = read(written(page(wyoming_lines), "page.html"))
    same_as(sounding)
    assert sounding.name == "99999 XYZ Nowhere & Co Observations at 00Z 01 Feb 2003"


def test_the_page_copied_as_text_is_read_up_to_its_indices(written, wyoming_lines, same_as):
    title = "99999 XYZ Nowhere Observations at 00Z 01 Feb 2003"
    tail = ["Station information and sounding indices", "", "           Station identifier: XYZ"]
    sounding = read(written([title, "", *wyoming_lines, *tail]))
    same_as(sounding)
    assert sounding.name == title


def test_blank_cells_are_missing_values(written, wyoming_lines):
    wyoming_lines[-1] = wyoming_lines[-1][:21]  # neither dewpoint nor wind at the top
    wyoming_lines[-4] = wyoming_lines[-4][:42] + " " * 14 + wyoming_lines[-4][56:]  # no wind
    sounding = read(written(wyoming_lines))
    assert len(sounding) == 12
    assert sounding.dewpoint[-1] == pytest.approx(sounding.temperature[-1] - 30.0)
    assert "Above 200 hPa no dewpoint: taken 30 K below the temperature." in sounding.remarks


def test_columns_that_lost_their_places_are_read_if_none_is_blank(written, wyoming_lines, same_as):
    same_as(read(written([" ".join(line.split()) for line in wyoming_lines if "-17" not in line])))


def test_a_blank_cell_in_a_line_that_lost_its_places_is_refused(written, wyoming_lines):
    wyoming_lines[8] = " ".join(wyoming_lines[8].split()[1:])
    with pytest.raises(SoundingError, match="line 9: the numbers do not stand below the names of the columns"):
        read(written(wyoming_lines))


def test_the_first_of_several_tables_is_taken(written, wyoming_lines, same_as):
    second = [line.replace("990.0", "980.0") for line in wyoming_lines]
    sounding = read(written([*page(wyoming_lines), *page(second)]))
    same_as(sounding)
    assert sounding.remarks[0] == "The first of 2 soundings in the file taken."


def test_a_word_among_the_numbers_is_refused(written, wyoming_lines):
    wyoming_lines[6] = wyoming_lines[6].replace(wyoming_lines[6][14:21], "   warm")
    with pytest.raises(SoundingError, match="line 7: the temperature warm is not a number"):
        read(written(wyoming_lines))


def test_a_table_without_units_is_refused(written, wyoming_lines):
    with pytest.raises(SoundingError, match="line 2: no line of units"):
        read(written(wyoming_lines[:2]))


def test_the_csv_of_the_university_is_read(written, levels, same_as):
    header = (
        "time,longitude,latitude,pressure_hPa,geopotential height_m,temperature_C,dew point temperature_C,"
        "ice point temperature_C,relative humidity_%,humidity wrt ice_%,mixing ratio_g/kg,wind direction_degree,"
        "wind speed_m/s"
    )
    rows = [
        f"2026-07-22 23:{k:02d}:05,-97.4400,35.1800,{p},{z},{t},{td},{td},55,,9.1,160,9.3"
        for k, (p, z, t, td) in enumerate(levels)
    ]
    same_as(read(written([header, *rows])))
    blank = rows[-1].split(",")
    blank[6:11] = [""] * 5  # no humidity at the top
    sounding = read(written([header, *rows[:-1], ",".join(blank)]))
    assert "Above 200 hPa no dewpoint: taken 30 K below the temperature." in sounding.remarks

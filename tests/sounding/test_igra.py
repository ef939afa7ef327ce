"""The files of the radiosonde archive of NOAA."""

import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read

LEVELS = [  # major and minor type, pressure [Pa], height [m], temperature and dewpoint depression [0.1 K]
    (2, 1, 97200, 345, 243, 51),
    (1, 0, 92500, 782, 212, 42),
    (2, 0, 86000, -9999, 176, 64),
    (1, 0, 85000, 1510, 180, 85),
    (1, 0, 70000, 3150, 88, 120),
    (3, -9, -9999, 4000, -9999, -9999),
    (1, 0, 50000, 5860, -77, 150),
    (1, 0, 30000, 9600, -341, -8888),
    (1, 0, 20000, 12300, -545, -9999),
]


def header(number, hour="00"):
    return f"#USM00072357 2014 09 10 {hour} 2301 {number:4d} ncdc-gts ncdc-gts  352211   -974647"


def row(major, minor, pressure, height, temperature, depression):
    """Return a record as ``igra2-data-format.txt`` lays it out: RH, wind and flags stand between what is read."""
    kind = f"{major}{minor}" if minor >= 0 else f"{major}0"
    return f"{kind} {-9999:5d} {pressure:6d}B{height:5d}B{temperature:5d}B{-9999:5d} {depression:5d} {160:5d} {51:5d} "


@pytest.fixture
def lines():
    return [header(len(LEVELS)), *(row(*level) for level in LEVELS)]


def test_columns_stand_where_the_description_of_the_archive_has_them(lines):
    first = lines[1]
    assert first[9:15] == " 97200"  # PRESS, columns 10 to 15
    assert first[16:21] == "  345"  # GPH, 17 to 21
    assert first[22:27] == "  243"  # TEMP, 23 to 27
    assert first[34:39] == "   51"  # DPDP, 35 to 39


def test_records_of_the_archive_itself_are_read(written):
    """The first five of 66 levels of a sounding over Edwards, California."""
    text = """
#USM00072381 2026 07 22 17 1700    5 ncdc-gts ncdc-gts  349167 -1179000
21 -9999  93200B-9999   336B-9999   230   240    46
20 -9999  92700 -9999   314B-9999   210 -9999 -9999
10 -9999  92500   798B  316B-9999   210   275    46
10 -9999  85000  1541B  244B-9999   160   300    26
20 -9999  80300 -9999   206B-9999   130 -9999 -9999
"""
    sounding = read(written([f"{line} " for line in text.split("\n")[1:-1]]))
    assert sounding.name == "USM00072381 2026-07-22 17 UTC"
    assert list(sounding.pressure) == [93200.0, 92700.0, 92500.0, 85000.0, 80300.0]
    assert list(sounding.temperature - 273.15) == pytest.approx([33.6, 31.4, 31.6, 24.4, 20.6])
    assert list(sounding.temperature - sounding.dewpoint) == pytest.approx([23.0, 21.0, 21.0, 16.0, 13.0])


def test_a_sounding_is_read_with_its_missing_values(written, lines):
    sounding = read(written(lines))
    assert sounding.name == "USM00072357 2014-09-10 00 UTC"
    assert [round(p / 100) for p in sounding.pressure] == [972, 925, 860, 850, 700, 500, 300, 200]
    assert sounding.temperature[0] - 273.15 == pytest.approx(24.3)
    assert sounding.dewpoint[0] - 273.15 == pytest.approx(19.2)
    assert sounding.temperature[-1] - sounding.dewpoint[-1] == pytest.approx(30.0)
    assert sounding.source.endswith("IGRA version 2")
    assert sounding.remarks[0] == "1 level without pressure or temperature left out."


def test_of_a_file_of_years_the_first_sounding_is_taken(written, lines):
    other = [header(1, hour="12"), row(2, 1, 96000, 345, 100, 50)]
    sounding = read(written(lines + other))
    assert len(sounding) == 8
    assert sounding.remarks[0] == "The first of 2 soundings in the file taken."


def test_a_file_that_is_cut_off_is_refused(written, lines):
    for cut in [1, 3, 8]:
        with pytest.raises(SoundingError, match=f"the header announces 9 levels, and {9 - cut} are there"):
            read(written(lines[:-cut]))


@pytest.mark.parametrize("levels", ["    ", "1  2"])
def test_a_header_without_the_number_of_levels_is_refused(written, lines, levels):
    assert lines[0][32:36] == "   9"
    with pytest.raises(SoundingError, match="line 1: the header does not say how many levels"):
        read(written([lines[0][:32] + levels + lines[0][36:], *lines[1:]]))


def test_a_line_that_is_cut_off_or_no_number_is_refused(written, lines):
    with pytest.raises(SoundingError, match=r"line 3: the line is cut off"):
        read(written([*lines[:2], lines[2][:30], *lines[3:]]))
    with pytest.raises(SoundingError, match=r"line 3: the temperature x212 is not a number"):
        read(written([*lines[:2], lines[2].replace("  212", " x212"), *lines[3:]]))

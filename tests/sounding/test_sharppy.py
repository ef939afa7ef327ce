import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read


def test_a_file_is_read_without_the_level_below_the_ground(written, sharppy_lines, same_as):
    sounding = read(written(sharppy_lines))
    same_as(sounding)
    assert sounding.name == "XYZ 010203/0000 10.00,-20.00"
    assert sounding.source.endswith("ascent.txt, SHARPpy text")
    assert sounding.remarks == ("1 level without pressure or temperature left out.",)


def test_a_file_without_title_has_the_name_of_the_file(written, sharppy_lines, same_as):
    sounding = read(written(sharppy_lines[5:]))
    same_as(sounding)
    assert sounding.name == "ascent"


def test_the_columns_are_those_of_the_header(written, sharppy_lines, same_as):
    sharppy_lines[3] = sharppy_lines[3].replace("LEVEL       HGHT", "LEVEL       HGHT       OMEG")
    first = sharppy_lines.index("%RAW%") + 1
    for i in range(first, len(sharppy_lines) - 1):
        cells = sharppy_lines[i].split(",")
        sharppy_lines[i] = ",".join([*cells[:2], " 0.01", *cells[2:]])
    same_as(read(written(sharppy_lines)))


def test_blank_lines_and_comments_are_skipped(written, sharppy_lines, same_as):
    sharppy_lines[8:8] = ["", "# by hand"]
    same_as(read(written(sharppy_lines)))


def test_a_file_that_is_cut_off_is_refused(written, sharppy_lines):
    with pytest.raises(SoundingError, match="there is no %END%, so the file is cut off"):
        read(written(sharppy_lines[:-1]))


def test_a_line_that_is_cut_off_is_refused(written, sharppy_lines):
    sharppy_lines[9] = sharppy_lines[9].rpartition(",")[0]
    with pytest.raises(SoundingError, match="line 10: there are 5 of 6 columns"):
        read(written(sharppy_lines))

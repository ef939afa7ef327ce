"""Reading: the content tells the format, in any usual encoding; what is no sounding is refused in a sentence."""

import os

import pytest

from atmosbox.errors import FileError, SoundingError
from atmosbox.scene.sounding import read, reading


def test_the_content_and_not_the_suffix_tells_the_format(written, wyoming_lines, sharppy_lines, csv_lines, same_as):
    for lines, kind in ((wyoming_lines, "Wyoming"), (sharppy_lines, "SHARPpy"), (csv_lines, "CSV")):
        for name in ("a.csv", "a.html", "a.nc", "a"):
            sounding = read(written(lines, name))
            same_as(sounding)
            assert kind in sounding.source


def test_any_usual_encoding_and_line_end_is_read(written, csv_lines, same_as):
    for encoding in ["utf-8", "utf-8-sig", "latin-1", "utf-16"]:
        for end in ["\n", "\r\n", "\r"]:
            text = end.join(["# Zürich", *csv_lines]).replace("degC", "°C")
            same_as(read(written(text.encode(encoding))))


def test_what_is_no_sounding_is_refused_in_a_sentence(written):
    cases = [
        (b"", "does not begin a sounding of a known format"),
        (b"\x00\x01\x02\x03" * 9, "is not a text"),
        (b"p,T,Td\n\x01\x02", "is not a text"),
        (b"\xff\xfe\x00\xd8\x00\x00\x00", "is not a text"),
        (b"\n\n  once upon a time", "line 3: once upon a time does not begin a sounding of a known format"),
    ]
    for content, sentence in cases:
        path = written(content)
        with pytest.raises(SoundingError, match=sentence) as caught:
            read(path)
        assert str(caught.value).startswith(str(path))
        assert str(caught.value).endswith(".")
        assert "\n" not in str(caught.value)


def test_what_is_no_file_or_a_huge_one_is_refused_before_it_is_read(tmp_path, monkeypatch):
    path = tmp_path / "huge.csv"
    with path.open("wb") as file:
        file.truncate(100_000_000)
    if os.name != "nt":
        os.mkfifo(tmp_path / "pipe")
    monkeypatch.setattr(reading.Path, "read_bytes", lambda path: pytest.fail("the file was read"))
    for name, said in [
        ("huge.csv", "has 100 MB"),
        ("", "is not a file"),
        ("pipe", "is not a file"),
        ("none", "is not a file"),
    ]:
        with pytest.raises(FileError, match=said):
            read(tmp_path / name)


def test_a_text_of_too_many_lines_is_refused(written, csv_lines, same_as):
    same_as(read(written([*csv_lines, *[""] * (reading.MOST_LINES - len(csv_lines) - 1)])))
    with pytest.raises(SoundingError, match="has far more lines, or longer ones, than a sounding"):
        read(written([*csv_lines, *[""] * reading.MOST_LINES]))

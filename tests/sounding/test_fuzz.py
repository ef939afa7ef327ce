"""Whatever is in a file, the result is a valid sounding or one sentence, and never a traceback."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.errors import AtmosboxError
from atmosbox.scene.sounding import Sounding, read
from tests.fuzz_case import fuzz_case

numbers = st.one_of(
    st.floats().map(repr),
    st.floats(-100.0, 1100.0).map(lambda x: f"{x:.1f}"),
    st.sampled_from(["-9999.00", "", "1e999", "nan", "1,5", "999.9", "M", "0", "-0", "1000", "850.0", "298", "25"]),
)
names = st.sampled_from([
    "p", "pressure [hPa]", "T [degC]", "T_K", "Td", "Td (K)", "dewpoint [degC]", "z [m]", "HGHT", "TEMP", "RH", "#",
    "",
])  # fmt: skip
units = st.sampled_from(["hPa", "degC", "K", "m", "Pa", "degF", "blorp", "m**-99", "°C", ""])
separators = st.sampled_from([",", ";", "\t", " ", ", ", "   "])
rows = st.builds(lambda cells, separator: separator.join(cells), st.lists(st.one_of(numbers, units, names)), separators)
marks = st.sampled_from([
    "%TITLE%", "%RAW%", "%END%", "<PRE>", "</PRE>", "-" * 30, "   PRES   HGHT   TEMP   DWPT",
    "    hPa     m      C      C ", " 1000.0    100   20.0   10.0", "  900.0   1000   15.0    5.0",
    "pressure [hPa],temperature [degC],dewpoint [degC]", "1000, 25, 17", "   LEVEL  HGHT TEMP DWPT",
])  # fmt: skip
texts = st.lists(st.one_of(marks, rows, st.text(max_size=30)), max_size=25).map("\n".join)

GOOD = "p [hPa],T [degC],Td [degC]\n1000,25,17\n850,15,9\n700,5,-3\n500,-10,-25\n300,-40,-60\n"


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz") / "ascent.csv"


def outcome(path, content):
    """Return the sounding in a file, or None after checking that it was refused with one sentence."""
    path.write_bytes(content)
    try:
        with fuzz_case("soundings"):
            sounding = read(path)
    except AtmosboxError as error:
        sentence = str(error)
        assert sentence.isprintable()
        assert sentence.endswith(".")
        assert str(path) in sentence
        assert len(sentence) < 500 + len(str(path))
        return None
    assert isinstance(sounding, Sounding)
    columns = [sounding.pressure, sounding.temperature, sounding.dewpoint]
    assert all(np.isfinite(column).all() for column in columns)
    assert np.all(np.diff(sounding.pressure) < 0.0)
    assert np.all(sounding.dewpoint <= sounding.temperature)
    assert len(sounding) >= 5
    return sounding


@settings(max_examples=400)
@given(
    content=st.one_of(
        texts.map(lambda text: text.encode("utf-8", "surrogatepass")),
        st.binary(max_size=200),
        st.binary(max_size=60).map(lambda b: b"\x89HDF\r\n\x1a\n" + b),
    )
)
def test_no_content_breaks_the_reader(path, content):
    outcome(path, content)


@settings(max_examples=300)
@given(
    place=st.integers(0, len(GOOD)),
    length=st.integers(0, 12),
    graft=st.one_of(st.text(max_size=8), numbers, marks),
)
def test_no_change_of_a_good_file_breaks_the_reader(path, place, length, graft):
    text = GOOD[:place] + graft + GOOD[place + length :]
    outcome(path, text.encode("utf-8", "surrogatepass"))


def test_the_fuzz_reaches_a_sounding(path):
    assert len(outcome(path, GOOD.encode())) == 5
    assert outcome(path, GOOD.replace("850", "1850").encode()) is None

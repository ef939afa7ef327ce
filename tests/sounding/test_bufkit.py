"""Forecasts in the format of BUFKIT."""

import pytest

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read

NAMES = ["PRES", "TMPC", "TMWC", "DWPC", "THTE", "DRCT", "SKNT", "OMEG", "CFRL", "HGHT"]
LEVELS = [  # PRES, TMPC, DWPC, HGHT
    (965.80, 22.24, 18.84, 357.2),
    (900.00, 18.94, 16.10, 970.0),
    (850.00, 16.00, 12.50, 1490.0),
    (700.00, 7.00, -2.00, 3120.0),
    (500.00, -9.00, -24.00, 5810.0),
    (300.00, -35.00, -50.00, 9520.0),
    (200.00, -53.00, -9999.00, 12200.0),
]


def block(time, levels=LEVELS):
    """Return the forecast of one hour as NAMSND writes it: eight values in a line, then the others of the level."""
    lines = [
        f"STID = KOUN STNM = 723570 TIME = {time}",
        "SLAT = 35.23 SLON = -97.47 SELV = 357.0",
        "STIM = 0",
        "",
        "SHOW = -2.47 LIFT = -3.72 SWET = 330.26 KINX = 33.07",
        "LCLP = 905.12 PWAT = 41.75 TOTL = 48.60 CAPE = 1534.00",
        "",
        " ".join(NAMES[:8]),
        " ".join(NAMES[8:]),
    ]
    for pressure, temperature, dewpoint, height in levels:
        lines.append(f"{pressure:.2f} {temperature:.2f} 0.00 {dewpoint:.2f} 340.00 180.00 12.00 -0.10")
        lines.append(f"0.00 {height:.2f}")
    return [*lines, ""]


@pytest.fixture
def lines():
    return [
        f"SNPARM = {';'.join(NAMES)}",
        "STNPRM = SHOW;LIFT;SWET;KINX;LCLP;PWAT;TOTL;CAPE",
        "",
        *block("140910/0000"),
        *block("140910/0100", [(p, t + 1.0, d, z) for p, t, d, z in LEVELS]),
        "STN YYMMDD/HHMM PMSL PRES SKTC",
        "723570 140910/0000 1010.90 965.80 22.24",
    ]


def test_the_first_hour_of_a_forecast_is_read(written, lines):
    sounding = read(written(lines))
    assert sounding.name == "KOUN 140910/0000"
    assert [round(p / 100, 1) for p in sounding.pressure] == [level[0] for level in LEVELS]
    assert sounding.temperature[1] - 273.15 == pytest.approx(18.94)
    assert sounding.dewpoint[1] - 273.15 == pytest.approx(16.10)
    assert sounding.source.endswith("BUFKIT")
    assert sounding.remarks[0] == "The first of 2 soundings in the file taken."


def test_a_forecast_as_a_service_issued_it_is_read(written):
    """The first levels for Missoula, Montana, by the model GFS: a station without letters, nine values in a level."""
    text = """
SNPARM = PRES;TMPC;TMWC;DWPC;THTE;DRCT;SKNT;OMEG;HGHT
STNPRM = SHOW;LIFT;SWET;KINX;LCLP;PWAT;TOTL;CAPE;LCLT;CINS;EQLV;LFCT;BRCH

STID = STNM = 727730 TIME = 170401/0600
SLAT = 46.92 SLON = -114.08 SELV = 972.0
STIM = 0

SHOW = 10.91 LIFT = 11.42 SWET = 28.88 KINX = -4.19
LCLP = 835.07 PWAT = 9.62 TOTL = 34.84 CAPE = 0.00
LCLT = 272.59 CINS = 0.00 EQLV = -9999.00 LFCT = -9999.00
BRCH = 0.00

PRES TMPC TMWC DWPC THTE DRCT SKNT OMEG
HGHT
906.90 5.94 3.47 0.58 299.79 234.46 3.34 -1.50
993.65
901.80 6.34 3.74 0.75 300.94 234.46 3.34 -1.50
1039.88
895.90 6.74 3.97 0.84 302.11 233.13 2.91 -1.50
1093.76
889.30 7.04 4.08 0.77 303.12 225.00 2.74 -1.50
1154.54
881.90 6.84 3.87 0.53 303.51 216.03 2.64 -1.50
1223.24
"""
    sounding = read(written([f"{line} " for line in text.splitlines()]))
    assert sounding.name == "727730 170401/0600"
    assert list(sounding.pressure) == pytest.approx([90690.0, 90180.0, 89590.0, 88930.0, 88190.0])
    assert list(sounding.temperature - 273.15) == pytest.approx([5.94, 6.34, 6.74, 7.04, 6.84])
    assert list(sounding.dewpoint - 273.15) == pytest.approx([0.58, 0.75, 0.84, 0.77, 0.53])


def test_values_may_be_laid_out_in_other_lines(written, lines):
    laid = read(written(lines))
    start = lines.index("PRES TMPC TMWC DWPC THTE DRCT SKNT OMEG")
    end = start + 2 + 2 * len(LEVELS)
    joined = [" ".join(lines[k : k + 2]) for k in range(start, end, 2)]
    again = read(written([*lines[:start], *joined, *lines[end:]]))
    assert again.temperature.tobytes() == laid.temperature.tobytes()


def test_a_forecast_that_is_cut_off_or_lacks_a_column_is_refused(written, lines):
    start = lines.index("PRES TMPC TMWC DWPC THTE DRCT SKNT OMEG")
    with pytest.raises(SoundingError, match="8 of 10 values of a level are there, so the sounding is cut off"):
        read(written(lines[: start + 2 + 5]))
    with pytest.raises(SoundingError, match="line 1: there is no dewpoint"):
        read(written([line.replace("DWPC", "RELH") for line in lines]))
    with pytest.raises(SoundingError, match="no table has the columns"):
        read(written(lines[:start]))

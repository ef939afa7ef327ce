"""Soundings of archives and programs: what a file holds is read, and what is cut off or wrong is refused.

The formats are those of Wyoming, SHARPpy, IGRA, BUFKIT, netCDF, and tables with separators.
"""

import numpy as np
import pytest
import xarray as xr

from atmosbox.errors import SoundingError
from atmosbox.scene.sounding import read

# Wyoming


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


def test_a_table_of_the_university_and_its_saved_page_are_read(written, wyoming_lines, same_as):
    """The level below the ground is left out, and of two tables the first is taken."""
    second = [line.replace("990.0", "980.0") for line in wyoming_lines]
    title = "99999 XYZ Nowhere & Co Observations at 00Z 01 Feb 2003"
    for lines, name, first in [
        (wyoming_lines, "ascent", False),
        (page(wyoming_lines), title, False),
        ([*page(wyoming_lines), *page(second)], title, True),
    ]:
        sounding = read(written(lines))
        same_as(sounding)
        assert sounding.name == name
        assert sounding.source.endswith("ascent.txt, table of the University of Wyoming")
        remarks = ["The first of 2 soundings in the file taken."] if first else []
        assert sounding.remarks == (*remarks, "1 level without pressure or temperature left out.")


def test_blank_cells_are_missing_values(written, wyoming_lines):
    wyoming_lines[-1] = wyoming_lines[-1][:21]  # neither dewpoint nor wind at the top
    wyoming_lines[-4] = wyoming_lines[-4][:42] + " " * 14 + wyoming_lines[-4][56:]  # no wind
    sounding = read(written(wyoming_lines))
    assert len(sounding) == 12
    assert sounding.dewpoint[-1] == pytest.approx(sounding.temperature[-1] - 30.0)
    assert "Above 200 hPa no dewpoint: taken 30 K below the temperature." in sounding.remarks


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


# SHARPpy


def test_a_text_of_sharppy_is_read_without_the_level_below_the_ground(written, sharppy_lines, same_as):
    sounding = read(written(sharppy_lines))
    same_as(sounding)
    assert sounding.name == "XYZ 010203/0000 10.00,-20.00"
    assert sounding.source.endswith("ascent.txt, SHARPpy text")
    assert sounding.remarks == ("1 level without pressure or temperature left out.",)


# IGRA

EDWARDS = """
#USM00072381 2026 07 22 17 1700    7 ncdc-gts ncdc-gts  349167 -1179000
21 -9999  93200B-9999   336B-9999   230   240    46
20 -9999  92700 -9999   314B-9999   210 -9999 -9999
10 -9999  92500   798B  316B-9999   210   275    46
10 -9999  85000  1541B  244B-9999   160   300    26
20 -9999  80300 -9999   206B-9999   130 -9999 -9999
30 -9999  -9999  4000B-9999 -9999 -9999   160    51
10 -9999  70000  3150B   88B-9999 -8888   160    51
"""
"""The first levels of a sounding over Edwards, California; the last two, made up, are of wind and without dewpoint."""


@pytest.fixture
def lines():
    return [f"{line} " for line in EDWARDS.split("\n")[1:-1]]


def test_a_sounding_is_read_with_its_missing_values(written, lines):
    sounding = read(written(lines))
    assert sounding.name == "USM00072381 2026-07-22 17 UTC"
    assert sounding.source.endswith("IGRA version 2")
    assert list(sounding.pressure) == [93200.0, 92700.0, 92500.0, 85000.0, 80300.0, 70000.0]
    assert list(sounding.temperature - 273.15) == pytest.approx([33.6, 31.4, 31.6, 24.4, 20.6, 8.8])
    assert list(sounding.temperature - sounding.dewpoint) == pytest.approx([23.0, 21.0, 21.0, 16.0, 13.0, 30.0])
    assert sounding.remarks[0] == "1 level without pressure or temperature left out."


# BUFKIT

MISSOULA = """
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
"""The first levels for Missoula, Montana, by the model GFS: a station without letters, nine values in a level."""


@pytest.fixture
def missoula():
    return [f"{line} " for line in MISSOULA.split("\n")]


def test_a_forecast_as_a_service_issued_it_is_read_and_of_two_hours_the_first(written, missoula):
    begin = next(k for k, line in enumerate(missoula) if line.startswith("STID"))
    later = [line.replace("0600", "0900").replace(" 5.94 ", " 9.94 ") for line in missoula[begin:]]
    for lines, remarks in ((missoula, 0), ([*missoula, *later], 1)):
        sounding = read(written(lines))
        assert sounding.name == "727730 170401/0600"
        assert list(sounding.pressure) == pytest.approx([90690.0, 90180.0, 89590.0, 88930.0, 88190.0])
        assert list(sounding.temperature - 273.15) == pytest.approx([5.94, 6.34, 6.74, 7.04, 6.84])
        assert list(sounding.dewpoint - 273.15) == pytest.approx([0.58, 0.75, 0.84, 0.77, 0.53])
        assert sounding.source.endswith("BUFKIT")
        assert sum("The first of 2 soundings" in remark for remark in sounding.remarks) == remarks


# netCDF


@pytest.fixture
def dataset(levels):
    pressure, height, temperature, dewpoint = np.array(levels).T
    return xr.Dataset(
        {
            "a": ("level", temperature, {"units": "degC", "standard_name": "air_temperature"}),
            "b": ("level", dewpoint + 273.15, {"units": "K", "standard_name": "dew_point_temperature"}),
            "c": ("level", height, {"units": "m", "standard_name": "altitude"}),
        },
        coords={"level": ("level", pressure, {"units": "hPa", "standard_name": "air_pressure"})},
    )


@pytest.fixture
def saved(tmp_path):
    def save(dataset, **options):
        path = tmp_path / "ascent.nc"
        dataset.to_netcdf(path, **options)
        return path

    return save


def test_variables_are_found_by_their_standard_names_or_their_own(dataset, saved, same_as):
    plain = dataset.copy(deep=True).rename(a="temperature", b="dewpoint", c="height", level="pressure")
    for variable in plain.variables.values():
        variable.attrs.pop("standard_name")
    thermometer = dataset.drop_vars("c").assign(height=((), 2.0, {"units": "m", "standard_name": "height"}))
    for found in (dataset, plain, dataset.expand_dims(time=[0.0], lat=[50.0]), thermometer):
        sounding = read(saved(found))
        same_as(sounding)
        assert sounding.source.endswith("ascent.nc, netCDF")


def test_a_file_without_one_profile_is_refused_in_a_sentence(dataset, saved):
    cases = [
        (lambda d: d.drop_vars("b"), 'no variable is the dewpoint: give one the standard_name "dew_point_temperature"'),
        (lambda d: d.expand_dims(time=[0.0, 1.0]), "the temperature in a is not one value for each level .* time = 2"),
        (lambda d: d.isel(level=0), "the pressure in level is not one value for each level .* it has no dimension"),
        (lambda d: d.assign(b=d.b.rename(level="other")), "the dewpoint in b is not one value .* it has other = 12"),
        (lambda d: d.assign(a=d.a.copy(data=["warm"] * 12)), "a holds no numbers"),
        (lambda d: d.assign(a=d.a.where(d.level > 200, np.inf)), "level 11: a temperature of inf degC does not occur"),
        (lambda d: d.assign(b=d.b + 20.0), "level 1: the dewpoint of .* degC is above the temperature"),
        (lambda d: xr.Dataset({"speed": ("bin", [1.0])}), "no variable is the pressure"),
    ]
    for change, sentence in cases:
        dataset["b"].attrs.update(units="K")
        with xr.set_options(keep_attrs=True), pytest.raises(SoundingError, match=sentence) as caught:
            read(saved(change(dataset)))
        assert "\n" not in str(caught.value)


# Tables with separators

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


def test_the_usual_marks_of_missing_values_are_understood(written, csv_lines):
    for mark in ["", "NaN", "-9999", "-9999.00", "-999", "9999", "999.9", "M", "null", "--", "////"]:
        cells = csv_lines[5].split(",")
        csv_lines[5] = ",".join([*cells[:2], mark, cells[3]])
        sounding = read(written(csv_lines))
        assert len(sounding) == 11
        assert 800e2 not in sounding.pressure


# What is refused


@pytest.fixture
def good(csv_lines, wyoming_lines, sharppy_lines, lines, missoula):
    """The lines of a sounding in each text format."""
    return {"csv": csv_lines, "wyoming": wyoming_lines, "sharppy": sharppy_lines, "igra": lines, "bufkit": missoula}


def instead(*change):
    """Return a function that replaces a text in all lines."""
    return lambda lines: [line.replace(*change) for line in lines]


def comma(lines):
    lines = [line.replace(",", ";") for line in lines]
    return [*lines[:3], lines[3].replace(".", ","), *lines[4:]]


COLUMNS = "PRES TMPC TMWC DWPC THTE DRCT SKNT OMEG "
REFUSED = [
    ("csv", instead("850.0", "high"), "line 5: the pressure high is not a number"),
    ("csv", instead("850.0", "inf"), "line 5: the pressure inf is not a number"),
    ("csv", instead("850.0", "1e999"), "line 5: the pressure 1e999 is not a number"),
    ("csv", instead("850.0", "1_000"), "line 5: the pressure 1_000 is not a number"),
    ("csv", instead("T [degC]", "T"), "line 1: the temperature has no unit: name it, as in"),
    ("csv", instead("T [degC]", "T [warm]"), "line 1: the unit warm of the temperature is not known"),
    ("csv", instead("T [degC]", "T [hPa]"), "line 1: hPa is not a unit of temperature"),
    ("csv", instead("Td [degC]", "RH [%]"), "line 1: there is no dewpoint: name its column dewpoint"),
    ("csv", instead("z [m]", "p [Pa]"), "line 1: p [Pa] is a second column of pressure"),
    ("csv", comma, "line 4: the pressure 900,0 is written with a comma: write a decimal point"),
    ("csv", lambda lines: [*lines[:4], "850.0,1457.0", *lines[5:]], "line 5: there are 2 of 4 columns"),
    ("csv", instead("850.0,", "850.0,7,"), "line 5: there are 5 columns, but 4 names"),
    ("wyoming", lambda lines: [*lines[:2], *lines[3:]], "line 2: no line of units follows the names of the columns"),
    ("sharppy", lambda lines: lines[:-1], "there is no %END%, so the file is cut off"),
    ("sharppy", lambda lines: [*lines[:9], lines[9].rpartition(",")[0], *lines[10:]], "line 10: there are 5 of 6"),
    ("igra", lambda lines: lines[:-3], "line 6: the header announces 7 levels, and 4 are whole"),
    ("igra", lambda lines: [*lines[:2], lines[2][:30], *lines[3:]], "line 3: the header announces 7 levels, and 1 are"),
    ("igra", instead("  314", " x314"), "line 3: the temperature x314 is not a number"),
    ("bufkit", lambda lines: lines[: lines.index(COLUMNS) + 11], "8 of 9 values"),
    ("bufkit", instead("DWPC", "RELH"), "there is no dewpoint"),
    ("bufkit", lambda lines: lines[: lines.index(COLUMNS)], "no table has the columns"),
]  # fmt: skip
"""A format, what is changed in its lines, and what the refusal says: the line, the value and the fix."""


@pytest.mark.parametrize(("format", "change", "said"), REFUSED)
def test_what_is_cut_off_or_wrong_is_refused_with_its_line(written, good, format, change, said):
    path = written(change(good[format]))
    with pytest.raises(SoundingError) as refused:
        read(path)
    assert said in str(refused.value)
    assert str(refused.value).startswith(str(path))

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


def test_blank_cells_are_missing_values(written, wyoming_lines):
    wyoming_lines[-1] = wyoming_lines[-1][:21]  # neither dewpoint nor wind at the top
    wyoming_lines[-4] = wyoming_lines[-4][:42] + " " * 14 + wyoming_lines[-4][56:]  # no wind
    sounding = read(written(wyoming_lines))
    assert len(sounding) == 12
    assert sounding.dewpoint[-1] == pytest.approx(sounding.temperature[-1] - 30.0)
    assert "Above 200 hPa no dewpoint: taken 30 K below the temperature." in sounding.remarks


def test_the_first_of_several_tables_is_taken(written, wyoming_lines, same_as):
    second = [line.replace("990.0", "980.0") for line in wyoming_lines]
    sounding = read(written([*page(wyoming_lines), *page(second)]))
    same_as(sounding)
    assert sounding.remarks[0] == "The first of 2 soundings in the file taken."


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


# SHARPpy


def test_a_file_is_read_without_the_level_below_the_ground(written, sharppy_lines, same_as):
    sounding = read(written(sharppy_lines))
    same_as(sounding)
    assert sounding.name == "XYZ 010203/0000 10.00,-20.00"
    assert sounding.source.endswith("ascent.txt, SHARPpy text")
    assert sounding.remarks == ("1 level without pressure or temperature left out.",)


def test_a_file_that_is_cut_off_is_refused(written, sharppy_lines):
    with pytest.raises(SoundingError, match="there is no %END%, so the file is cut off"):
        read(written(sharppy_lines[:-1]))


def test_a_line_that_is_cut_off_is_refused(written, sharppy_lines):
    sharppy_lines[9] = sharppy_lines[9].rpartition(",")[0]
    with pytest.raises(SoundingError, match="line 10: there are 5 of 6 columns"):
        read(written(sharppy_lines))


# IGRA

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


def test_a_file_that_is_cut_off_is_refused_in_igra(written, lines):
    for cut in [1, 3, 8]:
        with pytest.raises(SoundingError, match=f"the header announces 9 levels, and {9 - cut} are there"):
            read(written(lines[:-cut]))


def test_a_line_that_is_cut_off_or_no_number_is_refused(written, lines):
    with pytest.raises(SoundingError, match=r"line 3: the line is cut off"):
        read(written([*lines[:2], lines[2][:30], *lines[3:]]))
    with pytest.raises(SoundingError, match=r"line 3: the temperature x212 is not a number"):
        read(written([*lines[:2], lines[2].replace("  212", " x212"), *lines[3:]]))


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


def test_a_forecast_that_is_cut_off_or_lacks_a_column_is_refused(written, missoula):
    start = next(k for k, line in enumerate(missoula) if line.startswith("PRES TMPC"))
    with pytest.raises(SoundingError, match="8 of 9 values of a level are there, so the sounding is cut off"):
        read(written(missoula[: start + 2 + 9]))
    with pytest.raises(SoundingError, match="there is no dewpoint"):
        read(written([line.replace("DWPC", "RELH") for line in missoula]))
    with pytest.raises(SoundingError, match="no table has the columns"):
        read(written(missoula[:start]))


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


def test_variables_are_found_by_their_standard_names(dataset, saved, same_as):
    sounding = read(saved(dataset))
    same_as(sounding)
    assert sounding.source.endswith("ascent.nc, netCDF")


def test_variables_are_found_by_their_own_names(dataset, saved, same_as):
    plain = dataset.rename(a="temperature", b="dewpoint", c="height", level="pressure")
    for variable in plain.variables.values():
        del variable.attrs["standard_name"]
    same_as(read(saved(plain)))


def test_a_single_profile_may_have_dimensions_of_size_one(dataset, saved, same_as):
    same_as(read(saved(dataset.expand_dims(time=[0.0], lat=[50.0]))))


def test_the_height_of_a_thermometer_is_not_taken_for_that_of_the_levels(dataset, saved, same_as):
    odd = dataset.drop_vars("c").assign(height=((), 2.0, {"units": "m", "standard_name": "height"}))
    same_as(read(saved(odd)))


def test_a_file_without_one_profile_is_refused_in_a_sentence(dataset, saved):
    cases = [
        (lambda d: d.drop_vars("b"), 'no variable is the dewpoint: give one the standard_name "dew_point_temperature"'),
        (lambda d: d.expand_dims(time=[0.0, 1.0]), "the temperature in a is not one value for each level .* time = 2"),
        (
            lambda d: d.isel(level=0),
            "the pressure in level is not one value for each level of the pressure, for it has no dimension",
        ),
        (
            lambda d: d.assign(b=d.b.rename(level="other")),
            "the dewpoint in b is not one value for each level of the pressure, for it has other = 12",
        ),
        (lambda d: d.assign(a=d.a.copy(data=["warm"] * 12)), "a holds no numbers"),
        (lambda d: d.assign(a=d.a.where(d.level > 200, np.inf)), "level 11: the temperature is not finite"),
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

"""The levels of a sounding: which are left out, which are refused with their line, and what is doubted."""

import numpy as np
import pytest

from atmosbox.errors import SoundingError
from atmosbox.file import netcdf
from atmosbox.scene.sounding import Sounding, read
from atmosbox.scene.sounding.column import QUANTITIES, check_plausible, stated_columns
from atmosbox.scene.sounding.profile import LARGEST_GAP, ROUNDING, check_levels
from tests.in_process import typed

PRESSURE = np.array([1000e2, 900e2, 800e2, 650e2, 500e2, 300e2, 100e2])
TEMPERATURE = np.array([298.0, 292.0, 286.0, 275.0, 262.0, 233.0, 210.0])
DEWPOINT = TEMPERATURE - 5.0


def place(level):
    return f"here, level {level}"


def changed(column, level, value):
    column = column.copy()
    column[level] = value
    return column


WIDE = np.array([1000e2, 900e2, 750e2, 500e2, 280e2, 20e2, 1e2])
POSSIBLE = (PRESSURE, DEWPOINT), (PRESSURE, changed(DEWPOINT, 2, 286.0 + ROUNDING)), (WIDE, DEWPOINT)
IMPOSSIBLE = [
    (changed(PRESSURE, 3, 850e2), DEWPOINT, "level 3: the pressure of 850 hPa is not below the 800 hPa"),
    (changed(PRESSURE, 3, 800e2), DEWPOINT, "level 3: the pressure of 800 hPa is that of the level"),
    (PRESSURE, changed(DEWPOINT, 2, 286.06), "level 2: the dewpoint of 12.91 degC is above the temperature of 12.85"),
    (changed(WIDE, 3, 750e2 - LARGEST_GAP - 1e2), DEWPOINT, "level 3: below the pressure of 499 hPa there is a gap of"),
]


def test_levels_that_make_no_ascent_are_refused():
    for pressure, dewpoint in POSSIBLE:
        check_levels(pressure, TEMPERATURE, dewpoint, place)
    for pressure, dewpoint, said in IMPOSSIBLE:
        with pytest.raises(SoundingError, match=f"here, {said}"):
            check_levels(pressure, TEMPERATURE, dewpoint, place)


def test_a_wrong_unit_is_told_by_what_would_be_right():
    cases = [
        ("temperature", [25.0, 10.0], "K", "degC"), ("temperature", [298.0, 283.0], "degC", "K"),
        ("temperature", [95.0, 50.0], "degC", "degF"), ("dewpoint", [17.0, 5.0], "K", "degC"),
        ("pressure", [1000.0, 900.0], "Pa", "hPa"), ("pressure", [101325.0, 9e4], "hPa", "Pa"),
        ("pressure", [29.9, 27.0], "hPa", "inHg"), ("pressure", [101.3, 90.0], "hPa", "kPa"),
    ]  # fmt: skip
    for quantity, values, unit, looks in cases:
        with pytest.raises(SoundingError, match=f'looks like {looks}: name its unit, as in "{quantity} .{looks}."'):
            check_plausible(quantity, np.array(values), unit, place)
        check_plausible(quantity, np.array(values), looks, place)


def test_the_best_name_with_a_fitting_unit_is_chosen():
    for quantity, measure in QUANTITIES.items():
        assert all(stated_columns(["other", name], "here") == {quantity: (1, None)} for name in measure.names)
    cases = [
        (["T_K"], {"temperature": (0, "K")}), (["t", "T"], {"temperature": (1, None)}),
        (["t [s]", "temp [K]"], {"temperature": (1, "K")}), (["level", "pressure"], {"pressure": (1, None)}),
        (["level [1]", "lev [hPa]"], {"pressure": (1, "hPa")}), (["dew point (°C)"], {"dewpoint": (0, "°C")}),
        (["T_virtual", "p_sea"], {}),
    ]  # fmt: skip
    for header, found in cases:
        assert stated_columns(header, "here") == found


# Levels of a table


def cell(lines, line, column, value):
    """Return lines with one cell of one line, counted from 1, replaced."""
    cells = lines[line - 1].split(",")
    cells[column] = str(value)
    return [*lines[: line - 1], ",".join(cells), *lines[line:]]


P, Z, T, TD = range(4)


@pytest.mark.parametrize(
    ("column", "remark"),
    [
        (P, "without pressure or temperature"),
        (T, "without pressure or temperature"),
        (TD, "without dewpoint, below a level"),
    ],
)
def test_a_level_without_a_value_is_left_out(written, csv_lines, column, remark):
    sounding = read(written(cell(csv_lines, 6, column, -9999)))
    assert len(sounding) == 11
    assert sounding.remarks[0].startswith(f"1 level {remark}")


def test_levels_above_the_highest_dewpoint_are_kept_dry(written, csv_lines):
    sounding = read(written(cell(cell(csv_lines, 13, TD, -9999), 12, TD, "")))
    assert len(sounding) == 12
    assert list(sounding.temperature[-2:] - sounding.dewpoint[-2:]) == [30.0, 30.0]
    assert sounding.temperature[-3] - sounding.dewpoint[-3] < 30.0
    assert "Above 300 hPa no dewpoint: taken 30 K below the temperature." in sounding.remarks


def test_lines_and_not_levels_are_named(written, csv_lines):
    twice = cell([*csv_lines[:6], csv_lines[5], *csv_lines[6:]], 7, T, 3.3)
    with pytest.raises(SoundingError, match="line 7: the pressure of 800 hPa is that of the level before it"):
        read(written(twice))
    lines = cell(cell(csv_lines, 4, T, ""), 9, TD, 30)
    with pytest.raises(SoundingError, match=r"ascent\.txt, line 9: the dewpoint of 30 degC is above the temperature"):
        read(written(lines))


# What is possible but unlikely

DOUBT_PRESSURE = np.array([1000.0, 975.0, 925.0, 850.0, 700.0, 600.0, 500.0, 400.0, 300.0, 250.0, 200.0])
DOUBT_TEMPERATURE = np.array([24.0, 22.0, 18.5, 14.0, 5.0, -2.0, -10.5, -23.5, -43.5, -52.0, -56.0])


def doubts(temperature, pressure=DOUBT_PRESSURE):
    return Sounding(100.0 * pressure, temperature + 273.15, temperature + 270.0).doubts


def test_a_level_that_is_far_too_warm_is_doubted_and_an_ordinary_ascent_is_not():
    for ground in (24.0, 28.0, 5.0):  # also in the sun, and on a clear night
        assert doubts(np.where(DOUBT_PRESSURE == 1000.0, ground, DOUBT_TEMPERATURE)) == ()
    found = doubts(np.where(DOUBT_PRESSURE == 300.0, 0.0, DOUBT_TEMPERATURE))
    assert len(found) == 2
    assert "From 400 to 300 hPa the temperature rises by 23.5 K" in found[0]
    assert "From 300 to 250 hPa the air is 38.1 K colder than along the dry adiabat" in found[1]


def test_aloft_two_kelvin_beyond_the_dry_adiabat_are_the_limit():
    for excess, number in [(1.9, 0), (2.1, 1)]:
        steep = DOUBT_TEMPERATURE.copy()
        steep[5] = (steep[4] + 273.15) * (600.0 / 700.0) ** (2 / 7) - 273.15 - excess
        steep[6:] = np.minimum(steep[6:], steep[5] - 8.5)
        assert len(doubts(steep)) == number


def test_a_gap_and_a_missing_top_are_doubted():
    kept = DOUBT_PRESSURE != 600.0
    pressure = np.where(DOUBT_PRESSURE == 500.0, 480.0, DOUBT_PRESSURE)[kept]
    assert doubts(DOUBT_TEMPERATURE[kept], pressure) == (
        "Between 700 and 480 hPa there is no level: 220 hPa, more than 200 hPa.",
    )
    assert doubts(DOUBT_TEMPERATURE[:6], DOUBT_PRESSURE[:6]) == (
        "The sounding ends at 600 hPa, below the 300 hPa surface.",
    )


@pytest.fixture
def doubtful(tmp_path):
    rows = [f"{p:g},{t:g},{t - 3:g}" for p, t in zip(DOUBT_PRESSURE[:7], DOUBT_TEMPERATURE[:7], strict=True)]
    path = tmp_path / "short.csv"
    path.write_text("\n".join(["p [hPa],T [degC],Td [degC]", *rows]))
    return path


def run(folder, doubtful, *words):
    words = ["run", "lifting-sounding", "--set", f"sounding={doubtful}", "--set", "molecules=200", *words]
    return typed(*words, "--set", "ascent=20", "--out", str(folder / "x.nc"))


def test_a_doubtful_file_is_warned_of_in_the_file_too_and_strict_refuses_it(tmp_path, doubtful):
    assert read(doubtful).doubts
    done = run(tmp_path, doubtful, "--strict")
    assert done.exit_code == 2
    assert "ends at 500 hPa" in done.stderr
    assert "leave --strict out" in done.stderr
    assert not (tmp_path / "x.nc").exists()
    with pytest.warns(UserWarning, match="ends at 500 hPa"):
        assert run(tmp_path, doubtful).exit_code == 0
    assert "Doubtful: The sounding ends at 500 hPa" in netcdf.read(tmp_path / "x.nc").attrs["comment"]

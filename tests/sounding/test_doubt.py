"""Soundings that are possible but unlikely: a warning on stderr and in the file, or a refusal."""

import numpy as np
import pytest
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.file.netcdf import read
from atmosbox.scene.sounding import Sounding
from atmosbox.scene.sounding import read as read_sounding

PRESSURE = np.array([1000.0, 975.0, 925.0, 850.0, 700.0, 600.0, 500.0, 400.0, 300.0, 250.0, 200.0])
TEMPERATURE = np.array([24.0, 22.0, 18.5, 14.0, 5.0, -2.0, -10.5, -23.5, -43.5, -52.0, -56.0])


def doubts(temperature, pressure=PRESSURE):
    return Sounding(100.0 * pressure, temperature + 273.15, temperature + 270.0).doubts


def test_an_ordinary_ascent_has_none():
    assert doubts(TEMPERATURE) == ()
    assert doubts(np.where(PRESSURE == 1000.0, 28.0, TEMPERATURE)) == ()  # the ground in the sun
    assert doubts(np.where(PRESSURE == 1000.0, 5.0, TEMPERATURE)) == ()  # and on a clear night


def test_a_level_that_is_far_too_warm_is_doubted():
    found = doubts(np.where(PRESSURE == 300.0, 0.0, TEMPERATURE))
    assert len(found) == 2
    assert "From 400 to 300 hPa the temperature rises by 23.5 K" in found[0]
    assert "From 300 to 250 hPa the air is 38.1 K colder than along the dry adiabat" in found[1]


def test_aloft_two_kelvin_beyond_the_dry_adiabat_are_the_limit():
    for excess, number in [(1.9, 0), (2.1, 1)]:
        steep = TEMPERATURE.copy()
        steep[5] = (steep[4] + 273.15) * (600.0 / 700.0) ** (2 / 7) - 273.15 - excess
        steep[6:] = np.minimum(steep[6:], steep[5] - 8.5)
        assert len(doubts(steep)) == number


def test_a_gap_and_a_missing_top_are_doubted():
    kept = PRESSURE != 600.0
    pressure = np.where(PRESSURE == 500.0, 480.0, PRESSURE)[kept]
    assert doubts(TEMPERATURE[kept], pressure) == (
        "Between 700 and 480 hPa there is no level: 220 hPa, more than 200 hPa.",
    )
    assert doubts(TEMPERATURE[:6], PRESSURE[:6]) == ("The sounding ends at 600 hPa, below the 300 hPa surface.",)


@pytest.fixture
def doubtful(tmp_path):
    rows = [f"{p:g},{t:g},{t - 3:g}" for p, t in zip(PRESSURE[:7], TEMPERATURE[:7], strict=True)]
    path = tmp_path / "short.csv"
    path.write_text("\n".join(["p [hPa],T [degC],Td [degC]", *rows]))
    return path


def run(folder, doubtful, *words):
    words = ["run", "lifting-sounding", "--set", f"sounding={doubtful}", "--set", "molecules=200", *words]
    return CliRunner().invoke(app, [*words, "--set", "ascent=20", "--out", str(folder / "x.nc")])


def test_a_file_cut_to_a_part_is_warned_of_on_stderr_and_in_the_file(tmp_path, doubtful):
    assert read_sounding(doubtful).doubts
    with pytest.warns(UserWarning, match="ends at 500 hPa"):
        assert run(tmp_path, doubtful).exit_code == 0
    assert "Doubtful: The sounding ends at 500 hPa" in read(tmp_path / "x.nc").attrs["comment"]


def test_strict_refuses_it(tmp_path, doubtful):
    done = run(tmp_path, doubtful, "--strict")
    assert done.exit_code == 2
    assert "ends at 500 hPa" in done.stderr
    assert "leave --strict out" in done.stderr
    assert not (tmp_path / "x.nc").exists()

"""One made-up sounding in several formats."""

import numpy as np
import pytest

WYOMING_NAMES = ("PRES", "HGHT", "TEMP", "DWPT", "RELH", "MIXR", "DRCT", "SKNT", "THTA", "THTE", "THTV")
WYOMING_UNITS = ("hPa", "m", "C", "C", "%", "g/kg", "deg", "knot", "K", "K", "K")


@pytest.fixture
def levels():
    """Made-up air: pressure [hPa], height [m], temperature and dewpoint [degC], from the ground up."""
    pressure = np.array([990.0, 950, 900, 850, 800, 700, 600, 500, 400, 300, 200, 100])
    height = 44330 * (1 - (pressure / 1013.25) ** 0.19026)
    temperature = np.maximum(27 - 6.5e-3 * height, -55.0)
    rows = np.stack([pressure, height.round(), temperature.round(1), (temperature - 2 - height / 1e3).round(1)], axis=1)
    return [tuple(float(x) for x in row) for row in rows]


@pytest.fixture
def csv_lines(levels):
    return ["p [hPa],z [m],T [degC],Td [degC]", *(",".join(map(str, level)) for level in levels)]


@pytest.fixture
def wyoming_lines(levels):
    """The same in the format of the University of Wyoming, with a level below the ground in front."""

    def line(cells):
        return "".join(f"{cell:>7}" for cell in cells)

    rule = "-" * 77
    other = ["50", "5.00", "180", "10", "300.0", "310.0", "301.0"]
    body = [line([f"{p:.1f}", f"{z:.0f}", f"{t:.1f}", f"{td:.1f}", *other]) for p, z, t, td in levels]
    below = line(["1000.0", "-17"]) + " " * 63
    return [rule, line(WYOMING_NAMES), line(WYOMING_UNITS), rule, below, *body]


@pytest.fixture
def sharppy_lines(levels):
    body = [f"{p:9.2f}, {z:9.2f}, {t:9.2f}, {td:9.2f}, {180.0:9.2f}, {10.0:9.2f}" for p, z, t, td in levels]
    return [
        "%TITLE%",
        " XYZ   010203/0000 10.00,-20.00",
        "",
        "   LEVEL       HGHT       TEMP       DWPT       WDIR       WSPD",
        "-" * 67,
        "%RAW%",
        "  1000.00,    -17.00,  -9999.00,  -9999.00,  -9999.00,  -9999.00",
        *body,
        "%END%",
    ]


@pytest.fixture
def written(tmp_path):
    """Return a function that writes lines, text or bytes to a file."""

    def write(content, name="ascent.txt"):
        path = tmp_path / name
        if isinstance(content, list):
            content = "\n".join(content) + "\n"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return path

    return write


@pytest.fixture
def same_as(levels):
    """Return a function that checks that a sounding is the made-up air."""

    def check(sounding):
        pressure, _, temperature, dewpoint = np.array(levels).T
        np.testing.assert_allclose(sounding.pressure, pressure * 100, rtol=1e-12)
        np.testing.assert_allclose(sounding.temperature, temperature + 273.15, rtol=1e-12)
        np.testing.assert_allclose(sounding.dewpoint, dewpoint + 273.15, rtol=1e-12)

    return check

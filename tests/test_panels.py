"""The panels of a scene's figure, written to a file and read again."""

import pytest

from atmosbox.scene.panels import Line, Panel, from_json, to_json

AIR = Line("elapsed_time", "air_temperature", "air", error="air_temperature_se")
WALL = Line("elapsed_time", "wall_temperature[z_low]", "wall", "theory")
PARCEL = Line("parcel_temperature", "parcel_pressure", "parcel")

FIGURE = (
    Panel("line", "Temperature", (AIR, WALL), "time", "temperature", "ns", "degC", headlines=("mean",)),
    Panel("profile", "Air − in K", (PARCEL,), y_unit="hPa", y_scale="log", y_invert=True, note="A note."),
    Panel("histogram", "Speeds", (Line("speed", "speed_probability_density", "measured"),), x_invert=True),
    Panel("discs", "The box", x_unit="nm"),
    Panel("line", "Long noise", (WALL,), x_scale="log", averages=30),
    Panel(
        "profile", "Half", (PARCEL,), start=(15.0, 0.0), guides=(("y", 5.4, "half"),), y_limits=(0.0, 9.0), areas=True
    ),
)


def test_what_is_written_is_read_again_unchanged():
    assert from_json(to_json(FIGURE)) == FIGURE


def test_a_panel_that_cannot_be_drawn_is_refused_where_it_is_written():
    cases = [
        (lambda: Line("", "y", "a curve"), "the x of a line is ''"),
        (lambda: Line("x", "y", " "), "the label of a line"),
        (lambda: Line("x", 3, "a curve"), "the y of a line is 3"),
        (lambda: Line("x", "y", "a curve", "measured"), "one of data, theory, environment, reference"),
        (lambda: Line("x", "y", "a curve", error=""), "the error of a line"),
        (lambda: Panel("pie", "A panel", (AIR,)), "one of line, profile, histogram, discs"),
        (lambda: Panel("line", "", (AIR,)), "the title of a panel"),
        (lambda: Panel("line", "A panel"), "needs at least one line"),
        (lambda: Panel("line", "A panel", (AIR,), start=(1.0,)), "and has two numbers"),
        (lambda: Panel("line", "A panel", (AIR,), guides=(("z", 1.0, ""),)), "is not an axis, a value and a text"),
        (lambda: Panel("discs", "A panel", (AIR,)), "has no lines"),
        (lambda: Panel("line", "A panel", [AIR]), "lines of the panel 'A panel' is not a tuple of Line"),
        (lambda: Panel("line", "A panel", (AIR,), headlines=(1,)), "headlines of the panel"),
        (lambda: Panel("line", "A panel", (AIR,), x_label=None), "x_label of the panel 'A panel' is not a text"),
        (lambda: Panel("line", "A panel", (AIR,), y_scale="cubic"), "one of linear, log"),
        (lambda: Panel("line", "A panel", (AIR,), y_invert=1), "neither true nor false"),
        (lambda: Panel("line", "A panel", (AIR,), averages=True), "averages of the panel"),
        (lambda: Panel("profile", "A panel", (AIR,), averages=10), "averages of the panel"),
    ]
    for make, words in cases:
        with pytest.raises(ValueError, match=words):
            make()


def test_foreign_or_old_text_is_refused_in_a_sentence():
    cases = [
        ("{", "no JSON text"),
        (None, "no JSON text"),
        ('{"format": 1}', "not in the form that atmosbox writes"),
        ('{"format": 0, "panels": []}', "format 0, and this version of atmosbox reads format 1"),
        ('{"format": 1, "panels": [3]}', "a panel is written as int"),
        ('{"format": 1, "panels": [{"kind": "discs"}]}', "a panel lacks the field 'title'"),
        ('{"format": 1, "panels": [{"kind": "discs", "title": "A", "hue": 1}]}', "unknown field 'hue'"),
        ('{"format": 1, "panels": [{"kind": "line", "title": "A", "lines": "xy"}]}', "lines of a panel"),
        ('{"format": 1, "panels": [{"kind": "line", "title": "A", "lines": [{"x": "a"}]}]}', "lacks the field 'y'"),
        ('{"format": 1, "panels": [{"kind": [], "title": "A"}]}', "must be one of"),
    ]
    for text, words in cases:
        with pytest.raises(ValueError, match=words) as refusal:
            from_json(text)
        assert str(refusal.value).endswith(".")

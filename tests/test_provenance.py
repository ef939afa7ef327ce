"""Provenance: the attributes of a file that say how it was made."""

from atmosbox.file.provenance import global_attributes, history_line


def attributes():
    made = {"scene": "lifting-dry", "settings": {"seed": 7, "temperature": 25.0}, "engine": "exact"}
    words = {"title": "Lifted air", "comment": "No ice, pas de glace à 25 °C.", "references": "doi:10.1000/1"}
    return global_attributes(made, command=["atmosbox", "run", "lifting-dry"], **words)


def test_the_history_has_the_time_and_the_command_as_typed(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    words = ["atmosbox", "run", "lifting-dry", "--set", "temperature=25 degC"]
    line = "2023-11-14T22:13:20Z: atmosbox run lifting-dry --set 'temperature=25 degC'"
    assert history_line(words) == line
    assert history_line("atmosbox list") == "2023-11-14T22:13:20Z: atmosbox list"
    assert attributes()["date_created"] == "2023-11-14T22:13:20Z"

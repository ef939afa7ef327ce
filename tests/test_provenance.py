"""Provenance: the attributes of a file that say how it was made."""

from atmosbox.file.provenance import global_attributes, history_line


def test_the_history_has_the_time_and_the_command_as_typed(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    words = ["atmosbox", "run", "lifting-dry", "--set", "temperature=25 degC"]
    line = "2023-11-14T22:13:20Z: atmosbox run lifting-dry --set 'temperature=25 degC'"
    assert history_line(words) == line
    assert history_line("atmosbox list") == "2023-11-14T22:13:20Z: atmosbox list"
    made = global_attributes({"scene": "lifting-dry"}, title="Lifted air", command=words)
    assert made["date_created"] == "2023-11-14T22:13:20Z"

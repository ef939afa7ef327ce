"""Provenance: the attributes of a file that say how it was made."""

from atmosbox.file.provenance import global_attributes, history_line


def test_the_history_has_the_time_and_the_command_as_typed(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    made = global_attributes({"scene": "lifting-dry"}, title="Lifted air", command="atmosbox run lifting-dry")
    assert made["history"] == history_line("atmosbox run lifting-dry")
    assert made["history"] == "2023-11-14T22:13:20Z: atmosbox run lifting-dry"
    assert made["date_created"] == "2023-11-14T22:13:20Z"

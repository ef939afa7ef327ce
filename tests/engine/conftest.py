"""An engine that returns after every event."""

import pytest

from atmosbox.engine.exact import parcelset


@pytest.fixture
def by_single_events(monkeypatch):
    """Make a box of the exact engine return after every event."""
    monkeypatch.setattr(parcelset, "_CHUNK", 1)

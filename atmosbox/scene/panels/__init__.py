"""What the figure of a scene shows, as plain data.

A scene names the variables of its file that belong on a graph, and the form of the graph; it draws nothing. The panels
are stored with the run as one JSON string (the attribute ``atmosbox_panels``), so that a file can be drawn long
afterwards, on a machine that has neither the scene nor the engine.
"""

from atmosbox.scene.panels.line import ROLES, Line
from atmosbox.scene.panels.over_time import over_time
from atmosbox.scene.panels.panel import (
    ATMOSPHERE_VARIABLES,
    DISC_VARIABLES,
    KINDS,
    SCALES,
    SKEWT_AXES,
    Panel,
    without_headlines,
)
from atmosbox.scene.panels.record import from_json, to_json

__all__ = [
    "ATMOSPHERE_VARIABLES",
    "DISC_VARIABLES",
    "KINDS",
    "ROLES",
    "SCALES",
    "SKEWT_AXES",
    "Line",
    "Panel",
    "from_json",
    "over_time",
    "to_json",
    "without_headlines",
]

"""A parcel of air that rises under its piston: what the scenes of lifted air have in common."""

from atmosbox.scene.ascent.display import atmosphere_panel, lifted_headlines, lifted_panels, lifted_theory
from atmosbox.scene.ascent.launch import rise
from atmosbox.scene.ascent.limit import refuse_descent, refuse_supersaturation
from atmosbox.scene.ascent.way import MoistAscent

__all__ = [
    "MoistAscent",
    "atmosphere_panel",
    "lifted_headlines",
    "lifted_panels",
    "lifted_theory",
    "refuse_descent",
    "refuse_supersaturation",
    "rise",
]

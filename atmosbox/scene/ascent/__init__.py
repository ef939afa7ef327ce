"""A parcel of air that rises under its piston: what the scenes of lifted air have in common."""

from atmosbox.scene.ascent.display import lifted_headlines, lifted_panels, lifted_theory, misfit_panel
from atmosbox.scene.ascent.launch import rise
from atmosbox.scene.ascent.limit import refuse_descent, refuse_supersaturation
from atmosbox.scene.ascent.way import MoistAscent

__all__ = [
    "MoistAscent",
    "lifted_headlines",
    "lifted_panels",
    "lifted_theory",
    "misfit_panel",
    "refuse_descent",
    "refuse_supersaturation",
    "rise",
]

"""A parcel of air that rises under its piston: what the scenes of lifted air have in common."""

from atmosbox.rising.ascent import MoistAscent
from atmosbox.rising.refusal import refuse_descent, refuse_supersaturation
from atmosbox.rising.start import rise
from atmosbox.rising.story import lifted_headlines, lifted_panels, lifted_theory, misfit_panel

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

"""A parcel of air that rises under its piston: the common parts of the scenes with lifted air."""

from atmosbox.scene.ascent.convection import convection_headlines
from atmosbox.scene.ascent.display import atmosphere_panel, lifted_headlines, lifted_panels, lifted_theory
from atmosbox.scene.ascent.drawn_parcels import comparable, draw
from atmosbox.scene.ascent.launch import rise
from atmosbox.scene.ascent.way import MoistAscent, refuse_descent, refuse_supersaturation

__all__ = [
    "MoistAscent",
    "atmosphere_panel",
    "comparable",
    "convection_headlines",
    "draw",
    "lifted_headlines",
    "lifted_panels",
    "lifted_theory",
    "refuse_descent",
    "refuse_supersaturation",
    "rise",
]

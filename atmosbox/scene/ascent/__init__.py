"""A parcel of air that rises under its piston: the common parts of the scenes with lifted air."""

from atmosbox.scene.ascent.convection import convection_headlines
from atmosbox.scene.ascent.display import atmosphere_panel, lifted_headlines, lifted_panels, lifted_theory
from atmosbox.scene.ascent.fluctuation import along_frames, temperature_covariance
from atmosbox.scene.ascent.launch import rise
from atmosbox.scene.ascent.way import MoistAscent, refuse_descent, refuse_supersaturation

__all__ = [
    "MoistAscent",
    "along_frames",
    "atmosphere_panel",
    "convection_headlines",
    "lifted_headlines",
    "lifted_panels",
    "lifted_theory",
    "refuse_descent",
    "refuse_supersaturation",
    "rise",
    "temperature_covariance",
]

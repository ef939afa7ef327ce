"""A parcel of air that rises under its piston: what the scenes of lifted air have in common."""

from atmosbox.rising.ascent import MoistAscent
from atmosbox.rising.pool import AirOverPool
from atmosbox.rising.size import CLOSING, FLATNESS, size_of_parcel
from atmosbox.rising.start import rise
from atmosbox.rising.story import lifted_headlines, lifted_panels, lifted_theory

__all__ = [
    "CLOSING",
    "FLATNESS",
    "AirOverPool",
    "MoistAscent",
    "lifted_headlines",
    "lifted_panels",
    "lifted_theory",
    "rise",
    "size_of_parcel",
]

"""Soundings: the measured profile above a place, what it means for a lifted parcel, and an analytic profile.

============== =========================================================================
file           what is in it
============== =========================================================================
column         names, units and plausible values of the columns of a sounding
profile        the sounding itself, what no ascent can be, and what is doubtful in one
formats        the text formats: Wyoming, IGRA, BUFKIT, SHARPpy, and CSV and the like
reading        from a file to a sounding: recognises the format, also netCDF; units, missing values, order
analytic       Weisman and Klemp's formula for the environment of a thunderstorm
lifted_parcel  LCL, LFC, EL, CAPE and CIN, by MetPy, and the heights of levels
============== =========================================================================
"""

from atmosbox.scene.sounding.analytic import weisman_klemp
from atmosbox.scene.sounding.lifted_parcel import Indices, Level, hydrostatic_height, indices
from atmosbox.scene.sounding.profile import Sounding
from atmosbox.scene.sounding.reading import read

__all__ = ["Indices", "Level", "Sounding", "hydrostatic_height", "indices", "read", "weisman_klemp"]

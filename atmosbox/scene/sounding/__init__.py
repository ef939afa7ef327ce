"""Soundings: the measured profile above a place, what it means for a lifted parcel, and an analytic profile.

============== =========================================================================
file           what is in it
============== =========================================================================
profile        the sounding itself: pressure, temperature, dewpoint from the ground up
column         the names and units of its columns
plausibility   what no sounding can be, and what is doubtful in one
tabulated      from the columns of a file to a sounding: units, missing values, order
reading        opens a file and recognises its format
wyoming        the University of Wyoming's tables, as text or as a web page
igra           the Integrated Global Radiosonde Archive, version 2
bufkit         the soundings of a forecast
sharppy        SHARPpy's text
delimited      CSV and the like
profile_netcdf profiles as xarray and MetPy write them
analytic       Weisman and Klemp's formula for the environment of a thunderstorm
hydrostatics   the heights of levels
lifted_parcel  LCL, LFC, EL, CAPE and CIN, by MetPy
============== =========================================================================
"""

from atmosbox.scene.sounding.analytic import weisman_klemp
from atmosbox.scene.sounding.hydrostatics import hydrostatic_height
from atmosbox.scene.sounding.lifted_parcel import Indices, Level, indices
from atmosbox.scene.sounding.profile import Sounding
from atmosbox.scene.sounding.reading import read

__all__ = ["Indices", "Level", "Sounding", "hydrostatic_height", "indices", "read", "weisman_klemp"]

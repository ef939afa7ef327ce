"""Instruments: what a scene measures, each one a class that looks at the molecules and remembers.

A scene carries only the instruments that it needs. Each is shown the box at every sample (``look``) and
at the end of every frame (``close``); asked at any time (``readings``), it gives what it has, in SI
units, by the names that `diagnostics` declares.
"""

from atmosbox.instruments.air import Air
from atmosbox.instruments.disc import Discs
from atmosbox.instruments.drop import DropSizes
from atmosbox.instruments.instrument import Instrument, Readings
from atmosbox.instruments.layer import Layers
from atmosbox.instruments.leaving import Leaving
from atmosbox.instruments.lift import Environment, Lift
from atmosbox.instruments.moist_lift import MoistLift
from atmosbox.instruments.molecule import LAWS, Molecules, wall_laws
from atmosbox.instruments.speed import Speeds
from atmosbox.instruments.water import Water

__all__ = [
    "LAWS",
    "Air",
    "Discs",
    "DropSizes",
    "Environment",
    "Instrument",
    "Layers",
    "Leaving",
    "Lift",
    "MoistLift",
    "Molecules",
    "Readings",
    "Speeds",
    "Water",
    "wall_laws",
]

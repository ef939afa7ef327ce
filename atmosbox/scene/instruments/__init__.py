"""Instruments: what a scene measures. Each is a class that samples the molecules and keeps the readings.

A scene has only the instruments that it needs. The run shows the box to each of them several times a frame (``sample``)
and at the end of every frame (``end_frame``); ``readings`` returns at any time what has been measured so far, in SI
units, by the names that `atmosbox.file.variables` declares.
"""

from atmosbox.scene.instruments.air import Air
from atmosbox.scene.instruments.condensate import Clusters
from atmosbox.scene.instruments.disc_motion import Discs
from atmosbox.scene.instruments.drops import DropSizes, Nuclei
from atmosbox.scene.instruments.flow import Flow
from atmosbox.scene.instruments.instrument import Instrument, Readings
from atmosbox.scene.instruments.layer import Layers
from atmosbox.scene.instruments.lifted_air import Environment, Lift, MoistLift
from atmosbox.scene.instruments.mixing import MOMENTS, Mixing
from atmosbox.scene.instruments.molecule import LAWS, Molecules, wall_laws
from atmosbox.scene.instruments.slab import Slab
from atmosbox.scene.instruments.speeds import Speeds
from atmosbox.scene.instruments.water import Leaving, Water

__all__ = [
    "LAWS", "MOMENTS", "Air", "Clusters", "Discs", "DropSizes", "Environment", "Flow", "Instrument", "Layers",
    "Leaving", "Lift", "Mixing", "MoistLift", "Molecules", "Nuclei", "Readings", "Slab", "Speeds", "Water", "wall_laws",
]  # fmt: skip

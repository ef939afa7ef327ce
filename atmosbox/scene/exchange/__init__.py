"""Vapour and liquid that trade molecules until as many come as go: what the scenes of it know by theory."""

from atmosbox.scene.exchange.emission import energy_of_those_that_leave, temperature_of_those_that_left
from atmosbox.scene.exchange.moist_box import MoistBox
from atmosbox.scene.exchange.pool import AirOverPool
from atmosbox.scene.exchange.rates import history

__all__ = ["AirOverPool", "MoistBox", "energy_of_those_that_leave", "history", "temperature_of_those_that_left"]

"""Vapour and liquid that trade molecules until as many come as go: what the scenes of it know by theory."""

from atmosbox.exchange.box import MoistBox
from atmosbox.exchange.leaving import energy_of_those_that_leave, temperature_of_those_that_left
from atmosbox.exchange.pool import AirOverPool
from atmosbox.exchange.story import history

__all__ = ["AirOverPool", "MoistBox", "energy_of_those_that_leave", "history", "temperature_of_those_that_left"]

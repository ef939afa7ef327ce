"""Vapour and liquid that exchange molecules until both rates are equal: the theory that these scenes share."""

from atmosbox.scene.exchange.drop_growth import DropGrowth, DropKind
from atmosbox.scene.exchange.moist_box import MoistBox
from atmosbox.scene.exchange.pool import AirOverPool, energy_of_those_that_leave, temperature_of_those_that_left

__all__ = [
    "AirOverPool",
    "DropGrowth",
    "DropKind",
    "MoistBox",
    "energy_of_those_that_leave",
    "temperature_of_those_that_left",
]

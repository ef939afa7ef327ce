"""Molecules that leave a pool: their energy, and the temperature of the pool when they left."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from atmosbox import theory as law
from atmosbox.scene.exchange.pool import AirOverPool
from atmosbox.scene.headline import Headline
from atmosbox.theory.constants import BOLTZMANN

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["energy_of_those_that_leave", "temperature_of_those_that_left"]


def temperature_of_those_that_left(dataset: xr.Dataset) -> float:
    """Return the mean temperature of the liquid at the moments when molecules left it [K]; NaN if none did.

    If the liquid has no temperature in some frames, that of the gas is taken: a pool that disappears now and then
    consists of a molecule or two that came from the gas, and has its temperature.
    """
    always = bool(np.isfinite(dataset.liquid_temperature.values).all())
    warm = (dataset.liquid_temperature if always else dataset.gas_temperature).values
    rate = dataset.evaporation_rate.values
    return float(np.average(warm, weights=rate)) if rate.any() else math.nan


def energy_of_those_that_leave(dataset: xr.Dataset, start: AirOverPool, few: int) -> tuple[Headline, ...]:
    """Return the mean energy of the molecules that leave, if many have left a pool of many molecules.

    Parameters
    ----------
    dataset
        The run.
    start
        The air over its pool.
    few
        Least number of molecules that must have left, and of molecules in the pool.
    """
    left = float(dataset.evaporation_rate.mean() * dataset.elapsed_time[-1]) * 1e-9
    if min(left, start.pool) < few or not np.isfinite(dataset.liquid_temperature.values).all():
        return ()
    warm = temperature_of_those_that_left(dataset)
    middle, width = dataset.energy.values, np.diff(dataset.energy_bnds.values)[:, 0]
    share = dataset.leaving_energy_probability_density.values * width
    mean = float(middle @ share)
    flux = BOLTZMANN * law.LEAVING_FREEDOM * warm
    return (
        Headline(
            "energy_of_those_that_leave",
            mean,
            math.sqrt(float((middle - mean) ** 2 @ share) / left),
            BOLTZMANN * law.BINDING_TEMPERATURE + flux,
            flux * law.BINDING_TEMPERATURE / warm / (law.LIQUID_HEAT_CAPACITY * start.pool),
            "molecules leave a pool of few molecules mostly while it is warm by chance",
            "J",
            "zJ",
            "energy of leaving molecules",
        ),
    )

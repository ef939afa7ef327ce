"""A parcel of dry or of moist air on its ascent, and its environment."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import FollowPressure, Parcel, Snapshot
from atmosbox.scene.instruments.instrument import Instrument, Readings
from atmosbox.scene.instruments.water import gas_kT
from atmosbox.scene.units import Scale

Array = NDArray[np.float64]
REFERENCE_PRESSURE = 1e5
"""Pressure to which the potential temperature refers [Pa]."""


@dataclass(frozen=True)
class Environment:
    """The environment of a parcel that rises: its height, pressure and temperature as functions of time.

    Parameters
    ----------
    height, pressure, temperature
        Functions of the elapsed time [s] that give m, Pa and K.
    adiabat
        Function of pressure [Pa] that gives the temperature of the adiabat by theory [K].
    """

    height: Callable[[float], float]
    pressure: Callable[[float], float]
    temperature: Callable[[float], float]
    adiabat: Callable[[float], float] = lambda _: math.nan


class _Rising(Instrument):
    """What parcels of dry and of moist air have in common: the size of the box, and the environment."""

    def __init__(self, driver: FollowPressure, environment: Environment, scatter: Callable[[Array], Array]) -> None:
        self._driver = driver
        self.environment = environment
        self.scatter = scatter
        self._rows: list[tuple[float, ...]] = []

    def _measure(self, parcel: Parcel, *more: float) -> None:
        """Read the box at the end of a frame."""
        self._rows.append((parcel.time, parcel.volume, parcel.ceiling, parcel.piston_velocity, *more))

    def _readings(
        self, scale: Scale, time: Array, temperature: Array, pressure: Array, adiabat: Array, heat_capacity: float
    ) -> Readings:
        """Return the series of a parcel [K, Pa] and of its environment at the same moments [reduced time]."""
        volume, ceiling, velocity = np.array(self._rows).T[1:4]
        around = self.environment
        seconds = np.array([self._driver.course.moment(t) for t in time]) * scale.time
        outside = np.array([around.pressure(t) for t in seconds])
        return Readings(
            parcel_temperature=temperature,
            parcel_temperature_se=temperature * self.scatter(outside),
            parcel_pressure=pressure,
            parcel_potential_temperature=temperature * (REFERENCE_PRESSURE / pressure) ** (1.0 / heat_capacity),
            parcel_volume=volume * scale.length**3 * scale.weight,
            parcel_height=np.array([around.height(t) for t in seconds]),
            environment_temperature=np.array([around.temperature(t) for t in seconds]),
            environment_pressure=outside,
            adiabat_temperature=adiabat,
            piston_height=ceiling * scale.length,
            piston_velocity=velocity * scale.velocity,
        )


class Lift(_Rising):
    """A parcel on its ascent: temperature and pressure of parcel and environment against height.

    The temperature is that of the whole energy of the parcel, which does not fluctuate in a box at rest. What scatters
    from run to run is the work of the piston.

    Parameters
    ----------
    driver, environment
        The driver of the piston, which measures the pressure of the parcel; the environment.
    scatter
        Standard deviations of the temperature from run to run, as shares of it, for the pressures of the environment
        [Pa] at the ends of the frames; unknown unless it is given, see `atmosbox.theory.Ascent.scatter`.
    """

    def __init__(
        self, driver: FollowPressure, environment: Environment,
        scatter: Callable[[Array], Array] = lambda outside: np.full(len(outside), math.nan),
    ) -> None:  # fmt: skip
        super().__init__(driver, environment, scatter)
        self._heat_capacity = 3.5

    def end_frame(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the state of the parcel at the end of a frame."""
        freedom = parcel.degrees_of_freedom
        self._heat_capacity = 0.5 * freedom + 1.0
        self._measure(parcel, 2.0 * parcel.internal_energy() / (freedom * parcel.number), self._driver.pressure(parcel))

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series of parcel and environment."""
        if not self._rows:
            return Readings()
        time, _, _, _, kT, p = np.array(self._rows).T
        pressure = p * scale.pressure
        adiabat = np.array([self.environment.adiabat(each) for each in pressure])
        return self._readings(scale, time, kT * scale.temperature, pressure, adiabat, self._heat_capacity)


class MoistLift(_Rising):
    """A parcel of moist air on its ascent: temperature and pressure of parcel and environment against height.

    Temperature and pressure are means over the samples within a frame; for the pressure, of its logarithm. The number
    of molecules of vapour fluctuates all the time, and so does the temperature: each molecule that condenses warms the
    others. The standard error is that of the mean of a frame and comes from the theory of such fluctuations, because a
    single run cannot tell accumulated fluctuations from the finite-rate error.

    Parameters
    ----------
    driver, environment
        The driver of the piston, which measures the pressure of the parcel; the environment.
    curve
        Temperatures [K] that theory expects along a sequence of pressures [Pa], in the order in which they are met.
    scatter
        Standard deviations of the means of frames, as shares of the temperature, for the pressures of the environment
        [Pa] in the middle of the frames.
    """

    def __init__(
        self, driver: FollowPressure, environment: Environment, curve: Callable[[Array], Array],
        scatter: Callable[[Array], Array],
    ) -> None:  # fmt: skip
        super().__init__(driver, environment, scatter)
        self.curve = curve
        self._looks: list[tuple[float, float]] = []
        self._seen: list[list[tuple[float, float]]] = []

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Read temperature and pressure."""
        self._looks.append((gas_kT(parcel), self._driver.pressure(parcel)))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Read the state of the box at the end of a frame."""
        self._seen.append(self._looks)
        self._looks = []
        self._measure(parcel)

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series of parcel and environment; see `Instrument`."""
        if not self._rows:
            return Readings()
        time = np.array(self._rows)[:, 0]
        kT, p = np.moveaxis(np.array(self._seen), 2, 0)
        temperature, pressure = kT * scale.temperature, p * scale.pressure
        adiabat = self.curve(pressure.ravel()).reshape(pressure.shape).mean(axis=1)
        middle, mean = time - 0.5 * np.diff(time, prepend=0.0), np.exp(np.log(pressure).mean(axis=1))
        return self._readings(scale, middle, temperature.mean(axis=1), mean, adiabat, 3.5)

"""A parcel of moist air on its ascent, and its environment."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import FollowPressure, Snapshot
from atmosbox.scene.instruments.instrument import Readings
from atmosbox.scene.instruments.lifted_air import REFERENCE_PRESSURE, Environment
from atmosbox.scene.instruments.water import gas_kT
from atmosbox.scene.units import Scale

__all__ = ["MoistLift"]

Array = NDArray[np.float64]


class MoistLift:
    r"""A parcel of moist air on its ascent: temperature and pressure of parcel and environment against height.

    Temperature and pressure are means over the samples within a frame; for the pressure, of its logarithm. The number
    of molecules of vapour fluctuates all the time, and so does the temperature: each molecule that condenses warms the
    others. The standard error is that of the mean of a frame and comes from the theory of such fluctuations, because a
    single run cannot tell accumulated fluctuations from the finite-rate error.

    Parameters
    ----------
    driver
        The driver of the piston, which measures the pressure of the parcel.
    environment
        The environment.
    curve
        Temperatures [K] that theory expects along a sequence of pressures [Pa], in the order in which they are met.
    scatter
        Standard deviations of the means of frames, as shares of the temperature, for the pressures of the environment
        [Pa] in the middle of the frames.
    """

    def __init__(
        self,
        driver: FollowPressure,
        environment: Environment,
        curve: Callable[[Array], Array],
        scatter: Callable[[Array], Array],
    ) -> None:
        self._driver = driver
        self.environment = environment
        self.curve = curve
        self.scatter = scatter
        self._looks: list[tuple[float, float]] = []
        self._seen: list[list[tuple[float, float]]] = []
        self._rows: list[tuple[float, ...]] = []

    def sample(self, parcel: Any, snapshot: Snapshot) -> None:
        """Read temperature and pressure."""
        self._looks.append((gas_kT(parcel), self._driver.pressure(parcel)))

    def end_frame(self, parcel: Any, snapshot: Snapshot) -> None:
        """Read the state of the box at the end of a frame."""
        self._seen.append(self._looks)
        self._looks = []
        self._rows.append((parcel.time, parcel.volume, parcel.ceiling, parcel.piston_velocity))

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series of parcel and environment; see `Instrument`."""
        if not self._rows:
            return Readings()
        time, volume, ceiling, velocity = np.array(self._rows).T
        kT, p = np.moveaxis(np.array(self._seen), 2, 0)
        temperature, pressure = kT * scale.temperature, p * scale.pressure
        expected = self.curve(pressure.ravel()).reshape(pressure.shape)
        parcel_temperature = temperature.mean(axis=1)
        parcel_pressure = np.exp(np.log(pressure).mean(axis=1))
        around = self.environment
        middle = time - 0.5 * np.diff(time, prepend=0.0)
        middle = np.array([self._driver.course.moment(t) for t in middle]) * scale.time
        outside = np.array([around.pressure(t) for t in middle])
        return Readings(
            parcel_temperature=parcel_temperature,
            parcel_temperature_se=self.scatter(outside) * parcel_temperature,
            parcel_pressure=parcel_pressure,
            parcel_potential_temperature=parcel_temperature * (REFERENCE_PRESSURE / parcel_pressure) ** (2.0 / 7.0),
            parcel_volume=volume * scale.length**3 * scale.weight,
            parcel_height=np.array([around.height(t) for t in middle]),
            environment_temperature=np.array([around.temperature(t) for t in middle]),
            environment_pressure=outside,
            adiabat_temperature=expected.mean(axis=1),
            piston_height=ceiling * scale.length,
            piston_velocity=velocity * scale.velocity,
        )

"""Instruments: what a scene measures, each one a class that looks at the molecules and remembers.

A scene carries only the instruments that it needs. Each is shown the box at every sample (``look``) and
at the end of every frame (``close``); asked at any time (``readings``), it gives what it has, in SI
units, by the names that `diagnostics` declares.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine.lift import FollowPressure
from atmosbox.engine.measure import layer_sample, momentum, speed_counts, temperature
from atmosbox.engine.parcel import Parcel, Snapshot
from atmosbox.statistics import block_average
from atmosbox.units import Scale

__all__ = ["Air", "Discs", "Environment", "Instrument", "Layers", "Lift", "Molecules", "Readings", "Speeds"]

Array = NDArray[np.float64]
_BLOCKS = 20
_REFERENCE_PRESSURE = 1e5


class Readings(dict[str, Any]):
    """Variables and coordinates by name, in SI units."""


class Instrument(Protocol):
    """What every instrument does."""

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """See the molecules at a sample."""

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Close a frame."""

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return what has been measured; averages leave out the first ``settle`` frames."""


def open_faces(parcel: Parcel) -> Array:
    """Return the area of each wall that the centres of the molecules can reach [length^2; of a plane gas, length].

    Zero where a periodic axis has no wall.

    Examples
    --------
    >>> from atmosbox.engine import ParcelSet
    >>> pair = ParcelSet([[1, 1, 1], [3, 3, 1]], [[1, 0, 0], [0, 2, 0]], length=(4, 4, 3))
    >>> open_faces(pair)
    array([6., 6., 6., 6., 9., 9.])
    """
    diameter = float(parcel.diameter.mean()) if parcel.number else 0.0
    sides = parcel.length - np.where(parcel.periodic, 0.0, diameter)
    if parcel.planar:
        sides[1] = 1.0
    face = np.prod(sides) / sides * ~np.array(parcel.periodic)
    if parcel.planar:
        face[1] = 0.0
    return np.repeat(face, 2)


class Air:
    """The thermometer, the barometer and the energy ledger of the whole box.

    Parameters
    ----------
    barometer
        The walls whose pressure is that of the air: ``all`` of them, or the ``floor``.
    """

    def __init__(self, barometer: str = "all") -> None:
        self._barometer = slice(None) if barometer == "all" else slice(4, 5)
        self._kT: list[float] = []
        self._impulse = np.zeros(6)
        self._time = 0.0
        self._rows: list[dict[str, Any]] = []

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the thermometer."""
        self._kT.append(temperature(parcel, snapshot))

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the barometer and the ledger."""
        area = open_faces(parcel)
        lasted = parcel.time - self._time
        impulse = parcel.wall_impulse - self._impulse
        with np.errstate(invalid="ignore", divide="ignore"):
            wall_pressure = np.where(area > 0.0, impulse / (area * lasted), np.nan)
        kinetic, rotational, potential = parcel.energy()
        chosen = self._barometer
        row: dict[str, Any] = {
            "air_temperature": float(np.mean(self._kT)),
            "air_pressure": float(impulse[chosen].sum() / (area[chosen].sum() * lasted))
            if area[chosen].any()
            else math.nan,
            "wall_pressure": wall_pressure,
            "kinetic_energy": kinetic,
            "rotational_energy": rotational,
            "potential_energy": potential,
            "heat_from_wall": parcel.wall_heat,
            "work_by_piston": parcel.work,
            "ledger_residual": parcel.ledger(),
            "numerical_heat": parcel.numerical_heat,
            "collision_count": parcel.contacts,
            "wall_hit_count": int(parcel.wall_hits.sum()),
            "wall_temperature": parcel.wall_kT(),
        }
        self._rows.append(row)
        self._kT = []
        self._impulse = parcel.wall_impulse
        self._time = parcel.time

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series; see `Instrument`."""
        units = {
            "air_temperature": scale.temperature,
            "air_pressure": scale.pressure,
            "wall_pressure": scale.pressure,
            "kinetic_energy": scale.total_energy,
            "rotational_energy": scale.total_energy,
            "potential_energy": scale.total_energy,
            "heat_from_wall": scale.total_energy,
            "work_by_piston": scale.total_energy,
            "numerical_heat": scale.total_energy,
            "wall_temperature": scale.temperature,
        }
        if not self._rows:
            return Readings()
        columns = {name: np.array([row[name] for row in self._rows]) * units.get(name, 1) for name in self._rows[0]}
        if not columns["numerical_heat"].any():  # most schemes make none
            del columns["numerical_heat"]
        return Readings(columns)


class Layers:
    """Density, temperature and pressure of layers of equal thickness between floor and ceiling.

    The pressure is that of the motion and of the contacts: n kT + virial / d V in d dimensions, 3 or 2.

    Parameters
    ----------
    number
        How many layers; the box must count its virial by as many.
    """

    def __init__(self, number: int) -> None:
        self._number = number
        self._sum = np.zeros((3, number))
        self._looks = 0
        self._virial = np.zeros(number)
        self._time = 0.0
        self._frames: list[Array] = []
        self._volume = 1.0
        self._height = 1.0
        self._mass = 1.0
        self._dimensions = 3.0

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Count the molecules of each layer and the energy of their disordered motion."""
        self._sum += np.stack(layer_sample(parcel, snapshot, self._number))
        self._looks += 1

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Close the sums of a frame."""
        lasted = parcel.time - self._time
        rate = (parcel.virial - self._virial) / lasted
        self._frames.append(np.stack([*(self._sum / max(self._looks, 1)), rate]))
        self._sum = np.zeros((3, self._number))
        self._looks = 0
        self._virial = parcel.virial
        self._time = parcel.time
        self._height = float(parcel.length[2])
        self._volume = parcel.volume / self._number
        self._mass = float(parcel.mass.mean())
        self._dimensions = 2.0 if parcel.planar else 3.0

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the profiles with the standard errors of 20 blocks."""
        frames = np.array(self._frames[settle:])
        edges = np.linspace(0.0, self._height, self._number + 1) * scale.length
        out = Readings(height=0.5 * (edges[1:] + edges[:-1]), height_bnds=np.stack([edges[:-1], edges[1:]], axis=1))
        if len(frames) < 2:
            return out
        blocks = min(_BLOCKS, len(frames))
        parts = np.array([part.mean(axis=0) for part in np.array_split(frames, blocks)])
        number, energy, freedom, virial = np.moveaxis(parts, 1, 0)
        with np.errstate(invalid="ignore", divide="ignore"):
            kT = np.where(freedom > 0.0, 2.0 * energy / freedom, np.nan)
        pressure = (number * kT + virial / self._dimensions) / self._volume
        density = number / self._volume
        whole = frames.mean(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):
            whole_kT = np.where(whole[2] > 0.0, 2.0 * whole[1] / whole[2], np.nan)
        unit = {
            "number_density": (scale.number_density, whole[0] / self._volume, density),
            "air_density": (scale.mass_density * self._mass, whole[0] / self._volume, density),
            "layer_temperature": (scale.temperature, whole_kT, kT),
            "layer_pressure": (
                scale.pressure,
                (whole[0] * whole_kT + whole[3] / self._dimensions) / self._volume,
                pressure,
            ),
        }
        for name, (factor, mean, part) in unit.items():
            out[name] = factor * mean
            out[f"{name}_se"] = factor * part.std(axis=0, ddof=1) / math.sqrt(blocks)
        return out


class Speeds:
    """The share of molecules by speed.

    Parameters
    ----------
    edges : (bin + 1,)
        Bounds of the bins [reduced velocity].
    """

    def __init__(self, edges: Array) -> None:
        self._edges = np.asarray(edges, np.float64)
        self._counts = np.zeros(self._edges.size - 1)
        self._seen = 0
        self._frames: list[Array] = []

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Count by speed."""
        self._counts += speed_counts(snapshot, self._edges)
        self._seen += parcel.number

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Close the counts of a frame."""
        self._frames.append(self._counts / max(self._seen, 1) / np.diff(self._edges))
        self._counts = np.zeros_like(self._counts)
        self._seen = 0

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the histogram with the standard errors of 20 blocks."""
        edges = self._edges * scale.velocity
        out = Readings(speed=0.5 * (edges[1:] + edges[:-1]), speed_bnds=np.stack([edges[:-1], edges[1:]], axis=1))
        frames = np.array(self._frames[settle:])
        if len(frames) >= 2:
            mean, error = block_average(frames, min(_BLOCKS, len(frames)))
            out["speed_probability_density"] = mean / scale.velocity
            out["speed_probability_density_se"] = error / scale.velocity
        return out


@dataclass(frozen=True)
class Environment:
    """The air around a parcel that rises: its height, pressure and temperature as functions of time.

    Parameters
    ----------
    height, pressure, temperature
        Functions of the elapsed time [s] that give m, Pa and K.
    adiabat
        Function of pressure [Pa] that gives the temperature of the closed-form adiabat [K].
    """

    height: Callable[[float], float]
    pressure: Callable[[float], float]
    temperature: Callable[[float], float]
    adiabat: Callable[[float], float]


class Lift:
    r"""A parcel on its way up: temperature and pressure of parcel and environment against height.

    The temperature is that of all energy, which has no noise at rest. Two things scatter from run to run: the
    work that the piston exchanged, which adds up, and what the barometer says at the moment, which does not.

    Parameters
    ----------
    driver
        The driver of the piston, which knows the pressure of the parcel.
    environment
        The air around.

    Notes
    -----
    The work shows in the entropy per molecule of spheres of density n and temperature T, with the measured
    :math:`(Z - 1)/n = b + c n`,

    .. math:: s / k = (f/2) \ln T - \ln n - b n - c n^2 / 2 ,

    which an adiabat would keep. A finite speed makes it drift, and chance makes it walk at random. Both come from
    what the gas remembers of its last expansion, during a mean free time, so that drift and variance grow alike,

    .. math:: w = \int \left( \frac{d \ln n}{dt} \right)^2 \frac{dt}{n \sqrt{T}} ,

    and the variance, N times, is twice the drift [1]_. The variance is measured by the steps from one of 20 blocks of
    the ascent to the next, less their share of the drift; w tells how much of it has been gathered by when. To it
    comes the variance of the barometer, that of Z about the straight line.

    Against the scatter of 24 to 144 runs each the error is right within 20 %, as well as these can tell, from 400
    mean free times on. In faster ascents sound has no time to die out within a block, and the error is too large:
    1.4 times at 200 and at 50 mean free times, twice at 20.

    References
    ----------
    .. [1] Jarzynski, C. (1997), doi:10.1103/PhysRevLett.78.2690: work lost on the way is half the variance of
       the work, over kT.
    """

    def __init__(self, driver: FollowPressure, environment: Environment) -> None:
        self._driver = driver
        self._environment = environment
        self._rows: list[tuple[float, ...]] = []
        self._freedom = 5.0

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Need no look at single molecules."""

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Read the state of the parcel at the end of a frame."""
        self._freedom = parcel.degrees_of_freedom
        kT = 2.0 * parcel.internal_energy() / (self._freedom * parcel.number)
        self._rows.append(
            (
                parcel.time,
                kT,
                self._driver.pressure(parcel),
                parcel.open_density,
                parcel.volume,
                parcel.ceiling,
                parcel.piston_velocity,
            )
        )

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the series of parcel and environment."""
        if not self._rows:
            return Readings()
        time, kT, pressure, density, volume, ceiling, velocity = np.array(self._rows).T
        heat_capacity = 0.5 * self._freedom + 1.0
        spread = _entropy_spread(time, kT, pressure, density, self._freedom) / heat_capacity
        seconds = time * scale.time
        parcel_temperature = kT * scale.temperature
        parcel_pressure = pressure * scale.pressure
        surroundings = self._environment
        return Readings(
            parcel_temperature=parcel_temperature,
            parcel_temperature_se=parcel_temperature * spread,
            parcel_pressure=parcel_pressure,
            parcel_potential_temperature=parcel_temperature
            * (_REFERENCE_PRESSURE / parcel_pressure) ** (1.0 / heat_capacity),
            parcel_volume=volume * scale.length**3 * scale.weight,
            parcel_height=np.array([surroundings.height(t) for t in seconds]),
            environment_temperature=np.array([surroundings.temperature(t) for t in seconds]),
            environment_pressure=np.array([surroundings.pressure(t) for t in seconds]),
            adiabat_temperature=np.array([surroundings.adiabat(p) for p in parcel_pressure]),
            piston_height=ceiling * scale.length,
            piston_velocity=velocity * scale.velocity,
        )


def _entropy_spread(time: Array, kT: Array, pressure: Array, density: Array, freedom: float) -> Array:
    """Return how far chance takes (f/2 + 1) ln T - ln p of a rising parcel, by time; see `Lift`.

    Examples
    --------
    Three moments at least are needed:

    >>> two = np.array([1.0, 2.0])
    >>> _entropy_spread(two, two, two, two, 5.0)
    array([nan, nan])
    """
    if len(time) < 3:
        return np.full(len(time), math.nan)
    excess = (pressure / (density * kT) - 1.0) / density
    slope = np.cov(density, excess)[0, 1] / np.var(density, ddof=1) if np.ptp(density) > 0.0 else 0.0
    smooth = np.mean(excess) + slope * (density - np.mean(density))
    at_zero = smooth[0] - slope * density[0]
    barometer = density * (excess - smooth) / (1.0 + excess * density)
    entropy = 0.5 * freedom * np.log(kT) - np.log(density) - at_zero * density - 0.5 * slope * density**2
    free_time = np.convolve(1.0 / (density * np.sqrt(kT)), [0.5, 0.5], "valid")
    gathered = np.diff(np.log(density)) ** 2 / np.diff(time) * free_time
    gathered = np.concatenate([gathered[:1] * time[0] / (time[1] - time[0]), gathered]).cumsum()
    length = max(1, len(time) // _BLOCKS)
    last = len(time) // length * length
    step, share = (np.diff(each[-last:].reshape(-1, length).mean(axis=1)) for each in (entropy, gathered))
    if not share.sum() > 0.0:
        return np.full(len(time), math.nan)
    chance = step - step.sum() * share / share.sum()
    # what is left of the variance of a step once both its ends are means
    smoothing = (2.0 + 1.0 / length**2) / 3.0
    walk = np.sum(chance**2) / (smoothing * (share.sum() - np.sum(share**2) / share.sum())) * gathered
    return np.asarray(np.sqrt(walk + np.var(barometer, ddof=2)))


class Discs:
    """Every disc of a plane gas, the energies of the light and the heavy half, and the momentum account."""

    def __init__(self) -> None:
        self._position: list[Array] = []
        self._velocity: list[Array] = []
        self._momentum: list[Array] = []
        self._given: list[Array] = []
        self._mass = np.zeros(0)
        self._diameter = np.zeros(0)
        self._length = np.zeros(3)

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Need no look between frames."""

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Remember all discs."""
        outward = parcel.wall_impulse
        self._given.append(np.array([outward[0] - outward[1], outward[2] - outward[3], outward[4] - outward[5]]))
        self._position.append(snapshot.position)
        self._velocity.append(snapshot.velocity)
        self._momentum.append(momentum(parcel, snapshot))
        self._mass, self._diameter, self._length = parcel.mass, parcel.diameter, parcel.length

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return the discs and their accounts."""
        if not self._position:
            return Readings()
        velocity = np.array(self._velocity)
        energy = 0.5 * self._mass * np.sum(velocity**2, axis=2)
        total = energy.sum(axis=1)
        p = np.array(self._momentum)
        missing = (p - np.array(self._given)) - (p[0] - self._given[0])
        size = math.sqrt(2.0 * float(self._mass.sum()) * float(total[0])) or 1.0
        order = np.argsort(self._mass, kind="stable")
        half = len(order) // 2
        light_energy = energy[:, order[:half]].mean(axis=1) * scale.energy
        heavy_energy = energy[:, order[half:]].mean(axis=1) * scale.energy
        frames = np.arange(len(energy)) + 1.0
        return Readings(
            kinetic_energy_light=light_energy,
            kinetic_energy_heavy=heavy_energy,
            running_energy_light=np.cumsum(light_energy) / frames,
            running_energy_heavy=np.cumsum(heavy_energy) / frames,
            momentum=p * scale.mass * scale.velocity,
            momentum_residual=np.sqrt(np.sum(missing**2, axis=1)) / size,
            energy_change=total / total[0] - 1.0,
            disc_position=np.array(self._position) * scale.length,
            disc_velocity=velocity * scale.velocity,
            disc_mass=self._mass * scale.mass,
            disc_diameter=self._diameter * scale.length,
            box_length=self._length * scale.length,
        )


class Molecules:
    """Places and speeds of all molecules, for those who asked for them with ``--save-molecules``."""

    def __init__(self) -> None:
        self._position: list[NDArray[np.float32]] = []
        self._speed: list[NDArray[np.float32]] = []

    def look(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Need no look between frames."""

    def close(self, parcel: Parcel, snapshot: Snapshot) -> None:
        """Remember all molecules, in single precision."""
        self._position.append(snapshot.position.astype(np.float32))
        self._speed.append(np.sqrt(np.sum(snapshot.velocity**2, axis=1)).astype(np.float32))

    def readings(self, scale: Scale, settle: int) -> Readings:
        """Return places and speeds."""
        return Readings(
            molecule_position=np.array(self._position) * np.float32(scale.length),
            molecule_speed=np.array(self._speed) * np.float32(scale.velocity),
        )

"""The picture of a box for the page: data that are sent once, and then the positions in each frame."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.live.outlook import outlook, planned
from atmosbox.page import NEIGHBOURS, Box, Stage, round_up, stage
from atmosbox.scene.conversion import phrase, to_si
from atmosbox.scene.instruments import wall_laws
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared
from atmosbox.theory.constants import DRY_AIR, WATER
from atmosbox.version import __version__

if TYPE_CHECKING:
    from atmosbox.scene.panels import Panel

__all__ = ["Picture"]

_FASTEST = 3.0
COLDER = 0.5  # share of the scale of speeds: if the speeds reach less of it, a new scale is chosen


class Picture:
    """The view of one box.

    Parameters
    ----------
    prepared, setup
        The scene and its box.
    panels
        Its graphs.

    Attributes
    ----------
    stage
        The data that the page gets once.
    swift
        Speed that hardly any molecule exceeds, over the square root of the temperature [m s-1 K-1/2].
    """

    def __init__(self, prepared: Prepared, setup: Setup, panels: tuple[Panel, ...]) -> None:
        self._setup = setup
        parcel: Any = setup.parcel
        scale = setup.scale
        present = parcel.present
        mass = np.full(present.size, math.nan)
        diameter = np.full(present.size, math.nan)
        mass[present] = parcel.mass * scale.mass
        diameter[present] = parcel.diameter * scale.length
        water = None
        if hasattr(parcel, "vapour"):
            mass[~present] = WATER.molecule_mass  # only molecules of water ever leave the gas
            diameter[~present] = float(np.nanmax(diameter)) if present.any() else DRY_AIR.diameter
            water = mass < 0.5 * (DRY_AIR.molecule_mass + WATER.molecule_mass)
        self.swift = _swift(mass / scale.mass) * scale.velocity / math.sqrt(scale.temperature)
        module, settings = prepared.module, prepared.settings
        self._highest = 0.0
        self._counted = hasattr(parcel, "neighbours")  # colours show neighbours, because speeds do not show drops
        self.stage: Stage = stage(
            scene=prepared.scene,
            title=str(getattr(module, "title", prepared.scene)),
            story=(module.__doc__ or "").strip().split("\n\n")[0].replace("\n", " "),
            facts=list(setup.facts.items()),
            settings=[(p.name, _said(getattr(settings, p.name), p.unit)) for p in settings.describe()],
            version=__version__,
            seed=settings.seed,
            engine=str(prepared.engine),
            box=Box(
                length=tuple(float(side) * scale.length for side in parcel.length),  # type: ignore[arg-type]
                walls=wall_laws(parcel),
                wall_temperature=tuple(
                    float(each) * scale.temperature if math.isfinite(each) else None for each in parcel.wall_kT()
                ),
                planar=parcel.planar,
                gravity=parcel.gravity > 0.0,
            ),
            mass=mass,
            diameter=diameter,
            water=water,
            drops=hasattr(parcel, "drops"),
            right=setup.right,
            time_unit=setup.time_unit,
            fastest=NEIGHBOURS if self._counted else self._fastest(),
            panels=panels,
            discs=any(panel.kind == "discs" for panel in panels),
            counted=self._counted,
        )

        for record, points in zip(
            self.stage.record["panels"], planned(self.stage.record["panels"], outlook(setup)), strict=True
        ):
            record["planned"] = points

    def _fastest(self) -> float:
        """Return a speed that hardly any molecule exceeds at the present temperatures of gas and walls [m/s]."""
        kT = np.array([*self._setup.parcel.wall_kT(), self._kT()])
        return self.swift * math.sqrt(float(np.nanmax(kT)) * self._setup.scale.temperature)

    def _scale(self) -> float:
        """Return the end of the scale of speeds; it changes only if the box is too warm or too cold for it."""
        wanted = self._fastest()
        if not COLDER * self._highest <= wanted <= self._highest:
            self._highest = round_up(wanted)
        return self._highest

    def walls(self) -> list[float | None]:
        """Return the present temperatures of the six walls [K], None for a wall without a temperature."""
        kelvin = self._setup.parcel.wall_kT() * self._setup.scale.temperature
        return [float(f"{each:.6g}") if math.isfinite(each) else None for each in kelvin]

    def _kT(self) -> float:
        parcel = self._setup.parcel
        dimensions = 2.0 if parcel.planar else 3.0
        return 2.0 * parcel.energy()[0] / (dimensions * max(parcel.number, 1))

    def time(self) -> float:
        """Return the time of the box, in the unit of its stage."""
        return self._setup.parcel.time * self._setup.scale.time / to_si(1.0, self._setup.time_unit)

    def frame(self, sequence: int) -> bytes:
        """Return the present positions of everything that is drawn, as one message to the page."""
        parcel: Any = self._setup.parcel
        scale = self._setup.scale
        snapshot = parcel.snapshot()
        present = parcel.present
        position = np.full((present.size, 3), math.nan)
        shown = np.full(present.size, math.nan)
        position[present] = snapshot.position * scale.length
        if self._counted:
            shown[present] = parcel.neighbours()
        else:
            shown[present] = np.sqrt(np.sum(snapshot.velocity**2, axis=1)) * scale.velocity
        drops = None
        if hasattr(parcel, "drops"):
            centre, radius, _ = parcel.drops()
            drops = np.column_stack([centre, radius]) * scale.length
        return self.stage.frame(
            sequence,
            self.time(),
            parcel.length * scale.length,
            position,
            shown,
            drops=drops,
            liquid=int(getattr(parcel, "liquid", 0)),
            rained=int(getattr(parcel, "rained", 0)),
            highest=NEIGHBOURS if self._counted else self._scale(),
        )


def _swift(mass: NDArray[np.float64]) -> float:
    r"""Return the speed that hardly any molecule exceeds, over :math:`\sqrt{kT}`.

    It is :math:`3 / \sqrt{m}`, in a mixture the c at which the mean of :math:`e^{-m c^2 / 2}` is the same.

    Examples
    --------
    >>> _swift(np.full(5, 4.0)), round(_swift(np.array([1.0, 9.0])), 2)
    (1.5, 2.76)
    """
    known = mass[np.isfinite(mass)]
    if not known.size:
        return _FASTEST
    low, high = 1.0 / known.max(), 1.0 / known.min()
    while high - low > 1e-9 * high:
        middle = 0.5 * (low + high)
        rare = np.exp(-0.5 * _FASTEST**2 * middle * known).mean() < math.exp(-0.5 * _FASTEST**2)
        low, high = (low, middle) if rare else (middle, high)
    return _FASTEST * math.sqrt(high)


def _said(value: object, unit: str) -> str:
    """Return the value of a setting as text for the caption."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return str(value) if isinstance(value, str) else phrase(value, unit)  # type: ignore[arg-type]

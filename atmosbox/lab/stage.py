"""What a page shows of a box that runs, and gets once: its stage and its graphs."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.page import NEIGHBOURS, Box, Stage, stage
from atmosbox.page.lesson import lesson_of
from atmosbox.page.word import card_of
from atmosbox.scene.conversion import phrase
from atmosbox.scene.instruments import wall_laws
from atmosbox.scene.panels import without_headlines
from atmosbox.theory.constants import DRY_AIR, WATER
from atmosbox.version import __version__

if TYPE_CHECKING:
    from atmosbox.scene.panels import Panel
    from atmosbox.scene.setup import Setup
    from atmosbox.simulation.preparation import Prepared

COLDER = 0.5
"""Share of the scale of speeds: if the speeds reach less of it, the page takes another scale."""

_FASTEST = 3.0
_TIME = "elapsed_time"

Array = NDArray[np.float64]


def plain(values: ArrayLike) -> list[float | None]:
    """Return numbers as JSON can hold them, with seven digits; numbers that are not finite become null.

    Examples
    --------
    >>> plain([1.0, math.nan, 1.0 / 3.0])
    [1.0, None, 0.3333333]
    """
    numbers = np.atleast_1d(np.asarray(values, np.float64)).ravel()
    return [float(f"{x:.7g}") if math.isfinite(x) else None for x in numbers.tolist()]


def instrument_of(setup: Setup, kind: type) -> Any:
    """Return the instrument of a kind that a box has; None if it has none."""
    return next((each for each in setup.instruments if type(each) is kind), None)


def running_panels(prepared: Prepared) -> tuple[Panel, ...]:
    """Return the graphs of a scene without what only a whole run knows; an axis of time is linear.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> {panel.x_scale for panel in running_panels(prepare("temperature", {}))}
    {'linear'}
    """
    panels = prepared.module.panels
    found = panels(prepared.settings) if callable(panels) else panels
    return tuple(running for panel in found if (running := _running(panel)) is not None)


def _running(panel: Panel) -> Panel | None:
    """Return a panel without curves that come from headlines, and with linear time; None if nothing is left."""
    found = without_headlines(panel)
    evenly = found is not None and found.lines and all(line.x == _TIME for line in found.lines)
    return replace(found, x_scale="linear") if found is not None and evenly else found


def lab_stage(prepared: Prepared, setup: Setup, panels: tuple[Panel, ...]) -> tuple[Stage, float]:
    """Return what a page shows of a box, and `_swift` of its molecules in m s-1 K-1/2."""
    parcel: Any = setup.parcel
    scale, module, settings = setup.scale, prepared.module, prepared.settings
    present = parcel.present
    mass, diameter = np.full((2, present.size), math.nan)
    mass[present] = parcel.mass * scale.mass
    diameter[present] = parcel.diameter * scale.length
    water = None
    if hasattr(parcel, "vapour"):
        mass[~present] = WATER.molecule_mass  # only molecules of water ever leave the gas
        diameter[~present] = float(np.nanmax(diameter)) if present.any() else DRY_AIR.diameter
        water = mass < 0.5 * (DRY_AIR.molecule_mass + WATER.molecule_mass)
    fast = _swift(mass / scale.mass)
    counted = hasattr(parcel, "neighbours")  # colours show neighbours, because speeds do not show drops
    made = stage(
        scene=prepared.scene,
        title=str(getattr(module, "title", prepared.scene)),
        story=lesson_of(module).story or (module.__doc__ or "").strip().split("\n\n")[0].replace("\n", " "),
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
        fastest=NEIGHBOURS if counted else fast * math.sqrt(_warmest(setup)) * scale.velocity,
        panels=panels,
        discs=any(panel.kind == "discs" for panel in panels),
        counted=counted,
    )
    made.record["card"] = card_of(module.__doc__ or "")
    return made, fast * scale.velocity / math.sqrt(scale.temperature)


def _warmest(setup: Setup) -> float:
    """Return the highest temperature of gas and walls [reduced]."""
    parcel = setup.parcel
    gas = 2.0 * parcel.energy()[0] / ((2.0 if parcel.planar else 3.0) * max(parcel.number, 1))
    return float(np.nanmax([*parcel.wall_kT(), gas]))


def _swift(mass: Array) -> float:
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

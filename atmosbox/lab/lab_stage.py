"""What a page shows of a box that runs, and gets once: its stage, its graphs, and the planned ascent on their axes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.page import NEIGHBOURS, Box, Stage, stage
from atmosbox.page.lesson import lesson_of
from atmosbox.page.word import card_of
from atmosbox.scene.conversion import phrase, to_si
from atmosbox.scene.instruments import Environment, wall_laws
from atmosbox.scene.panels import without_headlines
from atmosbox.theory.constants import DRY_AIR, WATER
from atmosbox.version import __version__

if TYPE_CHECKING:
    from atmosbox.scene.panels import Panel
    from atmosbox.scene.setup import Setup
    from atmosbox.simulation.preparation import Prepared

__all__ = ["COLDER", "lab_stage", "plain", "running_panels"]

COLDER = 0.5
"""Share of the scale of speeds: if the speeds reach less of it, the page takes another scale."""

_FASTEST = 3.0
_PLACES = 60
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
    return tuple(shown for panel in found if (shown := _running(panel)) is not None)


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
    way = _planned_ascent(setup)
    made.record["card"] = card_of(module.__doc__ or "")
    for record in made.record["panels"]:
        record["planned"] = _points(record, way)
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


def _planned_ascent(setup: Setup) -> dict[str, Array]:
    """Return the planned ascent of a parcel by the names of variables [SI]; empty for another box.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import build, prepare
    >>> way = _planned_ascent(build(prepare("lifting-dry", {"molecules": 100})))
    >>> [round(float(p) / 100.0) for p in way["environment_pressure"][[0, -1]]]
    [1000, 300]
    """
    found = (getattr(instrument, "environment", None) for instrument in setup.instruments)
    around = next((each for each in found if isinstance(each, Environment)), None)
    if not setup.ends or around is None:
        return {}
    seconds = np.linspace(0.0, setup.duration * setup.scale.time, _PLACES)
    pressure = np.array([around.pressure(t) for t in seconds])
    way = {
        _TIME: seconds / to_si(1.0, setup.time_unit),
        "parcel_height": np.array([around.height(t) for t in seconds]),
        "parcel_pressure": pressure,
        "environment_pressure": pressure,
        "environment_temperature": np.array([around.temperature(t) for t in seconds]),
        "adiabat_temperature": np.array([around.adiabat(p) for p in pressure]),
    }
    return {name: values for name, values in way.items() if np.isfinite(values).all()}


def _points(panel: Mapping[str, Any], way: Mapping[str, Array]) -> dict[str, list[float]]:
    """Return the points of a planned ascent that the axes of a panel must include, in the units of the panel."""
    points: dict[str, list[float]] = {"x": [], "y": []}
    for line in panel["lines"]:
        if "minus" in line or not {line["x"]["name"], line["y"]["name"]} <= set(way):
            continue
        for axis in ("x", "y"):
            values = way[line[axis]["name"]] * line[axis]["factor"] + line[axis]["offset"]
            points[axis] += [float(f"{value:.5g}") for value in values if math.isfinite(value)]
    return points


def _said(value: object, unit: str) -> str:
    """Return the value of a setting as text for the caption."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return str(value) if isinstance(value, str) else phrase(value, unit)  # type: ignore[arg-type]

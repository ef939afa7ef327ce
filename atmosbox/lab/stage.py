"""What a page shows of a box that runs, and gets once: its stage and its graphs."""

from __future__ import annotations

import functools
import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.file.molecules import Molecules
from atmosbox.page import NEIGHBOURS, Stage, stage
from atmosbox.page.lesson import lesson_of
from atmosbox.page.panel import declared, panel_record
from atmosbox.page.word import card_of
from atmosbox.scene import instruments
from atmosbox.scene.panels import without_headlines
from atmosbox.version import __version__

if TYPE_CHECKING:
    from atmosbox.scene.panels import Panel
    from atmosbox.scene.setup import Setup
    from atmosbox.simulation.preparation import Prepared

COLDER = 0.5
"""Share of the scale of speeds: if the speeds reach less of it, the page takes another scale."""

_FASTEST, _STEPS = 3.0, 60
"""The highest speed of the scale, over that of kT = m; and number of speeds that are tried for a mixture."""
_TIME = "elapsed_time"

Array = NDArray[np.float64]


def instrument_of(setup: Setup, kind: type) -> Any:
    """Return the instrument of a kind that a box has; None if it has none."""
    return next((each for each in setup.instruments if type(each) is kind), None)


def running_panels(prepared: Prepared) -> tuple[Panel, ...]:
    """Return the graphs of a scene without what only a whole run knows; an axis of time is linear."""
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
    scale, module = setup.scale, prepared.module
    all_of_them = instruments.Molecules(setup.right)
    all_of_them.end_frame(parcel, parcel.snapshot())
    told = all_of_them.readings(scale, 0)
    seen = Molecules(
        discs=any(panel.kind == "discs" for panel in panels),
        time=np.zeros(1),
        **{name: told[f"molecule_{name}"] for name in ("position", "speed", "mass", "diameter")},
        water=told["species"] == 1 if "species" in told else None,
        side=told["box_side"],
        walls=instruments.wall_laws(parcel),
        wall_temperature=parcel.wall_kT()[None] * scale.temperature,
        planar=parcel.planar,
        gravity=parcel.gravity > 0.0,
        drops=told.get("drop_position"),
        neighbours=told.get("molecule_neighbour_count"),  # shown as colours, because speeds do not show drops
        right=setup.right,
    )
    fast = _swift(np.asarray(seen.mass, np.float64) / scale.mass)
    tell = functools.partial(declared, time_unit=setup.time_unit)
    made = stage(
        seen,
        title=str(getattr(module, "title", prepared.scene)),
        story=lesson_of(module).story or (module.__doc__ or "").strip().split("\n\n")[0].replace("\n", " "),
        time_unit=setup.time_unit,
        fastest=NEIGHBOURS if seen.neighbours is not None else fast * math.sqrt(_warmest(setup)) * scale.velocity,
        panels=[panel_record(each, tell) for each in panels if each.kind != "discs"],
    )
    made.record.update(
        scene=prepared.scene, seed=prepared.settings.seed, engine=str(prepared.engine), version=__version__,
        card=card_of(module.__doc__ or ""),
    )  # fmt: skip
    return made, fast * scale.velocity / math.sqrt(scale.temperature)


def _warmest(setup: Setup) -> float:
    """Return the highest temperature of gas and walls [reduced]."""
    parcel = setup.parcel
    gas = 2.0 * parcel.energy()[0] / ((2.0 if parcel.planar else 3.0) * max(parcel.number, 1))
    return float(np.nanmax([*parcel.wall_kT(), gas]))


def _swift(mass: Array) -> float:
    r"""Return the speed that hardly any molecule exceeds, over :math:`\sqrt{kT}`.

    It is :math:`3 / \sqrt{m}`, in a mixture the c at which the mean of :math:`e^{-m c^2 / 2}` is the same.

    >>> _swift(np.full(5, 4.0)), round(_swift(np.array([1.0, 9.0])), 2)
    (1.5, 2.76)
    """
    known = mass[np.isfinite(mass)]
    if not known.size:
        return _FASTEST
    inverse = np.geomspace(1.0 / known.max(), 1.0 / known.min(), _STEPS)
    share = [float(np.exp(-0.5 * _FASTEST**2 * each * known).mean()) for each in inverse]
    return _FASTEST * math.sqrt(np.interp(-math.exp(-0.5 * _FASTEST**2), np.negative(share), inverse))

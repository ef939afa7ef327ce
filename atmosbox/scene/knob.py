"""What may be changed while a box runs: its name, its range, and what changes in the box.

A scene lists its knobs in its `Setup`, beside its instruments. The page of `atmosbox.lab` has a slider for each that
its kernels know; every other setting has a control, too, but changing it begins the box again.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from atmosbox.engine.core.schedule import interpolate
from atmosbox.scene.conversion import from_si, to_si
from atmosbox.scene.units import rounded

if TYPE_CHECKING:
    from atmosbox.engine import FollowPressure, Parcel
    from atmosbox.scene.settings import SceneSettings
    from atmosbox.scene.units import Scale


@dataclass(frozen=True)
class Knob:
    """A property of a box that may be changed while the box runs.

    Parameters
    ----------
    name
        Its name; if it is the name of a setting, that setting is changed without a new start.
    help
        What it is, in one line.
    low, high, value, unit
        The lowest and the highest value and that at the start, in their unit, as settings spell it.
    turn
        Function that is called with the new value in SI units; may raise `atmosbox.engine.RefusedError`.
    leave
        Function that restores the box as it was before the knob was first turned; None if turning it to `value` does.
    wall
        The number of the wall whose temperature it sets; None for all walls, or for another property.
    places
        For a knob that moves a parcel to a height: heights [m], increasing, and the share of the path at each.

    Raises
    ------
    ValueError
        If the value does not lie between the lowest and the highest.

    >>> seen = []
    >>> Knob("temperature", "of the walls", "degC", 0.0, 100.0, 25.0, seen.append).set(50.0)
    >>> seen
    [323.15]
    """

    name: str
    help: str
    unit: str
    low: float
    high: float
    value: float
    turn: Callable[[float], None]
    leave: Callable[[], None] | None = None
    wall: int | None = None
    places: tuple[tuple[float, ...], tuple[float, ...]] | None = None

    def __post_init__(self) -> None:
        if not self.low <= self.value <= self.high:
            raise ValueError(f"the knob {self.name} stands at {self.value}, outside {self.low} to {self.high}")

    def set(self, value: float) -> None:
        """Set the knob to a value in its unit."""
        self.turn(value if self.unit in ("", "1") else to_si(value, self.unit))

    def reset(self) -> None:
        """Restore the property as it was before the knob was first turned; what has happened since stays."""
        if self.leave is None:
            self.set(self.value)
        else:
            self.leave()


def wall_temperature(
    parcel: Parcel, scale: Scale, settings: SceneSettings, *, name: str = "temperature", wall: int | None = None,
    low: float, high: float,
) -> Knob:  # fmt: skip
    """Return the knob that sets the temperature of the heat baths of a box.

    It has the name of a setting, and starts at the value of that setting. ``wall`` is the number of the wall, in the
    order of `atmosbox.engine.core.walls.WALL_NAMES`, None for all heat baths. The range from ``low`` to ``high``, in
    the unit of the setting, is widened to include the first value.

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> setup = build(prepare("temperature", {"temperature": "20 degC"}))
    >>> [(knob.name, knob.value, knob.unit) for knob in setup.knobs]
    [('temperature', 20.0, 'degC')]
    """
    knob = _of_setting(
        settings, name, low, high, lambda kelvin: parcel.set_wall_kT(scale.reduced_temperature(kelvin), wall)
    )
    return replace(knob, wall=wall)


def gravity(parcel: Parcel, scale: Scale, settings: SceneSettings, *, low: float, high: float) -> tuple[Knob, ...]:
    """Return the knob that sets gravity; nothing for a box without gravity, whose kernels have none.

    ``low`` and ``high`` are the range in the unit of the setting, above 0; it is widened to include the first value.

    The work of a change is in the energy budget:

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> setup = build(prepare("convection", {"molecules": 200}))
    >>> knob = {knob.name: knob for knob in setup.knobs}["gravity"]
    >>> knob.set(20.0)
    >>> setup.parcel.gravity_work > 0.0, setup.parcel.ledger() < 1e-12
    (True, True)
    """
    if not parcel.gravity > 0.0:
        return ()
    unit = scale.acceleration
    return (_of_setting(settings, "gravity", low, high, lambda value: parcel.set_gravity(rounded(value / unit))),)


def warmed_walls(
    parcel: Parcel, settings: SceneSettings, name: str, help: str, walls: Sequence[int], kT: Callable[[float], float],
    *, low: float, high: float,
) -> Knob:  # fmt: skip
    """Return the knob that turns smooth walls into heat baths at its first turn, and sets their temperature.

    Until then the walls are those of the scene, so that a run in which no knob is turned is that of ``atmosbox run``.
    ``name``, ``low`` and ``high`` are as in `wall_temperature`, ``walls`` are the numbers of the walls, and ``help``
    says in one line what the knob is. ``kT`` gives the temperature of the walls [reduced energy] for a value in SI
    units.

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> setup = build(prepare("evaporation", {"molecules": 200, "pool": 40}))
    >>> bool(np.isnan(setup.parcel.wall_kT()).all())
    True
    >>> setup.knobs[0].set(20.0)
    >>> np.isfinite(setup.parcel.wall_kT()).tolist()
    [True, True, True, True, False, False]
    >>> setup.knobs[0].reset()
    >>> bool(np.isnan(setup.parcel.wall_kT()).all())
    True
    """
    from atmosbox.engine import HeatBath, Specular

    def become(kind: HeatBath | Specular) -> None:
        for wall in walls:
            parcel.set_wall(wall, kind)

    knob = _of_setting(settings, name, low, high, lambda value: become(HeatBath(rounded(kT(value)))))
    return replace(knob, help=help, leave=lambda: become(Specular()))


def open_pool(parcel: Any) -> Knob:
    """Return the knob that covers a part of a pool, or all of it, with a foil; see `set_open_pool` of the box.

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> setup = build(prepare("evaporation", {"molecules": 300, "pool": 50}))
    >>> setup.knobs[1].set(0.0)
    >>> setup.parcel.advance(20.0)
    >>> setup.parcel.evaporated, setup.parcel.condensed, setup.parcel.ledger() < 1e-12
    (0, 0, True)
    """
    help = "share of the pool that is open; the rest is covered"
    return Knob("open_pool", help, "percent", 0.0, 100.0, 100.0, lambda share: parcel.set_open_pool(share))


def altitude(parcel: Parcel, driver: FollowPressure, height: Callable[[float], float]) -> Knob:
    """Return the knob that moves a parcel up and down, at the speed of its planned ascent.

    ``height`` gives the height [m] after a share of the ascent, 0 to 1; it increases.

    If the knob is not turned, the parcel rises to the top:

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> setup = build(prepare("lifting-dry", {"molecules": 100}))
    >>> setup.knobs[0].name, setup.knobs[0].unit, setup.knobs[0].value == setup.knobs[0].high
    ('altitude', 'km', True)
    """
    shares = np.linspace(0.0, 1.0, 401)
    # seven digits, as in the page, which finds the same place to the last bit
    heights = np.array([float(f"{height(float(share)):.7g}") for share in shares])

    def turn(metres: float) -> None:
        _lead(parcel, driver, rounded(float(interpolate(metres, heights, shares))))

    low, high = (from_si(float(h), "km") for h in (heights[0], heights[-1]))
    places = tuple(heights.tolist()), tuple(shares.tolist())
    return Knob("altitude", "height to which the parcel moves", "km", low, high, high, turn, places=places)


def way(parcel: Parcel, driver: FollowPressure) -> Knob:
    """Return the knob that moves a parcel back and forth along a path that goes up and down.

    >>> from atmosbox.simulation.preparation import build, prepare
    >>> [knob.name for knob in build(prepare("mountains", {"molecules": 200})).knobs]
    ['way']
    """
    help = "place on its path to which the parcel moves"
    return Knob("way", help, "percent", 0.0, 100.0, 100.0, lambda share: _lead(parcel, driver, share))


def _lead(parcel: Parcel, driver: FollowPressure, share: float) -> None:
    """Make a parcel move to a place on its path, given as a share of the path."""
    course = driver.course
    if not course.led:
        course.lead(0.0, course.end)  # as planned, but interpolated as in the page, to the last bit
    course.lead(parcel.time, min(max(share, 0.0), 1.0) * course.end)


def _of_setting(settings: SceneSettings, name: str, low: float, high: float, turn: Callable[[float], None]) -> Knob:
    """Return the knob of a setting, with a range that fits a slider."""
    declared = {parameter.name: parameter for parameter in settings.describe()}[name]
    value = float(getattr(settings, name))
    least = max(min(low, value), -math.inf if declared.low is None else declared.low)
    most = min(max(high, value), math.inf if declared.high is None else declared.high)
    return Knob(name, declared.help, declared.unit, least, most, value, turn)

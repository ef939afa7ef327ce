"""How a scene draws and places its molecules, so that a page can do it with another seed.

A scene does this in Python, with the functions of `atmosbox.engine.start`. This module records which of them the scene
calls, after how many random numbers, and with which results. It is not assumed that the seed decides nothing else:
`seeding` builds the same scene with another seed, and the two boxes must differ in nothing else.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from atmosbox.engine import RandomNumbers, clear_of_drops, equal_speeds, maxwell_velocities, rotational_energies
from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.lift import Gauges
from atmosbox.engine.core.walls import HEAT_BATH
from atmosbox.engine.start.overlap import bins_of, spheres_of
from atmosbox.lab.kernels.pairwise import DEPTH
from atmosbox.lab.kernels.starting import ALONG_X, AS_PLACED, SHUFFLED, STEP, Cleared, Start, can_start
from atmosbox.scene import moisture
from atmosbox.scene.engines import EngineChoice
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared

__all__ = ["Watched", "no_start", "start_of", "watched"]

Array = NDArray[np.float64]

_WORD = 1 << 64
_DRAWING = (maxwell_velocities, equal_speeds, rotational_energies, clear_of_drops)
_PLACING = {"length", "diameter", "periodic", "planar", "top", "scale_height"}
"""The options that a scene may use to place its molecules."""


@dataclass
class Watched:
    """The recorded calls of a scene: arguments, result, and number of random numbers drawn before the call."""

    placed: list[tuple[dict[str, Any], Array, int, int]] = field(default_factory=list)
    moved: list[tuple[str, dict[str, Any], Array, int]] = field(default_factory=list)
    turned: list[tuple[str, dict[str, Any], Array, int]] = field(default_factory=list)
    cleared: list[tuple[str, dict[str, Any], Array, int]] = field(default_factory=list)
    made: list[tuple[Array, Array, Array]] = field(default_factory=list)


def _count(rng: RandomNumbers, seed: int) -> int:
    """Return the number of random numbers that have been drawn."""
    gone = (int(rng.state[0]) - int(RandomNumbers(seed).state[0])) % _WORD
    return gone * pow(STEP, -1, _WORD) % _WORD


@contextmanager
def watched(prepared: Prepared) -> Iterator[Watched]:
    """Record which functions a scene calls to start its box."""
    seen, seed = Watched(), int(prepared.settings.seed)
    places = [vars(moisture), prepared.module.build.__globals__]
    usual = [(names, each) for names in places for each in _DRAWING if each.__name__ in names]
    scatter, make = EngineChoice.scatter, EngineChoice.make

    def drawing(name: str, function: Callable[..., Array]) -> Callable[..., Array]:
        def draw(*given: Any, **named: Any) -> Array:
            told = inspect.signature(function).bind(*given, **named)
            told.apply_defaults()
            before = _count(told.arguments["rng"], seed)
            made = function(*given, **named)
            kept = {rotational_energies: seen.turned, clear_of_drops: seen.cleared}.get(function, seen.moved)
            kept.append((name, dict(told.arguments), made.copy(), before))
            return made

        return draw

    def place(self: EngineChoice, length: Any, diameter: Any, rng: Any, **options: Any) -> Array:
        before = _count(rng, seed)
        made = scatter(self, length, diameter, rng, **options)
        told = {"length": length, "diameter": np.array(diameter), **options}
        seen.placed.append((told, made.copy(), before, _count(rng, seed)))
        return made

    def put(self: EngineChoice, position: Any, velocity: Any, **box: Any) -> Any:
        spin = np.array(box.get("rotational_energy", np.zeros(len(position))))
        seen.made.append((np.array(position), np.array(velocity), spin))
        return make(self, position, velocity, **box)

    try:
        EngineChoice.scatter, EngineChoice.make = place, put  # type: ignore[method-assign]
        for names, each in usual:
            names[each.__name__] = drawing(each.__name__, each)
        yield seen
    finally:
        EngineChoice.scatter, EngineChoice.make = scatter, make  # type: ignore[method-assign]
        for names, each in usual:
            names[each.__name__] = each


def start_of(prepared: Prepared, setup: Setup, seen: Watched) -> Start | None:
    """Return the data with which a page draws and places the molecules of a recorded start; None if it cannot.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import build, prepare
    >>> scene = prepare("temperature", {"molecules": 20})
    >>> with watched(scene) as seen:
    ...     box = build(scene)
    >>> start = start_of(scene, box, seen)
    >>> start.motion, start.place  # velocities are drawn first
    (0, 60)
    """
    seed = int(prepared.settings.seed)
    if not (len(seen.placed) == len(seen.moved) == len(seen.made) == 1):
        return None
    (told, placed, before, after), (position, velocity, spin) = seen.placed[0], seen.made[0]
    name, asked, moved, motion = seen.moved[0]
    parcel: Any = setup.parcel
    if not can_start(parcel._modes) or set(told) - _PLACING or asked["planar"] != parcel.planar:
        return None
    if not len(position) or moved.shape != position.shape or (moved != velocity).any():
        return None
    if parcel._modes.gravity and parcel._modes.mixed:
        return None
    numbered = _numbered(placed, position, after, seed) if not seen.cleared else _as_cleared(seen, position)
    rotates = _rotating(seen, spin) if parcel._rotates else {}
    if numbered is None or rotates is None:
        return None
    n = len(position)
    same = name == "equal_speeds"
    mass = np.broadcast_to(asked.get("mass", 1.0), (n,))
    kT = np.broadcast_to(asked.get("kT", 0.0), (n,))
    twice = 0.0
    if asked.get("exact") and n > 1 and kT.mean() > 0.0:
        if (mass != parcel.mass).any():
            return None
        twice = (2.0 if parcel.planar else 3.0) * float(kT.sum())
    return _start(parcel, told["diameter"], told.get("top"), _cleared(parcel, seen))._replace(
        place=before,
        order=after,
        motion=motion,
        numbered=numbered,
        scale_height=float(told.get("scale_height") or 0.0),
        speed=float(asked["speed"]) if same else 0.0,
        twice=twice,
        weight=float(np.array(mass).sum()),
        factor=np.zeros(n) if same else np.sqrt(kT / mass),
        **rotates,
    )


def _rotating(seen: Watched, spin: Array) -> dict[str, Any] | None:
    """Return the data with which rotational energies are drawn; None if a page cannot draw them."""
    if len(seen.turned) != 1:
        return None
    _, asked, drawn, first = seen.turned[0]
    degrees = np.asarray(asked["rotation"])
    if degrees.shape != spin.shape or np.ndim(asked["kT"]):
        return None
    rotating = 0.0
    if (spin != drawn).any():  # scaled, to kT / 2 for each degree of freedom
        rotating = 0.5 * float(degrees.sum())
        if (spin != drawn * (rotating / drawn.sum())).any():
            return None
    degrees = degrees.astype(np.float64)
    return {"rotation": first, "rotating": rotating, "warmth": float(asked["kT"]), "degrees": degrees}


def _numbered(placed: Array, position: Array, after: int, seed: int) -> int | None:
    """Return in which order molecules were numbered after they were placed; None if the order is not a known one."""
    rng = RandomNumbers(seed)
    rng.random(after)
    orders = {
        AS_PLACED: np.arange(len(placed)),
        SHUFFLED: np.argsort(rng.random(len(placed)), kind="stable"),
        ALONG_X: np.argsort(placed[:, 0], kind="stable"),
    }
    return next((which for which, order in orders.items() if np.array_equal(placed[order], position)), None)


def _as_cleared(seen: Watched, position: Array) -> int | None:
    """Return the order of molecules that made room for drops once, after everything else was drawn; otherwise None."""
    _, told, made, first = seen.cleared[0]
    _, placed, _, after = seen.placed[0]
    last = len(seen.cleared) == 1 and first == after >= max(each[-1] for each in (*seen.moved, *seen.turned))
    return AS_PLACED if last and (told["position"] == placed).all() and (made == position).all() else None


def no_start(setup: Setup) -> Start | None:
    """Return what a module needs to be loaded where the seed is fixed, so that the page never draws another start.

    None if its module has no kernels for a start.
    """
    parcel: Any = setup.parcel
    if not can_start(parcel._modes):
        return None
    return _start(parcel, np.array(parcel.diameter), None, _cleared(parcel, Watched()))


def _start(parcel: Any, diameter: Array, top: float | None, cleared: Any) -> Start:
    """Return a start with all data that follow from the box, without its cells, for molecules placed below ``top``."""
    n, planar = parcel.number, bool(parcel.planar)
    sides = np.array(parcel._sides)
    spread = _spread(parcel, sides)
    sides[2] = sides[2] if top is None else top
    spheres = spheres_of(diameter, sides, parcel._periodic, planar)
    liquid = float(parcel.condensed_energy), _warm(parcel)
    return Start(
        0, 0, 0, 0, AS_PLACED, 0.0, int(planar), 0.0, 0.0, 0.0, 0.0, 0.0, *liquid,
        spheres, bins_of(spheres), np.zeros(n), np.array(parcel.mass), np.zeros(n), spread, _first_gauges(parcel),
        0, cleared, np.zeros((n, 3)), np.zeros(3 * n), np.zeros(n, np.int64), np.zeros(n, np.int64),
        np.zeros((DEPTH, 2), np.int64), np.zeros(DEPTH), np.zeros(1, np.uint64),
    )  # fmt: skip


def _spread(parcel: Any, sides: Array) -> Array:
    """Return the spacing of molecules, and the fastest speed of walls and of a fall over it: see `natural_time`."""
    walls = parcel._walls
    spacing = float(cbrt(math.prod(sides.tolist()) / max(parcel.number, 1)))
    first = zip(walls.law, walls.schedule_kT[walls.schedule[:-1]], strict=True)
    fastest = [math.sqrt(float(kT) / float(parcel.mass.mean())) for law, kT in first if law == HEAT_BATH]
    fastest.append(math.sqrt(parcel.gravity * spacing))
    return np.array([spacing, max(fastest)])


def _warm(parcel: Any) -> float:
    """Return a speed of molecules that leave the warmest wall; 0 in a box without liquid: see `MoistParcelSet`."""
    baths = [float(kT) for kT in parcel.wall_kT() if math.isfinite(kT)]
    return math.sqrt(8.0 * max(baths, default=0.0) / parcel._liquid.substance.mass) if parcel._modes.phases else 0.0


def _first_gauges(parcel: Any) -> Any:
    """Return the data of the gas that the law of the piston needs at the start, without energy; 0 without ascent."""
    if not parcel._ascends:
        return 0
    open_height = parcel.ceiling - float(parcel.diameter.mean())
    return Gauges(
        0.0, parcel.number, parcel.degrees_of_freedom, 2.0 if parcel.planar else 3.0, 0.0, 0.0, parcel.open_density,
        open_height,
    )  # fmt: skip


def _cleared(parcel: Any, seen: Watched) -> Any:
    """Return the drops that molecules make room for; 0 in a box without drops."""
    if not parcel._modes.drops:
        return 0
    if not seen.cleared:
        return Cleared(np.zeros((0, 3)), np.zeros(0), 0.0)
    told = seen.cleared[0][1]
    return Cleared(np.array(told["centre"], np.float64), np.array(told["reach"], np.float64), float(told["side"]))

"""How a scene draws and places its molecules, so that a page can do it with another seed.

A scene says so in Python, with the functions of `atmosbox.engine.start`. Here it is watched while it does: which of
them it calls, after how many random numbers, and what becomes of the result. Whether that is all that a seed decides
is not assumed: the same scene is built with another seed, and the two boxes must differ in nothing else.
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

from atmosbox.engine import RandomNumbers, equal_speeds, maxwell_velocities
from atmosbox.engine.core.elementary import cbrt
from atmosbox.engine.core.inputs import natural_time
from atmosbox.engine.core.walls import HEAT_BATH
from atmosbox.engine.start.overlap import _bins, _Spheres
from atmosbox.lab.kernels.starting import ALONG_X, AS_PLACED, SHUFFLED, STEP, Start, can_start
from atmosbox.scene.engines import EngineChoice
from atmosbox.scene.setup import Setup
from atmosbox.simulation.preparation import Prepared

__all__ = ["Watched", "no_start", "start_of", "watched"]

Array = NDArray[np.float64]

_GAP = 1e-6
_WORD = 1 << 64


@dataclass
class Watched:
    """What a scene has called: with what, what came of it, and how many random numbers had been drawn."""

    placed: list[tuple[dict[str, Any], Array, int, int]] = field(default_factory=list)
    moved: list[tuple[str, dict[str, Any], Array, int]] = field(default_factory=list)
    made: list[tuple[Array, Array]] = field(default_factory=list)


def _count(rng: RandomNumbers, seed: int) -> int:
    """Return how many random numbers have been drawn."""
    gone = (int(rng.state[0]) - int(RandomNumbers(seed).state[0])) % _WORD
    return gone * pow(STEP, -1, _WORD) % _WORD


@contextmanager
def watched(prepared: Prepared) -> Iterator[Watched]:
    """Watch how a scene begins its box."""
    seen, seed = Watched(), int(prepared.settings.seed)
    names = prepared.module.build.__globals__
    usual = {each.__name__: each for each in (maxwell_velocities, equal_speeds) if each.__name__ in names}
    scatter, make = EngineChoice.scatter, EngineChoice.make

    def drawing(name: str, function: Callable[..., Array]) -> Callable[..., Array]:
        def draw(*given: Any, **named: Any) -> Array:
            told = inspect.signature(function).bind(*given, **named)
            told.apply_defaults()
            before = _count(told.arguments["rng"], seed)
            seen.moved.append((name, dict(told.arguments), made := function(*given, **named), before))
            return made

        return draw

    def place(self: EngineChoice, length: Any, diameter: Any, rng: Any, **options: Any) -> Array:
        before = _count(rng, seed)
        made = scatter(self, length, diameter, rng, **options)
        told = {"length": length, "diameter": np.array(diameter), **options}
        seen.placed.append((told, made.copy(), before, _count(rng, seed)))
        return made

    def put(self: EngineChoice, position: Any, velocity: Any, **box: Any) -> Any:
        seen.made.append((np.array(position), np.array(velocity)))
        return make(self, position, velocity, **box)

    try:
        EngineChoice.scatter, EngineChoice.make = place, put  # type: ignore[method-assign]
        names.update({name: drawing(name, each) for name, each in usual.items()})
        yield seen
    finally:
        EngineChoice.scatter, EngineChoice.make = scatter, make  # type: ignore[method-assign]
        names.update(usual)


def start_of(prepared: Prepared, setup: Setup, seen: Watched) -> Start | None:
    """Return how a page draws and places the molecules of a box that was watched; None if it cannot.

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
    (told, placed, before, after), (position, velocity) = seen.placed[0], seen.made[0]
    name, asked, moved, motion = seen.moved[0]
    parcel: Any = setup.parcel
    if not can_start(parcel._modes):
        return None
    if set(told) - {"length", "diameter", "periodic"} or asked["planar"] or asked.get("exact"):
        return None
    if not len(position) or moved.shape != position.shape or (moved != velocity).any():
        return None
    numbered = _numbered(placed, position, after, seed)
    if numbered is None:
        return None
    n = len(position)
    same = name == "equal_speeds"
    factor = np.zeros(n) if same else np.sqrt(np.broadcast_to(asked["kT"], (n,)) / np.asarray(asked["mass"]))
    found = _start(parcel, told["diameter"])
    return found._replace(
        place=before,
        order=after,
        motion=motion,
        numbered=numbered,
        speed=float(asked["speed"]) if same else 0.0,
        factor=factor,
    )


def _numbered(placed: Array, position: Array, after: int, seed: int) -> int | None:
    """Tell how molecules have been numbered after they were placed, None if in no way that is known."""
    rng = RandomNumbers(seed)
    rng.random(after)
    orders = {
        AS_PLACED: np.arange(len(placed)),
        SHUFFLED: np.argsort(rng.random(len(placed)), kind="stable"),
        ALONG_X: np.argsort(placed[:, 0], kind="stable"),
    }
    return next((which for which, order in orders.items() if np.array_equal(placed[order], position)), None)


def no_start(setup: Setup) -> Start | None:
    """Return what stands for the start where a box has the seed of its page alone; None where no module asks for it."""
    if not can_start(setup.parcel._modes):  # type: ignore[attr-defined]
        return None
    return _start(setup.parcel, np.array(setup.parcel.diameter))


def _start(parcel: Any, diameter: Array) -> Start:
    """Return a start with all that the box decides."""
    n = parcel.number
    radius = 0.5 * diameter
    sides, turns = np.array(parcel._sides), np.array(parcel._periodic)
    low = np.where(turns, 0.0, 1.0)[None, :] * 0.5 * diameter[:, None]
    high = sides[None, :] - low
    turn = sides * turns
    spacing = float(cbrt(math.prod(sides.tolist()) / max(n, 1)))
    warm = bool((parcel._walls.law == HEAT_BATH).any())
    # molecules at rest pass their neighbours as fast as the walls make them
    fastest = spacing / natural_time(np.zeros((1, 3)), sides, n, parcel._walls, parcel.mass, 0.0) if warm else 0.0
    flags = (np.zeros(n, np.bool_), np.zeros(n, np.bool_))
    return Start(
        0, 0, 0, AS_PLACED, 0.0,
        _Spheres(np.zeros((n, 3)), radius, low, high, turn, *flags),
        _bins(radius, low, high, turn, _GAP),
        np.zeros(n), np.array([spacing, fastest]), np.zeros((n, 3)), np.zeros(n), np.zeros(n, np.int64),
        np.zeros(n, np.int64), np.zeros(1, np.uint64),
    )  # fmt: skip

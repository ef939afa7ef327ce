"""One engine in one extreme: under guard, so that it can neither hang nor break a law unseen."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from atmosbox.engine import Parcel, Periodic, RefusedError, Specular, Wall, maxwell_velocities, random_positions
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.scene.engines import EngineChoice
from atmosbox.trade.extremes.verdict import Verdict, wrong

__all__ = ["Candidate", "Trial", "UnlawfulError"]

APPROXIMATE = ("stepped", "dsmc", "classic")

_LEDGER = 1e-10
_OUTSIDE = 1e-9
_OVERLAP = 1e-9

Array = NDArray[np.float64]


class Candidate(Protocol):
    """What is assessed: an engine with its options, as `atmosbox.scene.engines.choose` returns it."""

    @property
    def name(self) -> str:
        """The name of the engine."""

    def make(self, *arrays: Any, **box: Any) -> Parcel:
        """Return a parcel."""


class UnlawfulError(Exception):
    """A state or a behaviour that no engine may have."""


class Trial:
    """An engine on the bench.

    Boxes are made by `box` and advanced by `run`, which stops what hangs and looks, after every run, whether
    the state is still lawful: all molecules there and inside, every number finite, the ledger closed.

    Parameters
    ----------
    candidate
        The engine.
    limit
        For how long all runs together may take, of the processor's time [s]; compiling is not counted.
    """

    def __init__(self, candidate: Candidate, limit: float = 60.0) -> None:
        self.engine = candidate.name
        self.limit = limit
        self.stopped = threading.Event()
        self.exact = candidate.name not in APPROXIMATE
        self._candidate = candidate
        self._spent = 0.0

    # ------------------------------------------------------------------ boxes

    def box(self, position: Any, velocity: Any, *, options: Mapping[str, Any] | None = None, **box: Any) -> Parcel:
        """Return a parcel of the engine; the arguments are those of `Parcel`, and options of the engine."""
        candidate = self._candidate
        if isinstance(candidate, EngineChoice):
            candidate = replace(candidate, options={**candidate.options, **(options or {})})
        parcel = candidate.make(position, velocity, **box)
        self._look(parcel)
        return parcel

    def gas(
        self,
        number: int,
        length: tuple[float, float, float],
        *,
        seed: int = 1,
        kT: float = 1.0,
        diameter: ArrayLike = 1.0,
        mass: ArrayLike = 1.0,
        walls: tuple[Wall, ...] = (Specular(),) * 6,
        top: float | None = None,
        **box: Any,
    ) -> Parcel:
        """Return a box of molecules at random places with Maxwell's velocities, their energy that of kT."""
        rng = np.random.default_rng(seed)
        sizes = np.broadcast_to(np.asarray(diameter, np.float64), number)
        masses = np.broadcast_to(np.asarray(mass, np.float64), number)
        open_axes = tuple(isinstance(wall, Periodic) for wall in walls[::2])
        periodic = (open_axes[0], open_axes[1], open_axes[2])
        x = random_positions(length, sizes, rng, periodic=periodic, top=top)
        v = maxwell_velocities(kT, masses, rng, exact=True)
        return self.box(x, v, length=length, diameter=sizes, mass=masses, walls=walls, seed=seed, **box)

    # ------------------------------------------------------------------ time

    def run(self, parcel: Parcel, until: float) -> Parcel:
        """Let time pass, under guard; return the parcel."""
        began: list[float] = []  # the time of the processor counts, which others may have slowed down

        def watch(_: float) -> None:
            now = time.thread_time()
            began.append(now) if not began else None
            if self.stopped.is_set() or self._spent + now - began[0] > self.limit:
                raise UnlawfulError(f"hangs: not at t = {until:g} after {self.limit:g} s, but at {parcel.time:.6g}")

        try:
            parcel.advance(until, watch)
        finally:
            self._spent += time.thread_time() - began[0] if began else 0.0
            self._look(parcel)
        late = parcel.time - until
        step = parcel.time_step if isinstance(parcel, MarchingParcel) else 0.0
        slack = 1e-9 * max(abs(until), step)
        if not -step - slack <= late <= slack:
            raise UnlawfulError(f"asked to advance to t = {until:.9g}, it stands at {parcel.time:.9g}")
        return parcel

    def refused(self, doing: Callable[[], object], word: str) -> Verdict:
        """Return the verdict on something that must be refused, in a sentence that names a word."""
        try:
            doing()
        except RefusedError as refusal:
            sentence = " ".join(str(refusal).split())
            if word in sentence:
                return Verdict("refused", sentence)
            return wrong(f'refused without a word on "{word}": {sentence}')
        return wrong(f"{word}: accepted, though no box can have it")

    # ------------------------------------------------------------------ laws

    def _look(self, parcel: Parcel) -> None:
        """Refuse a state that no engine may have."""
        here = parcel.snapshot()
        shape = (parcel.number, 3)
        if here.position.shape != shape or here.velocity.shape != shape:
            raise UnlawfulError(f"of {parcel.number} molecules {len(here.position)} are left")
        tallies: dict[str, Any] = {
            "position": here.position,
            "velocity": here.velocity,
            "rotational energy": here.rotational_energy,
            "energy": parcel.energy(),
            "impulse of a wall": parcel.wall_impulse,
            "heat of a wall": parcel.wall_heat,
            "work": parcel.work,
            "virial": parcel.virial,
            "time": parcel.time,
            "height of the ceiling": parcel.ceiling,
        }
        for name, values in tallies.items():
            if not np.isfinite(values).all():
                raise UnlawfulError(f"{name} is not finite at t = {parcel.time:.6g}")
        if (here.rotational_energy < 0.0).any():
            raise UnlawfulError(f"a rotational energy is negative at t = {parcel.time:.6g}")
        if (out := outermost(parcel)) > _OUTSIDE:
            raise UnlawfulError(f"a molecule is {out:.3g} of the box outside of it at t = {parcel.time:.6g}")
        if not (off := misfit(parcel)) <= _LEDGER:
            raise UnlawfulError(f"the energy ledger is off by {off:.3g} at t = {parcel.time:.6g}")
        if self.exact and parcel.number <= 500 and (deep := deepest_overlap(parcel)) > _OVERLAP:
            raise UnlawfulError(f"molecules overlap by {deep:.3g} of their diameter at t = {parcel.time:.6g}")


def misfit(parcel: Parcel) -> float:
    """Return by how much the energy ledger fails to close, relative to all energy that there is or was exchanged.

    `Parcel.ledger` relates it to what there is. Between walls a million times as hot as each other a
    thousand times as much flows through in a while, and its rounding with it.
    """
    energy = sum(parcel.energy())
    exchanged = float(np.abs(parcel.wall_heat).sum()) + abs(parcel.work)
    start = parcel.internal_energy() - float(parcel.wall_heat.sum()) - parcel.work
    scale = abs(energy) + exchanged
    return parcel.ledger() * max(abs(energy), abs(start)) / scale if scale > 0.0 else 0.0


def outermost(parcel: Parcel) -> float:
    """Return how far a molecule reaches through a wall, in sides of the box; below 0 if none does."""
    x, length = parcel.snapshot().position, parcel.length
    radius = np.where(parcel.periodic, 0.0, 0.5 * parcel.diameter[:, None])
    return float(np.max(np.maximum(radius - x, x - (length - radius)) / length, initial=-math.inf))


def deepest_overlap(parcel: Parcel) -> float:
    """Return by how much the closest pair overlaps, in mean diameters of the pair; below 0 if none does."""
    x, diameter = parcel.snapshot().position, parcel.diameter
    i, j = np.triu_indices(parcel.number, 1)
    touching = 0.5 * (diameter[i] + diameter[j])
    i, j, touching = i[touching > 0.0], j[touching > 0.0], touching[touching > 0.0]
    apart = x[i] - x[j]
    apart -= np.where(parcel.periodic, parcel.length * np.rint(apart / parcel.length), 0.0)
    return float(np.max(1.0 - np.sqrt(np.sum(apart**2, axis=1)) / touching, initial=-math.inf))

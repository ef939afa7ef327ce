"""One engine in one extreme, with checks that detect a hang and every violation of a law."""

from __future__ import annotations

import math
import threading
import time
import weakref
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Protocol

import numpy as np

from atmosbox.engine import Parcel
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.engine.liquid.moist_account import MoistAccount
from atmosbox.scene.engines import EngineChoice

__all__ = ["Candidate", "GuardedRun", "UnlawfulError", "deepest_overlap", "step_of"]

APPROXIMATE = ("stepped", "dsmc")
CLOSES, OUTSIDE, OVERLAP = 1e-10, 1e-9, 1e-9
"""Limits for rounding: residual of the energy ledger, distance outside the box [sides], overlap of a pair [diameters].
"""
MEMORY, MEMORY_OF_ONE = 10_000_000, 400
"""Greatest memory of a box [bytes]: a constant part, and a part for each molecule."""


class Candidate(Protocol):
    """An engine to be assessed, with its options, as `atmosbox.scene.engines.choose` returns it."""

    @property
    def name(self) -> str:
        """The name of the engine."""

    def make(self, *arrays: Any, **box: Any) -> Parcel:
        """Return a parcel."""


class UnlawfulError(Exception):
    """A state or a behaviour that no engine may have."""


class GuardedRun:
    """An engine whose runs are checked.

    `box` makes boxes and `advance` lets time pass in them. `advance` stops a run that hangs, and checks after every run
    whether the state is still lawful: all molecules present and inside, all numbers finite, energy and water conserved.

    Parameters
    ----------
    candidate
        The engine.
    limit
        Processor time that all runs together may take [s]; compiling is not counted.
    """

    def __init__(self, candidate: Candidate, limit: float = 60.0) -> None:
        self.engine = candidate.name
        self.exact = candidate.name not in APPROXIMATE
        self.limit = limit
        self.stopped = threading.Event()
        self._candidate = candidate
        self._spent = 0.0
        self._waters: weakref.WeakKeyDictionary[Parcel, int] = weakref.WeakKeyDictionary()

    def box(self, position: Any, velocity: Any, *, options: Mapping[str, Any] | None = None, **box: Any) -> Parcel:
        """Return a parcel of the engine; the arguments are those of `Parcel`, and options by the name of the engine."""
        candidate, own = self._candidate, (options or {}).get(self.engine, {})
        if own and isinstance(candidate, EngineChoice):
            candidate = replace(candidate, options={**candidate.options, **own})
        parcel = candidate.make(position, velocity, **box)
        self._check(parcel)
        return parcel

    def advance(self, parcel: Parcel, until: float) -> Parcel:
        """Let time pass, check the run and the state, and return the parcel."""
        began: list[float] = []  # processor time, because other programs may slow down the run

        def watch(_: float) -> None:
            now = time.thread_time()
            began.append(now) if not began else None
            if self.stopped.is_set() or self._spent + now - began[0] > self.limit:
                raise UnlawfulError(f"hangs: not at t = {until:g} after {self.limit:g} s, but at {parcel.time:.6g}")

        try:
            parcel.advance(until, watch)
        finally:
            self._spent += time.thread_time() - began[0] if began else 0.0
            self._check(parcel)
        step = step_of(parcel)
        slack = 1e-9 * max(abs(until), step)
        if not -step - slack <= parcel.time - until <= slack:
            raise UnlawfulError(f"asked to advance to t = {until:.9g}, it is at {parcel.time:.9g}")
        return parcel

    def _check(self, parcel: Parcel) -> None:
        """Raise `UnlawfulError` for a state that no engine may have."""
        here, number = parcel.snapshot(), parcel.number
        if here.position.shape != (number, 3) or here.velocity.shape != (number, 3):
            raise UnlawfulError(f"of {number} molecules {len(here.position)} are left")
        numbers: dict[str, Any] = {
            "position": here.position,
            "velocity": here.velocity,
            "rotational energy": here.rotational_energy,
            "energy": (*parcel.energy(), parcel.condensed_energy),
            "impulse of a wall": parcel.wall_impulse,
            "heat of a wall": parcel.wall_heat,
            "work": parcel.work,
            "virial": parcel.virial,
            "time": parcel.time,
            "height of the ceiling": parcel.ceiling,
        }
        faults = [f"{name} is not finite" for name, values in numbers.items() if not np.isfinite(values).all()]
        if (here.rotational_energy < 0.0).any():
            faults.append("a rotational energy is negative")
        if (out := outermost(parcel)) > OUTSIDE:
            faults.append(f"a molecule is {out:.3g} of the box outside of it")
        if not (off := parcel.ledger()) <= CLOSES:
            faults.append(f"the energy ledger is off by {off:.3g}")
        if self.exact and number <= 500 and (deep := deepest_overlap(parcel)) > OVERLAP:
            faults.append(f"molecules overlap by {deep:.3g} of their diameter")
        if (memory := parcel.memory()) > MEMORY + MEMORY_OF_ONE * number:
            faults.append(f"{number} molecules take {memory} bytes")
        if isinstance(parcel, MoistAccount):
            parts = (parcel.vapour, parcel.liquid, parcel.rained)
            if min(parts) < 0 or sum(parts) != self._waters.setdefault(parcel, sum(parts)):
                faults.append(f"of {self._waters[parcel]} molecules of water {parts} are vapour, liquid and rain")
        if faults:
            raise UnlawfulError(f"{faults[0]} at t = {parcel.time:.6g}")


def step_of(parcel: Parcel) -> float:
    """Return the length of a step [time]; 0 for an engine without steps."""
    return parcel.time_step if isinstance(parcel, MarchingParcel) else 0.0


def outermost(parcel: Parcel) -> float:
    """Return how far a molecule extends through a wall, in sides of the box; negative if none does."""
    x, length = parcel.snapshot().position, parcel.length
    radius = np.where(parcel.periodic, 0.0, 0.5 * parcel.diameter[:, None])
    return float(np.max(np.maximum(radius - x, x - (length - radius)) / length, initial=-math.inf))


def deepest_overlap(parcel: Parcel) -> float:
    """Return the largest overlap of a pair, in mean diameters of the pair; negative if no pair overlaps."""
    x, diameter = parcel.snapshot().position, parcel.diameter
    i, j = np.triu_indices(parcel.number, 1)
    touching = 0.5 * (diameter[i] + diameter[j])
    i, j, touching = i[touching > 0.0], j[touching > 0.0], touching[touching > 0.0]
    apart = x[i] - x[j]
    apart -= np.where(parcel.periodic, parcel.length * np.rint(apart / parcel.length), 0.0)
    return float(np.max(1.0 - np.sqrt(np.sum(apart**2, axis=1)) / touching, initial=-math.inf))

"""What tests of the engine share: walls, a driver of the piston, and how a sample is held to its moments."""

import math
from dataclasses import dataclass, field

import numpy as np
import pytest

from atmosbox.engine import HeatBath, Periodic, Specular, Substance
from atmosbox.engine.core.jit import COMPILED

SMOOTH, TURNING, WARM = (Specular(),) * 6, (Periodic(),) * 6, (HeatBath(1.0),) * 6
WATER = Substance(mass=0.62, diameter=1.0, rotation=3.0, binding_energy=4.0, heat_capacity=9.0, volatility=1.0)
many_events = pytest.mark.skipif(not COMPILED, reason="so many events take minutes without numba")


@dataclass
class Pulse:
    """A driver that moves the piston out and in, and records when it was called."""

    interval: float = 0.75
    speeds: tuple = (0.3, -0.45, 0.0, -0.15, 0.3)
    asked: list = field(default_factory=list)

    def velocity(self, parcel):
        self.asked.append(parcel.time)
        return self.speeds[round(parcel.time / self.interval) % len(self.speeds)]


def random_state(seed=5):
    """Return a state of the random numbers."""
    return np.random.SeedSequence(seed).generate_state(1, np.uint64)


def held(sample, mean, variance):
    """Return whether the sample's mean lies within 4 standard errors of the right one."""
    return abs(np.mean(sample) - mean) <= 4.0 * math.sqrt(variance / len(sample))


def apart(a, b, sides, periodic):
    """Return the distances of some places from others, to the nearest image."""
    away = np.asarray(a)[:, None] - np.asarray(b)[None, :]
    away -= np.where(periodic, np.array(sides) * np.rint(away / np.array(sides)), 0.0)
    return np.sqrt(np.sum(away**2, axis=2))

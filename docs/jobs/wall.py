"""The energy budget of a box whose walls exchange heat and whose ceiling moves."""

import math

import numpy as np
from jobs.gas import contacts_pass
from jobs.registry import Findings, job, rounded

from atmosbox.engine import HeatBath, ParcelSet, Piston, Specular, maxwell_velocities, random_positions
from atmosbox.simulation.runner import LEDGER_LIMIT


class Breath:
    """A ceiling that goes up and down by a third, over and over."""

    interval = 0.1

    def __init__(self, height: float, period: float) -> None:
        self._height, self._turn = height, 2.0 * math.pi / period

    def velocity(self, parcel: ParcelSet) -> float:
        """Return the velocity of the ceiling for the next interval."""
        return self._height / 3.0 * self._turn * math.cos(self._turn * parcel.time)


@job("ledger")
def ledger(found: Findings) -> None:
    """Sum heat and work of molecules that rotate, in gravity, between unlike heat baths, below a piston that moves."""
    n = 1000
    rng = np.random.default_rng(2)
    length = (20.0, 20.0, 25.0)
    walls = (HeatBath(0.5), HeatBath(2.0), Specular(), HeatBath(1.0, accommodation=0.5), HeatBath(1.5), Piston())
    gas = ParcelSet(
        random_positions(length, np.ones(n), rng),
        maxwell_velocities(1.0, np.ones(n), rng),
        length=length,
        walls=walls,
        rotation=2.0,
        rotational_energy=np.ones(n),
        gravity=0.05,
        driver=Breath(25.0, 200.0),
    )
    worst = 0.0
    for _ in range(50):
        contacts_pass(gas, 4e4)
        worst = max(worst, gas.ledger())
    exchanged = (float(np.sum(np.abs(gas.wall_heat))) + abs(gas.work)) / sum(gas.energy())
    found.bound(f"residual of the energy budget in {rounded(gas.contacts, 3)} collisions", worst, LEDGER_LIMIT)
    found.number("exchanged", rounded(exchanged))
    found.number("missing", rounded(worst))

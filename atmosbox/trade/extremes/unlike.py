"""Molecules that are very unlike: a million times as heavy, a hundred times as large."""

import numpy as np

from atmosbox import theory
from atmosbox.engine import Parcel, Periodic
from atmosbox.scene.statistics import block_average
from atmosbox.trade.extremes.extreme import extreme
from atmosbox.trade.extremes.guarded_run import Trial
from atmosbox.trade.extremes.law import judged_contacts
from atmosbox.trade.extremes.verdict import Verdict, judged, wrong

_OPEN = (Periodic(),) * 6


def _mixture_rate(
    trial: Trial,
    gas: Parcel,
    members: list[int],
    sizes: list[float],
    masses: list[float],
    settle: float,
    block: float,
    distance: float,
) -> Verdict:
    counts = np.array(members, np.float64)
    rate = theory.collision_rate_between(counts / gas.volume, sizes, masses, 1.0)
    rate = np.asarray(rate) * (1.0 - np.eye(2) / counts)
    expected = 0.5 * float(np.sum(counts[:, None] * rate))
    trial.run(gas, settle)
    rates = []
    for _ in range(20):
        before, time = gas.contacts, gas.time
        trial.run(gas, time + block)
        rates.append((gas.contacts - before) / (gas.time - time))
    mean, error = block_average(rates)
    return judged_contacts(
        gas, "contacts per time", float(mean), expected, 4.0 * float(error) + 0.02 * expected, distance
    )


@extreme("mass-ratio", "masses 1 : 10⁶", may_refuse=("dsmc",))
def mass_ratio(trial: Trial) -> Verdict:
    """Mix molecules with others a million times as heavy: they meet as theory says, and no energy is lost."""
    number, heavy = 100, 10
    mass = np.where(np.arange(number) < heavy, 1e6, 1.0)
    gas = trial.gas(number, (12.0,) * 3, mass=mass, walls=_OPEN)
    before = sum(gas.energy())
    verdict = _mixture_rate(trial, gas, [heavy, number - heavy], [1.0, 1.0], [1e6, 1.0], 10.0, 50.0, 1.0)
    if (off := abs(sum(gas.energy()) / before - 1.0)) > 1e-12:
        return wrong(f"energy is off by {off:.2g}")
    return verdict


@extreme("count-of-pi", "masses 1 : 100ᵏ at a wall", may_refuse=("dsmc",))
def count_of_pi(trial: Trial) -> Verdict:
    """Push a light ball to a wall with a heavy one: the hits are the digits of π (Galperin 2003)."""
    hits = []
    for k in range(4):
        box = trial.box([[5, 5, 5], [8, 5, 5]], [[0, 0, 0], [-1, 0, 0]], length=(300, 10, 10), mass=[1.0, 100.0**k])
        trial.run(box, 100.0)
        hits.append(box.contacts + int(box.wall_hits[0]))
    if hits[:3] != [3, 31, 314]:
        return wrong(f"the counts are {hits}, not 3, 31, 314, 3141")
    return judged("hits at a mass of 10⁶", hits[3], 3141, 0)


@extreme("size-ratio", "sizes 1 : 100", may_refuse=("dsmc",))
def size_ratio(trial: Trial) -> Verdict:
    """Mix molecules with others a hundred times as large: they meet as the theory of mixtures says."""
    number, giants = (400, 4) if trial.exact else (100, 4)  # steps are as short as the smallest wants them
    diameter = np.where(np.arange(number) < giants, 10.0, 0.1)
    gas = trial.gas(number, (40.0,) * 3, diameter=diameter, walls=_OPEN)
    settle, block = (200.0, 500.0) if trial.exact else (5.0, 20.0)
    # four giants in a periodic box are few: 2 parts in 100
    return _mixture_rate(trial, gas, [giants, number - giants], [10.0, 0.1], [1.0, 1.0], settle, block, 5.05)

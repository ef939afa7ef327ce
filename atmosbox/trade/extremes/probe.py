r"""The measurements of extremes: each probe builds boxes, lets time pass and measures one number.

Each function here returns a function of a `GuardedRun`; boxes and numbers come from the table of extremes. The expected
value is that of mechanics or kinetic theory, for every engine alike: the error of an engine is the result.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from atmosbox import theory
from atmosbox.engine import Parcel, RefusedError, StalledError
from atmosbox.engine.core.marching import MarchingParcel
from atmosbox.engine.core.measure import layer_sample, temperature
from atmosbox.scene.statistics import block_average
from atmosbox.theory.constants import DRY_AIR
from atmosbox.trade.extremes.extreme_box import CURVED, Box
from atmosbox.trade.extremes.guarded_run import GuardedRun, UnlawfulError, deepest_overlap, step_of
from atmosbox.trade.extremes.verdict import Reading

Probe = Callable[[GuardedRun], Reading]
BLOCKS = 20


# ------------------------------------------------------------------ mechanics


def comes_to(
    boxes: Sequence[Box],
    until: float,
    *,
    position: Any = None,
    velocity: Any = None,
    per: Sequence[float] | None = None,
    tolerance: float = 1e-12,
) -> Probe:
    """Compare positions and velocities at a time with those of mechanics, box by box.

    ``per`` are the units of the errors, one for each box.
    """

    def read(run: GuardedRun) -> Reading:
        worst = 0.0
        for k, new in enumerate(boxes):
            box = run.advance(new(run), until)
            here, off = box.snapshot(), 0.0
            if velocity is not None:
                off = float(np.abs(here.velocity - velocity[k]).max())
            if position is not None:  # an engine that goes in steps stops at the last whole step before the time
                moved = 0.0 if velocity is None else (box.time - until) * np.asarray(velocity[k], float)
                off = max(off, float(np.abs(here.position - np.asarray(position[k]) - moved).max()))
            worst = max(worst, off / per[k] if per else off)
        return Reading("largest error of a position or a velocity", worst, 0.0, tolerance)

    return read


def hits(boxes: Sequence[Box], until: float, expected: Sequence[int]) -> Probe:
    """Count hits of walls and contacts; the first box with a wrong count is the result, or else the last box."""

    def read(run: GuardedRun) -> Reading:
        ran = [run.advance(new(run), until) for new in boxes]
        counts = [box.contacts + int(box.wall_hits.sum()) for box in ran]
        off = [k for k in range(len(counts)) if counts[k] != expected[k]] or [len(counts) - 1]
        return Reading("hits of walls and contacts", counts[off[0]], expected[off[0]])

    return read


def energy(new: Box, until: float, *, pieces: int = 1, events: int = 0, tolerance: float = 1e-12) -> Probe:
    """Compare the energy with that at the start, after at least a number of contacts and hits of walls."""

    def read(run: GuardedRun) -> Reading:
        box = new(run)
        before = sum(box.energy())
        for k in range(1, pieces + 1):
            run.advance(box, until * k / pieces)
        if (met := box.contacts + int(box.wall_hits.sum())) < events:
            raise UnlawfulError(f"only {met} contacts and hits of walls")
        return Reading(f"energy over that at the start{made(box)}", sum(box.energy()) / before, 1.0, tolerance)

    return read


def made(box: Parcel) -> str:
    """Return text with the energy that Euler's fall and a mirroring floor made, over N m g² Δt t; empty if none."""
    law = float(box.mass.sum()) * box.gravity**2 * step_of(box) * box.time
    return f"; the fall and the floor made {box.numerical_heat / law:.2g} N m g² Δt t" if box.numerical_heat else ""


def cooled(new: Box, times: Sequence[float], word: str) -> Probe:
    """Compare with zero the kinetic energy that very cold walls leave; a refusal must contain a word."""

    def read(run: GuardedRun) -> Reading:
        box = new(run)
        before, refusal = box.energy()[0], None
        for until in times:
            try:
                run.advance(box, until)
            except StalledError as stalled:
                refusal = stalled
        if refusal is not None:
            raise refusal if word in str(refusal) else UnlawfulError(f"refused without a word on {word}: {refusal}")
        return Reading("kinetic energy over that at the start", box.energy()[0] / before, 0.0, 1e-12)

    return read


def alike(new: Box, other: Box, until: float, *, cuts: int = 0, later: float = 0.0) -> Probe:
    """Compare two runs that must be the same.

    They differ in the form of their arguments, in that the second is cut into pieces, or in that its clock starts at a
    later time.
    """

    def read(run: GuardedRun) -> Reading:
        one, two = new(run), other(run)
        if later and isinstance(two, MarchingParcel):
            two._step = round(later / two.time_step)
            two._now = two._step * two.time_step
        elif later:
            two._walls.epoch[0] = 2.0 ** round(math.log2(later))
        began = two.time
        end = (math.floor(until / step_of(one)) * step_of(one)) if step_of(one) else until
        for time in np.sort(np.random.default_rng(9).random(cuts)) * end:
            run.advance(two, began + float(time))
            two.energy()
        run.advance(one, end), run.advance(two, began + end)
        if one.contacts < 20:
            raise UnlawfulError(f"only {one.contacts} contacts")
        if later and one.ideal:  # which molecules collide by chance depends on the number of the step
            ratio = two.contacts / one.contacts
            return Reading("contacts over those by the other clock", ratio, 1.0, 4.0 * math.sqrt(2.0 / one.contacts))
        off = float(np.abs(one.snapshot().position - two.snapshot().position).max())
        off = max(off, float(np.abs(one.wall_heat - two.wall_heat).max()))
        return Reading("difference between two runs", off, 0.0, 10.0 * float(np.spacing(later)) if later else 0.0)

    return read


def weight(new: Box, until: float) -> Probe:
    """Check the conservation of energy, then compare the force on the floor with the weight of the molecules."""

    def read(run: GuardedRun) -> Reading:
        box = new(run)
        before, falling = sum(box.energy()), float(box.snapshot().velocity[:, 2].sum())
        run.advance(box, max(until, 100.0 * step_of(box)))
        if box.wall_hits[4] < 100:
            raise UnlawfulError(f"only {box.wall_hits[4]} hits of the floor")
        if abs(sum(box.energy()) / before - 1.0) > 1e-9:
            return Reading(f"energy over that at the start{made(box)}", sum(box.energy()) / before, 1.0, 1e-9)
        pushed = float(box.wall_impulse[4] - box.wall_impulse[5])
        weighed = float(box.mass.sum()) * box.gravity * box.time
        gained = float(box.snapshot().velocity[:, 2].sum()) - falling
        rounding = 1e-12 * max(1.0, abs(pushed) / weighed, abs(gained) / weighed)
        return Reading("impulse of the floor over weight times time", (pushed - gained) / weighed, 1.0, rounding)

    return read


def swept(new: Box, speed: float) -> Probe:
    """Compare the work of a piston on molecules at rest with their energy at twice the velocity of the piston."""

    def read(run: GuardedRun) -> Reading:
        box = new(run)
        where = box.snapshot().position[:, 2]
        run.advance(box, 3.0 / speed)  # so short that no molecule that was hit has come back from the floor
        carried = 2.0 * speed**2 * int(np.sum(where > box.ceiling))
        return Reading("work over the energy of the molecules swept up", box.work / carried, 1.0, 1e-9)

    return read


def emptiness(new: Box, until: float) -> Probe:
    """Measure energy, temperature and layers of an empty box."""

    def read(run: GuardedRun) -> Reading:
        box = run.advance(new(run), until)
        if not math.isnan(temperature(box, box.snapshot())) or layer_sample(box, box.snapshot(), 3).number.any():
            raise UnlawfulError("an empty box has a temperature, or molecules in its layers")
        return Reading("energy of an empty box", sum(box.energy()))

    return read


# ------------------------------------------------------------------ what must be refused


def refused(boxes: Sequence[tuple[Box, str]]) -> Probe:
    """Try boxes that must be refused, each with a message that contains a word."""

    def read(run: GuardedRun) -> Reading:
        last = None
        for new, word in boxes:
            try:
                new(run)
            except RefusedError as refusal:
                last = refusal
                if word not in str(refusal):
                    raise UnlawfulError(f'refused without a word on "{word}": {refusal}') from None
            else:
                raise UnlawfulError(f"{word}: accepted, though no box can have it")
        raise last or UnlawfulError("nothing was tried")

    return read


def parted(boxes: Sequence[Box], word: str) -> Probe:
    """Start with pairs that overlap: they must be refused with a message that contains a word, or come apart."""

    def read(run: GuardedRun) -> Reading:
        deep = 0.0
        for new in boxes:
            try:
                box = new(run)
            except RefusedError as refusal:
                raise refusal if word in str(refusal) else UnlawfulError(f"refused without a word on {word}") from None
            deep = max(deep, deepest_overlap(box))
            if deepest_overlap(run.advance(box, 0.75)) > 0.0 and not box.ideal:
                raise UnlawfulError("a pair that overlaps at the start does not come apart")
        return Reading("largest overlap that is accepted, in diameters", deep)

    return read


def stopped(new: Box, until: float, word: str) -> Probe:
    """Advance a box that must be stopped, with a message that contains a word."""

    def read(run: GuardedRun) -> Reading:
        box = new(run)
        try:
            run.advance(box, until)
        except StalledError as stalled:
            if word in str(stalled) and box.time <= until:
                raise
            raise UnlawfulError(f"refused at t = {box.time:g} without a word on {word}: {stalled}") from None
        raise UnlawfulError(f"the ceiling stands at {box.ceiling:g}, and nothing was said")

    return read


# ------------------------------------------------------------------ statistics


def contacts(
    new: Box, settle: float, until: float, *, slack: float = 0.02, distance: float = 1.0, coarsely: float = 0.0
) -> Probe:
    """Compare the number of contacts with kinetic theory, for one or two kinds of molecules.

    ``slack`` is the relative error that theory may have, ``distance`` the distance of the centres in most contacts
    [length]; ``coarsely`` replaces ``until`` for engines that go in short steps [time].
    """

    def read(run: GuardedRun) -> Reading:
        box = new(run)
        step = step_of(box)
        run.advance(box, max(settle, 20.0 * step))
        before, time = box.contacts, box.time
        run.advance(box, time + (max(coarsely or until, 1000.0 * step) if step else until))
        kinds, members = np.unique(np.stack([box.diameter, box.mass]), axis=1, return_counts=True)
        free = box.length - np.where(box.periodic, 0.0, kinds[0].max())
        rate = np.asarray(theory.collision_rate_between(members / math.prod(free), kinds[0], kinds[1], 1.0))
        if any(box.periodic):
            rate = rate * (1.0 - np.eye(len(members)) / members)
        else:
            rate = rate * theory.contact_share(free, float(kinds[0].max()), box.number)
        expected = 0.5 * float(np.sum(members[:, None] * rate)) * (box.time - time)
        share = 1.0 if box.ideal else seen_share(step / distance)
        law = f", of which steps of δ = {step / distance:.3g} are known to see {share:.3g}" if share < 0.999 else ""
        # four standard errors of a count: 6 false alarms in 100 000
        return Reading(
            f"contacts over those of theory{law}",
            (box.contacts - before) / expected,
            1.0,
            4.0 / math.sqrt(expected) + slack,
        )

    return read


def seen_share(delta: float) -> float:
    r"""Return the share of the contacts of a thin gas that an engine with steps detects.

    A step detects a contact only if the two molecules overlap and still approach at its end. Of all pairs that would
    touch within a step in which they come closer by :math:`x` diameters, at all impact parameters, that is the share
    :math:`1 - x^2 / 3` for :math:`x \le 1` and :math:`2 / 3 x` beyond. This function is the mean of that share over the
    relative speeds u of pairs that meet, :math:`u^3 \exp(-m u^2 / 4 k T)`: :math:`1 - \frac{8}{3}\delta^2` for short
    steps and :math:`\sqrt{\pi}/6\delta` for long ones.

    Parameters
    ----------
    delta
        Length of a step, :math:`\Delta t \sqrt{kT/m} / \sigma`.

    Examples
    --------
    >>> [round(seen_share(delta), 4) for delta in (0.0, 0.05, 1.0, 10.0)]
    [1.0, 0.9933, 0.2922, 0.0295]
    """
    if delta == 0.0:
        return 1.0
    a = 0.5 / delta
    fast = math.exp(-a * a)
    slow = 1.0 - (1.0 + a * a) * fast - 8.0 / 3.0 * delta**2 * (1.0 - (1.0 + a * a + 0.5 * a**4) * fast)
    return slow + (2.0 * fast / delta + 2.0 * math.sqrt(math.pi) * math.erfc(a)) / (12.0 * delta)


def pressure(new: Box, expected: float, settle: float, block: float) -> Probe:
    """Compare the compressibility factor, from the virial of contacts in a gas without total momentum, with theory."""

    def read(run: GuardedRun) -> Reading:
        box = run.advance(new(run), settle)
        factors = []
        for _ in range(BLOCKS):
            virial, time = float(box.virial.sum()), box.time
            run.advance(box, time + block)
            kinetic = box.energy()[0] * (box.number / (box.number - 1.0))
            factors.append(1.0 + (float(box.virial.sum()) - virial) / (2.0 * kinetic * (box.time - time)))
        mean, error = (float(each) for each in block_average(factors, BLOCKS))
        return Reading("Z", mean, expected, 4.0 * error + 1.5 * (expected - 1.0) / box.number)

    return read


def force(new: Box, until: float, speed: float) -> Probe:
    """Compare the force of one molecule on a wall with that from its speed and the width of the box, within one hit."""

    def read(run: GuardedRun) -> Reading:
        box = run.advance(new(run), until)
        expected = speed**2 / float(box.length[0] - 1.0)
        return Reading("force on a wall", float(box.wall_impulse[1]) / box.time, expected, 2.0 * speed / box.time)

    return read


def heat(new: Box, hot: float, settle: float, until: float) -> Probe:
    """Compare the heat that points carry from a hot wall to one of kT = 1 with an exact formula."""

    def read(run: GuardedRun) -> Reading:
        box = run.advance(new(run), settle)
        given, met, time = box.wall_heat, box.wall_hits, box.time
        run.advance(box, time + until)
        given, met, time = box.wall_heat - given, box.wall_hits - met, box.time - time
        expected = float(theory.free_molecular_slab(hot, 1.0, float(box.number), 1.0).heat_flux)
        # Some molecules that the cold wall emits are very slow: the mean square of the time to cross the box, 1 / v,
        # grows with the logarithm of the duration of the run. The mean of that time is sqrt(pi / 2), and the energy
        # that a molecule takes back has a relative variance of 1 / 2.
        square = math.log(time) + 0.5 * (math.log(2.0) - 0.5772)
        error = math.sqrt((square / (0.5 * math.pi) - 0.5) / met[1])
        return Reading("heat flux over theory", 0.5 * (given[0] - given[1]) / time / expected, 1.0, 4.0 * error)

    return read


def vapour(new: Box, celsius: float, waters: int, crossings: float) -> Probe:
    """Compare the mean number of molecules of vapour with the exact law for a number of molecules of water.

    ``crossings`` is the duration of the measurement, in crossings of the box by a molecule of unit speed.
    """

    def read(run: GuardedRun) -> Reading:
        box: Any = new(run)
        side, means = float(box.length[0]), []
        run.advance(box, 0.2 * crossings * side)
        for _ in range(BLOCKS):
            seen = []
            for _ in range(100):
                run.advance(box, box.time + 0.01 * crossings / BLOCKS * side)
                seen.append(box.vapour)
            means.append(np.mean(seen))
        mean, error = (float(each) for each in block_average(means, BLOCKS))
        volume = ((side - 1.0) * DRY_AIR.diameter) ** 3
        expected = theory.isothermal_vapor_number(waters, celsius + 273.15, volume).mean
        what = f"molecules of vapour; {box.condensed} condensed, {box.evaporated} evaporated"
        return Reading(what, mean, expected, 4.0 * error + 0.01 * expected)

    return read


def curved(new: Box, saturated: float, salt: float, crossings: float) -> Probe:
    """Compare the mean number of molecules of vapour beside one drop with a curvature effect with that over all states.

    In equilibrium, a drop of n molecules, with the vapour beside it, gains one as often as a drop of n + 1 molecules
    loses one. This gives the probability of each n.
    """

    def read(run: GuardedRun) -> Reading:
        box: Any = new(run)
        side, seen = float(box.length[0]), []
        run.advance(box, 0.2 * crossings * side)
        for _ in range(100 * BLOCKS):
            run.advance(box, box.time + 0.01 * crossings / BLOCKS * side)
            seen.append(box.vapour)
        mean, error = (float(each) for each in block_average(seen, BLOCKS))
        held = np.arange(1.0, box.vapour + box.liquid + 1.0)
        ball, core = (4.0 / 3.0 * math.pi * CURVED[name] ** 3 for name in ("molecule_radius", "nucleus"))
        over = theory.humidity_over_drop(held, CURVED["surface_tension"], ball, 1.0, particles=salt, core=core)
        chance = np.cumsum(np.log((len(held) + 1.0 - held) / (saturated * over)))
        chance = np.exp(np.append(0.0, chance) - max(float(chance.max()), 0.0))
        expected = float(chance @ np.arange(len(held), -1.0, -1.0) / chance.sum())
        what = f"molecules of vapour; {box.condensed} condensed, {box.evaporated} evaporated"
        return Reading(what, mean, expected if expected > 1e-3 else 0.0, 4.0 * error + max(0.01 * expected, 1e-3))

    return read


def wells(new: Box, until: float, expected: float) -> Probe:
    """Compare the mean number of neighbours within the well of a molecule at the end with the expected number."""

    def read(run: GuardedRun) -> Reading:
        box: Any = new(run)
        run.advance(box, until)
        if box.contacts < 20 * box.number:
            raise UnlawfulError(f"only {box.contacts} contacts")
        return Reading("wells for each molecule", 2.0 * box.number_of_wells / box.number, expected)

    return read

"""Every engine in the extreme cases: what it does is what the table says, or better."""

import faulthandler
import sys

import numpy as np
import pytest

from atmosbox.engine import ParcelSet
from atmosbox.engine.core.jit import COMPILED
from atmosbox.scene import engines
from tests.extremes.cases import FAMILIES, Case, Reading, Run, at, hold


@pytest.fixture(autouse=True)
def nothing_hangs():
    faulthandler.dump_traceback_later(1800.0, exit=True, file=sys.__stderr__)
    yield
    faulthandler.cancel_dump_traceback_later()


@pytest.mark.skipif(not COMPILED, reason="takes hours without numba")
@pytest.mark.filterwarnings("ignore")  # that a step is too long
@pytest.mark.parametrize(
    ("name", "case"),
    [
        pytest.param(
            *(name, case),
            id=f"{name}, {case.name}",
            marks=[pytest.mark.nightly] if name in case.later.split() else [],
        )
        for name in engines.names()
        for family in FAMILIES.values()
        for case in family
    ],
)
def test_an_engine_is_right_or_refuses_or_is_no_worse_than_known(name, case):
    hold(case, Run(name))


def push(run):
    """Return the force of two molecules that pass each other on a wall."""
    box = run.advance(at([[3.0, 4, 5], [3.0, 7, 5]], [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]])(run), 900.0)
    return Reading(box.wall_impulse[1] / 900.0, 0.5 / 9.0, 1.0 / 900.0)


def late(**change):
    """Return a snapshot in which something changes at time 1."""

    def snapshot(box):
        here = ParcelSet.snapshot(box)
        changed = {name: each(getattr(here, name)) for name, each in change.items()}
        return here._replace(**changed) if box.time >= 1.0 else here

    return snapshot


def turn(box, until, watch):
    while True:
        watch(box.time)


@pytest.mark.parametrize(
    ("methods", "why"),
    [
        ({"snapshot": late(position=lambda x: x[1:])}, "are lost"),
        ({"snapshot": late(position=lambda x: x + 11.0)}, "outside"),
        ({"snapshot": late(velocity=lambda v: v * np.nan)}, "not finite"),
        ({"snapshot": late(position=lambda x: x[[0, 0]])}, "overlap"),
        ({"ledger": lambda box: 1e-9}, "energy budget"),
        ({"advance": lambda box, until, watch: ParcelSet.advance(box, 0.5 * until, watch)}, "it is at 450"),
        ({"advance": turn}, "hangs"),
        ({"wall_impulse": property(lambda box: 1.2 * ParcelSet.wall_impulse.fget(box))}, "kind='off'"),
    ],
)
def test_a_broken_engine_fails(methods, why):
    def run(methods):
        broken = type("Broken", (ParcelSet,), methods)
        return Run("exact", lambda options, *arrays, **box: broken(*arrays, **box), limit=0.3)

    hold(Case("push", push), run({}))
    with pytest.raises(AssertionError, match=why):
        hold(Case("push", push), run(methods))


def test_what_is_refused_and_must_not_be_or_the_other_way_round_fails():
    refusal = FAMILIES["walls"][0]
    assert hold(refusal, Run("exact")).kind == "refused"
    for case in (Case("", push, exact="cold"), Case("", refusal.measure), Case("", refusal.measure, exact="too warm")):
        with pytest.raises(AssertionError):
            hold(case, Run("exact"))

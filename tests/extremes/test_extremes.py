"""Every engine in the extreme cases: what it does is what the table says, or better."""

import faulthandler
import sys

import pytest

from atmosbox.engine import ParcelSet
from atmosbox.engine.core.jit import COMPILED
from atmosbox.scene import engines
from tests.extremes.cases import FAMILIES, Run, hold


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
            *(name, case), id=f"{name}, {case.name}", marks=[pytest.mark.nightly] if name in case.later.split() else []
        )
        for name in engines.names()
        for family in FAMILIES.values()
        for case in family
    ],
)
def test_an_engine_is_right_or_refuses_or_is_no_worse_than_known(name, case):
    hold(case, Run(name))


@pytest.mark.parametrize("speed", [1e-49, 1e-13, 1e40])
def test_two_molecules_meet_however_slow_or_fast_they_are(speed):
    pair = ParcelSet([[3, 5, 5], [7, 5, 5]], [[speed, 0, 0], [-speed, 0, 0]], length=(10, 10, 10))
    pair.advance(2.0 / speed)
    assert pair.contacts == 1
    assert pair.snapshot().velocity[:, 0].tolist() == [-speed, speed]

"""A box of any engine does the same, bit for bit: cut and looked at, interrupted, copied, or put back from a file."""

import copy
import itertools
import json
import pickle

import numpy as np
import pytest

from atmosbox.engine import (
    AttractingParcelSet,
    Drops,
    FollowPressure,
    HeatBath,
    Mist,
    ParcelSet,
    Periodic,
    Piston,
    Pool,
    Ramp,
    RandomBath,
    RefusedError,
    Specular,
    SquareWell,
)
from atmosbox.engine.core.saved_state import SavedState
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.dsmc.moist_dsmc_parcel import MoistDsmcParcel
from atmosbox.engine.exact import parcelset
from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.engine.stepped.stepped_parcel import SteppedParcel
from tests.engine.boxes import SMOOTH, WARM, WATER
from tests.engine.test_drop import box as drop_box
from tests.engine.test_moist import box as moist_box
from tests.engine.test_parcelset import box as exact_box


def gas(number=64, side=12.0, seed=5):
    """Return positions on a lattice, and velocities, of a gas."""
    random = np.random.default_rng(seed)
    site = np.stack(np.meshgrid(*[np.arange(5)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return (random.permutation(site)[:number] + 0.5) * side / 5, random.normal(size=(number, 3))


def lifted():
    """Return the arguments of a gas under a piston that follows a falling pressure."""
    follow = FollowPressure([0.0, 100.0], [0.036, 0.006], mean_free_time=2.0)
    return {"length": (12.0,) * 3, "walls": (*SMOOTH[:5], Piston()), "driver": follow, "rotation": 2.0}


BOXES = {
    "column": lambda: ParcelSet(
        *gas(), length=(12.0,) * 3, gravity=0.1, layers=4,
        walls=(Periodic(),) * 4 + (HeatBath(Ramp(1.0, 3.0, 0.0, 30.0)), Specular()),
    ),
    "lift": lambda: ParcelSet(*gas(), **lifted()),
    "mist": lambda: MoistParcelSet(*gas(), mass=[1.0, 0.62] * 32, liquid=Mist(WATER, number=9, kT=1.0), **lifted()),
    "pool": lambda: MoistParcelSet(
        *gas(), mass=[1.0, 0.62] * 32, liquid=Pool(WATER, number=40, kT=1.0), **lifted()
    ),
    "drops": lambda: DropParcelSet(
        *gas(60), length=(12.0,) * 3, mass=[0.62, 1.0] * 30, rotation=[3.0, 2.0] * 30,
        liquid=Drops(
            WATER, number=8, kT=1.0, nuclei=5.0, position=((4.7, 4.7, 4.7), (7.1, 7.1, 7.1)), nucleus=(1.0, 0.8),
            surface_tension=0.5, dissolved=(0.0, 6.0),
        ),
    ),
    "stepped": lambda: SteppedParcel(
        *gas(), delta=0.01, gravity=0.01, mass=[1.0, 3.0] * 32,
        **lifted() | {"walls": (*SMOOTH[:2], *(Periodic(),) * 2, Specular(), Piston())},
    ),
    "dsmc": lambda: DsmcParcel(*gas(), **lifted()),
    "moist dsmc": lambda: MoistDsmcParcel(
        *gas(), mass=[1.0, 0.62] * 32, liquid=Mist(WATER, number=9, kT=1.0), **lifted()
    ),
    "dsmc over a pool": lambda: MoistDsmcParcel(*gas(), length=(12.0,) * 3, liquid=Pool(WATER, number=40, kT=1.0)),
    "attraction": lambda: AttractingParcelSet(
        *gas(), length=(12.0,) * 3, walls=(Periodic(),) * 6, well=SquareWell(), bath=RandomBath(1.0, 0.2),
    ),
}  # fmt: skip
FEW = ["few under a piston", "few everything", "few in a mist", "few among drops"]
"""Boxes of so few molecules that their clocks are set back several times in a short run."""
BOXES |= {
    "few under a piston": lambda: ParcelSet(**exact_box("piston", number=8)),
    "few everything": lambda: ParcelSet(**exact_box("everything", number=8)),
    "few in a mist": lambda: moist_box("exact", "mist", air=4, vapour=3),
    "few among drops": lambda: drop_box("between heat baths", air=4, vapour=3),
}
in_each_box = pytest.mark.parametrize("name", BOXES)


class Stop(Exception):
    """What a watch may raise, as Ctrl-C does."""


def through_a_file(box, make):
    """Return another box in the state of this one, after the state was converted to text and bytes and back."""
    state = box.state()
    memory = {name: np.frombuffer(piece.tobytes(), np.uint8) for name, piece in state.memory.items()}
    twin = make()
    twin.restore(SavedState(json.loads(json.dumps(state.text)), memory))
    return twin


def bits(box):
    """Return all readings of a box, as bytes."""
    told = [*box.snapshot()[1:], box.wall_impulse, box.wall_heat, box.virial, box.wall_hits, box.ledger(), box.contacts]
    told += [box.ceiling, box.work, box._tallies.random[0]]
    for name in ("vapour", "liquid", "condensed", "liquid_energy", "drops", "pairs", "bath_heat"):
        held = getattr(box, name, 0)
        told += held() if name == "drops" and held else [held() if callable(held) else held]
    return box.time, b"".join(np.asarray(each).tobytes() for each in told)


def looked_at(box):
    """Read what there is to read of a box, and overwrite what was read."""
    for read in (box.snapshot().position, box.wall_heat, box.length):
        read[:] = np.nan
    box.energy(), box.ledger(), box.open_density, repr(box), box.memory(), box.degrees_of_freedom
    if hasattr(box, "emitted_energy"):
        box.emitted_energy[1][:] = 0


def chunks_of(monkeypatch, events):
    """Make the exact engines return to Python after so many events."""
    monkeypatch.setattr(parcelset, "_CHUNK", events)


@in_each_box
def test_a_run_is_the_same_to_the_last_byte_however_it_is_cut_and_looked_at(name, monkeypatch):
    whole = BOXES[name]()
    epoch = getattr(whole, "_epoch_length", 300.0)  # after which all clocks are set back
    end = (2.3 if name in FEW else 0.2) * epoch
    whole.advance(end)
    assert whole.contacts + whole.wall_hits.sum() > 100
    assert (whole._walls.epoch[0] > 0.0) == (name in FEW)
    assert whole.ceiling > 18.0 or name not in ("lift", "mist")  # the cells have been laid out again
    random = np.random.default_rng(6)
    about = (epoch, np.nextafter(epoch, 0.0), np.nextafter(epoch, np.inf), 2.0 * epoch, 0.0, 0.75, 0.75, end, end)
    for times, chunk in ((np.append(random.uniform(0.0, end, 60), end), 200_000), (about, 50)):
        chunks_of(monkeypatch, chunk)
        cut = BOXES[name]()
        for time in sorted(min(each, end) for each in times):
            cut.advance(time)
            looked_at(cut)
        assert bits(cut) == bits(whole)


@in_each_box
def test_a_run_that_is_interrupted_can_be_looked_at_and_go_on(name, monkeypatch):
    calls, stops, end = itertools.count(), 0, 60.0
    whole, stopped = BOXES[name](), BOXES[name]()
    whole.advance(end)
    chunks_of(monkeypatch, 7)

    def interrupt(time):
        if next(calls) % 3 == 0:
            raise Stop

    while stopped.time < whole.time:
        try:
            stopped.advance(end, watch=interrupt)
        except Stop:
            stops += 1
            assert stopped.escaped() == 0
            assert stopped.ledger() < 1e-10
    assert stops > 0
    assert bits(stopped) == bits(whole)


@in_each_box
def test_a_copy_does_what_the_original_does(name):
    box = BOXES[name]()
    box.advance(20.0)
    then = bits(box)
    twins = {"copy": copy.deepcopy(box), "pickle": pickle.loads(pickle.dumps(box))}
    twins["file"] = through_a_file(box, BOXES[name])
    for how, twin in twins.items():
        assert bits(twin) == then, how
        twin.advance(40.0)
        assert bits(box) == then, f"the original has changed with its {how}"
    box.advance(40.0)
    for how, twin in twins.items():
        assert twin.escaped() == 0
        assert bits(twin) == bits(box), how


@pytest.mark.parametrize("made", [ParcelSet, DsmcParcel])
def test_the_same_seed_is_the_same_run_and_another_seed_another(made):
    boxes = [made(*gas(), length=(12.0,) * 3, walls=WARM, **changes) for changes in ({}, {}, {"seed": 7})]
    for box in boxes:
        box.advance(20.0)
    runs = [bits(box) for box in boxes]
    assert runs[0] == runs[1] != runs[2]


def test_a_state_is_not_taken_for_that_of_another_box():
    with pytest.raises(RefusedError):
        BOXES["stepped"]().restore(BOXES["lift"]().state())

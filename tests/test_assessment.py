"""The stability assessment: how each engine does in each extreme case, and that an engine which fails is detected."""

import importlib.util
import itertools
import json
import threading
import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import ClassVar

import numpy as np
import pytest
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.engine import Mist, ParcelSet, RefusedError
from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.scene import engines
from atmosbox.trade import extremes
from atmosbox.trade.extremes import (
    EXTREMES,
    FAMILIES,
    Extreme,
    Finding,
    Reading,
    UnlawfulError,
    Verdict,
    assess,
    compared,
    examine,
    judged,
)
from atmosbox.trade.extremes.extreme_box import at, moist
from atmosbox.trade.extremes.guarded_run import GuardedRun
from atmosbox.trade.extremes.probe import parted, refused
from atmosbox.trade.extremes.verdict import stored

STEPPED = {
    *("hot-and-cold", "size-ratio", "packing-0.49-fine", "two-molecules", "mass-ratio"),
    *("crushing-piston", "piston-on-points", "supersonic-piston"),
    *("count-of-pi", "strong-gravity"),
}
"""Cases that take engines with time steps more than a second or two, compilation included."""
LATER = {
    "exact": {
        *("water-at-95", "step-of-a-quarter", "bouncing-ball", "stack-at-rest", "three-walls-at-once", "two-molecules"),
        *("touching-drops", "one-molecule-of-water", "all-water", "water-at-minus-60", "drying-pool"),
        *("no-molecules", "one-molecule", "ball-at-rest", "count-of-pi", "hot-and-cold", "mass-ratio", "size-ratio"),
        *("strong-gravity", "crushing-gravity", "tall-column", "edge-for-ever"),
        *("crushing-piston", "piston-on-points", "supersonic-piston", "fleeing-piston"),
        # tests/physics tests wells and curved drops in smaller boxes
        *("drop-of-pure-water", "drop-of-salt", "drop-in-tenfold-vapour", "supersaturation-10"),
        *("wells-of-no-depth", "narrow-wells", "wide-wells", "hot-wells", "wells-of-a-million", "orbit-in-a-well"),
    },
    "stepped": {
        *STEPPED,
        *("ball-at-rest", "bouncing-ball", "three-walls-at-once", "stack-at-rest"),
        *("crushing-gravity", "tall-column", "cold-floor", "one-molecule", "edge-for-ever", "three-molecules"),
    },
    "dsmc": {
        *("one-molecule-of-water", "drying-pool", "water-at-95", "water-at-minus-60"),
        *("two-molecules", "hot-and-cold", "cold-floor"),
    },
}
"""Cases of the tier ``validate``, which take seconds.

Most need kernels of their own, because no scene has such a box on this engine: the daily cases use the kernels of
scenes, between smooth walls and heat baths, periodic, in gravity on a floor, with a mist. The others are dear, and a
cheaper case asks the same. Empty boxes, edges, pistons, unlike molecules, balls in gravity and the heat between walls
are tried elsewhere, too: test_extremes, engine/test_stepped, physics/test_piston, test_column and test_dsmc_transport.
"""


def knows_nothing_of(name, family):
    """Return whether an engine refuses a whole family of extremes, so that testing one of them is enough."""
    return all(name in stored()[each.name] and stored()[each.name][name].outcome == "refused" for each in family)


def cases():
    for name, family in itertools.product(engines.names(), FAMILIES.values()):
        for each in family[:1] if knows_nothing_of(name, family) else family:
            slow = each.long or each.name in LATER[name]
            yield pytest.param(name, each, id=f"{name}-{each.name}", marks=[pytest.mark.validate] if slow else [])


@pytest.mark.skipif(not COMPILED, reason="takes hours without numba")
@pytest.mark.parametrize(("name", "each"), list(cases()))
def test_an_engine_does_not_do_worse_than_its_stored_outcome(name, each):
    before = stored()[each.name].get(name)
    verdict = examine(each, engines.choose(name), before).verdict
    assert before is not None or each.long
    assert verdict.passed, verdict.told
    if name == "exact":
        assert verdict.outcome in ("right", "refused"), verdict.told


def test_the_stored_outcomes_are_those_of_the_extremes_there_are():
    assert len(EXTREMES) == sum(map(len, FAMILIES.values()))
    assert list(stored()) == list(EXTREMES)
    for name, row in stored().items():
        assert {verdict.outcome for verdict in row.values()} <= {"right", "refused", "degrades"}, name
        if "exact" in row:
            assert row["exact"].outcome != "degrades", name


# An engine that fails is detected


@dataclass
class Broken:
    """A candidate whose parcels are of one class."""

    parcel: type
    name: str = "broken"

    def make(self, *arrays, **box):
        return self.parcel(*arrays, **box)


class Sound(ParcelSet):
    pass


class Loses(ParcelSet):
    def snapshot(self):
        here = super().snapshot()
        return here if self.time < 1.0 else here._replace(position=here.position[1:], velocity=here.velocity[1:])


class Leaves(ParcelSet):
    def snapshot(self):
        here = super().snapshot()
        return here._replace(position=here.position + (11.0 if self.time >= 1.0 else 0.0))


class Breeds(ParcelSet):
    def snapshot(self):
        here = super().snapshot()
        return here._replace(velocity=here.velocity * (np.nan if self.time >= 1.0 else 1.0))


class Heats(ParcelSet):
    def snapshot(self):
        here = super().snapshot()
        return here._replace(velocity=here.velocity * (1.0 + 1e-9 * self.time))


class Sinks(ParcelSet):
    def snapshot(self):
        here = super().snapshot()
        here.position[1:] = here.position[:1] if self.time >= 1.0 else here.position[1:]
        return here


class Dawdles(ParcelSet):
    def advance(self, until, watch=None):
        super().advance(0.5 * until, watch)


class Miscounts(ParcelSet):
    @property
    def wall_impulse(self):
        return 1.2 * super().wall_impulse


class Trips(ParcelSet):
    def advance(self, until, watch=None):
        raise IndexError("7 is out of bounds")


class Refuses(ParcelSet):
    def advance(self, until, watch=None):
        raise RefusedError("not today")


class Turns(ParcelSet):
    def advance(self, until, watch=None):
        while True:
            watch(self.time)


class Sleeps(ParcelSet):
    woken = threading.Event()
    threads: ClassVar[list[threading.Thread]] = []

    def advance(self, until, watch=None):
        self.threads.append(threading.current_thread())
        self.woken.wait()


class Warns(ParcelSet):
    """An engine with a warning, in whose run one that was left behind comes to its end."""

    def advance(self, until, watch=None):
        Sleeps.woken.set()
        Sleeps.threads[0].join()
        warnings.warn("a coarse step", stacklevel=2)
        super().advance(until, watch)


class Leaks(MoistParcelSet):
    """An engine that forgets a molecule of water."""

    @property
    def liquid(self):
        return super().liquid - (self.time > 0.0)


def pair(run):
    """Return the force of two molecules that pass each other on a wall."""
    box = run.box([[3.0, 4, 5], [3.0, 7, 5]], [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]], length=(10, 10, 10))
    run.advance(box, 900.0)
    return Reading("force", box.wall_impulse[1] / 900.0, 2 * 0.25 / 9.0, 2.0 / 900.0)


PAIR = Extreme("pair", "two that pass", "…", pair)
RIGHT = Verdict("right", "force", 0.0556, 0.0556, 0.002)


def test_a_broken_engine_is_wrong():
    cases = [
        (Loses, "of 2 molecules 1 are left"),
        (Leaves, "outside"),
        (Breeds, "velocity is not finite"),
        (Heats, "ledger is off"),
        (Sinks, "overlap"),
        (Dawdles, "asked to advance to t = 900, it is at 450"),
        (Miscounts, "it was 0.0556"),
        (Trips, "IndexError: 7 is out of bounds"),
        (Refuses, "refused, but the stored outcome is right: not today"),
        (Turns, "hangs"),
    ]
    assert examine(PAIR, Broken(Sound), RIGHT).verdict.outcome == "right"
    for parcel, why in cases:
        verdict = examine(PAIR, Broken(parcel), RIGHT, limit=0.3).verdict
        assert verdict.outcome == "wrong"
        assert why in verdict.sentence


def test_an_engine_that_loses_water_is_wrong():
    def wet(run):
        run.advance(moist(Mist, 20.0, 5.0, 20)(run), 1.0)

    verdict = examine(Extreme("wet", "", "", wet), Broken(Leaks)).verdict
    assert verdict.outcome == "wrong"
    assert "of 20 molecules of water" in verdict.sentence


def test_an_engine_that_never_comes_back_is_left_behind_and_warnings_of_the_next_one_stay_ignored():
    try:
        found = examine(PAIR, Broken(Sleeps), limit=0.3, patience=0.3)
        assert found.verdict.outcome == "wrong"
        assert "has not come back" in found.verdict.sentence
        assert examine(PAIR, Broken(Warns)).verdict.told == judged(pair(GuardedRun(Broken(Sound)))).told
    finally:
        Sleeps.woken.set()


def test_worse_than_before_is_wrong():
    def verdict(kind, value):
        return Verdict(kind, "a share", *([] if value is None else [value, 1.0, 0.01]))

    for measured, before, outcome in [
        (("right", 1.0), ("degrades", 1.3), "right"),
        (("right", 1.0), ("refused", None), "right"),
        (("degrades", 1.3), ("right", 1.0), "wrong"),
        (("degrades", 1.3), ("degrades", 1.3), "degrades"),
        (("degrades", 1.5), ("degrades", 1.3), "wrong"),
        (("degrades", 0.5), ("degrades", 1.3), "wrong"),
        (("degrades", 1.3), ("refused", None), "degrades"),
        (("refused", None), ("refused", None), "refused"),
        (("refused", None), ("degrades", 1.3), "wrong"),
        (("wrong", None), ("refused", None), "wrong"),
        (("degrades", 9.9), None, "degrades"),
    ]:
        assert compared(verdict(*measured), before and verdict(*before)).outcome == outcome


def test_a_real_engine_with_coarser_steps_is_worse_than_its_stored_outcome():
    each, before = EXTREMES["packing-0.58"], stored()["packing-0.58"]["stepped"]
    assert examine(each, engines.choose("stepped:delta=0.05"), before).verdict.outcome == "degrades"
    assert examine(each, engines.choose("stepped:delta=0.2"), before).verdict.outcome == "wrong"


def test_right_is_only_what_is_known_to_a_twentieth():
    assert judged(Reading("a share", 1.01, 1.0, 0.05)).outcome == "right"
    assert judged(Reading("a share", 1.01, 1.0, 0.12)).outcome == "degrades"
    assert judged(Reading("a share", 1.02, 1.0, 0.01)).outcome == "degrades"
    assert judged(Reading("a share", float("nan"), 1.0, np.inf)).outcome == "wrong"
    assert str(judged(Reading("Z", 7.14, 12.17, 0.1))) == "degrades by -41 %"


class Run:
    """The part of a guarded run that the rules on refusals need."""

    def __init__(self, says):
        self.says = says

    def box(self, *arrays, **box):
        if self.says:
            raise RefusedError(self.says)


def test_what_must_be_refused_and_is_not_or_without_a_word_on_why_is_wrong():
    with pytest.raises(RefusedError, match="mass = -1"):
        refused([(at([[1, 2, 2]]), "mass")])(Run("mass = -1 must be above 0"))
    with pytest.raises(UnlawfulError, match="accepted"):
        refused([(at([[1, 2, 2]]), "mass")])(Run(""))
    for rule in (refused([(at([[1, 2, 2]]), "diameter")]), parted([at([[1, 2, 2]])], "diameter")):
        with pytest.raises(UnlawfulError, match="without a word"):
            rule(Run("mass = -1 must be above 0"))


def test_the_assessment_goes_extreme_by_extreme_and_tells_how_far_it_is():
    told = []
    found = list(assess([Broken(Sound), Broken(Sound, "other")], ["cradle", "outside-start"],
                        lambda part, doing: told.append((part, doing))))  # fmt: skip
    assert [(each.extreme.name, each.engine) for each in found] == [
        ("cradle", "broken"),
        ("cradle", "other"),
        ("outside-start", "broken"),
        ("outside-start", "other"),
    ]
    assert [part for part, _ in told] == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert told[1][1] == "cradle on other"


def test_outcomes_are_stored_on_purpose_and_only_those_asked_for(tmp_path, monkeypatch):
    path = Path(__file__).resolve().parents[1] / "benchmarks" / "extremes.py"
    specification = importlib.util.spec_from_file_location("store_extremes", path)
    script = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(script)
    monkeypatch.setattr(script, "STORED", tmp_path / "stored.json")
    asked = ["--engine", "exact", "--only", "cradle"]
    script.main(asked)
    assert not script.STORED.exists()
    script.main([*asked, "--write"])
    kept = json.loads(script.STORED.read_text(encoding="utf-8"))
    assert list(kept) == ["cradle"]
    assert Verdict(**kept["cradle"]["exact"]) == stored()["cradle"]["exact"]


# The command


def check(*words):
    return CliRunner(env={"COLUMNS": "100"}).invoke(app, ["check", *words])


def test_check_extremes_is_a_table_of_outcomes():
    result = check("--extremes", "--engine", "exact", "--only", "cradle", "--only", "packing-0.75")
    assert result.exit_code == 0, result.output
    head, first, second, *_ = result.stdout.splitlines()
    assert head.split()[:2] == ["extreme", "exact"]
    assert first.split()[:2] == ["cradle", "right"]
    assert second.split()[:2] == ["packing-0.75", "refused"]


def test_check_extremes_as_json_is_one_object():
    found = json.loads(check("--extremes", "--only", "outside-start", "--json").stdout)
    assert found["passed"] is True
    assert found["engines"] == list(engines.names())
    assert [each["outcome"] for each in found["extremes"]] == ["refused"] * len(engines.names())
    assert all("z_low" in each["sentence"] for each in found["extremes"])


def test_an_engine_that_is_wrong_ends_check_with_3(monkeypatch):
    bad = Finding("exact", EXTREMES["cradle"], Verdict("wrong", "cradles", 3, 4, 0), 0.1)
    monkeypatch.setattr(extremes, "assess", lambda *words, **named: [bad])
    result = check("--extremes", "--engine", "exact")
    assert result.exit_code == 3
    assert "cradle   WRONG  cradles: 3, expected 4 ± 0" in result.stdout


def test_check_says_by_how_much_an_engine_degrades():
    result = check("--extremes", "--engine", "dsmc", "--only", "packing-0.49")
    assert result.exit_code == 0, result.output
    assert "degrades by -92 %" in result.stdout


def test_a_check_that_makes_no_sense_is_refused_with_a_sentence():
    cases = [
        ([], "does not know what to verify: give the file of a run, or --extremes"),
        (["a.nc", "--extremes"], "--extremes is about the engines and not about a file"),
        (["a.nc", "--engine", "exact"], "--engine belongs to --extremes"),
        (["a.nc", "--all"], "--all belongs to --extremes"),
        (["--extremes", "--engine", "exakt"], "engine = exakt is not one of"),
        (["--extremes", "--only", "cradel"], "--only = cradel is no extreme: give --only cradle."),
    ]
    for words, sentence in cases:
        result = check(*words)
        assert result.exit_code == 2
        assert sentence in result.stderr

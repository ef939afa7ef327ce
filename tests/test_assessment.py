"""The stability assessment: what each engine makes of each extreme, and that an engine which fails is found out."""

import json
import threading
from dataclasses import dataclass

import numpy as np
import pytest
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.engine import ParcelSet, RefusedError
from atmosbox.scene import engines
from atmosbox.trade import extremes
from atmosbox.trade.extremes import EXTREMES, Extreme, Finding, Trial, Verdict, assess, degraded, examine, judged
from atmosbox.trade.extremes.catalogue import FAMILIES

SLOW = {"cold-floor", "frozen-walls", "hot-and-cold", "packing-0.49", "packing-0.58", "packing-0.64", "size-ratio"}
"""What takes engines that go in steps more than a second or two."""
REFUSED_BY_EXACT = {
    "ball-at-rest",
    "cold-floor",
    "crushing-piston",
    "frozen-walls",
    "no-numbers",
    "no-temperature",
    "outside-start",
    "overlapping-start",
    "packing-0.75",
    "piston-on-points",
    "stack-at-rest",
}


def cases():
    for name in engines.names():
        for each in EXTREMES.values():
            slow = each.long or (name in ("stepped", "classic") and each.name in SLOW)
            yield pytest.param(name, each, id=f"{name}-{each.name}", marks=[pytest.mark.validate] if slow else [])


@pytest.mark.parametrize(("name", "each"), list(cases()))
def test_an_engine_is_right_or_refuses_or_degrades_as_stated(name, each):
    verdict = examine(each, engines.choose(name)).verdict
    assert verdict.passed, verdict.told
    if name == "exact":
        assert verdict.outcome == ("refused" if each.name in REFUSED_BY_EXACT else "right"), verdict.told


def test_every_extreme_has_a_name_a_title_and_says_what_is_asked():
    assert len(EXTREMES) == sum(map(len, FAMILIES.values())) > 40
    for name, each in EXTREMES.items():
        assert name == each.name == each.name.lower().strip()
        assert " " not in name
        assert each.title
        assert each.asked.endswith(".")
        assert set(each.may_refuse) <= {"exact", "stepped", "dsmc", "classic"}


# An engine that fails is found out


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

    def advance(self, until, watch=None):
        self.woken.wait()


def pair(trial: Trial) -> Verdict:
    """Ask for the force of two molecules that pass each other on a wall."""
    box = trial.box([[3.0, 4, 5], [3.0, 7, 5]], [[0.5, 0.0, 0.0], [-0.5, 0.0, 0.0]], length=(10, 10, 10))
    trial.run(box, 900.0)
    return judged("force", box.wall_impulse[1] / 900.0, 2 * 0.25 / 9.0, 2.0 / 900.0)


PAIR = Extreme("pair", "two that pass", "…", pair)


@pytest.mark.parametrize(
    ("parcel", "why"),
    [
        (Loses, "of 2 molecules 1 are left"),
        (Leaves, "outside"),
        (Breeds, "velocity is not finite"),
        (Heats, "ledger is off"),
        (Sinks, "overlap"),
        (Dawdles, "asked to advance to t = 900, it stands at 450"),
        (Miscounts, "force"),
        (Trips, "IndexError: 7 is out of bounds"),
        (Refuses, "refused, though it should be able to: not today"),
        (Turns, "hangs"),
    ],
)
def test_a_broken_engine_is_wrong(parcel, why):
    assert examine(PAIR, Broken(Sound)).verdict.outcome == "right"
    verdict = examine(PAIR, Broken(parcel), limit=1.0).verdict
    assert verdict.outcome == "wrong"
    assert why in verdict.sentence


def test_an_engine_that_never_comes_back_and_never_says_so_is_left_behind():
    try:
        found = examine(PAIR, Broken(Sleeps), limit=0.3, patience=0.3)
        assert found.verdict.outcome == "wrong"
        assert "has not come back" in found.verdict.sentence
    finally:
        Sleeps.woken.set()


def test_a_refusal_is_an_answer_only_for_whom_the_extreme_names():
    allowed = Extreme("pair", "two that pass", "…", pair, may_refuse=("broken",))
    assert examine(allowed, Broken(Refuses)).verdict == Verdict("refused", "not today")


def test_what_must_be_refused_and_is_not_or_without_a_word_on_why_is_wrong():
    trial = Trial(Broken(Sound))

    def refuse():
        raise RefusedError("mass = -1 must be above 0")

    assert trial.refused(lambda: None, "mass").outcome == "wrong"
    assert trial.refused(refuse, "diameter").outcome == "wrong"
    assert trial.refused(refuse, "mass") == Verdict("refused", "mass = -1 must be above 0")


def test_a_degradation_beyond_its_law_is_wrong():
    assert degraded("a share", 0.3, 0.31, 0.02).outcome == "degrades"
    assert degraded("a share", 0.3, 0.35, 0.02).outcome == "wrong"
    assert degraded("a share", float("nan"), 0.35, np.inf).outcome == "wrong"


def test_the_assessment_goes_extreme_by_extreme_and_tells_how_far_it_is():
    told = []
    found = list(assess([Broken(Sound), Broken(Sound, "other")], ["no-molecules", "three-walls-at-once"],
                        lambda part, doing: told.append((part, doing))))  # fmt: skip
    assert [(each.extreme.name, each.engine) for each in found] == [
        ("no-molecules", "broken"),
        ("no-molecules", "other"),
        ("three-walls-at-once", "broken"),
        ("three-walls-at-once", "other"),
    ]
    assert [part for part, _ in told] == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert told[1][1] == "no-molecules on other"


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
    bad = Finding("exact", EXTREMES["cradle"], degraded("cradles", 3, 4, 0), 0.1)
    monkeypatch.setattr(extremes, "assess", lambda *words, **named: [bad])
    result = check("--extremes", "--engine", "exact")
    assert result.exit_code == 3
    assert "cradle   WRONG  cradles: 3, expected 4 ± 0" in result.stdout


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ([], "does not know what to verify: give the file of a run, or --extremes"),
        (["a.nc", "--extremes"], "--extremes is about the engines and not about a file"),
        (["a.nc", "--engine", "exact"], "--engine belongs to --extremes"),
        (["a.nc", "--all"], "--all belongs to --extremes"),
        (["--extremes", "--engine", "exakt"], "engine = exakt is not one of"),
        (["--extremes", "--only", "cradel"], "--only = cradel is no extreme: give --only cradle."),
    ],
)
def test_a_check_that_makes_no_sense_is_refused_with_a_sentence(words, sentence):
    result = check(*words)
    assert result.exit_code == 2
    assert sentence in result.stderr

"""Whatever a browser sends, it is carried out or answered with a sentence, and the box goes on."""

import asyncio
import json
from concurrent.futures import ThreadPoolExecutor

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from atmosbox.errors import AtmosboxError
from atmosbox.live import Session
from atmosbox.live.audience import Mailbox
from atmosbox.live.server import _Service
from atmosbox.simulation.preparation import prepare
from tests.fuzz_case import CASES, fuzz_case

SCENES = {"temperature": {"molecules": 50}, "lifting-dry": {"molecules": 50}, "condensation": {"molecules": 60}}

numbers = st.one_of(st.floats(), st.integers(-(10**30), 10**30), st.sampled_from([0, 1, -1, 1e308, 300.0, 25]))
plain = st.one_of(numbers, st.text(max_size=12), st.booleans(), st.none())
values = st.recursive(
    plain, lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.text(max_size=5), inner, max_size=3))
)
KINDS = ["play", "pause", "step", "reset", "pace", "set", "set", "set", "record", "stop_record", "join", "leave"]
asked = st.fixed_dictionaries(
    {"type": st.one_of(st.sampled_from(KINDS), values)},
    optional={"value": st.one_of(plain, values), "seed": values, "file": values},
)


@pytest.fixture(scope="module", params=SCENES)
def session(request, tmp_path_factory):
    return Session(prepare(request.param, SCENES[request.param]), folder=tmp_path_factory.mktemp("live"))


@settings(max_examples=150)
@given(message=asked, place=st.integers(0, 60), odd=values)
def test_no_request_breaks_a_box(session, message, place, odd):
    names = [each.name for each in session.controls()]
    # requests that restart the box take seconds with many molecules, and are a separate case
    message = {**message, "name": names[place] if place < len(names) else odd}
    quick = message["name"] not in ("molecules", "drops") or not isinstance(message.get("value"), int | float)
    said = "."
    with fuzz_case("live messages"):
        try:
            if quick:
                session.obey(message)
            CASES["live messages, done"] += 1
        except AtmosboxError as error:
            said = str(error)
        assert said.isprintable()
        assert said.endswith(".")
        session.notes()
        json.dumps(session.state())


def test_a_name_that_cannot_be_printed_is_refused_in_a_sentence_that_can(session):
    session.obey({"type": "stop_record"})
    with pytest.raises(AtmosboxError) as refused:
        session.obey({"type": "record", "file": "\U000d5105"})
    assert str(refused.value).isprintable()
    assert "such as" in str(refused.value)


texts = st.one_of(
    st.text(max_size=60), st.binary(max_size=60), asked.map(json.dumps), values.map(json.dumps), st.just("[" * 5000)
)


@settings(max_examples=150)
@given(said=texts)
def test_no_text_breaks_the_socket(said):
    async def hear():
        service = _Service.__new__(_Service)
        taken = []
        service.worker = type("Worker", (), {"ask": lambda self, page, message: taken.append(message) or True})()
        box = Mailbox(1)
        service._hear(box, said)
        return taken, box.take()

    # in a separate thread: a test in a browser may have left an event loop in this one
    with fuzz_case("live messages"), ThreadPoolExecutor(1) as other:
        taken, answers = other.submit(asyncio.run, hear()).result()
    assert len(taken) + len(answers) == 1
    assert all(isinstance(message, dict) for message in taken)


def test_the_box_lives_on(session):
    before = session.state()["time"]
    session.obey({"type": "reset"})
    session.obey({"type": "play"})
    session.run(0.05)
    assert session.state()["time"] != before

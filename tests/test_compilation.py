"""The compilation before a first run is announced, and can be done in advance."""

import itertools
import json
import uuid

import pytest
from typer.testing import CliRunner

from atmosbox.cli import app
from atmosbox.engine.core import kernel_cache
from atmosbox.engine.core.jit import COMPILED, kernel
from atmosbox.engine.core.kernel_cache import compilations
from atmosbox.simulation import compilation
from atmosbox.simulation.preparation import prepare
from atmosbox.simulation.runner import execute

SCENE = "elastic-collisions"


def new_kernel(value):
    """Return a kernel that differs from those of all other tests."""

    @kernel(entry=True)
    def add(x):
        return x + value

    return add


@pytest.mark.skipif(not COMPILED, reason="nothing is compiled")
def test_a_kernel_that_is_compiled_is_announced_and_one_that_is_found_is_not():
    value = uuid.uuid4().int >> 80
    told = []
    with compilations(lambda name, begins: told.append((name.rsplit(".", 1)[-1], begins))):
        assert new_kernel(value)(1) == value + 1
        assert told == [("add", True), ("add", False)]
        assert new_kernel(value)(1) == value + 1
    assert len(told) == 2
    new_kernel(value + 1)(1)
    assert len(told) == 2, "who has left is told nothing"


def test_compilation_is_told_with_the_time_that_it_took_before(tmp_path, monkeypatch):
    clock = itertools.count(0.0, 0.7)
    monkeypatch.setattr(compilation.time, "process_time", lambda: next(clock))
    monkeypatch.setattr(compilation, "cache_home", lambda: tmp_path)
    monkeypatch.setattr(compilation, "_BREATH", 0.01)
    prepared = prepare(SCENE, {})
    told = []
    with compilation.told(prepared, lambda share, words: told.append((share, words))):
        assert told == []
        kernel_cache.announce("outer", True)
        kernel_cache.announce("inner", True)
        kernel_cache.announce("inner", False)
        while len(told) < 5:
            pass
        kernel_cache.announce("outer", False)
    shares, words = zip(*told, strict=True)
    assert set(words) == {"compiling the engine, once on this computer: about 15 s"}
    assert list(shares) == sorted(shares)
    assert 0.0 < shares[-1] < 1.0
    took = compilation.expected_seconds(prepared)
    assert took == pytest.approx(json.loads((tmp_path / "seconds.json").read_text())[f"{SCENE} exact"])
    assert took != 15.0


def test_a_run_whose_kernels_are_kept_says_nothing_of_a_compiler():
    prepared = prepare(SCENE, {"duration": "2 s"})
    execute(prepared)
    words = []
    execute(prepared, progress=lambda share, doing: words.append(doing))
    assert set(words) == {"running", "done"}


def test_prepare_tells_where_the_machine_code_is():
    execute(prepare(SCENE, {"duration": "2 s"}))
    result = CliRunner().invoke(app, ["prepare", SCENE, "--json"])
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["folder"] == str(compilation.cache_home())
    assert [row["scene"] for row in told["compiled"]] == [SCENE]


def test_prepare_refuses_a_scene_that_there_is_not():
    result = CliRunner().invoke(app, ["prepare", "no-such-scene"])
    assert result.exit_code == 2

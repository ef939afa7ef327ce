"""The compilation before a first run is announced, and can be done in advance."""

import json
import uuid

import pytest

from atmosbox.engine.core.jit import COMPILED, kernel
from atmosbox.engine.core.kernel_cache import cache_folder, compilations
from atmosbox.simulation.preparation import prepare
from atmosbox.simulation.runner import execute
from tests.in_process import typed

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


def test_prepare_tells_where_the_machine_code_is():
    execute(prepare(SCENE, {"duration": "2 s"}))
    result = typed("prepare", SCENE, "--json")
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    assert told["folder"] == str(cache_folder().parent)
    assert [row["scene"] for row in told["compiled"]] == [SCENE]

"""The same seed gives the same bits: on any processor, with any C library, compiled or not.

A change of what the engine computes changes digests: ``python tests/state_digest.py > tests/state_digest.json``.
"""

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from atmosbox.engine.core.jit import COMPILED
from atmosbox.engine.core.kernel_cache import cache_folder
from tests import state_digest

HERE = Path(__file__).parent
KNOWN = json.loads((HERE / "state_digest.json").read_text(encoding="utf-8"))
LIBRARY = re.compile(
    rb"\0_?(?:numba_)?(?:log|log2|log10|log1p|exp|exp2|expm1|pow|sin|cos|tan|sincos|sinh|cosh|tanh|atan2?|asin|acos|"
    rb"lgamma|tgamma|gamma|erfc?|cbrt|hypot|fma|ldexp)f?(?=\0)"
)
"""Functions of the C library that round differently on different systems, by their names in machine code."""
PLAIN_NUMPY = {"NPY_DISABLE_CPU_FEATURES": "X86_V3 X86_V4 AVX512_ICL AVX512_SPR"}


def digests(*names, **environment):
    """Return the digests that another process computes."""
    command = [sys.executable, "-W", "ignore", str(HERE / "state_digest.py"), *names]
    run = subprocess.run(command, env=os.environ | environment, capture_output=True, text=True, check=True)
    return json.loads(run.stdout)


def known(*names):
    """Return the expected digests."""
    return {name: KNOWN[name] for name in names}


@pytest.mark.parametrize(
    "name",
    [pytest.param(name, marks=pytest.mark.nightly if name.endswith("smooth") else ()) for name in state_digest.CASES],
)
def test_a_short_run_of_each_scene_ends_in_a_known_state(name):
    assert state_digest.digest(name) == KNOWN[name]


@pytest.fixture(scope="module")
def other_library(tmp_path_factory):
    """Return the environment for a process with a C library that rounds differently; empty if none can be built."""
    compiler = shutil.which("cc") if sys.platform == "linux" else None
    if compiler is None:
        return {}
    library = tmp_path_factory.mktemp("library") / "rounding.so"
    source = str(HERE / "other_rounding.c")
    subprocess.run(
        [compiler, "-shared", "-fPIC", "-fno-builtin", "-o", str(library), source, "-ldl", "-lm"], check=True
    )
    environment = {"LD_PRELOAD": str(library)}
    command = [sys.executable, "-c", "import math; print(math.log(3.3), math.exp(0.7), 1.7**0.3)"]
    usual, other = (subprocess.run(command, env=os.environ | more, capture_output=True) for more in ({}, environment))
    assert usual.stdout != other.stdout
    return environment


@pytest.mark.parametrize(
    "names",
    [
        ("atmosphere-plane", "lifting-moist", "attraction", "stepped", "dsmc-moist"),
        pytest.param(tuple(state_digest.CASES), marks=pytest.mark.nightly),
    ],
    ids=["a case of each engine", "all"],
)
def test_python_itself_ends_there_too_with_numpys_plainest_loops_and_another_c_library(names, other_library):
    assert digests(*names, NUMBA_DISABLE_JIT="1", **PLAIN_NUMPY, **other_library) == known(*names)


@pytest.mark.nightly
@pytest.mark.skipif(not COMPILED, reason="nothing is compiled")
@pytest.mark.parametrize("processor", ["generic", "haswell"])
def test_older_processors_would_end_in_the_same_states(processor, tmp_path):
    environment = {"NUMBA_CPU_NAME": processor, "NUMBA_CPU_FEATURES": "", "NUMBA_CACHE_DIR": str(tmp_path)}
    assert digests(**environment, **PLAIN_NUMPY) == known(*state_digest.CASES)


@pytest.mark.skipif(not COMPILED, reason="nothing is compiled")
def test_no_kernel_calls_a_function_of_the_c_library_that_rounds_its_own_way(tmp_path):
    for name in ("condensation-drops", "lifting-moist", "dsmc-moist", "stepped"):
        state_digest.digest(name)
    machine_code = sorted(cache_folder().rglob("*.nbc"))
    assert len(machine_code) >= 8
    called = {file.name: set(LIBRARY.findall(file.read_bytes())) for file in machine_code}
    assert not {name: found for name, found in called.items() if found}

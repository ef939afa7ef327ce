"""The modules in the package: made from the present sources, small, and importing nothing but memory."""

import gzip
import sys

import pytest

from atmosbox.engine.core.state import Modes
from atmosbox.errors import EngineError, on_command_line
from atmosbox.lab.box import lab_box
from atmosbox.lab.wasm_module import BESIDE, FOLDER, SCENES, module_bytes, module_name, source_stamp, stamp_of
from atmosbox.simulation.preparation import prepare

MODULES = sorted(FOLDER.glob("*.wasm.gz"))


def number_at(content, place):
    """Return a number in LEB128, and the index after it."""
    value = shift = 0
    while True:
        byte = content[place]
        value |= (byte & 0x7F) << shift
        place, shift = place + 1, shift + 7
        if byte < 0x80:
            return value, place


def imports_of(content):
    """Return the names that a module imports, by the kind of import."""
    assert content[:8] == b"\0asm\1\0\0\0"
    place = 8
    while place < len(content):
        section = content[place]
        length, place = number_at(content, place + 1)
        if section == 2:
            break
        place += length
    else:
        return []
    found, place = [], place
    count, place = number_at(content, place)
    assert count == 1
    for _ in range(2):
        length, place = number_at(content, place)
        found.append(content[place : place + length].decode())
        place += length
    return [(*found, content[place])]


def test_every_module_is_made_of_the_sources_as_they_are():
    now = source_stamp()
    if any(stamp_of(path.read_bytes()).split()[0] != now.split()[0] for path in MODULES):
        pytest.skip(f"the modules were made with another Python than {sys.version_info.major}.{sys.version_info.minor}")
    stale = [path.name for path in MODULES if stamp_of(path.read_bytes()) != now]
    assert stale == [], "run python tools/wasm.py"


def test_a_module_imports_memory_and_nothing_else():
    for path in MODULES:
        assert imports_of(gzip.decompress(path.read_bytes())) == [("env", "memory", 2)]


def test_the_modules_are_small_and_there_is_one_for_every_scene_that_has_a_lab():
    assert 0 < sum(path.stat().st_size for path in MODULES) <= 500_000
    needed = {
        lab_box(prepare(scene, settings, engine="exact")).module for scene, settings in [*SCENES.items(), *BESIDE]
    }
    assert needed == {path.name.removesuffix(".wasm.gz") for path in MODULES}


def test_a_set_of_modes_without_a_module_is_refused_in_a_sentence():
    with pytest.raises(EngineError) as refused:
        module_bytes(module_name(Modes(*[True] * 13)), "elastic-collisions")
    told = refused.value.said(on_command_line)
    assert "atmosbox run elastic-collisions --save-molecules, then atmosbox view" in told

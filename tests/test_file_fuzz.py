"""Whatever is in a netCDF file, the result is its content or one sentence, and never a traceback."""

import contextlib
import json
import random
import shutil
from pathlib import Path

import netCDF4
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import atmosbox
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.simulation import runner
from atmosbox.sweep import plan, sweep
from tests.few_frames import cut
from tests.fuzz_case import typed

ODD_TEXTS = ["", "x", "[" * 3000, "{}", "null", '{"scene": 3}', "\x00", "é" * 500, "nan", "9" * 400, '"', "run.nc"]
ODD_NUMBERS = [0, -1, 2**31 - 1, -(2**31), float("nan"), float("inf"), -1e308, 1e-320, 300.0]
COMMANDS = {
    "read": (["compare", "{odd}", "{good}", "--out", "out.png"], 1),
    "plot": (["plot", "{odd}", "--out", "out.png"], 1),
    "view": (["view", "{odd}", "--out", "out.html"], 6),
    "csv": (["export", "{odd}", "--format", "csv", "--out", "out.csv"], 12),
    "xyz": (["export", "{odd}", "--format", "extxyz", "--out", "out.xyz"], 12),
    "from": (["run", "--from", "{odd}", "--dry-run"], 12),
    "resume": (["run", "--resume", "{odd}", "--out", "out.nc", "--dry-run"], 12),
}


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Small files of all kinds, in the current folder."""
    place = tmp_path_factory.mktemp("files")

    def stop(share, word):
        if word == "running" and share > 0.5:
            raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(place)
        patch.setattr(runner, "_BREATH", 0.0)
        cut(patch, {"temperature": (60, 10), "elastic-collisions": (60, 20)})
        atmosbox.run("temperature", molecules=50, duration="0.1 ns", save_molecules=True, out="molecules.nc")
        atmosbox.run("lifting-dry", molecules=50, ascent=30.0, save_molecules=False, out="lift.nc")
        prepared = runner.prepare("elastic-collisions", {"duration": "5 s"})
        with pytest.raises(runner.Interrupted):
            runner.execute(prepared, checkpoint=Checkpoint("half.nc"), progress=stop)
        sweep(plan("elastic-collisions", ["molecules=10,20"], settings={"duration": 2.0}), "sweep.nc", jobs=1)
        yield sorted(path for path in place.iterdir() if path.is_file())


def other_bytes(path, draw):
    """Change some bytes of a file, cut it, or change its first blocks, which are HDF5's tables of addresses."""
    content = bytearray(path.read_bytes())
    kind = draw.randrange(3)
    if kind == 0:
        del content[draw.randrange(len(content)) :]
    else:
        end = min(4096, len(content)) if kind == 1 else len(content)
        for _ in range(draw.randrange(1, 20)):
            content[draw.randrange(end)] = draw.choice([0, 255, draw.randrange(256)])
    path.write_bytes(content)


def other_content(path, draw):
    """Change attributes, names and numbers of a file that stays a valid netCDF file."""
    refusals = OSError, RuntimeError, ValueError, AttributeError, TypeError, KeyError
    with netCDF4.Dataset(path, "r+") as file, contextlib.suppress(*refusals):  # netCDF itself refuses to write that
        for _ in range(draw.randrange(2, 5)):  # some of these change nothing
            owner = draw.choice([file, *file.variables.values()])
            names = owner.ncattrs()
            kind = draw.randrange(5)
            if kind == 0 and names:
                owner.delncattr(draw.choice(names))
            elif kind == 1 and names:
                owner.setncattr(draw.choice(names), draw.choice([*ODD_TEXTS, *ODD_NUMBERS]))
            elif kind == 2 and owner is not file and owner.size and owner.dtype.kind in "fiu":
                values = np.array(owner[...], dtype=owner.dtype)
                with np.errstate(all="ignore"):
                    odd = np.asarray(draw.choice(ODD_NUMBERS), float)
                    values.flat[draw.randrange(values.size)] = (
                        odd if owner.dtype.kind == "f" else int(np.nan_to_num(odd)) % 127
                    )
                owner[...] = values
            elif kind == 3:
                told = [name for name in file.ncattrs() if str(file.getncattr(name)).startswith(("{", "["))]
                if told:
                    name = draw.choice(told)
                    file.setncattr(name, json.dumps(other_json(json.loads(file.getncattr(name)), draw)))
            else:
                name = draw.choice(sorted(file.dimensions))
                file.renameDimension(name, f"other_{name}")


def other_json(held, draw):
    """Return a JSON text with one value in it changed."""
    if isinstance(held, dict) and held and draw.random() < 0.8:
        name = draw.choice(sorted(held))
        return {**held, name: other_json(held[name], draw)}
    if isinstance(held, list) and held and draw.random() < 0.8:
        k = draw.randrange(len(held))
        return [*held[:k], other_json(held[k], draw), *held[k + 1 :]]
    return draw.choice([None, True, [], {}, -1, 1e300, *ODD_TEXTS[:4], *ODD_TEXTS[6:]])


def damaged(files, draw):
    """Return a sound file, and a copy of it that is damaged."""
    good = draw.choice(files)
    odd = good.with_name("odd.nc")
    shutil.copy(good, odd)
    (other_content if draw.random() < 0.6 else other_bytes)(odd, draw)
    return good, odd


def tried(files, seed):
    """Damage a file in a way that depends on a number, and give it to a command."""
    draw = random.Random(seed)
    good, _ = damaged(files, draw)
    name = draw.choices([*COMMANDS], [weight for _, weight in COMMANDS.values()])[0]
    words = [word.format(odd="odd.nc", good=good.name) for word in COMMANDS[name][0]]
    try:
        return typed("netCDF files", *words)
    finally:
        for path in Path.cwd().iterdir():
            if path.is_file() and path not in files:
                path.unlink()


def test_nearly_all_cases_change_their_file(files):
    draw = random.Random(1)
    changed = [good.read_bytes() != odd.read_bytes() for good, odd in (damaged(files, draw) for _ in range(100))]
    files[0].with_name("odd.nc").unlink()
    assert sum(changed) >= 95


def test_other_programs_can_append_to_every_kind_of_file(files):
    for path in files:
        odd = path.with_name("odd.nc")
        shutil.copy(path, odd)
        with netCDF4.Dataset(odd, "r+") as file:
            file.setncattr("institution", "A school")
        said = [typed("netCDF files", "check", name) for name in (path.name, "odd.nc")]
        odd.unlink()
        assert said[0].exit_code == said[1].exit_code in (0, 3)
        assert said[0].output.replace(path.name, "odd.nc") == said[1].output


@settings(max_examples=60)
@given(seed=st.integers(0, 2**40))
def test_no_file_breaks_a_command(files, seed):
    tried(files, seed)


@pytest.mark.parametrize(
    "words",
    [["check", "odd.nc"], ["run", "lifting-sounding", "--set", "sounding=odd.nc", "--dry-run"]],
    ids=["run", "sounding"],
)
def test_a_heap_that_the_library_never_comes_to_the_end_of_is_refused(files, words):
    good = next(path for path in files if path.name == "lift.nc")
    content = bytearray(good.read_bytes())
    first = content.find(b"GCOL") + 16
    content[first : first + 16] = bytes(16)  # an object without a number and of no length
    odd = good.with_name("odd.nc")
    odd.write_bytes(content)
    try:
        result = typed("netCDF files", *words)
    finally:
        odd.unlink()
    assert result.exit_code == 2
    assert "damaged" in result.stderr

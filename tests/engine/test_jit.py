"""Machine code is kept on disk, and is never used when its sources have changed."""

import contextlib
import hashlib
import os
import pickle
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from types import SimpleNamespace
from typing import Any, NamedTuple

import numpy as np
import pytest

import atmosbox.engine
from atmosbox.engine.core import compiler, jit, kernel_cache
from atmosbox.engine.core.state import Modes

ENGINE = Path(atmosbox.engine.__file__).parent

CONSTANT = "FACTOR = 2.0\n"
CALLEE = """
from atmosbox.engine.core.jit import kernel

@kernel
def shifted(x):
    return x + 1.0
"""
CALLER = """
from atmosbox.engine.core.jit import kernel
from atmosbox.engine.probe_callee import shifted
from atmosbox.engine.probe_constant import FACTOR

@kernel(entry=True)
def answer(x):
    return FACTOR * shifted(x)
"""
QUESTION = "from atmosbox.engine.probe_caller import answer; print(answer(3.0), sum(answer.stats.cache_hits.values()))"

needs_numba = pytest.mark.skipif(not jit.COMPILED, reason="nothing is compiled, so nothing is kept")


@pytest.fixture
def tree(tmp_path):
    """Return a separate package tree with a copy of the engine and three more files."""
    engine = tmp_path / "tree" / "atmosbox" / "engine"
    shutil.copytree(ENGINE, engine, ignore=shutil.ignore_patterns("__pycache__"))
    (engine.parent / "__init__.py").write_text("", encoding="utf-8")
    (engine / "__init__.py").write_text("", encoding="utf-8")
    (engine / "probe_constant.py").write_text(CONSTANT, encoding="utf-8")
    (engine / "probe_callee.py").write_text(CALLEE, encoding="utf-8")
    (engine / "probe_caller.py").write_text(CALLER, encoding="utf-8")
    return tmp_path / "tree"


def ask(tree, **environment):
    """Run the kernel in a process of its own; return its answer and how often its machine code was on disk."""
    clean = {name: value for name, value in os.environ.items() if name not in ("NUMBA_CACHE_DIR", "XDG_CACHE_HOME")}
    # Python's own cache takes a file of the same time and size for unchanged
    clean["PYTHONDONTWRITEBYTECODE"] = "1"
    found = subprocess.run(
        [sys.executable, "-c", QUESTION],
        cwd=tree,
        env=clean | {"PYTHONPATH": str(tree)} | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert found.returncode == 0, found.stderr
    answer, hits = found.stdout.split()
    return float(answer), int(hits)


def edit(tree, name, old, new):
    path = tree / "atmosbox" / "engine" / name
    source = path.read_text(encoding="utf-8")
    assert old in source
    before = path.stat()
    path.write_text(source.replace(old, new), encoding="utf-8")
    # a coarse clock, or a checkout that sets times back, must not matter
    os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))


@needs_numba
def test_an_edit_in_another_file_is_seen_at_once_and_one_of_a_comment_compiles_nothing(tree, tmp_path):
    cache = {"NUMBA_CACHE_DIR": str(tmp_path / "asked"), "XDG_CACHE_HOME": str(tmp_path / "not asked")}
    assert ask(tree, **cache) == (8.0, 0)
    # the folder that numba is told is the one used
    digest = kernel_cache.source_digest(tree / "atmosbox" / "engine")
    assert list((tmp_path / "asked" / digest).rglob("*.nbc"))
    assert not (tmp_path / "not asked").exists()
    assert not list(tree.rglob("*.nbc"))
    edit(tree, "probe_callee.py", "x + 1.0", "x + 2.0")
    edit(tree, "probe_constant.py", "2.0", "3.0")
    assert ask(tree, **cache) == (15.0, 0)
    edit(tree, "probe_callee.py", "x + 2.0", "x + 1.0")
    edit(tree, "probe_constant.py", "3.0", "2.0")
    edit(tree, "probe_caller.py", "@kernel(entry", '"""A text."""\n\n# a comment\n\n\n@kernel(entry')
    edit(tree, "core/random.py", "import math", "# another comment\nimport math")
    assert ask(tree, **cache) == (8.0, 1)


def tripled(x):
    """Return three times a number."""
    return 3.0 * x


def hits():
    """Return how often a new kernel finds its machine code on disk."""
    anew = jit.kernel(entry=True)(tripled)
    assert anew(2.0) == 6.0
    return sum(anew.stats.cache_hits.values())


def flipped(content):
    place = len(content) // 2
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


@needs_numba
@pytest.mark.parametrize(
    "damage",
    [lambda content: content[:-1], lambda content: b"", flipped],
    ids=["a byte short", "empty", "one bit flipped"],
)
def test_a_damaged_cache_is_compiled_anew_and_mended(tmp_path, monkeypatch, damage):
    monkeypatch.setattr(compiler, "_CACHE", tmp_path)
    assert (hits(), hits()) == (0, 1)
    (kept,) = tmp_path.rglob("*.nbc")
    kept.write_bytes(damage(kept.read_bytes()))
    assert (hits(), hits()) == (0, 1)


class Planted:
    """A pickle that makes a file when it is loaded, as any pickle can run any program."""

    def __init__(self, mark):
        self.mark = mark

    def __reduce__(self):
        return Path.touch, (self.mark,)


def linked(path):
    path.rename(path.with_name("elsewhere"))
    path.symlink_to(path.with_name("elsewhere"))


@needs_numba
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such permissions")
@pytest.mark.parametrize(
    ("place", "change", "why"),
    [
        *((place, lambda path: path.chmod(0o720), "other users may write to it") for place in range(4)),
        *((place, linked, "it is a link") for place in range(4)),
        (3, None, "it belongs to another user"),
        (3, lambda path: None, ""),
    ],
)
def test_what_another_user_may_have_planted_does_not_run(tmp_path, monkeypatch, place, change, why):
    """The place is the home of the cache, the folder in it, that of a module, or its file; the last case runs it."""
    home, mark = tmp_path / "home", tmp_path / "ran"
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(home))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "spare"))
    monkeypatch.setattr(kernel_cache, "source_digest", lambda memory: "digest")
    monkeypatch.setattr(compiler, "_CACHE", kernel_cache.cache_folder())
    hits()
    (file,) = home.rglob("*.nbc")
    key, _ = pickle.loads(file.read_bytes()[32:])
    content = pickle.dumps((key, Planted(mark)))
    file.write_bytes(hashlib.sha256(content).digest() + content)
    path = (home, home / "digest", file.parent, file)[place]
    if change:
        change(path)
    else:
        real = kernel_cache._refuse_foreign

        def theirs(each, about):
            real(each, SimpleNamespace(st_mode=about.st_mode, st_uid=about.st_uid + (each == path)))

        monkeypatch.setattr(kernel_cache, "_refuse_foreign", theirs)
    with pytest.warns(UserWarning, match=why) if why else contextlib.nullcontext() as told:
        monkeypatch.setattr(compiler, "_CACHE", kernel_cache.cache_folder())
        hits()
        hits()
    assert mark.exists() is not bool(why)
    assert not why or str(path) in str(told[0].message)


@pytest.mark.skipif(sys.platform in ("win32", "darwin"), reason="the home of caches has another name there")
def test_where_the_home_cannot_be_written_the_temporary_folder_has_the_cache_or_nothing_is_kept(tmp_path, monkeypatch):
    blocked, spare = tmp_path / "a file, not a folder", tmp_path / "spare"
    blocked.write_text("", encoding="utf-8")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(blocked))
    monkeypatch.setenv("XDG_CACHE_HOME", str(blocked))
    monkeypatch.setattr(tempfile, "tempdir", str(spare))
    assert kernel_cache.cache_folder().parent == spare / f"atmosbox-{os.getuid()}"
    monkeypatch.setattr(tempfile, "tempdir", str(blocked))
    assert kernel_cache.cache_folder() is None
    monkeypatch.setattr(compiler, "_CACHE", None)
    assert hits() == 0


def test_the_digest_is_that_of_code_and_names_without_comments_and_survives_a_damaged_note(tmp_path):
    deep = tmp_path / "deep"
    deep.mkdir()
    texts = ['X = 1\n"""Its meaning."""\n', '"""A title."""\n\nX = 1  # a comment\n', "X = 1\n", "X = 2\n"]
    digests = []
    for text in texts:
        (deep / "one.py").write_text(text, encoding="utf-8")
        digests.append(kernel_cache.source_digest(deep, memory=tmp_path))
        assert kernel_cache.source_digest(deep) == kernel_cache.source_digest(deep, memory=tmp_path) == digests[-1]
    assert len(set(digests[:3])) == 1
    (deep / "one.py").rename(deep / "two.py")
    assert len({digests[2], digests[3], kernel_cache.source_digest(deep)}) == 3
    for damage in (b"", b"\xff\xfe", b"..", b"0123456789abcde/"):
        for note in tmp_path.glob("*.digest"):
            note.write_bytes(damage)
        assert kernel_cache.source_digest(deep, memory=tmp_path) == kernel_cache.source_digest(deep)


NO_MODES = Modes(*[False] * 7)


class Inner(NamedTuple):
    """Two values that kernels pass on."""

    number: float
    values: Any


class Outer(NamedTuple):
    """A NamedTuple in a NamedTuple."""

    inner: Inner
    number: float


@jit.kernel
def fallen(x, outer, modes):
    """Return a number; the branch for gravity cannot be compiled, so it must be left out where there is none."""
    if modes.gravity and modes.drops < 2:
        x -= outer.inner.no_such_field
    if not modes.rotation:
        x += outer.inner.number
    outer.inner.values[1] += outer.number
    return x


def asked_with(modes):
    """Return a kernel that calls `fallen` with a set of modes."""

    @jit.kernel(entry=True)
    def ask(x, outer):
        return fallen(x, jit.by_reference(outer), modes)

    return ask


def test_a_feature_that_is_off_is_not_compiled_and_a_reference_reads_and_writes_what_it_names(monkeypatch):
    monkeypatch.setattr(compiler, "_CACHE", None)  # machine code of another test on disk would prove nothing here
    values = np.zeros(3)
    outer = Outer(Inner(2.0, values), 5.0)
    assert asked_with(NO_MODES)(1.0, outer) == 3.0
    assert asked_with(NO_MODES._replace(rotation=True))(1.0, outer) == 1.0
    assert asked_with(NO_MODES._replace(gravity=True, drops=2))(1.0, outer) == 3.0
    assert list(values) == [0.0, 15.0, 0.0]
    with pytest.raises(Exception, match="no_such_field"):
        asked_with(NO_MODES._replace(gravity=True))(1.0, outer)


@needs_numba
def test_a_kernel_that_reads_a_flag_it_was_said_to_do_without_is_refused(monkeypatch):
    monkeypatch.setattr(compiler, "_CACHE", None)
    outer = Outer(Inner(2.0, np.zeros(3)), 5.0)
    assert asked_with(NO_MODES.without("mixed"))(1.0, outer) == 3.0
    with pytest.raises(AttributeError, match="rotation is one of the modes"):
        asked_with(NO_MODES.without("rotation"))(1.0, outer)

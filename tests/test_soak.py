"""Runs of an hour, and faults of the system around a run: by hand and in a workflow, ``pytest -m soak``."""

import os
import resource
import subprocess
import sys

import numpy as np
import pytest

from atmosbox.engine import FollowPressure, HeatBath, Mist, ParcelSet, Periodic, Piston, Specular, Substance
from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel
from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet
from atmosbox.file.netcdf import read

pytestmark = pytest.mark.soak

CONTACTS = 1e9  # of all exact boxes together
WATER = Substance(mass=0.62, diameter=1.0, rotation=3.0, binding_energy=4.0, heat_capacity=9.0, volatility=1.0)
SMOOTH = (Specular(),) * 5


def gas(fraction, edge=8, seed=3):
    """Return places on a lattice, velocities and the side of a box so full."""
    number = edge**3
    side = (number * np.pi / 6.0 / fraction) ** (1.0 / 3.0)
    site = np.stack(np.meshgrid(*[np.arange(edge)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return (site + 0.5) * side / edge, np.random.default_rng(seed).normal(size=(number, 3)), side


def column(fraction):
    x, v, side = gas(fraction)
    walls = (Periodic(),) * 4 + (HeatBath(1.0), HeatBath(1.5))
    return ParcelSet(x, v, length=(side,) * 3, walls=walls, gravity=0.05, rotation=2.0, rotational_energy=1.0)


def baths():
    x, v, side = gas(0.2)
    return ParcelSet(x, v, length=(side,) * 3, walls=tuple(HeatBath(1.0 + 0.1 * k) for k in range(6)), rotation=3.0)


def lifted(kind=ParcelSet, **more):
    x, v, side = gas(0.1)
    follow = FollowPressure([0.0, 1e9], [0.3, 0.15], mean_free_time=1.0)
    return kind(x, v, length=(side,) * 3, walls=(*SMOOTH, Piston()), driver=follow, rotation=2.0, **more)


def mist():
    return lifted(MoistParcelSet, mass=np.tile([1.0, 0.62], 256), liquid=Mist(WATER, number=40, kT=1.0))


BOXES = {
    "dilute column": lambda: column(0.01),
    "column": lambda: column(0.1),
    "dense column": lambda: column(0.3),
    "six baths": baths,
    "piston": lifted,
    "mist under a piston": mist,
}


@pytest.mark.parametrize("name", BOXES)
def test_an_exact_box_stays_lawful(name, request):
    wanted = request.config.getoption("--soak") * CONTACTS / len(BOXES)
    box = BOXES[name]()
    box.advance(1.0)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    while box.contacts < wanted:
        box.advance(box.time + 100.0)
        assert box.escaped() == 0
    assert box.ledger() < 1e-10
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < memory + 50_000  # kB


def test_many_molecules_of_dsmc_stay_lawful(request):
    share = request.config.getoption("--soak")
    number, steps = int(max(1e7 * share, 1e4)), int(max(1e4 * share, 100))
    random = np.random.default_rng(1)
    side = (number / 0.02) ** (1.0 / 3.0)
    box = DsmcParcel(random.uniform(1.0, side - 1.0, (number, 3)), random.normal(size=(number, 3)), length=(side,) * 3)
    for step in range(10):
        box.advance(0.1 * (step + 1) * steps / 10)
    assert box.contacts > 0
    assert box.escaped() == 0
    assert box.ledger() < 1e-10


def command(folder, *options, **environment):
    """Run a short scene by the command line, and return what became of it."""
    known = {"PATH": os.environ["PATH"], "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    own = ("HOME", "NUMBA_CACHE_DIR", "XDG_CACHE_HOME")
    kept = {name: os.environ[name] for name in own if name in os.environ}
    settings = {name: value for name, value in (known | kept | environment).items() if value is not None}
    words = [
        "-m",
        "atmosbox",
        "run",
        "elastic-collisions",
        "--set",
        "duration=2",
        "--quiet",
        "--force",
        "--out",
        "x.nc",
    ]
    return subprocess.Popen(
        [sys.executable, *options, *words], cwd=folder, env=settings, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        text=True,
    )  # fmt: skip


def numbers(folder):
    return read(folder / "x.nc").kinetic_energy_light.values.tobytes()


FAULTS = {
    "no home": ((), {"HOME": None}),
    "a home that is not there": ((), {"HOME": "/nowhere", "XDG_CACHE_HOME": "/nowhere/cache"}),
    "a file for a home": ((), {"HOME": "/etc/hostname", "XDG_CACHE_HOME": None}),
    "no assertions": (("-O",), {}),
    "every warning an error": (("-W", "error"), {}),
    "German": ((), {"LC_ALL": "de_DE.UTF-8"}),
    "Turkish": ((), {"LC_ALL": "tr_TR.UTF-8"}),
    "ASCII": ((), {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONIOENCODING": "ascii"}),
    "a clock before 1970": ((), {"SOURCE_DATE_EPOCH": "-86400"}),
    "another time zone": ((), {"TZ": "Pacific/Kiritimati"}),
}


@pytest.mark.parametrize("name", FAULTS)
def test_a_run_does_not_depend_on_what_is_around_it(name, tmp_path):
    options, environment = FAULTS[name]
    usual, odd = tmp_path / "usual", tmp_path / "odd"
    for folder, given in ((usual, ((), {})), (odd, (options, environment))):
        folder.mkdir()
        with command(folder, *given[0], **given[1]) as process:
            out, said = process.communicate()
        assert process.returncode == 0, said
        assert out == "x.nc\n"
    assert numbers(odd) == numbers(usual)


def test_cold_caches_may_be_shared_and_broken_ones_are_made_anew(tmp_path):
    cache = tmp_path / "cache"
    cache.mkdir(mode=0o700)
    folders = [tmp_path / str(k) for k in range(3)]
    for folder in folders:
        folder.mkdir()
    together = [command(folder, NUMBA_CACHE_DIR=str(cache)) for folder in folders]
    for process in together:
        _, said = process.communicate()
        assert process.returncode == 0, said
    kept = [path for path in cache.rglob("*") if path.suffix in (".nbi", ".nbc")]
    assert kept
    for path in kept:
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    with command(folders[0], NUMBA_CACHE_DIR=str(cache)) as process:
        _, said = process.communicate()
    assert process.returncode == 0, said
    assert len({numbers(folder) for folder in folders}) == 1


@pytest.mark.skipif(not hasattr(os, "geteuid") or os.geteuid() != 0, reason="only root may mount a small disk")
def test_a_full_disk_is_one_sentence_and_leaves_the_file_before(tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", str(disk)], check=False)
    if mounted.returncode:
        pytest.skip("no small disk can be mounted here")
    try:
        (disk / "x.nc").write_text("before")
        with command(disk) as process:
            _, said = process.communicate()
        assert process.returncode == 1
        assert "The disk has no room" in said
        assert "Traceback" not in said
        assert (disk / "x.nc").read_text() == "before"
        assert not list(disk.glob("*.tmp"))
    finally:
        subprocess.run(["umount", str(disk)], check=False)

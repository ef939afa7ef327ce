"""Files: complete or absent, according to CF, and read again as they were written."""

import errno
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from unittest.mock import Mock

import netCDF4
import numpy as np
import pytest
import xarray as xr

from atmosbox import film, page, plot, sheet
from atmosbox.errors import DiskFullError, FileError
from atmosbox.file import netcdf as output
from atmosbox.file import output_path, provenance, validity
from atmosbox.file.dataset import VARIABLES, dataset
from atmosbox.file.output_path import check_writable, clear, whole_file
from atmosbox.scene.headline import Headline

CHECKER = """
import contextlib, io, json, sys
from compliance_checker.runner import CheckSuite, ComplianceChecker
CheckSuite.load_all_available_checkers()

def once(function):
    # the checker looks through all variables thousands of times to find those of a kind
    found = {}

    def remembered(dataset, *more):
        key = (dataset.filepath(), *more)
        if key not in found:
            found[key] = function(dataset, *more)
        return list(found[key])

    return remembered

with contextlib.suppress(ImportError):  # another version has them elsewhere
    from compliance_checker.cf import util
    for kind in ("auxiliary_coordinate", "z", "time", "longitude", "latitude", "cell_boundary", "forecast_metadata"):
        name = f"get_{kind}_variables"
        if hasattr(util, name):
            setattr(util, name, once(getattr(util, name)))
said = {}
for path in sys.argv[1:]:
    with contextlib.redirect_stdout(io.StringIO()) as found:
        passed, failed = ComplianceChecker.run_checker(path, ["cf:1.11"], 0, "strict", output_filename="-")
    said[path] = found.getvalue() if failed or not passed else ""
print(json.dumps(said))
"""


def attributes(**extra):
    parameters = {"scene": "lifting-dry", "settings": {"seed": 7, "temperature": 25.0}, "engine": "exact"}
    words = {"title": "Lifted air", "comment": "No ice, pas de glace à 25 °C.", "references": "doi:10.1000/1"}
    return provenance.global_attributes(parameters, command="atmosbox run lifting-dry", **words) | extra


def headline(name, value, unit, **fields):
    stated = {"standard_error": 0.1, "theory": 9.8, "tolerance": 0.4, "reason": "finite speed", "label": "a number"}
    return Headline(**{"name": name, "value": value, "unit": unit, "display_unit": unit, **stated, **fields})


def times(count, step=0.001):
    """Return frames a picosecond long, in nanoseconds."""
    edges = step * np.arange(count + 1.0)
    return {"elapsed_time": edges[1:], "elapsed_time_bnds": np.stack([edges[:-1], edges[1:]], axis=1)}


def bins(name, count, width):
    edges = width * np.arange(count + 1.0)
    middle = (edges[1:] + edges[:-1]) / 2
    return {name: middle, f"{name}_bnds": np.stack([edges[:-1], edges[1:]], axis=1)}


def filled(names, coords, companions=("_se", "_count", "_theory", "_tolerance")):
    """Return an array for every named variable, and for its derived variables if it is measured."""
    random = np.random.default_rng(1)
    sizes = {"wall": 6, "axis": 3, "drop": 5} | {name: len(values) for name, values in coords.items()}
    frames = {}
    for name in names:
        shape = [sizes[dim] for dim in VARIABLES[name].dims]
        measured = not VARIABLES[name].ledger and VARIABLES[name].dtype == "f8"
        for suffix in ("", *companions) if measured else ("",):
            frames[name + suffix] = random.integers(0, 2, shape) if VARIABLES[name].flags else random.random(shape)
    return frames


def lifting():
    coords = times(50)
    names = [name for name in VARIABLES if name.startswith(("parcel", "environment", "piston"))]
    frames = filled(["air_pressure", "heat_from_wall", *names], coords, companions=("_se", "_theory"))
    frames["parcel_temperature"][3] = np.nan
    stated = [
        headline("lapse_rate", 9.7e-3, "K m-1"),
        headline("final_temperature", 293.15, "K"),
        headline("misfit", 0.2, "K", reason=None),
        headline("final_pressure", 30000.0, "Pa", theory=None, tolerance=None),
        headline("cloud_base", None, "m", standard_error=None, theory=None, tolerance=None),
        headline("compressibility_factor", 1.001, "1"),
    ]
    return dataset(frames, coords, attributes(), stated)


def everything():
    """Return a run with every variable that is declared."""
    coords = times(130) | bins("height", 20, 500.0) | bins("speed", 40, 50.0) | bins("energy", 60, 1e-21)
    coords |= (
        bins("distance", 20, 5e-9) | bins("radius", 30, 1e-10) | {"molecule": np.arange(40), "mode": np.arange(6.0)}
    )
    names = [name for name, declared in VARIABLES.items() if declared.dims != (name,)]
    frames = filled(names, coords, companions=())
    frames |= filled([name for name in names if VARIABLES[name].dims in (("height",), ("distance",))], coords)
    frames["layer_temperature"][-1] = np.nan
    frames["molecule_position"][5, 7] = np.nan
    return dataset(frames, coords, attributes(), time_unit="ps")


RUNS = [lifting, everything]


# The content of a file


@pytest.fixture(scope="module")
def faults(tmp_path_factory):
    """The results of the strict check of CF for files by name, in one process: the checker takes seconds to start."""
    folder = tmp_path_factory.mktemp("checked")
    whole, wrong = everything(), lifting()[["air_pressure"]]
    declared = sorted(map(str, whole.data_vars))
    # the checker takes the square of their number; a variable, its error and its theory begin with the same letters
    parts = [
        whole.drop_vars([name for name in declared if sum(map(ord, name[:3])) % 8 != k and not name.endswith("_bnds")])
        for k in range(8)
    ]
    assert set().union(*(part.data_vars for part in parts)) == set(declared)
    wrong.air_pressure.attrs["units"] = "m"
    runs = {"lifting": lifting(), **{f"part {k}": part for k, part in enumerate(parts)}, "wrong": wrong}
    paths = {name: output.write(run, folder / f"{name}.nc") for name, run in runs.items()}
    again = output.read(paths["part 1"])
    again.attrs["history"] += "\n" + provenance.history_line("atmosbox plot run.nc")
    paths["again"] = output.write(again.isel(elapsed_time=slice(0, 10)), folder / "again.nc")
    done = subprocess.run([sys.executable, "-c", CHECKER, *map(str, paths.values())], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    said = json.loads(done.stdout.splitlines()[-1])
    assert output.read(paths["again"]).attrs["history"].count("\n") == 1
    return {name: said[str(path)] for name, path in paths.items()}


def test_a_file_passes_the_strict_check_of_cf_also_read_changed_and_written_again(faults):
    assert [name for name, found in faults.items() if found] == ["wrong"], faults


@pytest.mark.parametrize("make", RUNS)
def test_a_file_is_read_as_it_was_written(tmp_path, make):
    run = make()
    found = output.read(output.write(run, tmp_path / "run.nc"))
    assert found.identical(run)
    with xr.open_dataset(tmp_path / "run.nc", engine="netcdf4") as opened:
        assert opened.identical(run)
        assert opened.elapsed_time.dtype == float


# Paths that may be written


def test_no_function_that_saves_replaces_a_file_unasked(tmp_path):
    """Commands check the path before they begin (test_cli), and each function checks it before its other arguments."""
    for save, ending in [
        (output.write, "nc"),
        (plot.save, "svg"),
        (film.save, "gif"),
        (page.save, "html"),
        (sheet.save, "md"),
    ]:
        path = tmp_path / f"mine.{ending}"
        path.write_text("mine")
        with pytest.raises(FileError, match=r"exists already: add force=True"):
            save(xr.Dataset(), path)
        assert path.read_text() == "mine"


@pytest.mark.parametrize("force", [False, True])
def test_a_place_that_cannot_be_written_is_refused_with_a_way_out(tmp_path, force):
    (tmp_path / "file").write_text("text")
    for place, words in [
        (tmp_path, "is a folder: give a file in it"),
        (tmp_path / "no" / "run.nc", f"type mkdir -p {tmp_path}/no first"),
        (tmp_path / "two words" / "run.nc", f"type mkdir -p '{tmp_path}/two words' first"),
        (tmp_path / "file" / "run.nc", "is a file, not a folder"),
        (tmp_path / ("x" * 240 + ".nc"), "too long"),
        (tmp_path / ("x" * 2000), "too long"),
        (tmp_path / ("x" * 2000) / "run.nc", "does not exist"),
        ("/dev/null", "is a device"),
        ("", "name of the file is empty"),
    ]:
        for attempt in (check_writable, lambda path, force: output.write(lifting(), path, force=force)):
            with pytest.raises(FileError, match=words) as refusal:
                attempt(place, force=force)
            assert str(refusal.value).endswith(".")
            assert refusal.value.exit_code == 2
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("place", [(os, "fsync"), (os, "replace"), (Path, "write_bytes")])
def test_a_full_disk_leaves_the_old_file_and_nothing_else(tmp_path, monkeypatch, place):
    path, new = output.write(lifting(), tmp_path / "run.nc"), lifting().isel(elapsed_time=slice(10))
    before = path.read_bytes()
    for number in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
        monkeypatch.setattr(*place, Mock(side_effect=OSError(number, os.strerror(number))))
        with pytest.raises(DiskFullError, match=r"no room.*stays as it was") as refusal:
            output.write(new, path, force=True)
        assert refusal.value.exit_code == 1
        assert [path.name for path in tmp_path.iterdir()] == ["run.nc"]
    monkeypatch.undo()
    assert path.read_bytes() == before


def test_whatever_a_file_is_made_of_it_is_there_whole_or_not_at_all(tmp_path):
    path = tmp_path / "film.mp4"
    path.write_bytes(b"old")

    def stopped(error):
        with whole_file(path) as temporary:
            temporary.write_bytes(b"half")
            raise error("it stopped")

    for error in (KeyboardInterrupt, RuntimeError, FileError):
        with pytest.raises(error):
            stopped(error)
    assert path.read_bytes() == b"old"
    with whole_file(path) as temporary:
        temporary.write_bytes(b"new")
        assert path.read_bytes() == b"old"
    assert path.read_bytes() == b"new"
    assert [each.name for each in tmp_path.iterdir()] == ["film.mp4"]


# Files that may be read


def foreign(path):
    xr.Dataset({"t": ("time", [1.0, 2.0], {"units": "days since 0000-00-00"})}).to_netcdf(path, engine="netcdf4")


def with_attributes(**changed):
    return lambda path: output.write(lifting().assign_attrs(changed), path)


def truncated(path):
    whole = output.write(everything(), path).read_bytes()
    path.write_bytes(whole[: len(whole) // 2])


def unitless(path):
    output.write(lifting(), path)
    with netCDF4.Dataset(path, "r+") as file:
        file["elapsed_time"].delncattr("units")


def boundless(path):
    """A file of some kilobytes that declares 5.6 GB."""
    with netCDF4.Dataset(path, "w") as file:
        file.setncatts(attributes())
        file.createDimension("many", 700_000_000)
        file.createVariable("air_density", "f8", ("many",), chunksizes=(1000,))


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda path: None, "does not exist: check the name"),
        (lambda path: path.mkdir(), "is a folder"),
        (lambda path: path.touch(), "is empty"),
        (lambda path: path.write_text("temperature, pressure\n"), "is not a netCDF file, or is damaged"),
        (lambda path: path.write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(500)), "is not a netCDF file, or is damaged"),
        (truncated, "is not a netCDF file, or is damaged"),
        (foreign, "was written by another program"),
        (with_attributes(atmosbox_format=provenance.FORMAT + 1), "format 2.*pip install --upgrade atmosbox"),
        (with_attributes(atmosbox_format="two"), "format two"),
        (lambda path: os.mkfifo(path), "may not be read"),
        (with_attributes(atmosbox_parameters="[" * 3000), "atmosbox_parameters .* is not as atmosbox writes it"),
        (with_attributes(atmosbox_headlines='{"a": 1}'), "atmosbox_headlines .* is not as atmosbox writes it"),
        (with_attributes(atmosbox_headlines="[[]]"), "which its headlines name"),
        (unitless, "does not say the units of elapsed_time"),
        (boundless, "declares 5.6 GB"),
    ],
)
def test_a_file_that_is_not_a_run_is_refused_in_one_sentence(tmp_path, make, words):
    path = tmp_path / "run.nc"
    make(path)
    with pytest.raises(FileError, match=words) as refusal:
        output.read(path)
    assert str(path) in str(refusal.value)
    assert str(refusal.value).endswith(".")
    assert "\n" not in str(refusal.value)


def test_a_run_that_does_not_fit_into_memory_is_refused_before_it_is_loaded(tmp_path, monkeypatch):
    path = output.write(lifting(), tmp_path / "run.nc")
    monkeypatch.setattr(validity, "SMALL", 0)
    monkeypatch.setattr(validity, "free_memory", lambda: 100.0)
    with pytest.raises(FileError, match="free memory are too few"):
        output.read(path)


KILLED = """
import sys, time
from pathlib import Path
from atmosbox.file.output_path import whole_file
from atmosbox.cli.terminal import stoppable
with stoppable(), whole_file(Path(sys.argv[1])) as temporary:
    temporary.touch()
    print(flush=True)
    time.sleep(60)
"""


@pytest.mark.skipif(os.name == "nt", reason="signals of Windows are others")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGINT])
def test_a_command_that_is_asked_to_end_leaves_nothing_half_written(tmp_path, number):
    stopped(tmp_path / "a.png", number)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.name == "nt", reason="signals of Windows are others")
def test_what_a_killed_command_has_left_goes_with_the_next(tmp_path):
    stopped(tmp_path / "a.png", signal.SIGKILL)
    (left,) = tmp_path.iterdir()
    long_ago = time.time() - 1.1 * output_path.LEFT_OVER
    os.utime(left, (long_ago, long_ago))
    with whole_file(tmp_path / "a.png") as ours:
        ours.write_text("figure")
        clear(tmp_path / "a.png")
        assert [each.name for each in tmp_path.iterdir()] == [ours.name]


def stopped(path, number):
    """Stop a command while it writes a file."""

    def listen():
        signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)

    with subprocess.Popen(
        [sys.executable, "-c", KILLED, str(path)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        preexec_fn=None if number == signal.SIGKILL else listen,
    ) as process:  # fmt: skip
        process.stdout.readline()
        process.send_signal(number)
    assert process.returncode != 0

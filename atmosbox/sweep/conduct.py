"""How a sweep runs: each run has a file of its own, and runs that have one are not repeated.

Runs are made in this process, in processes of this machine, or on a Dask cluster.
"""

import json
import multiprocessing
import os
import signal
import sys
import tempfile
import threading
import warnings
from collections.abc import Callable, Generator, Mapping, Sequence
from concurrent import futures
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, suppress
from multiprocessing import connection
from pathlib import Path
from typing import Any, TypeAlias

import xarray as xr

from atmosbox.errors import AtmosboxError, EngineError, FileError, Option, SettingError, shown
from atmosbox.file.netcdf import read, write
from atmosbox.file.output_lock import ANOTHER_NAME
from atmosbox.file.output_path import check_writable, write_whole
from atmosbox.scene.settings import Parameter
from atmosbox.simulation import runner
from atmosbox.sweep.plan import Plan, Task
from atmosbox.sweep.result import join, row

REQUEST = "sweep.json"
"""The file in the folder of a sweep that tells which sweep it is."""
_JOBS = Parameter("jobs", "1", 8, 1, 4096, kind="int", given_as=Option)
PATIENCE = 10.0
"""Longest time to wait for an answer of the scheduler, and then for a first worker [s]."""


Done: TypeAlias = tuple[Task, str, list[str]]
"""A run that has ended: why it failed, empty if its file is written, and its warnings."""


def cores() -> int:
    """Return the number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def folder_of(path: str | os.PathLike[str]) -> Path:
    """Return the folder with the runs of a sweep, beside the file that joins them.

    Examples
    --------
    >>> str(folder_of("condensation-sweep.nc"))
    'condensation-sweep'
    """
    name = Path(path)
    return name.parent / (name.stem if name.suffix else f"{name.name}-runs")


def sweep(
    plan: Plan,
    out: str | os.PathLike[str] | None = None,
    *,
    jobs: int | str | None = None,
    scheduler: str | None = None,
    force: bool = False,
    progress: Callable[[float, str], None] | None = None,
    command: str = "",
) -> xr.Dataset:
    """Run all members of a sweep, on the cores of this machine or on a cluster, and join them.

    Every run writes its own netCDF file, ``NAME/POINT-MEMBER.nc`` beside NAME.nc. The same call goes on where an
    earlier one stopped, for whatever reason: a run that has its file is not repeated, and the results are the same, bit
    for bit. With more members, the runs that are there are used. Ctrl-C leaves the runs that have ended.

    Parameters
    ----------
    plan
        The sweep.
    out
        The netCDF file to write; by default nothing is written.
    jobs
        Number of processes on this machine; by default one for each core. With 1, the runs are made in this process
        itself.
    scheduler
        Address of a Dask scheduler, whose workers run the members instead.
    force
        Whether the file and the runs of another sweep may be replaced.
    progress
        Called with the share of the runs that have ended, and a word on what happens.
    command
        The command that the user typed, for the history in the file.

    Returns
    -------
    xarray.Dataset
        The means of all headlines, what each run measured, and which runs failed, see `atmosbox.sweep.result.join`.
    """
    if out is None:
        with tempfile.TemporaryDirectory(prefix="atmosbox-sweep-") as temporary:
            path = Path(temporary, "sweep.nc")
            return sweep(plan, path, jobs=jobs, scheduler=scheduler, progress=progress, command=command)
    if jobs is not None and scheduler is not None:
        raise SettingError("jobs", jobs, "is for this machine, and a scheduler for another", "leave one of them out")
    processes = cores() if jobs is None else int(_JOBS.parse(jobs))
    _take(out, plan.request(), force)
    tell = progress or (lambda share, word: None)
    tasks = plan.tasks(folder_of(out))
    waiting = [task for task in tasks if not os.path.exists(task.path)]
    failed: dict[tuple[int, int], str] = {}
    tell(1.0 - len(waiting) / plan.runs, "running")
    runs: Generator[Done] = (_run(task) for task in waiting)
    if scheduler is not None:
        runs = _on_cluster(waiting, scheduler)
    elif min(processes, len(waiting)) > 1:
        runs = _in_processes(waiting, processes)
    with closing(runs):
        for ended, (task, reason, remarks) in enumerate(runs, plan.runs - len(waiting) + 1):
            tell(ended / plan.runs, "running")
            if reason:
                failed[task.point, task.member] = reason
            for text in remarks:
                warnings.warn(text, stacklevel=2)
    rows = {(task.point, task.member): row(read(task.path)) for task in tasks if os.path.exists(task.path)}
    empty = "The run was too short for any of its headlines to be measured."
    failed |= {key: empty for key, found in rows.items() if not found.attrs["names"]}
    dataset = join(plan, rows, failed, command or f"atmosbox.sweep.sweep({plan.scene!r}, ...)")
    write(dataset, out, force=True)
    return dataset


def _take(out: str | os.PathLike[str], wanted: Mapping[str, Any], force: bool) -> None:
    """Make the folder of a sweep, or go on with it if it is of the same sweep; with `force`, take that of another."""
    folder = folder_of(out)
    known = _request_in(folder)
    check_writable(out, force or known is not None)
    if known == wanted:
        return
    if known is None and os.path.lexists(folder):
        raise FileError(f"{folder} holds other things than a sweep", "move it, or ", *ANOTHER_NAME)
    if known is not None and not force:
        name = next(name for name in [*known, *wanted] if known.get(name) != wanted.get(name))
        before, now = ("not given" if each.get(name) is None else shown(each[name]) for each in (known, wanted))
        problem = f"{folder} has the runs of another sweep, with {name} {before} and not {now}"
        raise FileError(problem, *ANOTHER_NAME, ", or add ", Option("force", True), " to replace them")
    folder.mkdir(exist_ok=True)
    for old in folder.glob("*.nc"):
        old.unlink()
    write_whole(folder / REQUEST, json.dumps(wanted, indent=1).encode())


def is_taken(path: Path, plan: Plan) -> bool:
    """Return whether a file, or the folder of its runs, holds anything else than this sweep."""
    return (path.exists() or folder_of(path).exists()) and _request_in(folder_of(path)) != plan.request()


def _request_in(folder: Path) -> dict[str, Any] | None:
    """Return what determines the runs in a folder; None if it is not the folder of a sweep."""
    with suppress(OSError, ValueError):
        return dict(json.loads((folder / REQUEST).read_bytes()))
    return None


def _run(task: Task) -> Done:
    """Run one member and write its file, whole or not at all; no other can be saved either if that fails."""
    reason = ""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            if not os.path.exists(task.path):  # a Dask worker that is killed may leave a file and no answer
                write(runner.execute(runner.prepare(**task.asked)).dataset, task.path, force=True)
        except FileError:
            raise
        except Exception as error:
            reason = str(error) if isinstance(error, AtmosboxError) else f"{type(error).__name__}: {error}"
    return task, " ".join(reason.split()), sorted({str(each.message) for each in caught})


def _as_completed(pool: futures.Executor, tasks: Sequence[Task]) -> Generator[Done]:
    """Submit all runs, and yield each as it ends; one that kills its worker again and again has failed."""
    running = {pool.submit(_run, task): task for task in tasks}
    for future in futures.as_completed(running):
        if future.cancelled():
            raise EngineError("The connection to the scheduler was lost: type the same command again to go on.")
        error = future.exception()
        if error is None or isinstance(error, FileError | BrokenProcessPool):
            yield future.result()
        else:
            yield running[future], f"Its worker failed ({type(error).__name__}: {error}).", []


def _in_processes(tasks: Sequence[Task], jobs: int) -> Generator[Done]:
    """Run the members in processes of this machine.

    If a process dies, the runs that were under way are tried again, one at a time: the one whose process dies once
    more counts as failed.
    """
    waiting, suspects = list(tasks), 0
    while waiting:
        batch = waiting[:1] if suspects else waiting
        before = set(multiprocessing.active_children())
        pool = futures.ProcessPoolExecutor(jobs, multiprocessing.get_context("spawn"), initializer=_begin)
        try:
            _check_begun(pool)
            for done in _as_completed(pool, batch):
                waiting.remove(done[0])
                yield done
        except BrokenProcessPool:
            if suspects:
                yield waiting.pop(0), "Its process died twice: memory may be short, give fewer jobs.", []
            suspects = suspects or jobs + 1
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in set(multiprocessing.active_children()) - before:
                process.kill()
                process.join()
        suspects = max(suspects - 1, 0)


def _check_begun(pool: futures.Executor) -> None:
    """Refuse to go on if a process that has nothing to do yet dies."""
    try:
        pool.submit(cores).result()
    except BrokenProcessPool:
        remedy = 'in a script of your own, put the call below if __name__ == "__main__", or give '
        raise EngineError("The processes of the sweep cannot begin", remedy, Option("jobs", 1)) from None


def _begin() -> None:
    """Prepare a process: Ctrl-C is handled by the first process, and this one ends with it, for whatever reason."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.stdout = sys.stderr  # output of a user's scene must not mix with results

    def end_with_parent() -> None:
        parent = multiprocessing.parent_process()
        if parent is not None:
            connection.wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=end_with_parent, daemon=True).start()


def _on_cluster(tasks: Sequence[Task], address: str) -> Generator[Done]:
    """Run the members on the workers of a Dask cluster; a run whose worker dies is given to another worker."""
    try:
        from distributed import Client

        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (ImportError, OSError, TimeoutError, ValueError, TypeError, RuntimeError) as error:
        problem = f"cannot be reached ({' '.join(str(error).split()) or type(error).__name__})"
        fix = "type pip install 'atmosbox[cluster]', then dask scheduler, and give the address that it names"
        raise SettingError("scheduler", address, problem, fix) from error
    with client:
        with suppress(TimeoutError):
            client.wait_for_workers(1, timeout=PATIENCE)
        found = client.get_versions(packages=["atmosbox"])
        here, *there = (str(each["packages"]["atmosbox"]) for each in (found["client"], *found["workers"].values()))
        if set(there) != {here}:
            problem = f"needs workers with atmosbox {here}, and has {', '.join(sorted(set(there))) or 'none'}"
            fix = f"type pip install atmosbox=={here}, then dask worker {address} --nworkers auto --nthreads 1"
            raise SettingError("scheduler", address, problem, fix)
        yield from _as_completed(client.get_executor(pure=False), tasks)

"""Where the runs of a sweep are computed: in this process, in processes of this machine, or on a Dask cluster."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Generator, Sequence
from concurrent import futures
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import connection
from typing import TYPE_CHECKING

from atmosbox.errors import AtmosboxError, EngineError, Option, SettingError
from atmosbox.sweep import member
from atmosbox.sweep.member import Done, Task
from atmosbox.version import __version__

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["cores", "here", "on_cluster", "processes"]

PATIENCE = 10.0
"""Longest time to wait for an answer of the scheduler, and then for a first worker [s]."""

_BREATH = 0.5
"""Time between two reports of progress [s]."""

Watch = Callable[[float, str], None]
"""Called with the work under way, in units of one run, and a short text on the present step."""


def cores() -> int:
    """Return the number of cores that this process may use.

    Examples
    --------
    >>> cores() >= 1
    True
    """
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def here(tasks: Sequence[Task], watch: Watch) -> Generator[Done]:
    """Run the members one after another in this process."""
    for task in tasks:
        yield member.run(task, watch)


def processes(tasks: Sequence[Task], jobs: int, watch: Watch) -> Generator[Done]:
    """Run the members in processes of this machine, and yield each as it ends.

    If a process dies, the runs that were under way are tried again, one at a time: the one that kills its process once
    more counts as failed.

    Raises
    ------
    EngineError
        If the processes cannot begin.
    """
    waiting, suspects = list(tasks), 0
    while waiting:
        batch = waiting[: suspects or None]
        workers = 1 if suspects else min(jobs, len(batch))
        before = set(multiprocessing.active_children())
        pool = futures.ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), initializer=_begin)
        try:
            _check_begun(pool)
            watch(0.0, "compiling")
            pool.submit(member.compile_first, batch[0]).result()
            for done in _as_completed(pool, batch, watch):
                waiting.remove(done.task)
                yield done
            suspects = 0
        except BrokenProcessPool:
            if suspects:
                yield Done(waiting.pop(0), "Its process died twice: memory may be short, give fewer jobs.")
            suspects = suspects - 1 if suspects else workers
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
            for process in set(multiprocessing.active_children()) - before:
                process.kill()
                process.join()


def _check_begun(pool: futures.Executor) -> None:
    """Refuse to go on if a process that has nothing to do yet dies."""
    try:
        pool.submit(cores).result()
    except BrokenProcessPool:
        raise EngineError(
            "The processes of the sweep cannot begin",
            'in a script of your own, put the call below if __name__ == "__main__", or give ',
            Option("jobs", 1),
        ) from None


def _as_completed(pool: futures.Executor, tasks: Sequence[Task], watch: Watch) -> Generator[Done]:
    """Submit runs and yield each as it ends; the share of those under way is estimated from the pace so far."""
    left = {pool.submit(member.run, task) for task in tasks}
    began = last = time.monotonic()
    count = 0
    while left:
        ended, left = futures.wait(left, timeout=_BREATH, return_when=futures.FIRST_COMPLETED)
        now = time.monotonic()
        if not ended:
            watch(min(count / (now - began) * (now - last), 0.9), "running")
            continue
        for future in ended:
            yield future.result()
        count, last = count + len(ended), now


def _begin() -> None:
    """Prepare a worker: Ctrl-C is handled by the first process, with which the worker ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    sys.stdout = sys.stderr  # output of a user's scene must not mix with results
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """End this process when its parent process has ended, for whatever reason."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)


def on_cluster(tasks: Sequence[Task], address: str, watch: Watch) -> Generator[Done]:
    """Run the members on the workers of a Dask cluster, which see the folder of the sweep under the same path.

    A run whose worker dies is given to another worker, which goes on from its saved state.

    Raises
    ------
    SettingError
        If dask.distributed is missing, the scheduler does not answer, there are no workers, or a worker has another
        version of atmosbox.
    EngineError
        If the scheduler is lost during the sweep.
    """
    client = _connected(address)
    try:
        _check_workers(client, address)
        yield from _as_completed(client.get_executor(pure=False), tasks, watch)
    except AtmosboxError:
        raise
    except futures.CancelledError:
        raise EngineError(f"The scheduler {address} was lost: type the same again to go on where it stopped.") from None
    except Exception as error:
        why = " ".join(str(error).split()) or type(error).__name__
        raise EngineError(f"The cluster {address} cannot run it ({why}): look at its log.") from error
    finally:
        client.close(timeout=2.0)


def _connected(address: str) -> Client:
    """Return a client of the scheduler."""
    try:
        from distributed import Client
    except ImportError:
        problem, fix = "needs dask.distributed, which is not installed", "type pip install 'atmosbox[cluster]'"
        raise SettingError("scheduler", address, problem, fix) from None
    try:
        return Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, TimeoutError, ValueError, TypeError, RuntimeError) as error:
        why = " ".join(str(error).split()) or type(error).__name__
        problem = f"does not answer ({why}): start one with dask scheduler"
        raise SettingError(
            "scheduler", address, problem, Option("scheduler"), " with the address that it names"
        ) from error


def _check_workers(client: Client, address: str) -> None:
    """Refuse a cluster without workers, or with a worker that has another version of atmosbox."""

    def version() -> str:  # a nested function is sent as code, so it also runs on a worker without atmosbox
        try:
            from atmosbox.version import __version__
        except ImportError:
            return "no atmosbox"
        return f"atmosbox {__version__}"

    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        fix = f"start some with dask worker {address} --nworkers auto --nthreads 1"
        raise SettingError("scheduler", address, "has no workers", fix) from None
    for worker, found in sorted(client.run(version, on_error="return").items()):
        if found != f"atmosbox {__version__}":
            problem = f"has the worker {worker} with {found}, and this is atmosbox {__version__}"
            fix = f"type pip install atmosbox=={__version__} there, or take the worker away"
            raise SettingError("scheduler", address, problem, fix)

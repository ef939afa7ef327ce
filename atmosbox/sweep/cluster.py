"""The runs of a sweep on a cluster, by dask.distributed."""

from __future__ import annotations

import time
import uuid
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import CancelledError
from typing import TYPE_CHECKING, Any

from atmosbox.errors import EngineError, SettingError
from atmosbox.sweep import member
from atmosbox.sweep.member import Record
from atmosbox.sweep.plan import Task
from atmosbox.version import __version__

if TYPE_CHECKING:
    from distributed import Client

__all__ = ["PATIENCE", "remote"]

PATIENCE = 10.0
"""Longest time to wait for an answer of the scheduler, and then for a first worker [s]."""

_BREATH = 0.5
"""Time between two reports of progress [s]."""

Watch = Callable[[float, str], None]


def remote(tasks: Sequence[Task], address: str, watch: Watch) -> Generator[Record]:
    """Run the members on the workers of a Dask cluster, and yield the record of each as soon as it is complete.

    If a worker dies, its current run and its results that were not yet fetched are lost; Dask gives these runs to
    another worker.

    Parameters
    ----------
    tasks
        The runs.
    address
        Address of the scheduler: ``tcp://host:8786``.
    watch
        Called from time to time with the work under way, in units of one run, and a short text on the present step.

    Yields
    ------
    dict
        The record of each run, in the order in which they end.

    Raises
    ------
    SettingError
        If dask.distributed is missing, the scheduler does not answer, there are no workers, or a worker has another
        version of atmosbox.
    EngineError
        If the scheduler is lost during the sweep, or the cluster cannot run a member.
    """
    client = _connected(address)
    try:
        _check_workers(client, address)
        yield from _collected(client, tasks, address, watch)
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
        fix = "start one with dask scheduler, and give --scheduler with the address that it names"
        raise SettingError("scheduler", address, f"does not answer ({why})", fix) from error


def _check_workers(client: Client, address: str) -> None:
    """Refuse a cluster without workers, or with a worker that has another version of atmosbox."""

    def version() -> str:  # a nested function is sent as code, so it also runs on a worker without atmosbox
        try:
            from atmosbox.sweep.member import run as needed  # noqa: F401
            from atmosbox.version import __version__
        except ImportError:
            return ""
        return __version__

    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        fix = f"start some with dask worker {address} --nworkers auto --nthreads 1"
        raise SettingError("scheduler", address, "has no workers", fix) from None
    for worker, found in sorted(client.run(version, on_error="return").items()):
        if found != __version__:
            raise _other(address, worker, found if isinstance(found, str) else "")


def _other(address: str, worker: str, version: str) -> SettingError:
    """Return the error for a worker that does not have this version of atmosbox."""
    has = f"atmosbox {version}" if version else "no atmosbox of this kind"
    fix = f"type pip install atmosbox=={__version__} there, or take the worker away"
    return SettingError("scheduler", address, f"has the worker {worker} with {has}, and this is {__version__}", fix)


def _lost(address: str) -> EngineError:
    """Return the error for a lost scheduler; records that were fetched from it are saved."""
    return EngineError(f"The scheduler {address} was lost: type the same again to go on where it stopped.")


def _run(task: Task, version: str) -> tuple[str, Record | None]:
    """Run a member on a worker; return the worker's version, and no record if that is another version of atmosbox."""
    return (__version__, member.run(task)) if version == __version__ else (__version__, None)


def _collected(client: Client, tasks: Sequence[Task], address: str, watch: Watch) -> Generator[Record]:
    """Submit all runs and fetch each record when its run ends; it is then released, so that no run is repeated."""
    from distributed import KilledWorker, wait

    own = uuid.uuid4().hex
    under_way: dict[Any, Task] = {
        client.submit(_run, task, __version__, key=f"atmosbox-{own}-{task.point}-{task.member}"): task for task in tasks
    }
    done = 0
    began = last = time.monotonic()
    try:
        while under_way:
            try:
                with client.as_current():
                    wait(list(under_way), timeout=_BREATH, return_when="FIRST_COMPLETED")
            except TimeoutError:
                # Workers report nothing before the end of a run: the share is estimated from the pace so far.
                now = time.monotonic()
                watch(min(done / (now - began) * (now - last), 0.9), "running")
            except CancelledError:
                raise _lost(address) from None
            if client.status not in ("running", "connecting"):
                raise _lost(address)
            for future in [each for each in under_way if each.done()]:
                task = under_way.pop(future)
                try:
                    version, record = future.result()
                except KilledWorker as error:
                    version, record = __version__, member.failure(task, f"Its workers died one after another: {error}")
                except CancelledError:
                    raise _lost(address) from None
                except Exception as error:
                    why = " ".join(str(error).split()) or type(error).__name__
                    raise EngineError(f"The cluster {address} cannot run it ({why}): look at its log.") from error
                future.release()
                if record is None:
                    raise _other(address, "that joined later", version)
                done, last = done + 1, time.monotonic()
                yield record
    finally:
        client.cancel(list(under_way))

"""The runs of a sweep on the cores of this machine; each worker is a process of its own.

Every worker has its own pipe to this process. So it is known which run a worker was computing when it died, and only
that run is tried again; a process pool of the standard library would give up all runs.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections import deque
from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from multiprocessing import connection, get_context, parent_process
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess

from atmosbox.errors import EngineError
from atmosbox.sweep import member
from atmosbox.sweep.member import Record
from atmosbox.sweep.plan import Task

__all__ = ["ATTEMPTS", "cores", "here", "processes"]

ATTEMPTS = 2
"""Number of attempts of a run whose worker dies, before the run counts as failed."""

Watch = Callable[[float, str], None]
"""Called with the work under way, in units of one run, and a short text on the present step."""


def cores() -> int:
    """Return the number of cores that this process may use.

    Examples
    --------
    >>> cores() >= 1
    True
    """
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def here(tasks: Sequence[Task], watch: Watch) -> Generator[Record]:
    """Run the members one after another in this process.

    Examples
    --------
    >>> task = Task(1, 1, "elastic-collisions", {"duration": 5.0, "seed": 3}, "exact", None)
    >>> [record["status"] for record in here([task], lambda share, word: None)]
    ['complete']
    """
    for task in tasks:
        yield member.run(task, watch)


@dataclass
class _Worker:
    """A process, the pipe to it, its present run, and the share of that run that is done."""

    process: BaseProcess
    pipe: Connection
    task: Task | None = None
    share: float = 0.0
    ready: bool = False


def processes(tasks: Sequence[Task], jobs: int, watch: Watch) -> Generator[Record]:
    """Run the members in processes of their own, and yield the record of each as soon as it is complete.

    One worker begins alone. The others follow when it has compiled the engine, and load the machine code from the disk.

    Parameters
    ----------
    tasks
        The runs.
    jobs
        Number of processes.
    watch
        Called during the runs with the work under way and a short text, see `Watch`.

    Yields
    ------
    dict
        The record of each run, in the order in which they end.

    Raises
    ------
    EngineError
        If the workers cannot begin.
    """
    waiting = deque(tasks)
    attempts: dict[tuple[int, int], int] = {}
    workers: list[_Worker] = []
    compiled = False
    try:
        while waiting or any(worker.task for worker in workers):
            wanted = min(jobs if compiled else 1, len(waiting) + sum(worker.task is not None for worker in workers))
            while len(workers) < wanted:
                workers.append(_begin())
            for worker in workers:
                if worker.task is None and waiting:
                    _send(worker, waiting.popleft())
            heard = connection.wait([worker.pipe for worker in workers], timeout=1.0)
            for worker in [each for each in workers if each.pipe in heard]:
                try:
                    kind, content = worker.pipe.recv()
                except (EOFError, OSError):
                    workers.remove(worker)
                    yield from _mourn(worker, waiting, attempts)
                    continue
                worker.ready = True
                if kind == "progress":
                    worker.share, word = content
                    compiled = compiled or word == "running"
                    watch(sum(each.share for each in workers), word)
                elif kind == "record":
                    compiled, worker.task, worker.share = True, None, 0.0
                    yield content
    finally:
        for worker in workers:
            worker.process.kill()
        for worker in workers:
            worker.process.join()
            worker.pipe.close()


def _begin() -> _Worker:
    """Start a worker."""
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs,), daemon=True, name="atmosbox sweep")
    process.start()
    theirs.close()
    return _Worker(process, ours)


def _send(worker: _Worker, task: Task) -> None:
    worker.task = task
    with contextlib.suppress(OSError):  # if the worker has died, reading from its pipe will tell
        worker.pipe.send(task)


def _mourn(worker: _Worker, waiting: deque[Task], attempts: dict[tuple[int, int], int]) -> Generator[Record]:
    """Put the run of a worker that died back to the front of the queue, or record it as failed after two attempts."""
    worker.process.join()
    worker.pipe.close()
    if not worker.ready:
        raise EngineError(
            f"The processes of the sweep cannot begin (status {worker.process.exitcode}): in a script of your own, put "
            'the call below if __name__ == "__main__", or give --jobs 1.'
        )
    task = worker.task
    if task is None:
        return
    key = task.point, task.member
    attempts[key] = attempts.get(key, 0) + 1
    if attempts[key] < ATTEMPTS:
        waiting.appendleft(task)
    else:
        code = worker.process.exitcode
        how = f"signal {-code}" if code is not None and code < 0 else f"status {code}"
        yield member.failure(
            task, f"Its process died {ATTEMPTS} times ({how}): memory may be short, give fewer --jobs."
        )


def _serve(pipe: Connection) -> None:
    """Run each task that comes through the pipe, until the sender has closed the pipe."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C goes to all processes; the first process handles it
    sys.stdout = sys.stderr  # output of a user's scene must not mix with results
    threading.Thread(target=_end_with_parent, daemon=True).start()
    pipe.send(("ready", None))

    def tell(share: float, word: str) -> None:
        pipe.send(("progress", (share, word)))

    with contextlib.suppress(EOFError, OSError):
        while True:
            pipe.send(("record", member.run(pipe.recv(), tell)))


def _end_with_parent() -> None:
    """End this process when its parent process has ended, for whatever reason."""
    parent = parent_process()
    if parent is not None:
        connection.wait([parent.sentinel])
        os._exit(1)

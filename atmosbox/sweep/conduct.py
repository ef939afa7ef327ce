"""A sweep from its first run to its file: each run has a file of its own, and runs that have one are not repeated."""

from __future__ import annotations

import json
import os
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr

from atmosbox.errors import FileError, Option, SettingError, shown
from atmosbox.file.checkpoint import Checkpoint
from atmosbox.file.netcdf import read
from atmosbox.file.output_lock import ANOTHER_NAME
from atmosbox.file.output_path import part_path, write_failure, write_whole
from atmosbox.file.provenance import history_line
from atmosbox.scene.settings import Parameter
from atmosbox.simulation.recording import uninterrupted
from atmosbox.sweep import workers
from atmosbox.sweep.plan import Plan
from atmosbox.sweep.result import join, row

__all__ = ["SweepInterrupted", "Swept", "folder_of", "is_taken", "sweep"]

REQUEST = "sweep.json"
"""The file in the folder of a sweep that tells which sweep it is."""
_JOBS = Parameter("jobs", "1", workers.cores(), 1, 4096, kind="int", given_as=Option)

Progress = Callable[[float, str], None]


class Swept(NamedTuple):
    """The result of a sweep."""

    dataset: xr.Dataset
    failures: tuple[tuple[int, int, str], ...]
    """Point, member and reason of every run that failed."""
    ledger: float
    """The largest residual of the energy budget of any run."""
    computed: int
    """Number of runs that this call has computed."""
    recalled: int
    """Number of runs that an earlier call had saved."""


class SweepInterrupted(KeyboardInterrupt):
    """A sweep was stopped by Ctrl-C; ``saved`` is the number of runs that are complete."""

    def __init__(self, saved: int, exit_code: int = 130) -> None:
        super().__init__("the sweep was interrupted")
        self.saved = saved
        self.exit_code = exit_code


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
    progress: Progress | None = None,
    note: Callable[[str], None] | None = None,
    command: str = "",
) -> Swept:
    """Run all members of a sweep, on the cores of this machine or on a cluster, and join them.

    Every run writes its own netCDF file, ``NAME/POINT-MEMBER.nc`` beside NAME.nc, and saves its state on the way. The
    same call goes on where an earlier one stopped, for whatever reason, and the results are the same, bit for bit. With
    more members, the runs that are there are used.

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
        Called with the share that is done and a short text on the present step.
    note
        Called with remarks: how many runs are taken from an earlier call, and the warnings of runs.
    command
        The command that the user typed, for the history in the file.

    Returns
    -------
    Swept
        The dataset, and the runs that failed.

    Raises
    ------
    SweepInterrupted
        After Ctrl-C.
    AtmosboxError
        If a file cannot be written, the folder holds another sweep, or the workers cannot be reached.

    Examples
    --------
    >>> from atmosbox.simulation.runner import LEDGER_LIMIT
    >>> from atmosbox.sweep.plan import plan
    >>> discs = plan("elastic-collisions", ["molecules=20,40"], settings={"duration": 5.0})
    >>> swept = sweep(discs, jobs=1)
    >>> dict(swept.dataset.sizes), swept.failures, swept.ledger < LEDGER_LIMIT
    ({'molecules': 2, 'member': 1}, (), True)
    """
    processes = workers.cores() if jobs is None else int(_JOBS.parse(jobs))
    if jobs is not None and scheduler is not None:
        raise SettingError("jobs", jobs, "is for this machine, and a scheduler for another", "leave one of them out")
    tell, say = progress or (lambda share, word: None), note or (lambda text: None)
    with _folder(plan, out, force) as (folder, checkpoint):
        tasks = plan.tasks(folder)
        waiting = [task for task in tasks if not os.path.exists(task.path)]
        recalled = len(tasks) - len(waiting)
        begun = sum(part_path(task.path).exists() for task in waiting)
        if recalled or begun:
            also = f" and {begun} begun" if begun else ""
            say(f"{recalled} of {plan.runs} runs are saved in {folder}{also}: going on with the rest")
        failed: dict[tuple[int, int], str] = {}
        warned: set[str] = set()
        ended = recalled

        def watch(share: float, word: str) -> None:
            tell(min((ended + share) / plan.runs, 1.0), word)

        number = min(processes, len(waiting))
        runs = (
            workers.on_cluster(waiting, scheduler, watch)
            if scheduler is not None
            else workers.processes(waiting, number, watch)
            if number > 1
            else workers.here(waiting, watch)
        )
        try:
            with closing(runs):
                for done in runs:
                    ended += 1
                    if done.reason:
                        failed[done.task.point, done.task.member] = done.reason
                    for text in set(done.warnings) - warned:
                        warned.add(text)
                        say(f"warning: {text}")
                    watch(0.0, "running")
        except KeyboardInterrupt as stop:
            saved = sum(os.path.exists(task.path) for task in tasks)
            raise SweepInterrupted(saved, getattr(stop, "exit_code", 130)) from None
        line = history_line(command or f"atmosbox.sweep.sweep({plan.scene!r}, ...)")
        with uninterrupted():
            rows = {(task.point, task.member): row(read(task.path)) for task in tasks if os.path.exists(task.path)}
            empty = "The run was too short for any of its headlines to be measured."
            failed |= {key: empty for key, found in rows.items() if not found.attrs["names"]}
            if out is not None and os.path.exists(out):
                line = f"{read(out).attrs['history']}\n{line}"
            dataset = join(plan, rows, failed, line)
            if checkpoint is not None:
                checkpoint.finish(dataset)
    tell(1.0, "done")
    ledger = float(dataset["member_ledger"].max(skipna=True).fillna(0.0))
    failures = tuple((*key, why) for key, why in sorted(failed.items()))
    return Swept(dataset, failures, ledger, len(waiting), recalled)


@contextmanager
def _folder(plan: Plan, out: str | os.PathLike[str] | None, force: bool) -> Iterator[tuple[Path, Checkpoint | None]]:
    """Yield the folder for the runs, and the file to write; without a file, a folder that is removed at the end."""
    if out is None:
        with tempfile.TemporaryDirectory(prefix="atmosbox-sweep-") as temporary:
            yield Path(temporary), None
        return
    path = Path(out)
    folder = folder_of(path)
    checkpoint = Checkpoint(path, force=force or (folder / REQUEST).exists())
    with uninterrupted():
        checkpoint.load_libraries()
    checkpoint.begin()
    try:
        _take(folder, plan.request(), force)
        yield folder, checkpoint
    finally:
        checkpoint.release()


def is_taken(path: Path, plan: Plan) -> bool:
    """Return whether a file, or the folder of its runs, holds anything else than this sweep."""
    folder = folder_of(path)
    return (path.exists() or folder.exists()) and _request_in(folder) != _plain(plan.request())


def _plain(request: Mapping[str, Any]) -> dict[str, Any]:
    """Return a request as it comes out of a file."""
    made: dict[str, Any] = json.loads(json.dumps(dict(request)))
    return made


def _request_in(folder: Path) -> dict[str, Any] | None:
    """Return what determines the runs in a folder; None if it is not the folder of a sweep."""
    try:
        made: dict[str, Any] = json.loads((folder / REQUEST).read_bytes())
    except (OSError, ValueError):
        return None
    return made


def _take(folder: Path, request: Mapping[str, Any], force: bool) -> None:
    """Make the folder of a sweep, or go on with it if it is of the same sweep.

    Raises
    ------
    FileError
        If it holds anything else; with `force`, the runs of another sweep are removed.
    """
    wanted, known = _plain(request), _request_in(folder)
    if known == wanted:
        return
    if known is None and (os.path.lexists(folder) and not (folder.is_dir() and not any(folder.iterdir()))):
        raise FileError(f"{folder} holds other things than a sweep", "move it, or ", *ANOTHER_NAME)
    if known is not None and not force:
        raise FileError(
            f"{folder} has the runs of another sweep, {_difference(known, wanted)}",
            *ANOTHER_NAME,
            ", or add ",
            Option("force", True),
            " to replace them",
        )
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise write_failure(error, folder) from error
    for old in folder.glob("*.nc"):
        old.unlink()
    write_whole(folder / REQUEST, json.dumps(wanted, indent=1).encode())


def _difference(saved: Mapping[str, Any], asked: Mapping[str, Any]) -> str:
    """Return in words the first part in which two sweeps differ."""
    name = next(name for name in [*saved, *asked] if saved.get(name) != asked.get(name))
    before, now = ("not given" if each.get(name) is None else shown(each[name]) for each in (saved, asked))
    return f"with {name} {before} and not {now}"

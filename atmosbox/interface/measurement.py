"""Run a scene or a grid of settings, resume a run, open a saved run; and the list of scenes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from atmosbox.interface.run_dataset import Show, preformatted, progress_bar

if TYPE_CHECKING:
    import xarray as xr

    from atmosbox.interface.run_dataset import RunDataset


def run(
    scene: str | os.PathLike[str] | None = None,
    *,
    replay: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool | None = None,
    **settings: Any,
) -> RunDataset:
    """Run a scene and return the measurements, with the predictions of theory beside them.

    The molecules of the scene's box fly and collide for the scene's time. Temperature and pressure are measured
    meanwhile, with error bars, and the energy ledger is checked. The returned dataset prints the headline table of the
    run first.

    Parameters
    ----------
    scene
        Name of a scene, such as ``"lifting-dry"`` (`atmosbox.scenes` lists them), or the path of your own.
    replay
        Link of a run in the lab page, as a whole or from ``#`` on, in place of scene and settings: the same run, with
        every turn of its knobs.
    out
        File to write the dataset to, as CF netCDF; by default none is written.
    force
        Whether a file of that name may be replaced.
    progress
        By default a bar is shown in a notebook and on a terminal; False shows none. A function given here is called
        instead, with the share of the run that is done and the name of the present step.
    engine
        The engine, which moves the molecules, with its options, such as ``"stepped:delta=0.02"``; by default
        the scene's own, mostly ``"exact"``.
    accuracy
        The accuracy of the run: ``"sketch"``, ``"lecture"``, ``"reference"``, or the largest error, such as ``"0.5K"``
        or ``"2%"``. It picks the engine, and the settings that are not given.
    save_molecules
        Whether to keep the position and velocity of every molecule in every frame, as `atmosbox.show` needs them; by
        default if they take less than 10 MB.
    **settings
        The scene's settings, by name, as numbers in their documented units or as text with a unit:
        ``molecules=4000, temperature="25degC"``.

    Returns
    -------
    xarray.Dataset
        The measurements in SI units, on ``elapsed_time`` (in s, ns or ps, as the scene says) and, where a
        scene has them, ``height`` [m] and ``speed`` [m s-1].

    Raises
    ------
    UnknownSceneError
        If there is no scene of this name.
    SettingError
        If a setting is unknown, has the wrong dimension or is out of its range.
    FileError
        If your own scene cannot be read, or ``out`` cannot be written.
    EngineError
        If the engine cannot go on.

    Examples
    --------
    Lifted air cools, though no heat leaves it:

    >>> import atmosbox as ab
    >>> dataset = ab.run("lifting-dry", molecules=200, seed=1)
    >>> bool(dataset.air_temperature[-1] < dataset.air_temperature[0])
    True
    """
    from atmosbox.errors import Command, UnknownSceneError
    from atmosbox.file.checkpoint import Checkpoint
    from atmosbox.interface.run_dataset import as_run
    from atmosbox.simulation import runner

    given = {name: text for name, text in (("engine", engine), ("accuracy", accuracy)) if text is not None} | settings
    if replay is not None:
        runner.check_nothing_changes("a run that is replayed", given)
        prepared = runner.replayed(replay, scene, save_molecules=save_molecules)
        given = {"replay": replay}
    elif scene is None:
        raise UnknownSceneError("No scene is given", Command("list"), " to see all")
    else:
        prepared = runner.prepare(scene, settings, engine=engine, accuracy=accuracy, save_molecules=save_molecules)
    checkpoint = None if out is None else Checkpoint(out, force=force)
    words = [] if scene is None else [repr(str(scene))]
    command = f"atmosbox.run({', '.join([*words, *(f'{name}={value!r}' for name, value in given.items())])})"
    with progress_bar("replay" if scene is None else os.fspath(scene), progress) as show:
        return as_run(runner.execute(prepared, checkpoint=checkpoint, progress=show, command=command).dataset)


def resume(
    path: str | os.PathLike[str],
    *,
    scene: str | os.PathLike[str] | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    progress: Show | bool | None = None,
) -> RunDataset:
    """Continue a run that was stopped or killed; the result is bit for bit the same as without the stop.

    Parameters
    ----------
    path
        The file that the run has left, ``NAME.part.nc``.
    scene
        The path of the scene, if it is one of your own: atmosbox never runs code that only a data file names.
    out
        File of the finished run; by default the one that the run would have had.
    force
        Whether a file of that name may be replaced.
    progress
        As in `run`.

    Raises
    ------
    FileError
        If the file holds no state, or if the version, the sources of the engine, the scene or the processor are not
        the same as when the state was saved.

    Examples
    --------
    >>> import atmosbox as ab
    >>> ab.resume("no such file.part.nc")
    Traceback (most recent call last):
    atmosbox.errors.FileError: no such file.part.nc does not exist: check the name and the folder.
    """
    from atmosbox.file.checkpoint import Checkpoint
    from atmosbox.file.output_path import whole_path
    from atmosbox.interface.run_dataset import as_run
    from atmosbox.simulation import runner
    from atmosbox.simulation.restart import read_state

    restart = read_state(os.fspath(path))
    prepared = runner.prepared_again(restart, scene)
    checkpoint = Checkpoint(whole_path(path) if out is None else out, force=force)
    command = f"atmosbox.resume({os.fspath(path)!r})"
    with progress_bar(os.fspath(path), progress) as show:
        done = runner.execute(prepared, checkpoint=checkpoint, progress=show, command=command, restart=restart)
        return as_run(done.dataset)


def open(path: str | os.PathLike[str]) -> RunDataset:
    """Return a run that was saved, as a dataset in memory; the file is closed again.

    Parameters
    ----------
    path
        A file that `atmosbox.run` or ``atmosbox run`` has written.

    Raises
    ------
    FileError
        If the file is missing, damaged, of another program or of another file format than this atmosbox reads.

    Examples
    --------
    >>> import atmosbox as ab
    >>> ab.open("no such file.nc")
    Traceback (most recent call last):
    atmosbox.errors.FileError: no such file.nc does not exist: check the name and the folder.
    """
    from atmosbox.file.netcdf import read
    from atmosbox.interface.run_dataset import as_run

    return as_run(read(path))


def sweep(
    scene: str | os.PathLike[str],
    vary: Mapping[str, str | Iterable[Any]],
    *,
    members: int = 1,
    seed: int | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    out: str | os.PathLike[str] | None = None,
    force: bool = False,
    jobs: int | None = None,
    scheduler: str | None = None,
    progress: Show | bool | None = None,
    **settings: Any,
) -> xr.Dataset:
    """Run a scene with many settings, and return how its results depend on them.

    Parameters
    ----------
    scene
        Name of a scene, or the path of your own.
    vary
        The values of each setting that varies: a list, or a text such as ``"0degC:40degC:5"`` for five evenly spaced
        values, or ``"50:5000:5log"`` for values in equal ratios.
    members
        Number of runs at each point, each with a seed of its own.
    seed
        The seed from which the seeds of all runs are made.
    engine, accuracy
        As for `atmosbox.run`.
    out
        File to write, as CF netCDF. With it, each run is saved as it ends, and the same call continues a sweep that
        was stopped.
    force
        Whether a file of that name may be replaced.
    jobs
        Number of processes; one for each core by default. With 1 the runs are made in this process. A script that
        uses more must call `sweep` below ``if __name__ == "__main__":``.
    scheduler
        The address of a Dask scheduler whose workers make the runs instead.
    progress
        As for `atmosbox.run`.
    **settings
        Settings for all runs.

    Returns
    -------
    xarray.Dataset
        Mean, standard error and theory of each headline as functions of the settings that vary, in SI units.

    Raises
    ------
    SettingError
        If a setting is unknown or a value is not allowed, or if no point can run.
    FileError
        If the file cannot be written.

    Examples
    --------
    >>> import atmosbox as ab
    >>> swept = ab.sweep("elastic-collisions", {"molecules": [20, 40]}, duration="2 s", jobs=1)
    >>> dict(swept.sizes)
    {'molecules': 2, 'member': 1}
    """
    from atmosbox.sweep.conduct import sweep as conduct
    from atmosbox.sweep.plan import plan

    with progress_bar(os.fspath(scene), progress) as show:
        varied = [f"{name}={_typed(values)}" for name, values in vary.items()]
        how: dict[str, Any] = {"members": members, "seed": seed, "engine": engine, "accuracy": accuracy}
        grid = plan(scene, varied, settings=settings, **how)
        path = None if out is None else os.fspath(out)
        command = f"atmosbox.sweep({grid.scene!r}, {dict(vary)!r}, members={members})"
        return conduct(grid, path, jobs=jobs, scheduler=scheduler, force=force, progress=show, command=command)


def _typed(values: str | Iterable[Any]) -> str:
    """Return values as text, as typed after ``--vary name=``."""
    if isinstance(values, str):
        return values
    return ",".join(("off", "on")[value] if isinstance(value, bool) else str(value) for value in values)


_WIDTH = 100


class Printed(tuple[str, ...]):
    """Names that print as a table, in a terminal and in a notebook.

    Examples
    --------
    >>> Printed(["one", "two"], ["one  first", "two  second"])
    one  first
    two  second
    """

    lines: Sequence[str]

    def __new__(cls, names: Sequence[str], lines: Sequence[str]) -> Printed:
        """Make the tuple of names, with the lines that print them."""
        made = super().__new__(cls, names)
        made.lines = lines
        return made

    def __repr__(self) -> str:
        """Return the table."""
        return "\n".join(self.lines)

    def _repr_html_(self) -> str:
        """Return the table for a notebook."""
        return preformatted(repr(self))


def scenes(scene: str | os.PathLike[str] | None = None) -> Printed:
    """Return the names of all scenes, or of the settings of one scene; printed, each has a line that explains it.

    Parameters
    ----------
    scene
        Name of the scene whose settings to return, or the path of your own; by default the scenes are returned.

    Raises
    ------
    UnknownSceneError
        If there is no scene of this name.

    Examples
    --------
    >>> import atmosbox as ab
    >>> "lifting-dry" in ab.scenes(), "temperature" in ab.scenes("lifting-dry")
    (True, True)
    """
    from atmosbox import scenarios
    from atmosbox.text.report import parameter_lines, scene_lines

    if scene is None:
        found = scenarios.summaries()
        return Printed(list(found), scene_lines(found, _WIDTH))
    module = scenarios.load(scene)
    declared = module.Settings.describe()
    story = (module.__doc__ or "").strip().partition("\n\n")[0].replace("\n", " ")
    lines = [f"{os.fspath(scene)}: {story}", "", *parameter_lines(declared, _WIDTH)]
    return Printed([parameter.name for parameter in declared], lines)

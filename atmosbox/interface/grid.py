"""Run a scene over a grid of settings."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from atmosbox.interface.notebook import Show, progress_bar

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["sweep"]


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
        grid = plan(
            scene,
            [f"{name}={_typed(values)}" for name, values in vary.items()],
            settings=settings,
            members=members,
            seed=seed,
            engine=engine,
            accuracy=accuracy,
        )
        path = None if out is None else os.fspath(out)
        command = f"atmosbox.sweep({grid.scene!r}, {dict(vary)!r}, members={members})"
        return conduct(grid, path, jobs=jobs, scheduler=scheduler, force=force, progress=show, command=command)


def _typed(values: str | Iterable[Any]) -> str:
    """Return values as text, as typed after ``--vary name=``."""
    if isinstance(values, str):
        return values
    return ",".join(("off", "on")[value] if isinstance(value, bool) else str(value) for value in values)

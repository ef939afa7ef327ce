"""An atmosphere in a box: textbook meteorology that emerges from colliding molecules.

A scenario configures one shared engine of colliding molecules, a run measures what they do with error bars,
and the answer of theory is laid beside it. Importing `atmosbox` is quick: the engine and the libraries of
the data are imported when a run asks for them.

Where things are: `atmosbox.run` runs a scenario; `atmosbox.scenarios` says which there are;
`atmosbox.engine` is the physics, to be read in the order its own docstring gives; `atmosbox.theory` holds
the closed-form answers.
"""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from atmosbox.version import __version__

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray

__all__ = ["__version__", "run"]


def run(
    scene: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    progress: Callable[..., None] | None = None,
    engine: str | None = None,
    accuracy: str | None = None,
    save_molecules: bool = False,
    **settings: Any,
) -> xarray.Dataset:
    """Run a scenario and return what was measured, with the answer of theory beside it.

    The molecules of the scenario's box fly and collide for the scenario's time; temperature and pressure are
    measured on the way, with error bars, and the energy ledger is closed.

    Parameters
    ----------
    scene
        Name of a scenario, such as ``"lifting-dry"``, or path of your own.
    out
        File to write the dataset to, as CF netCDF; by default none is written.
    progress
        Called again and again while the molecules move, to show how far the run is.
    engine
        What lets time pass, with its options: ``"stepped:delta=0.02"``; ``"exact"`` if nothing is said.
    accuracy
        How accurate the run shall be: ``"sketch"``, ``"lecture"``, ``"reference"``, or the largest error, as ``"0.5K"``
        or ``"2%"``. Picks the engine, and the settings that are not given.
    save_molecules
        Whether to keep the position and speed of every molecule in every frame.
    **settings
        The scenario's settings, by name, as numbers in their documented units or as text with a unit:
        ``molecules=4000, temperature="25degC"``.

    Returns
    -------
    xarray.Dataset
        The measurements in SI units, on ``elapsed_time`` (in s, ns or ps, as the scenario says) and, where a
        scenario has them, ``height`` [m] and ``speed`` [m s-1].

    Raises
    ------
    UnknownSceneError
        If there is no scenario of this name.
    SettingError
        If a setting is unknown, of a wrong dimension or out of its range.
    FileError
        If your own scenario cannot be read, or ``out`` cannot be written.
    PhysicsError
        If a conservation law does not hold in the run.

    Examples
    --------
    Lifted air cools, though no heat leaves it:

    >>> import atmosbox
    >>> dataset = atmosbox.run("lifting-dry", molecules=200, seed=1)
    >>> bool(dataset.air_temperature[-1] < dataset.air_temperature[0])
    True
    """
    from atmosbox.simulation.runner import run as start

    return start(
        scene,
        out=out,
        progress=progress,
        engine=engine,
        accuracy=accuracy,
        save_molecules=save_molecules,
        **settings,
    )

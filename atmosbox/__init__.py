"""An atmosphere in a box: textbook meteorology that emerges from colliding molecules.

A scene configures an engine of colliding molecules, which all scenes share. A run measures temperature, pressure and
other quantities with error bars, and compares them with theory::

    import atmosbox as ab

    ab.scenes()                                     # the scenes; ab.scenes("lifting-dry"): the settings of one
    run = ab.run("lifting-dry", molecules=2000)     # an xarray.Dataset that prints its main results first
    ab.plot(run)                                    # its figure
    ab.show(ab.run("temperature"))                  # its molecules, in a notebook or in the browser
    ab.compare(run, ab.run("lifting-dry", temperature=30))   # two runs side by side
    ab.sweep("condensation", {"temperature": [0, 10, 20]})   # how the results depend on a setting
    ab.open("run.nc")                               # a saved run
    ab.resume("run.part.nc")                        # continue a run that was stopped or killed

Importing `atmosbox` is quick: the engine and the data libraries are imported when a call needs them.

Where things are: `atmosbox.interface` holds these functions; `atmosbox.scenarios` the scenes;
`atmosbox.engine` is the physics, to be read in the order that its docstring gives; `atmosbox.theory` holds
closed forms and solved equations.
"""

from __future__ import annotations

from typing import Any

from atmosbox.callable_room import CallableRoom
from atmosbox.version import __version__

__all__ = ["__version__", "compare", "open", "plot", "resume", "run", "scenes", "show", "sweep"]


def __getattr__(name: str) -> Any:
    """Return a public function; it is imported when it is first used."""
    if name == "plot":  # a room that can be called
        import atmosbox.plot as plot

        return plot
    if name == "sweep":
        import atmosbox.sweep as sweep

        return sweep
    if name in __all__:
        return _function(name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def _function(name: str) -> Any:
    """Return a public function."""
    from atmosbox import interface

    return getattr(interface, name)


CallableRoom.function_of = _function


def __dir__() -> list[str]:
    """Return the public names, for an editor that completes names."""
    return sorted({*globals(), *__all__})

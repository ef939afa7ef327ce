"""The parts from which a scene is written.

A scene of your own needs little more than the names below, ``from atmosbox.scene import Setup, Panel, ...``; each is
imported when it is first used.

`settings`     what a user may set; `conversion` reads numbers with units, `spelling` names
`setup`        what a scene hands to the run: its box, its instruments, its times
`units`        the scale of a scene: engine units to SI
`engines`      the engines a scene may use, and their options
`instruments`  what is measured, one class each
`statistics`   means with their standard errors
`target`       how accurate a run is to be, as a user says it
`headline`     the main results of a run, compared with theory
`panels`       the graphs of its figure, declared
`knob`         what may be changed while the box runs
`moisture`     water for a scene
`piston`       a parcel under a piston
`ascent`       the common parts of the scenes of lifted air
`exchange`     the common parts of the scenes of vapour over liquid
`sounding`     measured profiles of the atmosphere, read and checked
"""

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from atmosbox.scene.engines import EngineChoice
    from atmosbox.scene.headline import Headline
    from atmosbox.scene.instruments import *
    from atmosbox.scene.panels import Line, Panel
    from atmosbox.scene.settings import SceneSettings, setting
    from atmosbox.scene.setup import Series, Setup
    from atmosbox.scene.statistics import block_average
    from atmosbox.scene.units import Scale

_HOMES = {
    "EngineChoice": "engines", "Headline": "headline", "Line": "panels", "Panel": "panels", "Scale": "units",
    "SceneSettings": "settings", "Series": "setup", "Setup": "setup", "block_average": "statistics",
    "setting": "settings",
}  # fmt: skip
"""The files of the names that are not instruments."""

__all__ = [
    "LAWS", "Air", "Clusters", "Discs", "DropSizes", "EngineChoice", "Environment", "Flow", "Headline", "Instrument",
    "Layers", "Leaving", "Lift", "Line", "Mixing", "MoistLift", "Molecules", "Nuclei", "Panel", "Readings", "Scale",
    "SceneSettings", "Series", "Setup", "Slab", "Speeds", "Water", "block_average", "setting", "wall_laws",
]  # fmt: skip


def __getattr__(name: str) -> Any:
    """Import a public name from the file that defines it."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    home = _HOMES.get(name, "instruments")
    value = getattr(importlib.import_module(f"{__name__}.{home}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})

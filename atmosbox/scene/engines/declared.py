"""The declaration of every engine: its name, its options, and the class of its boxes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING

from atmosbox.errors import Option, SettingError
from atmosbox.scene.settings import Parameter, Value

if TYPE_CHECKING:
    from atmosbox.engine import Liquid, Parcel

__all__ = ["ENGINES", "Engine"]


@dataclass(frozen=True)
class Engine:
    """The declaration of an engine.

    Parameters
    ----------
    name
        Its name.
    summary
        What it does, in one line.
    parcel
        Function that returns the class of its parcels; nothing of the engine is imported before it is called.
    parameters
        Its options.
    ideal
        Whether the pressure is n kT, without Z: its molecules have no excluded volume.
    reference
        Publication of its method.
    moist
        Function that returns the class of its parcels with a liquid in them, if there is one.
    attracting
        Function that returns the class of its parcels of molecules that attract each other, if there is one.
    presets
        Names that stand for several options at once.
    """

    name: str
    summary: str
    parcel: Callable[[], type[Parcel]]
    parameters: tuple[Parameter, ...] = ()
    ideal: bool = False
    reference: str = ""
    moist: Callable[[Liquid], type[Parcel]] | None = None
    attracting: Callable[[], type[Parcel]] | None = None
    presets: Mapping[str, Mapping[str, Value]] = field(default_factory=dict)


def _exact() -> type[Parcel]:
    from atmosbox.engine import ParcelSet

    return ParcelSet


def _attracting_exact() -> type[Parcel]:
    from atmosbox.engine import AttractingParcelSet

    return AttractingParcelSet


def _moist_exact(liquid: Liquid) -> type[Parcel]:
    from atmosbox.engine import Drops
    from atmosbox.engine.liquid.drop_parcelset import DropParcelSet
    from atmosbox.engine.liquid.moist_parcelset import MoistParcelSet

    return DropParcelSet if isinstance(liquid, Drops) else MoistParcelSet


def _stepped() -> type[Parcel]:
    from atmosbox.engine.stepped.stepped_parcel import SteppedParcel

    return SteppedParcel


def _dsmc() -> type[Parcel]:
    from atmosbox.engine.dsmc.dsmc_parcel import DsmcParcel

    return DsmcParcel


def _moist_dsmc(liquid: Liquid) -> type[Parcel]:
    from atmosbox.engine import Drops
    from atmosbox.engine.dsmc.moist_dsmc_parcel import MoistDsmcParcel

    if isinstance(liquid, Drops):
        problem = "has no drops with a size of their own"
        raise SettingError("engine", "dsmc", problem, Option("engine", "exact"), ", or a mist")
    return MoistDsmcParcel


def _number(name: str, default: float, low: float, high: float, help: str) -> Parameter:
    return Parameter(name, "1", default, low, high, None, help, "float")


def _word(name: str, choices: tuple[str, ...], help: str) -> Parameter:
    return Parameter(name, "", choices[0], None, None, choices, help, "str")


def _count(name: str, default: int, high: int, help: str) -> Parameter:
    return Parameter(name, "1", default, 1, high, None, help, "int")


_COLLISIONS = Parameter(
    "collisions", "", True, None, None, None, "whether molecules collide with each other, or with walls alone", "bool"
)
_DELTA = "time step, as the share of its diameter that a molecule moves in it at thermal speed"

ENGINES: Mapping[str, Engine] = MappingProxyType(
    {
        engine.name: engine
        for engine in (
            Engine(
                "exact",
                "every contact and every wall hit at its exact time, in order",
                _exact,
                (_COLLISIONS,),
                reference="https://doi.org/10.1007/s40571-014-0021-8 (event-driven hard spheres)",
                moist=_moist_exact,
                attracting=_attracting_exact,
            ),
            Engine(
                "stepped",
                "equal steps, as in applets: all molecules move, then those that overlap and approach collide",
                _stepped,
                (
                    _number("delta", 0.05, 1e-6, 1e3, _DELTA),
                    _word(
                        "rule",
                        ("pairwise", "index-order", "look-ahead", "every-overlap"),
                        "which pairs collide, and how they are found",
                    ),
                    _word("motion", ("parabola", "euler"), "how molecules fall"),
                    _word(
                        "smooth_walls",
                        ("mirror", "fold", "flip", "clamp", "undo"),
                        "what smooth walls do with a molecule that has gone through them",
                    ),
                    _COLLISIONS,
                ),
                presets={
                    "applet": {"rule": "index-order", "motion": "euler", "smooth_walls": "fold"},
                    "applet-discs": {"rule": "look-ahead", "motion": "euler", "smooth_walls": "clamp"},
                    "applet-atmosphere": {"rule": "pairwise", "motion": "parabola", "smooth_walls": "undo"},
                },
            ),
            Engine(
                "dsmc",
                "equal steps: in each cell partners of collisions are drawn at random; for many in a thin gas",
                _dsmc,
                (
                    _number("dt", 0.2, 1e-4, 10.0, "time step in mean free times"),
                    _number("occupancy", 10.0, 1.0, 1e4, "mean number of molecules in a cell"),
                    _number("cell", 0.5, 1e-3, 1e3, "side of a cell in mean free paths, in place of an occupancy"),
                    _COLLISIONS,
                    _count("threads", 1, 256, "on how many threads; the result is the same for any number"),
                ),
                ideal=True,
                reference="https://doi.org/10.1063/1.869674 (cells and steps of direct simulation Monte Carlo)",
                moist=_moist_dsmc,
            ),
        )
    }
)
"""The engines by name; the first is exact up to rounding."""

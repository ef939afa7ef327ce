"""The accuracy that a user asks for: how large the error of a run may be."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple

from atmosbox.errors import Option, SettingError, either
from atmosbox.scene.spelling import nearest, plain


class Target(NamedTuple):
    """How large the expected error of a single run may be.

    ``text`` is what a user types; ``kelvin`` the largest error of a temperature [K] and ``share`` that of everything
    else, as a share of the theory, each ``inf`` where there is no limit. If ``absolute``, ``share`` also limits the
    error of temperatures, as a share of the absolute temperature. If ``best``, the most accurate run is chosen, with
    errors in units of the two limits, and not the cheapest run within the limits.
    """

    text: str
    kelvin: float = math.inf
    share: float = math.inf
    absolute: bool = False
    best: bool = False

    @property
    def limits(self) -> str:
        """The limits in words."""
        limits = [f"{100.0 * self.share:g} %"] if math.isfinite(self.share) else []
        return " and ".join([*limits, f"{self.kelvin:g} K"] if math.isfinite(self.kelvin) else limits)


_NAMED = (
    Target("sketch", 3.0, 0.05),  # in a figure the result lies near the theory
    Target("lecture", 0.5, 0.01),  # numbers that may be written on a blackboard
    Target("reference", 0.5, 0.01, best=True),  # the best of all measured runs, at any cost
)
TARGETS: Mapping[str, Target] = MappingProxyType({target.text: target for target in _NAMED})
"""The targets that have a name, the same for all scenes."""

_NUMBER = re.compile(r"([0-9]+\.?[0-9]*(?:e[+-]?[0-9]{1,3})?|\.[0-9]+(?:e[+-]?[0-9]{1,3})?)\s*(\S*)", re.IGNORECASE)
FIX = (Option("accuracy", "lecture"), ", or an error such as 0.5K or 2%")


def parse(text: object) -> Target:
    """Return the target that a text stands for; refuse any other text with a SettingError.

    It is the name of a target, or the largest error of temperatures, ``0.5K``, or of everything as a share, ``2%``.

    >>> parse("lecture").limits, parse("0.5 K").kelvin, parse("2%").share
    ('1 % and 0.5 K', 0.5, 0.02)
    """
    if not isinstance(text, str):
        raise SettingError("accuracy", text, "is not a text", *FIX)
    word = text.strip()
    if plain(word) in TARGETS:
        return TARGETS[plain(word)]
    found = _NUMBER.fullmatch(word.replace(",", ".")) if len(word) < 100 else None
    if found is None:
        near = nearest(word, TARGETS)
        problem = f"is neither one of {', '.join(TARGETS)} nor an error"
        raise SettingError("accuracy", text, problem, *((Option("accuracy", near),) if near else FIX))
    size, unit = float(found[1]), found[2]

    def refusal(problem: str, *units: str) -> SettingError:
        fix = either("accuracy", [f"{size:g}{one}" for one in units]) if 0.0 < size <= 100.0 else ()
        return SettingError("accuracy", text, problem, *(fix or FIX))

    if unit.casefold() in ("degc", "°c", "c", "degf", "°f", "f"):
        raise refusal("is a temperature, not an error", "K")
    if unit not in ("K", "k", "%"):
        raise refusal(f"has {'an unknown unit' if unit else 'no unit'}", "K", "%")
    if not 0.0 < size <= (100.0 if unit == "%" else 1000.0):
        raise refusal("is not an error above 0 and of at most " + ("100 %" if unit == "%" else "1000 K"))
    if "," in word:
        raise refusal("is written with a comma", unit)
    name = f"{found[1]}{unit.upper()}"
    return Target(name, share=size / 100.0, absolute=True) if unit == "%" else Target(name, kelvin=size)

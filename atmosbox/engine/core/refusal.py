"""What the engine refuses or cannot do, and the checks of a number. Each error carries one sentence.

::

    ValueError
     +-- RefusedError     an impossible number: its name, its value, what is allowed
          +-- PackingError   molecules that do not fit
    RuntimeError
     +-- StalledError     time no longer advances
    UserWarning
     +-- CoarseStepWarning   a time step so long that collisions come late
"""

import math
from typing import Any

import numpy as np

SMALLEST, LARGEST = 1e-50, 1e50
"""Range of masses, lengths, speeds and accelerations: their products in the time of a contact are numbers then."""


class RefusedError(ValueError):
    """An input that the engine refuses."""


class PackingError(RefusedError):
    """Molecules so many or so large that they do not fit into the box."""


class StalledError(RuntimeError):
    """So many events in a vanishing time that time no longer advances."""


class CoarseStepWarning(UserWarning):
    """A time step so long that molecules overlap deeply before they collide."""


def shown(value: Any) -> str:
    """Return the text of a refused value: numbers of numpy are written like any other number.

    >>> shown(np.float64(1.0)), shown((np.float64(1.0), 2)), shown(np.zeros(2)), shown("wide")
    ('1.0', '(1.0, 2)', '[0.0, 0.0]', "'wide'")
    """
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if type(value) in (list, tuple):
        inside = ", ".join(map(shown, value))
        return f"({inside})" if type(value) is tuple else f"[{inside}]"
    return repr(value)


def number(
    value: Any,
    name: str,
    *,
    least: float = -math.inf,
    above: float = -math.inf,
    most: float = math.inf,
    infinite: bool = False,
) -> float:
    """Return a number within its limits, or refuse."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        raise RefusedError(f"{name} = {shown(value)} is not a number: give a number") from None
    if math.isnan(found) or (math.isinf(found) and not infinite) or not (least <= found <= most and found > above):
        limits = {"above": above, "at least": least, "at most": most}
        words = " and ".join(f"{word} {limit:g}" for word, limit in limits.items() if math.isfinite(limit))
        raise RefusedError(f"{name} = {shown(value)} is impossible: give a finite number{words and ', '}{words}")
    return found


def whole(value: Any, name: str, *, least: int) -> int:
    """Return a whole number that is not below ``least``, or refuse."""
    found = number(value, name, least=least)
    if found != math.floor(found):
        raise RefusedError(f"{name} = {shown(value)} is not a whole number: give one from {least} up")
    return int(value)

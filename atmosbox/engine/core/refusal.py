"""What the engine refuses or cannot do. Each subclasses a builtin and carries one sentence.

::

    ValueError
     +-- RefusedError     an impossible number: its name, its value, what is allowed
          +-- PackingError   molecules that do not fit
    RuntimeError
     +-- StalledError     time no longer advances
    UserWarning
     +-- CoarseStepWarning   a time step so long that collisions come late
"""

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

    Examples
    --------
    >>> shown(np.float64(1.0)), shown((np.float64(1.0), 2)), shown(np.zeros(2)), shown("wide")
    ('1.0', '(1.0, 2)', '[0.0, 0.0]', "'wide'")
    """
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if type(value) in (list, tuple):
        inside = ", ".join(map(shown, value))
        return f"({inside})" if type(value) is tuple else f"[{inside}]"
    return repr(value)

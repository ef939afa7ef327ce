"""Numbers for the engine, rounded to 32 binary digits.

The numbers that a scene sets up come from powers, exponentials and logarithms, which every C library, and numpy on
every processor, rounds differently in the last of their 53 digits. From the same numbers the engine repeats a run to
the last bit. So it is given numbers that do not depend on the machine: a difference in digit 53 changes digit 32 once
in half a million numbers, and a change of 1 in 4e9 is too small to matter to a scene.
"""

from typing import overload

import numpy as np
from numpy.typing import NDArray

__all__ = ["rounded"]

_DIGITS = 32


@overload
def rounded(x: float) -> float: ...
@overload
def rounded(x: NDArray[np.float64]) -> NDArray[np.float64]: ...


def rounded(x: float | NDArray[np.float64]) -> float | NDArray[np.float64]:
    """Return a number, or each of an array, rounded to 32 binary digits.

    Examples
    --------
    >>> rounded(0.1) - 0.1 < 2.0**-35, rounded(0.1) == rounded(0.1 + 1e-16), rounded(3.0)
    (True, True, 3.0)
    """
    part, power = np.frexp(x)  # exact, as are all later steps
    found = np.ldexp(np.rint(np.ldexp(part, _DIGITS)), power - _DIGITS)
    return found if isinstance(x, np.ndarray) else float(found)

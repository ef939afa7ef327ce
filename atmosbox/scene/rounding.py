"""Numbers that the engine is given, rounded to 32 binary digits.

What a scene sets up comes from powers, exponentials and logarithms, which every C library, numpy on every processor,
rounds in its own way in the last of their 53 digits. The engine repeats everything from the numbers that it is given to
the last bit. So it is given numbers that do not show where they were made: a difference in digit 53 moves digit 32 once
in half a million numbers, and 1 in 4e9 is nothing that a scene would notice.
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
    part, power = np.frexp(x)  # exact, as is all that follows
    found = np.ldexp(np.rint(np.ldexp(part, _DIGITS)), power - _DIGITS)
    return found if isinstance(x, np.ndarray) else float(found)

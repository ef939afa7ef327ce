"""Conversion and checks of the arguments of all functions of the theory."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def as_floats(values: ArrayLike) -> FloatArray:
    """Return the values as an array of float64; a plain number becomes an array without axes."""
    return np.asarray(values, dtype=np.float64)


def require_positive(**values: float) -> None:
    """Raise ``ValueError`` naming the first value that is not a finite number above zero."""
    for name, value in values.items():
        if not (np.isfinite(value) and value > 0.0):
            raise ValueError(f"{name} = {value} must be a finite number above 0.")


def require_not_negative(**values: float) -> None:
    """Raise ``ValueError`` naming the first value that is not a finite number of at least zero."""
    for name, value in values.items():
        if not (np.isfinite(value) and value >= 0.0):
            raise ValueError(f"{name} = {value} must be a finite number of at least 0.")


def require_dimensions(dimensions: int) -> None:
    """Raise ``ValueError`` unless there are two or three dimensions."""
    if dimensions not in (2, 3):
        raise ValueError(f"dimensions = {dimensions} must be 2 or 3.")

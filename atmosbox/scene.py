"""What a scenario hands to the runner: a box ready to go, and how to watch it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from atmosbox.units import Scale

if TYPE_CHECKING:
    from atmosbox.engine.parcel import Parcel
    from atmosbox.instruments import Instrument

__all__ = ["Setup"]


@dataclass(frozen=True)
class Setup:
    """A box at its start, its scale, and what is measured how often.

    Parameters
    ----------
    parcel
        The molecules in their box, in the engine's reduced units.
    scale
        What one unit of these is in SI.
    duration
        How long the run lasts [reduced time].
    frames
        Into how many frames, each one point of the time series, the run is divided.
    instruments
        What is measured.
    samples
        How often the molecules are looked at within a frame.
    settle
        How many frames pass before averages begin.
    time_unit
        Unit of the elapsed time in the file: ``s``, ``ns`` or ``ps``.
    facts
        Lines of the model card that depend on the settings: the scale, the noise to expect.

    Raises
    ------
    ValueError
        If the frames are not in order.

    Examples
    --------
    >>> from atmosbox.engine import ParcelSet
    >>> pair = ParcelSet([[1, 2, 2], [3, 2, 2]], [[1, 0, 0], [-1, 0, 0]], length=(4, 4, 4))
    >>> Setup(pair, Scale(1.0, 1.0, 1.0), duration=10.0, frames=5, instruments=()).frame
    2.0
    """

    parcel: Parcel
    scale: Scale
    duration: float
    frames: int
    instruments: tuple[Instrument, ...]
    samples: int = 1
    settle: int = 0
    time_unit: str = "ns"
    facts: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if self.frames < 1 or self.samples < 1 or not 0 <= self.settle < self.frames or not self.duration > 0.0:
            raise ValueError("a run needs a duration, at least one frame, and frames left after it has settled")

    @property
    def frame(self) -> float:
        """Length of a frame [reduced time]."""
        return self.duration / self.frames

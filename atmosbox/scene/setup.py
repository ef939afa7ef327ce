"""What a scenario builds: a box at its start, its scale, its instruments, and the runs to be compared."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from atmosbox.scene.units import Scale, rounded

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from atmosbox.engine import Parcel
    from atmosbox.scene.instruments import Instrument
    from atmosbox.scene.knob import Knob

__all__ = ["Series", "Setup"]


@dataclass(frozen=True)
class Setup:
    """A box at its start, its scale, its instruments, and how often they measure.

    Parameters
    ----------
    parcel, scale
        The molecules in their box, in the engine's reduced units, and the SI values of these units.
    duration, frames
        How long the run lasts [reduced time], and the number of its frames, each one point of the time series.
    instruments, samples
        What is measured, and the number of samples of the molecules in a frame.
    settle
        Number of frames before averages begin.
    time_unit
        Unit of the elapsed time in the file: ``s``, ``ns`` or ``ps``.
    facts
        Lines of the model card that depend on the settings: the scale, the noise to expect.
    knobs
        What may be changed while the box runs, in ``atmosbox live``.
    ends
        Whether the run has an end of its own, as an ascent has at its top; other runs could continue for ever.
    doubts
        Doubts about the given values, one sentence each; they are printed when the run begins, and stored in its file.

    right : (molecule,), optional
        Which molecules belong to the second of two gases, where there are two; pictures give them another colour.

    Raises
    ------
    ValueError
        If duration, frames, samples or settling frames are out of range.

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
    knobs: tuple[Knob, ...] = ()
    ends: bool = False
    doubts: tuple[str, ...] = ()
    right: NDArray[np.bool_] | None = None

    def __post_init__(self) -> None:
        if self.frames < 1 or self.samples < 1 or not 0 <= self.settle < self.frames or not self.duration > 0.0:
            raise ValueError("a run needs a duration, at least one frame, and frames left after it has settled")
        object.__setattr__(self, "duration", rounded(self.duration))

    @property
    def frame(self) -> float:
        """Length of a frame [reduced time]."""
        return self.duration / self.frames

    def moment(self, frame: int, sample: int) -> float:
        """Return the time of a sample [reduced time]: frames count from 0, the samples of a frame from 1."""
        return (frame + 1) * self.frame if sample == self.samples else (frame + sample / self.samples) * self.frame


@dataclass(frozen=True)
class Series:
    """Runs that differ in one value, for the measurement of speed against accuracy.

    Parameters
    ----------
    engine
        The engine of all runs, with its options.
    vary, values
        What differs: an option of the engine, or a setting of the scene; its values, from the cheapest run to the most
        expensive.
    settings
        The settings of all runs that differ from the scene's defaults.
    order
        The power of the varied value with which the error of a headline grows, by the name of the headline, where
        theory gives it.

    Raises
    ------
    ValueError
        If there is no value.

    Examples
    --------
    >>> Series("stepped", "delta", (0.2, 0.1), order={"collision_rate": 2.0}).values
    (0.2, 0.1)
    """

    engine: str
    vary: str
    values: tuple[float, ...]
    settings: Mapping[str, Any] = field(default_factory=dict)
    order: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not self.values:
            raise ValueError("a series needs a value at least")

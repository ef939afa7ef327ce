"""What a scenario hands to the runner: a box ready to go, how to watch it, and what is worth comparing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from atmosbox.scene.units import Scale

if TYPE_CHECKING:
    from atmosbox.engine import Parcel
    from atmosbox.scene.instruments import Instrument
    from atmosbox.scene.knob import Knob

__all__ = ["Series", "Setup"]


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
    knobs
        What may be turned while the box runs, in ``atmosbox live``.
    ends
        Whether the run comes to an end of its own, as an ascent at its top; else it could go on for ever.

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
    knobs: tuple[Knob, ...] = ()
    ends: bool = False

    def __post_init__(self) -> None:
        if self.frames < 1 or self.samples < 1 or not 0 <= self.settle < self.frames or not self.duration > 0.0:
            raise ValueError("a run needs a duration, at least one frame, and frames left after it has settled")

    @property
    def frame(self) -> float:
        """Length of a frame [reduced time]."""
        return self.duration / self.frames

    def moment(self, frame: int, look: int) -> float:
        """Return when the molecules are looked at [reduced time]: the looks of a frame count from 1, frames from 0."""
        return (frame + 1) * self.frame if look == self.samples else (frame + look / self.samples) * self.frame


@dataclass(frozen=True)
class Series:
    """A row of runs that differ in one thing, for the measurement of speed against accuracy.

    Parameters
    ----------
    engine
        What lets time pass in all of them, with its options.
    vary
        What differs: an option of the engine, or a setting of the scene.
    values
        Its values, from the cheapest run to the dearest.
    settings
        What all the runs have in common and differs from the scene's defaults.
    order
        For a headline, by name, the power of the varied value with which its error grows, where a law is known.

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

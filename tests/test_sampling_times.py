"""The times at which the molecules of a run are sampled, checked with a molecule whose path is known."""

from types import SimpleNamespace

import numpy as np
import pytest

from atmosbox.engine import ParcelSet, Periodic
from atmosbox.scene.setup import Setup
from atmosbox.scene.units import Scale
from atmosbox.simulation.recording import Recording


class Tracker:
    """An instrument that records the position of the first molecule at each sample, and the samples of each frame."""

    def __init__(self):
        self.sampled, self.closed = [], []

    def sample(self, parcel, snapshot):
        self.sampled.append(float(snapshot.position[0, 0]))

    def end_frame(self, parcel, snapshot):
        self.closed.append((len(self.sampled), float(snapshot.position[0, 0])))


@pytest.mark.parametrize(("frames", "samples"), [(4, 1), (5, 3), (3, 8)])
def test_samples_lie_evenly_in_a_frame_and_the_last_at_its_end(frames, samples):
    # one molecule that moves from 0.1 to 7.3 at unit speed without a collision
    walls = (Periodic(),) * 6
    position = [[0.1, 2.0, 2.0], [0.1, 6.0, 6.0]]
    parcel = ParcelSet(position, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], length=(8.0, 8.0, 8.0), walls=walls)
    tracker = Tracker()
    setup = Setup(parcel, Scale(1.0, 1.0, 1.0), 7.2, frames, (tracker,), samples=samples)
    recording = Recording(SimpleNamespace(save_molecules=False, replay=None), setup, {})
    for _ in range(frames):
        recording.advance(lambda now: None)
    expected = 0.1 + 7.2 * np.arange(1, frames * samples + 1) / (frames * samples)
    assert np.allclose(tracker.sampled, expected, rtol=0.0, atol=1e-9)
    assert np.allclose(tracker.closed, [((k + 1) * samples, expected[(k + 1) * samples - 1]) for k in range(frames)])
    assert np.allclose(recording.times, np.linspace(0.0, 7.2, frames + 1))

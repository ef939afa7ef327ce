"""Cut the runs of a test into fewer frames: with all frames of the scene, the ends of frames take most of the time."""

import pytest

from atmosbox import scenarios

FRAMES = {
    "atmosphere": (80, 14),
    "attraction": (75, 25),
    "condensation": (80, 14),
    "convection": (60, 20),
    "diffusion": (60, None),
    "elastic-collisions": (240, 80),
    "evaporation": (200, None),
    "temperature": (200, 10),  # and temperature-large, which is built there
}
"""Into how many frames a run is cut whose errors are to be right, and how many of them settle.

The run is as long as before, and so are the blocks that its errors are read from.
"""


def cut(patch, frames):
    """Set the number of frames of a scene's runs, and how many of them are for settling, while a patch lasts.

    ``frames`` has both numbers by scene; the second is None where a scene works it out.
    """
    for scene, (number, settle) in frames.items():
        module = scenarios.load(scene)
        patch.setattr(module, "FRAMES", number)
        if settle is not None:
            patch.setattr(module, "SETTLE", settle)


def few_frames_of(frames):
    """Return a fixture that cuts all runs of a file of tests, see `cut`."""

    @pytest.fixture(scope="module", autouse=True)
    def few_frames():
        with pytest.MonkeyPatch.context() as patch:
            cut(patch, frames)
            yield

    return few_frames

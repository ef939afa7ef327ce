"""Runs of a test cut into fewer frames: a run in as many as a scene has spends most of its time on what ends each."""

from atmosbox import scenarios

__all__ = ["cut"]


def cut(patch, frames):
    """Set into how many frames scenes cut a run, and how many of them settle, for as long as a patch lasts.

    ``frames`` has both numbers by scene; the second is None where a scene works it out.
    """
    for scene, (number, settle) in frames.items():
        module = scenarios.load(scene)
        patch.setattr(module, "FRAMES", number)
        if settle is not None:
            patch.setattr(module, "SETTLE", settle)

"""Cut the runs of a test into fewer frames: with all frames of the scene, the ends of frames take most of the time."""

from atmosbox import scenarios

__all__ = ["cut"]


def cut(patch, frames):
    """Set the number of frames of a scene's runs, and how many of them are for settling, while a patch lasts.

    ``frames`` has both numbers by scene; the second is None where a scene works it out.
    """
    for scene, (number, settle) in frames.items():
        module = scenarios.load(scene)
        patch.setattr(module, "FRAMES", number)
        if settle is not None:
            patch.setattr(module, "SETTLE", settle)

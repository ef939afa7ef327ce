"""What the engine refuses or cannot do. Each subclasses a builtin and carries one sentence.

::

    ValueError
     +-- RefusedError     a number that no box can have: its name, its value, what is allowed
          +-- PackingError   molecules that do not fit
    RuntimeError
     +-- StalledError     time no longer advances
    UserWarning
     +-- CoarseStepWarning   a time step so long that collisions come late
"""

__all__ = ["CoarseStepWarning", "PackingError", "RefusedError", "StalledError"]


class RefusedError(ValueError):
    """An input that the engine refuses."""


class PackingError(RefusedError):
    """So many or so large molecules that they do not fit into the box."""


class StalledError(RuntimeError):
    """Events pile up without end in a vanishing time."""


class CoarseStepWarning(UserWarning):
    """A time step so long that molecules overlap deeply before they collide."""

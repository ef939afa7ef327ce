"""A room of the package that is also the function of its name: `atmosbox.plot` and `atmosbox.sweep`.

Python binds ``atmosbox.plot`` to the package of that name as soon as anything in it is imported, so a function of the
same name would vanish. The package is therefore callable itself.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

__all__ = ["CallableRoom"]


class CallableRoom(ModuleType):
    """A package that can be called: ``atmosbox.plot(run)`` calls `atmosbox.interface.plot`.

    Examples
    --------
    >>> import atmosbox.plot
    >>> callable(atmosbox.plot), atmosbox.plot.FORMATS
    (True, ('png', 'svg', 'pdf'))
    """

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Call the function of the public face that has this room's name; `atmosbox.interface` documents it."""
        from atmosbox import interface

        return getattr(interface, self.__name__.rpartition(".")[2])(*args, **options)

"""A room of the package that is also the function of its name: `atmosbox.plot` and `atmosbox.sweep`.

Python binds ``atmosbox.plot`` to the package of that name as soon as anything in it is imported, so a function of the
same name would vanish. The package is therefore callable itself; which function it stands for, the package above says.
"""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any, ClassVar

__all__ = ["CallableRoom"]


class CallableRoom(ModuleType):
    """A package that can be called: ``atmosbox.plot(run)`` calls `atmosbox.interface.plot`.

    Examples
    --------
    >>> import atmosbox.plot
    >>> callable(atmosbox.plot), atmosbox.plot.FORMATS
    (True, ('png', 'svg', 'pdf'))
    """

    function_of: ClassVar[Callable[[str], Callable[..., Any]]]
    """Returns the function of a room by its name; `atmosbox` sets it when it is imported."""

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Call the function of this room's name."""
        return CallableRoom.function_of(self.__name__.rpartition(".")[2])(*args, **options)

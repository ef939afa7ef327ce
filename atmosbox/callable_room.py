"""A package that is also the function of the same name: `atmosbox.plot` and `atmosbox.sweep`.

Python binds ``atmosbox.plot`` to the package of that name as soon as anything in it is imported, so a function of the
same name would be hidden. The package itself is therefore callable; `atmosbox` says which function it calls.
"""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any, ClassVar


class CallableRoom(ModuleType):
    """A package that can be called: ``atmosbox.plot(run)`` calls `atmosbox.interface.plot`.

    Examples
    --------
    >>> import atmosbox.plot
    >>> callable(atmosbox.plot), atmosbox.plot.FORMATS
    (True, ('png', 'svg', 'pdf'))
    """

    function_of: ClassVar[Callable[[str], Callable[..., Any]]]
    """Function that returns the public function of a name; `atmosbox` sets it when it is imported."""

    def __call__(self, *args: Any, **options: Any) -> Any:
        """Call the function with the name of this package."""
        return CallableRoom.function_of(self.__name__.rpartition(".")[2])(*args, **options)

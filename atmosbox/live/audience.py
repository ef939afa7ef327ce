"""The pages that are open, and the messages that wait for each of them, never more than a few."""

from __future__ import annotations

import asyncio
from collections import deque

__all__ = ["Audience", "Mailbox"]

_MOST = 200
_LATEST = ('{"type": "state"', '{"type": "arrays"')


class Mailbox:
    """The messages that wait for one page.

    Of pictures, states and arrays only the latest waits. What must not be missed waits in order; a page that is so
    slow that too many wait gets everything anew instead.

    Examples
    --------
    >>> box = Mailbox(1)
    >>> for message in (b"one picture", '{"type": "note"}', b"the next"):
    ...     box.put(message)
    >>> box.take()
    ['{"type": "note"}', b'the next']
    """

    def __init__(self, number: int) -> None:
        self.number = number
        self.waiting = asyncio.Event()
        self.overrun = False
        self._texts: deque[str] = deque()
        self._latest: dict[str, str] = {}
        self._picture: bytes | None = None

    def put(self, message: str | bytes) -> None:
        """Add a message."""
        kind = None if isinstance(message, bytes) else next((k for k in _LATEST if message.startswith(k)), None)
        if isinstance(message, bytes):
            self._picture = message
        elif kind is not None:
            self._latest[kind] = message
        else:
            if message.startswith('{"type": "stage"'):
                self._latest.clear()
                self._texts.clear()
                self._picture = None
            self._texts.append(message)
        if len(self._texts) > _MOST:
            self._texts.clear()
            self.overrun = True
        self.waiting.set()

    def take(self) -> list[str | bytes]:
        """Return what waits, and empty the mailbox."""
        found: list[str | bytes] = [*self._texts, *self._latest.values()]
        if self._picture is not None:
            found.append(self._picture)
        self._texts.clear()
        self._latest.clear()
        self._picture = None
        self.waiting.clear()
        return found


class Audience:
    """All pages that are open.

    Examples
    --------
    >>> audience = Audience()
    >>> first, second = audience.join(), audience.join()
    >>> audience.put(None, '{"type": "note"}')
    >>> len(first.take()), len(second.take()), len(audience)
    (1, 1, 2)
    """

    def __init__(self) -> None:
        self._boxes: dict[int, Mailbox] = {}
        self._count = 0

    def __len__(self) -> int:
        return len(self._boxes)

    def join(self) -> Mailbox:
        """Return the mailbox of a page that has come."""
        self._count += 1
        box = self._boxes[self._count] = Mailbox(self._count)
        return box

    def leave(self, box: Mailbox) -> None:
        """Remove a page that has gone."""
        self._boxes.pop(box.number, None)

    def put(self, page: int | None, message: str | bytes) -> None:
        """Add a message for one page, or for all."""
        for box in list(self._boxes.values()) if page is None else [self._boxes[page]] if page in self._boxes else []:
            box.put(message)

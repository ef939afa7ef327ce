"""The open pages, and a short queue of messages for each."""

from __future__ import annotations

import asyncio
from collections import deque

__all__ = ["Audience", "Mailbox"]

_MOST = 200
_LATEST = ('{"type": "state"', '{"type": "arrays"')


class Mailbox:
    """The queue of messages for one page.

    Of pictures, states and arrays only the latest is kept. Messages that must not be missed are kept in order; if too
    many of them wait, because the page is slow, they are dropped and the page gets everything anew.

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
        """Return the waiting messages, and empty the mailbox."""
        found: list[str | bytes] = [*self._texts, *self._latest.values()]
        if self._picture is not None:
            found.append(self._picture)
        self._texts.clear()
        self._latest.clear()
        self._picture = None
        self.waiting.clear()
        return found


class Audience:
    """All open pages.

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
        """Return the mailbox of a page that has just connected."""
        self._count += 1
        box = self._boxes[self._count] = Mailbox(self._count)
        return box

    def leave(self, box: Mailbox) -> None:
        """Remove a page that has disconnected."""
        self._boxes.pop(box.number, None)

    def put(self, page: int | None, message: str | bytes) -> None:
        """Add a message for one page; for all if `page` is None."""
        for box in list(self._boxes.values()) if page is None else [self._boxes[page]] if page in self._boxes else []:
            box.put(message)

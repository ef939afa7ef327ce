"""Names as users spell them, and the one that was probably meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

__all__ = ["nearest", "plain"]


def plain(name: str) -> str:
    """Return a name as it is compared: without capitals, and with "_" for "-".

    Parameters
    ----------
    name
        What was typed, or what could have been.

    Examples
    --------
    >>> plain(" Pressure-Top")
    'pressure_top'
    """
    return name.strip().casefold().replace("-", "_")


def nearest(name: str, names: Iterable[str]) -> str | None:
    """Return the name that a user probably meant, or None.

    Parameters
    ----------
    name
        What was typed.
    names
        What could have been.

    Examples
    --------
    >>> names = ["molecules", "temperature"]
    >>> nearest("temprature", names), nearest("mol", names), nearest("x", names)
    ('temperature', 'molecules', None)
    """
    known = {plain(candidate): candidate for candidate in names}
    wanted = plain(name)[:100]
    if wanted in known:
        return known[wanted]
    begun = [candidate for candidate in known if len(wanted) > 2 and candidate.startswith(wanted)]
    close = begun if len(begun) == 1 else difflib.get_close_matches(wanted, known, n=1)
    return known[close[0]] if close else None

"""Names and assignments as users spell them, and the name that was probably meant."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from atmosbox.errors import Setting, SettingError, shown


def field_name(name: str) -> str:
    """Return the Python name of a setting, which a user may spell with "-" for "_".

    >>> field_name(" pressure-top")
    'pressure_top'
    """
    return name.strip().replace("-", "_")


def plain(name: str) -> str:
    """Return a name in the form for comparison: without capitals, and with "_" for "-".

    >>> plain(" Pressure-Top")
    'pressure_top'
    """
    return field_name(name).casefold()


def nearest(name: str, names: Iterable[str]) -> str | None:
    """Return the name that a user probably meant, or None.

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


def assignments(items: Iterable[str]) -> dict[str, str]:
    """Return the values of ``name=value``, as they are typed after each ``--set``, by name; refuse other texts.

    >>> assignments(["temperature=25 degC", "pressure-top=300hPa"])
    {'temperature': '25 degC', 'pressure_top': '300hPa'}
    """
    values: dict[str, str] = {}
    for item in items:
        name, equals, value = (part.strip() for part in item.partition("="))
        name = field_name(name)
        if len(value) > 1 and value[0] == value[-1] and value[0] in "\"'":
            value = value[1:-1].strip()
        if not (name and equals and value):
            lacks = "name" if equals and not name else "value" if equals else '"=" between name and value'
            known = name if name.isascii() and name.isidentifier() else "name"
            raise SettingError(item, None, f"has no {lacks}", Setting(known, "value"))
        if name in values:
            raise SettingError(name, value, "is given twice", Setting(shown(name)), " once")
        values[name] = value
    return values

"""Error messages with Python arguments: ``--set molecules=200`` of the command line becomes ``molecules=200``."""

from __future__ import annotations

import contextlib
import json
import re
import shlex
from collections.abc import Iterator

from atmosbox.errors import AtmosboxError

__all__ = ["in_python", "python_words"]

_FLAGS = ("force", "save-molecules", "with-box", "graphs")

# A value in a sentence: in quotes, or a word without the punctuation mark after it.
_VALUE = r"""(?:'[^']*'|"[^"]*"|[^\s'"]*[^\s'",;:.)])"""
_RUN = re.compile(rf"atmosbox run (?P<scene>{_VALUE}) --save-molecules")
_OPTION = re.compile(
    rf"(?P<before>leave out |leave |without )?--(?P<option>[a-z][a-z-]*)"
    rf"(?: (?P<name>[A-Za-z]\w*(?:[-_]\w+)*)=(?P<set>{_VALUE})?"
    rf"|(?! (?:with|that|for|is|are|has|once|instead|of|out|or|and|a)\b) (?P<value>{_VALUE}))?"
)
_NUMBER = re.compile(r"[+-]?\d+(?:\.\d+)?(?:e[+-]?\d+)?", re.IGNORECASE)


def python_words(sentence: str) -> str:
    """Return a sentence in which each option of the command line is replaced by the Python argument.

    Parameters
    ----------
    sentence
        An error message, or a part of it.

    Returns
    -------
    str
        The message for the caller of a function of `atmosbox`.

    Examples
    --------
    >>> python_words("give --set molecules=200, or --engine dsmc")
    'give molecules=200, or engine="dsmc"'
    >>> python_words("x.nc exists already: add --force to replace it, or name another file with --out.")
    'x.nc exists already: add force=True to replace it, or name another file with out.'
    """
    said = _RUN.sub(lambda found: f"atmosbox.run({_text(found['scene'])}, save_molecules=True)", sentence)
    said = re.sub(r"`?atmosbox list`?", "atmosbox.scenes()", said)
    said = re.sub(r"atmosbox (run|plot)(?= has\b| to\b|\.?$)", r"atmosbox.\1", said)
    return _OPTION.sub(_argument, said)


def _argument(found: re.Match[str]) -> str:
    """Return an option of the command line as a Python argument."""
    option, before = found["option"], found["before"] or ""
    if found["name"] is not None:
        name, value = found["name"].replace("-", "_"), found["set"] or ""
        return before + (f'vary={{"{name}": {_text(value)}}}' if option == "vary" else f"{name}={_literal(value)}")
    name, value = option.replace("-", "_"), found["value"]
    if option in _FLAGS:
        after = f" {value}" if value is not None else ""
        return f"{before}{name}{'' if before else '=True'}{after}"
    if value is None:
        return before + name
    if option in ("set", "vary"):
        name = value.replace("-", "_")
        return before + (f'vary={{"{name}": ...}}' if option == "vary" else name)
    return f"{before}{name}={_literal(value)}"


def _literal(value: str) -> str:
    """Return a value of the command line as a Python literal."""
    if value in ("on", "off"):
        return str(value == "on")
    return value if _NUMBER.fullmatch(value) else _text(value)


def _text(value: str) -> str:
    """Return a text in Python's quotation marks, without those of the shell."""
    with contextlib.suppress(ValueError):
        value = "".join(shlex.split(value))
    return json.dumps(value, ensure_ascii=False)


@contextlib.contextmanager
def in_python() -> Iterator[None]:
    """Change the messages of errors that are raised in this block, so that they name Python arguments.

    Examples
    --------
    >>> from atmosbox.errors import SettingError
    >>> with in_python():
    ...     raise SettingError("molecules", 0, "is too few", "give --set molecules=200")
    Traceback (most recent call last):
    atmosbox.errors.SettingError: molecules = 0 is too few: give molecules=200.
    """
    try:
        yield
    except AtmosboxError as error:
        error.reword(python_words)
        raise

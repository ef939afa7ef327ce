"""Columns and numbers: how a table fits a terminal, and with how many digits a measurement is shown."""

import itertools
import math
import textwrap
from collections.abc import Sequence

LONGEST_LINE = 100  # columns of running text, however wide the terminal is
NARROWEST = 20  # columns for a cell that is broken into lines


def table(header: Sequence[str], rows: Sequence[Sequence[str]], width: int, narrowest: int = NARROWEST) -> list[str]:
    r"""Return the lines of a table at most `width` characters wide; no cell is cut off.

    To fit, the names of columns are broken into lines, then the last cell of a row and the first, to `narrowest`
    characters at least and never within a word; if that is not enough, each row becomes a block of lines. An empty
    header means columns without names.

    >>> print("\n".join(table(["quantity", "theory"], [["temperature [degC]", "15.0"]], 80)))
    quantity            theory
    temperature [degC]  15.0
    >>> print("\n".join(table(["quantity", "theory"], [["temperature [degC]", "15.0"]], 20)))
    temperature [degC]
      theory: 15.0
    """
    lines = [list(header), *map(list, rows)] if any(header) else [list(row) for row in rows]
    if not lines:
        return []
    sizes = [max(len(row[column]) for row in lines) for column in range(len(lines[0]))]
    columns = list(zip(*rows, strict=True)) or [()] * len(header)
    words = [max(map(len, name.split()), default=0) for name in header]

    def shrink(column: int, least: int) -> None:
        excess = max(sum(sizes) + 2 * len(sizes) - 2 - width, 0)
        sizes[column] = max(sizes[column] - excess, min(least, sizes[column]))

    for column in reversed(range(len(sizes))):
        shrink(column, max([words[column], *map(len, columns[column])]))
    for column in (-1, 0):
        longest = max(map(len, " ".join(columns[column]).split()), default=0)
        shrink(column, max([words[column], longest, min(max(map(len, columns[column]), default=0), narrowest)]))
    if sum(sizes) + 2 * len(sizes) - 2 > width:
        return _blocks(header, rows, width)
    made = []
    for row in lines:
        cells = [_filled(cell, max(size, 1)) for cell, size in zip(row, sizes, strict=True)]
        for parts in itertools.zip_longest(*cells, fillvalue=""):
            made.append("  ".join(part.ljust(size) for part, size in zip(parts, sizes, strict=True)).rstrip())
    return made


def _filled(text: str, size: int, indent: str = "") -> list[str]:
    """Return a text in lines of at most this width; no word is cut."""
    return textwrap.TextWrapper(size, indent, indent, break_long_words=False, break_on_hyphens=False).wrap(text)


def _blocks(header: Sequence[str], rows: Sequence[Sequence[str]], width: int) -> list[str]:
    """Return each row of a table as a block of lines, one cell below the other."""
    made = []
    for row in rows:
        if not any(header):
            made += ["  ".join(row[:-1]), *wrapped(row[-1], width, indent="  ")]
            continue
        made.append(row[0])
        for name, cell in zip(header[1:], row[1:], strict=True):
            if cell:
                made += wrapped(f"{name}: {cell}" if name else cell, width, indent="  ")
    return made


def wrapped(text: str, width: int, indent: str = "") -> list[str]:
    """Return a paragraph in lines of a readable length; no word is cut."""
    return _filled(text, max(min(width, LONGEST_LINE), 20), indent)


def story(text: str, width: int) -> list[str]:
    r"""Return a docstring for a terminal: paragraphs are wrapped again, indented lines stay as they are.

    The backquotes around code are left out.

    >>> story("Air that\n``rises`` cools.\n\n    T ~ p^(2/7)", 80)
    ['Air that rises cools.', '', '    T ~ p^(2/7)']
    """
    made: list[str] = []
    for paragraph in text.replace("``", "").strip().split("\n\n"):
        lines = paragraph.splitlines()
        plain = not any(line[:1].isspace() or line[:2] in ("- ", "* ", "..") for line in lines)
        made += ["", *(wrapped(" ".join(lines), width) if plain else lines)]
    return made[1:]


def number(value: float, decimals: int | None = None, power: int = 0, sign: str = "") -> str:
    """Return a number as text, with six significant digits or the given decimals.

    Negative decimals round to tens or hundreds. The power of ten is taken out: 9 shows 1.5e9 as 1.5 and "e9". The sign
    "+" shows that of a positive number too.

    >>> number(288.149, 2), number(12345.0, -2), number(1.5e9, 1, 9, "+")
    ('288.15', '12300', '+1.5e9')
    """
    if not math.isfinite(value):
        return f"{value:{sign}}"
    if decimals is None:
        return f"{value:{sign}.6g}"
    mantissa = round(value / 10.0**power, decimals) + 0.0  # never "-0"
    return f"{mantissa:{sign}.{max(decimals, 0)}f}{f'e{power}' if power else ''}"


def digits(value: float, error: float) -> tuple[int | None, int]:
    """Return the number of decimals to show of a measurement, and the power of ten to take out of it.

    Two digits of the standard error are shown; decimals are None if there is none. The power is zero for numbers that
    are easy to read without it.

    >>> digits(288.149, 0.0312), digits(1.5e9, 2e7), digits(3.0, 0.0)
    ((3, 0), (3, 9), (None, 0))
    """
    if not (math.isfinite(value) and math.isfinite(error) and error > 0.0):
        return None, 0
    last = math.floor(math.log10(error)) - 1
    first = math.floor(math.log10(max(abs(value), error)))
    power = 0 if -4 <= first < 6 else first
    return power - max(last, first - 11), power


def measurement(value: float, error: float) -> str:
    """Return a measurement with its standard error as text.

    >>> measurement(288.149, 0.0312), measurement(1.52345e9, 2e7), measurement(15.0, 0.0)
    ('288.149 ± 0.031', '(1.523 ± 0.020)e9', '15')
    """
    decimals, power = digits(value, error)
    if decimals is None:
        return number(value) if error == 0.0 else f"{number(value)} ± {number(error)}"
    # The power of ten is taken out of both numbers, and written once.
    low, high = (number(x / 10.0**power, decimals) for x in (value, error))
    return f"({low} ± {high})e{power}" if power else f"{low} ± {high}"

"""The entries of the file of a sheet, taken one by one and checked."""

from __future__ import annotations

from typing import Any

from atmosbox.errors import ConfigError, shown

__all__ = ["Table"]

MOST_LINES = 12


class Table:
    """A table of the file, whose entries are taken one by one; what is left over is refused.

    Parameters
    ----------
    path
        The file.
    name
        What a refusal calls the table.
    content
        What TOML has made of it.

    Raises
    ------
    ConfigError
        If it is no table, here or when an entry is taken that is not as it should be.

    Examples
    --------
    >>> table = Table("my_scene.sheet.toml", "the sheet", {"goal": "See air cool."})
    >>> table.text("goal"), table.number("lines", 2)
    ('See air cool.', 2)
    """

    def __init__(self, path: str, name: str, content: Any) -> None:
        self.path, self.name = path, name
        if not isinstance(content, dict):
            raise self.refusal("is not a table")
        self.content = dict(content)

    def refusal(self, problem: str) -> ConfigError:
        """Return the refusal of this table."""
        return ConfigError(f"{self.path}: {self.name} {problem}; see docs/sheet.md.")

    def text(self, key: str, default: str | None = None) -> str:
        """Take a text; without a default it must be there."""
        value = self.content.pop(key, default)
        if not isinstance(value, str) or (default is None and not value.strip()):
            raise self.refusal(f"needs a text {key}")
        return " ".join(value.split())

    def number(self, key: str, default: int) -> int:
        """Take a small number."""
        value = self.content.pop(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value <= MOST_LINES:
            raise self.refusal(f"needs a number from 0 to {MOST_LINES} for {key}")
        return value

    def tables(self, key: str, name: str) -> list[Table]:
        """Take an array of tables."""
        value = self.content.pop(key, [])
        if not isinstance(value, list):
            raise self.refusal(f"needs [[{key}]] with two brackets")
        return [Table(self.path, f"{name} {number}", each) for number, each in enumerate(value, 1)]

    def close(self) -> None:
        """Refuse what nobody has taken."""
        if self.content:
            raise self.refusal(f"does not know {', '.join(shown(key) for key in self.content)}")

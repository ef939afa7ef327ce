"""What the words of lines and panels must be."""

from __future__ import annotations

__all__ = ["check_choice", "check_text"]


def check_text(what: str, name: str, value: object) -> None:
    """Refuse what is no text, or an empty one."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be a text that is not empty.")


def check_choice(what: str, name: str, value: object, choices: tuple[str, ...]) -> None:
    """Refuse a word of a line or panel that is none of those that there are."""
    if value not in choices:
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be one of {', '.join(choices)}.")

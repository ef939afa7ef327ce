"""Checks of the texts in lines and panels."""

from __future__ import annotations

__all__ = ["check_choice", "check_text"]


def check_text(what: str, name: str, value: object) -> None:
    """Refuse a value that is not a text, and an empty text."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be a text that is not empty.")


def check_choice(what: str, name: str, value: object, choices: tuple[str, ...]) -> None:
    """Refuse a word of a line or panel that is not one of the choices."""
    if value not in choices:
        raise ValueError(f"the {name} of a {what} is {value!r}, and must be one of {', '.join(choices)}.")

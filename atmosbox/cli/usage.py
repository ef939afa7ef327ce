"""What was typed: NAME=VALUE is a setting, and what cannot be understood is answered with one sentence."""

import contextlib
import re
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperCommand

from atmosbox.errors import AtmosboxError, shown
from atmosbox.text.stream import tell

UsageError: Any = typer.BadParameter.__base__  # of the click inside typer, which has no public name

_ASSIGNMENT = re.compile(r"[A-Za-z][\w-]*=.*", re.DOTALL)


class OneSentence(UsageError):  # type: ignore[misc]
    """Something that was typed cannot be understood; the message is one sentence."""

    def show(self, file: Any = None) -> None:
        """Print the sentence."""
        tell(f"error: {shown(self.message, longest=2000)}")


class Command(TyperCommand):
    """A command in which a setting may be typed as NAME=VALUE, without ``--set``."""

    @property
    def _sets(self) -> bool:
        return any("--set" in parameter.opts for parameter in self.params)

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Parse what was typed after the name of the command."""
        ctx.allow_extra_args = True
        words = list(args)
        try:
            super().parse_args(ctx, self._with_set(args) if self._sets else args)
        except UsageError as error:
            raise OneSentence(self._said(error, words)) from error
        if ctx.args and not ctx.resilient_parsing:
            raise OneSentence(self._too_many(ctx.args, words))
        return []

    def collect_usage_pieces(self, ctx: Any) -> list[str]:
        """Return the parts of the line that shows how the command is typed."""
        return [*super().collect_usage_pieces(ctx), *(["[NAME=VALUE]..."] if self._sets else [])]

    def _with_set(self, words: Sequence[str]) -> list[str]:
        """Return the words with ``--set`` before each NAME=VALUE that is not the value of an option."""
        valued = {opt for each in self.params if not getattr(each, "is_flag", True) for opt in each.opts}
        made: list[str] = []
        for k, word in enumerate(words):
            if word == "--":
                return [*made, *words[k:]]
            if _ASSIGNMENT.fullmatch(word) and (k == 0 or words[k - 1] not in valued):
                made.append("--set")
            made.append(word)
        return made

    def _too_many(self, extra: Sequence[str], words: Sequence[str]) -> str:
        """Return the sentence for words that the command has no place for."""
        names = _settings(words) if self._sets else []
        place = words.index(extra[0])
        parts = [*words[place - 1 : place], *extra]
        parts = parts if extra[0] not in names and parts[0].partition("=")[0] in names else [*extra]
        whole = "".join(parts) if any("=" in part for part in parts) else "=".join([*parts, "VALUE"][:2])
        if whole.partition("=")[0] in names:
            return f"{' '.join(parts)} is not one word of the form NAME=VALUE: write {shlex.quote(whole)}."
        if not self._sets and _ASSIGNMENT.fullmatch(extra[0]):
            return f"atmosbox {self.name} takes no settings: leave {extra[0]} out, or give it to atmosbox run."
        if extra[0].endswith(".nc"):
            pair = shlex.join(["atmosbox", "compare", *(word for word in words if word.endswith(".nc"))])
            return f"atmosbox {self.name} takes one file, and is given {1 + len(extra)}: give one, or type {pair}."
        return (
            f"{shlex.join(extra)} has no meaning for atmosbox {self.name}: leave it out; "
            f"atmosbox {self.name} --help shows what may be given."
        )

    def _said(self, error: Any, words: Sequence[str]) -> str:
        """Return the sentence for an error that the parser has found; an unknown option is mostly a setting."""
        kind, said = type(error).__name__, str(error.format_message()).replace("Value error, ", "").rstrip(".")
        if kind == "MissingParameter":
            lines = [line.strip() for line in (self.epilog or "").splitlines()]
            example = next(line for line in lines if line.startswith(f"atmosbox {self.name} "))
            return f"{said}: type for instance {example}."
        if kind == "NoSuchOption" and self._sets:
            from atmosbox.scene.spelling import nearest

            place = next(k for k, word in enumerate(words) if word.startswith(error.option_name))
            option, _, value = words[place].partition("=")
            name = nearest(option.lstrip("-"), _settings(words))
            if name is not None:
                value = shlex.quote(value or next(iter(words[place + 1 : place + 2]), "VALUE"))
                return (
                    f"{option} is not an option, but {name} is a setting: give {name}={value}, or --set {name}={value}."
                )
        return f"{said}; atmosbox {self.name} --help shows what may be given."


def _settings(words: Sequence[str]) -> list[str]:
    """Return the names of the settings of the scene that was typed; none if no scene was."""
    from atmosbox import scenarios

    for word in words:
        with contextlib.suppress(AtmosboxError):
            if not word.startswith("-"):
                return [parameter.name for parameter in scenarios.load(word).Settings.describe()]
    return []


def command_refusal(words: Sequence[str], commands: Sequence[str]) -> OneSentence:
    """Return the refusal of a word that is no command, with what was probably meant.

    Examples
    --------
    >>> command_refusal(["plott", "x.nc"], ["run", "plot"]).message
    'There is no command plott: did you mean atmosbox plot x.nc?'
    >>> command_refusal(["set", "temperature=30"], ["run", "plot"]).message
    'There is no command set: did you mean atmosbox run SCENE --set temperature=30?'
    """
    from atmosbox import scenarios
    from atmosbox.scene.spelling import nearest

    name, rest = words[0], list(words[1:])
    if name in scenarios.names() or name.endswith(".py"):
        meant = ["run", *words]
    elif name.endswith(".nc") and Path(name).exists():
        meant = ["plot", *words]
    elif name == "set":
        given = rest if any("=" in word for word in rest) else ["=".join(rest) or "NAME=VALUE"]
        meant = ["run", "SCENE", "--set", *given]
    else:
        near = nearest(name, commands) or ("run" if set(rest) & set(scenarios.names()) else None)
        if near is None:
            return OneSentence(f"There is no command {shown(name)}: atmosbox --help shows all.")
        meant = [near, *rest]
    return OneSentence(f"There is no command {shown(name)}: did you mean {shlex.join(['atmosbox', *meant])}?")

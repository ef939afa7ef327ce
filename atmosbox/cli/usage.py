"""What was typed: NAME=VALUE is a setting, and what cannot be understood is answered with one sentence."""

from __future__ import annotations

import contextlib
import re
import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import typer
from typer.core import TyperCommand

from atmosbox.errors import AtmosboxError, shown
from atmosbox.text.stream import tell

__all__ = ["OneSentence", "command_refusal", "one_sentence"]

UsageError: Any = typer.BadParameter.__base__  # of the click inside typer, which has no public name

_ASSIGNMENT = re.compile(r"[A-Za-z][\w-]*=.*", re.DOTALL)
_NUMBER = r"[-+]?[\d.]"


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
        with one_sentence(self, words):
            if self._sets:
                _refuse_blanks(words)
                args = self._with_set(args)
            super().parse_args(ctx, args)
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
        if self._sets:
            before = words[words.index(extra[0]) - 1]
            if _ASSIGNMENT.fullmatch(before):
                whole = before + extra[0]
                return f"{before} {extra[0]} is two words: write {shlex.quote(whole)}, without a blank."
            if len(extra) > 1 and re.match(_NUMBER, extra[1]) and extra[0].isidentifier():
                return f"{extra[0]} {extra[1]} is two words: write a setting as {extra[0]}={shlex.quote(extra[1])}."
            if extra[0] in _settings(words):
                return f"{extra[0]} is a setting and has no value: give {extra[0]}=VALUE."
        elif _ASSIGNMENT.fullmatch(extra[0]):
            return f"atmosbox {self.name} takes no settings: leave {extra[0]} out, or give it to atmosbox run."
        elif extra[0].endswith(".nc"):
            pair = shlex.join(["atmosbox", "compare", *(word for word in words if word.endswith(".nc"))])
            return f"atmosbox {self.name} takes one file, and is given {1 + len(extra)}: give one, or type {pair}."
        return (
            f"{shlex.join(extra)} is too much for atmosbox {self.name}: leave it out; "
            f"atmosbox {self.name} --help shows what may be given."
        )

    def sentence(self, error: Any, words: Sequence[str]) -> str:
        """Return the sentence for an error that the parser has found."""
        kind, name = type(error).__name__, str(getattr(error, "option_name", ""))
        if kind == "NoSuchOption":
            return self._no_option(name, words)
        if kind == "BadOptionUsage":
            found = next((each for each in self.params if name in each.opts), None)
            if "does not take" in error.message:
                return f"{name} takes no value: give {name} alone."
            return f"{name} has no value: give {name} {getattr(found, 'metavar', None) or 'VALUE'}."
        parameter: Any = getattr(error, "param", None)
        if kind == "MissingParameter":
            wanted = parameter.metavar or parameter.name.upper()
            lines = [line.strip() for line in (self.epilog or "").splitlines()]
            example = next(line for line in lines if line.startswith(f"atmosbox {self.name} "))
            return f"atmosbox {self.name} needs {wanted}: type for instance {example}."
        if parameter is not None:
            option = next((opt for opt in parameter.opts if opt in words), parameter.opts[0])
            given = shown(words[words.index(option) + 1] if option in words else "")
            _, listed, allowed = error.message.replace("'", "").rstrip(".").partition(" is not one of ")
            if listed:
                from atmosbox.scene.spelling import nearest

                near = nearest(given, allowed.split(", ")) or allowed.split(", ")[0]
                return f"{option} = {given} is not one of {allowed}: give {option} {near}."
            return f"{option} = {given} is not a number: give one, such as {option} 10."
        return str(error.format_message())

    def _no_option(self, option: str, words: Sequence[str]) -> str:
        """Return the sentence for an option that the command does not have: mostly it is a setting."""
        from atmosbox.scene.spelling import nearest

        known = [opt for each in self.params for opt in each.opts if opt.startswith("--")]
        place = next(k for k, word in enumerate(words) if word.startswith(option))
        option = words[place].partition("=")[0]
        value = words[place].partition("=")[2] or next(iter(words[place + 1 : place + 2]), "")
        value = shlex.quote(value) if value and not value.startswith("--") else "VALUE"
        if self._sets:
            name = nearest(option.lstrip("-"), _settings(words))
            if name is not None:
                return f"{option} is no option, but {name} is a setting: give {name}={value}, or --set {name}={value}."
        near = nearest(option.lstrip("-"), [each.lstrip("-") for each in known])
        fix = f"did you mean --{near}?" if near else f"atmosbox {self.name} --help shows all"
        if self._sets and near is None:
            fix += f"; a setting is given as {option.lstrip('-')}={value}"
        return f"atmosbox {self.name} has no option {option}: {fix}" + ("" if near else ".")


def _settings(words: Sequence[str]) -> list[str]:
    """Return the names of the settings of the scene that was typed; none if no scene was."""
    from atmosbox import scenarios

    for word in words:
        with contextlib.suppress(AtmosboxError):
            if not word.startswith("-"):
                return [parameter.name for parameter in scenarios.load(word).Settings.describe()]
    return []


def _refuse_blanks(words: Sequence[str]) -> None:
    """Refuse NAME = VALUE, written with blanks, which the shell takes apart."""
    for k, word in enumerate(words):
        after = next(iter(words[k + 1 : k + 2]), "")
        if word.startswith("=") and k:
            name, value = words[k - 1], word[1:] or after
        elif re.fullmatch(r"[A-Za-z][\w-]*=", word) and after and not after.startswith("--"):
            name, value = word[:-1], after
        else:
            continue
        if name.isidentifier() and value:
            raise OneSentence(f"{name} = {shown(value)} is written with blanks: write {name}={shlex.quote(value)}.")


@contextlib.contextmanager
def one_sentence(command: Command, words: Sequence[str]) -> Iterator[None]:
    """Turn an error of the parser into one sentence."""
    try:
        yield
    except OneSentence:
        raise
    except UsageError as error:
        raise OneSentence(command.sentence(error, words)) from error


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
    elif name == "help":
        meant = [*rest[:1], "--help"]
    else:
        near = nearest(name, commands) or ("run" if set(rest) & set(scenarios.names()) else None)
        if near is None:
            return OneSentence(f"There is no command {shown(name)}: atmosbox --help shows all.")
        meant = [near, *rest]
    return OneSentence(f"There is no command {shown(name)}: did you mean {shlex.join(['atmosbox', *meant])}?")

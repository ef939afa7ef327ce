"""What goes to which stream, and how an error ends a command: with one sentence and a status."""

from __future__ import annotations

import contextlib
import functools
import json
import math
import os
import shutil
import sys
import traceback
from collections.abc import Callable, Mapping
from typing import Any, ParamSpec, TextIO, TypeVar

import typer

from atmosbox.errors import AtmosboxError, shown

INTERRUPTED = 130  # what a shell reports of a program that Ctrl-C ended
TERMINATED = 143  # what a shell reports of a program that was asked to end
ENDLESS = 1_000_000  # columns of what is no terminal
LONGEST_SENTENCE = 20_000  # characters; paths may have 4096

P = ParamSpec("P")
R = TypeVar("R")


def say(text: str) -> None:
    r"""Write a line or more of the result to stdout.

    A reader that has seen enough and closed the pipe changes nothing about what the command does.

    Parameters
    ----------
    text
        The lines, without the last line's end.

    Raises
    ------
    AtmosboxError
        If stdout cannot be written, for instance because it goes to a disk that is full.

    Examples
    --------
    >>> say("two\nlines")
    two
    lines
    """
    try:
        _write(sys.stdout, text)
    except BrokenPipeError:
        # What Python still flushes at its end must go somewhere.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except OSError as error:
        sys.stdout = None  # so that Python's end does not fail once more
        raise AtmosboxError(f"The result cannot be written to stdout: {error.strerror}.") from error


def tell(text: str) -> None:
    """Write a line that is not the result to stderr."""
    with contextlib.suppress(OSError):  # no reader may be left
        _write(sys.stderr, text)


def _write(stream: TextIO | None, text: str) -> None:
    """Write a line and flush it; what the encoding lacks is spelled out."""
    if stream is None:  # the shell closed it
        return
    line = f"{text}\n"
    try:
        line.encode(stream.encoding or "utf-8", stream.errors or "strict")
    except UnicodeEncodeError:
        spelled = line.replace("±", "+-").replace("σ", " sigma")
        line = spelled.encode(stream.encoding, "backslashreplace").decode(stream.encoding)
    stream.write(line)
    stream.flush()


def say_json(content: Mapping[str, Any]) -> None:
    """Write the result as one JSON object; a number that is not finite becomes null.

    Examples
    --------
    >>> say_json({"value": float("nan"), "unit": "K"})
    {
      "value": null,
      "unit": "K"
    }
    """
    say(json.dumps(_finite(content), indent=2, allow_nan=False))


def _finite(content: Any) -> Any:
    """Return what JSON can hold of a value."""
    if isinstance(content, Mapping):
        return {str(name): _finite(value) for name, value in content.items()}
    if isinstance(content, list | tuple):
        return [_finite(value) for value in content]
    return None if isinstance(content, float) and not math.isfinite(content) else content


def prints_to_stderr() -> contextlib.AbstractContextManager[object]:
    """Keep what a scene of a user's own prints out of the result."""
    return contextlib.redirect_stdout(sys.stderr)


def width() -> int:
    """Return how many columns the result may take: those of the terminal, or of COLUMNS if that is set."""
    tty = sys.stdout is not None and sys.stdout.isatty()
    return shutil.get_terminal_size().columns if tty or os.environ.get("COLUMNS", "").isdecimal() else ENDLESS


def guarded(command: Callable[P, R]) -> Callable[P, R]:
    """Return a command that ends with one sentence and a status, whatever goes wrong in it.

    Parameters
    ----------
    command
        The function; its option ``verbose``, if it has one, asks for the traceback of a bug.

    Raises
    ------
    typer.Exit
        With the status of the error.
    """

    @functools.wraps(command)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            return command(*args, **kwargs)
        except (typer.Exit, typer.Abort, typer.BadParameter):
            raise
        except AtmosboxError as error:
            # The name of a file may hold anything, but a sentence stands on one line.
            tell(f"error: {shown(str(error), longest=LONGEST_SENTENCE)}")
            raise typer.Exit(error.exit_code) from error
        except KeyboardInterrupt as error:
            tell("stopped")
            raise typer.Exit(getattr(error, "exit_code", INTERRUPTED)) from error
        except MemoryError as error:
            tell("error: This computer has not enough memory for it: give fewer molecules.")
            raise typer.Exit(1) from error
        except Exception as error:
            if kwargs.get("verbose"):
                tell(traceback.format_exc())
            reason = " ".join(str(error).split())
            what = type(error).__name__ + (f": {shown(reason, longest=200)}" if reason else "")
            again = "" if kwargs.get("verbose") else "; --verbose shows where"
            tell(f"error: This is a bug in atmosbox or in your own scene ({what}){again}.")
            raise typer.Exit(1) from error

    return wrapper

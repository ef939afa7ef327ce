"""What goes to which stream, and how an error ends a command: with one sentence and a status."""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
import sys
import traceback
from collections.abc import Callable
from typing import ParamSpec, TypeVar

import typer

from atmosbox.errors import AtmosboxError, shown
from atmosbox.text.stream import say, say_json, tell

__all__ = ["guarded", "prints_to_stderr", "say", "say_json", "tell", "width"]

INTERRUPTED = 130  # what a shell reports of a program that Ctrl-C ended
TERMINATED = 143  # what a shell reports of a program that was asked to end
ENDLESS = 1_000_000  # columns of what is no terminal
LONGEST_SENTENCE = 20_000  # characters; paths may have 4096

P = ParamSpec("P")
R = TypeVar("R")


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

"""How an error ends a command: with one sentence on stderr and an exit status."""

import contextlib
import functools
import os
import shutil
import signal
import sys
import threading
import traceback
from collections.abc import Callable, Iterator
from typing import Any, Never, ParamSpec, TypeVar

import typer

from atmosbox.errors import AtmosboxError, FileError, on_command_line, shown
from atmosbox.text.stream import say, say_json, tell

__all__ = ["guarded", "prints_to_stderr", "say", "say_json", "stoppable", "tell", "width"]

INTERRUPTED = 130  # exit status, as shells report it, of a program that Ctrl-C ended
ENDLESS = 1_000_000  # columns if the output is not a terminal
LONGEST_SENTENCE = 20_000  # characters; paths may have 4096

P = ParamSpec("P")
R = TypeVar("R")


def prints_to_stderr() -> contextlib.AbstractContextManager[object]:
    """Send what a user's own scene prints to stderr, so that it does not get into the result."""
    return contextlib.redirect_stdout(sys.stderr)


def width() -> int:
    """Return the number of columns that the result may take: those of the terminal, or COLUMNS if that is set."""
    tty = sys.stdout is not None and sys.stdout.isatty()
    return shutil.get_terminal_size().columns if tty or os.environ.get("COLUMNS", "").isdecimal() else ENDLESS


def _reason(error: Exception) -> str:
    """Return the reason of an error in one short line."""
    text = str(error.args[0] if isinstance(error, KeyError) and error.args else error)
    reason = " ".join(text.split()).rstrip(".")
    return type(error).__name__ + (f": {shown(reason, longest=200)}" if reason else "")


class Stopped(KeyboardInterrupt):
    """Another program asked this one to end, or its terminal was closed; the exit status is that of a shell."""

    def __init__(self, exit_code: int) -> None:
        super().__init__()
        self.exit_code = exit_code


@contextlib.contextmanager
def stoppable() -> Iterator[None]:
    """Make Ctrl-C, a request to end (SIGTERM) and the closing of the terminal (SIGHUP) stop a command.

    The command then removes files that are half written, and keeps what is complete. Python drops an exception that is
    raised in a function which a C library calls, as LLVM does while it compiles: such a signal is sent again. If it
    gets lost in another way, the block raises `Stopped` at its end.
    """
    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    usual = (signal.SIG_DFL, signal.default_int_handler)
    main = threading.current_thread() is threading.main_thread()
    before = {number: handler for number in numbers if main and (handler := signal.getsignal(number)) in usual}
    came: list[int] = []
    sent: list[threading.Timer] = []
    hook = sys.unraisablehook

    def stop(number: int, frame: object) -> Never:
        came.append(number)
        raise Stopped(128 + number)

    def dropped(what: "sys.UnraisableHookArgs") -> None:
        if isinstance(what.exc_value, Stopped):
            sent.append(threading.Timer(0.05, signal.raise_signal, [came[-1]]))
            sent[-1].start()
        else:
            hook(what)

    for number in before:
        signal.signal(number, stop)
        sys.unraisablehook = dropped
    try:
        yield
        if came:
            raise Stopped(128 + came[-1])
    finally:
        for timer in sent:
            timer.cancel()
            timer.join()
        for number, handler in before.items():
            signal.signal(number, handler)
            sys.unraisablehook = hook


def guarded(command: Callable[P, R]) -> Callable[P, R]:
    """Return a command that ends with one sentence and an exit status, whatever goes wrong in it.

    Its option ``verbose``, if it has one, shows the traceback of a bug.
    """

    @functools.wraps(command)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            with stoppable():
                return command(*args, **kwargs)
        except (typer.Exit, typer.Abort, typer.BadParameter):
            raise
        except AtmosboxError as error:
            # A file name may contain anything, even a new line, but the message must be one line.
            tell(f"error: {shown(error.said(on_command_line), longest=LONGEST_SENTENCE)}")
            raise typer.Exit(error.exit_code) from error
        except KeyboardInterrupt as error:
            tell("stopped")
            raise typer.Exit(getattr(error, "exit_code", INTERRUPTED)) from error
        except MemoryError as error:
            tell("error: This computer has not enough memory for this: give fewer molecules.")
            raise typer.Exit(1) from error
        except Exception as error:
            from atmosbox import scenarios

            if kwargs.get("verbose"):
                tell(traceback.format_exc())
            options: dict[str, Any] = kwargs
            given = [*(options.get(name) for name in ("file", "resume", "source")), *options.get("files", ())]
            read = [str(file) for file in given if file is not None]
            scene = str(kwargs.get("scene") or "")
            own = scenarios.place(error) or (scene if scene.endswith(".py") else None)
            reason = _reason(error)
            said = f"This is a bug in atmosbox ({reason})"
            if read:  # the file may have the names that atmosbox writes, but values that it never writes
                named = shown(" or ".join(read), longest=LONGEST_SENTENCE)
                said = f"{named} cannot be used ({reason}): it is not as atmosbox has written it, or this is a bug"
            elif own is not None:
                said = f"{shown(own, longest=4096)} cannot be run ({reason}): correct it and run it again"
            tell(f"error: {said}{'' if kwargs.get('verbose') else '; --verbose shows where'}.")
            raise typer.Exit(FileError.exit_code if read or own is not None else 1) from error

    return wrapper

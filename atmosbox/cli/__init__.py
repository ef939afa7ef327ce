"""The command line: it parses and calls, and decides nothing.

Each command is one file: its options on top, below what it does. A new file is a new command. They share

`application`  what all commands belong to
`option`       the options that several commands have
`request`      where the settings of a run come from: the command line, a `config` file, an earlier run
`output_name`  the file that is written where no name is given
`expectation`  the errors that were to be expected
`terminal`     how an error ends a command

What comes out, as text and as JSON, its tables, streams and the bar stand in `atmosbox.text`, which Python uses too.

The result goes to stdout and everything else to stderr. The exit status is 0 if all went well, 1 if something
failed, 2 if the request was wrong, 3 if a physics check failed, 130 after Ctrl-C and 143 after a request to
terminate.
"""

import atexit
import importlib
import pkgutil
import signal
import sys
import warnings

from atmosbox.cli.application import app

__all__ = ["app", "main"]

for _file in pkgutil.iter_modules(__path__):
    importlib.import_module(f"atmosbox.cli.{_file.name}")


def main() -> None:
    """Run the command line; this is what the program atmosbox calls.

    Raises
    ------
    SystemExit
        With the status of the command.
    """
    warnings.formatwarning = lambda message, *rest, **named: f"warning: {message}\n"
    # Python's own tidying up is no part of the command: Ctrl-C would change the status of what is done
    atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)
    try:
        app(prog_name="atmosbox")
    except KeyboardInterrupt:
        sys.exit(130)

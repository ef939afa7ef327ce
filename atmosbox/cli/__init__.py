"""The command line: it parses what was typed and calls other modules, which do the work.

Each command is one file: its options on top, below them what it does. A new one is named in `_COMMANDS`. They share

`application`  the Typer application that all commands belong to
`option`       the options that several commands have, and the output file if no name is given
`request`      where the settings of a run come from: the command line, a settings file, an earlier run
`expectation`  the expected errors of a run
`usage`        what was typed: NAME=VALUE as a setting, and one sentence for what cannot be understood
`terminal`     how an error ends a command

Results as text and as JSON, tables, streams and the progress bar are in `atmosbox.text`, which Python uses too.

The result goes to stdout and everything else to stderr. The exit status is 0 if all went well, 1 if something
failed, 2 if the request was wrong, 3 if a physics check failed, 130 after Ctrl-C, 143 after a request to
terminate and 129 when the terminal is closed.
"""

import atexit
import importlib
import os
import signal
import sys
import threading
import warnings

# Ctrl-C while the program is being loaded ends it at once, without a traceback
_in_main = threading.current_thread() is threading.main_thread()
_loading = _in_main and signal.getsignal(signal.SIGINT) is signal.default_int_handler
if _loading:
    signal.signal(signal.SIGINT, signal.SIG_DFL)

# The matrices of the theory are small: several threads only wait for each other, and the last digit would depend on
# their number. OpenBLAS reads this when numpy is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from atmosbox.cli.application import app  # noqa: E402
from atmosbox.text.stream import tell  # noqa: E402

__all__ = ["app", "main"]

_COMMANDS = "list_scenes info run sweep tradeoff plot view live lab animate compare export sheet check prepare"
"""The files of the commands in the order of the help: what a beginner needs first."""

for _file in _COMMANDS.split():
    importlib.import_module(f"atmosbox.cli.{_file}")

if _loading:
    signal.signal(signal.SIGINT, signal.default_int_handler)


def main() -> None:
    """Run the command line: the entry point of the program atmosbox.

    Raises
    ------
    SystemExit
        With the status of the command.
    """
    warnings.formatwarning = lambda message, *rest, **named: f"warning: {message}\n"
    # when Python cleans up at exit, the command is done: Ctrl-C must not change its exit status any more
    atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)
    try:
        app(prog_name="atmosbox")
    except KeyboardInterrupt:
        sys.exit(130)
    except OSError as error:  # typer prints the help by itself
        sys.stdout = None  # so that the flush when Python exits does not fail again
        tell(f"error: The help cannot be written to stdout: {error.strerror}.")
        sys.exit(1)

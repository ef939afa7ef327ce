"""The command line: it parses and calls, and decides nothing.

Read in this order: `command` (the commands and their options), `request` (where the settings of a run come
from), `run`, `check` and `scene` (what the commands do), `report` (what comes out, as text and as JSON),
`table` (columns and numbers), `progress` (the bar), `terminal` (streams, and how an error ends a command).

The result goes to stdout and everything else to stderr. The exit status is 0 if all went well, 1 if something
failed, 2 if the request was wrong, 3 if a physics check failed, 130 after Ctrl-C and 143 after a request to
terminate.
"""

from atmosbox.cli.application import app
from atmosbox.cli.command import main

__all__ = ["app", "main"]

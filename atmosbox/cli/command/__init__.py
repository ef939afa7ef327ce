"""The commands of atmosbox and their options, one file each, in the order in which ``--help`` lists them."""

import sys
import warnings

from atmosbox.cli.application import app

from atmosbox.cli.command import listing, run, tradeoff, plot, check  # isort: skip

__all__ = ["check", "listing", "main", "plot", "run", "tradeoff"]


def main() -> None:
    """Run the command line; this is what the program atmosbox calls.

    Raises
    ------
    SystemExit
        With the status of the command.
    """
    warnings.formatwarning = lambda message, *rest, **named: f"warning: {message}\n"
    try:
        app(prog_name="atmosbox")
    except KeyboardInterrupt:
        sys.exit(130)

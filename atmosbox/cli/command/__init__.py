"""The commands of atmosbox and their options, one file each, in the order in which ``--help`` lists them."""

import sys
import warnings

from atmosbox.cli.application import app

from atmosbox.cli.command import listing, run, sweep, tradeoff, plot, view, live, animate, compare, sheet, check  # isort: skip

__all__ = [
    "animate",
    "check",
    "compare",
    "listing",
    "live",
    "main",
    "plot",
    "run",
    "sheet",
    "sweep",
    "tradeoff",
    "view",
]


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

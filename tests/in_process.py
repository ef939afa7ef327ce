"""Commands in the process of the test; the command line is built once, which takes longer than most commands."""

import pytest
import typer
from typer import testing

from atmosbox.cli import app

COMMAND = typer.main.get_command(app)


def typed(*words, **environment):
    """Type a command, and return its result."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(testing, "_get_command", lambda app: COMMAND)
        return testing.CliRunner().invoke(app, [*map(str, words)], env=environment)


def refused(result):
    """Return the one sentence with which a command was refused."""
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    (line,) = result.stderr.splitlines()
    assert line.startswith("error: ")
    return line

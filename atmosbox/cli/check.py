"""The command ``check``: verify the physics in a file."""

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Json, RunFile
from atmosbox.cli.terminal import say, say_json, width
from atmosbox.errors import PhysicsError
from atmosbox.text.table import table


@command("atmosbox check lifting-dry.nc", "atmosbox check lifting-dry.nc --json")
def check(file: RunFile, as_json: Json = False) -> None:
    """Verify the physics in a file.

    Is the energy budget closed, and does the run agree with theory? The exit status is 3 if anything fails.
    """
    from atmosbox.file.netcdf import read
    from atmosbox.simulation.verification import verify

    checks = verify(read(file))
    passed = all(one.passed for one in checks)
    if as_json:
        say_json({"file": file, "passed": passed, "checks": [one._asdict() for one in checks]})
    else:
        rows = [["ok" if one.passed else "FAILED", one.name, one.sentence] for one in checks]
        say("\n".join(table(["", "", ""], rows, width())))
    if not passed:
        raise typer.Exit(PhysicsError.exit_code)

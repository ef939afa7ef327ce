"""The command ``check``: verify the physics and the CF conventions of a file."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Json, RunFile
from atmosbox.cli.terminal import say, say_json, width
from atmosbox.errors import PhysicsError
from atmosbox.text.table import table

CONVENTION = "cf:1.11"
CHECKER = "compliance-checker"


@command("atmosbox check lifting-dry.nc", "atmosbox check lifting-dry.nc --json")
def check(
    file: RunFile,
    as_json: Json = False,
) -> None:
    """Verify the physics in a file.

    Is the energy budget closed, does the run agree with theory, does the file keep to the CF conventions? The exit
    status is 3 if anything fails.
    """
    from atmosbox.file.netcdf import read
    from atmosbox.simulation import runner

    checks = runner.verify(read(file))
    cf = conventions(Path(file))
    passed = all(one.passed for one in checks) and cf.passed is not False
    if as_json:
        listed = [{"name": c.name, "passed": bool(c.passed), "sentence": c.sentence} for c in checks]
        say_json({"file": file, "passed": passed, "checks": listed, "conventions": cf._asdict()})
    else:
        verdict = {True: "ok", False: "FAILED", None: "not tried"}
        rows = [[verdict[bool(one.passed)], one.name, one.sentence] for one in checks]
        rows.append([verdict[cf.passed], "conventions", cf.sentence])
        say("\n".join(table(["", "", ""], rows, width())))
    if not passed:
        raise typer.Exit(PhysicsError.exit_code)


class Conventions(NamedTuple):
    """Whether a file follows the CF conventions; ``passed`` is None if that could not be checked."""

    passed: bool | None
    sentence: str


def conventions(path: Path) -> Conventions:
    """Check with the program compliance-checker, if it is installed, whether a file follows CF-1.11."""
    # A compliance-checker beside this Python is preferred to another that a shell would find.
    places = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    program = shutil.which(CHECKER, path=places)
    if program is None:
        return Conventions(None, f"{CHECKER} is not installed: type pip install 'atmosbox[test]'")
    command = [program, "-t", CONVENTION, "-c", "strict", "-f", "json", "-o", "-", str(path.resolve())]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", check=False)
    last = (done.stderr.strip() or done.stdout.strip() or "it says nothing").splitlines()[-1]
    try:
        found = _messages(json.loads(done.stdout)[CONVENTION])
    except (ValueError, KeyError, TypeError):
        return Conventions(None, f"{CHECKER} does not work here: {last}")
    if found:
        return Conventions(False, "; ".join(found))
    if done.returncode:  # it found nothing wrong, but one of its own tests has failed
        return Conventions(None, f"{CHECKER} does not work for this file: {last}")
    return Conventions(True, "the file follows the CF-1.11 conventions")


def _messages(report: dict[str, Any]) -> list[str]:
    """Return the messages of the compliance-checker about what is wrong."""
    parts = [entry for rank in ("high", "medium", "low") for entry in report[f"{rank}_priorities"]]
    wrong = [part for part in parts if part["value"][0] < part["value"][1]]
    return [f"{part['name']}: {message}" for part in wrong for message in part["msgs"] or ["not kept"]]

"""What ``atmosbox check`` does: verify the physics in a file, and that it keeps to the CF conventions."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import typer

from atmosbox.cli.table import table
from atmosbox.cli.terminal import say, say_json, width
from atmosbox.errors import PhysicsError

CONVENTION = "cf:1.11"
CHECKER = "compliance-checker"


class Conventions(NamedTuple):
    """Whether a file keeps to the CF conventions; ``passed`` is None where nothing could tell."""

    passed: bool | None
    sentence: str


def conventions(path: Path) -> Conventions:
    """Ask the compliance-checker, if there is one, whether a file keeps to CF-1.11.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Conventions
        What it found.
    """
    # The one beside this Python is preferred to another that a shell would find.
    places = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", os.defpath)])
    program = shutil.which(CHECKER, path=places)
    if program is None:
        return Conventions(None, f"{CHECKER} is not installed: type pip install 'atmosbox[test]'")
    command = [program, "-t", CONVENTION, "-c", "strict", "-f", "json", "-o", "-", str(path.resolve())]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", errors="replace", check=False)
    try:
        found = _messages(json.loads(done.stdout)[CONVENTION])
    except (ValueError, KeyError, TypeError):
        last = (done.stderr.strip() or done.stdout.strip() or "it says nothing").splitlines()[-1]
        return Conventions(None, f"{CHECKER} does not work here: {last}")
    if done.returncode == 0 and not found:
        return Conventions(True, "the file keeps to the CF-1.11 conventions, to the letter")
    return Conventions(False, "; ".join(found) or f"{CHECKER} finds fault with the file")


def _messages(report: dict[str, Any]) -> list[str]:
    """Return what the compliance-checker finds wrong."""
    parts = [entry for rank in ("high", "medium", "low") for entry in report[f"{rank}_priorities"]]
    return [
        f"{part['name']}: {message}"
        for part in parts
        if part["value"][0] < part["value"][1]
        for message in part["msgs"] or ["not kept"]
    ]


def check(file: str, *, as_json: bool) -> None:
    """Verify a file and say what was found.

    Parameters
    ----------
    file
        The file of a run.
    as_json
        Whether to say it as JSON.

    Raises
    ------
    FileError
        If the file cannot be read.
    typer.Exit
        With the status of a physics check that failed, if anything did.
    """
    from atmosbox import runner
    from atmosbox.output import read

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

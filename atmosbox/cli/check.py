"""The command ``check``: verify the physics and the CF conventions of a file, or the engines in extreme cases."""

from __future__ import annotations

import dataclasses
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Json, Verbose
from atmosbox.cli.terminal import say, say_json, width
from atmosbox.errors import PhysicsError, SettingError
from atmosbox.text.progress import progress
from atmosbox.text.table import table

if TYPE_CHECKING:
    from atmosbox.trade.extremes import Finding

CONVENTION = "cf:1.11"
CHECKER = "compliance-checker"


@command(
    "atmosbox check lifting-dry.nc",
    "atmosbox check lifting-dry.nc --json",
    "atmosbox check --extremes",
    "atmosbox check --extremes --engine exact --only cradle",
)
def check(
    file: Annotated[
        str | None, typer.Argument(metavar="FILE", help="A file that `atmosbox run` has written.", show_default=False)
    ] = None,
    extremes: Annotated[
        bool, typer.Option("--extremes", help="Test the engines in boxes that break simulations.")
    ] = False,
    engine: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="With --extremes: an engine, with its options; may be repeated."),
    ] = None,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="With --extremes: the name of one case; may be repeated.")
    ] = None,
    every: Annotated[bool, typer.Option("--all", help="With --extremes: also those that take minutes.")] = False,
    as_json: Json = False,
    verbose: Verbose = False,
) -> None:
    """Verify the physics in a file, or the engines in extreme cases.

    Of a file: is the energy budget closed, does the run agree with theory, does the file keep to the CF
    conventions? With --extremes: is each engine right where simulations hang, lose molecules or give wrong
    results? The exit status is 3 if anything fails.
    """
    if extremes:
        _check_extremes(file, engine, only, every=every, as_json=as_json)
        return
    for option, given in (("--engine", engine), ("--only", only), ("--all", every)):
        if given:
            raise SettingError(option, None, "belongs to --extremes", f"give --extremes, or leave {option} out")
    if file is None:
        fix = "give the file of a run, or --extremes for the engines"
        raise SettingError("check", None, "does not know what to verify", fix)
    _check_file(file, as_json=as_json)


def _check_file(file: str, *, as_json: bool) -> None:
    """Verify a file and print the result."""
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
    """Check with the program compliance-checker, if it is installed, whether a file follows CF-1.11.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Conventions
        The result of the check.
    """
    # A compliance-checker beside this Python is preferred to another that a shell would find.
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
    """Return the messages of the compliance-checker about what is wrong."""
    parts = [entry for rank in ("high", "medium", "low") for entry in report[f"{rank}_priorities"]]
    return [
        f"{part['name']}: {message}"
        for part in parts
        if part["value"][0] < part["value"][1]
        for message in part["msgs"] or ["not kept"]
    ]


def _check_extremes(
    file: str | None, engines: Sequence[str] | None, only: Sequence[str] | None, *, every: bool, as_json: bool
) -> None:
    """Run the engines in the extreme cases and print how each fared."""
    if file is not None:
        fix = f"give atmosbox check {file}, or atmosbox check --extremes"
        raise SettingError("--extremes", None, "is about the engines and not about a file", fix)

    from atmosbox.scene import engines as registry
    from atmosbox.scene.spelling import nearest
    from atmosbox.trade.extremes import EXTREMES, assess

    chosen = [registry.choose(name) for name in engines or registry.names()]
    for name in only or ():
        if name not in EXTREMES:
            fix = f"give --only {nearest(name, EXTREMES) or next(iter(EXTREMES))}"
            raise SettingError("--only", name, "is no extreme", fix)
    with progress("extremes", quiet=False) as show:
        heading = [str(choice) for choice in chosen]
        found = list(assess(chosen, only or None, lambda part, _: show(part, "running"), long=every))
    passed = all(one.verdict.passed for one in found)
    if as_json:
        listed = [_as_json(one, heading[k % len(heading)]) for k, one in enumerate(found)]
        say_json({"passed": passed, "engines": heading, "extremes": listed})
    else:
        rows = [_row(found[k : k + len(chosen)]) for k in range(0, len(found), len(chosen))]
        say("\n".join(table(["extreme", *heading, "what was found"], rows, width())))
    if not passed:
        raise typer.Exit(PhysicsError.exit_code)


def _as_json(one: Finding, engine: str) -> dict[str, Any]:
    """Return a finding as a record for JSON."""
    off = None if one.verdict.value is None else one.verdict.off
    about = {"extreme": one.extreme.name, "title": one.extreme.title, "engine": engine}
    return {**about, **dataclasses.asdict(one.verdict), "off": off}


def _row(found: Sequence[Finding]) -> list[str]:
    """Return the table row of one extreme case: the verdict on each engine, and the sentences."""
    said = [
        (f"{one.engine}: " if len(found) > 1 else "") + one.verdict.told
        for one in found
        if len(found) == 1 or one.verdict.outcome != "right"
    ]
    cells = [str(one.verdict) if one.verdict.passed else "WRONG" for one in found]
    return [found[0].extreme.name, *cells, "; ".join(said) or found[0].verdict.told]

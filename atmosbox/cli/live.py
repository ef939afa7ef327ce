"""The command ``live``: run a box, and serve the page on which a class can change it."""

from __future__ import annotations

import asyncio
import os
import secrets
import signal
import socket
import sys
import threading
import webbrowser
from pathlib import Path
from typing import Annotated

import typer

from atmosbox.cli.application import command, typed
from atmosbox.cli.option import (
    Accuracy,
    Config,
    Engine,
    Language,
    SceneName,
    Seed,
    Source,
    Values,
    Verbose,
    out_option,
    quiet_option,
)
from atmosbox.cli.output_name import netcdf_name
from atmosbox.cli.request import checked, gather
from atmosbox.cli.terminal import INTERRUPTED, TERMINATED, prints_to_stderr, say, tell
from atmosbox.errors import SettingError


@command(
    "atmosbox live temperature",
    "atmosbox live lifting-dry --set molecules=2000 --no-browser",
    "atmosbox live temperature --language de",
    "atmosbox live atmosphere --port 9000 --out column.nc",
)
def live(
    ctx: typer.Context,
    scene: Annotated[str | None, SceneName] = None,
    values: Values = None,
    config: Config = None,
    source: Source = None,
    seed: Seed = None,
    engine: Engine = None,
    accuracy: Accuracy = None,
    out: Annotated[
        str | None, out_option("Where the record button writes.  [default: SCENE-live.nc in this folder]")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Recordings may replace files.")] = False,
    save_molecules: Annotated[
        bool, typer.Option("--save-molecules", help="Recordings say where every molecule is, for atmosbox view.")
    ] = False,
    host: Annotated[
        str, typer.Option(metavar="ADDRESS", help="Who can reach the page; by default this computer alone.")
    ] = "127.0.0.1",
    port: Annotated[
        str | None, typer.Option(metavar="N", help="Port of the page.  [default: the first free one from 8642 on]")
    ] = None,
    no_token: Annotated[
        bool,
        typer.Option(
            "--no-token", help="Let in anybody who can reach the port, also without the token of the address."
        ),
    ] = False,
    language: Language = "auto",
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Only say where the page is.")] = False,
    quiet: Annotated[bool, quiet_option("Print the address, no more.")] = False,
    verbose: Verbose = False,
) -> None:
    """Play with a scene on a local page: change one thing at a time, and see what follows.

    The page shows molecules and graphs while the engine runs. Its record button writes the same netCDF file as
    run. While no page is open, the box is paused, unless it is being recorded.

    The address has a token that is new each time, so that another account of this computer cannot steer the box.
    """
    number = _port(port)

    asked = gather(scene, values or (), config, source, seed, save_molecules or None, engine, accuracy)
    asked = asked._replace(save_molecules=asked.save_molecules is True)
    prepared = checked(asked)
    folder, name = _place(out, prepared.scene, force=force)

    from atmosbox.live import Session
    from atmosbox.live.server import PORT, loopback, serve_session
    from atmosbox.page import live_page
    from atmosbox.simulation.compilation import told
    from atmosbox.text.progress import progress

    with prints_to_stderr(), progress(prepared.scene, quiet=quiet) as show, told(prepared, show):
        session = Session(prepared, folder=folder, out=name, force=force, command=typed(ctx))

    def opened(address: str, used: int) -> None:
        say(address)
        sys.stdout.flush()
        if number is None and used != PORT:
            tell(f"note: port {PORT} is in use, so the page is at port {used}")
        if not loopback(host):
            elsewhere = f"http://{socket.gethostname()}:{used}/" + (f"?token={token}" if token else "")
            who = "reaches this computer and knows the address" if token else "can reach this computer"
            tell(f"warning: who {who} can use this page, at {elsewhere}")
        if not no_browser and _display():
            threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        elif not quiet:
            tell(f"open {address} in a browser")
        if not quiet:
            tell("Ctrl-C ends it; what is being recorded is saved")

    token = None if no_token else secrets.token_urlsafe(16)
    page = live_page(language=language)
    served = serve_session(session, page, host=host, port=number, token=token, opened=opened)
    ended, left = asyncio.run(served)
    for sentence in left:
        tell(sentence)
    raise typer.Exit(TERMINATED if ended == signal.SIGTERM else INTERRUPTED)


def _port(text: str | None) -> int | None:
    """Return the port that was asked for."""
    if text is None:
        return None
    if not text.isdecimal() or not 1 <= int(text) <= 65_535:
        raise SettingError("port", text, "is no whole number from 1 to 65535", "give --port 8642")
    return int(text)


def _place(out: str | None, scene: str, *, force: bool) -> tuple[Path, str | None]:
    """Return the folder of the recordings, and the name of the first."""
    if out is None:
        return Path(), None
    from atmosbox.file.output_path import check_writable

    path = check_writable(netcdf_name(Path(out)), force)
    return path.parent, path.name


def _display() -> bool:
    """Return whether there is a screen on which a browser can open; a browser inside the terminal is not wanted."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))

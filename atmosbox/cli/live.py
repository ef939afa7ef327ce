"""What ``atmosbox live`` does: let a box run, and serve the page on which a class plays with it."""

from __future__ import annotations

import contextlib
import os
import shlex
import signal
import socket
import sys
import threading
import webbrowser
from collections.abc import Sequence
from pathlib import Path

import typer

from atmosbox.cli.request import Request
from atmosbox.cli.run import TERMINATED, checked_path
from atmosbox.cli.terminal import INTERRUPTED, say, tell
from atmosbox.errors import SettingError

HOST = "127.0.0.1"


def live(
    request: Request,
    *,
    words: Sequence[str],
    out: str | None = None,
    force: bool = False,
    host: str = HOST,
    port: str | None = None,
    browser: bool = True,
    quiet: bool = False,
) -> None:
    """Serve the page of a scene until Ctrl-C.

    Parameters
    ----------
    request
        The scene and its settings.
    words
        What was typed, for the history of recordings.
    out, force
        The file of the first recording, and whether recordings may replace files.
    host, port
        Where the page is.
    browser
        Whether a browser is opened.
    quiet
        Whether no more than the address is said.

    Raises
    ------
    AtmosboxError
        If something is refused or fails.
    typer.Exit
        With the status of an interruption.
    """
    number = _port(port)

    from atmosbox.simulation import runner

    scene, settings, engine, molecules, accuracy = request.gather()
    with contextlib.redirect_stdout(sys.stderr):
        prepared = runner.prepare(scene, settings, engine=engine, accuracy=accuracy, save_molecules=molecules)
    folder, name = _place(out, prepared.scene, force=force)

    from atmosbox.live import Session
    from atmosbox.live.server import PORT, loopback, run
    from atmosbox.page import live_page

    if not quiet:
        tell("compiling the engine, once")
    command = shlex.join(words).encode("utf-8", "backslashreplace").decode("utf-8")
    with contextlib.redirect_stdout(sys.stderr):
        session = Session(prepared, folder=folder, out=name, force=force, command=command)

    def opened(address: str, used: int) -> None:
        say(address)
        sys.stdout.flush()
        if number is None and used != PORT:
            tell(f"note: port {PORT} is in use, so the page is at port {used}")
        if not loopback(host):
            tell(f"warning: who can reach this computer can use this page, at http://{socket.gethostname()}:{used}/")
        if browser and _display():
            threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        elif not quiet:
            tell(f"open {address} in a browser")
        if not quiet:
            tell("Ctrl-C ends it; what is being recorded is saved")

    ended, left = run(session, live_page(), host=host, port=number, opened=opened)
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

    path = check_writable(checked_path(out, scene), force)
    return path.parent, path.name


def _display() -> bool:
    """Return whether there is a screen on which a browser could open; in a terminal none should."""
    if sys.platform in ("darwin", "win32"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))

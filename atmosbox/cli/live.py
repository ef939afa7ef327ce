"""The command ``live``: open the page in which a scene runs, and make a plan whenever a setting is changed there."""

import os
import secrets
import sys
import threading
import webbrowser
from typing import Annotated

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Language, Sought, switch, text
from atmosbox.cli.request import checked, gather, with_fewer_molecules
from atmosbox.cli.terminal import prints_to_stderr, say, tell
from atmosbox.errors import Option, SettingError


@command(
    "atmosbox live temperature",
    "atmosbox live lifting-dry --set molecules=2000 --no-browser",
    "atmosbox live temperature --language de",
    "atmosbox live atmosphere --port 9000",
)
def live(
    sought: Sought,
    port: Annotated[int | None, text("N", "Port of the page.  [default: the first free one from 8642 on]")] = None,
    no_token: Annotated[
        bool, switch("--no-token", "Let anybody on this computer open the page, without the token.")
    ] = False,
    language: Language = "auto",
    no_browser: Annotated[bool, switch("--no-browser", "Only print the address of the page.")] = False,
    quiet: Annotated[bool, switch("--quiet", "Print only the address.")] = False,
) -> None:
    """Open a page in which a scene runs: change one thing at a time and see what happens.

    It is the page of `atmosbox lab`, with more settings: for a changed setting, the page asks atmosbox for a new start.
    Only this computer can open it, and the address has a token that is new each time.
    """
    if port is not None and not 1 <= port <= 65_535:
        raise SettingError("port", port, "is not a port from 1 to 65535", Option("port", 8642))
    prepared = checked(with_fewer_molecules(gather(sought, False)))

    from atmosbox.lab.server import PORT, Server, ended
    from atmosbox.simulation.compilation import told
    from atmosbox.text.progress import progress

    token = None if no_token else secrets.token_urlsafe(16)
    with prints_to_stderr(), progress(prepared.scene, quiet=quiet) as show, told(show):
        server = Server(prepared, port=port, token=token, language=language)

    def opened() -> None:
        say(server.address)
        used = server.server_address[1]
        if port is None and used != PORT:
            tell(f"note: port {PORT} is in use, so the page is at port {used}")
        if not no_browser and _display():
            threading.Thread(target=webbrowser.open, args=(server.address,), daemon=True).start()
        elif not quiet:
            tell(f"open {server.address} in a browser")
        if not quiet:
            tell("Ctrl-C ends it")

    with server:
        number = ended(server, opened)
    raise typer.Exit(128 + number)


def _display() -> bool:
    """Return whether there is a screen on which a browser can open; a browser inside the terminal is not wanted."""
    return sys.platform in ("darwin", "win32") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))

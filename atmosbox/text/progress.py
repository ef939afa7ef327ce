"""The progress of a run: on a terminal a bar with the remaining time, elsewhere a line for a step that takes long."""

import contextlib
import os
import sys
import threading
from collections.abc import Callable, Iterator

from atmosbox.text.stream import tell

DELAY = 1.0  # seconds after which the name of a step is shown
SILENT = ("running", "done")

Show = Callable[[float, str], None]


@contextlib.contextmanager
def progress(scene: str, *, quiet: bool, expected: str = "") -> Iterator[Show]:
    """Show the progress of a run on stderr; yield the function to call with the share that is done and the step.

    A step such as "compiling the engine, once" is shown when it has taken a second, with or without a terminal; an
    engine that was compiled before is ready sooner. `expected` says how long the run will take.
    """
    if quiet:
        yield lambda fraction, doing: None
    elif sys.stderr is not None and sys.stderr.isatty() and os.environ.get("TERM") != "dumb":
        shown = f"{scene}, {expected}" if expected else scene
        with _bar(shown) as (move, name), _patient(lambda doing: name(f"{scene}: {doing}")) as hear:

            def show(fraction: float, doing: str) -> None:
                if hear(doing):
                    name(shown)
                move(fraction)

            yield show
    else:
        with _patient(lambda doing: tell(f"{scene}: {doing}")) as hear:
            yield lambda fraction, doing: (hear(doing), None)[1]


@contextlib.contextmanager
def _patient(announce: Callable[[str], None]) -> Iterator[Callable[[str], bool]]:
    """Yield a function to call with the name of the present step; it returns whether a new step has begun.

    A step is announced only when it has taken `DELAY`.
    """
    now: str = ""
    waiting: threading.Timer | None = None

    def hear(doing: str) -> bool:
        nonlocal now, waiting
        if doing == now:
            return False
        now = doing
        if waiting is not None:
            waiting.cancel()
        if doing not in SILENT:
            waiting = threading.Timer(DELAY, announce, [doing])
            waiting.daemon = True
            waiting.start()
        return True

    try:
        yield hear
    finally:
        if waiting is not None:
            waiting.cancel()


@contextlib.contextmanager
def _bar(scene: str) -> Iterator[tuple[Callable[[float], None], Callable[[str], None]]]:
    """Show a progress bar until the block ends; yield a function that moves it and one that changes its name."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    bar = Progress(
        TextColumn("{task.description}", markup=False),
        BarColumn(bar_width=None),
        TaskProgressColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True, markup=False),
        transient=True,
        auto_refresh=False,  # while the engine computes, no other thread could draw the bar
        expand=True,
    )
    with bar:
        task = bar.add_task(scene, total=1.0)
        yield (
            lambda fraction: bar.update(task, completed=min(max(fraction, 0.0), 1.0), refresh=True),
            lambda name: bar.update(task, description=name, refresh=True),
        )

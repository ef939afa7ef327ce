"""The command ``prepare``: compile the engine in advance, so that the first run of a scene need not wait."""

import time
from collections.abc import Iterator
from typing import Annotated

import typer

from atmosbox.cli.application import command
from atmosbox.cli.option import Json, switch
from atmosbox.cli.terminal import say, say_json, width
from atmosbox.errors import EngineError
from atmosbox.text.progress import progress
from atmosbox.text.table import table

Work = tuple[str, str]


@command("atmosbox prepare", "atmosbox prepare lifting-dry")
def prepare(
    scenes: Annotated[
        list[str] | None,
        typer.Argument(metavar="[SCENE]...", help="Which scenes; all that come with atmosbox if none is named."),
    ] = None,
    as_json: Json = False,
    quiet: Annotated[bool, switch("--quiet", "Print only the folder of the machine code.")] = False,
) -> None:
    """Compile the engine for all scenes, on all cores.

    Each command compiles what it needs, once; prepare does so in advance, for instance before a class.
    """
    from atmosbox import scenarios
    from atmosbox.engine.core.kernel_cache import cache_folder
    from atmosbox.simulation import runner

    code = cache_folder()
    if code is None:
        raise EngineError(
            "Compiled kernels cannot be kept, since no folder can be written: set NUMBA_CACHE_DIR to one."
        )
    own = {name: runner.prepare(name, {}).engine.name for name in scenes or scenarios.names()}
    # a scene with few molecules runs on the exact engine
    asked = [(name, engine) for name, usual in own.items() for engine in dict.fromkeys([usual, "exact"])]
    began = time.perf_counter()
    seconds: dict[Work, float] = {}
    with progress("prepare", quiet=quiet or as_json) as show:
        for each, spent in _compiled(asked):
            seconds[each] = spent
            show(len(seconds) / len(asked), "running")
    waited = time.perf_counter() - began
    folder, size = str(code.parent), sum(file.stat().st_size for file in code.rglob("*") if file.is_file())
    if as_json:
        rows = [{"scene": name, "engine": engine, "seconds": s} for (name, engine), s in seconds.items()]
        say_json({"folder": folder, "bytes": size, "seconds": waited, "compiled": rows})
    elif quiet:
        say(folder)
    else:
        lines = [(name, engine, f"{s:.1f} s" if s else "kept") for (name, engine), s in seconds.items()]
        say("\n".join(table(["scene", "engine", "compiled in"], lines, width())))
        say(f"\nready after {waited:.0f} s; {size / 1e6:.0f} MB of machine code are kept in {folder}")


def _compiled(asked: list[Work]) -> Iterator[tuple[Work, float]]:
    """Compile on all cores; yield each scene and engine with the time [s]."""
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    from atmosbox.sweep.conduct import cores

    # separate processes, since the compiler holds the lock of the Python interpreter (GIL)
    with ProcessPoolExecutor(min(cores(), len(asked)), multiprocessing.get_context("spawn")) as pool:
        try:
            yield from zip(asked, pool.map(_compile, *zip(*asked, strict=True)), strict=True)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def _compile(scene: str, engine: str) -> float:
    """Compile for a scene and an engine in this process."""
    import warnings

    from atmosbox.simulation.compilation import compile_kernels
    from atmosbox.simulation.preparation import prepare as prepared

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return compile_kernels(prepared(scene, {}, engine=engine))

"""The page in which a scene runs, as an HTML file, which is written whole or not at all."""

from __future__ import annotations

import base64
import gzip
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from atmosbox.file.output_path import check_writable, write_whole
from atmosbox.lab.starts import Start, lab_starts
from atmosbox.lab.wasm_module import module_bytes
from atmosbox.page import lab_page
from atmosbox.simulation.preparation import Prepared

_MOST_BYTES = 231_000
"""Largest size of the module and the starts of a page, compressed [bytes]: the page then stays below 1.5 MB."""


def lab_text(
    prepared: Prepared,
    *,
    theme: str = "auto",
    language: str = "auto",
    others: bool = True,
    progress: Callable[[float, str], None] = lambda share, word: None,
) -> str:
    """Return the HTML of the page that `save_lab` writes; refuse a scene that cannot run in a page.

    >>> from atmosbox.simulation.preparation import prepare
    >>> "WebAssembly" in lab_text(prepare("temperature", {"molecules": 20}), others=False)
    True
    """
    starts, module = lab_starts(prepared, _MOST_BYTES if others else 0, progress)
    return lab_page(*lab_data(starts, module, prepared.scene), theme=theme, language=language)


def lab_data(starts: list[Start], module: str, scene: str, *, level: int = 9) -> tuple[Any, list[Any], str, str]:
    """Return the stage of a page, and as data for it the starts, their module, and their plans and memories.

    ``level`` says how much time to spend on compressing them, from 1 to 9.
    """
    stored = gzip.compress(b"".join(each.stored() for each in starts), level, mtime=0)
    packed = [base64.b64encode(each).decode("ascii") for each in (module_bytes(module, scene), stored)]
    return starts[0].plan["told"]["stage"], [each.size() for each in starts], packed[0], packed[1]


def save_lab(
    prepared: Prepared,
    path: str | os.PathLike[str],
    *,
    theme: str = "auto",
    language: str = "auto",
    others: bool = True,
    force: bool = False,
    progress: Callable[[float, str], None] = lambda share, word: None,
) -> Path:
    """Write the page in which a scene runs.

    Parameters
    ----------
    prepared
        The scene.
    path
        The file; it should end in ``.html``.
    theme : {"auto", "light", "dark"}
        The colours of the page.
    language : {"auto", "en", "de", "es"}
        Its language.
    others
        Whether the page offers other starts too, such as other numbers of molecules.
    force
        Whether a file of that name may be replaced.
    progress
        Function that is called with the share of the page that is filled and the name of the present step.

    Returns
    -------
    pathlib.Path
        The file that was written.

    Raises
    ------
    AtmosboxError
        If the scene cannot run in a page, or the file cannot be written.
    """
    target = check_writable(path, force, example="lab.html")
    text = lab_text(prepared, theme=theme, language=language, others=others, progress=progress)
    write_whole(target, text.encode("utf-8"))
    return target

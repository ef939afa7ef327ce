"""The page of a scene that runs in it, as a file, which is there whole or not at all."""

from __future__ import annotations

import base64
import gzip
import os
from pathlib import Path

from atmosbox.file.output_path import check_writable, write_whole
from atmosbox.lab.lab_plan import lab_plan
from atmosbox.lab.wasm_module import module_bytes
from atmosbox.page import lab_page
from atmosbox.simulation.preparation import Prepared

__all__ = ["lab_text", "save_lab"]


def lab_text(prepared: Prepared, *, theme: str = "auto", language: str = "auto") -> str:
    """Return the HTML of the page that `save_lab` writes.

    Raises
    ------
    AtmosboxError
        If the scene cannot run in a page.

    Examples
    --------
    >>> from atmosbox.simulation.preparation import prepare
    >>> "WebAssembly" in lab_text(prepare("temperature", {"molecules": 20}))
    True
    """
    plan, memory, box = lab_plan(prepared)
    module = module_bytes(box.modes, prepared.scene)
    stored = gzip.compress(b"".join(content for _, content in memory.pieces), 9, mtime=0)
    packed = (base64.b64encode(each).decode("ascii") for each in (module, stored))
    return lab_page(plan, *packed, theme=theme, language=language)


def save_lab(
    prepared: Prepared,
    path: str | os.PathLike[str],
    *,
    theme: str = "auto",
    language: str = "auto",
    force: bool = False,
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
        Its words.
    force
        Whether a file of that name may be replaced.

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
    write_whole(target, lab_text(prepared, theme=theme, language=language).encode("utf-8"))
    return target

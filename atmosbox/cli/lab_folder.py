"""A folder with the page of every scene and an index of them, for the site of a course or a USB stick."""

from __future__ import annotations

import html
from collections.abc import Callable
from pathlib import Path

from atmosbox import scenarios
from atmosbox.errors import FileError

__all__ = ["save_all"]

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>An atmosphere in a box</title>
<style>
body { margin: 0 auto; max-width: 75rem; padding: 1rem; font: 1rem/1.45 system-ui, sans-serif; }
body { color: #1a1f26; background: #f4f6f9; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(17rem, 1fr)); gap: 1rem; }
a { display: block; padding: 0.75rem; color: inherit; background: #fff; border: 1px solid #d8dee6; }
h2 { margin: 0.5rem 0 0.25rem; font-size: 1.125rem; color: #0072b2; }
p { margin: 0; }
small { color: #566270; }
</style>
</head>
<body>
<h1>An atmosphere in a box</h1>
<p>Molecules collide, and meteorology emerges. The scenes stand in the order of teaching; each runs in this browser.</p>
<main>
@@SCENES@@
</main>
<p><small>@@BY@@</small></p>
</body>
</html>
"""


def save_all(
    folder: Path, *, theme: str, language: str, force: bool, progress: Callable[[float, str], None]
) -> list[Path]:
    """Write the page of every scene that can run in one, and ``index.html``; return their paths, the index first.

    Raises
    ------
    AtmosboxError
        If a file is there and may not be replaced, or cannot be written.
    """
    from atmosbox.file.output_path import check_writable, write_whole
    from atmosbox.lab import save_lab
    from atmosbox.lab.wasm_module import SCENES
    from atmosbox.simulation.preparation import prepare
    from atmosbox.version import __version__

    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise FileError(f"{folder} cannot be made ({error.strerror}): give another folder.") from error
    found = {name: each for name, each in scenarios.summaries().items() if name in SCENES}
    pages = {name: check_writable(folder / f"{name}-lab.html", force) for name in found}
    index = check_writable(folder / "index.html", force)
    cards = []
    for number, (name, told) in enumerate(found.items()):
        progress(number / len(found), name)
        prepared = prepare(name, SCENES[name], engine="exact")
        save_lab(prepared, pages[name], theme=theme, language=language, force=force)
        title = html.escape(str(getattr(prepared.module, "title", name)))
        about = " · ".join(filter(None, [told.level, f"{told.minutes} minutes" if told.minutes else ""]))
        cards.append(
            f'<a href="{pages[name].name}"><h2>{title}</h2>'
            f"<p>{html.escape(told.sentence)}</p><small>{html.escape(about)}</small></a>"
        )
    text = _PAGE.replace("@@SCENES@@", "\n".join(cards)).replace("@@BY@@", f"Made by atmosbox {__version__}.")
    write_whole(index, text.encode("utf-8"))
    return [index, *pages.values()]
